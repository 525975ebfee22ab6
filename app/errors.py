"""Messages for the person: errors, notices, install hints and the progress of long work.

Errors are messages, never tracebacks. A context variable holds the progress listener of a thread,
so that the rooms between the listener and the computation need not hand it on.
"""

import platform
import re
import shlex
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from importlib.metadata import requires
from importlib.util import find_spec
from pathlib import Path
from typing import Final, Literal

from app.texts import N_, _
from engine.errors import EngineError

# Optional features, each an extra of the package with its own library.
Extra = Literal["video", "psd", "figures"]
LIBRARIES: Final[dict[Extra, str]] = {"video": "av", "psd": "psd-tools", "figures": "matplotlib"}
ProgressListener = Callable[[float], None]
_listener: ContextVar[ProgressListener | None] = ContextVar("listener", default=None)
CANCELLED: Final = N_("it was cancelled")
REINSTALL: Final = N_("install Lissom again")
# On Linux, Python reads the bytes of a file name that are not UTF-8 as these surrogates.
_UNREADABLE = re.compile("[\ud800-\udfff]")
MAX_TEXT_LENGTH: Final = 120  # characters of a text from a file or another program
MAX_MESSAGE_LENGTH: Final = 1_000  # characters
MAX_LISTED: Final = 10  # names in a list, or notices
_CUT: Final = "\N{HORIZONTAL ELLIPSIS}"
# A quoted text within a message that is longer than MAX_TEXT_LENGTH.
_LONG_QUOTED: Final = re.compile(
    rf"""(?<!\w)(['"])((?:(?!\1).){{{MAX_TEXT_LENGTH - 1}}})(?:(?!\1).){{2,}}\1(?!\w)"""
)
# Printable characters that `str.isprintable` rejects: spaces of any width, and joiners.
_PRINTABLE: Final = re.compile("[\u00a0\u1680\u2000-\u200a\u202f\u205f\u3000\u200c\u200d]")


class LissomError(Exception):
    """A request that cannot be met; the message states the fault and the remedy."""


# A command line, a job or a panel shows these errors as plain messages.
EXPECTED_ERRORS = (LissomError, EngineError)


@dataclass(frozen=True, slots=True)
class ImportLog:
    """Notices from opening a drawing, one per line, each with the names of its layers."""

    warnings: tuple[str, ...] = ()  # the layer looks different from the program that made it
    notes: tuple[str, ...] = ()  # the layer was changed on import and looks the same

    def __bool__(self) -> bool:
        return bool(self.warnings or self.notes)

    @property
    def lines(self) -> tuple[str, ...]:
        """Warnings, then notes."""
        return self.warnings + self.notes

    def __add__(self, other: "ImportLog") -> "ImportLog":
        """Return the notices of both logs."""
        return ImportLog(self.warnings + other.warnings, self.notes + other.notes)


EMPTY_IMPORT_LOG = ImportLog()


class NoticeCollector:
    """Collects notices while a drawing is read; equal notices share a line with all names."""

    def __init__(self) -> None:
        self._losses: dict[str, list[str]] = {}
        self._matters: dict[str, list[str]] = {}

    def add_warning(self, name: str, what: str) -> None:
        """Add a notice that a layer looks different here."""
        self._losses.setdefault(what, []).append(name)

    def add_note(self, name: str, what: str) -> None:
        """Add a notice that a layer was changed and looks the same."""
        self._matters.setdefault(what, []).append(name)

    @property
    def import_log(self) -> ImportLog:
        losses, matters = (
            tuple(f"{join_names(names)}: {what}" for what, names in found.items())
            for found in (self._losses, self._matters)
        )
        return ImportLog(losses, matters)


def display_name(name: object) -> str:
    """Return the text with � in place of each byte that is not UTF-8.

    Neither a window nor a text file accepts other bytes.
    """
    return _UNREADABLE.sub("\N{REPLACEMENT CHARACTER}", str(name))


def printable(text: object, *, keeps_lines: bool = False) -> str:
    r"""Return the text with control characters escaped, for example \x1b.

    Characters that change the writing direction are escaped too.
    """

    def escaped(letter: str) -> str:
        if letter.isprintable() or _PRINTABLE.match(letter) or (keeps_lines and letter == "\n"):
            return letter
        return letter.encode("unicode_escape").decode("ascii")

    text = display_name(text)
    return text if text.isprintable() else "".join(map(escaped, text))


def shortened(text: object) -> str:
    """Return a foreign text for use in a sentence: printable and at most MAX_TEXT_LENGTH long."""
    shown = printable(str(text)[: MAX_TEXT_LENGTH + 1])
    return shown if len(shown) <= MAX_TEXT_LENGTH else shown[: MAX_TEXT_LENGTH - 1] + _CUT


def display_message(message: object) -> str:
    """Return the message on one line, printable, with long quoted texts shortened."""
    shown = _LONG_QUOTED.sub(rf"\1\2{_CUT}\1", printable(" ".join(str(message).split())))
    half = MAX_MESSAGE_LENGTH // 2
    return shown if len(shown) <= MAX_MESSAGE_LENGTH else f"{shown[:half]}{_CUT}{shown[-half:]}"


def join_names(names: Sequence[object]) -> str:
    """Return the first names, separated by commas, and the number of the others."""
    few = ", ".join(map(shortened, names[:MAX_LISTED]))
    more = len(names) - MAX_LISTED
    return _("{names} and {count:,} more").format(names=few, count=more) if more > 0 else few


def few_notices(notices: Sequence[str]) -> list[str]:
    """Return the first notices and the number of the others."""
    more = len(notices) - MAX_LISTED
    return [
        *notices[:MAX_LISTED],
        *([_("and {count:,} more").format(count=more)] if more > 0 else []),
    ]


def install_hint(extra: Extra) -> str:
    """Return how to install the library of an extra; empty if it is installed."""
    is_there = find_spec(LIBRARIES[extra].replace("-", "_")) is not None
    return "" if is_there else _how_to_install(extra)


def _how_to_install(extra: Extra) -> str:
    """Return the command that adds the extra's library to this installation of Lissom.

    The command does not reinstall Lissom: this installation may come from a local folder.
    """
    if getattr(sys, "frozen", False):
        # A bundled application contains all libraries.
        return _("a part of Lissom is missing; install it again")
    home = Path(sys.prefix)
    if (home / "pipx_metadata.json").is_file():
        return f"pipx inject {_quoted(home.name)} {_quoted(required_library(extra))}"
    if (home / "uv-receipt.toml").is_file() or find_spec("pip") is None:
        return f"uv pip install --python {_quoted(str(home))} {_quoted(required_library(extra))}"
    found = shutil.which("pip")
    is_ours = found is not None and Path(found).parent == Path(sys.executable).parent
    pip = "pip" if is_ours else f"{_quoted(sys.executable)} -m pip"
    return f"{pip} install {_quoted(f'lissom[{extra}]')}"


def required_library(extra: Extra) -> str:
    """Return the requirement of an extra: its library with the accepted versions."""
    lines = (line.partition(";") for line in requires("lissom") or ())
    return next(name.strip() for name, _mark, case in lines if re.search(rf"\b{extra}\b", case))


def _quoted(word: str) -> str:
    """Return the word quoted for the usual shells of this system."""
    if platform.system() != "Windows":
        return shlex.quote(word)
    return word if re.fullmatch(r"[\w:.\\-]+", word) else f'"{word}"'


@contextmanager
def listen_to_progress(listener: ProgressListener) -> Iterator[None]:
    """Send the progress of this thread to a listener within a `with` block.

    The listener takes the finished share, from 0 to 1. An exception from the listener ends the
    work.
    """
    before = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(before)


def report_progress(share: float) -> None:
    """Report the finished share of the work, from 0 to 1, to the listener of this thread."""
    listener = _listener.get()
    if listener is not None:
        listener(share)

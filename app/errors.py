"""What is told to the person: errors, what to install, names of files, and how far long work is.

Errors are messages and no tracebacks. Between what computes for long and whoever waits for it are
many rooms that have nothing to add: so who listens is said once, for a block on the same thread.
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

from engine.errors import EngineError

# What Lissom can do with a library that it does not always have: extras of the package.
Extra = Literal["video", "psd", "figures"]
LIBRARIES: Final[dict[Extra, str]] = {"video": "av", "psd": "psd-tools", "figures": "matplotlib"}
ProgressListener = Callable[[float], None]
_listener: ContextVar[ProgressListener | None] = ContextVar("listener", default=None)
CANCELLED: Final = "it was cancelled"
REINSTALL: Final = "install Lissom again"
# What Python makes of the bytes of a file's name that are no UTF-8, on Linux.
_UNREADABLE = re.compile("[\ud800-\udfff]")
MAX_TEXT_LENGTH: Final = 120  # characters of a text that others wrote
MAX_MESSAGE_LENGTH: Final = 1_000  # characters
MAX_LISTED: Final = 10  # names in a row, and notices
_CUT: Final = "\N{HORIZONTAL ELLIPSIS}"
# A text in quotes within a message, of more characters than are shown.
_LONG_QUOTED: Final = re.compile(
    rf"""(?<!\w)(['"])((?:(?!\1).){{{MAX_TEXT_LENGTH - 1}}})(?:(?!\1).){{2,}}\1(?!\w)"""
)
# Beside all that Python counts as printable: spaces of every width, and joiners within words.
_PRINTABLE: Final = re.compile("[\u00a0\u1680\u2000-\u200a\u202f\u205f\u3000\u200c\u200d]")


class LissomError(Exception):
    """A request that cannot be met; the message tells the person what was wrong and what to do."""


# What a command line, a job or a panel reports as a plain message.
EXPECTED_ERRORS = (LissomError, EngineError)


@dataclass(frozen=True, slots=True)
class ImportLog:
    """What opening a drawing told, a line each, with the names of the layers that it is about."""

    warnings: tuple[str, ...] = ()  # what does not look as it does elsewhere
    notes: tuple[str, ...] = ()  # what was done, and looks the same

    def __bool__(self) -> bool:
        """Tell whether there is anything to be told."""
        return bool(self.warnings or self.notes)

    @property
    def lines(self) -> tuple[str, ...]:
        """All of it, losses first."""
        return self.warnings + self.notes

    def __add__(self, other: "ImportLog") -> "ImportLog":
        """Return both."""
        return ImportLog(self.warnings + other.warnings, self.notes + other.notes)


EMPTY_IMPORT_LOG = ImportLog()


class NoticeCollector:
    """What is found while a drawing is read: told once, with the names of all that it is about."""

    def __init__(self) -> None:
        self._losses: dict[str, list[str]] = {}
        self._matters: dict[str, list[str]] = {}

    def add_warning(self, name: str, what: str) -> None:
        """Tell what of something is not shown as it is elsewhere."""
        self._losses.setdefault(what, []).append(name)

    def add_note(self, name: str, what: str) -> None:
        """Tell what was done to something, which looks the same."""
        self._matters.setdefault(what, []).append(name)

    @property
    def import_log(self) -> ImportLog:
        """All that was told."""
        losses, matters = (
            tuple(f"{join_names(names)}: {what}" for what, names in found.items())
            for found in (self._losses, self._matters)
        )
        return ImportLog(losses, matters)


def display_name(name: object) -> str:
    """Return a file's name, or a text with names in it, with a � for each byte that is no UTF-8.

    Neither a window nor a file of text takes such a name as it is.
    """
    return _UNREADABLE.sub("\N{REPLACEMENT CHARACTER}", str(name))


def printable(text: object, *, keeps_lines: bool = False) -> str:
    r"""Return a text as any terminal shows it: its control characters are escapes, such as \x1b.

    Those that turn the direction of writing are among them.
    """

    def escaped(letter: str) -> str:
        if letter.isprintable() or _PRINTABLE.match(letter) or (keeps_lines and letter == "\n"):
            return letter
        return letter.encode("unicode_escape").decode("ascii")

    text = display_name(text)
    return text if text.isprintable() else "".join(map(escaped, text))


def shortened(text: object) -> str:
    """Return a text that others wrote as it stands in a sentence: printable, and cut if long."""
    shown = printable(str(text)[: MAX_TEXT_LENGTH + 1])
    return shown if len(shown) <= MAX_TEXT_LENGTH else shown[: MAX_TEXT_LENGTH - 1] + _CUT


def display_message(message: object) -> str:
    """Return a message as it is printed: on one line, printable, and what is long in it cut."""
    shown = _LONG_QUOTED.sub(rf"\1\2{_CUT}\1", printable(" ".join(str(message).split())))
    half = MAX_MESSAGE_LENGTH // 2
    return shown if len(shown) <= MAX_MESSAGE_LENGTH else f"{shown[:half]}{_CUT}{shown[-half:]}"


def join_names(names: Sequence[object]) -> str:
    """Return names in a row, and how many more there are."""
    few = ", ".join(map(shortened, names[:MAX_LISTED]))
    more = len(names) - MAX_LISTED
    return f"{few} and {more:,} more" if more > 0 else few


def few_notices(notices: Sequence[str]) -> list[str]:
    """Return the first notices, and how many more there are."""
    more = len(notices) - MAX_LISTED
    return [*notices[:MAX_LISTED], *([f"and {more:,} more"] if more > 0 else [])]


def install_hint(extra: Extra) -> str:
    """Return how to install the library of an extra here; empty where it is there."""
    is_there = find_spec(LIBRARIES[extra].replace("-", "_")) is not None
    return "" if is_there else _how_to_install(extra)


def _how_to_install(extra: Extra) -> str:
    """Return the command that brings an extra to this Lissom, or what else to do.

    It does not ask for Lissom anew, which may have come from a folder.
    """
    if getattr(sys, "frozen", False):
        # What is built without Python has all of them inside.
        return "a part of Lissom is gone, install it again"
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
    """Return an extra's library, with the versions that will do."""
    lines = (line.partition(";") for line in requires("lissom") or ())
    return next(name.strip() for name, _, case in lines if re.search(rf"\b{extra}\b", case))


def _quoted(word: str) -> str:
    """Return a word as the system's usual shells take it."""
    if platform.system() != "Windows":
        return shlex.quote(word)
    return word if re.fullmatch(r"[\w:.\\-]+", word) else f'"{word}"'


@contextmanager
def listen_to_progress(listener: ProgressListener) -> Iterator[None]:
    """Let somebody listen to what this thread does in a `with` block.

    Parameters
    ----------
    listener : callable
        Takes the share that is done, from 0 to 1; what it raises ends the work.
    """
    before = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(before)


def report_progress(share: float) -> None:
    """Tell how far the work is, if somebody listens."""
    listener = _listener.get()
    if listener is not None:
        listener(share)

"""What is told of a problem of the program itself: nothing that is the person's own.

Nothing is sent anywhere: a report is a text that the person reads, and passes on or not.
"""

import getpass
import platform
import re
import sys
import textwrap
import traceback
from collections.abc import Iterable, Sequence
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

from app.errors import printable

LIBRARIES: Final = (
    *("numpy", "scipy", "pillow", "shapely", "contourpy", "zlib-ng"),
    *("moderngl", "glcontext", "glfw", "imgui-bundle"),
)
LEFT_OUT: Final = "…"
WIDTH: Final = 90  # letters of a line
LONGEST: Final = 40_000  # characters of a trace
SHORTEST_NAME: Final = 3  # letters of a person's name that are looked for
ENDINGS: Final = (
    "lissom|png|jpe?g|gif|webp|bmp|tiff?|ppm|tga|ico|avif|ora|psd|json|npz|mp4|webm|mov"
)
# What points at a part of the line above, which letters of different widths do not.
_CARETS = re.compile(r"^\s+[~^]+\n", re.MULTILINE)
_FRAME = re.compile(r'^(\s*)File "([^"\n]*)"', re.MULTILINE)
_QUOTED = re.compile(r"""(?P<mark>['"])[^'"\n]*[/\\][^'"\n]*(?P=mark)""")
_PATH = re.compile(r"""(?<![\w./…-])~?(?:[A-Za-z]:[\\/]|\\\\|/)[\w.~-][^\s'":;,()<>|]*""")
_FILE = re.compile(rf"""[^\s'"/\\:(]+\.({ENDINGS})\b""", re.IGNORECASE)


def library_version(name: str) -> str:
    """Return the version of a library that is installed, or that it is missing."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "missing"


def describe_machine() -> str:
    """Return two lines: Lissom, Python and the system, and the libraries, each with its version."""
    system = f"{platform.system()} {platform.release()} {platform.machine()}"
    libraries = ", ".join(f"{name} {library_version(name)}" for name in LIBRARIES)
    return f"Lissom {version('lissom')}, Python {platform.python_version()}, {system}\n{libraries}"


def format_problem_report(*, graphics: str, actions: Sequence[str], trace: str) -> str:
    """Return a text about a problem that somebody else may read.

    Parameters
    ----------
    graphics : str
        What draws the window; empty where nothing does.
    actions : sequence of str
        What was done last, by names of the program, the newest one last.
    trace : str
        What went wrong, as `trace_in_words` or `without_names` returns it; empty where nothing did.
    """
    parts = [
        "Report of a problem with Lissom",
        "What happened, and what should have happened, in your words:\n\n",
        "\n".join(textwrap.fill(line, WIDTH) for line in describe_machine().splitlines()),
    ]
    if graphics:
        parts.append(f"Drawn by {graphics}")
    if actions:
        parts.append("\n".join(["Done last, the newest at the end:", *(f"  {a}" for a in actions)]))
    parts.append(trace.rstrip() or "Nothing failed that the program has noticed.")
    return printable("\n\n".join(parts) + "\n", keeps_lines=True)


def format_trace(error: BaseException, hidden: Iterable[Path] = ()) -> str:
    """Return the traceback of an exception without paths and names of files of the person's."""
    trace = _CARETS.sub("", "".join(traceback.format_exception(error)))
    return redact_names(trace, hidden)


def redact_names(text: str, hidden: Iterable[Path] = ()) -> str:
    """Return a text with places in the program shortened, and all other paths and names left out.

    Parameters
    ----------
    text : str
        Such as a traceback.
    hidden : iterable of Path
        Files whose names are left out, too, whatever they consist of.
    """
    text = text if len(text) <= LONGEST else f"{text[: LONGEST // 2]}\n…\n{text[-LONGEST // 2 :]}"
    pieces = _FRAME.split(text)
    found = [_redact_paths(pieces[0], hidden)]
    for indent, path, rest in zip(pieces[1::3], pieces[2::3], pieces[3::3], strict=True):
        found.append(f'{indent}File "{_place(path)}"{_redact_paths(rest, hidden)}')
    return "".join(found)


def _place(path: str) -> str:
    """Return where a source file is in the program or in a library; its name alone elsewhere."""
    for root in sorted(filter(None, sys.path), key=len, reverse=True):
        with suppress(ValueError):
            return Path(path).relative_to(root).as_posix()
    return Path(path.replace("\\", "/")).name if Path(path).is_absolute() else path


def _redact_paths(text: str, hidden: Iterable[Path]) -> str:
    names = {str(path) for path in hidden} | {path.name for path in hidden}
    for name in sorted(filter(None, names), key=len, reverse=True):
        text = text.replace(name, LEFT_OUT)
    text = _QUOTED.sub(rf"\g<mark>{LEFT_OUT}\g<mark>", text)
    text = _PATH.sub(LEFT_OUT, text)
    text = _FILE.sub(rf"{LEFT_OUT}.\1", text)
    for name in _names_of_person():
        text = re.sub(rf"(?<!\w){re.escape(name)}(?!\w)", LEFT_OUT, text)
    return text


def _names_of_person() -> set[str]:
    """Return how the system calls who runs this, where that is more than a letter or two."""
    names = set()
    # Without a home or a name, as in containers, there is nothing to hide.
    with suppress(RuntimeError):
        names.add(Path.home().name)
    with suppress(OSError, KeyError, ImportError):
        names.add(getpass.getuser())
    return {name for name in names if len(name) >= SHORTEST_NAME}

"""Reports of errors of the program itself, without the person's own names and paths.

Lissom sends nothing: a report is a text that the person reads, and may pass on.
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
    *("numpy", "scipy", "pillow", "miniaudio", "shapely", "contourpy", "zlib-ng"),
    *("moderngl", "glcontext", "glfw", "imgui-bundle"),
)
LEFT_OUT: Final = "…"
WIDTH: Final = 90  # letters of a line
LONGEST: Final = 40_000  # characters of a traceback
SHORTEST_NAME: Final = 3  # letters of a person's name to remove
ENDINGS: Final = (
    "lissom|png|jpe?g|gif|webp|bmp|tiff?|ppm|tga|ico|avif|ora|psd|json|npz|mp4|webm|mov"
)
# Carets under a part of the line above; they do not align with proportional fonts.
_CARETS = re.compile(r"^\s+[~^]+\n", re.MULTILINE)
_FRAME = re.compile(r'^(\s*)File "([^"\n]*)"', re.MULTILINE)
_QUOTED = re.compile(r"""(?P<mark>['"])[^'"\n]*[/\\][^'"\n]*(?P=mark)""")
_PATH = re.compile(r"""(?<![\w./…-])~?(?:[A-Za-z]:[\\/]|\\\\|/)[\w.~-][^\s'":;,()<>|]*""")
_FILE = re.compile(rf"""[^\s'"/\\:(]+\.({ENDINGS})\b""", re.IGNORECASE)


def library_version(name: str) -> str:
    """Return the version of an installed library, or "missing"."""
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
    """Return a report of a problem that another person may read.

    Parameters
    ----------
    graphics : str
        The window's renderer; empty without a window.
    actions : sequence of str
        The last actions, by names of the program, the newest one last.
    trace : str
        Result of `format_trace` or `redact_names`; empty without an error.
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
    """Return the traceback of an exception without the person's paths and file names."""
    trace = _CARETS.sub("", "".join(traceback.format_exception(error)))
    return redact_names(trace, hidden)


def redact_names(text: str, hidden: Iterable[Path] = ()) -> str:
    """Return a text with program paths shortened and all other paths and names removed.

    The names of `hidden` files are removed in any form.
    """
    text = text if len(text) <= LONGEST else f"{text[: LONGEST // 2]}\n…\n{text[-LONGEST // 2 :]}"
    pieces = _FRAME.split(text)
    found = [_redact_paths(pieces[0], hidden)]
    for indent, path, rest in zip(pieces[1::3], pieces[2::3], pieces[3::3], strict=True):
        found.append(f'{indent}File "{_place(path)}"{_redact_paths(rest, hidden)}')
    return "".join(found)


def _place(path: str) -> str:
    """Return a source file's path within the program or a library; elsewhere its bare name."""
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
    """Return the system's names of the current person, without very short ones."""
    names = set()
    # Without a home or a name, as in containers, nothing needs to be hidden.
    with suppress(RuntimeError):
        names.add(Path.home().name)
    with suppress(OSError, KeyError, ImportError):
        names.add(getpass.getuser())
    return {name for name in names if len(name) >= SHORTEST_NAME}

"""`lissom` and `lissom FILE`: the window."""

import argparse
from pathlib import Path

from app.errors import LissomError
from app.texts import _

EPILOG = _(
    """\
Without FILE the window opens with samples to try. `lissom FILE` is short for `lissom window FILE`.

examples:
  lissom
  lissom giraffe.png
  lissom wave.lissom
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "file", metavar="FILE", nargs="?", type=_existing, help=_("a picture or a .lissom project")
    )


def run(arguments: argparse.Namespace) -> int:
    from app.cli.window_process import run_window

    return run_window(arguments.file)


def _existing(text: str) -> Path:
    """Return the path of an existing file; a word that is no command is taken for a file."""
    path = Path(text)
    if not path.is_file():
        raise LissomError(
            _("{text} is neither a command nor a file (see 'lissom --help')").format(text=text)
        )
    return path

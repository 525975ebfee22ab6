"""What is said to `lissom thumbnail`."""

import argparse
from pathlib import Path

from app.cli.options import input_file

EPILOG = """\
The small picture is the one that was saved with the project; nothing is rendered. It is never made
larger than it is. File managers call this command after 'lissom desktop --install'.

examples:
  lissom thumbnail nod.lissom --out nod.png
  lissom thumbnail nod.lissom --out nod.png --size 128
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `lissom thumbnail`."""
    parser.epilog = EPILOG
    parser.add_argument("project", metavar="PROJECT", type=input_file, help="the .lissom file")
    parser.add_argument(
        "--out", metavar="OUT.png", type=Path, required=True, help="where to write the picture"
    )
    parser.add_argument(
        "--size",
        metavar="N",
        type=_size,
        default=256,
        help="pixels of its longer side, at most (default: %(default)s)",
    )


def _size(text: str) -> int:
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"expected a number of pixels, such as 128, not {text!r}")
    return int(text)

"""Arguments of `lissom thumbnail`."""

import argparse

from app.cli.options import add_out, add_project, whole_number

EPILOG = """\
The small picture is the one that was saved with the project; nothing is rendered. It is never made
larger than it is. File managers call this command after 'lissom desktop --install'.

examples:
  lissom thumbnail nod.lissom --out nod.png
  lissom thumbnail nod.lissom --out nod.png --size 128
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_project(parser)
    add_out(parser, "OUT.png")
    parser.add_argument(
        "--size",
        metavar="N",
        type=whole_number(1),
        default=256,
        help="pixels of its longer side, at most (default: %(default)s)",
    )

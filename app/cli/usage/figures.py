"""Arguments of `lissom figures`."""

import argparse

from app.cli.options import add_out, output, whole_number

FIGURES = (1, 3, 4, 5, 6, 7, 8, 9, 10, 11)

EPILOG = """\
Makes the figures of the paper anew with Lissom's own drawings: DIR/figure_N.png, and one page,
DIR/figures.html, with captions and measured numbers. Figure 9 times every method, the slowest with
seconds a frame: --largest 100000 takes many minutes.

It needs matplotlib; without it, it says how to install that.

examples:
  lissom figures --out figures
  lissom figures --out figures --only 5
  lissom figures --out figures --only 9 --largest 100000
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_out(parser, "DIR", place=output)
    parser.add_argument(
        "--only",
        metavar="N",
        type=int,
        choices=FIGURES,
        action="append",
        help=f"make this figure, of {', '.join(map(str, FIGURES))}; may be said again",
    )
    parser.add_argument(
        "--triangles",
        metavar="N",
        type=whole_number(1_000, 2_000_000),
        default=6_000,
        help="of each drawing, 1000 to 2000000 (default: %(default)s)",
    )
    parser.add_argument(
        "--largest",
        metavar="N",
        type=whole_number(1_000),
        default=10_000,
        help="vertices of the largest mesh in figure 9, at least 1000 (default: %(default)s)",
    )

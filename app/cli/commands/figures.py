"""`lissom figures`: the figures of the paper, computed anew."""

import argparse
from collections.abc import Sequence
from operator import methodcaller
from pathlib import Path

from app.cli.console import StatusLine, print_line
from app.cli.options import add_out, output, whole_number
from app.texts import _, ngettext

FIGURES = (1, 3, 4, 5, 6, 7, 8, 9, 10, 11)

EPILOG = _(
    """\
Draws the figures of the paper with Lissom's own drawings: DIR/figure_N.png, and one page,
DIR/figures.html, with captions and measured numbers. Figure 9 times every method. The slowest one
takes seconds for a frame; with --largest 100000 this takes many minutes.

It needs matplotlib; if it is missing, the command says how to install it.

examples:
  lissom figures --out figures
  lissom figures --out figures --only 5
  lissom figures --out figures --only 9 --largest 100000
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_out(parser, "DIR", place=output)
    parser.add_argument(
        "--only",
        metavar="N",
        type=int,
        choices=FIGURES,
        action="append",
        help=_("make only this figure, one of {numbers}; may be given several times").format(
            numbers=", ".join(map(str, FIGURES))
        ),
    )
    parser.add_argument(
        "--triangles",
        metavar="N",
        type=whole_number(1_000, 2_000_000),
        default=6_000,
        help=_("triangles of each drawing, 1000 to 2000000 (default: %(default)s)"),
    )
    parser.add_argument(
        "--largest",
        metavar="N",
        type=whole_number(1_000),
        default=10_000,
        help=_("vertices of the largest mesh in figure 9, at least 1000 (default: %(default)s)"),
    )


def run(arguments: argparse.Namespace) -> int:
    """Make the figures and print their measurements."""
    from app.paper_figures import (
        MAKERS,
        FigureContext,
        ShapeRenderer,
        render_page,
        require_matplotlib,
    )
    from app.storage import make_folder, write_atomically

    require_matplotlib()
    out: Path = arguments.out.path
    make_folder(out)
    figures = {}
    with StatusLine() as status, ShapeRenderer() as renderer:
        context = FigureContext(
            renderer=renderer, triangles=arguments.triangles, largest=arguments.largest
        )
        for number in sorted(set(arguments.only or MAKERS)):
            status.show(_("making figure {number}").format(number=number))
            figures[number] = figure = MAKERS[number](context)
            picture = methodcaller("write", figure.picture)
            write_atomically(out / f"figure_{number}.png", picture)
    page = render_page(figures).encode()
    write_atomically(out / "figures.html", methodcaller("write", page))
    for number, figure in figures.items():
        title = _("Figure {number}: {title}").format(number=number, title=figure.title)
        print_line(f"\n{title}\n{_as_table([figure.column_names, *figure.rows])}")
    summary = ngettext("{path}: {count} figure", "{path}: {count} figures", len(figures))
    print_line("\n" + summary.format(path=out, count=len(figures)))
    return 0


def _as_table(table: Sequence[Sequence[str]]) -> str:
    """Return the numbers of a figure in columns."""
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = []
    for name, *numbers in table:
        cells = map(str.rjust, numbers, widths[1:])
        lines.append("  ".join(["", name.ljust(widths[0]), *cells]).rstrip())
    return "\n".join(lines)

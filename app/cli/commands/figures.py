"""`lissom figures`: the figures of the paper, made anew."""

import argparse

from app.cli.console import StatusLine
from app.cli.figures import MAKERS, make_figures
from app.errors import LissomError

FEWEST_TRIANGLES, MOST_TRIANGLES = 1_000, 2_000_000
SMALLEST = 1_000


def run(arguments: argparse.Namespace) -> int:
    """Make the figures and print what was measured."""
    if not FEWEST_TRIANGLES <= arguments.triangles <= MOST_TRIANGLES:
        raise LissomError(
            f"--triangles must be between {FEWEST_TRIANGLES:,} and {MOST_TRIANGLES:,}, not "
            f"{arguments.triangles:,}"
        )
    if arguments.largest < SMALLEST:
        raise LissomError(f"--largest must be at least {SMALLEST:,}, not {arguments.largest:,}")
    status = StatusLine()
    try:
        plates = make_figures(
            arguments.out,
            sorted(set(arguments.only)) if arguments.only else tuple(MAKERS),
            triangles=arguments.triangles,
            largest=arguments.largest,
            progress=status.show,
        )
    finally:
        status.clear()
    for number, plate in plates.items():
        print(f"\nFigure {number}: {plate.title}")
        table = [plate.heads, *plate.rows]
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        for row in table:
            cells = [row[0].ljust(widths[0])]
            cells += [word.rjust(width) for word, width in zip(row[1:], widths[1:], strict=True)]
            print("  " + "  ".join(cells).rstrip())
    print(f"\n{arguments.out}: {len(plates)} figures")
    return 0

"""`lissom figures`: the figures of the paper, computed anew."""

import argparse
from pathlib import Path

from app.cli.console import StatusLine, print_line
from app.paper_figures import (
    MAKERS,
    FigureContext,
    PaperFigure,
    ShapeRenderer,
    render_page,
    require_matplotlib,
)
from app.storage import make_folder, write_atomically


def run(arguments: argparse.Namespace) -> int:
    """Make the figures and print their measurements."""
    require_matplotlib()
    out: Path = arguments.out.path
    make_folder(out)
    plates = {}
    with StatusLine() as status, ShapeRenderer() as easel:
        studio = FigureContext(
            renderer=easel, triangles=arguments.triangles, largest=arguments.largest
        )
        for number in sorted(set(arguments.only or MAKERS)):
            status.show(f"making figure {number}")
            plates[number] = plate = MAKERS[number](studio)
            _write(out / f"figure_{number}.png", plate.picture)
    _write(out / "figures.html", render_page(plates).encode())
    for number, plate in plates.items():
        print(f"\nFigure {number}: {plate.title}\n{_as_table(plate)}")
    print_line(f"\n{out}: {len(plates)} figures")
    return 0


def _as_table(plate: PaperFigure) -> str:
    """Return the numbers of a figure in columns."""
    table = [plate.column_names, *plate.rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = []
    for name, *numbers in table:
        cells = map(str.rjust, numbers, widths[1:])
        lines.append("  ".join(["", name.ljust(widths[0]), *cells]).rstrip())
    return "\n".join(lines)


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda file: file.write(content))

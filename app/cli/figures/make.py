"""Figures to files."""

from collections.abc import Callable, Sequence
from pathlib import Path

from app.cli.figures.easel import Easel
from app.cli.figures.page import lay_out
from app.cli.figures.plates import MAKERS, Plate, Studio
from app.cli.figures.sheet import require_matplotlib
from app.storage import write_atomically

PAGE = "figures.html"


def make_figures(
    out: Path,
    numbers: Sequence[int],
    *,
    triangles: int,
    largest: int,
    progress: Callable[[str], None],
) -> dict[int, Plate]:
    """Write figures as pictures, and a page with all of them.

    Parameters
    ----------
    out : Path
        A folder, made if it is not there.
    numbers : sequence of int
        Of `MAKERS`.
    triangles : int
        Of each shape's mesh.
    largest : int
        Vertices of the largest mesh that is timed.
    progress : callable
        Told in words what is being made.

    Raises
    ------
    LissomError
        If matplotlib is not installed, or this machine cannot draw.
    """
    require_matplotlib()
    out.mkdir(parents=True, exist_ok=True)
    plates: dict[int, Plate] = {}
    with Easel() as easel:
        studio = Studio(easel=easel, triangles=triangles, largest=largest)
        for number in numbers:
            progress(f"making figure {number}")
            plates[number] = MAKERS[number](studio)
            _write(out / f"figure_{number}.png", plates[number].picture)
    _write(out / PAGE, lay_out(plates).encode())
    return plates


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda file: file.write(content))

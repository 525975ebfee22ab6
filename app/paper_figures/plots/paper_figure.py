"""A finished figure, and the context of making figures."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.paper_figures.measure import MeasuredMotion
from app.paper_figures.shape_renderer import ShapeRenderer
from app.paper_figures.sheet import as_png, format_number
from app.texts import _

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BOUNDED = (
    "",
    _("k, of its key"),
    _("τ − 1, of its key"),
    _("largest k"),
    _("largest τ − 1"),
    _("least area"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class FigureContext:
    """Renderer and sizes for making figures."""

    renderer: ShapeRenderer
    triangles: int  # of a shape's mesh
    largest: int  # vertices of the largest timed mesh


@dataclass(frozen=True, slots=True, kw_only=True)
class PaperFigure:
    """A finished figure: a PNG file and a table; the first column holds the names of the rows."""

    title: str
    caption: str
    picture: bytes
    column_names: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def make_distortion_figure(
    title: str, caption: str, sheet: "Figure", tracks: Mapping[str, MeasuredMotion]
) -> PaperFigure:
    """Return a figure with the distortion of in-betweens relative to their keyframes, by name."""
    rows = []
    for name, track in tracks.items():
        one = track.summarize()
        numbers = map(format_number, (one.k, one.tau, one.k_of_all, one.tau_of_all))
        rows.append((name, *numbers, f"{one.area:.3f}"))
    return PaperFigure(
        title=title, caption=caption, picture=as_png(sheet), column_names=BOUNDED, rows=tuple(rows)
    )

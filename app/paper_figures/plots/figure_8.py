"""Figure 8: the dragon's tail between two keyframes that both differ from the drawing."""

from dataclasses import dataclass, replace

import numpy as np

from app.paper_figures.measure import MeasuredMotion
from app.paper_figures.methods import METRIC, SCALED_ETA, SIG13
from app.paper_figures.plots.paper_figure import FigureContext, PaperFigure
from app.paper_figures.shape_renderer import bounds_of
from app.paper_figures.shapes import ShapePair, make_sample_pair
from app.paper_figures.sheet import as_png, draw_panels
from app.texts import _
from engine.arrays import Complexes
from engine.maps import HarmonicMap

TIME = 0.5
NEAR = 0.04  # of the width: the neighbourhood of the tail's tip
CAPTION = _(
    "Dragon with a moving tail: Ω in the first picture and f⁰ ≠ Id in the second. Scaled η blends "
    "the angle of the tail linearly and metric does not; metric and Chen et al. (2013) look alike."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class TailPosition:
    """Position of a method's in-between at t = 0.5."""

    name: str
    turned: float  # turned share of the whole rotation of the tail's tip
    from_metric: float  # largest distance from the metric variant, over the diameter


def make_tail_pair(triangles: int) -> ShapePair:
    """Return two keys of the dragon with its tail high and low."""
    return make_sample_pair("dragon", 1, 2, triangles)


def measure_tail(tracks: tuple[MeasuredMotion, ...]) -> tuple[TailPosition, ...]:
    """Measure methods; the first one must be metric."""
    both = tracks[0].pair
    rest = both.shape.domain.mesh.vertices
    tip = int(rest.real.argmax())
    reference = tracks[0].frame(TIME).positions
    size = abs(bounds_of(reference).upper - bounds_of(reference).lower)
    found = []
    for track in tracks:
        first, now, last = (track.frame(time).positions for time in (0.0, TIME, 1.0))
        found.append(
            TailPosition(
                name=track.method.name,
                turned=_turn(rest, first, now, tip) / _turn(rest, first, last, tip),
                from_metric=float(np.abs(now - reference).max() / size),
            )
        )
    return tuple(found)


def make_figure_8(studio: FigureContext) -> PaperFigure:
    both = make_tail_pair(studio.triangles)
    tracks = tuple(MeasuredMotion(both, method) for method in (METRIC, SCALED_ETA, SIG13))
    metric, eta, chen = tracks
    rest = MeasuredMotion(replace(both, first=HarmonicMap.identity(both.first.cage)), METRIC)
    panels = (
        ("Ω", rest, 0.0),
        ("f⁰", metric, 0.0),
        ("scaled η", eta, TIME),
        ("metric", metric, TIME),
        ("Chen et al. 2013", chen, TIME),
        ("f¹", metric, 1.0),
    )
    return PaperFigure(
        title=_("The dragon's tail"),
        caption=CAPTION,
        picture=as_png(draw_panels(studio.renderer, panels, (14, 2.6))),
        column_names=("t = 0.5", _("of the tail's turn"), _("from metric, of the diameter")),
        rows=tuple(
            (one.name, f"{one.turned:.3f}", f"{one.from_metric:.2%}")
            for one in measure_tail(tracks)
        ),
    )


def _turn(rest: Complexes, first: Complexes, second: Complexes, tip: int) -> float:
    """Return the rotation of a vertex's neighbourhood between two poses, in radians."""
    near = np.abs(rest - rest[tip]) < NEAR * np.ptp(rest.real)
    before, after = (positions[near] - positions[near].mean() for positions in (first, second))
    return float(np.angle(np.vdot(before, after)))

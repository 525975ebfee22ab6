"""Figure 3: the direction of stretch of a square that turns while it is stretched."""

from dataclasses import dataclass

import numpy as np

from app.paper_figures.measure import MeasuredMotion
from app.paper_figures.methods import METRIC, NU, SCALED_ETA
from app.paper_figures.plots.paper_figure import FigureContext, PaperFigure
from app.paper_figures.shapes import ShapePair, square
from app.paper_figures.sheet import as_png, draw_panels
from app.texts import _
from engine.maps import HarmonicMap, distortion

TIME = 0.8
MU = -1 / 3
TRIANGLES = 400  # the maps are affine
CAPTION = _(
    "Interpolation of the stretch direction. The square (a) is stretched along y by both keyframes "
    "(b) and (e), μ = −1/3, and (e) is also turned by a right angle. At t = 0.8 the ν variant (c) "
    "stretches it in another direction, and less; scaled η (d) and metric keep the direction."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class StretchResult:
    """The stretch of the square at t = 0.8 by one method."""

    name: str
    direction: float  # degrees from the keyframes' direction of stretch
    k: float


def make_square_pair() -> ShapePair:
    """Return the square, stretched, and stretched and turned."""
    shape = square(TRIANGLES)
    cage = shape.domain.cage
    centre = shape.domain.outline.mean()
    first = HarmonicMap(cage=cage, phi=cage, psi=MU * (cage - centre))
    return ShapePair(shape=shape, first=first, second=first.moved(1j, centre - 1j * centre))


def measure_stretch() -> tuple[StretchResult, ...]:
    """Measure ν, scaled η and metric."""
    both = make_square_pair()
    found = []
    for method in (NU, SCALED_ETA, METRIC):
        frame = MeasuredMotion(both, method).frame(TIME)
        mu = distortion.mu(frame.fz, frame.fzbar)
        off = np.degrees(np.abs(np.angle(mu / MU)) / 2)
        found.append(
            StretchResult(name=method.name, direction=float(off.max()), k=float(np.abs(mu).max()))
        )
    return tuple(found)


def make_figure_3(studio: FigureContext) -> PaperFigure:
    both = make_square_pair()
    nu, eta = MeasuredMotion(both, NU), MeasuredMotion(both, SCALED_ETA)
    identity = HarmonicMap.identity(both.shape.domain.cage)
    rest = MeasuredMotion(ShapePair(shape=both.shape, first=identity, second=both.first), NU)
    panels = (
        ("(a) Ω", rest, 0.0),
        ("(b) f⁰", nu, 0.0),
        ("(c) ν, t = 0.8", nu, TIME),
        ("(d) scaled η, t = 0.8", eta, TIME),
        ("(e) f¹", nu, 1.0),
    )
    return PaperFigure(
        title=_("Stretch direction"),
        caption=CAPTION,
        picture=as_png(draw_panels(studio.renderer, panels, (12, 2.8))),
        column_names=("t = 0.8", _("direction off by"), _("k (keys: 0.3333)")),
        rows=tuple(
            (one.name, f"{one.direction:.4f}°", f"{one.k:.4f}") for one in measure_stretch()
        ),
    )

"""Figure 11: scaled η on plain meshes, and the Poisson error under refinement."""

from dataclasses import dataclass

import numpy as np

from app.document import Baseline
from app.motion import PreparedBaseline, discrete_harmonic, prepare_baseline
from app.paper_figures.measure import MeasuredMotion
from app.paper_figures.methods import MESH_ETA, ComparedMethod
from app.paper_figures.plots.paper_figure import FigureContext, PaperFigure
from app.paper_figures.shapes import Shape, ShapePair, beam, bend_points, make_sample_pair
from app.paper_figures.sheet import as_png, draw_panels
from app.texts import _
from engine.arrays import Complexes
from engine.maps import HarmonicMap

TIMES = (0.0, 0.25, 0.5, 0.75, 1.0)
TIME = 0.5
SIZES = (500, 2_000, 8_000)
SWIRL, WAVE = 1.1, 0.05  # radians in the middle; share of the height
TURN, SHEAR = 1.5, 0.15
CAPTION = _(
    "The scaled η variant on meshes. Two keyframes that are not harmonic are blended triangle "
    "by triangle, and a Poisson step makes the blend a map again. The table shows the relative "
    "change of the Jacobians by this step at t = 0.5. Between discrete harmonic maps (cotangent "
    "weights) of a bar, the change goes to zero as the triangles become smaller."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class PoissonError:
    """Mean square change by the Poisson step at t = 0.5, for a number of triangles."""

    name: str
    triangles: int
    error: float


def measure_errors(triangles: int) -> tuple[PoissonError, ...]:
    """Measure discrete harmonic keyframes on finer and finer meshes, then the swirled octopus."""
    found = []
    for size in SIZES:
        shape = beam(size)
        found.append(_measure_error(_("discrete harmonic bar"), shape, *_bent(shape)))
    octopus = _octopus(triangles)
    return (*found, _measure_error("octopus", octopus, *_swirled(octopus)))


def make_figure_11(studio: FigureContext) -> PaperFigure:
    shape = _octopus(studio.triangles)
    keyframes = _swirled(shape)
    still = HarmonicMap.identity(shape.domain.cage)
    method = ComparedMethod(
        name=MESH_ETA.name,
        colour=MESH_ETA.colour,
        prepare=lambda _pair: _prepared(shape, *keyframes).frame,
    )
    track = MeasuredMotion(ShapePair(shape=shape, first=still, second=still), method)
    panels = [(f"t = {time:g}", track, time) for time in TIMES]
    return PaperFigure(
        title=_("Meshes"),
        caption=CAPTION,
        picture=as_png(draw_panels(studio.renderer, panels, (13, 3))),
        column_names=("", _("triangles"), _("Poisson error")),
        rows=tuple(
            (loss.name, f"{loss.triangles:,}", f"{loss.error:.2e}")
            for loss in measure_errors(studio.triangles)
        ),
    )


def _octopus(triangles: int) -> Shape:
    return make_sample_pair("octopus", 0, 1, triangles).shape


def _swirled(shape: Shape) -> tuple[Complexes, Complexes]:
    """Return the mesh waved from side to side, and swirled about its middle, both non-harmonic."""
    rest = shape.domain.mesh.vertices
    height = float(np.ptp(rest.imag))
    middle = rest.mean()
    wave = WAVE * height * np.sin(2 * np.pi * (rest.imag - middle.imag) / height)
    angle = SWIRL * np.exp(-(np.abs(rest - middle) ** 2) / (0.35 * height) ** 2)
    return rest + wave, middle + (rest - middle) * np.exp(1j * angle)


def _bent(shape: Shape) -> tuple[Complexes, Complexes]:
    """Return the discrete harmonic maps that shear the border of a bar, and bend it."""
    rest = shape.domain.mesh.vertices
    offset = rest - rest.mean()
    domain = _prepared(shape, rest, rest).domain
    keys = (offset + SHEAR * offset.conj(), bend_points(offset, turn=TURN))
    first, second = (discrete_harmonic(domain, positions) for positions in keys)
    return first, second


def _prepared(shape: Shape, first: Complexes, second: Complexes) -> PreparedBaseline:
    mesh = shape.domain.mesh
    return prepare_baseline(Baseline.MESH_ETA, (first, second), mesh.vertices, mesh.triangles)


def _measure_error(name: str, shape: Shape, first: Complexes, second: Complexes) -> PoissonError:
    error = _prepared(shape, first, second).frame(TIME).poisson_error
    return PoissonError(name=name, triangles=len(shape.domain.mesh.triangles), error=error or 0.0)

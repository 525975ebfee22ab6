"""Figure 11: scaled η on plain meshes, and what is lost by that when they are made finer."""

from dataclasses import dataclass

import numpy as np

from app.cli.figures.methods import MESH_ETA, ComparedMethod
from app.cli.figures.plates.plate import Plate, Studio
from app.cli.figures.shapes import Shape, ShapePair, beam, bent, sample
from app.cli.figures.sheet import as_png, show_panels
from app.cli.figures.track import Tracked
from engine.arrays import Complexes
from engine.baselines import Baseline, PreparedBaseline, discrete_harmonic, prepare_baseline
from engine.maps import HarmonicMap

TIMES = (0.0, 0.25, 0.5, 0.75, 1.0)
TIME = 0.5
SIZES = (500, 2_000, 8_000)
SWIRL, WAVE = 1.1, 0.05  # radians in the middle, and of the height
TURN, SHEAR = 1.5, 0.15
CAPTION = (
    "The scaled η variant on meshes: two keyframes that are not harmonic, blended triangle by "
    "triangle, and made a map again by a Poisson step. The table has what that step changes of the "
    "Jacobians at t = 0.5, relative to them: between discrete harmonic maps (cotangent weights) of "
    "a bar it goes to zero as the triangles become smaller."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Loss:
    """What the Poisson step changes at t = 0.5, by the mean square, of so many triangles."""

    name: str
    triangles: int
    error: float


def measure(triangles: int) -> tuple[Loss, ...]:
    """Measure discrete harmonic keyframes on finer and finer meshes, then the swirled octopus."""
    found = []
    for size in SIZES:
        shape = beam(size)
        found.append(_loss("discrete harmonic bar", shape, *_bent(shape)))
    octopus = _octopus(triangles)
    return (*found, _loss("octopus", octopus, *_swirled(octopus)))


def make(studio: Studio) -> Plate:
    """Draw the figure."""
    shape = _octopus(studio.triangles)
    keyframes = _swirled(shape)
    still = HarmonicMap.identity(shape.domain.cage)
    method = ComparedMethod(
        name=MESH_ETA.name,
        colour=MESH_ETA.colour,
        prepare=lambda _: _prepared(shape, *keyframes).frame,
    )
    track = Tracked(ShapePair(shape=shape, first=still, second=still), method)
    panels = [(f"t = {time:g}", track, time) for time in TIMES]
    return Plate(
        title="Meshes",
        caption=CAPTION,
        picture=as_png(show_panels(studio.easel, panels, (13, 3))),
        heads=("", "triangles", "Poisson error"),
        rows=tuple(
            (loss.name, f"{loss.triangles:,}", f"{loss.error:.2e}")
            for loss in measure(studio.triangles)
        ),
    )


def _octopus(triangles: int) -> Shape:
    return sample("octopus", 0, 1, triangles).shape


def _swirled(shape: Shape) -> tuple[Complexes, Complexes]:
    """Return the mesh waved from side to side, and swirled about its middle; neither harmonic."""
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
    keys = (offset + SHEAR * offset.conj(), bent(offset, turn=TURN))
    first, second = (discrete_harmonic(domain, positions) for positions in keys)
    return first, second


def _prepared(shape: Shape, first: Complexes, second: Complexes) -> PreparedBaseline:
    mesh = shape.domain.mesh
    return prepare_baseline(Baseline.MESH_ETA, (first, second), mesh.vertices, mesh.triangles)


def _loss(name: str, shape: Shape, first: Complexes, second: Complexes) -> Loss:
    error = _prepared(shape, first, second).frame(TIME).poisson_error
    return Loss(name=name, triangles=len(shape.domain.mesh.triangles), error=error or 0.0)

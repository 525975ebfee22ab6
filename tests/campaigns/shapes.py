"""Random and degenerate shapes, dragged at random, with in-betweens of every variant.

Every map that would be shown is certified, and held against samples; no number is NaN; no frame
folds, nor distorts more than its keyframes or the bounds, but of the two variants that change
nothing. What fails is told by its kind and number, and the others are gone through all the same.
"""

import warnings
from collections.abc import Callable, Iterator
from operator import add
from time import process_time
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from app.cut_out import build_picture_domain
from engine.arrays import Complexes, Integers
from engine.deform import Deformer, Handles
from engine.domain import mesh_inside
from engine.errors import EngineError
from engine.geometry import Domain
from engine.interpolation import prepare
from engine.maps import Boundary, Bounds, HarmonicMap
from engine.variant import Variant
from tests.campaigns.slowest import timed

CANVAS = 160
TRIANGLES = 1500
STEPS = 10  # of a drag, each of which is shown
BOUNDS = (
    Bounds(),
    Bounds(k=0.3, sigma_a=1.5, sigma_b=0.7),
    Bounds(k=0.99, sigma_a=50.0, sigma_b=0.02),
)
SCALES = (1.0, 1.0, 1.0, 1e-6, 1e6)
SAMPLES = 4000  # of the outline, against which a certificate is held
ROUNDING = 1e-9
EXCESS = 1e-6  # of k in in-betweens
TOLD_EVERY = 25  # shapes
PARTS = 8  # into which the sides of a triangle are cut
UNBOUNDED = {Variant.LINEAR, Variant.ETA}  # which change no bounds


class Shape(NamedTuple):
    """What is deformed: its outline and cage, and a mesh of it."""

    outline: Complexes
    cage: Complexes
    vertices: Complexes
    triangles: Integers


Maker = Callable[[np.random.Generator, int], Shape]


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Drag so many shapes, and yield the figures of each kind of them, also on the way."""
    failures: list[str] = []
    # A number that is none is told here already.
    warnings.simplefilter("error")
    for name, (make, share, extremes) in KINDS.items():
        count = max(1, round(share * amount))
        total: dict[str, float] = {}
        for number in timed(range(count)):
            try:
                layers = shape_layers(seed, name, make, number, extremes)
            except Exception as error:  # noqa: BLE001 - told below
                failures.append(f"{name} shape {number}: {type(error).__name__}: {error}")
                print(f"  {failures[-1]}", flush=True)
                layers = {"failed": 1.0}
            for label, value in layers.items():
                together = max if label.startswith("most") else add
                total[label] = together(total.get(label, 0.0), value)
            if (number + 1) % TOLD_EVERY == 0 or number + 1 == count:
                yield f"{name} shapes, {number + 1} of {count}", total
    assert not failures, "\n".join(failures)


def shape_layers(
    seed: int, name: str, make: Maker, number: int, extremes: dict[str, int]
) -> dict[str, float]:
    """Return what came of one shape."""
    rng = np.random.default_rng([seed, number, len(name)])
    begun = process_time()
    try:
        shape = make(rng, number)
    except EngineError:
        return {"refused in words": 1.0}
    layers = stress(shape, rng, **extremes)
    return {"shapes": 1.0, **layers, "seconds of the processor": process_time() - begun}


def stress(
    shape: Shape, rng: np.random.Generator, *, handles: int = 0, keys: int = 3
) -> dict[str, float]:
    """Drag a shape to some keyframes, and look at the in-betweens of every variant."""
    bounds = BOUNDS[rng.integers(len(BOUNDS))]
    scale = SCALES[rng.integers(len(SCALES))]
    outline, cage, vertices = (scale * each for each in shape[:3])
    boundary = Boundary.sample(Domain(outline, cage))
    count = handles or int(rng.integers(1, 9))
    inside = rng.choice(vertices, size=min(count, len(vertices)), replace=False)
    deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, inside), bounds=bounds)
    size = np.ptp(outline.real) + np.ptp(outline.imag)
    state, shown, maps = deformer.start(), 0, []
    for _ in range(keys):
        to = inside + 0.4 * size * rng.normal(size=len(inside)) * np.exp(1j * rng.uniform(0, 6.3))
        wish = deformer.handles.targets(to)
        for _ in range(STEPS if keys < 50 else 1):
            state = deformer.step(state, wish)
            check_state(deformer, state, bounds)
            shown += 1
        maps.append(state.map)
    scaled = Shape(boundary.outline, cage, vertices, shape.triangles)
    layers = in_betweens(maps, boundary, scaled, bounds, rng)
    return {"maps shown": shown, **layers}


def check_state(deformer: Deformer, state: object, bounds: Bounds) -> None:
    """Hold the certificate of a state against samples of its map on the outline."""
    certificate = state.certificate
    assert certificate.is_certified
    assert bounds.allow(k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b)
    outline = deformer.boundary.outline
    each = max(2, SAMPLES // len(outline))
    side = np.roll(outline, -1) - outline
    points = (outline[:, None] + side[:, None] * np.arange(each) / each).ravel()
    a, b = (np.abs(values) for values in state.map.derivatives(points))
    assert np.isfinite(a).all()
    assert np.isfinite(b).all()
    assert (b / a).max() <= certificate.k + ROUNDING
    assert (a + b).max() <= certificate.sigma_a * (1 + ROUNDING)
    assert (a - b).min() >= certificate.sigma_b * (1 - ROUNDING)


def in_betweens(
    maps: list[HarmonicMap],
    boundary: Boundary,
    shape: Shape,
    bounds: Bounds,
    rng: np.random.Generator,
) -> dict[str, float]:
    """Return how many frames were looked at, and how many of those fold that may."""
    count = folds = coarse = 0
    excess = 0.0
    for variant in Variant:
        through = bool(rng.integers(2))
        options = {"variant": variant, "through": through}
        options["bounds"] = bounds
        prepared = prepare(maps, boundary, shape.vertices, triangles=shape.triangles, **options)
        for time in [*rng.uniform(0, len(maps) - 1, 3), float(len(maps) - 1)]:
            frame = prepared.frame(time)
            assert np.isfinite(frame.positions).all()
            a, b = np.abs(frame.fz), np.abs(frame.fzbar)
            assert np.isfinite(a - b).all()
            # As they are drawn.
            turned = areas(frame.positions.astype(np.complex64), shape.triangles) <= 0
            count += 1
            if variant in UNBOUNDED:
                folds += bool((b >= a).any() or turned.any())
                continue
            excess = max(excess, float((b / a).max()) - bounds.k)
            assert excess <= EXCESS, f"{variant} distorts {excess:.2g} beyond the bound at {time}"
            if turned.any():
                # The map does not fold, but between the corners it bends more than they tell.
                coarse += 1
                points, triangles = cut(shape.vertices[shape.triangles[turned]])
                finer = prepare(maps, boundary, points, **options).frame(time).positions
                assert (areas(finer, triangles) > 0).all(), f"{variant} folds at {time}"
    return {
        "frames": count,
        "folds of variants without bounds": folds,
        "frames whose mesh is too coarse": coarse,
        "most beyond the bound on k": excess,
    }


def cut(corners: Complexes) -> tuple[Complexes, Integers]:
    """Return the points and the triangles that some triangles (m, 3) are cut into."""
    places = [(i, j) for i in range(PARTS + 1) for j in range(PARTS + 1 - i)]
    i, j = np.array(places).T
    points = corners @ np.stack([PARTS - i - j, i, j]) / PARTS
    number = {place: n for n, place in enumerate(places)}
    corner = [(i, j) for i, j in places if i + j < PARTS]
    inner = [(i, j) for i, j in corner if i + j < PARTS - 1]
    small = [[number[i, j], number[i + 1, j], number[i, j + 1]] for i, j in corner]
    small += [[number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]] for i, j in inner]
    starts = len(places) * np.arange(len(corners))
    return points.ravel(), (starts[:, None, None] + np.array(small)).reshape(-1, 3)


def areas(positions: Complexes, triangles: Integers) -> np.ndarray:
    """Return the signed areas of triangles, relative to the largest."""
    a, b, c = positions[triangles].T
    doubled = ((b - a).conj() * (c - a)).imag
    return doubled / np.abs(doubled).max()


def drawn_shape(rng: np.random.Generator, number: int) -> Shape:
    """Return the domain of a picture of random blobs and limbs."""
    image = Image.new("L", (CANVAS, CANVAS))
    draw = ImageDraw.Draw(image)
    centre = rng.uniform(50, 110, 2)
    for _ in range(rng.integers(1, 5)):
        radii = rng.uniform(8, 35, 2)
        draw.ellipse((*(centre - radii), *(centre + radii)), fill=255)
        end = np.clip(centre + rng.normal(0, 45, 2), 4, CANVAS - 4)
        draw.line((*centre, *end), fill=255, width=int(rng.integers(2, 22)))
        centre = end
    return pictured(np.asarray(image), "coarse" if number % 2 else "normal")


def pictured(grey: np.ndarray, detail: str) -> Shape:
    """Return the domain of a mask."""
    rgba = np.zeros((*grey.shape, 4), dtype=np.uint8)
    rgba[..., 3] = grey
    domain, _ = build_picture_domain(rgba, triangles=TRIANGLES, detail=detail)
    return Shape(domain.outline, domain.cage, domain.mesh.vertices, domain.mesh.triangles)


def degenerate_shape(rng: np.random.Generator, number: int) -> Shape:
    """Return a triangle, a sliver, islands of one pixel, limbs of one pixel, or needles."""
    match number % 5:
        case 0:
            return polygon(np.array([0, 1, 0.5 + rng.uniform(0.01, 1.0) * 1j]))
        case 1:
            return polygon(np.array([0, 1, 1 + 0.02j, 0.02j]) + rng.normal(0, 0.003, 4))
        case 2:
            grey = np.zeros((40, 40), dtype=np.uint8)
            grey[tuple(rng.integers(2, 38, (2, 9)))] = 255
            # Alone they are refused.
            grey[12:28, 12:28] = 255 * (number % 10 > 2)
            return pictured(grey, "fine")
        case 3:
            grey = np.zeros((120, 120), dtype=np.uint8)
            grey[50:70, 50:70] = 255
            grey[60, 5:115] = 255
            grey[5:115, 60 : 60 + rng.integers(1, 3)] = 255
            return pictured(grey, "fine")
    spikes = 2 * int(rng.integers(3, 9))
    radii = np.where(np.arange(spikes) % 2, 1.0, rng.uniform(0.05, 0.3))
    return polygon(radii * np.exp(2j * np.pi * np.arange(spikes) / spikes))


def polygon(corners: Complexes) -> Shape:
    """Return the domain of a polygon, its cage at a distance from it, without more vertices."""
    turned = corners if _area(corners) > 0 else corners[::-1]
    along = np.roll(turned, -1) - turned
    normals = -1j * along / np.abs(along)
    before = np.roll(normals, 1)
    # Parallel to each side, at the same distance from it.
    corner = (normals + before) / (1 + (normals * before.conj()).real)
    cage = turned + 0.02 * np.abs(along).min() * corner
    mesh = mesh_inside(Domain(turned, cage), triangles=TRIANGLES)
    return Shape(turned.astype(complex), cage, mesh.vertices, mesh.triangles)


def _area(corners: Complexes) -> float:
    return float((corners.conj() * np.roll(corners, -1)).imag.sum())


# Of each kind its maker, its share of the amount, and what is extreme about it.
KINDS: dict[str, tuple[Maker, float, dict[str, int]]] = {
    "drawn": (drawn_shape, 0.8, {}),
    "degenerate": (degenerate_shape, 0.18, {}),
    "300 handles": (drawn_shape, 0.01, {"handles": 300}),
    "200 keyframes": (drawn_shape, 0.004, {"keys": 200}),
}

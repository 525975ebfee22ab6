"""Domains and keyframes for the tests of the interpolation."""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import shapely

from engine.arrays import Complexes
from engine.dirichlet import Extension, HilbertTransform
from engine.geometry import Domain
from engine.geometry.polygon import as_xy, diameter, edge_vectors, sample_graded
from engine.interpolation import (
    Inbetweens,
    KeyframeBlend,
    KeyframeSegment,
    SampledDomain,
    Variant,
    prepare_inbetweens,
    sample_domain,
    sample_keyframes,
)
from engine.maps import Boundary, Bounds
from engine.maps.cauchy import evaluate
from engine.maps.harmonic_map import HarmonicMap
from engine.paths import root_sheets

Shape = tuple[Complexes, Complexes]
NOWHERE = np.empty(0, dtype=np.complex128)


def subdivided(polygon, longest):
    """Cut the edges of a polygon into equal parts no longer than `longest`."""
    parts = [
        start + side * np.arange(n) / n
        for start, side in zip(polygon, edge_vectors(polygon), strict=True)
        for n in [int(np.ceil(abs(side) / longest))]
    ]
    return np.concatenate(parts)


def around(outline, offset):
    """Return the cage at a distance of `offset` around a polygon, with as many vertices."""
    direction = edge_vectors(outline) / np.abs(edge_vectors(outline))
    before = np.roll(direction, 1)
    half = np.sqrt(direction / before)
    return outline - 1j * before * half * offset / half.real


@cache
def bar(longest: float = 0.5) -> Shape:
    outline = subdivided(np.array([-2, 2, 2 + 1j, -2 + 1j]) - 0.5j, longest)
    return outline, around(outline, 0.06)


@cache
def letter_l() -> Shape:
    corners = np.array([0, 3, 3 + 1j, 1 + 1j, 1 + 3j, 3j])
    outline = subdivided(corners, 0.55)
    return outline, around(outline, 0.05)


@cache
def narrow_u(gap: float = 0.04) -> Shape:
    """Two legs with a narrow gap between them."""
    g = gap / 2
    corners = np.array([-1, 1, 1 + 2j, g + 2j, g + 0.6j, -g + 0.6j, -g + 2j, -1 + 2j])
    outline = subdivided(corners, 0.3)
    return outline, around(outline, 0.35 * gap)


@cache
def spiral(turns: float = 2.3) -> Shape:
    """An arm that winds around itself, with gaps a third of its width."""
    angle = np.linspace(np.pi, 2 * np.pi * turns, 32)
    pitch = 0.2
    middle = pitch * angle / (2 * np.pi) * np.exp(1j * angle)
    normal = np.gradient(middle)
    normal = 1j * normal / np.abs(normal)
    width = 0.36 * pitch
    outline = np.concatenate([middle - width * normal, (middle + width * normal)[::-1]])
    return outline, around(outline, 0.01)


def boundary_of(shape: Shape) -> Boundary:
    """Sample the boundary of a shape, once."""
    return _boundary(*(z.tobytes() for z in shape))


@cache
def _boundary(outline: bytes, cage: bytes) -> Boundary:
    return Boundary.sample(Domain(np.frombuffer(outline, complex), np.frombuffer(cage, complex)))


@dataclass(frozen=True, eq=False)
class Stage:
    """A shape and the points at which in-betweens are wanted, ready for any keyframes."""

    sites: SampledDomain

    @property
    def transform(self) -> HilbertTransform:
        """Of the shape, made once."""
        return transform_of((self.sites.outline, self.sites.cage))

    @cached_property
    def extension(self) -> Extension:
        """At the sites; only the metric variant needs it."""
        return self.transform.at(self.sites.paths.nodes)

    def between(self, maps, variant, bounds: Bounds = Bounds()) -> Inbetweens:
        """Return the in-betweens of two keyframes, as `prepare` does."""
        variant = Variant(variant)
        keys = sample_keyframes(maps, self.sites)
        sheets = root_sheets(np.array([key.anchor_fz for key in keys]))
        extension = self.extension if variant.needs_transform else None
        interval = KeyframeSegment(self.sites, KeyframeBlend.of(keys, sheets), bounds, extension)
        return prepare_inbetweens(variant, interval)


def transform_of(shape: Shape) -> HilbertTransform:
    """Prepare the Hilbert transform of a shape, once."""
    return _transform(*(z.tobytes() for z in shape))


@cache
def _transform(outline: bytes, cage: bytes) -> HilbertTransform:
    return HilbertTransform.on(_boundary(outline, cage).domain)


@cache
def _stage(
    outline: bytes, cage: bytes, points: bytes, values_at: bytes, anchor: complex | None
) -> Stage:
    places, beside = (np.frombuffer(each, complex) for each in (points, values_at))
    boundary = _boundary(outline, cage)
    return Stage(sample_domain(boundary, places, anchor=anchor, values_at=beside))


def stage_of(
    shape: Shape,
    points: Complexes,
    anchor: complex | None = None,
    values_at: Complexes = NOWHERE,
) -> Stage:
    """Return the stage of a shape and points, which is prepared once."""
    arrays = (*shape, points, values_at)
    return _stage(*(z.tobytes() for z in arrays), anchor)


def outline_samples(shape: Shape) -> Complexes:
    outline, cage = shape
    return sample_graded(outline, cage, ratio=0.3, longest=diameter(outline) / 300)


def scattered_on(outline: Complexes, count: int) -> Complexes:
    """Return points of an outline in order: its vertices, and irrational places on every edge.

    None of the latter is where an engine that halves edges samples them.
    """
    golden = (np.sqrt(5) - 1) / 2
    places = np.sort(np.arange(count) * golden % 1.0)
    return (outline[:, None] + edge_vectors(outline)[:, None] * places).ravel()


def inner_points(outline, count, seed, *, margin=0.0):
    """Return random points inside a polygon."""
    rng = np.random.default_rng(seed)
    room = shapely.Polygon(as_xy(outline)).buffer(-margin)
    x0, y0, x1, y1 = room.bounds
    found = np.empty(0, dtype=complex)
    while len(found) < count:
        z = rng.uniform(x0, x1, 4 * count) + 1j * rng.uniform(y0, y1, 4 * count)
        found = np.concatenate([found, z[shapely.contains_xy(room, z.real, z.imag)]])
    return found[:count]


def distortion_of(f, points):
    fz, fzbar = f.derivatives(points)
    return np.abs(fz) + np.abs(fzbar), np.abs(fz) - np.abs(fzbar), np.abs(fzbar) / np.abs(fz)


def bent(shape, *, bend=0.0, stretch=1.0, turn=0.0, shift=0j):
    """Bend a shape along its length by `bend` radians a unit, and stretch it across."""
    _, cage = shape
    rotation = np.exp(1j * turn)
    along = cage if bend == 0 else (np.exp(1j * bend * cage) - 1) / (1j * bend)
    phi = rotation * (1 + stretch) / 2 * along + shift
    psi = np.conj(rotation) * (1 - stretch) / 2 * cage
    return HarmonicMap(cage=cage, phi=phi, psi=psi)


def random_map(shape, seed, *, k=0.5, bend=1.0):
    """Return a random map without folds: k below the bound on the outline, and winding number 0.

    A conformal bend is disturbed at random, and the disturbance shrunk until the bounds hold.
    """
    outline, cage = shape
    rng = np.random.default_rng(seed)
    size = diameter(outline)
    turn, shift = rng.uniform(-3, 3), complex(*rng.normal(size=2))
    base = bent(shape, bend=bend * rng.uniform(-1, 1), turn=turn, shift=shift)
    place = 2 * (cage - cage.mean()) / size
    noise = rng.normal(size=(4, 6)) + 1j * rng.normal(size=(4, 6))
    smooth = noise[:2] @ (place ** np.arange(6)[:, None]) / 6
    rough = (rng.normal(size=(2, len(cage))) + 1j * rng.normal(size=(2, len(cage)))) / len(cage)
    d_phi, d_psi = size * (smooth + rough)
    samples = outline_samples(shape)
    for amount in 0.5 * 0.7 ** np.arange(30):
        f = HarmonicMap(cage=cage, phi=base.phi + amount * d_phi, psi=base.psi + amount * d_psi)
        (slopes,) = evaluate(cage, np.column_stack([f.phi, f.psi]), samples, orders=(1,))
        fz, g = slopes.T
        turns = np.angle(np.roll(fz, -1) / fz)
        bounded = np.all(np.abs(g) <= k * np.abs(fz))
        if bounded and np.abs(turns).max() < 1 and abs(turns.sum()) < 1:
            return f
    raise AssertionError(f"no map for seed {seed}")

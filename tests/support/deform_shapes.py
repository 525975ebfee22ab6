"""Shapes, handles and probes for the tests of the deformer."""

from functools import cache

import numpy as np
from interpolation_shapes import around, subdivided

from engine.deform import Deformer, Handles, Objective, State
from engine.deform.interior_point.continuation import advance_search, begin_search
from engine.deform.interior_point.search import Search, StartingPoint
from engine.deform.model.barrier import MARGIN
from engine.geometry import Domain
from engine.maps import Boundary, Bounds


@cache
def star_boundary() -> Boundary:
    """A star with five arms."""
    radii = np.tile([1.0, 0.42], 5)
    corners = radii * np.exp(1j * (np.pi / 2 + np.pi / 5 * np.arange(10)))
    outline = subdivided(corners, 0.35)
    return Boundary.sample(Domain(outline, around(outline, 0.035)))


@cache
def bar_boundary() -> Boundary:
    outline = subdivided(np.array([-2 - 0.5j, 2 - 0.5j, 2 + 0.5j, -2 + 0.5j]), 0.5)
    return Boundary.sample(Domain(outline, around(outline, 0.06)))


STAR_POINTS = np.concatenate([[0.0], 0.8 * np.exp(1j * np.pi * (0.5 + 0.4 * np.arange(5)))])
BAR_POINTS = np.array([-1.8, 0.0, 1.8])


def star(bounds: Bounds = Bounds()) -> Deformer:
    boundary = star_boundary()
    return Deformer(boundary=boundary, handles=Handles.place(boundary, STAR_POINTS), bounds=bounds)


def bar(bounds: Bounds = Bounds()) -> Deformer:
    boundary = bar_boundary()
    return Deformer(boundary=boundary, handles=Handles.place(boundary, BAR_POINTS), bounds=bounds)


ARCHED = BAR_POINTS + np.array([0, 1j, 0])
TIGHT = Bounds(k=0.2, sigma_a=1.5, sigma_b=0.6)
TWISTED = STAR_POINTS * np.exp(1j * np.array([0, 0.7, -0.5, 0.6, -0.8, 0.4]))


def settle(deformer: Deformer, targets) -> State:
    """Return the pose of least energy for targets, from the shape at rest."""
    return deformer.settle(deformer.start(), deformer.handles.targets(targets))[0]


@cache
def settled_star() -> State:
    """The star, twisted within tight bounds."""
    return settle(star(TIGHT), TWISTED)


@cache
def arched_bar() -> State:
    """The bar with its middle pulled up within the default bounds."""
    return settle(bar(), ARCHED)


def search_from_rest(
    steps: int, way: StartingPoint = StartingPoint.REST, bounds: Bounds = TIGHT
) -> Search:
    """Return the search for a twisted star within bounds after some steps."""
    deformer = star(bounds)
    first = deformer.start()
    search = begin_search(
        Objective(
            boundary=deformer.boundary,
            handles=deformer.handles,
            targets=deformer.handles.targets(TWISTED),
        ),
        first.map,
        first.certificate,
        inside=bounds.towards_identity(MARGIN),
        limits=bounds,
        way=way,
    )
    for _ in range(steps):
        search = advance_search(search)
    return search


def dense_outline(boundary: Boundary, count: int = 30_000):
    """Return about `count` samples, the vertices among them."""
    outline = boundary.outline
    each = count // len(outline)
    side = np.roll(outline, -1) - outline
    return (outline[:, None] + side[:, None] * np.arange(each) / each).ravel()


def extremes(harmonic_map, points):
    """Return the largest k and sigma_a and the smallest sigma_b at points."""
    fz, fzbar = harmonic_map.derivatives(points)
    a, b = np.abs(fz), np.abs(fzbar)
    return (b / a).max(), (a + b).max(), (a - b).min()


def assert_sound(state, bounds):
    """Hold a state's map against 30,000 samples of the outline and some inside."""
    boundary, certificate = state.boundary, state.certificate
    assert certificate.is_certified
    assert certificate.winding == 0
    assert bounds.allow(k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b)
    outline = dense_outline(boundary)
    # Star-shaped about the origin: scaled outlines are inside.
    inside = np.concatenate([r * boundary.outline for r in (0.2, 0.5, 0.8, 0.97)])
    k, sigma_a, sigma_b = extremes(state.map, np.concatenate([outline, inside]))
    assert k <= certificate.k
    assert sigma_a <= certificate.sigma_a
    assert sigma_b >= certificate.sigma_b
    fz, _ = state.map.derivatives(outline)
    assert abs(np.angle(np.roll(fz, -1) / fz).sum()) < 1e-6

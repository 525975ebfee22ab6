"""Shapes that are stiffer, or softer, in places."""

import re

import numpy as np
import pytest
from deform_shapes import (
    BAR_POINTS,
    STAR_POINTS,
    TWISTED,
    bar_boundary,
    dense_outline,
    star_boundary,
)
from holed_shapes import boundary_of, inner_points, plate
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from engine.deform import BoundedPull, Deformer, Handles, Objective, limits_inside
from engine.deform.model.inner_limits import _continued
from engine.dirichlet import HilbertTransform
from engine.errors import EngineError
from engine.geometry import Domain
from engine.maps import Boundary, Bounds, certify
from engine.maps.stiffness import STIFFNESS_RANGE, STIFFNESS_SHAPE

BAR, STAR = bar_boundary(), star_boundary()
WIDE = Bounds(k=0.9, sigma_a=8.0, sigma_b=0.1)
SOME = Bounds(k=0.6, sigma_a=3.0, sigma_b=0.4)
# The ends of a bar turn, and its middle is stiff.
BENT = np.array([-1.6 + 0.9j, 0.0, 1.6 + 0.9j])
BOWED = STAR_POINTS + np.array([0, 0, 0.2j, 0, 0, 0.2j])
MIDDLE = np.exp(np.log(100) * np.clip(1.6 - np.abs(BAR.outline.real), 0.0, 1.0))


def settled(boundary, points, targets, bounds=WIDE, hands=()):
    handles = Handles.place(boundary, points)
    deformer = Deformer(boundary=boundary, handles=handles, bounds=bounds)
    handle_targets = handles.targets(targets, None, hands)
    state, _ = deformer.settle(deformer.start(), handle_targets)
    assert state.certificate.is_certified
    return deformer, state


def test_a_stiffness_of_one_changes_no_bit():
    ends, hands = BAR_POINTS[[0, 2]], (BoundedPull([1]),)
    _, plain = settled(BAR, ends, BENT[[0, 2]], SOME, hands)
    same = BAR.stiffened(np.ones(len(BAR.outline)))
    _, other = settled(same, ends, BENT[[0, 2]], SOME.scaled_by_stiffness(same), hands)
    assert_array_equal(plain.map.coefficients, other.map.coefficients)
    assert plain.statistics == other.statistics
    assert SOME.scaled_by_stiffness(same) is SOME


def test_stiffness_is_logarithmically_linear_along_edges_and_refined_so():
    given = np.linspace(1 / 30, 100.0, len(STAR.outline))
    stiff = STAR.stiffened(given)
    corners = np.flatnonzero(np.isin(STAR.points, STAR.outline))
    assert_allclose(stiff.stiffness[corners], given, rtol=1e-9)
    for i, first in enumerate(corners):
        last = corners[i + 1] if i + 1 < len(corners) else len(STAR.points)
        side = np.roll(STAR.outline, -1)[i] - STAR.outline[i]
        along = ((STAR.points[first:last] - STAR.outline[i]) / side).real
        wanted = np.log(given[i]) * (1 - along) + np.log(np.roll(given, -1)[i]) * along
        assert_allclose(np.log(stiff.stiffness[first:last]), wanted, atol=1e-9)
    assert_allclose(stiff.weights, STAR.weights * stiff.stiffness, rtol=1e-15)
    assert_allclose(stiff.lengths, STAR.weights, rtol=1e-15)
    finer = stiff.refined(np.array([0, 3]))
    assert_allclose(finer.stiffness[1], np.sqrt(np.prod(stiff.stiffness[:2])))
    assert finer.mean_stiffness == pytest.approx(stiff.mean_stiffness)


def test_the_same_stiffness_everywhere_is_the_same_problem():
    """Energy and handles are multiplied alike: the minimum stays."""
    _, plain = settled(STAR, STAR_POINTS, TWISTED)
    boundary = STAR.stiffened(np.full(len(STAR.outline), 20.0))
    deformer, stiff = settled(boundary, STAR_POINTS, TWISTED)
    assert_allclose(deformer.handles.around, 20.0)
    at = STAR.outline
    assert_allclose(stiff.map(at), plain.map(at), atol=2e-4)
    assert stiff.statistics.energy == pytest.approx(plain.statistics.energy, rel=1e-4)
    assert stiff.statistics.objective == pytest.approx(20 * plain.statistics.objective, rel=1e-4)


def test_the_gradient_is_that_of_the_weighted_energy():
    rng = np.random.default_rng(3)
    boundary = STAR.stiffened(np.exp(rng.uniform(-3, 4, len(STAR.outline))))
    handles = Handles.place(boundary, STAR_POINTS)
    objective = Objective(boundary=boundary, handles=handles, targets=handles.targets(TWISTED))
    count = 4 * boundary.basis.shape[1] - 2
    shift = 0.002 * rng.normal(size=count)
    phi, psi = objective.coefficients(shift)
    jet = objective.evaluate(boundary.cage + phi, psi)
    a, b = jet.a, jet.b
    density = (a**2 + b**2) * (1 + (a**2 - b**2) ** -2)
    held = handles.stiffness @ np.abs(jet.positions - TWISTED) ** 2
    energy = (STAR.weights * boundary.stiffness) @ density + held
    assert objective.energy(jet) == pytest.approx(energy, rel=1e-12)
    gradient = objective.gradient(jet, objective.radial_derivatives(jet))
    for _ in range(4):
        direction = rng.normal(size=count)
        change, step = objective.evaluate_change(direction), 1e-6
        ahead, behind = (objective.energy(jet.advanced(by, change)) for by in (step, -step))
        assert (ahead - behind) / (2 * step) == pytest.approx(gradient @ direction, rel=1e-5)


def test_a_stiff_middle_is_distorted_less_than_60_percent():
    middle = dense_outline(BAR, 4000)
    middle = middle[np.abs(middle.real) < 0.7]
    points, targets = (
        np.array([-1.8 + 0.3j, -1.8 - 0.3j, 1.8]),
        [-1.8 + 0.3j, -1.8 - 0.3j, 1.5 + 1j],
    )
    distortions = []
    for boundary in (BAR, BAR.stiffened(MIDDLE)):
        _, state = settled(boundary, points, targets)
        fz, fzbar = state.map.derivatives(middle)
        distortions.append([np.std(fz), np.abs(fzbar).mean()])
    usual, stiff = np.array(distortions)
    assert (stiff < 0.6 * usual).all()


def test_handles_miss_no_more_where_it_is_stiff():
    boundary = BAR.stiffened(MIDDLE)
    usual, stiff = (
        np.abs(deformer.positions(state) - BENT)
        for deformer, state in (settled(b, BAR_POINTS, BENT) for b in (BAR, boundary))
    )
    assert stiff.max() <= usual.max()


def test_hands_pull_as_much_more_strongly_as_what_they_hold_is_stiff():
    boundary = BAR.stiffened(np.full(len(BAR.outline), 10.0))
    for of in (BAR, boundary):
        handles = Handles.place(of, BAR_POINTS)
        far = handles.targets(np.array([-1.8, 0.0, 4.0]), None, [BoundedPull([2])])
        assert_allclose(far.pulls.huber_thresholds, BoundedPull([2]).max_force * of.size / 2e4)
    assert_allclose(boundary.stiffness_around(BAR_POINTS)[1], 10.0)


def test_the_mean_around_a_point_is_that_of_what_is_near():
    boundary = BAR.stiffened(MIDDLE)
    around, quadratic = boundary.stiffness_around(np.array([0.0, -1.9, 0.49j, -1.99 - 0.49j]))
    assert (around[[0, 2]] > [60, 95]).all()
    assert (around[[1, 3]] < [5, 1.5]).all()
    assert (around <= quadratic).all()
    assert np.isfinite(boundary.stiffness_around(boundary.points)).all()


def test_stiff_shapes_that_are_turned_and_enlarged_deform_alike():
    factor, shift = 3.0 * np.exp(0.7j), 5 - 2j
    stiffness = np.exp(np.log(30) * np.sin(np.arange(len(STAR.outline))))
    larger = Boundary.sample(Domain(factor * STAR.outline + shift, factor * STAR.cage + shift))
    bounds = Bounds(k=0.3, sigma_a=1.8, sigma_b=0.5)
    placed = []
    for base, by, moved in ((STAR, 1.0, 0.0), (larger, factor, shift)):
        boundary = base.stiffened(stiffness)
        limits = bounds.scaled_by_stiffness(boundary)
        _, state = settled(boundary, by * STAR_POINTS + moved, by * BOWED + moved, limits)
        placed.append((state.map(by * STAR.outline + moved) - moved) / by)
    assert_allclose(placed[0], placed[1], atol=2e-4)


COUNT = len(STAR.outline)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (np.ones(3), says(STIFFNESS_SHAPE, count=COUNT)),
        (np.ones(COUNT, complex), "complex128"),
        (np.full(COUNT, np.nan), says(STIFFNESS_RANGE, value=float("nan"), vertex=0)),
        (np.full(COUNT, 101.0), says(STIFFNESS_RANGE, value=101, vertex=0)),
        (np.where(np.arange(COUNT) == 7, 0.0, 1.0), says(STIFFNESS_RANGE, value=0, vertex=7)),
        (
            np.where(np.arange(COUNT) == 7, -np.inf, 1.0),
            says(STIFFNESS_RANGE, value=float("-inf"), vertex=7),
        ),
    ],
)
def test_other_numbers_are_refused(wrong, said):
    with pytest.raises(EngineError, match="stiffness must be") as refused:
        STAR.stiffened(wrong)
    assert re.search(said, str(refused.value))


def test_limits_where_it_is_stiff_hold_between_the_samples_too():
    boundary = STAR.stiffened(
        np.exp(np.log(60) * (STAR.outline.real > 0) * np.minimum(2 * STAR.outline.real, 1))
    )
    local = SOME.scaled_by_stiffness(boundary)
    _, state = settled(boundary, STAR_POINTS, BOWED, local)
    along = np.linspace(0, 1, 12, endpoint=False)
    following = boundary.next_samples
    points = boundary.points[:, None] * (1 - along) + boundary.points[following, None] * along
    logs = np.log(boundary.stiffness)
    stiffness = np.exp(logs[:, None] * (1 - along) + logs[following, None] * along)
    points, root = points.ravel(), np.sqrt(np.maximum(stiffness.ravel(), 1))
    assert len(points) > 5000
    fz, fzbar = state.map.derivatives(points)
    a, b = np.abs(fz), np.abs(fzbar)
    k, sigma_a, sigma_b = b / a * root, np.log(a + b) * root, np.log(a - b) * root
    assert (k <= SOME.k).all()
    assert (sigma_a <= np.log(SOME.sigma_a)).all()
    assert (sigma_b >= np.log(SOME.sigma_b)).all()
    # They press somewhere, and the stiff half keeps less than is allowed elsewhere.
    assert max((k / SOME.k).max(), (sigma_a / np.log(SOME.sigma_a)).max()) > 0.9
    transform = HilbertTransform.on(Domain(STAR.outline, STAR.cage))
    rng = np.random.default_rng(1)
    inside = np.concatenate([r * boundary.points for r in rng.uniform(0.05, 0.98, 4)])
    within = limits_inside(transform, boundary, SOME, inside)
    fz, fzbar = state.map.derivatives(inside)
    a, b = np.abs(fz), np.abs(fzbar)
    assert within.allow(k=b / a, sigma_a=a + b, sigma_b=a - b)
    assert within.k.min() < 0.2 * SOME.k < within.k.max()


def test_segments_keep_what_their_stiffer_end_allows():
    stiffness = np.ones(len(BAR.outline))
    stiffness[4] = 50.0
    boundary = BAR.stiffened(stiffness)
    local, following = SOME.scaled_by_stiffness(boundary), boundary.next_samples
    root = np.sqrt(np.maximum(boundary.stiffness, boundary.stiffness[following]))
    of_segments = np.maximum(local.k, local.k[following])
    assert (of_segments <= SOME.k / root * (1 + 1e-12)).all()
    soft = BAR.stiffened(1 / np.maximum(stiffness / 2, 1.0))
    assert SOME.scaled_by_stiffness(soft) is SOME


def test_logarithms_of_limits_go_on_into_shapes_with_holes():
    shape, boundary = plate(), boundary_of("plate", 3)
    transform = HilbertTransform.on(boundary.domain)

    def harmonic(z):
        return np.column_stack([np.log(np.abs(z - boundary.holes[1].centre)), (z**2).real])

    points = inner_points(shape, 100)
    continued = _continued(transform, boundary, harmonic(transform.nodes), points)
    assert_allclose(continued, harmonic(points), atol=1e-7)
    stiff = boundary.stiffened(np.full(len(np.concatenate(boundary.loops)), 4.0))
    inside = limits_inside(transform, stiff, SOME, points)
    assert_allclose(inside.k, SOME.k / 2, rtol=1e-7)
    assert_allclose(np.log(inside.sigma_b), np.log(SOME.sigma_b) / 2, rtol=1e-7)


def test_a_pose_beyond_new_limits_begins_a_drag_that_is_free_elsewhere():
    _, bent = settled(BAR, BAR_POINTS, BENT)
    boundary = BAR.stiffened(MIDDLE)
    limits = WIDE.scaled_by_stiffness(boundary)
    deformer = Deformer(
        boundary=boundary, handles=Handles.place(boundary, BAR_POINTS), bounds=limits
    )
    assert not certify(bent.map, boundary, limits).is_certified
    allowed = deformer.widened_for(bent.map, 0.02)
    state = allowed.start(bent.map)
    assert state.certificate.is_certified
    assert allowed.bounds.include(limits)
    # Only about where it is beyond.
    assert (allowed.bounds.k < 0.5 * WIDE.k).any()
    assert allowed.widened_for(bent.map, 0.02) is allowed
    state, _ = deformer.settle(deformer.resume(bent.map), deformer.handles.targets(BAR_POINTS))
    assert certify(state.map, boundary, limits).is_certified
    assert_allclose(state.map(BAR_POINTS), BAR_POINTS, atol=1e-3)

"""Drags: what they reach, and what they must never do."""

from dataclasses import replace

import numpy as np
import pytest
from deform_shapes import (
    ARCHED,
    BAR_POINTS,
    STAR_POINTS,
    arched_bar,
    assert_sound,
    bar,
    bar_boundary,
    dense_outline,
    extremes,
    star,
    star_boundary,
)
from hypothesis import given, settings, strategies as st
from interpolation_shapes import subdivided
from messages import says
from numpy.testing import assert_allclose, assert_array_equal
from pictures import seen, stick_figure

from engine.deform import Deformer, Handles, Status, require_held, tracking
from engine.deform.certified_step import FARTHEST, add_samples
from engine.deform.deformer import UNCERTIFIED_START, UNSETTLED
from engine.deform.handles import MOST_CAGE, TARGET_COUNT, TARGET_FAR, WEIGHT_NOT_POSITIVE
from engine.deform.model.newton import SERVES_STEPS
from engine.domain.build import build_domain
from engine.domain.outline.cage import offset_cage
from engine.errors import EngineError
from engine.geometry import Domain
from engine.geometry.polygon import OUTSIDE_OUTLINE
from engine.maps import Boundary, Bounds
from engine.maps.harmonic_map import HarmonicMap

BOUNDS = Bounds()
BENT = BAR_POINTS + np.array([0, 0.3j, 0])


def dragged(deformer, targets, steps, state=None):
    state = deformer.start() if state is None else state
    handle_targets = deformer.handles.targets(targets)
    for _ in range(steps):
        state = deformer.step(state, handle_targets)
    return state


@pytest.mark.parametrize("turn", [0.0, 0.7, 3.0])
def test_similarities_are_met_exactly(turn):
    deformer = star()
    targets = np.exp(1j * turn) * STAR_POINTS + 3 - 1j
    state, _ = deformer.settle(deformer.start(), deformer.handles.targets(targets))
    assert state.status is Status.CONVERGED
    assert_allclose(deformer.positions(state), targets, rtol=0, atol=1e-5)
    assert_allclose(state.certificate.sigma_a, 1, atol=1e-3)
    assert_allclose(state.certificate.sigma_b, 1, atol=1e-3)
    assert_allclose(np.angle(state.map.derivatives(deformer.handles.points)[0]), turn, atol=1e-3)


@pytest.mark.parametrize("affine", [(1.3, 0.0), (1.25 * np.exp(0.5j), 0.3), (0.9, -0.2j)])
def test_affine_targets_are_met_when_allowed(affine):
    deformer = star()
    a, b = affine
    targets = a * STAR_POINTS + b * STAR_POINTS.conj()
    state, _ = deformer.settle(deformer.start(), deformer.handles.targets(targets))
    assert state.status is Status.CONVERGED
    # λ is large but finite: the handles give way a little to the energy.
    assert_allclose(deformer.positions(state), targets, rtol=0, atol=2e-3 * deformer.boundary.size)
    from_affine = deformer.start(
        HarmonicMap(
            cage=deformer.boundary.cage,
            phi=a * deformer.boundary.cage,
            psi=np.conj(b) * deformer.boundary.cage,
        )
    )
    back, _ = deformer.settle(from_affine, deformer.handles.targets(targets))
    assert_allclose(deformer.positions(back), deformer.positions(state), atol=1e-4)


def test_affine_targets_that_the_bounds_forbid_end_at_the_bounds():
    bounds = Bounds(k=0.2, sigma_a=1.5, sigma_b=0.6)
    deformer = bar(bounds)
    state, _ = deformer.settle(deformer.start(), deformer.handles.targets(2 * BAR_POINTS))
    assert state.status is Status.AT_LIMITS
    assert_sound(state, bounds)
    assert state.certificate.sigma_a > 1.45


@pytest.mark.parametrize(
    ("factor", "shift"), [(1j, 0), (1, 50 - 20j), (1e-3, 0), (200j, 1e4), (np.exp(0.8j), 0)]
)
def test_drags_are_equivariant(factor, shift):
    targets = STAR_POINTS + np.array([0, 0.3j, 0.1, -0.2j, 0.2 - 0.1j, 0])
    deformer = star()
    here = dragged(deformer, targets, 12)
    other = moved_star(factor, shift)
    there = dragged(other, factor * targets + shift, 12)
    points = 0.8 * deformer.boundary.outline
    assert_allclose(
        (there.map(factor * points + shift) - shift) / factor,
        here.map(points),
        rtol=0,
        atol=1e-9,
    )


def test_poses_turn_with_a_drawing_that_is_turned():
    targets = STAR_POINTS + np.array([0, 0.3j, 0.1, -0.2j, 0.2 - 0.1j, 0])
    deformer, turn = star(), np.exp(0.8j)
    here, _ = deformer.settle(deformer.start(), deformer.handles.targets(targets))
    other = moved_star(turn, 0)
    there, _ = other.settle(other.start(), other.handles.targets(turn * targets))
    assert there.statistics.objective == pytest.approx(here.statistics.objective, rel=1e-9)
    points = 0.8 * deformer.boundary.outline
    assert_allclose(there.map(turn * points) / turn, here.map(points), rtol=0, atol=1e-6)


def moved_star(factor, shift):
    boundary = star_boundary()
    boundary = Boundary.sample(
        Domain(factor * boundary.outline + shift, factor * boundary.cage + shift)
    )
    handles = Handles.place(boundary, factor * STAR_POINTS + shift)
    return Deformer(boundary=boundary, handles=handles, bounds=BOUNDS)


def test_a_recorded_drag_is_repeated_bit_for_bit():
    rng = np.random.default_rng(4)
    path = STAR_POINTS + 0.3 * (rng.normal(size=(6, 6)) + 1j * rng.normal(size=(6, 6)))

    def run():
        deformer = star()
        state = deformer.start()
        for row in path:
            state, _ = deformer.track_path_row(state, deformer.handles.targets(row))
        return state

    first, second = run(), run()
    assert_array_equal(first.map.phi, second.map.phi)
    assert_array_equal(first.map.psi, second.map.psi)
    assert first.certificate == second.certificate


WILD = {
    "three times as far": lambda rng: 3 * STAR_POINTS * np.exp(1j * rng.normal()) + 1,
    "swapped": lambda rng: STAR_POINTS[rng.permutation(6)],
    "collapsed": lambda _: np.full(6, 0.1 + 0.2j),
    "outside": lambda rng: STAR_POINTS + 10 * np.exp(2j * np.pi * rng.random(6)),
}


@pytest.mark.parametrize(
    "name",
    [
        "three times as far",
        "collapsed",
        pytest.param("swapped", marks=pytest.mark.long),
        pytest.param("outside", marks=pytest.mark.long),
    ],
)
def test_wild_requests_stay_certified_and_the_shape_comes_back(name):
    deformer = star()
    state = deformer.start()
    handle_targets = deformer.handles.targets(WILD[name](np.random.default_rng(1)))
    lengths = []
    for step in range(40):
        state = deformer.step(state, handle_targets)
        lengths.append(state.statistics.length)
        assert state.certificate.is_certified
        assert np.isfinite(state.map.phi).all()
        if step % 13 == 0:
            assert_sound(state, BOUNDS)
    assert state.status in (Status.MOVING, Status.AT_LIMITS)
    assert state.statistics.target_error > 0.01
    assert np.mean(lengths) > 0.1
    state, _ = deformer.settle(state, deformer.handles.targets(STAR_POINTS))
    assert state.status is Status.CONVERGED
    assert_allclose(deformer.positions(state), STAR_POINTS, rtol=0, atol=1e-5)
    assert_allclose(state.map(0.9 * STAR_POINTS), 0.9 * STAR_POINTS, atol=1e-4)


def test_an_old_factor_follows_the_hand_like_a_new_one(monkeypatch):
    angle = 2 * np.pi * np.arange(100) / 100
    outline, cage = (
        (1 + offset + 0.35 * np.cos(5 * angle)) * np.exp(1j * angle) for offset in (0.0, 0.04)
    )
    boundary = Boundary.sample(Domain(outline, cage))
    points = np.append(1.1 * np.exp(2j * np.pi * np.arange(5) / 5), 0.0)
    deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, points), bounds=BOUNDS)
    jitter = np.random.default_rng(101).normal(size=(25, 6, 2)) @ [1, 1j]
    means = []
    for served in (SERVES_STEPS, 1):
        monkeypatch.setattr("engine.deform.model.newton.SERVES_STEPS", served)
        state, energies = deformer.start(), []
        for moved in np.cumsum(0.025 * jitter, axis=0):
            state = deformer.step(state, deformer.handles.targets(points + moved))
            energies.append(state.statistics.objective)
        means.append(np.mean(energies))
    assert means[0] < 1.05 * means[1]


def test_dual_variables_follow_the_steps_of_a_drag():
    deformer = star()
    handle_targets = deformer.handles.targets(1.5 * STAR_POINTS)
    state = deformer.start()
    for _ in range(6):
        state = deformer.step(state, handle_targets)
    # Nothing is in the way: dual · c = weight of the barrier is all but reached.
    step = tracking._prepare(deformer, state, handle_targets)
    products = step.barrier.duals * step.barrier.margins(step.evaluation.a, step.evaluation.b)
    assert_allclose(products, step.barrier.weight, rtol=0.05)


def test_a_drag_in_random_jerks_stays_certified():
    deformer = star()
    rng = np.random.default_rng(11)
    state = deformer.start()
    for jerk in range(30):
        targets = STAR_POINTS + 0.8 * (rng.normal(size=6) + 1j * rng.normal(size=6))
        state = dragged(deformer, targets, 2, state)
        assert state.certificate.is_certified
        if jerk % 10 == 9:
            assert_sound(state, BOUNDS)
    state, _ = deformer.settle(state, deformer.handles.targets(STAR_POINTS))
    assert state.status is Status.CONVERGED
    assert_allclose(deformer.positions(state), STAR_POINTS, rtol=0, atol=1e-5)


@settings(max_examples=5)
@given(
    st.integers(0, 10**6),
    st.floats(0.02, 3.0),
    st.sampled_from(
        [BOUNDS, Bounds(k=0.3, sigma_a=2.0, sigma_b=0.5), Bounds(k=0.1, sigma_a=1.2, sigma_b=0.8)]
    ),
)
def test_any_drag_keeps_the_certificate(seed, size, bounds):
    rng = np.random.default_rng(seed)
    deformer = star(bounds)
    state = deformer.start()
    for _ in range(6):
        targets = STAR_POINTS + size * (rng.normal(size=6) + 1j * rng.normal(size=6))
        state = dragged(deformer, targets, 3, state)
        assert state.certificate.is_certified
    assert_sound(state, bounds)


def test_bounds_that_are_active_are_used_up():
    bounds = Bounds(k=0.15, sigma_a=1.6, sigma_b=0.7)
    deformer = bar(bounds)
    state, _ = deformer.settle(deformer.start(), deformer.handles.targets(ARCHED))
    assert_sound(state, bounds)
    near = bounds.towards_identity(0.01)
    certificate = state.certificate
    assert not near.allow(k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b)
    free = arched_bar()
    # The bounds cost energy or accuracy, never less than nothing.
    assert free.statistics.target_error <= state.statistics.target_error


def test_a_new_handle_moves_nothing():
    deformer = bar()
    state, _ = deformer.settle(deformer.start(), deformer.handles.targets(BENT))
    more = Deformer(
        boundary=deformer.boundary,
        handles=Handles.place(deformer.boundary, [*BAR_POINTS, 1 + 0.2j]),
        bounds=deformer.bounds,
    )
    held = np.append(BENT, more.positions(state)[-1])
    before = state.map(deformer.boundary.outline)
    for _ in range(5):
        state = more.step(state, more.handles.targets(held))
        assert_allclose(state.map(deformer.boundary.outline), before, atol=2e-3)
    # Fewer handles go on from the same map too, without a jump.
    fewer = Deformer(
        boundary=deformer.boundary,
        handles=Handles.place(deformer.boundary, BAR_POINTS[:2]),
        bounds=deformer.bounds,
    )
    before = state.map(deformer.boundary.outline)
    state = fewer.step(state, fewer.handles.targets(held[:2]))
    moved = np.abs(state.map(deformer.boundary.outline) - before).max()
    assert moved <= (1 + 1e-9) * FARTHEST * deformer.boundary.size
    assert state.certificate.is_certified


def test_without_handles_the_pose_stays():
    deformer = bar()
    state = dragged(deformer, BENT, 5)
    none = Deformer(
        boundary=deformer.boundary,
        handles=Handles.place(deformer.boundary, []),
        bounds=deformer.bounds,
    )
    after = none.step(state, none.handles.targets([]))
    assert after.map is state.map
    assert after.status is Status.FREE
    assert after.status.is_final


def test_without_handles_tighter_bounds_are_kept():
    deformer, state = bar(), arched_bar()
    tight = Bounds(k=0.5 * state.certificate.k, sigma_a=1.2, sigma_b=0.8)
    none = Deformer(
        boundary=deformer.boundary, handles=Handles.place(deformer.boundary, []), bounds=tight
    )
    state = none.step(state, none.handles.targets([]))
    assert state.status is Status.TIGHTENING
    state, _ = none.settle(state, none.handles.targets([]))
    assert state.status is Status.FREE
    assert state.limits is tight
    assert_sound(state, tight)


@pytest.mark.parametrize(
    ("factor", "tight"), [(2.0, Bounds(sigma_b=0.95)), (0.4, Bounds(sigma_a=1.05))]
)
def test_bounds_near_the_identity_hold_a_map_that_is_far_from_it(factor, tight):
    # σ_b = 2 under σ_b ≥ 0.95: what a step must keep of that slack lies beyond the identity.
    deformer = bar(tight)
    cage = deformer.boundary.cage
    state = deformer.start(HarmonicMap(cage=cage, phi=factor * cage, psi=0 * cage))
    state, _ = deformer.track_path_row(state, deformer.handles.targets(factor * BAR_POINTS + 0.1j))
    assert_sound(state, tight)


def test_one_handle_carries_the_shape_without_turning_it():
    boundary = bar_boundary()
    deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, [0.5]), bounds=BOUNDS)
    state, _ = deformer.settle(deformer.start(), deformer.handles.targets([3 + 2j]))
    assert_allclose(state.map(boundary.outline), boundary.outline + 2.5 + 2j, atol=1e-3)


def test_tightened_bounds_are_walked_into_through_certified_maps():
    state = arched_bar()
    loose = state.certificate
    tight = Bounds(k=0.5 * loose.k, sigma_a=1 + 0.6 * (loose.sigma_a - 1), sigma_b=0.6)
    deformer = bar(tight)
    handle_targets = deformer.handles.targets(ARCHED)
    with pytest.raises(EngineError, match=says(UNCERTIFIED_START)):
        deformer.start(state.map)
    for steps in range(200):  # noqa: B007 - the count is asserted
        at = deformer.positions(state)
        state = deformer.step(state, handle_targets)
        assert np.abs(deformer.positions(state) - at).max() < 0.2
        assert state.certificate.is_certified
        assert state.certificate.k <= state.limits.k
        if state.status is not Status.TIGHTENING:
            break
    assert 0 < steps < 150
    state, _ = deformer.settle(state, handle_targets)
    assert_sound(state, tight)
    resumed = deformer.resume(dragged(bar(), ARCHED, 60).map)
    assert resumed.status is Status.TIGHTENING
    assert resumed.certificate.is_certified
    resumed, _ = deformer.settle(resumed, handle_targets)
    assert_sound(resumed, tight)
    # Wider bounds let the handles go on.
    wide = bar()
    state, _ = wide.settle(state, handle_targets)
    assert state.status is Status.CONVERGED
    assert state.certificate.k > tight.k


def test_a_map_that_finds_no_way_into_its_bounds_says_so(monkeypatch):
    state, handle_targets = arched_bar(), bar().handles.targets(ARCHED)
    # Steps that go nowhere.
    monkeypatch.setattr("engine.deform.certified_step.line_search", lambda _, jet, *__: (0.0, jet))
    with pytest.raises(EngineError, match=says(UNSETTLED, status=Status.OUTSIDE.value)):
        bar(Bounds(k=0.05)).settle(state, handle_targets)
    stuck, steps = bar(Bounds(k=0.05)).settle(state, handle_targets, throw=False)
    assert stuck.status is Status.OUTSIDE
    assert steps < 80
    assert stuck.certificate.is_certified
    assert stuck.map is state.map


def test_rotations_are_met():
    deformer = star()
    angle = np.full(6, np.nan)
    angle[1] = 0.8
    handle_targets = deformer.handles.targets(STAR_POINTS, angle)
    state, _ = deformer.settle(deformer.start(), handle_targets)
    assert state.status is Status.CONVERGED
    assert_sound(state, BOUNDS)
    turned = np.angle(state.map.derivatives(deformer.handles.points)[0])
    assert 0.6 < turned[1] < 0.81
    assert abs(turned[3]) < 0.1
    free, _ = deformer.settle(state, deformer.handles.targets(STAR_POINTS))
    assert_allclose(np.angle(free.map.derivatives(deformer.handles.points)[0]), 0, atol=1e-3)


def test_heavier_handles_win():
    boundary = bar_boundary()
    targets = np.array([-1.8, 0.8j, 1.8])
    errors = []
    for weights in ([1, 1, 1], [1, 30, 1]):
        deformer = Deformer(
            boundary=boundary,
            handles=Handles.place(boundary, BAR_POINTS, weights),
            bounds=Bounds(k=0.5, sigma_a=1.8, sigma_b=0.4),
        )
        state, _ = deformer.settle(deformer.start(), deformer.handles.targets(targets), at_most=150)
        errors.append(abs(deformer.positions(state)[1] - targets[1]))
    assert errors[1] < errors[0]


@pytest.mark.parametrize(
    ("points", "weights", "message"),
    [
        ([5.0], None, "handle at .* outside"),
        ([0.0, np.nan], None, "finite"),
        ([0.0], [1, 2], "weights, not"),
        ([0.0], [0.0], says(WEIGHT_NOT_POSITIVE)),
        ([0.0], [np.nan], says(WEIGHT_NOT_POSITIVE)),
    ],
)
def test_bad_handles_are_refused(points, weights, message):
    with pytest.raises(EngineError, match=message):
        Handles.place(star_boundary(), points, weights)


@pytest.mark.parametrize(
    ("targets", "rotations", "message"),
    [
        ([0.0], None, says(TARGET_COUNT)),
        ([0.0, np.inf], None, "finite"),
        ([0.0, 1e300], None, says(TARGET_FAR, handle=1, x=1e300, y=0.0)),
        ([0.0, 1.0], None, "same point .* different targets"),
        ([0.0, 0.0], [0.5, -0.5], "same point .* different rotations"),
        ([0.0, 0.0], [0.0], "angles"),
        ([0.0, 0.0], [np.inf, 0.0], "angles"),
    ],
)
def test_bad_targets_are_refused(targets, rotations, message):
    handles = Handles.place(star_boundary(), [0.1, 0.1])
    with pytest.raises(EngineError, match=message):
        handles.targets(targets, rotations)


def test_handles_that_nobody_can_tell_apart_are_at_one_point():
    handles = Handles.place(star_boundary(), [0.1, 0.1 + 1e-7])
    with pytest.raises(EngineError, match="same point"):
        handles.targets([0.1, 0.2])
    # As far from each other as bounds allow, and turned by a whole turn, they ask for the same.
    handles.targets([0.1, 0.1 + 1e-6], [0.5, 0.5 + 2 * np.pi])
    handles.targets([0.1, 0.1], [0.5, np.nan])


def test_a_cage_of_too_many_vertices_is_refused_in_words():
    outline = star_boundary().outline
    fine = Domain(outline, subdivided(star_boundary().cage, 0.01))
    boundary = replace(star_boundary(), domain=fine)
    with pytest.raises(EngineError, match=says(MOST_CAGE, count=790, most=400)):
        Handles.place(boundary, [0.0])
    with pytest.raises(EngineError, match=says(OUTSIDE_OUTLINE)):
        require_held([5.0], Domain(outline, outline))


def test_handles_at_one_point_with_one_target_work():
    boundary = bar_boundary()
    deformer = Deformer(
        boundary=boundary, handles=Handles.place(boundary, [0, 0, 1.5, -1.5]), bounds=BOUNDS
    )
    targets = np.array([0.1j, 0.1j, 1.5, -1.5])
    state, _ = deformer.settle(deformer.start(), deformer.handles.targets(targets))
    assert_allclose(deformer.positions(state)[:2], 0.1j, atol=1e-3)


def test_a_drawing_is_dragged():
    domain, _ = build_domain(seen(stick_figure(300, 14)), triangles=1000, detail="coarse")
    boundary = Boundary.sample(domain)
    top, left = (
        boundary.outline[np.argmax(v)] for v in (boundary.outline.imag, -boundary.outline.real)
    )
    centre = domain.mesh.vertices.mean()
    places = [
        domain.mesh.vertices[np.argmin(np.abs(domain.mesh.vertices - p))]
        for p in (top, left, centre)
    ]
    deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, places), bounds=BOUNDS)
    far = np.array(places) + boundary.size * np.array([0.3, -2j, 0.1])
    state = deformer.start()
    for _ in range(25):
        state = deformer.step(state, deformer.handles.targets(far))
        assert state.certificate.is_certified
    k, sigma_a, sigma_b = extremes(state.map, dense_outline(boundary, 10_000))
    certificate = state.certificate
    assert k <= certificate.k <= BOUNDS.k
    assert sigma_a <= certificate.sigma_a <= BOUNDS.sigma_a
    assert sigma_b >= certificate.sigma_b >= BOUNDS.sigma_b
    state, _ = deformer.settle(state, deformer.handles.targets(places))
    assert state.status is Status.CONVERGED
    assert_allclose(deformer.positions(state), places, rtol=0, atol=1e-4 * boundary.size)


def test_handles_do_not_pull_while_the_shape_walks_into_its_bounds():
    deformer = bar()
    far = deformer.handles.targets(BAR_POINTS + np.array([-40, 0, 40]))
    state = deformer.start()
    for _ in range(30):
        state = deformer.step(state, far)
    certificate = state.certificate
    tight = bar(Bounds(k=0.6 * certificate.k, sigma_a=0.8 * certificate.sigma_a, sigma_b=0.3))
    stretched = np.ptp(tight.positions(state).real)
    for _ in range(80):
        state = tight.step(state, far)
        if state.status is not Status.TIGHTENING:
            break
        assert np.ptp(tight.positions(state).real) <= stretched
        stretched = np.ptp(tight.positions(state).real)
    assert state.status is Status.MOVING


def test_samples_are_added_where_a_bound_was_broken():
    base = star_boundary()
    duals = np.arange(3.0 * len(base.points)).reshape(3, -1)
    same, kept = add_samples(base, base, duals, np.array([], dtype=int))
    assert same is base
    assert_array_equal(kept, duals)
    more, longer = add_samples(base, base, duals, np.array([3, 7]))
    assert len(more.points) == len(base.points) + 2
    assert longer.shape == (3, len(more.points))
    assert longer[0, 4] == duals[0, 4]
    assert longer[0, 9] == duals[0, 8]
    fewer, none = add_samples(base, more, longer, np.arange(200))
    assert fewer is base
    assert none is None


def test_a_wild_drag_adds_samples():
    deformer = star(Bounds(k=0.3, sigma_a=2.0, sigma_b=0.5))
    state = deformer.start()
    handle_targets = deformer.handles.targets(STAR_POINTS[::-1])
    most = 0
    for _ in range(40):
        state = deformer.step(state, handle_targets)
        most = max(most, len(state.boundary.points))
    assert most > len(deformer.boundary.points)


@pytest.mark.long
def test_a_shape_that_stays_entangled_is_settled_anew():
    # A thin band whose handles were dragged through each other under tight bounds.
    x = np.linspace(0, 3, 14)
    spine = x + 0.25j * np.sin(2.2 * x)
    outline = np.concatenate([spine - 0.12j, (spine + 0.12j)[::-1]])
    boundary = Boundary.sample(Domain(outline, offset_cage(outline, 0.06)))
    points = spine[[1, 4, 7, 10, 12]]
    handles = Handles.place(boundary, points)
    bounds = Bounds(k=0.4, sigma_a=3, sigma_b=0.4)
    deformer = Deformer(boundary=boundary, handles=handles, bounds=bounds)
    state = deformer.start()
    for share in np.linspace(0, 1, 12):
        state, _ = deformer.track_path_row(
            state, handles.targets(points + share * (points[::-1] - points))
        )
    home = handles.targets(points)
    back, _ = deformer.settle(state, home)
    assert back.status is Status.CONVERGED
    assert_allclose(deformer.positions(back), points, rtol=0, atol=1e-6)

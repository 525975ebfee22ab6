"""Hands that pull with bounded force: their energy, where they lead, and where they let go."""

from functools import cache

import numpy as np
import pytest
from deform_shapes import BAR_POINTS, STAR_POINTS, bar, star, star_boundary
from holed_shapes import plate
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from engine.deform import BoundedPull, Deformer, Handles, Objective, Status, projected_hessian
from engine.deform.forces.pulls import FORCE_NOT_POSITIVE, PULL_HANDLES
from engine.deform.interior_point.search import OPTIMAL
from engine.deform.model.hessian import hessian_product
from engine.errors import EngineError
from engine.maps import Boundary, Bounds

FORCE = 10.0
BOUNDS = Bounds(k=0.5, sigma_a=2.0, sigma_b=0.5)
BOUNDARY = star_boundary()
SIZE = BOUNDARY.size
WEIGHTS = [1.0, 2.0, 1.0, 0.5, 1.0, 3.0]
HANDLES = Handles.place(BOUNDARY, STAR_POINTS, WEIGHTS)
OUT = STAR_POINTS.copy()
OUT[1] *= 1 + 0.5 * SIZE / abs(OUT[1])
TWO = (BoundedPull([1, 3], FORCE), BoundedPull([4], FORCE / 2))


def objective(targets, hands, **more):
    handle_targets = HANDLES.targets(targets, None, hands)
    return Objective(boundary=BOUNDARY, handles=HANDLES, targets=handle_targets, **more)


def coefficients(seed=0):
    """Return a map near the identity."""
    rng, cage = np.random.default_rng(seed), BOUNDARY.cage
    noise = 0.02 * (rng.normal(size=(2, len(cage))) + 1j * rng.normal(size=(2, len(cage))))
    return cage + noise[0], noise[1]


def settled(deformer, handle_targets, state=None):
    state = deformer.start() if state is None else state
    for _ in range(500):
        state = deformer.step(state, handle_targets)
        if state.status.is_final:
            return state
    raise AssertionError("the shape does not come to rest")


def pixels(one, other):
    """Return how far points are from others at most, if a drawing has a diameter of 1,000."""
    return 1000 * float(np.abs(one - other).max()) / SIZE


@cache
def shape():
    """Return a star that no test changes."""
    return star(BOUNDS)


@cache
def pulled_out():
    """Return the star at rest with one arm pulled beyond reach, and its targets."""
    deformer = shape()
    handle_targets = deformer.handles.targets(OUT, None, (BoundedPull([1]),))
    return handle_targets, settled(deformer, handle_targets)


@pytest.mark.parametrize("away", [1e-4, 3e-3, 0.1, 1.0, 1e5])
def test_a_hand_pulls_as_it_was_until_its_force_is_spent_and_no_stronger_then(away):
    jet = objective(OUT, ()).evaluate(*coefficients())
    stiffness, gives = HANDLES.stiffness[1], FORCE / (2 * HANDLES.stiffness[1] * SIZE)
    arrived, wanted = OUT.copy(), OUT.copy()
    arrived[1] = jet.positions[1]
    wanted[1] = arrived[1] + away * SIZE * np.exp(0.7j)
    pulled, others = (
        objective(wanted, (BoundedPull([1], FORCE),)),
        objective(arrived, ()).energy(jet),
    )
    far = away * SIZE
    huber = stiffness * (2 * gives * far - gives**2 if far > gives else far**2)
    assert_allclose(pulled.energy(jet), others + huber, rtol=1e-9)
    force = 2 * stiffness * abs(pulled.targets.target_errors(jet.positions)[1])
    assert_allclose(force, min(FORCE / SIZE, 2 * stiffness * far), rtol=1e-7)


@pytest.mark.parametrize("hands", [TWO, (BoundedPull([0, 1, 2, 3, 4, 5], 3.0),)])
def test_its_gradient_and_its_hessian_are_those_of_its_energy(hands):
    mine = objective(1.4 * STAR_POINTS * np.exp(0.3j), hands)
    jet = mine.evaluate(*coefficients())
    assert np.count_nonzero(
        mine.targets.pulls.slack(jet.positions - mine.targets.positions)
    ) == len(hands)
    gradient = mine.gradient(jet, mine.radial_derivatives(jet))
    rng, step = np.random.default_rng(1), 1e-5
    for _ in range(5):
        direction = rng.normal(size=len(gradient))
        change = mine.evaluate_change(direction)
        there, back = (jet.advanced(sign * step, change) for sign in (1, -1))
        assert_allclose(
            (mine.energy(there) - mine.energy(back)) / (2 * step), gradient @ direction, rtol=1e-6
        )
        # The Hessian of the handles alone: positions are linear in the unknowns.
        positions = [moved.positions for moved in (there, back)]
        pull = [2 * HANDLES.stiffness * mine.targets.target_errors(place) for place in positions]
        curved = 2 * HANDLES.stiffness * mine.target_error_change(jet, change.positions)
        assert_allclose(
            (pull[0] - pull[1]) / (2 * step), curved, rtol=1e-5, atol=1e-6 * np.abs(curved).max()
        )


@pytest.mark.parametrize("secant", [False, True])
def test_the_matrix_and_the_products_of_its_hessian_agree(secant):
    mine = objective(1.4 * STAR_POINTS * np.exp(0.3j), TWO, secant=secant)
    jet = mine.evaluate(*coefficients())
    radial = mine.radial_derivatives(jet)
    upper = projected_hessian(mine, jet, radial)
    hessian = np.triu(upper) + np.triu(upper, 1).T
    assert np.linalg.eigvalsh(hessian).min() > -1e-4
    direction = np.random.default_rng(2).normal(size=len(hessian))
    product = hessian_product(mine, jet, radial, mine.evaluate_change(direction))
    assert_allclose(product, hessian @ direction, rtol=0, atol=2e-3 * np.abs(product).max())


def test_a_hand_beyond_reach_moves_what_it_holds_and_nothing_else():
    deformer = star(BOUNDS)
    # With no bound of the force the others give way, long before all comes to rest.
    held = deformer.start()
    for _ in range(60):
        held = deformer.step(held, deformer.handles.targets(OUT))
    others = [0, 2, 3, 4, 5]
    assert pixels(deformer.positions(held)[others], STAR_POINTS[others]) > 10
    handle_targets, state = pulled_out()
    assert state.status is Status.AT_LIMITS
    assert state.certificate.sigma_a > 0.99 * BOUNDS.sigma_a
    places = deformer.positions(state)
    assert pixels(places[others], STAR_POINTS[others]) < 3
    assert pixels(places[1], OUT[1]) > 100
    # All of its force is in use, and no more.
    force = 2 * deformer.handles.stiffness[1] * abs(handle_targets.target_errors(places)[1])
    assert_allclose(force, 10.0 / SIZE, rtol=1e-9)
    # Targets within reach are met like any others.
    near = STAR_POINTS.copy()
    near[1] *= 1.1
    one, two = (
        settled(deformer, deformer.handles.targets(near, None, hands))
        for hands in ((), (BoundedPull([1]),))
    )
    assert pixels(deformer.positions(one), deformer.positions(two)) < 0.01


def test_what_a_hand_lets_go_stays_where_it_is_and_is_found_again():
    deformer = star(BOUNDS)
    handle_targets, state = pulled_out()
    places, shape = deformer.positions(state), state.map(BOUNDARY.outline)
    left = handle_targets.released(places)
    assert left.pulls is None
    assert_array_equal(left.positions[[0, 2, 3, 4, 5]], STAR_POINTS[[0, 2, 3, 4, 5]])
    beyond = left.positions[1] - places[1]
    assert_allclose(np.angle(beyond / (OUT[1] - places[1])), 0, atol=1e-9)
    assert pixels(left.positions[1], places[1]) < 1
    assert pixels(settled(deformer, left, state).map(BOUNDARY.outline), shape) < 0.5
    # From the shape at rest it nearly gets there soon, and takes long for the last of it.
    again = deformer.start()
    for _ in range(50):
        again = deformer.step(again, left)
    assert pixels(again.map(BOUNDARY.outline), shape) < 3
    # Targets that nothing bounds stay as they are.
    assert left.released(places) is left


def within_reach():
    """Return targets that the star meets."""
    targets = STAR_POINTS.copy()
    targets[1] *= 1 + 0.15 * SIZE / abs(targets[1])
    return shape().handles.targets(targets, None, (BoundedPull([1]),))


@pytest.mark.parametrize("is_reached", [True, False])
def test_a_pose_at_rest_stays_when_hands_let_go(is_reached):
    deformer = shape()
    handle_targets, state = pulled_out()
    if is_reached:
        handle_targets = within_reach()
        state = settled(deformer, handle_targets)
    left = handle_targets.released(deformer.positions(state))
    released = deformer.release(state, left)
    assert deformer.step(released, left) is released
    assert released.map is state.map
    assert deformer.release(released, left).status is state.status
    # It is a minimum for the new targets as for the old ones, and a new search finds it again.
    gradients = []
    for each in (handle_targets, left):
        mine, jet = deformer.measure_state(state, each)
        gradients.append(mine.gradient(jet, mine.radial_derivatives(jet)))
    assert_allclose(*gradients, rtol=0, atol=1e-9)
    again = settled(deformer, left, state)
    off = pixels(again.map(BOUNDARY.outline), state.map(BOUNDARY.outline))
    # At the bounds the least energy leaves the place of a pose less certain.
    assert off < (2e-5 if is_reached else 0.5)


def test_a_pose_on_its_way_goes_on_when_hands_let_go():
    deformer, handle_targets = shape(), within_reach()
    moving = deformer.step(deformer.start(), handle_targets)
    left = handle_targets.released(deformer.positions(moving))
    going = deformer.release(moving, left)
    assert going.status is Status.MOVING
    assert settled(deformer, left, going).map is not moving.map


def test_a_short_search_comes_to_rest_where_a_long_one_does(monkeypatch):
    deformer, handle_targets = shape(), within_reach()
    moved = deformer.start()
    for share in np.linspace(0, 1, 6)[1:]:
        targets = STAR_POINTS + share * (handle_targets.positions - STAR_POINTS)
        moved = deformer.step(moved, deformer.handles.targets(targets, None, (BoundedPull([1]),)))
    short, few = deformer.settle(moved, handle_targets)
    # Heavier at first, slowly lighter, and hands with nothing along their pull in the Hessian.
    monkeypatch.setattr("engine.deform.interior_point.continuation.HERE_PER_ENERGY", 1e-2)
    monkeypatch.setattr("engine.deform.interior_point.continuation.LOWER_IN_THE_OPEN", 0.1)
    monkeypatch.setattr("engine.deform.interior_point.continuation.FAR_FROM_REST", np.inf)
    long, many = deformer.settle(moved, handle_targets)
    assert few <= 6 < many
    for state in (short, long):
        assert state.status is Status.CONVERGED
        assert state.statistics.optimality <= OPTIMAL
    assert_allclose(short.statistics.objective, long.statistics.objective, rtol=1e-8)
    assert pixels(short.map(BOUNDARY.outline), long.map(BOUNDARY.outline)) < 2e-5


def test_a_hand_that_comes_back_leaves_nothing_behind():
    deformer = star(BOUNDS)
    state = deformer.start()
    for share in [*np.linspace(0, 1, 12), *np.linspace(1, 0, 12)]:
        targets = STAR_POINTS + share * (OUT - STAR_POINTS)
        handle_targets = deformer.handles.targets(targets, None, (BoundedPull([1]),))
        state = deformer.step(deformer.step(state, handle_targets), handle_targets)
    state = settled(
        deformer, deformer.handles.targets(STAR_POINTS, None, (BoundedPull([1]),)), state
    )
    assert pixels(state.map(BOUNDARY.outline), BOUNDARY.outline) < 1e-3


def test_handles_that_one_hand_pulls_keep_their_formation_and_pull_as_one():
    deformer = star(BOUNDS)
    targets = STAR_POINTS.copy()
    targets[[1, 2]] += 0.6 * SIZE * np.exp(2.2j)
    states = []
    for hands in ((BoundedPull([1, 2]),), (BoundedPull([1]), BoundedPull([2]))):
        handle_targets = deformer.handles.targets(targets, None, hands)
        states.append((handle_targets, deformer.positions(settled(deformer, handle_targets))))
    (handle_targets, places), (targets_of_two, places_of_two) = states
    force = (2 * deformer.handles.stiffness * handle_targets.target_errors(places))[[1, 2]].sum()
    assert_allclose(abs(force), 10.0 / SIZE, rtol=1e-9)
    # Two hands pull twice as strongly, and do not keep the handles as they are to each other.
    force = (2 * deformer.handles.stiffness * targets_of_two.target_errors(places_of_two))[[1, 2]]
    assert_allclose(np.abs(force), 10.0 / SIZE, rtol=1e-9)
    asked = targets[1] - targets[2]
    assert (
        pixels(places[1] - places[2], asked)
        < 5
        < pixels(places_of_two[1] - places_of_two[2], asked)
    )
    left = handle_targets.released(places)
    assert_allclose(left.positions[1] - left.positions[2], asked, rtol=1e-12)


def test_around_a_hole_a_hand_pulls_as_bounded():
    shape = plate(1)
    boundary = Boundary.sample(shape.domain)
    points = 0.97 * shape.outline[[0, len(shape.outline) // 3, 2 * len(shape.outline) // 3]]
    handles = Handles.place(boundary, points)
    far = points.copy()
    far[0] *= 1 + boundary.size / abs(far[0])
    handle_targets = handles.targets(far, None, (BoundedPull([0]),))
    deformer = Deformer(boundary=boundary, handles=handles, bounds=BOUNDS)
    state = settled(deformer, handle_targets)
    assert state.status is Status.AT_LIMITS
    places = deformer.positions(state)
    assert np.abs(places - points)[1:].max() < 3e-3 * boundary.size
    mine = Objective(boundary=boundary, handles=handles, targets=handle_targets)
    jet = mine.evaluate(*state.map.columns)
    gradient = mine.gradient(jet, mine.radial_derivatives(jet))
    direction = np.random.default_rng(3).normal(size=len(gradient))
    change = mine.evaluate_change(direction)
    there, back = (mine.energy(jet.advanced(sign * 1e-6, change)) for sign in (1, -1))
    assert_allclose((there - back) / 2e-6, gradient @ direction, rtol=1e-5)


@pytest.mark.parametrize("far", [0.3, 5.0])
def test_a_pull_of_everything_moves_the_whole_shape(far):
    deformer = bar()
    way = far * deformer.boundary.size * np.exp(0.4j)
    handle_targets = deformer.handles.targets(BAR_POINTS + way, None, (BoundedPull([0, 1, 2]),))
    state = settled(deformer, handle_targets)
    assert state.status is Status.CONVERGED
    outline = deformer.boundary.outline
    assert_allclose(state.map(outline), outline + way, rtol=0, atol=1e-3)


@pytest.mark.parametrize(
    ("hands", "reported"),
    [
        ((BoundedPull([1], 0.0),), says(FORCE_NOT_POSITIVE, pull=0)),
        ((BoundedPull([1], np.nan),), says(FORCE_NOT_POSITIVE, pull=float("nan"))),
        ((BoundedPull([9]),), says(PULL_HANDLES, handles="[9]", count=6)),
        ((BoundedPull([-1]),), says(PULL_HANDLES, handles="[-1]", count=6)),
        ((BoundedPull([]),), "names no handle"),
        ((BoundedPull([1, 2]), BoundedPull([2])), "Two pulls name handle 2"),
    ],
)
def test_hands_that_cannot_pull_are_refused(hands, reported):
    with pytest.raises(EngineError, match=reported):
        HANDLES.targets(OUT, None, hands)


def test_a_hand_of_unbounded_force_holds():
    deformer = star(BOUNDS)
    requests = [
        deformer.handles.targets(OUT, None, hands) for hands in ((), (BoundedPull([1], np.inf),))
    ]
    assert requests[0].is_same(requests[1])
    assert not requests[0].is_same(deformer.handles.targets(OUT, None, (BoundedPull([1]),)))
    other = deformer.handles.targets(OUT, None, (BoundedPull([2]),))
    assert not other.is_same(deformer.handles.targets(OUT, None, (BoundedPull([1]),)))


def test_hands_hold_all_where_each_handle_is_in_one():
    def holds_all(*handles):
        return HANDLES.targets(
            OUT, None, [BoundedPull(each, FORCE) for each in handles]
        ).pulls.has_all_handles

    assert holds_all([0, 1, 2], [3, 4, 5])
    assert not holds_all([0, 1, 2], [3, 4])

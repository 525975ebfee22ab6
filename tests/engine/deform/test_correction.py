"""Corrections in the variables of the blend: points, periods, least size, limits, invariances."""

from functools import cache

import numpy as np
import pytest
from deform_shapes import BAR_POINTS, STAR_POINTS, bar_boundary, star_boundary
from holed_shapes import ring
from messages import says
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from engine.deform.correction.barrier import WIDTH, LimitBarrier, extremes
from engine.deform.correction.corrector import build_corrector
from engine.deform.correction.frame import BaseFrame, CorrectedFrame
from engine.deform.correction.limits import frame_limits, max_feasible_share, solve_within
from engine.deform.correction.paths import PointPaths
from engine.deform.correction.point_targets import PointTargets
from engine.deform.correction.solver import (
    LEVER,
    UNFINISHED,
    PointSolution,
    solve_correction,
)
from engine.deform.correction.step_model import metric_root
from engine.errors import EngineError
from engine.maps import Boundary, Bounds

SHAPES = {"bar": (bar_boundary, BAR_POINTS), "star": (star_boundary, STAR_POINTS)}
RNG = np.random.default_rng(5)


@cache
def corrector(name):
    make, points = SHAPES[name]
    return build_corrector(make(), 0.05 + 0.02j, points)


@cache
def holed():
    shape = ring()
    boundary = Boundary.sample(shape.domain)
    return build_corrector(boundary, shape.anchor, np.array([0.75j, -0.75]))


def bent(places, *, amount=0.15, sign=-1, is_squared=True):
    """A frame with f_z = e^{i/3} (1 + a e^z / 2) and f_z̄ = conj(a z / 3), at some places."""
    fz = np.exp(1j / 3) * (1 + amount / 2 * np.exp(places))
    plain = np.exp(1j / 3) * (1 + amount * places / 4)
    g = amount * places / 3
    return BaseFrame(fz, g, plain**2 / fz if is_squared else plain, sign)


def moves_of(places, by):
    """Moves of points: all stay but the second one."""
    moves = np.zeros(len(places), dtype=np.complex128)
    moves[1] = by
    return moves


def lack_of(known, base, found, moves):
    at_rest = CorrectedFrame.of(known, base, 0 * found.x).places()
    there = CorrectedFrame.of(known, base, found.x).places()
    return (there - at_rest + found.shift)[: len(moves)] - moves


@pytest.mark.parametrize("name", SHAPES)
def test_paths_integrate_holomorphic_functions(name):
    make, points = SHAPES[name]
    boundary, anchor = make(), 0.05 + 0.02j
    paths = PointPaths.of(boundary, anchor, points)
    # As singular as coordinates are: around a vertex of the cage.
    z0 = boundary.cage[3]
    exact = [(p - z0) * (np.log((p - z0) / (anchor - z0)) - 1) + (anchor - z0) for p in points]
    values = np.log((paths.nodes - z0) / (anchor - z0))
    found = paths.integrals(np.exp(paths.nodes))
    assert_allclose(found, np.exp(points) - np.exp(anchor), atol=1e-6)
    assert_allclose(paths.integrals(values), exact, atol=2e-5)
    pulls = np.arange(len(points)) + 1j
    assert paths.spread(pulls) @ values == pytest.approx(pulls @ paths.integrals(values))


def test_paths_lead_around_holes():
    paths = holed().paths
    assert_allclose(paths.integrals(1 / paths.nodes)[2:], [-2j * np.pi], atol=1e-9)


@pytest.mark.parametrize(("name", "sign"), [("bar", -1), ("star", 1)])
def test_points_come_to_their_targets(name, sign):
    known = corrector(name)
    base = bent(known.paths.nodes, sign=sign)
    moves = moves_of(known.points, 0.1 + 0.08j)
    found = solve_correction(
        known, base, PointTargets(moves, np.ones(len(moves)), is_anchored=False)
    )
    assert np.abs(lack_of(known, base, found, moves)).max() < 1e-10 * known.boundary.size
    assert found.target_errors.max() < 1e-10 * known.boundary.size
    assert found.steps <= 5


def test_rows_and_bending_are_derivatives():
    known = corrector("star")
    base, size = bent(known.paths.nodes), 2 * known.variables.count
    x, step = RNG.normal(size=(2, size)) * 0.05
    pulls = RNG.normal(size=6) + 1j * RNG.normal(size=6)
    e = 1e-5

    def at(s):
        return CorrectedFrame.of(known, base, x + s * step)

    change = (at(e).places() - at(-e).places()) / (2 * e)
    rows = at(0).constraint_rows() @ step
    assert_allclose(rows, [*change.real, *change.imag], atol=1e-8)
    weights = np.concatenate([pulls.real, pulls.imag])
    bend = weights @ (at(e).constraint_rows() - at(-e).constraint_rows()) / (2 * e)
    assert_allclose(at(0).curvature(pulls)(step), bend, atol=1e-7)


def test_corrections_are_the_least():
    known = corrector("bar")
    base = bent(known.paths.nodes)
    moves = moves_of(known.points, 0.05 - 0.1j)
    found = solve_correction(known, base, PointTargets(moves, np.ones(3), is_anchored=True))
    rest = CorrectedFrame.of(known, base, 0 * found.x).places()

    def lack(x):
        places = CorrectedFrame.of(known, base, x).places() - rest - moves
        return np.concatenate([places.real, places.imag])

    other = minimize(
        lambda x: (0.5 * x @ x, x),
        np.zeros(len(found.x)),
        jac=True,
        method="SLSQP",
        constraints={
            "type": "eq",
            "fun": lack,
            "jac": lambda x: CorrectedFrame.of(known, base, x).constraint_rows(),
        },
        options={"ftol": 1e-12, "maxiter": 200},
    )
    assert_allclose(found.x, other.x, atol=1e-5)


def test_size_of_a_correction_is_its_dirichlet_energy():
    """Four times |x|² is the symmetric Dirichlet energy beyond the base's, to second order."""
    known = corrector("star")
    count = known.variables.count
    x = RNG.normal(size=2 * count) * 1e-3 / np.sqrt(count)
    boundary, values = known.boundary, known.variables.at_samples
    h, q = values.both_of(x)
    a, b = np.abs(np.exp(h)), np.abs(q * np.exp(h))
    stretched = ((a + b) ** 2 + (a - b) ** 2 + (a + b) ** -2.0 + (a - b) ** -2.0) - 4
    energy = boundary.lengths @ stretched
    size = x @ x
    own = boundary.lengths @ (h.real**2 + np.abs(q) ** 2)
    assert energy == pytest.approx(8 * own, rel=0.02)
    assert own <= size


def test_a_handle_of_weight_0_is_free():
    known = corrector("bar")
    base = bent(known.paths.nodes)
    moves = np.array([0, 0.1j, 5.0])
    weights = np.array([1.0, 1.0, 0.0])
    found = solve_correction(known, base, PointTargets(moves, weights, is_anchored=True))
    few = build_corrector(known.boundary, 0.05 + 0.02j, known.points[:2])
    alone = solve_correction(
        few, bent(few.paths.nodes), PointTargets(moves[:2], np.ones(2), is_anchored=True)
    )
    assert_allclose(found.x @ found.x, alone.x @ alone.x, rtol=1e-4)
    light = solve_correction(
        known, base, PointTargets(moves, np.array([1.0, 1.0, 1e-9]), is_anchored=True)
    )
    assert_allclose(light.x, found.x, atol=1e-6)


def test_an_anchor_stays_or_all_is_moved():
    known = corrector("star")
    base = bent(known.paths.nodes)
    moves = np.full(len(known.points), 0.3 - 0.2j)
    free = solve_correction(known, base, PointTargets(moves, np.ones(6), is_anchored=False))
    assert_allclose(free.shift, 0.3 - 0.2j, atol=1e-12)
    assert np.abs(free.x).max() < 1e-12
    held = solve_correction(known, base, PointTargets(moves, np.ones(6), is_anchored=True))
    assert held.shift == 0
    assert held.target_errors.max() < 1e-8
    assert np.abs(held.x).max() > 0.01


def test_periods_around_holes_are_closed():
    known = holed()
    moves = np.array([0.05, 0.1j])
    # With a period of its own, which is closed, too.
    base = bent(known.paths.nodes)
    base = base._replace(g=base.g + 0.01 / known.paths.nodes)
    opened = known.paths.integrals(base.fz) + known.paths.integrals(base.g).conj()
    assert np.abs(opened[2:]).max() > 0.05
    found = solve_correction(known, base, PointTargets(moves, np.ones(2), is_anchored=False))
    frame = CorrectedFrame.of(known, base, found.x)
    assert np.abs(frame.places()[2:]).max() < 1e-9
    assert found.target_errors.max() < 1e-9


def test_a_stiff_part_changes_less():
    known = corrector("bar")
    right = known.boundary.points.real > 0
    stiff = known.boundary.stiffened_at_samples(np.where(right, 30.0, 1.0))
    other = build_corrector(stiff, 0.05 + 0.02j, known.points)
    moves, changes = moves_of(known.points, 0.1j), []
    for each in (known, other):
        targets = PointTargets(moves, np.ones(3), is_anchored=False)
        found = solve_correction(each, bent(each.paths.nodes), targets)
        assert found.target_errors.max() < 1e-9
        stretch = each.variables.at_samples.h_of(found.x).real
        changes.append(np.abs(stretch[right]).mean() / np.abs(stretch[~right]).mean())
    assert changes[1] < 0.6 * changes[0]


def test_nothing_asked_changes_nothing():
    known = corrector("bar")
    moves = np.zeros(3, dtype=np.complex128)
    found = solve_correction(
        known, bent(known.paths.nodes), PointTargets(moves, np.ones(3), is_anchored=False)
    )
    assert not found.x.any()
    assert found.steps == 0


def test_the_same_is_found_elsewhere_and_turned():
    """A base that is turned and scaled is corrected alike."""
    known = corrector("star")
    base, factor = bent(known.paths.nodes), 2 * np.exp(0.7j)
    moves = moves_of(known.points, 0.1j)
    found = solve_correction(known, base, PointTargets(moves, np.ones(6), is_anchored=False))
    turned = base._replace(
        fz=factor * base.fz, g=factor.conjugate() * base.g, by=factor.conjugate() * base.by
    )
    other = solve_correction(
        known, turned, PointTargets(factor * moves, np.ones(6), is_anchored=False)
    )
    assert_allclose(np.abs(other.x @ other.x), np.abs(found.x @ found.x), rtol=1e-6)
    assert other.shift == pytest.approx(factor * found.shift, abs=1e-7)


def test_a_share_of_a_correction_keeps_the_limits():
    known, bounds = corrector("bar"), Bounds(k=0.3, sigma_a=1.3, sigma_b=0.75)
    base, samples = (bent(z, amount=0.02) for z in (known.paths.nodes, known.boundary.points))
    moves = moves_of(known.points, 0.9j)
    found = solve_correction(known, base, PointTargets(moves, np.ones(3), is_anchored=False))
    limits = frame_limits(bounds)
    share = max_feasible_share(known.variables.at_samples, samples, found.x, limits)
    assert 0.05 < share < 0.95

    def moduli(s):
        values = known.variables.at_samples
        conformal, own, mixed, _ = samples.apply_correction(values, s * found.x)
        return np.abs(conformal), np.abs(own + mixed)

    def are_kept(a, b):
        k = (b / a).max() <= bounds.k
        return k and (a + b).max() <= bounds.sigma_a and (a - b).min() >= bounds.sigma_b

    assert are_kept(*moduli(share))
    assert not are_kept(*moduli(share + 0.03))
    # Within the limits all of it is taken; where the base is beyond, little that goes farther.
    assert (
        max_feasible_share(known.variables.at_samples, samples, 0.1 * share * found.x, limits)
        == 1.0
    )
    tight = frame_limits(Bounds(k=0.001, sigma_a=1.3, sigma_b=0.75))
    assert max_feasible_share(known.variables.at_samples, samples, found.x, tight) < 0.2 * share
    own = extremes(known, samples, found.x)
    assert (
        max_feasible_share(known.variables.at_samples, samples, found.x, frame_limits(bounds, own))
        == 1.0
    )


def test_a_start_changes_nothing_but_the_steps():
    known = corrector("star")
    base = bent(known.paths.nodes)
    targets = PointTargets(moves_of(known.points, 0.2), np.ones(6), is_anchored=False)
    far = solve_correction(known, base, targets)
    near = solve_correction(known, base, targets, start=far)
    assert near.steps <= far.steps
    assert_allclose(near.x, far.x, atol=1e-7)


def test_a_correction_that_is_not_finished_raises(monkeypatch):
    monkeypatch.setattr("engine.deform.correction.solver.MOST_STEPS", 1)
    known = corrector("star")
    moves = moves_of(known.points, 0.2)
    targets = PointTargets(moves, np.ones(6), is_anchored=True)
    task = known, bent(known.paths.nodes), targets
    with pytest.raises(EngineError, match=says(UNFINISHED, steps=1)):
        solve_correction(*task)
    assert not solve_correction(*task, throw=False).is_finished


@pytest.mark.parametrize("sign", [-1, 1])
def test_the_barrier_has_the_slope_of_its_energy(sign):
    known, e = corrector("star"), 1e-6
    samples = bent(known.boundary.points, sign=sign)
    limits = extremes(known, samples, np.zeros(2 * known.variables.count)) + 0.05
    walls = LimitBarrier(known, samples, limits)
    x, step = RNG.normal(size=(2, 2 * known.variables.count)) * 1e-3
    rise = (walls.energy(walls.state(x + e * step)) - walls.energy(walls.state(x - e * step))) / e
    assert walls.model(walls.state(x)).gradient @ step == pytest.approx(rise / 2, rel=1e-4)
    assert walls.energy(walls.state(300 * x)) == np.inf


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_a_barrier_that_is_passed_at_first_closes_in(scale):
    known = corrector("star")
    nodes, samples = (bent(z, sign=-1) for z in (known.paths.nodes, known.boundary.points))
    nothing = known.variables.nothing
    targets = PointTargets(moves_of(known.points, 0.0), np.ones(6), is_anchored=False)
    start = PointSolution(x=nothing, shift=0j, target_errors=np.zeros(6), steps=0)
    own = extremes(known, samples, nothing)
    limits = own - 0.03 * scale
    walls = LimitBarrier.around(known, samples, limits, scale, nothing)
    found = solve_correction(known, nodes, targets, start, walls)
    assert (extremes(known, samples, found.x) < limits).all()
    # Limits that cannot be kept are approached.
    far = LimitBarrier.around(known, samples, own - 1.0, scale, nothing)
    least = extremes(known, samples, solve_correction(known, nodes, targets, start, far).x)
    assert (least > own - 1.0).any()
    assert (least < own).all()
    # What has room is left alone.
    walls = LimitBarrier.around(known, samples, own + WIDTH * scale, scale, nothing)
    assert not solve_correction(known, nodes, targets, start, walls).x.any()


@pytest.mark.parametrize(("name", "sign"), [("bar", -1), ("star", 1)])
def test_others_stay_and_limits_hold_out_of_reach(name, sign):
    known, bounds = corrector(name), Bounds(k=0.4, sigma_a=1.5, sigma_b=0.6)
    nodes, samples = (
        bent(z, amount=0.02, sign=sign) for z in (known.paths.nodes, known.boundary.points)
    )
    count, size = len(known.points), known.boundary.size
    forces = np.where(np.arange(count) == 1, 8 / size, np.inf)
    moves = moves_of(known.points, size * np.exp(2j))
    targets = PointTargets(moves, np.ones(count), is_anchored=False, yield_forces=forces)
    found = solve_within(known, nodes, samples, targets, frame_limits(bounds))
    assert found.is_limited
    assert (extremes(known, samples, found.x) <= frame_limits(bounds)).all()
    assert np.delete(found.target_errors, 1).max() < 1e-4 * size
    # A part of the smallest correction, which leaves the others alone as little, goes less far.
    free = solve_correction(known, nodes, targets)
    share = max_feasible_share(known.variables.at_samples, samples, free.x, frame_limits(bounds))
    assert size - found.target_errors[1] > share * (size - free.target_errors[1])


@pytest.mark.parametrize("turn", [np.nan, 0.4])
def test_target_error_grows_with_the_cube_of_the_pull(turn):
    known = corrector("star")
    base, size = bent(known.paths.nodes), known.boundary.size
    moves, force = moves_of(known.points, 0.3 - 0.2j), 0.5 / size
    at_point = np.arange(len(moves)) == 1
    forces, turns = (
        np.where(at_point, each, other) for each, other in ((force, np.inf), (turn, np.nan))
    )
    targets = PointTargets(
        moves, np.ones(6), is_anchored=True, yield_forces=forces, rotations=turns
    )
    found = solve_correction(known, base, targets)
    lack = lack_of(known, base, found, moves)
    rows = CorrectedFrame.of(known, base, found.x).constraint_rows()
    turning = np.append(known.variables.at_points.h[:, 1].imag, np.zeros(known.variables.count))
    rows = np.vstack([rows, turning])
    pulls, rest, *_ = np.linalg.lstsq(rows.T, -found.x)
    assert rest == pytest.approx(0, abs=1e-9)
    pull = pulls[1] + 1j * pulls[7]
    assert lack[1] == pytest.approx(size * pull * abs(pull) ** 2 / force**3, rel=1e-4)
    assert np.abs(np.delete(lack, 1)).max() < 1e-9 * size
    if not np.isnan(turn):
        error = turning @ found.x - turn
        assert error == pytest.approx((pulls[-1] / (LEVER * size * force)) ** 3 / LEVER, rel=1e-4)


def test_points_slow_down_smoothly_where_limits_stop_them():
    known, limits = corrector("bar"), frame_limits(Bounds(k=0.4, sigma_a=1.5, sigma_b=0.6))
    nodes, samples = (bent(z, amount=0.02) for z in (known.paths.nodes, known.boundary.points))
    size = known.boundary.size
    forces = np.where(np.arange(3) == 1, 6 / size, np.inf)
    wanted = 0.5 * size * np.exp(2j) * np.sin(np.linspace(0, np.pi / 2, 13)[5:]) ** 2
    places = []
    for each in wanted:
        moves = moves_of(known.points, each)
        targets = PointTargets(moves, np.ones(3), is_anchored=False, yield_forces=forces)
        found = solve_within(known, nodes, samples, targets, limits)
        assert np.delete(found.target_errors, 1).max() < 1e-6 * size
        places.append(each + lack_of(known, nodes, found, moves)[1])
    assert found.target_errors[1] > 0.2 * size
    assert (np.diff(np.abs(places)) > 0).all()
    assert np.abs(np.diff(places, 2)).max() < 2 * np.abs(np.diff(wanted, 2)).max()


@pytest.mark.parametrize("outside", [5 + 5j, np.nan])
def test_points_outside_the_domain_are_refused(outside):
    with pytest.raises(EngineError):
        build_corrector(star_boundary(), 0.05 + 0.02j, np.array([0.1, outside]))
    with pytest.raises(EngineError):
        build_corrector(star_boundary(), outside, np.array([0.1 + 0j]))


@pytest.mark.parametrize(
    "changes",
    [
        {"offsets": np.full(6, np.nan + 0j)},
        {"offsets": np.full(6, np.inf + 0j)},
        {"offsets": np.zeros(5, complex)},
        {"weights": np.full(6, np.nan)},
        {"weights": np.full(6, 1.5)},
        {"weights": np.full(6, -0.1)},
        {"yield_forces": np.full(6, np.nan)},
        {"rotations": np.full(6, np.inf)},
        {"compliances": np.full(6, -1.0)},
    ],
)
def test_targets_are_refused_that_no_point_can_have(changes):
    known = corrector("star")
    given = {"offsets": np.zeros(6, complex), "weights": np.ones(6), "is_anchored": True} | changes
    with pytest.raises(EngineError):
        solve_correction(known, bent(known.paths.nodes), PointTargets(**given))


@pytest.mark.parametrize("size", [1.0, 1e11])
def test_steps_beside_a_limit_do_not_depend_on_how_near_it_is(size):
    way = RNG.normal(size=60)
    way /= np.linalg.norm(way)
    root = metric_root(size * np.outer([1.0, 0.7, -0.4], way))
    free = RNG.normal(size=60)
    free -= way * (way @ free)
    step = np.linalg.solve(root.T, np.linalg.solve(root, free))
    assert_allclose(step, free, rtol=0, atol=1e-3)
    assert abs(way @ np.linalg.solve(root.T, np.linalg.solve(root, way))) <= 1.0

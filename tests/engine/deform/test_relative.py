"""Corrections of a motion's frames: energy, bounds, invariances."""

from dataclasses import replace

import numpy as np
import pytest
from deform_shapes import BAR_POINTS, STAR_POINTS, bar_boundary, star_boundary
from holed_shapes import ring
from numpy.testing import assert_allclose, assert_array_equal

from engine.deform.model import Barrier, Jet, Walls, factor_of, factor_shifted
from engine.deform.relative import (
    Corrector,
    Pins,
    energy as energy_module,
    rows as rows_module,
)
from engine.deform.relative.between import Middles
from engine.deform.relative.corrector import LEAST_WEIGHT, MOST_STEPS, _walls
from engine.deform.relative.energy import RelativeEnergy
from engine.deform.relative.pulls import Pulls
from engine.deform.relative.rows import Rows
from engine.geometry import HERE, RigidMotion, best_rigid
from engine.maps import Boundary, Bounds

WIDE = Bounds(k=0.9, sigma_a=9.0, sigma_b=0.1)


def bent(corrector, amount=0.15):
    """A map that is not of the span: z + a exp(z) / 2 + conj(a z² / 3), far from an isometry."""
    z, points = corrector.boundary.points, corrector.points
    turn = np.exp(0.4j)

    def fz(z):
        return turn * (1 + amount / 2 * np.exp(z))

    return Jet(
        f=fz(z),
        g=np.conj(turn) * 2 * amount * z / 3,
        positions=turn * (points + amount / 2 * np.exp(points) + np.conj(amount * points**2 / 3)),
        fz=fz(points),
    )


def rest(corrector):
    boundary, points = corrector.boundary, corrector.points
    ones = np.ones(len(boundary.points), dtype=np.complex128)
    return Jet(f=ones, g=0 * ones, positions=points, fz=np.ones(len(points), dtype=np.complex128))


def pins(base, moves, *, firm=None, turns=None, reach=1.0):
    count = len(base.positions)
    return Pins(
        base.positions + moves,
        np.ones(count) if firm is None else firm,
        np.full(count, np.nan) if turns is None else turns,
        reach,
    )


def star():
    return Corrector(boundary=star_boundary(), points=STAR_POINTS)


def one_arm(by=0.3j):
    moves, firm = np.zeros(len(STAR_POINTS), dtype=complex), np.zeros(len(STAR_POINTS))
    moves[2], firm[2] = by, 1.0
    return moves, firm


def holed():
    shape = ring()
    boundary = Boundary.sample(shape.outline, shape.cage, shape.holes)
    points = np.array([shape.outline[0], shape.outline[len(shape.outline) // 2]]) * 0.97
    return Corrector(boundary=boundary, points=points)


def value_of(energy, barrier, load, unknowns):
    at = energy.base.advanced(1.0, energy.rows.change(unknowns))
    return energy.value(at, unknowns, barrier, load)


@pytest.mark.parametrize("make", [star, holed])
def test_gradient_and_hessian_are_those_of_the_value(make, monkeypatch):
    monkeypatch.setattr(rows_module, "SAMPLES_PER_FUNCTION", 10_000)
    monkeypatch.setattr(energy_module, "FELT", 0.0)
    corrector = make()
    base = bent(corrector, 0.05)
    rng = np.random.default_rng(3)
    # Some give in, where the Hessian has what Newton's step starts from.
    moves = 0.1 * rng.normal(size=len(base.positions)) * (np.arange(len(base.positions)) % 2)
    turns = np.full(len(moves), np.nan)
    turns[0] = np.angle(base.fz[0]) + 0.02
    wish = pins(base, moves, turns=turns, reach=0.4)
    rows = Rows.of(corrector.boundary, corrector.points)
    energy = RelativeEnergy(rows=rows, base=base, pins=wish)
    walls = Walls.around(WIDE, len(base.f))
    barrier = Barrier(walls=walls, weight=0.05)
    load = energy.load(barrier)
    count = len(energy.fixed)
    at = 1e-3 * rng.normal(size=count)
    # Constants on the cages of holes change no map: their stiffness is of the Hessian alone.
    free = np.flatnonzero(np.abs(rows.held).sum(axis=0) > 1e-12)
    there = base.advanced(1.0, rows.change(at))
    gradient, hessian, removed = energy.model(there, at, barrier, load)
    for direction in np.eye(count)[rng.choice(free, 6, replace=False)]:
        e = 1e-5
        ahead, back = (value_of(energy, barrier, load, at + s * e * direction) for s in (1, -1))
        slope = (ahead - back) / (2 * e)
        assert gradient @ direction == pytest.approx(slope, rel=1e-5, abs=1e-6)
        found = [
            energy.model(
                base.advanced(1.0, rows.change(at + s * e * direction)),
                at + s * e * direction,
                barrier,
                load,
            )[0]
            for s in (1, -1)
        ]
        bend = direction @ (found[0] - found[1]) / (2 * e)
        pulled = bend + along_pulls(energy, there, rows.change(direction))
        # The turn's own projection apart, and single precision.
        assert direction @ (hessian - removed) @ direction == pytest.approx(pulled, rel=2e-2)


def along_pulls(energy, at, change):
    """What a Hessian has more than the exact one, along pulls that give in."""
    lacking = at.positions - energy.pins.places
    gives = np.abs(lacking) > energy.pulls.gives
    along = (lacking.conj() * change.positions).real / np.abs(lacking)
    return float((energy.pulls.firmness(lacking) * gives) @ along**2)


def test_a_step_is_to_the_minimum_of_the_model_with_the_pulls_as_they_are():
    """All modes at once: pulls that give in, one that comes near its place, one that is held."""
    boundary = star_boundary()
    rng = np.random.default_rng(5)
    coordinates = boundary.span.coordinates(STAR_POINTS) @ boundary.basis
    stiffness = np.full(len(STAR_POINTS), 1e6 / boundary.size**2)
    lacking = np.array([0.0, 0.5, -0.8j, 1e-7, 2.0 + 1j, 0.01j])
    pulls = Pulls(
        boundary=boundary,
        coordinates=coordinates,
        stiffness=stiffness,
        firmer=np.ones(len(stiffness)),
        offsets=np.abs(lacking),
    )
    count = len(pulls.hessian(lacking))
    root = rng.normal(size=(count, count))
    alone = root @ root.T / len(root) + 120.0 * np.eye(len(root))
    elsewhere = rng.normal(size=len(alone))

    def pulled(unknowns):
        return Rows.of(boundary, STAR_POINTS).change(unknowns).positions

    def slope_of(step):
        """The gradient of the model, by each direction."""
        after = lacking + pulled(step)
        force = pulls.firmness(after) * after
        moves = np.array([pulled(each) for each in np.eye(len(alone))])
        by_pulls = (moves.conj() @ force).real
        return alone @ step + elsewhere + by_pulls

    nothing = np.zeros(len(alone))
    factor = factor_of(alone + pulls.hessian(lacking), 0.0)
    step = pulls.step(factor, slope_of(nothing), lacking)
    assert np.abs(slope_of(step)).max() < 1e-3 * np.abs(slope_of(nothing)).max()
    after = np.abs(lacking + pulled(step))
    assert (after[1:] > pulls.gives[1:]).any()
    assert (after[1:] < pulls.gives[1:]).any()


def test_nothing_is_the_minimum_where_nothing_is_asked():
    corrector = star()
    base = bent(corrector)
    # Also where a wall is felt: its own slope is taken off.
    for bounds in (WIDE, Bounds(k=0.3, sigma_a=1.4, sigma_b=0.7)):
        found = corrector.correct(base, pins(base, 0.0), bounds)
        assert np.abs(found.change.positions).max() < 1e-12
        assert np.abs(found.change.f).max() < 1e-11


def test_nothing_is_the_minimum_however_near_a_wall_is():
    boundary, nowhere = star_boundary(), np.zeros(0, dtype=np.complex128)
    corrector = Corrector(boundary=boundary, points=nowhere)
    ones = np.ones(len(boundary.points), dtype=np.complex128)
    base = Jet(f=1.25 * ones, g=0.25 * ones, positions=nowhere, fz=nowhere)
    # 1e-5 below the largest stretch, and far from the other bounds.
    walls = Walls.around(Bounds(k=0.9, sigma_a=1.50001, sigma_b=0.1), len(ones))
    barrier = Barrier(walls=walls, weight=1e-3)
    energy = RelativeEnergy(rows=corrector.rows, base=base, pins=pins(base, 0.0))
    load, nothing = energy.load(barrier), np.zeros(len(energy.fixed))
    least = energy.value(base, nothing, barrier, load)
    cage = boundary.span.cage
    for amount in (-0.1, -1e-3, -1e-5, 1e-5, 1e-3, 0.1):
        # Along the wall: |F| + |G| stays.
        along = base.advanced(1.0, corrector.measured(-amount * cage, amount * cage))
        assert_allclose(np.abs(along.f) + np.abs(along.g), 1.5, rtol=1e-10)
        assert energy.value(along, nothing, barrier, load) > least


def test_a_common_motion_of_all_pins_is_a_rigid_one():
    corrector = star()
    base = bent(corrector)
    turned = np.exp(0.3j) * base.positions + 0.2 - base.positions
    found = corrector.correct(base, pins(base, turned), WIDE)
    after = base.advanced(1.0, found.change)
    assert_allclose(after.f, np.exp(0.3j) * base.f, atol=2e-3)
    assert_allclose(after.g, np.exp(-0.3j) * base.g, atol=2e-3)


@pytest.mark.parametrize("make", [star, holed])
def test_pins_are_reached_within_the_bounds_where_there_is_room(make):
    corrector = make()
    base = bent(corrector, 0.05)
    moves = np.zeros(len(base.positions), dtype=complex)
    moves[-1] = 0.1 + 0.05j
    found = corrector.correct(base, pins(base, moves), WIDE)
    assert found.misses.max() < 1e-4 * corrector.boundary.size
    assert found.steps <= 8
    assert not found.is_held_back


@pytest.mark.parametrize("seed", range(3))
def test_bounds_are_kept_however_far_pins_are_wanted(seed):
    rng = np.random.default_rng(seed)
    corrector = star()
    base = bent(corrector, 0.08)
    bounds = Bounds(k=0.35, sigma_a=1.5, sigma_b=0.6)
    count = len(STAR_POINTS)
    moves = rng.normal(size=count) + 1j * rng.normal(size=count)
    found = corrector.correct(base, pins(base, moves), bounds)
    after = base.advanced(1.0, found.change)
    a, b = np.abs(after.f), np.abs(after.g)
    assert (b / a).max() < bounds.k
    assert (a + b).max() < bounds.sigma_a
    assert (a - b).min() > bounds.sigma_b
    assert found.is_held_back
    assert found.steps > 2


TIGHT = Bounds(k=0.35, sigma_a=1.5, sigma_b=0.6)


@pytest.mark.parametrize("bounds", [Bounds(), TIGHT])
@pytest.mark.parametrize("by", [1.5, 3.0j, -30.0, 1000.0 - 500.0j])
def test_a_pin_wanted_far_out_of_reach_comes_to_rest_and_tears_at_nothing(by, bounds):
    corrector = star()
    base = bent(corrector, 0.08)
    moves, firm = one_arm(by)
    wish = pins(base, moves, firm=firm)
    found = corrector.correct(base, wish, bounds)
    assert found.steps < MOST_STEPS
    assert found.is_held_back
    assert found.misses[np.arange(len(moves)) != 2].max() < 0.04
    # Nothing leads on: what is minimised rises in all directions alike.
    energy = RelativeEnergy(rows=corrector.rows, base=base, pins=wish)
    barrier = Barrier(walls=_walls(base, bounds), weight=LEAST_WEIGHT)
    unknowns = np.linalg.lstsq(corrector.boundary.basis, found.phi, rcond=None)[0]
    psi = np.linalg.lstsq(corrector.boundary.basis, found.psi, rcond=None)[0]
    at = np.concatenate([unknowns, psi[1:]]).conj().view(np.float64)
    there = base.advanced(1.0, found.change)
    gradient, hessian, _ = energy.model(there, at, barrier, energy.load(barrier))
    step = energy.pulls.step(factor_shifted(hessian), gradient, there.positions - wish.places)
    assert np.abs(corrector.rows.change(step).positions).max() < 1e-3
    assert -gradient @ step < 1e-5


@pytest.mark.parametrize("bounds", [Bounds(), TIGHT])
def test_corrections_are_continuous_in_wishes_out_of_reach(bounds):
    corrector = star()
    base = bent(corrector, 0.08)

    def found(wish):
        moves, firm = one_arm(wish)
        return corrector.correct(base, pins(base, moves, firm=firm), bounds).change.positions

    places = np.array([found(3.0 * np.exp(1j * angle)) for angle in 2.8 + 0.01 * np.arange(4)])
    jumps = np.abs(np.diff(places, axis=0)).max(axis=1)
    assert jumps.max() < 0.03
    assert jumps.max() < 2.0 * jumps.min()


def test_a_base_beyond_its_bounds_gets_no_worse():
    corrector = star()
    base = bent(corrector, 0.3)
    bounds = Bounds(k=0.05, sigma_a=1.05, sigma_b=0.95)
    moves, firm = one_arm(0.2j)
    found = corrector.correct(base, pins(base, moves, firm=firm), bounds)
    after, a0, b0 = base.advanced(1.0, found.change), np.abs(base.f), np.abs(base.g)
    a, b = np.abs(after.f), np.abs(after.g)
    assert (b / a).max() <= (b0 / a0).max() + 1e-4
    assert (a + b).max() <= (a0 + b0).max() * (1 + 1e-4)
    assert (a - b).min() >= (a0 - b0).min() * (1 - 1e-4)


def test_a_base_that_folds_stays_as_it_is():
    corrector = star()
    base = bent(corrector, 3.0)
    assert np.any(np.abs(base.f) <= np.abs(base.g))
    moves, firm = one_arm(0.2j)
    found = corrector.correct(base, pins(base, moves, firm=firm), WIDE)
    assert not found.phi.any()
    assert not found.psi.any()
    assert found.misses[2] == pytest.approx(0.2)


def test_a_correction_turns_with_its_base():
    corrector = star()
    base = bent(corrector)
    moves, firm = one_arm()
    found = corrector.correct(base, pins(base, moves, firm=firm), WIDE)
    motion = RigidMotion(np.exp(1.1j), 3 - 2j)
    turned = base.moved(motion)
    again = corrector.correct(turned, pins(turned, motion.factor * moves, firm=firm), WIDE)
    assert_allclose(again.change.f, motion.factor * found.change.f, atol=1e-6)
    assert_allclose(again.change.positions, motion.factor * found.change.positions, atol=1e-6)


def test_a_point_is_turned_where_it_is_asked():
    corrector = star()
    base = bent(corrector)
    turns = np.full(len(STAR_POINTS), np.nan)
    turns[2] = np.angle(base.fz[2]) + 0.5
    found = corrector.correct(base, pins(base, 0.0, turns=turns), WIDE)
    after = base.advanced(1.0, found.change)
    assert np.angle(after.fz[2] / base.fz[2]) == pytest.approx(0.5, abs=5e-3)


def test_a_smaller_reach_moves_less_of_the_outline():
    corrector = star()
    base = rest(corrector)
    moves, firm = one_arm(0.25)
    moved = []
    for reach in (1.0, 0.5, 0.0):
        found = corrector.correct(base, pins(base, moves, firm=firm, reach=reach), WIDE)
        coordinates = corrector.boundary.vertex_coordinates
        places = coordinates @ found.phi + (coordinates @ found.psi).conj()
        moved.append(np.mean(np.abs(places) ** 2))
        assert found.misses[2] < 1e-3
    assert moved[0] > moved[1] > moved[2]


def test_the_same_is_asked_the_same_is_found():
    corrector = star()
    base = bent(corrector)
    moves, firm = one_arm()
    wish = pins(base, moves, firm=firm)
    one, other = (corrector.correct(base, wish, WIDE) for _ in range(2))
    assert_array_equal(one.phi, other.phi)
    assert_array_equal(one.psi, other.psi)
    measured = corrector.measured(one.phi, one.psi)
    assert_allclose(measured.f, one.change.f, atol=1e-10)
    assert_allclose(measured.positions, one.change.positions, atol=1e-10)


def test_limits_of_each_sample_are_those_of_all_where_they_are_the_same():
    boundary = bar_boundary()
    corrector = Corrector(boundary=boundary, points=BAR_POINTS)
    base = rest(corrector)
    wish = pins(base, np.array([0.0, 0.8j, 0.0]))
    bounds = Bounds(k=0.3, sigma_a=1.4, sigma_b=0.7)
    count = len(boundary.points)
    local = replace(Bounds())  # any limits: arrays in place of its numbers
    for name in ("k", "sigma_a", "sigma_b"):
        object.__setattr__(local, name, np.full(count, getattr(bounds, name)))
    one, other = (corrector.correct(base, wish, limits) for limits in (bounds, local))
    assert_array_equal(one.phi, other.phi)


class TestBestRigid:
    places = np.array([1 + 2j, -1 + 0.5j, 2 - 1j])

    def test_it_brings_one_point_where_it_should_be(self):
        offsets = np.array([0.3 - 0.2j, 0, 0])
        found = best_rigid(self.places, offsets, np.array([1.0, 0, 0]))
        assert_allclose(found.on(self.places)[0], self.places[0] + offsets[0], atol=1e-5)

    def test_it_brings_points_that_move_together(self):
        motion = RigidMotion(np.exp(0.3j), 0.5 - 1j)
        offsets = motion.on(self.places) - self.places
        found = best_rigid(self.places, offsets, np.ones(3))
        assert_allclose(found.on(self.places), motion.on(self.places), atol=3e-3)

    def test_a_pivot_stays(self):
        found = best_rigid(self.places, np.array([0.3j, 0, 0.1]), np.ones(3), pivot=0.5 + 0.5j)
        assert found.on(np.array([0.5 + 0.5j]))[0] == pytest.approx(0.5 + 0.5j)
        assert abs(found.factor) == pytest.approx(1.0)
        assert found.factor != 1.0

    def test_where_nothing_is_lacking_nothing_moves(self):
        found = best_rigid(self.places, 0j * self.places, np.ones(3))
        assert_allclose(found.on(self.places), self.places, rtol=0, atol=1e-15)
        assert best_rigid(self.places, self.places, np.zeros(3)) is HERE


def test_between_samples_a_correction_keeps_what_is_allowed_or_as_much_of_it_as_does():
    boundary, count = star_boundary(), len(star_boundary().points)
    corrector = Corrector(boundary=boundary, points=STAR_POINTS[:2])
    middles = Middles.of(boundary)
    base, still = bent(corrector), rest(corrector)
    between = (boundary.points + boundary.points[boundary.following]) / 2
    exact = bent(replace(corrector, boundary=replace(boundary, points=between)))
    assert_allclose(middles.along(base.f)[count:], exact.f, rtol=1e-5)
    assert_allclose(middles.along(base.g)[count:], exact.g, atol=1e-5)
    change = still.scaled(-1.0).advanced(1.0, base)
    assert middles.share_within(still, change, WIDE, boundary) == 1.0
    largest = (np.abs(exact.f) + np.abs(exact.g)).max()
    tight = Bounds(k=0.9, sigma_a=(1 + largest) / 2, sigma_b=0.1)
    share = middles.share_within(still, change, tight, boundary)
    assert 0.3 < share < 1.0
    f, g = (middles.along(a + share * b) for a, b in ((still.f, change.f), (still.g, change.g)))
    assert_allclose((np.abs(f) + np.abs(g)).max(), tight.sigma_a, rtol=1e-6)

"""Rigid shafts, hinges and aims: their energy, and limbs that keep their lengths."""

import numpy as np
import pytest
from deform_shapes import bar_boundary
from numpy.testing import assert_allclose

from engine.deform import (
    Aim,
    Armature,
    BoundedPull,
    Deformer,
    Handles,
    Hinge,
    Objective,
    Shaft,
    Ties,
)
from engine.deform.forces.posed_armature import PosedArmature
from engine.deform.model.hessian import hessian_product
from engine.domain.material.line_ties import BendingPlace, tie_lines
from engine.errors import EngineError
from engine.maps import Bounds

BOUNDARY = bar_boundary()
# Two bones in a bar from -2 to 2: a root, a joint that is no handle, and an end.
ROOT, JOINT, END = -1.8, 0.0, 1.8
UPPER = np.linspace(-1.8, -0.7, 4).astype(complex)
LOWER = np.linspace(0.7, 1.8, 4).astype(complex)
SHAFTS = (Shaft(UPPER, UPPER), Shaft(LOWER, LOWER, weights=np.linspace(0.3, 1.0, 4)))
TIES = Ties(
    np.linspace(-0.5, 0.5, 5) + 0.49j, np.linspace(-0.5, 0.5, 5) + 0.4j, np.linspace(1.0, 2.0, 5)
)
ARMATURE = Armature.place(BOUNDARY, SHAFTS, [Hinge(0, 1, JOINT, JOINT)], TIES)
HANDLES = Handles.place(BOUNDARY, np.array([END], complex), None, ARMATURE)
FREE = Handles.place(BOUNDARY, np.array([END], complex))
AIMS = (
    Aim(0, ROOT, ROOT + 0.05j),
    Aim(0, JOINT, 0.3j, 10.0),
    Aim(1, END, 0.2j + END, 30.0, weight=2.0),
    Aim(1, 0.5, 0.5 * np.exp(0.2j), 5.0, is_way=True),
)


def objective(handles=HANDLES, aims=AIMS):
    targets = handles.targets(np.array([END + 0.1j]), aims=aims)
    return Objective(boundary=BOUNDARY, handles=handles, targets=targets)


def posed(armature, positions):
    return PosedArmature(armature=armature, positions=positions, aims=None)


def bent_map():
    cage = BOUNDARY.cage
    return cage * np.exp(0.4j) + 0.03j * cage**2, 0.05 * cage + 0.02 * cage**2


def test_a_armature_costs_nothing_after_a_rigid_motion():
    turned = np.exp(0.7j) * BOUNDARY.cage + 0.3
    jet = objective().evaluate(turned, 0 * turned)
    assert posed(ARMATURE, jet.shaft_positions).energy == pytest.approx(0.0, abs=1e-9)
    moved = ARMATURE.shafts.carried(
        ARMATURE.motions(jet.shaft_positions), np.array([0, 1]), np.array([JOINT, END + 1j])
    )
    assert_allclose(moved, np.exp(0.7j) * np.array([JOINT, END + 1j]) + 0.3, atol=1e-12)


def test_a_armature_has_no_resultant_and_no_moment():
    jet = objective().evaluate(*bent_map())
    force = posed(ARMATURE, jet.shaft_positions).gradient
    assert np.abs(force).max() > 1.0
    assert abs(force.sum()) < 1e-9 * np.abs(force).sum()
    assert abs(np.vdot(force, 1j * jet.shaft_positions).real) < 1e-9 * np.abs(force).sum()


def test_the_gradient_of_a_armature_is_that_of_its_energy():
    rng, boned = np.random.default_rng(4), objective()
    jet = boned.evaluate(*bent_map())
    gradient = boned.gradient(jet, boned.radial_derivatives(jet))
    for _ in range(4):
        change = boned.evaluate_change(direction := rng.normal(size=len(gradient)))
        ahead, behind = (boned.energy(jet.advanced(by, change)) for by in (1e-6, -1e-6))
        assert (ahead - behind) / 2e-6 == pytest.approx(gradient @ direction, rel=1e-4)


def test_the_hessian_of_a_armature_is_that_of_its_product():
    rng, boned, free = np.random.default_rng(5), objective(), objective(FREE, ())
    jet = boned.evaluate(*bent_map())
    radial = boned.radial_derivatives(jet)
    direction = rng.normal(size=len(HANDLES.hessian))
    change = boned.evaluate_change(direction)
    added, removed = boned.armature_rows(jet)
    matrix = HANDLES.hessian - FREE.hessian + added.T @ added - removed.T @ removed
    products = [hessian_product(each, jet, radial, change) for each in (boned, free)]
    assert_allclose(matrix @ direction, np.subtract(*products), rtol=1e-9, atol=1e-6)
    assert np.linalg.eigvalsh(matrix).min() > -1e-9 * np.abs(matrix).max()


def test_the_hessian_of_shafts_is_exact_where_it_is_positive():
    shafts = Armature.place(BOUNDARY, SHAFTS)
    positions = 1.3 * np.exp(0.2j) * shafts.shafts.points + 0.05j * shafts.shafts.points**2
    rng = np.random.default_rng(6)
    changes = rng.normal(size=len(positions)) + 1j * rng.normal(size=len(positions))
    ahead, behind = (posed(shafts, positions + by * changes).gradient for by in (1e-6, -1e-6))
    product = posed(shafts, positions).hessian_product(changes)
    assert_allclose((ahead - behind) / 2e-6, product, rtol=1e-5, atol=1e-4)


def test_a_limb_keeps_its_length_when_its_hand_is_pulled():
    deformer = Deformer(boundary=BOUNDARY, handles=HANDLES, bounds=Bounds(k=0.7))
    goal = ROOT + 1.8 * (np.exp(-0.6j) + np.exp(0.6j))
    aims = (Aim(0, ROOT, ROOT), Aim(0, JOINT, ROOT + 1.8 * np.exp(-0.6j), 50.0))
    targets = HANDLES.targets(np.array([goal]), None, [BoundedPull([0], 50.0)], aims)
    state, _ = deformer.settle(deformer.start(), targets)
    assert state.certificate.is_certified
    positions = ARMATURE.coordinates @ state.map.columns[0]
    positions = positions + (ARMATURE.coordinates @ state.map.columns[1]).conj()
    motions = ARMATURE.motions(positions)
    ends = ARMATURE.shafts.carried(
        motions, np.array([0, 0, 1, 1]), np.array([ROOT, JOINT, JOINT, END], complex)
    )
    assert abs(ends[0] - ROOT) < 0.02
    assert abs(ends[1] - ends[2]) < 0.02
    assert abs(deformer.positions(state)[0] - goal) < 0.02
    assert np.abs(np.abs(motions.correlations) / ARMATURE.shafts.squares - 1.0).max() < 0.03
    left = targets.released(deformer.positions(state))
    assert left.pulls is None
    assert left.aims is targets.aims
    assert not targets.is_same(targets._replace(aims=None))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Armature.place(BOUNDARY, [Shaft(UPPER[:1], UPPER[:1])]), "Shaft 0 needs two"),
        (lambda: Armature.place(BOUNDARY, SHAFTS, [Hinge(0, 2, 0, 0)]), "joins shafts 0 and 2"),
        (lambda: HANDLES.targets([0j], aims=[Aim(2, 0, 0)]), "only 2 shafts"),
        (lambda: FREE.targets([0j], aims=[Aim(0, 0, 0)]), "only 0 shafts"),
        (lambda: HANDLES.targets([0j], aims=[Aim(0, 0, 0, 0.0)]), "must be positive, not 0"),
    ],
)
def test_a_wrong_armature_is_refused(make, message):
    with pytest.raises(EngineError, match=message):
        make()


def bent_bar(ties):
    """Return the map of a bar bent by 100° at its joint, and its hinge."""
    axes = [np.linspace(*ends, 5).astype(complex) for ends in ((-1.8, -0.45), (0.45, 1.8))]
    shafts = [Shaft(axis, axis) for axis in axes]
    armature = Armature.place(BOUNDARY, shafts, [Hinge(0, 1, JOINT, JOINT)], ties)
    handles = Handles.place(BOUNDARY, np.array([END], complex), None, armature)
    ways = 1.8 * np.exp(1j * np.radians([50.0, -50.0]))
    aims = (Aim(0, ROOT, ROOT), Aim(0, JOINT, ROOT + ways[0], 50.0))
    targets = handles.targets(np.array([ROOT + ways.sum()]), None, (), aims)
    deformer = Deformer(
        boundary=BOUNDARY, handles=handles, bounds=Bounds(k=0.85, sigma_a=4.0, sigma_b=0.15)
    )
    state, _ = deformer.settle(deformer.start(), targets)
    assert state.certificate.is_certified
    assert state.certificate.sigma_b > 0
    return state.map, ROOT + ways[0]


def test_ties_keep_the_line_of_a_bent_bar_and_round_its_elbow():
    """A mitre of two straight bones lies 56 % too far outside, and its line is as thick again."""
    joints = [BendingPlace(JOINT, 0.5)]
    starts, ends, shares = tie_lines(BOUNDARY.domain.loops, joints)
    outside = np.linspace(-1.0, 1.0, 81) + 0.5j * (1 - 1e-9)
    thickness, distance = [], []
    for ties in (Ties(starts, ends, 0 * shares), Ties(starts, ends, 150 * shares)):
        shape, elbow = bent_bar(ties)
        f, g = shape.derivatives(outside)
        thickness.append(np.abs(1j * f + np.conj(1j * g)).max())
        distance.append(abs(shape(outside[40:41])[0] - elbow) / 0.5)
    assert thickness[0] > 2.9
    assert thickness[1] < 2.05
    assert distance[0] > 1.6
    assert 0.7 < distance[1] < 1.1

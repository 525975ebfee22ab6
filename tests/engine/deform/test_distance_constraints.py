"""Links that keep handles in reach of each other while a hand pulls."""

import numpy as np
import pytest
from deform_shapes import BAR_POINTS, bar_boundary
from messages import says
from numpy.testing import assert_allclose

from engine.deform import BoundedPull, Deformer, DistanceConstraint, Handles, Objective
from engine.deform.model.hessian import hessian_product
from engine.deform.pulls import CONSTRAINT_ENDS, CONSTRAINT_LENGTHS
from engine.errors import EngineError
from engine.maps import Bounds

BOUNDARY = bar_boundary()
HANDLES = Handles.place(BOUNDARY, BAR_POINTS)
# One that is too short, one that is too long, and one within its range.
LINKS = [
    DistanceConstraint(0, 1, 2.0, 2.2),
    DistanceConstraint(1, 2, 1.0, 1.1),
    DistanceConstraint(0, 2, 3.0, 5.0),
]


def objective(*links):
    handle_targets = HANDLES.targets(BAR_POINTS + 0.1j, None, (), links)
    return Objective(boundary=BOUNDARY, handles=HANDLES, targets=handle_targets)


def bent_jet():
    cage = BOUNDARY.cage
    return objective().evaluate(cage + 0.03j * cage**2, 0.02 * cage)


def test_links_cost_what_their_distances_are_beyond_their_range():
    jet = bent_jet()
    lengths = np.abs(np.diff(jet.positions))
    cost = HANDLES.stiffness[0] * ((lengths[0] - 2.0) ** 2 + (lengths[1] - 1.1) ** 2)
    added = objective(*LINKS).energy(jet) - objective().energy(jet)
    assert added == pytest.approx(cost, rel=1e-9)


def test_their_derivatives_are_those_of_their_energy():
    rng, jet = np.random.default_rng(4), bent_jet()
    linked, free = objective(*LINKS), objective()
    gradient = linked.gradient(jet, linked.radial_derivatives(jet))
    for _ in range(3):
        change = linked.evaluate_change(direction := rng.normal(size=len(gradient)))
        ahead, behind = (linked.energy(jet.advanced(by, change)) for by in (1e-6, -1e-6))
        assert (ahead - behind) / 2e-6 == pytest.approx(gradient @ direction, rel=1e-5)
    # The projection leaves out what is negative: across a link that is too short.
    rows, radial = linked.distance_constraint_rows(jet), linked.radial_derivatives(jet)
    assert len(rows) == 3
    products = [hessian_product(each, jet, radial, change) for each in (linked, free)]
    assert_allclose(rows.T @ (rows @ direction), np.subtract(*products), rtol=1e-9, atol=1e-6)
    # Of one that is too long it is the whole Hessian.
    rows = objective(LINKS[1]).distance_constraint_rows(jet)
    ends = [jet.advanced(by, change) for by in (1e-6, -1e-6)]
    slopes = [
        np.subtract(*(each.gradient(end, each.radial_derivatives(end)) for end in ends)) / 2e-6
        for each in (objective(LINKS[1]), free)
    ]
    wanted = np.subtract(*slopes)
    assert_allclose(rows.T @ (rows @ direction), wanted, atol=1e-5 * np.abs(wanted).max())


def pulled(links):
    deformer = Deformer(boundary=BOUNDARY, handles=HANDLES, bounds=Bounds(k=0.6))
    handle_targets = HANDLES.targets(
        BAR_POINTS + np.array([0, 0, 2]), None, [BoundedPull([2])], links
    )
    state, _ = deformer.settle(deformer.start(), handle_targets)
    assert state.certificate.is_certified
    return deformer, handle_targets, state


def test_a_link_stops_a_hand_that_pulls_too_far_and_the_pose_stays_when_it_lets_go():
    deformer, handle_targets, state = pulled([DistanceConstraint(1, 2, 0.0, 1.9)])
    places = deformer.positions(state)
    assert abs(places[2] - places[1]) < 1.9 * 1.01
    _, _, usual = pulled(())
    assert abs(np.diff(deformer.positions(usual))[1]) > 2.2
    left = handle_targets.released(places, HANDLES.stiffness)
    assert left.pulls is left.distance_constraints is None
    after, _ = deformer.settle(state, left)
    assert_allclose(deformer.positions(after), places, atol=1e-3)
    assert not handle_targets.is_same(
        HANDLES.targets(handle_targets.positions, None, [BoundedPull([2])])
    )


@pytest.mark.parametrize(
    ("link", "message"),
    [
        ((0, 0, 1.0, 2.0), says(CONSTRAINT_ENDS, first=0, second=0)),
        ((0, 3, 1.0, 2.0), says(CONSTRAINT_ENDS, first=0, second=3)),
        ((0, 1, 2.0, 1.0), says(CONSTRAINT_LENGTHS, shortest=2, longest=1)),
        ((0, 1, np.nan, 1.0), says(CONSTRAINT_LENGTHS, shortest=float("nan"), longest=1)),
    ],
)
def test_links_that_are_none_are_refused(link, message):
    with pytest.raises(EngineError, match=message):
        objective(DistanceConstraint(*link))

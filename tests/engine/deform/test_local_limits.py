"""Bounds, and weights of the energy, that differ from sample to sample of the boundary."""

from dataclasses import replace

import numpy as np
import pytest
from deform_shapes import BAR_POINTS, bar_boundary, dense_outline
from numpy.testing import assert_array_equal

from engine.deform import Deformer, Handles, Status
from engine.maps import Bounds, LocalBounds, certify

BOUNDARY = bar_boundary()
COUNT = len(BOUNDARY.points)
LEFT = BOUNDARY.points.real < 0
# The ends of a bar go up, and farther apart.
WANTED = np.array([-2.2 + 0.2j, 0.0, 2.2 + 0.2j])
FARTHER = np.array([-2.4 + 0.8j, 0.0, 2.4 + 0.8j])


def bar(bounds, boundary=BOUNDARY):
    return Deformer(boundary=boundary, handles=Handles.place(boundary, BAR_POINTS), bounds=bounds)


def two_halves(left, right, is_left=LEFT):
    """Return the bounds of the left half and of the right one."""
    return LocalBounds(
        k=np.where(is_left, left.k, right.k),
        sigma_a=np.where(is_left, left.sigma_a, right.sigma_a),
        sigma_b=np.where(is_left, left.sigma_b, right.sigma_b),
    )


def extremes_of(f, half):
    """Return the extremes of a map on a half of the outline, but next to the other one."""
    points = dense_outline(BOUNDARY)
    fz, fzbar = f.derivatives(points[half * points.real > 0.05])
    a, b = np.abs(fz), np.abs(fzbar)
    return {"k": (b / a).max(), "sigma_a": (a + b).max(), "sigma_b": (a - b).min()}


def come_to_rest(deformer, start=None, wanted=WANTED):
    handle_targets = deformer.handles.targets(wanted)
    state = deformer.start() if start is None else start
    for _ in range(500):
        state = deformer.step(state, handle_targets)
        if state.status.is_final:
            return state
    raise AssertionError("the shape does not come to rest")


@pytest.mark.parametrize("bounds", [Bounds(), Bounds(k=0.12, sigma_a=1.25, sigma_b=0.8)])
def test_bounds_that_are_alike_everywhere_are_those_of_the_shape_to_the_last_bit(bounds):
    single, each = come_to_rest(bar(bounds)), come_to_rest(bar(two_halves(bounds, bounds)))
    assert_array_equal(each.map.coefficients, single.map.coefficients)
    assert (each.status, each.search_steps) == (single.status, single.search_steps)


def test_each_half_keeps_its_own_bounds_and_uses_them():
    tight, loose = (
        Bounds(k=0.1, sigma_a=1.15, sigma_b=0.87),
        Bounds(k=0.3, sigma_a=1.6, sigma_b=0.6),
    )
    limits = two_halves(tight, loose)
    state = come_to_rest(bar(limits))
    assert state.status is Status.AT_LIMITS
    assert certify(state.map, BOUNDARY, limits).is_certified
    assert tight.allow(**extremes_of(state.map, -1))
    right = extremes_of(state.map, 1)
    assert loose.allow(**right)
    assert right["sigma_a"] > 1.05 * tight.sigma_a
    assert not certify(state.map, BOUNDARY, tight).is_certified
    # A drag from there into the mirrored bounds walks out of the ones and into the others.
    mirrored = two_halves(loose, tight, BOUNDARY.points.real <= 0)
    back = come_to_rest(bar(mirrored), bar(mirrored).resume(state.map))
    assert certify(back.map, BOUNDARY, mirrored).is_certified
    assert loose.allow(**extremes_of(back.map, -1))
    assert tight.allow(**extremes_of(back.map, 1))
    assert back.statistics.objective == pytest.approx(state.statistics.objective, rel=1e-3)


def test_a_softer_half_bends_more():
    stiffness = np.where(LEFT, 1.0, 20.0)
    soft = replace(BOUNDARY, weights=BOUNDARY.weights * stiffness)
    state = come_to_rest(bar(Bounds(), soft), wanted=FARTHER)
    left, right = extremes_of(state.map, -1), extremes_of(state.map, 1)
    assert left["sigma_a"] - 1 > 1.5 * (right["sigma_a"] - 1)
    even = come_to_rest(bar(Bounds()), wanted=FARTHER)
    assert left["sigma_a"] > 1.05 * extremes_of(even.map, -1)["sigma_a"]
    assert right["sigma_a"] < 0.9 * extremes_of(even.map, 1)["sigma_a"]
    # Where it is as stiff everywhere as it ever was nothing changes.
    same = replace(BOUNDARY, weights=BOUNDARY.weights * np.ones(COUNT))
    again = come_to_rest(bar(Bounds(), same), wanted=FARTHER)
    assert_array_equal(again.map.coefficients, even.map.coefficients)

"""The way to rest: samples that are added, and when the barrier's weight falls."""

from dataclasses import replace

import numpy as np
from deform_shapes import search_from_rest
from numpy.testing import assert_array_equal

from engine.deform import Objective
from engine.deform.rest.continuation import AT_A_SADDLE, CENTRED, LOWER, weighed
from engine.deform.rest.samples import resolved


def measured(search):
    objective = Objective(boundary=search.boundary, handles=search.handles, wish=search.wish)
    return objective.jet(*search.map.columns)


def test_a_segment_that_broke_a_bound_gets_a_sample_though_there_are_too_many(monkeypatch):
    # Without it no later step is certified: a search once ended there.
    monkeypatch.setattr("engine.deform.rest.samples.MOST_SAMPLES", 0)
    search = search_from_rest(8)
    broken = np.array([3, 40])
    finer = resolved(search, measured(search), broken)
    assert len(finer.boundary.points) == len(search.boundary.points) + 2
    ends = search.boundary.following[broken]
    middles = (search.boundary.points[broken] + search.boundary.points[ends]) / 2
    assert_array_equal(finer.boundary.points[[4, 42]], middles)
    assert finer.duals.shape == (3, len(finer.boundary.points))
    assert len(finer.walls.k) == len(finer.boundary.points)


def test_samples_are_added_where_segments_bulge_most_first(monkeypatch):
    search = search_from_rest(8)
    base = replace(search, boundary=search.boundary)
    none = np.empty(0, np.intp)
    for _ in range(20):
        finer = resolved(base, measured(base), none)
        if len(finer.boundary.points) > len(base.boundary.points):
            break
        base = search_from_rest(base.steps + 2)
    added = len(finer.boundary.points) - len(base.boundary.points)
    assert added > 1
    own = np.count_nonzero(base.boundary.weights)
    monkeypatch.setattr(
        "engine.deform.rest.samples.MOST_SAMPLES", (len(base.boundary.points) + 1.5) / own
    )
    fewer = resolved(base, measured(base), none)
    assert len(fewer.boundary.points) == len(base.boundary.points) + 1


def test_the_weight_falls_where_little_is_left_to_gain_but_not_at_a_saddle():
    search = search_from_rest(3)
    search = replace(search, length=1.0, weight=0.01 * search.energy)
    search = replace(search, optimality=search.optimality._replace(measure=0.1))
    much = replace(search, gain=2 * CENTRED * search.weight)
    little = replace(search, gain=0.5 * CENTRED * search.weight)
    least = replace(search, gain=0.5 * AT_A_SADDLE * CENTRED * search.weight)
    assert weighed(much, convex=True).weight == search.weight
    assert weighed(little, convex=True).weight == LOWER * search.weight
    # A saddle: from there a valley may lead on, at this weight.
    assert weighed(little, convex=False).weight == search.weight
    assert weighed(least, convex=False).weight == LOWER * search.weight
    # A barrier that outweighs the energy shapes the valley itself.
    heavy = replace(little, optimality=search.optimality._replace(measure=2.0))
    assert weighed(heavy, convex=False).weight == LOWER * search.weight
    # A step that was cut short says nothing.
    assert weighed(replace(little, length=0.1), convex=True).weight == search.weight

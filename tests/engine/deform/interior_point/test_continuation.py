"""The way to rest: samples that are added, when the barrier's weight falls, and walls that open."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from deform_shapes import search_from_rest
from numpy.testing import assert_allclose, assert_array_equal
from shapes import regular_polygon

from engine.deform import ActiveBound, Deformer, Handles, Objective, Status
from engine.deform.interior_point.continuation import (
    AT_A_SADDLE,
    CENTRED,
    LOWER,
    LOWER_IN_THE_OPEN,
    RAISED_PER_GAIN,
    advance_search,
    is_centred,
    lower_weight,
    raise_weight,
)
from engine.deform.interior_point.homotopy import (
    FIRST_LEVEL_WIDTH,
    are_same_bounds,
    exceed_first_level,
    homotopy_level,
)
from engine.deform.interior_point.samples import resolve_segments
from engine.deform.interior_point.search import StartingPoint
from engine.deform.model.barrier import BarrierBounds
from engine.geometry import Domain
from engine.maps import Boundary, Bounds, segment_enclosures


def measured(search):
    objective = Objective(boundary=search.boundary, handles=search.handles, targets=search.targets)
    return objective.evaluate(*search.map.columns)


def with_samples(search, broken):
    enclosures = segment_enclosures(search.map, search.boundary)
    return resolve_segments(search, measured(search), enclosures, broken)


def test_a_segment_that_broke_a_bound_gets_a_sample_though_there_are_too_many(monkeypatch):
    # Without it no later step is certified: a search once ended there.
    monkeypatch.setattr("engine.deform.interior_point.samples.MOST_SAMPLES", 0)
    search = search_from_rest(8)
    broken = np.array([3, 40])
    finer = with_samples(search, broken)
    assert len(finer.boundary.points) == len(search.boundary.points) + 2
    ends = search.boundary.next_samples[broken]
    middles = (search.boundary.points[broken] + search.boundary.points[ends]) / 2
    assert_array_equal(finer.boundary.points[[4, 42]], middles)
    assert finer.duals.shape == (3, len(finer.boundary.points))
    assert len(finer.bounds.k) == len(finer.boundary.points)


def test_samples_are_added_where_segments_bulge_most_first(monkeypatch):
    base, none = search_from_rest(8), np.empty(0, np.intp)
    # Else all that bulge have their samples.
    monkeypatch.setattr("engine.deform.interior_point.samples.BULGE_PER_SLACK", 0.02)
    finer = with_samples(base, none)
    added = len(finer.boundary.points) - len(base.boundary.points)
    assert added > 1
    own = np.count_nonzero(base.boundary.weights)
    monkeypatch.setattr(
        "engine.deform.interior_point.samples.MOST_SAMPLES", (len(base.boundary.points) + 1.5) / own
    )
    fewer = with_samples(base, none)
    assert len(fewer.boundary.points) == len(base.boundary.points) + 1


def test_the_weight_falls_where_little_is_left_to_gain_but_not_at_a_saddle():
    search = search_from_rest(3)
    search = replace(search, length=1.0, weight=0.01 * search.energy)
    search = replace(search, optimality=search.optimality._replace(measure=0.1))
    much = replace(search, gain=2 * CENTRED * search.weight)
    little = replace(search, gain=0.5 * CENTRED * search.weight)
    least = replace(search, gain=0.5 * AT_A_SADDLE * CENTRED * search.weight)
    assert not is_centred(much, convex=True)
    assert is_centred(little, convex=True)
    # A saddle: from there a valley may lead on, at this weight.
    assert not is_centred(little, convex=False)
    assert is_centred(least, convex=False)
    # A barrier that outweighs the energy shapes the valley itself.
    heavy = replace(little, optimality=search.optimality._replace(measure=2.0))
    assert is_centred(heavy, convex=False)
    # A step that was cut short says nothing.
    assert not is_centred(replace(little, length=0.1), convex=True)
    # From the present map the valley is given, and the way to it short where nothing is near.
    here = replace(much, starting_point=StartingPoint.HERE)
    assert is_centred(here, convex=False)
    assert lower_weight(little).weight == lower_weight(replace(here, length=0.9)).weight
    assert lower_weight(little).weight == LOWER * search.weight
    assert lower_weight(here).weight == LOWER_IN_THE_OPEN * search.weight
    pressed = here.optimality._replace(active=(ActiveBound("k", 1.0, 0j),))
    assert lower_weight(replace(here, optimality=pressed)).weight == LOWER * search.weight


def test_the_weight_rises_where_bounds_cut_steps_short_that_promise_much():
    search = search_from_rest(3)
    promising = replace(search, gain=100.0 * search.weight)
    assert raise_weight(promising).weight == RAISED_PER_GAIN * promising.gain
    assert raise_weight(replace(search, gain=search.weight)).weight == search.weight


def test_walls_open_from_rungs_that_do_not_depend_on_the_bounds():
    wide, wider = (
        search_from_rest(0, StartingPoint.WIDENING, Bounds(k=k, sigma_a=4.0, sigma_b=0.2))
        for k in (0.7, 0.8)
    )
    rungs = [wide.level_width]
    while not wide.is_widest and wide.steps < 60:
        # As long as walls stand on the same rungs, both go the same way, bit for bit.
        wide, wider = advance_search(wide), advance_search(wider)
        assert not wide.has_converged
        assert wide.certificate.is_certified
        if wide.level_width != rungs[-1]:
            rungs.append(wide.level_width)
        elif are_same_bounds(wide.level_bounds, wider.level_bounds):
            assert_array_equal(wide.map.phi, wider.map.phi)
    assert len(rungs) >= 3
    first = homotopy_level(wide.final_bounds, rungs[0])
    assert_allclose(first.sigma_a, np.exp(FIRST_LEVEL_WIDTH), rtol=1e-12)
    assert_allclose(first.sigma_b, np.exp(-FIRST_LEVEL_WIDTH), rtol=1e-12)
    assert all(looser > tight for tight, looser in pairwise(rungs))
    assert_array_equal(wide.level_bounds, wide.final_bounds)
    # Within bounds as tight as the first rung there is nothing to open.
    assert not exceed_first_level(
        BarrierBounds.for_samples(Bounds(k=0.2, sigma_a=1.3, sigma_b=0.8), 1)
    )
    assert exceed_first_level(BarrierBounds.for_samples(Bounds(k=0.2, sigma_a=1.6, sigma_b=0.8), 1))


def test_a_cage_that_is_denser_than_it_is_far_comes_to_rest():
    # Its functions nearly depend on each other: steps along what they hardly show at the samples
    # bent so much between these that every search doubled its samples and got nowhere.
    boundary = Boundary.sample(Domain(regular_polygon(40), regular_polygon(160, 1.4)))
    assert boundary.basis.shape[1] < 80
    handles = Handles.place(boundary, [-0.7, 0.0, 0.7])
    deformer = Deformer(boundary=boundary, handles=handles, bounds=Bounds())
    handle_targets = handles.targets([-0.7, 0.2j, 0.7])
    state, _ = deformer.settle(deformer.start(), handle_targets, at_most=60)
    assert state.status is Status.CONVERGED
    assert len(state.outcome.boundary.points) <= 4 * len(boundary.points)

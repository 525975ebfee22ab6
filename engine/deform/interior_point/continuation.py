"""Continuation to the minimum by certified maps: the weight of the barrier goes to zero.

Drag steps follow the targets; this search finds the minimum. It begins with a heavy barrier, which
holds the map in the middle of the feasible set (a map that met a bound early never leaves it). Its
Newton steps are those of a primal–dual interior point method (Nocedal and Wright, ch. 19) with full
targets and no trust region. When the model expects little more at one weight, the next weight is a
tenth, or a hundredth far from the bounds.

The open conic solver Clarabel does not pay for this search: one convexified inner problem (Chen and
Weber 2015) of 810 samples and 50 cage vertices takes it 3.8 s, the whole search here 0.7 s.
"""

from dataclasses import replace
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Indices, readonly
from engine.deform.interior_point.homotopy import (
    FIRST_LEVEL_WIDTH,
    homotopy_level,
    next_level_width,
)
from engine.deform.interior_point.optimality import Optimality
from engine.deform.interior_point.samples import barrier_bounds_around, resolve_segments
from engine.deform.interior_point.search import Search, StartingPoint
from engine.deform.interior_point.second_order_correction import (
    STALLED,
    CorrectedStep,
    find_corrected_step,
    radial_changes,
)
from engine.deform.model.barrier import Barrier, BarrierBounds
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.newton import SHORTEST
from engine.deform.model.objective import Objective
from engine.maps import (
    Certificate,
    Enclosures,
    HarmonicMap,
    LocalBounds,
    certify_segments,
    segment_enclosures,
)

# Weight of the barrier at the start: per energy where the energy is large, and at least.
FIRST_PER_ENERGY = 0.1
FIRST_LEAST = 10.0
# The same from the present map, whose valley is kept, and the least weight after bounds widened.
HERE_PER_ENERGY = 1e-3
WIDENED_PER_ENERGY = 0.03
# The weight falls by this factor when the model expects a gain below a part of the weight: a small
# part while the weight is above this part of the energy. There the valley is chosen. Later, and
# from the present map, only digits change.
LOWER = 0.1
CENTRED = 0.1
CENTRED_LATE = 1.0
LATE_PER_ENERGY = 1e-3
# After a full step from the present map that no bound holds back, the weight falls by this factor.
# Measured: lower weights, at first or later, take up to six times as long next to bounds.
LOWER_IN_THE_OPEN = 0.01
# After a step that bounds cut short the weight is at least this part of the gain that the model
# expected. Below it the map is next to the bounds and creeps along them: where a valley bends, the
# gain grows again after the weight has fallen. Measured: hard drags of limbs then take half as
# long, with minima of the same energy.
RAISED_PER_GAIN = 0.1
# Where the objective is not convex, the gain is small at a saddle, too, from which a valley leads
# on. There only this part of the gain counts, while the barrier holds back less than a part of the
# energy (else the barrier, not the handles, shapes the valley).
AT_A_SADDLE = 0.03
HELD_BACK = 0.5
# Bounds have cut a step short of which less than this part was taken.
LONG_ENOUGH = 0.3
# The weight falls no lower than needed for a minimum.
LEAST_PER_ENERGY = 1e-7
# While the model expects more than this part of the energy as a gain, pulls with slack are as stiff
# along their direction as across. Otherwise their stiffness along it is 0, and steps lead a hundred
# times too far. Near rest the true Hessian needs fewer steps.
FAR_FROM_REST = 1e-3
# Less slack than this cannot be distinguished from none: the bound is moved this far away.
ROUNDING_SLACK = 1e-11
MOVED_OUT = 1e-9
# A step whose map is not certified is halved this many times.
HALVINGS = 6


def begin_search(
    objective: Objective,
    harmonic_map: HarmonicMap,
    certificate: Certificate,
    *,
    inside: LocalBounds,
    limits: LocalBounds,
    way: StartingPoint,
) -> Search:
    """Return a search that begins with a certified map.

    Parameters
    ----------
    objective : Objective
        Without a barrier, over the shape's own samples.
    harmonic_map, certificate
        The start; the shape at rest, unless `way` is the present map.
    inside : LocalBounds
        Barrier bounds of all samples.
    limits : LocalBounds
        Limits of all certificates, the first included.
    """
    jet = objective.evaluate(*harmonic_map.columns)
    energy = objective.energy(jet)
    reach = FIRST_LEVEL_WIDTH if way is StartingPoint.WIDENING else inf
    own = homotopy_level(BarrierBounds.at(inside, objective.boundary), reach)
    outermost = BarrierBounds.at(limits, objective.boundary)
    return Search(
        handles=objective.handles,
        targets=objective.targets,
        starting_point=way,
        map=harmonic_map,
        certificate=certificate,
        boundary=objective.boundary,
        limits=limits,
        final_limits=inside,
        level_width=reach,
        bounds=barrier_bounds_around(own, outermost, jet.a, jet.b),
        weight=HERE_PER_ENERGY * energy
        if way is StartingPoint.HERE
        else max(FIRST_LEAST, FIRST_PER_ENERGY * energy),
        energy=energy,
    )


def advance_search(search: Search) -> Search:
    """Take one Newton step.

    Notes
    -----
    The same searches give the same steps, bit for bit on one machine. Cost: as a step of a drag
    with the whole Hessian, 24 m n² for m samples.
    """
    objective, barrier, jet = _objective(search)
    step, taken, broken = _certified(search, find_corrected_step(objective, barrier, jet))
    changes = radial_changes(jet, step.direction)
    reached = jet.advanced(1.0, step.change.evaluation)
    search = replace(
        search,
        bounds=barrier.bounds,
        map=taken.map,
        certificate=taken.certificate,
        duals=readonly(step.barrier.next_duals(jet.a, jet.b, *changes)),
        energy=objective.energy(reached),
        steps=search.steps + 1,
        length=step.length,
        stalled_steps=search.stalled_steps + 1 if step.length < STALLED else 0,
        gain=step.gain,
    )
    search = replace(search, optimality=_optimality(search, reached, step.barrier))
    if is_centred(search, convex=step.convex):
        search = lower_weight(search) if search.is_widest else widen_bounds(search, reached)
    elif search.length <= LONG_ENOUGH:
        search = raise_weight(search)
    return resolve_segments(search, reached, taken.enclosures, broken)


def _objective(search: Search) -> tuple[Objective, Barrier, Evaluation]:
    """Return the objective of the next step, its barrier, and the evaluation of the map."""
    hands = search.targets.pulls
    objective = Objective(
        boundary=search.boundary,
        handles=search.handles,
        targets=search.targets,
        secant=hands is not None
        and (hands.has_all_handles or search.gain > FAR_FROM_REST * search.energy),
    )
    jet = objective.evaluate(*search.map.columns)
    barrier = Barrier(bounds=search.bounds, weight=search.weight, duals=search.duals)
    a, b = jet.a, jet.b
    too_near = barrier.slacks(a, b) < ROUNDING_SLACK
    if too_near.any():
        # The slack after the last step is below the rounding of this measurement.
        k, sigma_b, sigma_a = search.bounds.k, search.bounds.sigma_b, search.bounds.sigma_a
        walls = BarrierBounds(
            k=np.where(too_near[0], np.maximum(k, b / a + MOVED_OUT), k),
            sigma_a=np.where(too_near[2], np.maximum(sigma_a, a + b + MOVED_OUT), sigma_a),
            sigma_b=np.where(too_near[1], np.minimum(sigma_b, a - b - MOVED_OUT), sigma_b),
        )
        barrier = replace(barrier, bounds=walls)
    return replace(objective, barrier=barrier), barrier, jet


class _Proven(NamedTuple):
    """A certified map and the enclosures of its segments."""

    map: HarmonicMap
    certificate: Certificate
    enclosures: Enclosures


def _certified(search: Search, step: CorrectedStep) -> tuple[CorrectedStep, _Proven, Indices]:
    """Shorten a step until its map is certified; return the broken segments too."""
    broken = np.empty(0, np.intp)
    refusals = 0
    while step.length > SHORTEST and refusals <= HALVINGS:
        tried = search.map.changed(step.change.phi, step.change.psi)
        proof, segments, enclosures = certify_segments(tried, search.boundary, search.limits)
        if proof.is_certified:
            return step, _Proven(tried, proof, enclosures), broken
        broken = np.union1d(broken, segments)
        refusals += 1
        step = step.halved()
    enclosures = segment_enclosures(search.map, search.boundary)
    return step.without_step(), _Proven(search.map, search.certificate, enclosures), broken


def _optimality(search: Search, jet: Evaluation, barrier: Barrier) -> Optimality:
    """Return the optimality of the map within the present bounds, after a step."""
    if search.length == 0:
        return Optimality()
    return Optimality.of(
        jet.a,
        jet.b,
        gain=search.gain,
        energy=search.energy,
        boundary=search.boundary,
        barrier=barrier,
        bounds=search.level_bounds,
    )


def is_centred(search: Search, *, convex: bool) -> bool:
    """Whether little is left to gain at the present weight."""
    if (
        search.starting_point is StartingPoint.HERE
        or search.weight < LATE_PER_ENERGY * search.energy
    ):
        little = CENTRED_LATE
    elif convex or search.optimality.measure > HELD_BACK:
        little = CENTRED
    else:
        little = AT_A_SADDLE * CENTRED
    return search.length > LONG_ENOUGH and search.gain < little * search.weight


def raise_weight(search: Search) -> Search:
    return replace(search, weight=max(search.weight, RAISED_PER_GAIN * search.gain))


def lower_weight(search: Search) -> Search:
    least = LEAST_PER_ENERGY * search.energy / float(search.boundary.barrier_weights.sum())
    is_open = (
        search.starting_point is StartingPoint.HERE
        and search.length >= 1.0
        and not search.optimality.active
    )
    factor = LOWER_IN_THE_OPEN if is_open else LOWER
    return replace(search, weight=max(factor * search.weight, least))


def widen_bounds(search: Search, jet: Evaluation) -> Search:
    """Return the search with its bounds on the next level."""
    weight = max(LOWER * search.weight, WIDENED_PER_ENERGY * search.energy)
    wider = replace(
        search, level_width=next_level_width(search.final_bounds, search.level_width), weight=weight
    )
    outermost = BarrierBounds.at(wider.limits, wider.boundary)
    walls = barrier_bounds_around(wider.level_bounds, outermost, jet.a, jet.b)
    return replace(wider, bounds=walls)

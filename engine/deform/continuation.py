"""The way to rest: a barrier whose weight goes to zero, from certified map to certified map.

Where a drag follows the hand, this finds the minimum. It begins with a heavy barrier, which holds
the map in the middle of what the bounds allow (what has met a bound early never leaves it), and
takes Newton steps of a primal–dual interior point method (Nocedal and Wright, ch. 19) at full pull,
without a leash. When the model expects little more at one weight, the next one is a tenth of it.

- Corrections: where a step is stopped by a wall, the second-order change of the bounds along it is
  added to the right-hand side and solved for with the same factors (after Mehrotra 1992).
- Where it is still stopped, by the curvature of walls that are near but hardly press, their dual
  variables are raised until the Hessian sees it, and the step is solved for anew.
- Samples are added where a segment could bulge out farther than a part of the slack at its ends, so
  that the barrier sees what the certificate would find between the samples, before it refuses.
- The kept open conic solver Clarabel does not pay for this: one convexified inner problem (Chen and
  Weber 2015) of 810 samples and 50 cage vertices takes it 3.8 s, the whole way here 0.7 s.
- Walls: they stand a little inside the bounds, which leaves the room between samples. A sample that
  is added between the two gets a wall of its own around it, and keeps it.
"""

from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.deform.barrier import Barrier, Walls
from engine.deform.handles import Handles, Wish
from engine.deform.newton import SHORTEST, SUFFICIENT, Direction, Model, newton_models
from engine.deform.objective import Jet, Objective
from engine.deform.steering import MARGIN
from engine.maps import (
    Boundary,
    Certificate,
    HarmonicMap,
    Limits,
    certify_segments,
    segment_enclosures,
)

# Weight of the barrier at the start: over the energy where that is large, and at least.
FIRST_PER_ENERGY = 0.1
FIRST_LEAST = 10.0
# The same from the present map, which stays in its valley.
HERE_PER_ENERGY = 1e-2
# The weight falls by this factor when the model expects less than this part of it as a gain.
LOWER = 0.1
CENTRED = 0.1
# At least this part of the last step must have been taken then.
LONG_ENOUGH = 0.3
# Expected gain and complementarity, over the energy: a minimum. The weight falls no lower than
# needed for that.
OPTIMAL = 1e-6
LEAST_PER_ENERGY = 1e-7
# The wall of a sample that is beyond them stands this part of its way to the bound farther out.
OUTWARDS = 0.1
# Segments may bulge by this part of the slack at their ends, or of the margin, before they are cut.
BULGE_PER_SLACK = 0.25
BULGE_PER_MARGIN = 0.5
# No more samples than this many times those of the shape itself.
MOST_SAMPLES = 4
# Part of the way to a wall that a step may use up.
TO_THE_WALL = 0.95
CORRECTIONS = 2
# How often walls that stop a step are made stiffer, until this part of it can be taken.
STIFFENINGS = 4
ENOUGH = 0.8
# As long as the model expects more than this part of the energy as a gain, a sketch of the Hessian
# does, of one sample in so many.
SKETCHED = 1e-3
STRIDE = 4
# Less slack than this cannot be told from none: the wall is moved this far away.
ROUNDING_SLACK = 1e-11
REOPENED = 1e-9
# A full step is doubled as long as that gains.
LONGEST = 64.0
# Steps shorter than this are caught by the curvature of a few bounds. Dual variables of walls that
# stop a step are raised to this part of what would outweigh the expected gain.
CAUGHT = 0.08
RAISED = 0.1
# A step whose map is not certified is halved this many times.
HALVINGS = 6
# A bound is active when moving it all the way to the identity would, to first order, cost more than
# this part of the energy.
ACTIVE = 1e-4
# A search from elsewhere must gain this part of the energy: less is not worth a jump.
WORTH_A_JUMP = 1e-3
# What a search could still gain is an estimate that holds below this part of the energy.
RELIED_ON = 0.03
# Steps before all searches for one wish are given up, and before the one from the present map is
# put off, which is near rest or caught by bounds.
MOST_STEPS = 150
MOST_STEPS_HERE = 12
# Steps in a row that are hardly taken: the search is caught.
MOST_CAUGHT = 12
# Far handles go at most this far (of L) in one row of a straight path, in at most so many rows.
ROW = 0.05
MOST_ROWS = 20


class Way(Enum):
    """Where a search for the minimum starts."""

    HERE = "from the present map"
    REST = "from the shape at rest"
    PATH = "from the shape at rest, along straight paths of the handles"


class ActiveBound(NamedTuple):
    """A bound that holds back a pose.

    Parameters
    ----------
    name : str
        "k", "sigma_a" or "sigma_b".
    price : float
        By how much the energy would fall, to first order, if the bound were moved by 1 away from
        the identity.
    place : complex
        Where on the outline at rest it presses most.
    """

    name: str
    price: float
    place: complex


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Search:
    """A search for the minimum, on its way.

    Parameters
    ----------
    handles : Handles
    wish : Wish
    way : Way
    rows : int
        Of the straight path of the handles that the search follows first; 0 for none.
    origins : complex128, shape (h,)
        Where that path begins.
    map : HarmonicMap
    certificate : Certificate
    boundary : Boundary
        With the samples that were added.
    limits : Limits
        What the certificates are for.
    inside : Limits
        Where the walls of the shape's own samples stand.
    walls : Walls
    weight : float
        Of the barrier.
    duals : float64, shape (3, m), or None
    energy : float
        Of the map with its handles, at the whole wish.
    steps : int
    length : float
        Part of the last step that was taken.
    gain : float
        What the model expected of it.
    refusals : int
        Maps of the last step that were not certified.
    caught : int
        Steps in a row that were hardly taken.
    optimality : float
        Expected gain and complementarity over the energy; 0 at a minimum.
    active : tuple of ActiveBound
    gap : float
        About what the map could still gain, were everything convex.
    rival : float
        The energy that other ways have found: a search that cannot win is given up.
    before : int
        The steps of those ways.
    """

    handles: Handles
    wish: Wish
    way: Way
    rows: int
    origins: Complexes
    map: HarmonicMap
    certificate: Certificate
    boundary: Boundary
    limits: Limits
    inside: Limits
    walls: Walls
    weight: float
    energy: float
    duals: Floats | None = None
    steps: int = 0
    length: float = 1.0
    gain: float = np.inf
    refusals: int = 0
    caught: int = 0
    optimality: float = np.inf
    active: tuple[ActiveBound, ...] = ()
    gap: float = np.inf
    rival: float = np.inf
    before: int = 0

    @property
    def has_arrived(self) -> bool:
        """Whether the map is a minimum."""
        return self.optimality <= OPTIMAL

    @property
    def is_over(self) -> bool:
        """Whether the search found a minimum, or is given up."""
        here_first = self.way is Way.HERE and self.before == 0
        most = MOST_STEPS_HERE if here_first else MOST_STEPS - self.before
        return (
            self.has_arrived or self.steps >= most or self.caught >= MOST_CAUGHT or self._cannot_win
        )

    @property
    def _cannot_win(self) -> bool:
        """Whether another way has found less energy than this one can come to."""
        low_enough = (1.0 - WORTH_A_JUMP) * self.rival
        return self.gap < RELIED_ON * self.energy and self.energy - self.gap > low_enough


def begin_search(
    objective: Objective,
    harmonic_map: HarmonicMap,
    certificate: Certificate,
    *,
    inside: Limits,
    limits: Limits,
    way: Way,
) -> Search:
    """Return a search that begins with a certified map.

    Parameters
    ----------
    objective : Objective
        Without a barrier, over the shape's own samples.
    harmonic_map, certificate
        Where it begins; the shape at rest, unless the way is from the present map.
    inside : Limits
        Where the walls of the shape's own samples stand.
    limits : Limits
        That the certificates are for, the one at the start included.
    way : Way
    """
    boundary, wish, handles = objective.boundary, objective.wish, objective.handles
    jet = objective.jet(*harmonic_map.columns)
    energy = objective.energy(jet)
    rows = 0
    if way is Way.PATH:
        farthest = float(np.abs(wish.positions - jet.positions).max(initial=0.0))
        rows = min(int(np.ceil(farthest / (ROW * boundary.size))), MOST_ROWS)
    return Search(
        handles=handles,
        wish=wish,
        way=way,
        rows=rows,
        origins=jet.positions,
        map=harmonic_map,
        certificate=certificate,
        boundary=boundary,
        limits=limits,
        inside=inside,
        walls=_walls(inside, limits, np.abs(jet.f), np.abs(jet.g)),
        weight=HERE_PER_ENERGY * energy if way is Way.HERE else _first_weight(energy),
        energy=energy,
    )


def advance(search: Search) -> Search:
    """Take one Newton step.

    Notes
    -----
    The same searches give the same steps, bit for bit on one machine. Cost: as a step of a drag
    with the whole Hessian, 24 m n² for m samples.
    """
    objective, barrier, jet = _objective(search)
    search = replace(search, walls=barrier.walls)
    for model in newton_models(objective, jet):
        direction, length, barrier = _freed(model, barrier, jet)
        # Where the exact Hessian is hardly positive, its steps lead far beyond the walls.
        if length > CAUGHT:
            break
    length = _length(objective, jet, direction, length)
    taken, length, refusals, broken = _certified(search, direction, length)
    a, b, da, db = _radial_changes(jet, direction)
    duals = barrier.next_duals(a, b, da, db)
    gain = -direction.derivative / 2
    if length < CAUGHT:
        ahead = jet.advanced(1.0, direction.jet)
        outside = barrier.slacks(np.abs(ahead.f), np.abs(ahead.g)) < CAUGHT * barrier.slacks(a, b)
        needed = RAISED * gain / (search.boundary.shares * barrier.margins(a, b))
        duals = np.where(outside, np.maximum(duals, needed), duals)
    free = replace(objective, barrier=None, wish=search.wish)
    reached = jet.advanced(length, direction.jet)
    search = replace(
        search,
        map=taken[0],
        certificate=taken[1],
        duals=readonly(duals),
        energy=free.energy(reached),
        steps=search.steps + 1,
        length=length,
        caught=search.caught + 1 if length < CAUGHT else 0,
        gain=gain,
        refusals=refusals,
    )
    search = _rated(search, reached, objective.boundary, barrier)
    return _weighed(_resolved(search, reached, broken))


def _objective(search: Search) -> tuple[Objective, Barrier, Jet]:
    """Return what the next step minimises, and the map as it sees it."""
    wish, weight = search.wish, search.weight
    if search.steps < search.rows:
        wish = _on_the_path(search)
    objective = Objective(
        boundary=search.boundary,
        handles=search.handles,
        wish=wish,
        stride=STRIDE if search.gain > SKETCHED * search.energy else 1,
    )
    jet = objective.jet(*search.map.columns)
    if search.steps < search.rows:
        weight = _first_weight(objective.energy(jet))
    barrier = Barrier(walls=search.walls, weight=weight, duals=search.duals)
    a, b = np.abs(jet.f), np.abs(jet.g)
    too_near = barrier.slacks(a, b) < ROUNDING_SLACK
    if too_near.any():
        # What the last step left of it is less than the rounding of this measurement.
        k, sigma_b, sigma_a = search.walls.k, search.walls.sigma_b, search.walls.sigma_a
        walls = Walls(
            k=np.where(too_near[0], np.maximum(k, b / a + REOPENED), k),
            sigma_a=np.where(too_near[2], np.maximum(sigma_a, a + b + REOPENED), sigma_a),
            sigma_b=np.where(too_near[1], np.minimum(sigma_b, a - b - REOPENED), sigma_b),
        )
        barrier = replace(barrier, walls=walls)
    return replace(objective, barrier=barrier), barrier, jet


def _on_the_path(search: Search) -> Wish:
    """Return what the handles are asked for in the present row of the straight path."""
    share = (search.steps + 1) / search.rows
    targets = search.wish.positions
    return Wish(search.origins + share * (targets - search.origins), share * search.wish.rotations)


def _freed(model: Model, barrier: Barrier, jet: Jet) -> tuple[Direction, float, Barrier]:
    """Return a step that few walls stop, how much of it they allow, and the barrier of its model.

    What stops a step is the curvature of walls that are near but press little, which their dual
    variables do not show. They are raised to where the Hessian sees it.
    """
    objective = model.objective
    a, b = np.abs(jet.f), np.abs(jet.g)
    slacks, margins = barrier.slacks(a, b), barrier.margins(a, b)
    direction, allowed = _corrected(model, barrier, jet)
    best, tried = (direction, allowed, barrier), (direction, allowed, barrier)
    for _ in range(STIFFENINGS):
        direction, allowed, barrier = tried
        if allowed >= ENOUGH:
            break
        ahead = jet.advanced(1.0, direction.jet)
        outside = barrier.slacks(np.abs(ahead.f), np.abs(ahead.g)) < (1 - TO_THE_WALL) * slacks
        needed = -RAISED * direction.derivative / (objective.boundary.shares * margins)
        duals = barrier.current_duals(a, b)
        raised = replace(barrier, duals=np.where(outside, np.maximum(4 * duals, needed), duals))
        samples = np.flatnonzero(outside.any(axis=0))
        stiffer = raised.derivatives(a, b).plus(
            barrier.derivatives(a, b).weighted(-np.ones(len(a)))
        )
        added = objective.stiffening(jet, stiffer.weighted(objective.boundary.shares), samples)
        model = model.stiffened(added)
        tried = (*_corrected(model, raised, jet), raised)
        if _promise(*tried[:2]) > _promise(*best[:2]):
            best = tried
    return best


def _promise(direction: Direction, length: float) -> float:
    """Return what a quadratic model expects of a part of its step."""
    return -direction.derivative * length * (1 - length / 2)


def _corrected(model: Model, barrier: Barrier, jet: Jet) -> tuple[Direction, float]:
    """Return the step, corrected where walls stop it, and how much of it they allow."""
    objective = model.objective
    direction = model.direction()
    allowed = _to_the_wall(objective, jet, direction)
    a, b = np.abs(jet.f), np.abs(jet.g)
    duals, margins = barrier.current_duals(a, b), barrier.margins(a, b)
    most = np.maximum(duals, barrier.weight / margins)
    for _ in range(CORRECTIONS):
        if allowed == 1.0 or allowed <= CAUGHT:
            break
        ahead = jet.advanced(allowed, direction.jet)
        _, _, da, db = _radial_changes(jet, direction)
        linear = margins + allowed * barrier.margin_changes(a, b, da, db)
        curved = (barrier.margins(np.abs(ahead.f), np.abs(ahead.g)) - linear) / allowed**2
        factors = np.clip(duals * curved / margins, -most, most)
        by_a, b_per_b = barrier.margin_gradient(a, objective.boundary.shares * factors)
        corrected = model.direction(objective.sampled_gradient(jet, by_a, b_per_b))
        if corrected.derivative >= 0:
            break
        farther = _to_the_wall(objective, jet, corrected)
        if farther <= 1.1 * allowed:
            break
        direction, allowed = corrected, farther
    return direction, allowed


def _to_the_wall(objective: Objective, jet: Jet, direction: Direction) -> float:
    """Return how much of a step, at most the whole, keeps a distance from the walls."""
    length = 1.0
    while length > SHORTEST:
        beyond = length if length == 1.0 else length / TO_THE_WALL
        if objective.within(jet.advanced(beyond, direction.jet)):
            return length
        length *= 0.8 if length > CAUGHT else 0.4
    return 0.0


def _length(objective: Objective, jet: Jet, direction: Direction, allowed: float) -> float:
    """Return the length of a step that gains enough: a part, the whole, or a multiple of it."""
    value = objective.value(jet)
    length = allowed
    rounding = 1e-13 * abs(value)

    def reached(length: float) -> float:
        return objective.value(jet.advanced(length, direction.jet))

    if length == 1.0:
        best = reached(length)
        while length < LONGEST:
            beyond = jet.advanced(2 * length / TO_THE_WALL, direction.jet)
            if not objective.within(beyond) or not (farther := reached(2 * length)) < best:
                break
            length, best = 2 * length, farther
    while length > SHORTEST:
        if reached(length) <= value + SUFFICIENT * length * direction.derivative + rounding:
            return length
        length *= 0.6
    return 0.0


def _certified(
    search: Search, direction: Direction, length: float
) -> tuple[tuple[HarmonicMap, Certificate], float, int, Indices]:
    """Shorten a step until its map is certified; return refusals and broken segments, too."""
    broken = np.empty(0, np.intp)
    refusals = 0
    while length > SHORTEST and refusals <= HALVINGS:
        tried = search.map.changed(length * direction.phi, length * direction.psi)
        proof, segments = certify_segments(tried, search.boundary, search.limits)
        if proof.certified:
            return (tried, proof), length, refusals, broken
        broken = np.union1d(broken, segments)
        refusals += 1
        length /= 2
    return (search.map, search.certificate), 0.0, refusals, broken


def _resolved(search: Search, jet: Jet, broken: Indices) -> Search:
    """Return the search with samples added where segments could bulge, or did."""
    boundary, limits = search.boundary, search.limits
    a, b, following = np.abs(jet.f), np.abs(jet.g), boundary.following
    proven = segment_enclosures(search.map, boundary)
    worse = (
        (proven.k, np.maximum(b / a, (b / a)[following]), limits.k, limits.k),
        (
            proven.sigma_a,
            np.maximum(a + b, (a + b)[following]),
            limits.sigma_a,
            limits.sigma_a - 1.0,
        ),
        (
            -proven.sigma_b,
            -np.minimum(a - b, (a - b)[following]),
            -limits.sigma_b,
            1 - limits.sigma_b,
        ),
    )
    coarse = np.zeros(len(a), dtype=np.bool_)
    for enclosure, ends, limit, way in worse:
        bulge, slack = enclosure - ends, limit - ends
        least = BULGE_PER_MARGIN * MARGIN * abs(way)
        coarse |= (bulge > BULGE_PER_SLACK * slack) & (bulge > least)
    segments = np.union1d(np.flatnonzero(coarse), broken)
    most = MOST_SAMPLES * np.count_nonzero(boundary.weights)
    if len(segments) == 0 or len(a) + len(segments) > most:
        return search
    finer = boundary.refined(segments)
    new = segments + np.arange(len(segments)) + 1
    added = Objective(boundary=finer, handles=search.handles, wish=search.wish).jet(
        *search.map.columns
    )
    walls = _walls(search.inside, limits, np.abs(added.f[new]), np.abs(added.g[new]))
    duals = search.duals
    if duals is not None:
        ends = following[segments]
        between = np.maximum(duals[:, segments], duals[:, ends])
        duals = readonly(np.insert(duals, segments + 1, between, axis=1))
    return replace(
        search,
        boundary=finer,
        walls=Walls(
            *(
                np.insert(old, segments + 1, its)
                for old, its in zip(search.walls, walls, strict=True)
            )
        ),
        duals=duals,
    )


def _walls(inside: Limits, limits: Limits, a: Floats, b: Floats) -> Walls:
    """Return the inner walls, moved out a little where a sample is beyond or next to them."""
    k, sigma_a, sigma_b = b / a, a + b, a - b
    return Walls(
        k=np.maximum(inside.k, k + OUTWARDS * (limits.k - k)),
        sigma_a=np.maximum(inside.sigma_a, sigma_a + OUTWARDS * (limits.sigma_a - sigma_a)),
        sigma_b=np.minimum(inside.sigma_b, sigma_b + OUTWARDS * (limits.sigma_b - sigma_b)),
    )


def _rated(search: Search, jet: Jet, boundary: Boundary, barrier: Barrier) -> Search:
    """Return the search with its optimality and the bounds that are active.

    With the multipliers weight / c of the barrier the expected gain measures the projected
    gradient; the multipliers times c are the energy that the barrier holds back.
    """
    if search.steps <= search.rows or search.length == 0:
        return replace(search, optimality=np.inf, gap=np.inf)
    a, b = np.abs(jet.f), np.abs(jet.g)
    multipliers = boundary.shares * (barrier.weight / barrier.margins(a, b))
    complementarity = 3.0 * barrier.weight * float(boundary.shares.sum())
    optimality = (search.gain + complementarity) / search.energy
    gap = search.gain + 2.0 * complementarity
    # The derivatives of c = u² − b² by the bound, away from the identity.
    walls = barrier.walls
    prices = multipliers * np.array(
        [2 * walls.k * a * a, 2 * (a - walls.sigma_b), 2 * (walls.sigma_a - a)]
    )
    inside = search.inside
    ways = {"k": inside.k, "sigma_b": 1.0 - inside.sigma_b, "sigma_a": inside.sigma_a - 1.0}
    active = tuple(
        ActiveBound(name, float(price.sum()), complex(boundary.points[price.argmax()]))
        for (name, way), price in zip(ways.items(), prices, strict=True)
        if price.sum() * way > ACTIVE * search.energy
    )
    return replace(search, optimality=float(optimality), active=active, gap=gap)


def _weighed(search: Search) -> Search:
    """Return the search with the weight of its next step."""
    if search.steps <= search.rows:
        return replace(search, weight=_first_weight(search.energy))
    if search.length > LONG_ENOUGH and search.gain < CENTRED * search.weight:
        least = LEAST_PER_ENERGY * search.energy / float(search.boundary.shares.sum())
        return replace(search, weight=max(LOWER * search.weight, least))
    return search


def _first_weight(energy: float) -> float:
    return max(FIRST_LEAST, FIRST_PER_ENERGY * energy)


def _radial_changes(jet: Jet, direction: Direction) -> tuple[Floats, Floats, Floats, Floats]:
    """Return a and b, and how a step changes them to first order."""
    a, b = np.abs(jet.f), np.abs(jet.g)
    da = (jet.f.conj() * direction.jet.f).real / a
    db = (jet.g.conj() * direction.jet.g).real / np.maximum(b, np.finfo(np.float64).tiny)
    return a, b, da, db

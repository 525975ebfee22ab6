"""A deformation: from certified map to certified map, one Newton step at a time.

The objective is the symmetric Dirichlet energy with stiff handles and a barrier at the bounds
(Chen and Weber 2015, 2017). While the hand moves, a drag follows it:

- each handle is pulled by a leash, towards a point a little ahead of where it is. The leash is
  shortened when the bounds cut steps short and lengthened again when they do not: the trust region;
- the barrier's weight rises and falls with the same signs, and its Hessian is primal–dual;
- a step is cut until its map is certified with a part of the slack left, and where the certificate
  found a bound broken between two samples, a sample is added: the barrier then sees it.

When the hand rests, `engine.deform.rest` finds the minimum: first from the present map, which is
often near it; then, where bounds hold it back, from the shape at rest, since a map that has met
bounds early hardly leaves them. The pose of least energy is kept.
"""

from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.certified_step import CertifiedStep, add_samples, take_certified_step
from engine.deform.handles import Handles, Wish
from engine.deform.model import Barrier, Jet, Objective, Walls
from engine.deform.rest import MOST_STEPS, WORTH_A_JUMP, Search, Way, advance, begin_search, opens
from engine.deform.state import State, Statistics, Status
from engine.deform.steering import (
    FULL,
    LEASH,
    LEAST_RESTING,
    MARGIN,
    ROUNDING,
    Schedule,
    closing_limits,
    correlation,
    cut_to_leash,
    limits_for,
    place_walls,
    rigidly_aligned,
)
from engine.errors import EngineError
from engine.maps import Boundary, Bounds, Certificate, HarmonicMap, Limits, certify

# On the way into tightened bounds the barrier weighs at least this much, and the handles are this
# much softer.
LEAST_TIGHTENING = 0.1
SOFTNESS = 0.003
# One sample in so many enters the sketch of the Hessian.
STRIDE = 6
# One row of a recorded path: so many steps, or until the expected gain is below this.
PATH_STEPS = 10
PATH_REST = 1e-3
# Steps without progress after which a drag is handed over to the search for the minimum.
PATIENCE = 4
# Handles that are wanted this far (of L) from where they are at rest may be in a tangle: when a
# rotation of them all leads less than this part of the way. Measured: random drags of .15 L are no
# tangles, most handles that change places or meet in a point are.
FAR = 0.15
TANGLED = 0.8


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Deformer:
    """Deforms a shape by handles within bounds.

    To add, move or remove handles or to change the bounds, make another deformer over the same
    boundary and go on with the same state. A new handle does not move anything if its target is
    where its point is now, see `positions`.

    Parameters
    ----------
    boundary : Boundary
        Of the shape, as sampled.
    handles : Handles
    bounds : Bounds
    """

    boundary: Boundary
    handles: Handles
    bounds: Bounds

    def start(self, harmonic_map: HarmonicMap | None = None) -> State:
        """Return the state of a drag that starts from a map, by default the identity.

        Raises
        ------
        EngineError
            If the map is not certified within the bounds.
        """
        first = self._at_rest if harmonic_map is None else harmonic_map
        certificate = certify(first, self.boundary, self.bounds)
        if not certificate.certified:
            raise EngineError(
                "The start map is not certified within the bounds: it has k up to "
                f"{certificate.k:.4g}, sigma_a up to {certificate.sigma_a:.4g} and sigma_b down to "
                f"{certificate.sigma_b:.4g}. Start from another map or widen the bounds."
            )
        return State(map=first, certificate=certificate, limits=self.bounds, boundary=self.boundary)

    def resume(self, harmonic_map: HarmonicMap) -> State:
        """Return the state of a drag that starts from a map that may be outside the bounds.

        The steps from there walk into the bounds; until then the status is tightening.

        Raises
        ------
        EngineError
            If the map is not proven to be locally injective.
        """
        certificate = certify(harmonic_map, self.boundary, self.bounds)
        if certificate.certified:
            return self.start(harmonic_map)
        if not (certificate.k < 1 and certificate.sigma_b > 0):
            raise EngineError(
                "The start map folds, or nearly: it is not proven to be locally injective. Start "
                "from another map."
            )
        limits = limits_for(certificate, self.bounds)
        return State(
            map=harmonic_map,
            certificate=certify(harmonic_map, self.boundary, limits),
            limits=limits,
            status=Status.TIGHTENING,
            boundary=self.boundary,
        )

    def positions(self, state: State) -> Complexes:
        """Return where the handles are now, complex128 (h,)."""
        coordinates = self.handles.coordinates
        phi, psi = state.map.columns
        return coordinates @ phi + (coordinates @ psi).conj()

    def rotations(self, state: State) -> Floats:
        """Return the closest rotation arg f_z at each handle now, float64 (h,), in radians."""
        phi, _ = state.map.columns
        alone = self.boundary.span.without_constant(phi)
        angles: Floats = np.angle(self.handles.derivatives @ alone)
        return angles

    def step(self, state: State, wish: Wish) -> State:
        """Take one Newton step towards a wish; the new state's map is certified like the old.

        Call it once for each picture while the hand moves, that is, with changing wishes: the shape
        follows. Call it on with the same wish, as often as there is time, until the status is final
        (`Status.is_final`): the shape comes to rest in a minimum, and its energy only falls. From
        then on the same wish returns the same state.

        Parameters
        ----------
        state : State
        wish : Wish
            From `Handles.wish`.

        Notes
        -----
        The same states and wishes give the same maps, bit for bit on one machine. Cost: 24 s n² for
        s samples in the Hessian, n the number of cage vertices; then 22 n³ for its factors. Far
        from walls both serve some steps, and each of those costs 32 m n for m samples a round.
        """
        if len(wish.positions) == 0 and self._is_within(state.certificate):
            return replace(state, limits=self.bounds, status=Status.CONVERGED, wish=wish)
        if not self._goes_on(state, wish):
            state = replace(state, search=None, outcome=None, ways=())
        elif state.status.is_final:
            return state
        elif state.search is None and self._has_followed(state):
            state = self._begin(state, wish, (Way.HERE, Way.REST))
        if state.search is None:
            return self._follow_hand(state, wish)
        return self._search_on(state, state.search)

    def _goes_on(self, state: State, wish: Wish) -> bool:
        """Tell whether the last step was towards this wish, with these handles and bounds."""
        return (
            state.handles is self.handles
            and state.limits == self.bounds
            and _same(wish, state.wish)
        )

    def _has_followed(self, state: State) -> bool:
        """Tell whether a drag has come as far as it gets by itself."""
        last = state.statistics
        return (
            last is not None
            and self._is_within(state.certificate)
            and (state.schedule.idle >= PATIENCE or (not last.leashed and last.length > FULL))
        )

    def _follow_hand(self, state: State, wish: Wish) -> State:
        """Take one step of a drag."""
        step = self._prepare(state, wish)
        taken = take_certified_step(
            step.objective,
            step.jet,
            state.map,
            state.certificate,
            required=step.required,
            sketch=state.sketch,
        )
        decrement = -taken.direction.derivative / 2
        error = _handle_error(step.jet, wish, self.boundary.size)
        schedule = step.schedule.after(
            length=taken.length,
            shortfall=_excess(taken.certificate, self.bounds) if step.tightening else error,
            moving=step.leashed or step.tightening,
        )
        boundary, duals = add_samples(
            self.boundary, state.boundary, step.next_duals(taken), taken.broken
        )
        status = Status.MOVING
        if step.tightening:
            status = Status.OUTSIDE if schedule.at_rest else Status.TIGHTENING
        free = replace(step.objective, handles=self.handles, wish=wish, barrier=None)
        return State(
            map=taken.map,
            certificate=taken.certificate,
            limits=step.limits,
            status=status,
            statistics=Statistics(
                energy=step.energy,
                objective=free.energy(taken.jet),
                handle_error=_handle_error(taken.jet, wish, self.boundary.size),
                decrement=decrement,
                length=taken.length,
                barrier_weight=step.schedule.weight,
                leash=step.schedule.leash,
                leashed=step.leashed,
                refusals=taken.refusals,
                samples=len(state.boundary.points),
                optimality=inf,
                active=(),
            ),
            boundary=boundary,
            schedule=schedule,
            duals=duals,
            wish=wish,
            handles=self.handles,
            sketch=taken.sketch,
        )

    def _prepare(self, state: State, wish: Wish) -> "_Step":
        """Choose what the next step minimises, and what it must keep."""
        free = Objective(boundary=state.boundary, handles=self.handles, wish=wish)
        jet = free.jet(*state.map.columns)
        a, b = jet.a, jet.b
        limits = closing_limits(self.bounds, state.limits, a, b)
        limits_of_walls, required = place_walls(limits, a, b, state.certificate)
        schedule = state.schedule if _same(wish, state.wish) else state.schedule.for_new_wish()
        tightening = limits is not self.bounds
        if tightening:
            # Held softly where it is, the shape gives in to its energy; later handles pull again.
            handles, leashed = self.handles.softened(SOFTNESS), False
            wish = Wish(jet.positions, np.full(len(jet.positions), np.nan))
            schedule = replace(schedule, weight=max(schedule.weight, LEAST_TIGHTENING))
        else:
            handles = self.handles
            wish, leashed = cut_to_leash(handles, self.boundary.size, schedule.leash, jet, wish)
        # On the way into the bounds the walls move with the map, and dual variables would lag.
        walls = Walls.around(limits_of_walls, len(a))
        barrier = Barrier(
            walls=walls, weight=schedule.weight, duals=None if tightening else state.duals
        )
        return _Step(
            jet=jet,
            barrier=barrier,
            objective=replace(
                free,
                handles=handles,
                wish=wish,
                barrier=barrier,
                stride=STRIDE,
            ),
            limits=limits,
            required=required,
            schedule=schedule,
            leashed=leashed,
            tightening=tightening,
        )

    def settle(self, state: State, wish: Wish, *, at_most: int = 600) -> tuple[State, int]:
        """Find the pose of least energy for a wish; return the number of steps too.

        From the present map, from the shape at rest as long as bounds hold it back, and, for
        handles that are wanted far away and past each other, from the shape at rest within bounds
        that open on the way. At most `at_most` steps are taken. The energy is never above that of
        the present map, once that is within the bounds.
        """
        count = 0
        if not (self._goes_on(state, wish) and state.status.is_final):
            while count < at_most and not self._is_within(state.certificate):
                state, count = self._follow_hand(state, wish), count + 1
                if state.status.is_final:
                    return state, count
            if len(wish.positions) > 0 and count < at_most:
                state = self._begin(state, wish, (Way.HERE, Way.REST, Way.OPENING))
        while count < at_most:
            state, count = self.step(state, wish), count + 1
            if state.status.is_final:
                break
        return state, count

    def follow(self, state: State, wish: Wish) -> tuple[State, int]:
        """Take the few steps that one row of a recorded path gets; return their number too."""
        for count in range(1, PATH_STEPS + 1):
            state = self._follow_hand(state, wish)
            done = state.statistics
            if done is None or (
                done.length > FULL
                and done.decrement < PATH_REST * done.energy
                and done.handle_error < LEASH
            ):
                return state, count
        return state, PATH_STEPS

    def _begin(self, state: State, wish: Wish, ways: tuple[Way, ...]) -> State:
        """Return the state at the beginning of the searches along these ways."""
        if state.map.is_same(self._at_rest):
            ways = tuple(way for way in ways if way is not Way.HERE)
        state = replace(
            state,
            limits=self.bounds,
            status=Status.MOVING,
            wish=wish,
            handles=self.handles,
            boundary=self.boundary,
            schedule=Schedule(weight=LEAST_RESTING),
            duals=None,
            sketch=None,
            ways=ways,
            outcome=None,
        )
        return replace(state, search=self._search(state, wish, ways[0]))

    def _search(self, state: State, wish: Wish, way: Way) -> Search:
        """Return the search along a way, at its beginning."""
        first, certificate = state.map, state.certificate
        if way is not Way.HERE:
            first = rigidly_aligned(self.handles, wish, self._at_rest)
            certificate = certify(first, self.boundary, self.bounds)
        within = self.bounds.towards_identity(ROUNDING)
        keeps = within.allow(
            k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b
        )
        return begin_search(
            Objective(boundary=self.boundary, handles=self.handles, wish=wish),
            first,
            certificate,
            inside=self.bounds.towards_identity(MARGIN),
            limits=within if keeps else self.bounds,
            way=way,
        )

    def _search_on(self, state: State, search: Search) -> State:
        """Take one step of the search, and keep its map if it has less energy."""
        free = Objective(boundary=self.boundary, handles=self.handles, wish=search.wish)
        energy = free.energy(free.jet(*state.map.columns))
        search = advance(search)
        # From the present map every gain is shown; of a search from elsewhere the end is shown, if
        # it is worth the jump, or proven where nothing was.
        before = state.outcome
        proves = search.has_arrived and before is not None and not before.has_arrived
        if before is None:
            better = search.energy < energy
        else:
            worth = energy if proves else (1.0 - WORTH_A_JUMP) * energy
            better = search.is_over and search.energy < worth
        if better:
            state = replace(state, map=search.map, certificate=search.certificate)
        jet = free.jet(*state.map.columns)
        if not search.is_over:
            statistics = self._search_statistics(free, jet, search, search)
            return replace(state, search=search, statistics=statistics)
        # A minimum that was found before stays what is known, unless there is much less energy.
        if before is None or proves or search.energy < (1.0 - WORTH_A_JUMP) * before.energy:
            outcome = search
        else:
            outcome = before
        shown = free.energy(jet)
        taken = search.before + search.steps
        ways = self._further_ways(state.ways, outcome, shown) if taken < MOST_STEPS else ()
        state = replace(
            state,
            search=search,
            outcome=outcome,
            ways=ways,
            statistics=self._search_statistics(free, jet, search, outcome),
        )
        if ways:
            following = replace(
                self._search(state, search.wish, ways[0]),
                rival=outcome.energy if outcome.has_arrived else inf,
                before=taken,
            )
            return replace(state, search=following)
        if _is_proven(outcome, shown):
            return replace(
                state, status=Status.AT_LIMITS if outcome.optimality.active else Status.CONVERGED
            )
        return replace(state, status=Status.UNFINISHED)

    def _further_ways(
        self, ways: tuple[Way, ...], outcome: Search, shown: float
    ) -> tuple[Way, ...]:
        """Return the ways that are left to search."""
        free = outcome.has_arrived and not outcome.optimality.active
        others = tuple(
            way
            for way in ways[1:]
            if (self._is_tangled(outcome) if way is Way.OPENING else not free)
        )
        if not others and ways[0] is not Way.HERE and not _is_proven(outcome, shown):
            return (Way.HERE,)
        return others

    def _search_statistics(
        self, free: Objective, jet: Jet, search: Search, outcome: Search
    ) -> Statistics:
        """Return what a step of a search did, and what is known of the outcome."""
        return Statistics(
            energy=float(self.boundary.weights @ jet.density),
            objective=free.energy(jet),
            handle_error=_handle_error(jet, search.wish, self.boundary.size),
            decrement=search.gain,
            length=search.length,
            barrier_weight=search.weight,
            leash=1.0,
            leashed=False,
            refusals=search.refusals,
            samples=len(search.boundary.points),
            optimality=outcome.optimality.measure,
            active=outcome.optimality.active,
        )

    @property
    def _at_rest(self) -> HarmonicMap:
        return HarmonicMap.identity(self.boundary.cage, self.boundary.holes)

    def _is_tangled(self, outcome: Search) -> bool:
        """Tell whether handles are wanted far from where they are at rest, past each other.

        Then there are many valleys, and those that wide and opening bounds lead to may differ.
        """
        targets = outcome.wish.positions
        farthest = float(np.abs(targets - self.handles.points).max(initial=0.0))
        return (
            farthest > FAR * self.boundary.size
            and opens(self.bounds)
            and correlation(self.handles, targets) < TANGLED
        )

    def _is_within(self, certificate: Certificate) -> bool:
        return self.bounds.allow(
            k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b
        )


class _Step(NamedTuple):
    """A step as it is prepared; `required` is what the certificate of its map is tested for."""

    jet: Jet
    objective: Objective
    barrier: Barrier
    limits: Limits
    required: Limits
    schedule: Schedule
    leashed: bool
    tightening: bool

    @property
    def energy(self) -> float:
        return float(self.objective.boundary.weights @ self.jet.density)

    def next_duals(self, taken: CertifiedStep) -> Floats:
        """Return the dual variables after the whole step, be it taken or not."""
        whole = taken.length == 1.0
        ahead = taken.jet if whole else self.jet.advanced(1.0, taken.direction.jet)
        a, b = self.jet.a, self.jet.b
        return self.barrier.next_duals(a, b, ahead.a - a, ahead.b - b)


def _is_proven(outcome: Search, shown: float) -> bool:
    """Tell whether a minimum was found that the energy shown is not much below.

    A little it may be: the present map may be nearer to the bounds than searches go.
    """
    return outcome.has_arrived and shown >= (1.0 - WORTH_A_JUMP) * outcome.energy


def _handle_error(jet: Jet, wish: Wish, size: float) -> float:
    if len(wish.positions) == 0:
        return 0.0
    return float(np.sqrt(np.mean(np.abs(jet.positions - wish.positions) ** 2))) / size


def _excess(certificate: Certificate, bounds: Bounds) -> float:
    """Return by how much a map is outside its bounds; more than any distance of handles."""
    return 1e3 + max(
        certificate.k - bounds.k,
        (certificate.sigma_a - bounds.sigma_a) / bounds.sigma_a,
        (bounds.sigma_b - certificate.sigma_b) / bounds.sigma_b,
    )


def _same(wish: Wish, other: Wish | None) -> bool:
    return other is not None and all(
        np.array_equal(one, two, equal_nan=True) for one, two in zip(wish, other, strict=True)
    )

"""A drag: from certified map to certified map, one Newton step at a time.

The objective is the symmetric Dirichlet energy with stiff handles and a barrier at the bounds
(Chen and Weber 2015, 2017). What makes it hold in wild drags:

- each handle is pulled by a leash, towards a point a little ahead of where it is. The leash is
  shortened when the bounds cut steps short and lengthened again when they do not: the trust region;
- the barrier's weight rises and falls with the same signs, and its Hessian is primal–dual;
- a step is cut until its map is certified with a part of the slack left, and where the certificate
  found a bound broken between two samples, a sample is added: the barrier then sees it;
- a drag that does not get on begins its barrier afresh.
"""

from dataclasses import dataclass, field, replace
from enum import Enum
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.barrier import Barrier
from engine.deform.certified_step import CertifiedStep, add_samples, take_certified_step
from engine.deform.energy import symmetric_dirichlet
from engine.deform.handles import Handles, Wish
from engine.deform.objective import Jet, Objective
from engine.deform.steering import (
    FULL,
    LEASH,
    LEAST_RESTING,
    Schedule,
    closing_limits,
    cut_to_leash,
    limits_for,
    place_walls,
)
from engine.errors import EngineError
from engine.maps import Boundary, Bounds, Certificate, HarmonicMap, Limits, certify

# On the way into tightened bounds the barrier weighs at least this much, and the handles are this
# much softer.
LEAST_TIGHTENING = 0.1
SOFTNESS = 0.003
# Expected gain relative to the objective: near rest, where a sketched Hessian would go in circles,
# and at rest.
NEAR_REST = 1e-4
REST = 1e-8
# Handles that are where they should be (of L), and bounds that are reached (relative).
ARRIVED = 1e-3
REACHED = 0.02
# One row of a recorded path: so many steps, or until the expected gain is below this.
PATH_STEPS = 10
PATH_REST = 1e-3


class Status(Enum):
    """How far a drag has come."""

    CONVERGED = "converged"
    """At rest in a minimum."""
    BOUNDS_REACHED = "bounds reached"
    """At rest, but handles are away from their targets: the bounds allow no more."""
    LAGGING = "lagging"
    """The handles are still on their way."""
    TIGHTENING = "tightening"
    """The bounds became tighter than the map; it is on its way into them."""
    OUTSIDE = "outside the bounds"
    """The map is outside its bounds and finds no way into them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Statistics:
    """What the last step did.

    Parameters
    ----------
    energy : float
        Arc-length mean of the symmetric Dirichlet density before the step; 2 at rest.
    handle_error : float
        Root mean square distance of the handles from their targets before the step, over L.
    decrement : float
        Gain that Newton's model expected of the whole step.
    length : float
        Part of the step that was taken.
    barrier_weight : float
    leash : float
        Part of it that was paid out.
    refusals : int
        Maps that were tried and not certified.
    samples : int
    """

    energy: float
    handle_error: float
    decrement: float
    length: float
    barrier_weight: float
    leash: float
    refusals: int
    samples: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class State:
    """A certified map in a drag, with what the next step needs.

    It does not depend on the handles: it can go on with others, and with other bounds.

    Parameters
    ----------
    map : HarmonicMap
    certificate : Certificate
        Of the map, for its limits.
    limits : Limits
        What the map is held to: the bounds, or looser ones on the way into tightened bounds.
    status : Status
    statistics : Statistics or None
        None before the first step.
    boundary : Boundary
        With the samples that were added.
    schedule : Schedule
    duals : float64, shape (3, m), or None
        Of the barrier.
    wish : Wish or None
        Of the last step.
    """

    map: HarmonicMap
    certificate: Certificate
    limits: Limits
    status: Status = Status.LAGGING
    statistics: Statistics | None = None
    boundary: Boundary
    schedule: Schedule = field(default_factory=Schedule)
    duals: Floats | None = None
    wish: Wish | None = None


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
        first = HarmonicMap.identity(self.boundary.cage) if harmonic_map is None else harmonic_map
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
        return coordinates @ state.map.phi + (coordinates @ state.map.psi).conj()

    def rotations(self, state: State) -> Floats:
        """Return the closest rotation arg f_z at each handle now, float64 (h,), in radians."""
        angles: Floats = np.angle(self.handles.derivatives @ (state.map.phi - state.map.phi[0]))
        return angles

    def step(self, state: State, wish: Wish) -> State:
        """Take one Newton step towards a wish; the new state's map is certified like the old.

        Parameters
        ----------
        state : State
        wish : Wish
            From `Handles.wish`.

        Notes
        -----
        The same states and wishes give the same maps, bit for bit on one machine. Cost: 24 s n² for
        s samples in the Hessian, n the number of cage vertices; then 22 n³ for its factors.
        """
        if len(wish.positions) == 0 and self._is_within(state.certificate):
            return replace(state, limits=self.bounds, status=Status.CONVERGED)
        step = self._prepare(state, wish)
        taken = take_certified_step(
            step.objective, step.jet, state.map, state.certificate, step.required
        )
        decrement = -taken.direction.derivative / 2
        error = _handle_error(step.jet, wish, self.boundary.size)
        schedule = step.schedule.after(
            length=taken.length,
            shortfall=_excess(taken.certificate, self.bounds) if step.tightening else error,
            moving=step.leashed or step.tightening,
            # A sketch may overshoot between its samples in the open: nothing to do with the walls.
            overshot=step.objective.sketched and not step.leashed,
        )
        settled = (
            not (step.leashed or step.tightening)
            and 2 * decrement < REST * step.energy
            and step.schedule.weight <= LEAST_RESTING
        )
        boundary, duals = add_samples(
            self.boundary, state.boundary, step.next_duals(taken), taken.broken
        )
        if schedule.asks_for_renewal and step.leashed:
            boundary, duals, schedule = self.boundary, None, schedule.renewed()
        return State(
            map=taken.map,
            certificate=taken.certificate,
            limits=step.limits,
            status=self._status(
                taken.certificate,
                tightening=step.tightening,
                settled=settled,
                at_rest=schedule.at_rest,
                arrived=error < ARRIVED,
            ),
            statistics=Statistics(
                energy=step.energy,
                handle_error=error,
                decrement=decrement,
                length=taken.length,
                barrier_weight=step.schedule.weight,
                leash=step.schedule.leash,
                refusals=taken.refusals,
                samples=len(state.boundary.points),
            ),
            boundary=boundary,
            schedule=schedule,
            duals=duals,
            wish=wish,
        )

    def _prepare(self, state: State, wish: Wish) -> "_Step":
        """Choose what the next step minimises, and what it must keep."""
        free = Objective(boundary=state.boundary, handles=self.handles, wish=wish)
        jet = free.jet(state.map.phi, state.map.psi)
        a, b = np.abs(jet.f), np.abs(jet.g)
        limits = closing_limits(self.bounds, state.limits, a, b)
        walls, required = place_walls(limits, a, b, state.certificate)
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
        barrier = Barrier(walls=walls, weight=schedule.weight, duals=state.duals)
        return _Step(
            jet=jet,
            barrier=barrier,
            objective=replace(
                free,
                handles=handles,
                wish=wish,
                barrier=barrier,
                sketched=leashed or not _near_rest(state.statistics),
            ),
            limits=limits,
            required=required,
            schedule=schedule,
            leashed=leashed,
            tightening=tightening,
        )

    def settle(self, state: State, wish: Wish, *, at_most: int = 500) -> tuple[State, int]:
        """Step until the shape is at rest, or `at_most` times; return the number of steps too."""
        for count in range(1, at_most + 1):
            state = self.step(state, wish)
            if state.status not in (Status.LAGGING, Status.TIGHTENING):
                return state, count
        return state, at_most

    def settle_anew(self, state: State, wish: Wish) -> tuple[State, int]:
        """Settle; where the shape is held back, settle from the undeformed shape too.

        Limbs that were pulled through each other can stay entangled when the handles come back.
        The better of both results by the objective is returned, with all steps that were taken. It
        may be a jump: for the end of a drag, not for its course.
        """
        state, count = self.settle(state, wish)
        if state.status is Status.CONVERGED:
            return state, count
        fresh, more = self.settle(self.start(), wish)
        objective = Objective(boundary=self.boundary, handles=self.handles, wish=wish)
        values = [
            objective.value(objective.jet(end.map.phi, end.map.psi)) for end in (state, fresh)
        ]
        return (state if values[0] <= values[1] else fresh), count + more

    def _is_within(self, certificate: Certificate) -> bool:
        return self.bounds.allow(
            k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b
        )

    def follow(self, state: State, wish: Wish) -> tuple[State, int]:
        """Take the few steps that one row of a recorded path gets; return their number too."""
        for count in range(1, PATH_STEPS + 1):
            state = self.step(state, wish)
            done = state.statistics
            if done is None or (
                done.length > FULL
                and done.decrement < PATH_REST * done.energy
                and done.handle_error < LEASH
            ):
                return state, count
        return state, PATH_STEPS

    def _status(
        self,
        certificate: Certificate,
        *,
        tightening: bool,
        settled: bool,
        at_rest: bool,
        arrived: bool,
    ) -> Status:
        if tightening:
            return Status.OUTSIDE if at_rest else Status.TIGHTENING
        # Handles that have arrived make no progress, but the shape between them may.
        if not settled and (arrived or not at_rest):
            return Status.LAGGING
        near = self.bounds.towards_identity(REACHED)
        reached = not near.allow(
            k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b
        )
        return Status.BOUNDS_REACHED if reached and not arrived else Status.CONVERGED


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
        density = symmetric_dirichlet(np.abs(self.jet.f), np.abs(self.jet.g))
        return float(self.objective.boundary.weights @ density)

    def next_duals(self, taken: CertifiedStep) -> Floats:
        """Return the dual variables after the whole step, be it taken or not."""
        ahead = self.jet.advanced(1.0, taken.direction.jet)
        here, there = (np.abs(self.jet.f), np.abs(self.jet.g)), (np.abs(ahead.f), np.abs(ahead.g))
        return self.barrier.next_duals(*here, *there)


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


def _near_rest(last: Statistics | None) -> bool:
    """Tell whether the next step needs the whole Hessian."""
    return last is not None and (last.length < FULL or last.decrement < NEAR_REST * last.energy)


def _same(wish: Wish, other: Wish | None) -> bool:
    return other is not None and all(
        np.array_equal(one, two, equal_nan=True) for one, two in zip(wish, other, strict=True)
    )

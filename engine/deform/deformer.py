"""A drag: from certified map to certified map, one Newton step at a time.

The objective is the symmetric Dirichlet energy with stiff handles and a barrier at the bounds
(Chen and Weber 2015, 2017). What makes it hold in wild drags:

- each handle is pulled by a leash, towards a point a little ahead of where it is. The leash is
  shortened when the bounds cut steps short and lengthened again when they do not: the trust region;
- the barrier's weight rises and falls with the same signs, and its Hessian is primal–dual;
- a step is cut until its map is certified with a part of the slack left, and where the certificate
  found a bound broken between two samples, a sample is added: the barrier then sees it.
"""

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.deform.barrier import Barrier
from engine.deform.boundary import Boundary
from engine.deform.bounds import Bounds
from engine.deform.certificate import Certificate, certify, certify_samples
from engine.deform.energy import symmetric_dirichlet
from engine.deform.handles import Handles, Wish
from engine.deform.newton import Direction, line_search, newton_direction
from engine.deform.objective import Jet, Objective
from engine.errors import EngineError
from engine.harmonic_map import HarmonicMap

# A handle is pulled towards a point at most this far (of L) ahead of it, and turned by at most this
# angle; both times the reach, between SHORTEST_REACH and 1.
LEASH, TURN_LEASH, SHORTEST_REACH = 0.02, 0.2, 0.1
# Handles whose correlation with their targets is weaker have no common rotation.
CORRELATED = 0.5
# No point of the shape moves farther (of L) in one step: removed handles make no jump.
FARTHEST = 0.05
# Barrier weight: at the start, at most, and at least while handles move and when they have arrived.
FIRST, MOST, LEAST_MOVING, LEAST_RESTING = 1e-2, 3.0, 1e-3, 1e-6
RAISE, LOWER = 4.0, 0.5
# Lengths of steps that the bounds have cut short, and that they have not.
SHORT, FULL = 0.3, 0.7
# The walls stand inside the bounds by this part of the way to the identity; a step leaves at least
# KEPT of the slack between them and the map.
MARGIN, KEPT = 1e-4, 0.1
# While a map is outside its bounds the limits follow it at this relative distance, the barrier
# weighs at least this much, and the handles are this much softer.
FOLLOW, LEAST_TIGHTENING, SOFTNESS = 0.005, 0.3, 0.01
# A step whose map is not certified is halved this many times.
HALVINGS = 5
# Added samples are dropped when they outnumber those of the shape itself.
MOST_ADDED = 1.0
# At rest: expected gain relative to the objective; handles that stand still (of L) for so many
# steps; handles that are where they should be (of L); bounds that are reached (relative).
REST, STILL, STILL_STEPS, ARRIVED, REACHED = 1e-8, 1e-5, 12, 1e-3, 0.02
# One row of a recorded path: so many steps, or until the expected gain is below this.
PATH_STEPS, PATH_REST = 10, 1e-3


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
    barrier_weight, reach : float
    refusals : int
        Maps that were tried and not certified.
    samples : int
    """

    energy: float
    handle_error: float
    decrement: float
    length: float
    barrier_weight: float
    reach: float
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
    limits : Bounds
        What the map is held to: the bounds, or looser ones on the way into tightened bounds.
    status : Status
    statistics : Statistics or None
        None before the first step.
    boundary : Boundary
        With the samples that were added.
    barrier_weight, reach : float
    duals : float64, shape (3, m), or None
    still : int
        Steps for which nothing has moved.
    """

    map: HarmonicMap
    certificate: Certificate
    limits: Bounds
    status: Status = Status.LAGGING
    statistics: Statistics | None = None
    boundary: Boundary
    barrier_weight: float = FIRST
    reach: float = 1.0
    duals: Floats | None = None
    still: int = 0


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
        k, sigma_a, sigma_b = certificate.k, certificate.sigma_a, certificate.sigma_b
        if not (k < 1 and sigma_b > 0):
            raise EngineError(
                "The start map folds, or nearly: it is not proven to be locally injective. Start "
                "from another map."
            )
        limits = Bounds(
            k=max(self.bounds.k, k + FOLLOW * (1 - k)),
            sigma_a=max(self.bounds.sigma_a, sigma_a * (1 + FOLLOW)),
            sigma_b=min(self.bounds.sigma_b, sigma_b * (1 - FOLLOW)),
        )
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
        if len(wish.positions) == 0:
            return replace(state, status=Status.CONVERGED)
        free = Objective(boundary=state.boundary, handles=self.handles, wish=wish)
        jet = free.jet(state.map.phi, state.map.psi)
        a, b = np.abs(jet.f), np.abs(jet.g)
        limits = _limits(self.bounds, state.limits, a, b)
        walls, required = _walls(limits, a, b)
        tightening = limits != self.bounds
        weight = state.barrier_weight
        if tightening:
            # The shape relaxes until it is within; only then the handles pull again.
            weight = max(weight, LEAST_TIGHTENING)
            wish_now = Wish(jet.positions, np.full(len(jet.positions), np.nan))
            leashed = False
        else:
            wish_now, leashed = _leash(self.handles, self.boundary.size, state.reach, jet, wish)
        barrier = Barrier(walls=walls, weight=weight, duals=state.duals)
        handles = self.handles.softened(SOFTNESS) if tightening else self.handles
        # A step that was cut in the open may have overshot between the samples of a sketch.
        last = state.statistics
        sketched = leashed or last is None or last.length > FULL
        objective = replace(
            free, handles=handles, wish=wish_now, barrier=barrier, sketched=sketched
        )
        direction = _moderate(newton_direction(objective, jet), state.boundary)
        value = objective.value(jet)
        taken = _certified_step(state, objective, jet, direction, required)
        ahead = jet.advanced(1.0, direction.jet)
        ahead_duals = barrier.next_duals(a, b, np.abs(ahead.f), np.abs(ahead.g))
        boundary, duals = _with_samples(self.boundary, state.boundary, ahead_duals, taken.broken)
        moved = taken.length * float(np.abs(direction.jet.positions).max()) / self.boundary.size
        settled = not leashed and -direction.slope < REST * value and weight <= LEAST_RESTING
        still = state.still + 1 if moved < STILL else 0
        error = np.sqrt(np.mean(np.abs(jet.positions - wish.positions) ** 2)) / boundary.size
        return State(
            map=taken.map,
            certificate=taken.certificate,
            limits=limits,
            status=self._status(
                taken.certificate,
                tightening=tightening,
                settled=settled,
                still=still,
                arrived=bool(error < ARRIVED),
            ),
            statistics=Statistics(
                energy=float(state.boundary.weights @ symmetric_dirichlet(a, b)),
                handle_error=float(error),
                decrement=-direction.slope / 2,
                length=taken.length,
                barrier_weight=weight,
                reach=state.reach,
                refusals=taken.refusals,
                samples=len(boundary.points),
            ),
            boundary=boundary,
            barrier_weight=_next_weight(weight, taken.length, moving=leashed or tightening),
            reach=_next_reach(state.reach, taken.length),
            duals=duals,
            still=still,
        )

    def settle(self, state: State, wish: Wish, *, at_most: int = 500) -> tuple[State, int]:
        """Step until the shape is at rest, or `at_most` times; return the number of steps too."""
        for count in range(1, at_most + 1):
            state = self.step(state, wish)
            if state.status not in (Status.LAGGING, Status.TIGHTENING):
                return state, count
        return state, at_most

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
        still: int,
        arrived: bool,
    ) -> Status:
        at_rest = still >= STILL_STEPS
        if tightening:
            return Status.OUTSIDE if at_rest else Status.TIGHTENING
        # Handles that stand still but have arrived only wait for the barrier to fade.
        if not settled and (arrived or not at_rest):
            return Status.LAGGING
        near = self.bounds.towards_identity(REACHED)
        reached = not near.allow(
            k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b
        )
        return Status.BOUNDS_REACHED if reached and not arrived else Status.CONVERGED


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Taken:
    """What was taken of a step; `broken` are the segments where a longer one broke a bound."""

    map: HarmonicMap
    certificate: Certificate
    length: float
    broken: Indices
    refusals: int


def _certified_step(
    state: State, objective: Objective, jet: Jet, direction: Direction, required: Bounds
) -> _Taken:
    value = objective.value(jet)
    length, broken = 1.0, np.empty(0, np.intp)
    for refusals in range(HALVINGS):
        length = line_search(objective, jet, direction, value, length)
        if length == 0:
            break
        phi = state.map.phi + length * direction.phi
        psi = state.map.psi + length * direction.psi
        reached = jet.advanced(length, direction.jet)
        certificate, segments = certify_samples(
            state.boundary,
            np.column_stack([phi, psi]),
            np.column_stack([reached.f, reached.g]),
            required,
        )
        if certificate.certified:
            harmonic_map = HarmonicMap(cage=state.map.cage, phi=phi, psi=psi)
            return _Taken(
                map=harmonic_map,
                certificate=certificate,
                length=length,
                broken=broken,
                refusals=refusals,
            )
        # The longest step says where the drag wants to break a bound.
        broken = segments if refusals == 0 else broken
        length /= 2
    return _Taken(
        map=state.map,
        certificate=state.certificate,
        length=0.0,
        broken=broken,
        refusals=refusals + (length > 0),
    )


def _limits(bounds: Bounds, before: Bounds, a: Floats, b: Floats) -> Bounds:
    """Return the bounds, or limits that close in on a map that is outside of them."""
    k, sigma_a, sigma_b = _extremes(a, b)
    return Bounds(
        k=bounds.k if k < bounds.k else min(before.k, k + FOLLOW * (1 - k)),
        sigma_a=bounds.sigma_a
        if sigma_a < bounds.sigma_a
        else min(before.sigma_a, sigma_a * (1 + FOLLOW)),
        sigma_b=bounds.sigma_b
        if sigma_b > bounds.sigma_b
        else max(before.sigma_b, sigma_b * (1 - FOLLOW)),
    )


def _walls(limits: Bounds, a: Floats, b: Floats) -> tuple[Bounds, Bounds]:
    """Return the walls of the barrier, and the bounds that the next map must keep everywhere."""
    inner = limits.towards_identity(MARGIN)
    k, sigma_a, sigma_b = _extremes(a, b)
    # A map may start between the walls and the limits.
    walls = Bounds(
        k=max(inner.k, k + (limits.k - k) / 4),
        sigma_a=max(inner.sigma_a, sigma_a + (limits.sigma_a - sigma_a) / 4),
        sigma_b=min(inner.sigma_b, sigma_b + (limits.sigma_b - sigma_b) / 4),
    )
    required = Bounds(
        k=walls.k - KEPT * (walls.k - k),
        sigma_a=walls.sigma_a - KEPT * (walls.sigma_a - sigma_a),
        sigma_b=walls.sigma_b - KEPT * (walls.sigma_b - sigma_b),
    )
    return walls, required


def _extremes(a: Floats, b: Floats) -> tuple[float, float, float]:
    return float((b / a).max()), float((a + b).max()), float((a - b).min())


def _moderate(direction: Direction, boundary: Boundary) -> Direction:
    """Return the direction, shortened if it moves the outline too far."""
    coordinates = boundary.vertex_coordinates
    moves = coordinates @ direction.phi + (coordinates @ direction.psi).conj()
    farthest = float(np.abs(moves).max()) / (FARTHEST * boundary.size)
    return direction if farthest <= 1 else direction.scaled(1 / farthest)


def _leash(handles: Handles, size: float, reach: float, jet: Jet, wish: Wish) -> tuple[Wish, bool]:
    """Return the wish cut to the leash, and whether that cut anything.

    What all handles want to turn together, they turn: straight ways to a wish that is mainly a
    rotation would squeeze the shape.
    """
    distance, most = LEASH * size * reach, TURN_LEASH * reach
    positions = _turned(handles, jet.positions, wish.positions, most)
    pull = wish.positions - positions
    cut = distance / np.maximum(np.abs(pull), distance)
    # Free handles have NaN, which passes through.
    turn = np.angle(np.exp(1j * wish.rotations) * jet.fz.conj())
    near = np.angle(jet.fz) + np.clip(turn, -most, most)
    leashed = bool(np.any(cut < 1.0) or np.any(np.abs(turn) > most))
    return Wish(positions + cut * pull, near), leashed


def _turned(handles: Handles, positions: Complexes, targets: Complexes, most: float) -> Complexes:
    """Return the positions turned as a whole towards the targets (Procrustes), up to an angle."""
    weights = handles.stiffness / handles.stiffness.sum()
    centre = weights @ positions
    from_centre, wanted = positions - centre, targets - weights @ targets
    correlation = weights @ (from_centre.conj() * wanted)
    scale = weights @ (np.abs(from_centre) * np.abs(wanted))
    if abs(correlation) <= CORRELATED * scale:
        return positions
    angle = np.clip(np.angle(correlation), -most, most)
    turned: Complexes = centre + np.exp(1j * angle) * from_centre
    return turned


def _with_samples(
    base: Boundary, boundary: Boundary, duals: Floats, segments: Indices
) -> tuple[Boundary, Floats | None]:
    """Return the boundary with samples added in the segments, and the dual variables for it."""
    if len(segments) == 0:
        return boundary, readonly(duals)
    if len(boundary.points) + len(segments) > (1 + MOST_ADDED) * len(base.points):
        return base, None
    ends = (segments + 1) % len(boundary.points)
    between = np.maximum(duals[:, segments], duals[:, ends])
    return boundary.refined(segments), readonly(np.insert(duals, segments + 1, between, axis=1))


def _next_weight(weight: float, length: float, *, moving: bool) -> float:
    if length < SHORT:
        return min(RAISE * weight, MOST)
    least = LEAST_MOVING if moving else LEAST_RESTING
    return max(LOWER * weight, least) if length > FULL else weight


def _next_reach(reach: float, length: float) -> float:
    if length < SHORT:
        return max(reach / 2, SHORTEST_REACH)
    return min(2 * reach, 1.0) if length > FULL else reach

"""A deformation: from certified map to certified map, one Newton step at a time.

The objective is the symmetric Dirichlet energy with stiff handles and a barrier at the bounds (Chen
and Weber 2015, 2017). While the hand moves, drag steps follow the targets (`tracking`). At rest,
searches from several starting points (`minimisation`) keep the pose of least energy.
"""

from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import Complexes, as_count, require_kind
from engine.deform.constrained_shape import ConstrainedShape
from engine.deform.handles import TARGET_COUNT, HandleTargets
from engine.deform.interior_point.search import StartingPoint
from engine.deform.minimisation import advance_searches, begin_searches
from engine.deform.model.barrier_position import FOLLOW, proven_around, widen_limits
from engine.deform.state import State, Status
from engine.deform.tracking import take_drag_step
from engine.deform.trust_region import FULL, STEP_RADIUS
from engine.errors import EngineError
from engine.maps import Certificate, HarmonicMap, LocalBounds, certify

# Steps for one row of a recorded path. They end earlier if the expected gain is below this.
PATH_STEPS = 10
PATH_REST = 1e-3
# Steps without progress after which a drag is handed over to the search for the minimum.
PATIENCE = 4
# Gradients of pulls that differ by at most this part are the same but for rounding.
SAME_PULL = 1e-9
UNSETTLED = (
    "The shape did not converge in {count} steps: it is {status}. Give more steps (at_most), "
    "wider limits or nearer targets, or accept the shape as it is (throw=False)."
)
UNCERTIFIED_START = (
    "The start map is not certified within the limits: it has k up to {k:.4g}, sigma_a up to "
    "{sigma_a:.4g} and sigma_b down to {sigma_b:.4g}. Start from another map, or widen the "
    "limits."
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Deformer(ConstrainedShape):
    """Deforms a shape by handles within bounds.

    To add, move or remove handles or to change the bounds, make another deformer over the same
    boundary and continue with the same state. A new handle moves nothing if its target is the
    present position of its point, see `positions`.
    """

    def start(self, harmonic_map: HarmonicMap | None = None) -> State:
        """Return the state of a drag that starts from a map, by default the identity.

        Raises
        ------
        EngineError
            If the map is not certified within the bounds.
        """
        first = self.rest_map if harmonic_map is None else harmonic_map
        require_kind(first, HarmonicMap, "the map")
        certificate = certify(first, self.boundary, self.bounds)
        if not certificate.is_certified:
            raise EngineError(
                UNCERTIFIED_START,
                k=certificate.k,
                sigma_a=certificate.sigma_a,
                sigma_b=certificate.sigma_b,
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
        if certificate.is_certified:
            return self.start(harmonic_map)
        if not (certificate.k < 1 and certificate.sigma_b > 0):
            raise EngineError(
                "The start map folds, or nearly folds: it is not proven to be locally "
                "injective. Start from another map."
            )
        limits = self._limits_for(harmonic_map, certificate)
        return State(
            map=harmonic_map,
            certificate=certify(harmonic_map, self.boundary, limits),
            limits=limits,
            status=Status.TIGHTENING,
            boundary=self.boundary,
        )

    def widened_for(self, harmonic_map: HarmonicMap, room: float) -> "Deformer":
        """Return the deformer with bounds widened as far as a map needs.

        `room` is the part of the remaining slack of the distortions that is added beyond the map's
        own.
        """
        certificate = certify(harmonic_map, self.boundary, self.bounds)
        if certificate.is_certified:
            return self
        return replace(self, bounds=self._limits_for(harmonic_map, certificate, room=room))

    def _limits_for(
        self, harmonic_map: HarmonicMap, certificate: Certificate, *, room: float = FOLLOW
    ) -> LocalBounds:
        """Return the bounds, widened as a map needs.

        Limits that differ along the outline widen one by one.
        """
        if not np.ndim(self.bounds.k):
            return widen_limits(certificate, self.bounds, room=room)
        proven = proven_around(harmonic_map, certificate, self.boundary)
        return widen_limits(proven, self.bounds, room=room)

    def positions(self, state: State) -> Complexes:
        """Return the present positions of the handles, complex128 (h,)."""
        coordinates = self.handles.coordinates
        phi, psi = state.map.columns
        return coordinates @ phi + (coordinates @ psi).conj()

    def step(self, state: State, targets: HandleTargets) -> State:
        """Take one Newton step towards the targets; the new map is certified like the old one.

        Call it once for each picture while the targets move: the shape follows. Call it again with
        the same targets, as often as there is time, until the status is final (`Status.is_final`).
        The shape then comes to rest in a minimum, and its energy only falls. From then on the same
        targets return the same state.

        Notes
        -----
        The same states and targets give the same maps, bit for bit on one machine. Cost: 24 s n²
        for s samples in the Hessian, n the number of cage vertices; then 22 n³ for its factors. Far
        from the bounds both serve several steps, and each such step costs 32 m n for m samples a
        round.
        """
        self._require_own(targets)
        if len(targets.positions) == 0 and targets.aims is None and self.allows(state):
            return replace(state, limits=self.bounds, status=Status.FREE, targets=targets)
        if not self._is_same_request(state, targets):
            if state.search or state.outcome or state.starting_points:
                state = replace(state, search=None, outcome=None, starting_points=())
        elif state.status.is_final:
            return state
        elif state.search is None and self._has_tracked(state):
            state = begin_searches(self, state, targets, tuple(StartingPoint))
        if state.search is None:
            return take_drag_step(self, state, targets)
        return advance_searches(self, state, state.search)

    def release(self, state: State, left: HandleTargets) -> State:
        """Return the state after the drag ends and the handles have the targets `left`.

        A minimum stays final if `left` pulls as the present targets do: the gradient is the same,
        as with targets from `HandleTargets.released`. From any other state further steps continue
        the search.
        """
        targets, is_minimum = state.targets, state.status in (Status.CONVERGED, Status.AT_LIMITS)
        if is_minimum and targets is not None:
            before, after = (
                objective.held_gradient(evaluation)
                for objective, evaluation in (
                    self.measure_state(state, each) for each in (targets, left)
                )
            )
            if np.linalg.norm(after - before) <= SAME_PULL * np.linalg.norm(before):
                return replace(state, targets=left)
        return replace(state, status=Status.MOVING, search=None, outcome=None, starting_points=())

    def _require_own(self, targets: HandleTargets) -> None:
        require_kind(targets, HandleTargets, "targets")
        if len(targets.positions) != len(self.handles.points):
            raise EngineError(
                TARGET_COUNT, count=len(self.handles.points), given=len(targets.positions)
            )

    def _is_same_request(self, state: State, targets: HandleTargets) -> bool:
        """Whether the last step had these targets, handles and bounds."""
        return (
            state.handles is self.handles
            and targets.is_same(state.targets)
            and self.bounds.include(state.limits)
            and state.limits.include(self.bounds)
        )

    def _has_tracked(self, state: State) -> bool:
        """Whether drag steps alone bring the handles no nearer."""
        last = state.statistics
        return (
            last is not None
            and self.allows(state)
            and (
                state.schedule.idle_steps >= PATIENCE
                or (not last.has_hit_radius and last.length > FULL)
            )
        )

    def settle(
        self,
        state: State,
        targets: HandleTargets,
        *,
        ways: tuple[StartingPoint, ...] = tuple(StartingPoint),
        at_most: int = 600,
        throw: bool = True,
    ) -> tuple[State, int]:
        """Find the pose of least energy for the targets; return the number of steps too.

        Each entry of `ways` starts one search. A search from the present map alone stays in its
        valley. At most `at_most` steps are taken. Once the present map is within the bounds, the
        result has no more energy than it.

        Raises
        ------
        EngineError
            If the shape did not come to rest within the bounds. With `throw=False` the last state
            is returned, certified for its `limits`, and `status` is the reason.
        """
        self._require_own(targets)
        state, count = self._settled(state, targets, ways, as_count(at_most, "at_most"))
        if throw and not state.status.is_solved:
            raise EngineError(UNSETTLED, count=count, status=state.status.value)
        return state, count

    def _settled(
        self, state: State, targets: HandleTargets, ways: tuple[StartingPoint, ...], at_most: int
    ) -> tuple[State, int]:
        count = 0
        if not (self._is_same_request(state, targets) and state.status.is_final):
            while count < at_most and not self.allows(state):
                state, count = take_drag_step(self, state, targets), count + 1
                if state.status.is_final:
                    return state, count
            if len(targets.positions) > 0 and count < at_most:
                state = begin_searches(self, state, targets, ways)
        while count < at_most:
            state, count = self.step(state, targets), count + 1
            if state.status.is_final:
                break
        return state, count

    def track_path_row(self, state: State, targets: HandleTargets) -> tuple[State, int]:
        """Take up to `PATH_STEPS` steps towards one row of a recorded path; return their number."""
        self._require_own(targets)
        for count in range(1, PATH_STEPS + 1):
            state = take_drag_step(self, state, targets)
            done = state.statistics
            if done is None or (
                done.length > FULL
                and done.decrement < PATH_REST * done.energy
                and done.target_error < STEP_RADIUS
            ):
                return state, count
        return state, PATH_STEPS

"""The solver of a drag, step by step."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

from app.document import Pose, Target, misses_target
from app.solving.drag.limb_targets import LimbTargets
from app.solving.drag.rig import PosedRig, Rig, pins_of
from engine.deform import BoundedPull, State


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DragSolver:
    """The state of a drag; every map in between is certified.

    The deformer has the layer's limits, widened if the first pose needs it. `pins` are the targets
    of the fixed points. `followed` are the last targets, and where limbs are for them.
    """

    posed: PosedRig
    state: State
    pins: tuple[Target, ...] = ()
    followed: tuple[Mapping[int, Target], LimbTargets] | None = None

    @classmethod
    def begin(cls, rig: Rig, pose: Pose) -> Self:
        """Return the drag that begins with a pose; a folded pose raises an `EngineError`."""
        shape = rig.layer.map_of(pose)
        posed = rig.posed_at(shape, pose.targets, rig.allow_pose(pose))
        return cls(posed=posed, state=posed.deformer.start(shape), pins=pins_of(rig.layer, pose))

    @property
    def rig(self) -> Rig:
        return self.posed.rig

    @property
    def is_over(self) -> bool:
        """Whether more steps would change nothing."""
        return self.state.status.is_final

    def step_towards(
        self,
        targets: Mapping[int, Target],
        steps: int,
        hands: Sequence[BoundedPull] = (),
        pulled: Collection[int] = (),
    ) -> "DragSolver":
        """Return the drag after some steps towards the targets, or fewer if it comes to rest.

        `pulled` are the ids of dragged handles. They are included even with springs.
        """
        rig = Rig.of(self.rig.layer, self.rig, pulled)
        posed, followed = self.posed, self._known(targets)
        if followed is None or rig is not posed.rig:
            posed, followed = posed.with_rig(rig).follow(targets)
        state, now = self.state, posed.straighten(followed, self.state.map)
        wanted = posed.build_targets(now, self.pins, hands)
        for _ in range(steps):
            if now != followed and (now := posed.straighten(followed, state.map)) == followed:
                wanted = posed.build_targets(followed, self.pins, hands)
            state = posed.deformer.step(state, wanted)
            if state.status.is_final:
                break
        return replace(self, posed=posed, state=state, followed=(targets, followed))

    def release(
        self, targets: Mapping[int, Target], hands: Sequence[BoundedPull]
    ) -> tuple["DragSolver", Mapping[int, Target]]:
        """Return the drag after release, and the new targets of the dragged handles.

        Ends of limbs that are dragged beyond reach are left where the bones reach. A pose at rest
        is also at rest for the new targets.
        """
        posed, followed = self.posed.follow(targets)
        wanted = posed.build_targets(followed, self.pins, hands)
        left = wanted.released(posed.deformer.positions(self.state)).positions
        before = followed.targets
        pulled = {identity for hand in hands for identity in hand.handles}
        places = {
            handle.id: replace(before[handle.id], position=complex(place))
            for handle, place in zip(posed.rig.handles, left, strict=False)
            if handle.id in pulled
        }
        ends = posed.release_ends(before, self.state.map, pulled)
        places |= {i: replace(before[i], position=place) for i, place in ends.items()}
        wanted = posed.build_targets(followed._replace(targets={**before, **places}), self.pins)
        return replace(self, state=posed.deformer.release(self.state, wanted)), places

    def out_of_reach(self, targets: Mapping[int, Target]) -> Mapping[int, float]:
        """Return how far ends of limbs stay off their targets, in pixels, by the bones alone."""
        followed = self.posed.follow(targets := {**self.posed.start, **targets})[1].targets
        off = {i: abs(followed[i].position - targets[i].position) for i in self.posed.ends}
        return {i: error for i, error in off.items() if misses_target(self.rig.layer, error)}

    def make_pose(self, targets: Mapping[int, Target]) -> Pose:
        """Return the current state as a pose with these targets."""
        followed = self._known(targets) or self.posed.follow(targets)[1]
        return self.posed.make_pose(self.state.map, followed.targets, self.state.certificate)

    def _known(self, targets: Mapping[int, Target]) -> LimbTargets | None:
        """Return the targets with limbs of the last steps if they were for these targets."""
        known = self.followed
        return known[1] if known is not None and known[0] == targets else None

"""A pose drag: a requested pose, from the press until the pose rests."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from app.document import Clip, Document, History, Layer, Pose, PoseReplacement, Target
from app.editor.work.derived import Derived
from app.editor.work.pending_change import PendingChange
from app.solving import DragSolver
from app.texts import _
from engine.deform import BoundedPull

# Newton steps towards one target; a drag comes to rest in far fewer.
MOST_STEPS = 600
ROUNDING = 1e-9  # pixels


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DragStart:
    """The pose at the start of a drag, by the ids of the layer's handles.

    `places` are the handles' places. `angles` are the rotations of the shape there, in radians.
    """

    places: Mapping[int, complex]
    angles: Mapping[int, float]
    targets: Mapping[int, Target]

    @classmethod
    def of(cls, layer: Layer, pose: Pose) -> "DragStart":
        f, identities = layer.map_of(pose), [handle.id for handle in layer.handles]
        at = np.array([handle.position for handle in layer.handles], dtype=np.complex128)
        places = dict(zip(identities, f(at).tolist(), strict=True))
        turns = dict(zip(identities, np.angle(f.derivatives(at)[0]).tolist(), strict=True))
        return cls.at(places, turns, pose.targets)

    @classmethod
    def at(
        cls,
        places: Mapping[int, complex],
        turns: Mapping[int, float],
        targets: Mapping[int, Target],
    ) -> "DragStart":
        """Return the start for handles at some places; a handle without a target gets its place."""
        wanted = {i: targets.get(i) or Target(position=places[i]) for i in places}
        return cls(places=places, angles=turns, targets=wanted)


# Computes new targets from the start of a drag and its earlier targets.
TargetChange = Callable[[DragStart, Mapping[int, Target]], Mapping[int, Target]]


@dataclass(slots=True, kw_only=True, eq=False)
class Pull(PendingChange):
    """A pose drag of a layer at a frame: targets of handles, and the solver's progress.

    It lives until the pose rests, independent of the playhead and of other edits. Each pose of the
    solver replaces the previous one, in its own history step and in all later ones.

    Attributes
    ----------
    clip : Clip
        The layer at the start, in its scene's time; the solver works on it.
    frame : int
        The present frame of the pose: it moves with its key.
    gesture : object
        Edits of one gesture are one undo step.
    start : DragStart, optional
        None while the in-between at the start is not computed.
    before : Pose, optional
        The pose of the key or the frame before the drag; None for a new key.
    is_keyed : bool
        Whether a key holds the pose: the auto-key setting at the start.
    target_changes : dict of object to TargetChange
        By gesture, in order; each change gets the targets before it.
    dragged_targets : dict of object to BoundedPull
        By gesture, until the pose rests.
    translations : dict of object to complex
        Moves of the whole layer, by gesture. They are applied to the solver's result exactly and
        do not change it.
    rests : bool
        Whether the pose at the start is at rest: a mere move keeps it.
    targets : mapping of int to Target, optional
        The result of all changes; None without a start.
    dragged_handles : frozenset of int
        Ids of the handles with changed targets.
    position : int
        Of the history at the last change of targets.
    drag : DragSolver, optional
        The solver's state; None until its first steps are done.
    solved : tuple of mapping of int to Target and tuple of BoundedPull, optional
        The targets and the bounded pulls of the solver's last steps.
    steps : int
        Newton steps towards the present targets.
    found : Pose, optional
        The solver's pose, without translations.
    newest : Pose, optional
        The solver's pose with the translations.
    kept : Pose, optional
        The committed pose; None before the first commit.
    tried : Pose, optional
        The pose whose in-betweens are prepared, after the release.
    trial : Derived
        The layer's clip with `tried`, cached since each frame asks for it several times.
    ready : Pose, optional
        The newest pose with prepared in-betweens, committed when the playhead leaves.
    is_left : bool
        Whether the playhead is elsewhere.
    """

    label: str = _("Posing")
    clip: Clip
    frame: int
    gesture: object
    start: DragStart | None
    before: Pose | None
    is_keyed: bool
    target_changes: dict[object, TargetChange] = field(default_factory=dict)
    dragged_targets: dict[object, BoundedPull] = field(default_factory=dict)
    translations: dict[object, complex] = field(default_factory=dict)
    rests: bool = True
    targets: Mapping[int, Target] | None = None
    dragged_handles: frozenset[int] = frozenset()
    position: int = 0
    is_held: bool = True
    drag: DragSolver | None = None
    solved: tuple[Mapping[int, Target], tuple[BoundedPull, ...]] | None = None
    steps: int = 0
    found: Pose | None = None
    newest: Pose | None = None
    kept: Pose | None = None
    tried: Pose | None = None
    trial: Derived[tuple[Document, Pose, Pose], Clip | None] = field(
        default_factory=lambda: Derived(None)
    )
    ready: Pose | None = None
    is_left: bool = False

    def change_targets(
        self, gesture: object, change: TargetChange, hand: BoundedPull | None = None
    ) -> None:
        """Set a gesture's change of targets, in place of its earlier one."""
        self.target_changes[gesture] = change
        if hand is not None:
            self.dragged_targets[gesture] = hand
        self.update_targets()

    def move(self, gesture: object, way: complex) -> None:
        """Set a gesture's translation of the whole layer from the start."""
        self.translations[gesture] = way
        self.change_targets(gesture, _nothing)
        pose = self.found or self.before
        if pose is not None:
            self.take(pose)

    def take(self, pose: Pose) -> Pose:
        """Store the solver's pose; return it with the translations."""
        way = sum(self.translations.values())
        self.found = pose
        self.newest = _moved_pose(self.clip.layer, pose, way) if way else pose
        return self.newest

    def revert(self, gesture: object) -> None:
        """Remove a gesture's targets and translation."""
        del self.target_changes[gesture]
        self.dragged_targets.pop(gesture, None)
        if self.translations.pop(gesture, None) and self.found is not None:
            self.take(self.found)
        self.update_targets()

    def force_targets(self) -> None:
        """Keep the released positions as targets even if they cannot be reached."""
        self.dragged_targets = {}
        self.steps = 0

    def release(self) -> None:
        """Move the dragged targets to the reached places; a pose at rest stays."""
        if self.drag is None or self.targets is None:
            return
        before, hands = self.targets, self.dragged_targets
        self.drag, places = self.drag.release(before, tuple(hands.values()))
        moves = {i: place.position - before[i].position for i, place in places.items()}
        for gesture in hands:
            others = {i for other in hands if other is not gesture for i in hands[other].handles}
            own = {i: moves.pop(i) for i in places if i in moves and i not in others}
            self.target_changes[gesture] = partial(_moved, self.target_changes[gesture], own)
        self.dragged_targets = {}
        self.update_targets()
        # The pose stays unless a later gesture has set an absolute target.
        found = {**before, **places}
        if all(abs(self.targets[i].position - found[i].position) < ROUNDING for i in found):
            self.solved = (self.targets, ())
            self.take(self.drag.make_pose(self.targets))

    @property
    def reached(self) -> Mapping[int, Target]:
        """Targets of dragged handles after a release at this moment, by id."""
        if self.drag is None or self.targets is None or not self.dragged_targets:
            return {}
        return self._moved(self.drag.release(self.targets, tuple(self.dragged_targets.values()))[1])

    @property
    def world_targets(self) -> Mapping[int, Target] | None:
        """The targets with the translations; None without a start."""
        return None if self.targets is None else self._moved(self.targets)

    def _moved(self, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        return _moved_targets(targets, dict.fromkeys(targets, sum(self.translations.values())))

    def update_targets(self) -> None:
        """Compute the targets again."""
        self.steps = 0
        if self.start is None:
            # Targets of the dropped start were for other handles.
            self.targets, self.dragged_handles = None, frozenset()
        else:
            self.targets = combine_targets(self.start, self.target_changes.values())
            self.dragged_handles = find_changed_handles(self.start, self.target_changes.values())

    @property
    def layer(self) -> int:
        return self.clip.layer.id

    @property
    def is_rigid(self) -> bool:
        """Whether the drag only moves a pose at rest, so that nothing needs solving."""
        return (
            self.rests
            and bool(self.translations)
            and self.translations.keys() == self.target_changes.keys()
        )

    @property
    def is_at_rest(self) -> bool:
        """Whether the solver has found the final pose."""
        if self.is_rigid:
            return self.found is not None
        is_over = self.drag is not None and self.drag.is_over
        towards = (self.targets, tuple(self.dragged_targets.values()))
        return self.steps >= MOST_STEPS or (is_over and self.solved == towards)

    @property
    def is_settled(self) -> bool:
        """Whether the final pose is committed, and released targets are clamped."""
        is_done = self.is_held or not self.dragged_targets
        return self.is_at_rest and self.kept is self.newest and is_done

    def is_in(self, history: History) -> bool:
        """Return whether the present document has a pose of this drag, or will get the first."""
        if self.kept is None:
            return True
        layers = history.document.layers
        layer = next((layer for layer in layers if layer.id == self.layer), None)
        if layer is None:
            return False
        poses = list(layer.poses)
        if history.preview_pose is not None:
            poses.append(history.preview_pose.pose)
        return any(pose.phi is self.kept.phi for pose in poses)

    def brought_to(self, pose: Pose) -> PoseReplacement:
        """Return the function that puts a pose of this drag into a layer of any history step."""
        then = {handle.id: handle.position for handle in self.clip.layer.handles}

        def of(layer: Layer, earlier: Pose) -> Pose:
            now = {handle.id: handle.position for handle in layer.handles}
            if now == then and earlier.targets.keys() == pose.targets.keys() == then.keys():
                return pose
            # Handles have changed meanwhile; new handles have no targets yet.
            start = DragStart.of(layer, replace(pose, targets=earlier.targets))
            targets = {}
            for identity, position in now.items():
                here = replace(start.targets[identity], position=start.places[identity])
                is_same = then.get(identity) == position and identity in pose.targets
                targets[identity] = pose.targets[identity] if is_same else here
            return replace(pose, targets=targets)

        return of


def _moved(
    change: TargetChange,
    moves: Mapping[int, complex],
    start: DragStart,
    targets: Mapping[int, Target],
) -> Mapping[int, Target]:
    """Return the targets of a change, moved to the places that the drag reached."""
    joints = {i: targets[i] for i in moves if i in targets}
    return _moved_targets({**joints, **change(start, targets)}, moves)


def _moved_targets(
    targets: Mapping[int, Target], moves: Mapping[int, complex]
) -> Mapping[int, Target]:
    return {
        i: replace(target, position=target.position + moves.get(i, 0.0))
        for i, target in targets.items()
    }


def _moved_pose(layer: Layer, pose: Pose, way: complex) -> Pose:
    """Return a moved pose with its targets; its distortion stays the same."""
    targets = _moved_targets(pose.targets, dict.fromkeys(pose.targets, way))
    return replace(pose.with_map(layer.map_of(pose).moved(1.0, way)), targets=targets)


def _nothing(_: DragStart, __: Mapping[int, Target]) -> Mapping[int, Target]:
    """Return no changes of targets."""
    return {}


def absolute_targets(
    wanted: Mapping[int, Target], _: DragStart, targets: Mapping[int, Target]
) -> Mapping[int, Target]:
    """Return targets that are independent of the drag's start."""
    return {i: target for i, target in wanted.items() if i in targets}


def combine_targets(start: DragStart, changes: Iterable[TargetChange]) -> Mapping[int, Target]:
    """Return the targets after all changes in order."""
    targets = dict(start.targets)
    for change in changes:
        for identity, target in change(start, targets).items():
            # Unknown fields of a target, written by a later version, stay.
            targets[identity] = replace(target, unknown=targets[identity].unknown)
    return targets


def find_changed_handles(start: DragStart, changes: Iterable[TargetChange]) -> frozenset[int]:
    """Return the ids of the handles with changed targets."""
    return frozenset(identity for change in changes for identity in change(start, start.targets))

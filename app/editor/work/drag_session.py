"""A drag of a pose, from the press until the pose rests and becomes a key."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from app.document import Clip, Easing, Layer, Pose, Target, find_limbs
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
        f, identities, limbs = layer.map_of(pose), [h.id for h in layer.handles], find_limbs(layer)
        at = np.array([handle.position for handle in layer.handles], dtype=np.complex128)
        places = dict(zip(identities, f(at).tolist(), strict=True))
        turns = dict(zip(identities, np.angle(f.derivatives(at)[0]).tolist(), strict=True))
        if limbs is not None:
            # Joints are places of bones, which the drawing there may miss by some pixels.
            placed = limbs.locate(f(limbs.points))
            places |= placed.places
            turns |= placed.angles
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
class DragSession(PendingChange):
    """A drag of a layer's pose at a frame: targets of handles, and the solver's progress.

    It lives until the pose rests, independent of the playhead. Meanwhile its `preview` is displayed
    on top of the document. Then the pose becomes one undo step.

    Attributes
    ----------
    clip : Clip
        The layer at the start, in its scene's time; the solver works on it.
    frame : int
        The frame of the key.
    gesture : object
        Edits of one gesture are one undo step.
    start : DragStart, optional
        None while the in-between at the start is not computed.
    before : Pose, optional
        The pose of the key or the frame before the drag; None for a new key.
    is_stepped : bool
        Whether it has no gesture: it consists of single steps.
    is_keyed : bool
        Whether a key holds the pose: the auto-key setting at the start.
    easing : Easing
        Of a new key.
    target_changes : dict of object to TargetChange
        By gesture, in order; each change gets the targets before it.
    dragged_targets : dict of object to BoundedPull
        By gesture, until the pose rests.
    translations : dict of object to complex
        Moves of the whole layer, by gesture. They are applied to the solver's result exactly and
        do not change it.
    targets : mapping of int to Target, optional
        The result of all changes; None without a start.
    dragged_handles : frozenset of int
        Ids of the handles with changed targets.
    solver : DragSolver, optional
        The solver's state; None until its first steps are done.
    solved : tuple of mapping of int to Target and tuple of BoundedPull, optional
        The targets and the bounded pulls of the solver's last steps.
    steps : int
        Newton steps towards the present targets.
    found : Pose, optional
        The solver's pose, without translations.
    newest : Pose, optional
        The solver's pose with the translations.
    preview : Pose, optional
        The displayed pose: the newest one at the playhead. When the playhead leaves, it stays until
        the pose rests, so that the in-betweens stay the same.
    is_awaited : bool
        Whether a command waits until the pose rests.
    """

    label: str = _("Posing")
    clip: Clip
    frame: int
    gesture: object
    is_stepped: bool = False
    start: DragStart | None
    before: Pose | None
    is_keyed: bool
    easing: Easing
    target_changes: dict[object, TargetChange] = field(default_factory=dict)
    dragged_targets: dict[object, BoundedPull] = field(default_factory=dict)
    translations: dict[object, complex] = field(default_factory=dict)
    targets: Mapping[int, Target] | None = None
    dragged_handles: frozenset[int] = frozenset()
    solver: DragSolver | None = None
    solved: tuple[Mapping[int, Target], tuple[BoundedPull, ...]] | None = None
    steps: int = 0
    found: Pose | None = None
    newest: Pose | None = None
    preview: Pose | None = None
    is_awaited: bool = False

    @property
    def layer(self) -> int:
        return self.clip.layer.id

    def change_targets(
        self, gesture: object, change: TargetChange, hand: BoundedPull | None = None
    ) -> None:
        """Set a gesture's change of targets, in place of its earlier one."""
        self.update_targets({**self.target_changes, gesture: change})
        if hand is not None:
            self.dragged_targets[gesture] = hand

    def move(self, gesture: object, way: complex) -> None:
        """Set a gesture's translation of the whole layer from the start."""
        self._translate({**self.translations, gesture: way}, self.found or self.before)
        self.change_targets(gesture, _nothing)

    def note_awaited(self) -> None:
        """Note that a command waits until the pose rests."""
        self.is_awaited, self.label = True, _("Finishing the pose. Esc stops it where it is")

    def take(self, pose: Pose) -> None:
        """Store the solver's pose, and the same with the translations."""
        self._translate(self.translations, pose)

    def _translate(self, translations: dict[object, complex], pose: Pose | None) -> None:
        way = sum(translations.values())
        newest = _moved_pose(self.clip.layer, pose, way) if pose is not None and way else pose
        self.translations, self.found, self.newest = translations, pose, newest

    def revert(self, gesture: object) -> None:
        """Remove a gesture's targets and translation."""
        self.dragged_targets.pop(gesture, None)
        if self.translations.pop(gesture, None) and self.found is not None:
            self.take(self.found)
        left = {by: change for by, change in self.target_changes.items() if by is not gesture}
        self.update_targets(left)

    def force_targets(self) -> None:
        """Keep the released positions as targets even if they cannot be reached."""
        self.dragged_targets = {}
        self.steps = 0

    def clamp_targets(self) -> None:
        """Move the dragged targets to the reached places; a pose at rest stays."""
        if self.solver is None or self.targets is None:
            return
        before, hands = self.targets, self.dragged_targets
        self.solver, places = self.solver.release(before, tuple(hands.values()))
        moves = {i: place.position - before[i].position for i, place in places.items()}
        changes = dict(self.target_changes)
        for gesture in hands:
            others = {i for other in hands if other is not gesture for i in hands[other].handles}
            own = {i: moves.pop(i) for i in places if i in moves and i not in others}
            changes[gesture] = partial(_moved, changes[gesture], own)
        self.dragged_targets = {}
        self.update_targets(changes)
        # The pose stays unless a later gesture has set an absolute target.
        found = {**before, **places}
        if all(abs(self.targets[i].position - found[i].position) < ROUNDING for i in found):
            self.solved = (self.targets, ())
            self.take(self.solver.make_pose(self.targets))

    @property
    def reached(self) -> Mapping[int, Target]:
        """Targets of dragged handles after a release at this moment, by id."""
        if self.solver is None or self.targets is None or not self.dragged_targets:
            return {}
        hands = tuple(self.dragged_targets.values())
        return self._moved(self.solver.release(self.targets, hands)[1])

    @property
    def world_targets(self) -> Mapping[int, Target] | None:
        """The targets with the translations; None without a start."""
        return None if self.targets is None else self._moved(self.targets)

    def _moved(self, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        way = sum(self.translations.values())
        return _moved_targets(targets, dict.fromkeys(targets, way)) if way else targets

    def update_targets(self, changes: dict[object, TargetChange]) -> None:
        """Compute the targets of these changes; if a target is refused, the earlier ones stay."""
        targets, dragged = None, frozenset[int]()
        if self.start is not None:
            targets = combine_targets(self.start, changes.values())
            dragged = find_changed_handles(self.start, changes.values())
        self.target_changes, self.targets, self.dragged_handles = changes, targets, dragged
        self.steps = 0

    @property
    def is_rigid(self) -> bool:
        """Whether the drag only moves a pose, so that nothing needs solving."""
        return bool(self.translations) and self.translations.keys() == self.target_changes.keys()

    @property
    def is_at_rest(self) -> bool:
        """Whether the solver has found the final pose."""
        if self.is_rigid:
            return self.found is not None
        is_over = self.solver is not None and self.solver.is_over
        towards = (self.targets, tuple(self.dragged_targets.values()))
        return self.steps >= MOST_STEPS or (is_over and self.solved == towards)


class StoppedDrag(NamedTuple):
    """A drag with the wanted targets of its handles, and those that they reached, by handle id."""

    drag: DragSession
    asked: Mapping[int, Target]
    reached: Mapping[int, Target]


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

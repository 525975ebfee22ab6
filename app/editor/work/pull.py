"""A pose that the hand has asked for, on its way to rest."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from app.document import Clip, Document, History, Layer, Pose, PoseReplacement, Target
from app.editor.work.derived import Derived
from app.editor.work.promise import Promise
from app.solving import DragSolver
from engine.deform import BoundedPull

# Newton steps towards one wish; a drag comes to rest in far fewer.
MOST_STEPS = 600
ROUNDING = 1e-9  # pixels


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DragStart:
    """A pose as a pull begins with it, by the ids of the layer's handles.

    Parameters
    ----------
    places : mapping of int to complex
        Where the handles are.
    turns : mapping of int to float
        By how much the shape turns there, in radians.
    targets : mapping of int to Target
        Where they are wanted.
    """

    places: Mapping[int, complex]
    angles: Mapping[int, float]
    targets: Mapping[int, Target]

    @classmethod
    def of(cls, layer: Layer, pose: Pose) -> "DragStart":
        """Return the start that a pose of a layer is."""
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
        """Return the start with handles at some places, wanted there unless a target says else."""
        wanted = {i: targets.get(i) or Target(position=places[i]) for i in places}
        return cls(places=places, angles=turns, targets=wanted)


# Returns where handles are wished, of a pull's start and of what was wished of it before.
TargetChange = Callable[[DragStart, Mapping[int, Target]], Mapping[int, Target]]


@dataclass(slots=True, kw_only=True, eq=False)
class Pull(Promise):
    """Handles of a layer at a frame, wished elsewhere, and how far the solver has followed.

    It lives until the pose rests, wherever the playhead goes and whatever else is done meanwhile:
    each pose that the solver finds takes the place of the one before, in the step of history that
    is its own and in all later ones.

    Parameters
    ----------
    clip : Clip
        The layer as it was when it began, which the solver knows, in its scene's time.
    frame : int
        Where the pose belongs now: it moves with its key.
    gesture : object
        What is one step of undo together.
    start : DragStart, optional
        None as long as the in-between that it begins with is not worked out.
    before : Pose, optional
        The one that the key or the frame had; None for a new key.
    is_keyed : bool
        Whether a key has the pose, as the person wanted when it began.
    wishes : dict of object to TargetChange
        By the gestures that they are of, in order; each knows what was wished before it.
    hands : dict of object to Hand
        By the gestures that pull handles, told by their ids, until the pose has come to rest.
    ways : dict of object to complex
        By the gestures that move the layer as a whole. The solver knows nothing of that: what it
        finds is moved, as exactly as it is.
    rests : bool
        Whether the pose that it begins with is at rest: merely moved, it stays as it is.
    targets : mapping of int to Target, optional
        What all of that comes to; None as long as there is no start.
    pulled : frozenset of int
        The ids of the handles of which something is wished.
    position : int
        Of the history when something was wished last.
    is_held : bool
        Whether the hand still pulls.
    drag : DragSolver, optional
        Where the solver is; None until its first steps are done.
    solved : tuple of mapping of int to Target and tuple of BoundedPull, optional
        The targets that these steps were towards, and the hands that pulled.
    steps : int
        Newton steps towards the present targets.
    found : Pose, optional
        Where the solver is, as a pose; at first the one that was there before.
    newest : Pose, optional
        The same, moved as the layer is moved.
    kept : Pose, optional
        What the document has of it; None as long as that is nothing.
    tried : Pose, optional
        The one whose in-betweens are being prepared, once the hand has let go.
    trial : Derived
        The layer's clip with it, as long as the document stays: several ask for it in each frame.
    ready : Pose, optional
        The newest one whose in-betweens are there: the playhead that leaves it finds them.
    is_left : bool
        Whether the playhead is elsewhere.
    """

    label: str = "Posing"
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
        self, gesture: object, wish: TargetChange, hand: BoundedPull | None = None
    ) -> None:
        """Wish something else of a gesture, in place of what it wished before."""
        self.target_changes[gesture] = wish
        if hand is not None:
            self.dragged_targets[gesture] = hand
        self.update_targets()

    def move(self, gesture: object, way: complex) -> None:
        """Let a gesture move the layer as a whole, so far from where it began."""
        self.translations[gesture] = way
        self.change_targets(gesture, _nothing)
        pose = self.found or self.before
        if pose is not None:
            self.take(pose)

    def take(self, pose: Pose) -> Pose:
        """Take note of where the solver is; return that as it is moved."""
        way = sum(self.translations.values())
        self.found = pose
        self.newest = _moved_pose(self.clip.layer, pose, way) if way else pose
        return self.newest

    def revert(self, gesture: object) -> None:
        """Take back what a gesture wished."""
        del self.target_changes[gesture]
        self.dragged_targets.pop(gesture, None)
        if self.translations.pop(gesture, None) and self.found is not None:
            self.take(self.found)
        self.update_targets()

    def force_targets(self) -> None:
        """Let what hands pulled be wanted where they let go, however far that is."""
        self.dragged_targets = {}
        self.steps = 0

    def release(self) -> None:
        """Let what hands pulled be wanted where it is from now on; a pose at rest stays."""
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
        # Unless a later wish is for a place that does not depend on the one before it.
        found = {**before, **places}
        if all(abs(self.targets[i].position - found[i].position) < ROUNDING for i in found):
            self.solved = (self.targets, ())
            self.take(self.drag.make_pose(self.targets))

    @property
    def reached(self) -> Mapping[int, Target]:
        """Where handles that hands pull would be wanted if these let go now, by their ids."""
        if self.drag is None or self.targets is None or not self.dragged_targets:
            return {}
        return self._moved(self.drag.release(self.targets, tuple(self.dragged_targets.values()))[1])

    @property
    def world_targets(self) -> Mapping[int, Target] | None:
        """The targets, moved as the layer is; None as long as there is no start."""
        return None if self.targets is None else self._moved(self.targets)

    def _moved(self, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        return _moved_targets(targets, dict.fromkeys(targets, sum(self.translations.values())))

    def update_targets(self) -> None:
        """Work out the targets anew."""
        self.steps = 0
        if self.start is None:
            # Those of a start that was left knew other handles.
            self.targets, self.dragged_handles = None, frozenset()
        else:
            self.targets = combine_targets(self.start, self.target_changes.values())
            self.dragged_handles = find_changed_handles(self.start, self.target_changes.values())

    @property
    def layer(self) -> int:
        """The id of its layer."""
        return self.clip.layer.id

    @property
    def is_rigid(self) -> bool:
        """Whether there is nothing to be solved, as a pose at rest is but moved."""
        return (
            self.rests
            and bool(self.translations)
            and self.translations.keys() == self.target_changes.keys()
        )

    @property
    def is_at_rest(self) -> bool:
        """Whether the solver has found the pose, and moves nothing any more."""
        if self.is_rigid:
            return self.found is not None
        is_over = self.drag is not None and self.drag.is_over
        towards = (self.targets, tuple(self.dragged_targets.values()))
        return self.steps >= MOST_STEPS or (is_over and self.solved == towards)

    @property
    def is_settled(self) -> bool:
        """Whether the document has the pose at rest, and hands that let go have given in."""
        is_done = self.is_held or not self.dragged_targets
        return self.is_at_rest and self.kept is self.newest and is_done

    def is_in(self, history: History) -> bool:
        """Tell whether the document, as it is now, has a pose of it, or is to have the first."""
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
        """Return how a layer of any step of history has a pose of this pull."""
        then = {handle.id: handle.position for handle in self.clip.layer.handles}

        def of(layer: Layer, earlier: Pose) -> Pose:
            now = {handle.id: handle.position for handle in layer.handles}
            if now == then and earlier.targets.keys() == pose.targets.keys() == then.keys():
                return pose
            # Handles came, went or were put elsewhere since: of those nothing is wished yet.
            start = DragStart.of(layer, replace(pose, targets=earlier.targets))
            targets = {}
            for identity, position in now.items():
                here = replace(start.targets[identity], position=start.places[identity])
                is_same = then.get(identity) == position and identity in pose.targets
                targets[identity] = pose.targets[identity] if is_same else here
            return replace(pose, targets=targets)

        return of


def _moved(
    wish: TargetChange,
    moves: Mapping[int, complex],
    start: DragStart,
    targets: Mapping[int, Target],
) -> Mapping[int, Target]:
    """Return what is wished, moved as far as hands, and joints beside them, have given in."""
    joints = {i: targets[i] for i in moves if i in targets}
    return _moved_targets({**joints, **wish(start, targets)}, moves)


def _moved_targets(
    targets: Mapping[int, Target], moves: Mapping[int, complex]
) -> Mapping[int, Target]:
    return {
        i: replace(target, position=target.position + moves.get(i, 0.0))
        for i, target in targets.items()
    }


def _moved_pose(layer: Layer, pose: Pose, way: complex) -> Pose:
    """Return a pose of a layer moved, with all that is wanted of it; it is as distorted."""
    targets = _moved_targets(pose.targets, dict.fromkeys(pose.targets, way))
    return replace(pose.with_map(layer.map_of(pose).moved(1.0, way)), targets=targets)


def _nothing(_: DragStart, __: Mapping[int, Target]) -> Mapping[int, Target]:
    """Return no wishes: those that there are stay."""
    return {}


def absolute_targets(
    wishes: Mapping[int, Target], _: DragStart, targets: Mapping[int, Target]
) -> Mapping[int, Target]:
    """Return wishes that do not depend on where a pull begins."""
    return {i: wish for i, wish in wishes.items() if i in targets}


def combine_targets(start: DragStart, wishes: Iterable[TargetChange]) -> Mapping[int, Target]:
    """Return what some wishes, one after the other, come to."""
    targets = dict(start.targets)
    for wish in wishes:
        for identity, wished in wish(start, targets).items():
            # What a later version wrote about a target stays.
            targets[identity] = replace(wished, unknown=targets[identity].unknown)
    return targets


def find_changed_handles(start: DragStart, wishes: Iterable[TargetChange]) -> frozenset[int]:
    """Return the ids of the handles of which some wishes say anything."""
    return frozenset(identity for wish in wishes for identity in wish(start, start.targets))

"""One step of undo: a frozen snapshot of the document, and the bytes that only it needs."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from app.document.commands.pose_commands import with_all_targets
from app.document.keyframe import Pose
from app.document.layer import Layer
from app.document.model import Document

# Rough sizes of the names and tuples of a snapshot, and of a pose without its map.
SNAPSHOT_BYTES = 2_000
POSE_BYTES = 1_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PreviewPose:
    """An unkeyed pose of a layer at a frame. Undo covers it; a project file does not contain it."""

    layer: int
    frame: int
    pose: Pose


@dataclass(frozen=True, slots=True, eq=False)
class UndoStep:
    """The document after one action."""

    document: Document
    preview_pose: PreviewPose | None
    label: str


@dataclass(slots=True, kw_only=True, eq=False)
class OpenStep:
    """The displayed step of a gesture, until another change of the document commits it.

    Attributes
    ----------
    gestures : set of object
        Their commands extend the step.
    is_held : bool
        Whether the hand goes on with it.
    finish : callable, optional
        Extends the step to its final form before it is committed. May raise
        `UnfinishedStepError` after the history's `patience`.
    """

    step: UndoStep
    gestures: set[object]
    is_held: bool = False
    finish: Callable[[], None] | None = None


class UnfinishedStepError(Exception):
    """The open step is not final yet, and a command that must follow it has changed nothing."""


def fit_preview_pose(
    unkeyed: PreviewPose | None, before: Document, after: Document
) -> PreviewPose | None:
    """Return the unkeyed pose with a target for each handle of the later document.

    A handle that was added or moved gets its own position as target. None if the later document
    lacks the layer, or the layer has another domain.
    """
    if unkeyed is None:
        return None
    was = before.layer(unkeyed.layer)
    now = next((layer for layer in after.layers if layer.id == was.id), None)
    if now is None or now.domain is not was.domain:
        return None
    places = {handle.id: handle.position for handle in now.handles}
    if places == {handle.id: handle.position for handle in was.handles}:
        return unkeyed
    targets = {
        handle.id: unkeyed.pose.targets[handle.id]
        for handle in was.handles
        if places.get(handle.id) == handle.position
    }
    return replace(unkeyed, pose=with_all_targets(now, replace(unkeyed.pose, targets=targets)))


def is_same_step(step: UndoStep, other: UndoStep) -> bool:
    return step.document is other.document and step.preview_pose is other.preview_pose


def bytes_only_in(old: UndoStep, new: UndoStep) -> int:
    """Return the bytes of `old` that `new` does not share."""
    layers = {layer.id: layer for layer in new.document.layers}
    size = SNAPSHOT_BYTES + sum(
        _layer_bytes_only_in(layer, layers.get(layer.id)) for layer in old.document.layers
    )
    kept = {sound.file.sha256 for sound in new.document.sounds}
    size += sum(each.file.size for each in old.document.sounds if each.file.sha256 not in kept)
    if old.preview_pose is not None and old.preview_pose is not new.preview_pose:
        size += POSE_BYTES + old.preview_pose.pose.nbytes
    return size


def _layer_bytes_only_in(old: Layer, new: Layer | None) -> int:
    if old is new:
        return 0
    size = 0
    if new is None or old.picture is not new.picture:
        size += len(old.picture.data)
    if new is None or old.cut_out.mask is not new.cut_out.mask:
        size += old.cut_out.nbytes
    elif old.cut_out is not new.cut_out:
        kept = {id(line) for line in new.cut_out.lines}
        size += sum(line.points.nbytes for line in old.cut_out.lines if id(line) not in kept)
    if new is None or old.domain is not new.domain:
        mesh = old.domain.mesh
        size += sum(loop.nbytes for loop in (*old.domain.loops, *old.domain.cages))
        size += mesh.vertices.nbytes + mesh.triangles.nbytes
    later = () if new is None else new.poses
    poses, maps = {id(pose) for pose in later}, {id(pose.phi) for pose in later}
    for pose in old.poses:
        if id(pose) not in poses:
            size += POSE_BYTES
        if id(pose.phi) not in maps:
            size += pose.nbytes
    return size

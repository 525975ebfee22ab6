"""Undo and redo, as frozen snapshots of the document that share unchanged values."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

from app.document.commands.command import Command
from app.document.commands.pose_commands import with_all_targets
from app.document.keyframe import Pose
from app.document.layer import Layer, PictureFile
from app.document.model import Document

HISTORY_BYTES = 512 * 1024 * 1024
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
    gesture: object = None


class UnfinishedChange(NamedTuple):
    """A change that is displayed but not yet a step; `commit` makes it one."""

    applied_to: Callable[[Document], Document]
    commit: Callable[[], None]


class History:
    """The undo steps of a session; beyond `memory` bytes, the oldest steps are dropped."""

    def __init__(self, document: Document, *, saved: bool, memory: int = HISTORY_BYTES) -> None:
        self._steps = [UndoStep(document, None, "")]
        # _bytes[i]: bytes that only steps up to i use. Dropping step i frees them.
        self._bytes = [0]
        self._now = 0
        self._forgotten = 0  # number of dropped steps
        self.revision = 0  # counts all changes of the steps, and of the present one
        self._gesture: object = None
        # The redo steps that the first command of the gesture replaced.
        self._undone: list[UndoStep] = []
        self._saved = document if saved else None
        self._memory = memory
        # Committed before the next change of the steps.
        self.unfinished: UnfinishedChange | None = None

    @property
    def document(self) -> Document:
        return self._steps[self._now].document

    @property
    def preview_pose(self) -> PreviewPose | None:
        """The current unkeyed pose, if any."""
        return self._steps[self._now].preview_pose

    @property
    def undo_label(self) -> str | None:
        """Label of the action that undo takes back, if any."""
        return self._steps[self._now].label if self._now else None

    @property
    def redo_label(self) -> str | None:
        """Label of the action that redo repeats, if any."""
        return self._steps[self._now + 1].label if self._now + 1 < len(self._steps) else None

    @property
    def position(self) -> int:
        """Number of steps from the first document to the current one, dropped steps included."""
        return self._forgotten + self._now

    @property
    def nearby(self) -> tuple[Document, ...]:
        """The documents after undo, now, and after redo, as far as they exist."""
        steps = self._steps[max(self._now - 1, 0) : self._now + 2]
        return tuple(step.document for step in steps)

    @property
    def picture_files(self) -> frozenset[PictureFile]:
        """Picture files of all layers in all undo and redo steps."""
        layers = (layer for step in self._steps for layer in step.document.layers)
        return frozenset(layer.picture for layer in layers)

    @property
    def is_saved(self) -> bool:
        """Whether the current document is the last saved one."""
        return self.document is self._saved

    def mark_saved(self, document: Document) -> None:
        """Record that a file holds this document, which may be older than the current one."""
        self.revision += 1
        self._saved = document

    def do(self, command: Command, *, gesture: object = None) -> None:
        """Run a command on the document.

        Consecutive commands with the same `gesture` object form one step. No step remains if they
        end with the document before the gesture. Raises a `LissomError` if the command is not
        possible. The history is then unchanged.
        """
        if self.unfinished is not None:
            displayed = self.unfinished.applied_to(self.document)
            if command(displayed) is displayed:
                return
        self._commit_unfinished()
        document = command(self.document)
        unkeyed = _fitting(self.preview_pose, self.document, document)
        self._go_on(UndoStep(document, unkeyed, command.label, gesture))

    def set_preview_pose(self, unkeyed: PreviewPose | None, *, gesture: object = None) -> None:
        """Replace or remove the unkeyed pose, as an undo step."""
        self._commit_unfinished()
        self._go_on(UndoStep(self.document, unkeyed, "Pose", gesture))

    def extend_step(self, command: Command) -> None:
        """Run a command in the last step and remove the unkeyed pose; redo stays possible."""
        self._commit_unfinished()
        step = self._steps[self._now]
        document = command(step.document)
        if document is not step.document:
            self._put(self._now, replace(step, document=document, preview_pose=None))

    def revert(self, gesture: object) -> None:
        """Remove the last step if the gesture made it, and restore the replaced redo steps."""
        if gesture is None or gesture is not self._gesture:
            return
        self.revision += 1
        del self._steps[-1], self._bytes[-1]
        self._now -= 1
        self._bytes[-1] = 0
        for step in self._undone:
            self._append(step)
        self._gesture, self._undone = None, []

    def undo(self) -> None:
        """Go back one step, to the same document object, if possible."""
        self._commit_unfinished()
        if self._now:
            self.revision += 1
            self._now -= 1
            self._gesture, self._undone = None, []

    def redo(self) -> None:
        """Go forward one step, if possible."""
        if self._now + 1 < len(self._steps):
            self._commit_unfinished()
        if self._now + 1 < len(self._steps):
            self.revision += 1
            self._now += 1

    def _commit_unfinished(self) -> None:
        unfinished, self.unfinished = self.unfinished, None
        if unfinished is not None:
            unfinished.commit()

    def _put(self, index: int, step: UndoStep) -> None:
        self.revision += 1
        self._steps[index] = step
        for around in range(max(index - 1, 0), min(index + 1, len(self._steps) - 1)):
            self._bytes[around] = _bytes_only_in(self._steps[around], self._steps[around + 1])

    def _go_on(self, step: UndoStep) -> None:
        gesture = step.gesture
        if _is_same(step, self._steps[self._now]):
            return
        self.revision += 1
        if gesture is not None and gesture is self._gesture:
            if _is_same(step, self._steps[self._now - 1]):
                self.revert(gesture)
                return
            del self._steps[-1], self._bytes[-1]
            self._now -= 1
        else:
            self._undone = [] if gesture is None else self._steps[self._now + 1 :]
            del self._steps[self._now + 1 :], self._bytes[self._now + 1 :]
            self._gesture = gesture
        self._append(step)
        self._now += 1
        self._forget()

    def _append(self, step: UndoStep) -> None:
        self._bytes[-1] = _bytes_only_in(self._steps[-1], step)
        self._steps.append(step)
        self._bytes.append(0)

    def _forget(self) -> None:
        excess = sum(self._bytes) - self._memory
        count = 0
        while excess > 0 and count < self._now - 1:
            excess -= self._bytes[count]
            count += 1
        del self._steps[:count], self._bytes[:count]
        self._now -= count
        self._forgotten += count


def _fitting(unkeyed: PreviewPose | None, before: Document, after: Document) -> PreviewPose | None:
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


def _is_same(step: UndoStep, other: UndoStep) -> bool:
    return step.document is other.document and step.preview_pose is other.preview_pose


def _bytes_only_in(old: UndoStep, new: UndoStep) -> int:
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

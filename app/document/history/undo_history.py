"""Undo and redo, as frozen snapshots of the document that share unchanged values."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import inf

from app.document.commands.command import Command
from app.document.history.undo_step import (
    OpenStep,
    PreviewPose,
    UndoStep,
    bytes_only_in,
    fit_preview_pose,
    is_same_step,
)
from app.document.layer import PictureFile
from app.document.model import Document

HISTORY_BYTES = 512 * 1024 * 1024


class History:
    """The undo steps of a session; beyond `memory` bytes, the oldest steps are dropped.

    A gesture of the hand, such as a drag, is a single step: `hold` begins it, `preview` displays
    its commands, and `release` ends it. `cancel` drops it. Any other command commits it first;
    then later commands of the gesture are void.
    """

    def __init__(self, document: Document, *, saved: bool, memory: int = HISTORY_BYTES) -> None:
        self._steps = [UndoStep(document, None, "")]
        # _bytes[i]: bytes that only steps up to i use. Dropping step i frees them.
        self._bytes = [0]
        self._now = 0
        self._forgotten = 0  # number of dropped steps
        self.revision = 0  # counts all changes of the steps, and of the present one
        self._open: OpenStep | None = None
        # The gestures of the last step that ended while it was held.
        self._ended: frozenset[object] = frozenset()
        self.patience = inf  # seconds for which a command may solve the open step
        self._saved = document if saved else None
        self._memory = memory

    @property
    def _present(self) -> UndoStep:
        return self._steps[self._now] if self._open is None else self._open.step

    @property
    def document(self) -> Document:
        """The document as displayed: with the step of an unfinished gesture."""
        return self._present.document

    @property
    def committed(self) -> Document:
        """The document before the open step."""
        return self._steps[self._now].document

    @property
    def preview_pose(self) -> PreviewPose | None:
        """The current unkeyed pose, if any."""
        return self._present.preview_pose

    @property
    def is_held(self) -> bool:
        """Whether the hand changes the document: undo cancels the change."""
        return self._open is not None and self._open.is_held

    @property
    def is_unfinished(self) -> bool:
        """Whether the displayed step is not final."""
        return self._open is not None and (self._open.is_held or self._open.finish is not None)

    @property
    def undo_label(self) -> str | None:
        """Label of the action that undo takes back, if any."""
        return None if self._present is self._steps[0] else self._present.label

    @property
    def redo_label(self) -> str | None:
        """Label of the action that redo repeats, if any."""
        has_later = self._open is None and self._now + 1 < len(self._steps)
        return self._steps[self._now + 1].label if has_later else None

    @property
    def position(self) -> int:
        """Number of steps from the first document to the current one, dropped steps included."""
        return self._forgotten + self._now + (self._open is not None)

    @property
    def nearby(self) -> tuple[Document, ...]:
        """The documents after undo, now, and after redo, as far as they exist."""
        nearby = [step.document for step in self._steps[max(self._now - 1, 0) : self._now + 2]]
        return (*nearby, self.document) if self._open is not None else tuple(nearby)

    @property
    def picture_files(self) -> frozenset[PictureFile]:
        """Picture files of all layers in all undo and redo steps."""
        layers = (layer for step in (*self._steps, self._present) for layer in step.document.layers)
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
        if not self.is_open(gesture):
            # A command that changes nothing ends no drag.
            if self.is_unfinished and command(self.document) is self.document:
                return
            self.commit()
        before = self._present
        document = command(before.document)
        unkeyed = fit_preview_pose(before.preview_pose, before.document, document)
        self._go_on(UndoStep(document, unkeyed, command.label), gesture)

    def set_preview_pose(self, unkeyed: PreviewPose | None, *, gesture: object = None) -> None:
        """Replace or remove the unkeyed pose, as an undo step."""
        if not self.is_open(gesture):
            self.commit()
        self._go_on(UndoStep(self.document, unkeyed, "Pose"), gesture)

    def extend_step(self, command: Command) -> None:
        """Run a command in the last step and remove the unkeyed pose; redo stays possible."""
        self.commit()
        step = self._steps[self._now]
        document = command(step.document)
        if document is not step.document:
            self._put(self._now, replace(step, document=document, preview_pose=None))

    def is_open(self, gesture: object) -> bool:
        """Return whether commands of a gesture extend the displayed step."""
        return self._open is not None and gesture in self._open.gestures

    def begin(self, gesture: object, label: str, finish: Callable[[], None] | None = None) -> None:
        """Open the step of a gesture; the step of another gesture is committed first."""
        if not self.is_open(gesture):
            self.commit()
            step = replace(self._steps[self._now], label=label)
            self._open = OpenStep(step=step, gestures={gesture})
        if self._open is not None:
            self._open.finish = finish

    def hold(self, gesture: object, *others: object) -> bool:
        """Note that the hand holds the step of a gesture, which other gestures extend, too.

        Return False if another command has ended the gesture: it is void.
        """
        if gesture in self._ended:
            return False
        if not self.is_open(gesture):
            self.begin(gesture, self._present.label)
        if self._open is not None:
            self._open.is_held = True
            self._open.gestures.update(others)
        return True

    def preview(self, command: Command, gesture: object) -> None:
        """Run a command of a gesture of the hand, unless another command has ended the gesture.

        Without a gesture, it is an undo step at once.
        """
        if gesture in self._ended:
            return
        self.do(command, gesture=gesture)
        if self._open is not None and self.is_open(gesture):
            self._open.is_held = True

    def has_ended(self, gesture: object) -> bool:
        """Return whether another command has ended a gesture that was held."""
        return gesture in self._ended

    def release(self, gesture: object) -> None:
        """End the hold of a gesture; a step that changes nothing is dropped."""
        opened = self._open
        if opened is not None and self.is_open(gesture):
            self.revision += 1
            opened.is_held = False
            if opened.finish is None and is_same_step(opened.step, self._steps[self._now]):
                self._open = None

    def interrupt(self) -> None:
        """End the hold of the open step; later commands of the hand are void."""
        if self._open is not None and self._open.is_held:
            self.revision += 1
            self._ended, self._open.is_held = frozenset(self._open.gestures), False

    def settle(self) -> None:
        """Note that the displayed step is final."""
        if self._open is not None:
            self.revision += 1
            self._open.is_held, self._open.finish = False, None

    @contextmanager
    def limited(self, seconds: float) -> Iterator[None]:
        """Let commands raise `UnfinishedStepError` if the open step is not final by then."""
        self.patience = seconds
        try:
            yield
        finally:
            self.patience = inf

    def commit(self) -> None:
        """Make the open step final, as an undo step."""
        opened = self._open
        if opened is None:
            return
        self.interrupt()
        if opened.finish is not None:
            opened.finish()
        # It may be cancelled if it has no final form.
        if self._open is opened:
            self._open = None
            if not is_same_step(opened.step, self._steps[self._now]):
                self._append(opened.step)

    def cancel(self) -> None:
        """Drop the open step; redo is possible as before."""
        if self._open is not None:
            self.interrupt()
            self.revision += 1
            self._open = None

    def revert(self, gesture: object) -> None:
        """Drop the open step if it is the step of a gesture."""
        if self.is_open(gesture):
            self.cancel()

    def undo(self) -> None:
        """Go back one step, to the same document object, if possible."""
        self.commit()
        if self._now:
            self.revision += 1
            self._now -= 1

    def redo(self) -> None:
        """Go forward one step, if possible."""
        if self.redo_label is not None:
            self.revision += 1
            self._now += 1

    def _put(self, index: int, step: UndoStep) -> None:
        self.revision += 1
        self._steps[index] = step
        for around in range(max(index - 1, 0), min(index + 1, len(self._steps) - 1)):
            self._bytes[around] = bytes_only_in(self._steps[around], self._steps[around + 1])

    def _go_on(self, step: UndoStep, gesture: object) -> None:
        """Make a step the present one; that of a gesture stays open."""
        if is_same_step(step, self._present):
            return
        self.revision += 1
        if gesture is None:
            self._append(step)
        elif self._open is None:
            self._open = OpenStep(step=step, gestures={gesture})
        elif is_same_step(step, self._steps[self._now]) and not self.is_unfinished:
            self._open = None
        else:
            self._open.step = step

    def _append(self, step: UndoStep) -> None:
        """Append a step in place of those that redo would repeat."""
        self.revision += 1
        del self._steps[self._now + 1 :], self._bytes[self._now + 1 :]
        self._bytes[-1] = bytes_only_in(self._steps[-1], step)
        self._steps.append(step)
        self._bytes.append(0)
        self._now += 1
        self._forget()

    def _forget(self) -> None:
        excess = sum(self._bytes) - self._memory
        count = 0
        while excess > 0 and count < self._now - 1:
            excess -= self._bytes[count]
            count += 1
        del self._steps[:count], self._bytes[:count]
        self._now -= count
        self._forgotten += count

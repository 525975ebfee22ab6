"""Undo and redo of everything, as frozen snapshots that share what they have in common."""

from dataclasses import dataclass

from app.document.commands import Command
from app.document.figure import Figure
from app.document.model import Document

MEMORY = 512 * 1024 * 1024
# Tuples, names and numbers of a snapshot, roughly, and those of each pose.
SNAPSHOT_BYTES = 2_000
POSE_BYTES = 1_000


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """What one action led to."""

    document: Document
    label: str


class History:
    """The documents of a session, one for each step.

    Parameters
    ----------
    document : Document
        As opened or made.
    saved : bool
        Whether it is what a file holds.
    memory : int
        Bytes that undoing may keep; beyond them the oldest steps are forgotten.
    """

    def __init__(self, document: Document, *, saved: bool, memory: int = MEMORY) -> None:
        self._steps = [Step(document, "")]
        # _held[i]: bytes that only steps up to i keep alive, freed by forgetting step i.
        self._held = [0]
        self._now = 0
        self._gesture: object = None
        self._saved = document if saved else None
        self._memory = memory

    @property
    def document(self) -> Document:
        """The document as it is now."""
        return self._steps[self._now].document

    @property
    def undo_label(self) -> str | None:
        """What undo would take back; None where there is nothing."""
        return self._steps[self._now].label if self._now else None

    @property
    def redo_label(self) -> str | None:
        """What redo would do again; None where there is nothing."""
        return self._steps[self._now + 1].label if self._now + 1 < len(self._steps) else None

    @property
    def is_saved(self) -> bool:
        """Whether the document is the one that was saved last."""
        return self.document is self._saved

    def mark_saved(self, document: Document) -> None:
        """Note that a file holds this document, which may no longer be the present one."""
        self._saved = document

    def do(self, command: Command, *, gesture: object = None) -> None:
        """Run a command on the document.

        Parameters
        ----------
        command : Command
        gesture : object, optional
            Commands of one gesture, that is with one and the same object here and nothing in
            between, make up one step together; none if they end with the document before it.

        Raises
        ------
        LissomError
            If the command is not possible; then nothing has changed.
        """
        document = command(self.document)
        if document is self.document:
            return
        del self._steps[self._now + 1 :], self._held[self._now + 1 :]
        if gesture is not None and gesture is self._gesture:
            del self._steps[-1], self._held[-1]
            if document is self._steps[-1].document:
                self._now -= 1
                self._held[-1] = 0
                self._gesture = None
                return
        else:
            self._now += 1
            self._gesture = gesture
        self._held[-1] = _held_only_by(self._steps[-1].document, document)
        self._steps.append(Step(document, command.label))
        self._held.append(0)
        self._forget()

    def undo(self) -> None:
        """Go back by one step, to the very document that was; without one, stay."""
        if self._now:
            self._now -= 1
            self._gesture = None

    def redo(self) -> None:
        """Go forward again by one step; without one, stay."""
        if self._now + 1 < len(self._steps):
            self._now += 1

    def _forget(self) -> None:
        excess = sum(self._held) - self._memory
        count = 0
        while excess > 0 and count < self._now - 1:
            excess -= self._held[count]
            count += 1
        del self._steps[:count], self._held[:count]
        self._now -= count


def _held_only_by(old: Document, new: Document) -> int:
    """Return the bytes of `old` that `new` does not share."""
    figures = {figure.id: figure for figure in new.figures}
    return SNAPSHOT_BYTES + sum(
        _figure_held_only_by(figure, figures.get(figure.id)) for figure in old.figures
    )


def _figure_held_only_by(old: Figure, new: Figure | None) -> int:
    held = 0
    if new is None or old.picture is not new.picture:
        held += len(old.picture.data)
    if new is None or old.domain is not new.domain:
        mesh = old.domain.mesh
        arrays = (old.domain.outline, old.domain.cage, mesh.vertices, mesh.triangles)
        held += sum(array.nbytes for array in arrays)
    kept = [] if new is None else [key.pose for key in new.keys]
    poses, maps = {id(pose) for pose in kept}, {id(pose.phi) for pose in kept}
    for key in old.keys:
        if id(key.pose) not in poses:
            held += POSE_BYTES
        if id(key.pose.phi) not in maps:
            held += key.pose.phi.nbytes + key.pose.psi.nbytes
    return held

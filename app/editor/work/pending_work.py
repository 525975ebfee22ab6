"""What a project waits for: pending changes, deferred actions, and the end of a drag."""

from collections.abc import Container
from dataclasses import dataclass, field

from app.editor.work.drag_session import StoppedDrag
from app.editor.work.pending_change import DeferredAction, PendingChange
from app.editor.work.revised import Revised


@dataclass(slots=True, kw_only=True, eq=False)
class PendingWork(Revised):
    """Pending changes of the document, and the inputs of the last update steps."""

    changes: list[PendingChange] = field(default_factory=list)
    deferred: list[DeferredAction] = field(default_factory=list)  # in the order of the requests
    stopped_drag: StoppedDrag | None = None  # to be shown in a notice
    polled: tuple[object, ...] = ()  # the inputs of the last poll for due jobs
    settled: tuple[object, ...] = ()  # the inputs of the shown frame at its last update

    def add(self, change: PendingChange) -> None:
        self.changes.append(change)

    def remove(self, change: PendingChange) -> None:
        self.changes.remove(change)

    def drop(self, label: str) -> None:
        """Drop the changes with a label: their results are not taken."""
        self.changes = [change for change in self.changes if change.label != label]

    def defer(self, action: DeferredAction) -> None:
        self.deferred.append(action)

    def drop_deferred(self, dropped: Container[DeferredAction]) -> None:
        """Run or cancel deferred actions: they wait no more."""
        self.deferred = [each for each in self.deferred if each not in dropped]

    def stop_drag(self, stopped: StoppedDrag) -> None:
        """Note a drag whose targets are out of reach."""
        self.stopped_drag = stopped

    def take_stopped_drag(self) -> StoppedDrag | None:
        """Return the drag that a notice has to show, once."""
        stopped, self.stopped_drag = self.stopped_drag, None
        return stopped

    def note_poll(self, inputs: tuple[object, ...]) -> None:
        """Note that all due jobs of these inputs are queued."""
        self.polled = inputs

    def note_shown(self, inputs: tuple[object, ...]) -> None:
        """Note that the shown frame is that of these inputs."""
        self.settled = inputs

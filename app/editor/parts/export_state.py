"""The running export, and the destinations of exports."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.document import Document
from app.editor.work.revised import Revised
from app.export import ExportPlan
from app.motion import BoundingBox, Evaluator
from app.storage import Cancellation
from engine.arrays import Bytes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ExportRun:
    """A running export: its plan, its settings, and the number of drawn frames.

    The file of an export to the clipboard is deleted afterwards.
    """

    document: Document
    pictures: Mapping[int, Bytes]
    evaluator: Evaluator
    plan: ExportPlan
    for_clipboard: bool = False
    done: int = 0


@dataclass(slots=True, kw_only=True, eq=False)
class ExportState(Revised):
    """The export of a session; there is at most one at a time."""

    run: ExportRun | None = None  # the running export
    completed: ExportPlan | None = None  # the last complete export
    cancellation: Cancellation = field(default_factory=Cancellation)  # of the export under way
    is_aspect_locked: bool = True  # of width and height
    frame_box: BoundingBox | None = None  # shown while export settings are shown

    def begin(self) -> None:
        """Begin an export, which is prepared first."""
        self.cancellation = Cancellation()

    def start(self, run: ExportRun) -> None:
        """Start to draw a prepared export."""
        self.run = run

    def note_progress(self, run: ExportRun, done: int) -> None:
        """Note the number of drawn frames of an export, unless it has ended."""
        if self.run is run:
            self.run = replace(run, done=done)

    def end(self) -> None:
        self.run = None

    def complete(self, plan: ExportPlan) -> None:
        """Note that an export is complete."""
        self.completed = plan

    def lock_aspect(self, *, locked: bool) -> None:
        """Link or unlink width and height of an export."""
        self.is_aspect_locked = locked

    def show_frame_box(self, box: BoundingBox | None) -> None:
        """Show the export's frame in the viewport, or hide it."""
        self.frame_box = box


@dataclass(slots=True, kw_only=True, eq=False)
class ExportDestinations(Revised):
    """Where exports of a project go."""

    # Destination of the next export by format, the newest last.
    by_format: dict[str, Path] = field(default_factory=dict)
    # Format and destination of an export that may replace files: the person agreed, or the files
    # are of an export.
    replaceable: tuple[str, Path] | None = None

    def choose(self, name: str, out: Path) -> None:
        """Set the destination of the next export of a format."""
        self.by_format.pop(name, None)
        self.by_format[name] = out

    def allow_replacing(self, name: str, out: Path) -> None:
        """Let the next export of a format replace the files of a destination."""
        self.replaceable = name, out

    def forbid_replacing(self) -> None:
        self.replaceable = None

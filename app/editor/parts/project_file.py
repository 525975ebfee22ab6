"""The file of a project: its path, lock and autosave."""

from dataclasses import dataclass, field
from pathlib import Path

from app.document import Document, PreviewPose
from app.editor.work.revised import Revised
from app.errors import display_name
from app.storage import FileLock, SourceInfo, file_time

Kept = tuple[Document, PreviewPose | None]  # the document and the unkeyed pose


@dataclass(slots=True, kw_only=True, eq=False)
class ProjectFile(Revised):
    """Where a project is saved, and how much of it is in the autosave."""

    name: str  # file name of the picture or the project, without suffix
    path: Path | None = None  # the project file; None for a new project
    # Source files of the pictures; they are never overwritten.
    drawings: set[Path] = field(default_factory=set)
    times: dict[Path, int] = field(default_factory=dict)  # when they were changed, as last seen
    lock: FileLock | None = None  # lock against other windows
    # Digest of the file when it was last opened or saved here; None for a new project.
    digest: str | None = None
    # Whether it is recovered work, whose first save asks for the file.
    is_recovered: bool = False
    # What is in the autosave, the seconds of the clock then, and the seconds when a later change
    # was first seen.
    autosaved: Kept | None = None
    autosaved_at: float = 0.0
    changed_at: float | None = None

    @property
    def origin(self) -> SourceInfo:
        """Origin of autosaved changes, by which recovery finds them."""
        return SourceInfo(self.name, self.path)

    @property
    def sources(self) -> tuple[Path, ...]:
        """Files that no export may overwrite."""
        return (*self.drawings, *([] if self.path is None else [self.path]))

    def __post_init__(self) -> None:
        self.add_drawings(*self.drawings)

    def add_drawings(self, *paths: Path) -> None:
        """Note source files of pictures that were read."""
        self.drawings = {*self.drawings, *paths}
        self.times = {**self.times, **{path: file_time(path) for path in paths}}

    def note_time(self, path: Path, time: int) -> None:
        """Note when a source file was changed, in nanoseconds."""
        self.times = {**self.times, path: time}

    def is_locked_for(self, path: Path) -> bool:
        """Return whether this project locks a file."""
        return self.lock is not None and self.lock.path == path

    def replace_lock(self, lock: FileLock | None) -> None:
        """Take another lock, or none, and release the present one."""
        before, self.lock = self.lock, lock
        if before is not None:
            before.release()

    def note_saved(self, path: Path, digest: str) -> None:
        """Note that the project was saved to a file."""
        self.name, self.path, self.is_recovered = display_name(path.stem), path, False
        self.digest = digest

    def forget_digest(self) -> None:
        """Let the next save overwrite the file, even if another program has changed it."""
        self.digest = None

    def note_autosave(self, kept: Kept, now: float) -> None:
        """Note that unsaved work is in the autosave."""
        self.autosaved, self.autosaved_at = kept, now

    def revert_autosave(self, earlier: Kept | None) -> None:
        """Note that the last autosave failed, and an earlier one is left."""
        self.autosaved = earlier

    def note_change(self, now: float) -> float:
        """Note a change, and return when the first change since the autosave was."""
        if self.changed_at is None:
            self.changed_at = now
        return self.changed_at

    def note_unchanged(self) -> None:
        self.changed_at = None

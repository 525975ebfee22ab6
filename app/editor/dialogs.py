"""What the person is asked before anything is done."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from app.editor.action import Action
from app.storage import SourceInfo


def _no_file(_: str) -> bool:
    return False


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FileDialog:
    """A question for a file: the system's own dialog, or our file browser where it has none."""

    title: str
    folder: Path  # where it begins; in our browser, whose contents it lists
    name: str = ""  # of the file to write, or what was typed
    # Of the files that it lists, such as ".png"; none where a folder is to be written.
    suffixes: tuple[str, ...]
    writes: bool  # whether it asks for a file to write, and not for one to read
    verb: str = "Save"  # on the button of one that writes
    chosen: Callable[[Path], Action]  # returns the action for a path
    marked: str = ""  # the entry of our browser's list that is marked
    # Tells by its name whether a file that is there may lie in the folder to write to.
    is_frame: Callable[[str], bool] = _no_file

    @property
    def wants_folder(self) -> bool:
        """Whether it asks for a folder to write to."""
        return self.writes and not self.suffixes

    def path_of(self, name: str) -> Path:
        """Return the path that a name stands for; one to write gets its suffix if it has none."""
        path = self.folder / name
        if self.writes and self.suffixes and path.suffix.lower() not in self.suffixes:
            return path.with_name(path.name + self.suffixes[0])
        return path


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Question:
    """A question with some answers; another one that is always there is to do nothing."""

    title: str
    text: str
    answers: tuple[tuple[str, Action], ...]


@dataclass(frozen=True, slots=True)
class ShortcutSheet:
    """The list of all keys."""


class RecoverableFile(NamedTuple):
    """Unsaved work of an earlier time: its file, its origin, when it was kept, and its bytes."""

    path: Path
    origin: SourceInfo
    kept: float
    size: int


@dataclass(frozen=True, slots=True)
class RecoveryDialog:
    """A choice among all unsaved work of earlier times; what is not chosen stays."""

    candidates: tuple[RecoverableFile, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ProblemReport:
    """A text about a problem, to be looked through and saved; nothing sends it."""

    text: str
    is_kept: bool  # whether it is of an earlier time, and stays until it is saved or discarded
    behind: RecoveryDialog | None = None  # what is asked next: one question at a time


Dialog = FileDialog | Question | ShortcutSheet | RecoveryDialog | ProblemReport

"""Dialogs: questions to the person before an action."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from app.document import Document
from app.editor.action import Action
from app.editor.work.revised import Revised
from app.solving import ReloadPlan
from app.storage import SourceInfo
from app.texts import _


def _no_file(_: str) -> bool:
    return False


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FileDialog:
    """A request for a file: the system's dialog, or Lissom's file browser if there is none."""

    title: str
    folder: Path  # initial folder; in Lissom's browser, the listed folder
    name: str = ""  # name of the file to write, or the typed name
    # Suffixes of the listed files, such as ".png"; none if it asks for a folder to write to.
    suffixes: tuple[str, ...]
    writes: bool  # whether the file is written; otherwise it is read
    verb: str = _("Save")  # label of the button if it writes
    chosen: Callable[[Path], Action]  # returns the action for a path
    marked: str = ""  # the marked entry in Lissom's browser
    # Returns whether an existing file of this name may be in the folder to write to.
    is_frame: Callable[[str], bool] = _no_file

    @property
    def wants_folder(self) -> bool:
        return self.writes and not self.suffixes

    def path_of(self, name: str) -> Path:
        """Return the path for a name; a missing suffix is added to a file to write."""
        path = self.folder / name
        if self.writes and self.suffixes and path.suffix.lower() not in self.suffixes:
            return path.with_name(path.name + self.suffixes[0])
        return path


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Question:
    """A question with its answers; the answer "do nothing" is always there."""

    title: str
    text: str
    answers: tuple[tuple[str, Action], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ShortcutSheet:
    """The list of all shortcuts, in which they are changed.

    Attributes
    ----------
    search : str
        Part of the listed actions' labels or keys.
    changed : str
        Label of the action whose keys are asked for; "" for none.
    taken : int
        Key chord that was pressed for it and belongs to another action; 0 for none.
    """

    search: str = ""
    changed: str = ""
    taken: int = 0


class RecoverableFile(NamedTuple):
    """Unsaved work of an earlier session: file, origin, time and size in bytes."""

    path: Path
    origin: SourceInfo
    kept: float
    size: int


@dataclass(frozen=True, slots=True)
class RecoveryDialog:
    """A choice among unsaved work of earlier sessions; work that is not chosen stays."""

    candidates: tuple[RecoverableFile, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ProblemReport:
    """A text about a problem that the person can read and save; it is never sent."""

    text: str
    is_kept: bool  # whether it is of an earlier session; it stays until saved or discarded
    behind: RecoveryDialog | None = None  # the dialog that is shown next


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ReloadDialog:
    """The changes of a drawing's file, to be reloaded or not."""

    path: Path
    plan: ReloadPlan
    document: Document  # that was compared with the file


Dialog = FileDialog | ReloadDialog | Question | ShortcutSheet | RecoveryDialog | ProblemReport


@dataclass(slots=True, kw_only=True, eq=False)
class DialogState(Revised):
    """The open dialog; there is at most one."""

    current: Dialog | None = None
    uses_system: bool = False  # whether the system's own file dialogs are used
    empty_answers: int = 0  # of the system's dialogs, in a row

    def show(self, dialog: Dialog | None) -> None:
        """Open a dialog in place of the open one."""
        self.current = dialog

    def ask(self, *, title: str, text: str, answers: tuple[tuple[str, Action], ...]) -> None:
        """Ask a question in place of the open dialog."""
        self.show(Question(title=title, text=text, answers=answers))

    def close(self) -> None:
        """Close the dialog without an action; the dialog below a report returns."""
        self.current = self.current.behind if isinstance(self.current, ProblemReport) else None

    def note_empty_answer(self) -> int:
        """Count an answer without a file, and return how many came in a row."""
        self.empty_answers += 1
        return self.empty_answers

    def note_answer(self) -> None:
        self.empty_answers = 0

    def use_own_file_browser(self) -> None:
        """From now on, use Lissom's file browser instead of the system's dialogs."""
        self.uses_system = False

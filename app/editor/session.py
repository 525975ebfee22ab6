"""The state of one window: all values that may change, without drawing."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import wraps
from pathlib import Path
from typing import Concatenate, Literal, ParamSpec

from app.editor.action import Action
from app.editor.parts.clipboard import Clipboard
from app.editor.parts.diagnostics import Diagnostics
from app.editor.parts.dialogs import DialogState, FileDialog
from app.editor.parts.export_state import ExportState
from app.editor.parts.notices import Notices
from app.editor.parts.settings import SessionSettings
from app.editor.parts.tools import ToolState
from app.editor.parts.viewport_state import DisplayState
from app.editor.project import Project
from app.editor.work.jobs import Jobs
from app.editor.work.revised import Revised
from app.export import ExportPlan
from app.sound import SoundPlayer

TutorialStage = Literal["handle", "time", "pose", "play", "export", "done"]
P = ParamSpec("P")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TutorialState:
    """Progress of the tutorial.

    In the sample, the person puts a handle at `aim` and drags it to `goal`.
    """

    project: Project | None = None  # None until the drawing is opened
    handles: frozenset[tuple[int, int]] = frozenset()  # earlier handles, by layer and id
    handle_place: complex | None = None
    target_place: complex | None = None
    stage: TutorialStage = "handle"
    has_played: bool = False  # since the drawing moves
    exported: ExportPlan | None = None  # the last export before the awaited one


@dataclass(slots=True, kw_only=True, eq=False)
class Tutorial(Revised):
    """The tutorial of a session."""

    state: TutorialState | None = None  # None without a tutorial

    def show(self, state: TutorialState) -> None:
        """Begin the tutorial, or go on with it."""
        self.state = state

    def end(self) -> None:
        self.state = None


@dataclass(slots=True, kw_only=True, eq=False)
class Session(Revised):
    """All values that one window changes while it runs."""

    clock: Callable[[], float]
    jobs: Jobs
    settings: SessionSettings
    project: Project | None = None
    notices: Notices = field(init=False)
    player: SoundPlayer = field(init=False)
    dialogs: DialogState = field(default_factory=DialogState)
    clipboard: Clipboard = field(default_factory=Clipboard)
    diagnostics: Diagnostics = field(default_factory=Diagnostics)
    export: ExportState = field(default_factory=ExportState)
    tutorial: Tutorial = field(default_factory=Tutorial)
    display: DisplayState = field(default_factory=DisplayState)
    tools: ToolState = field(default_factory=ToolState)
    is_quitting: bool = False

    def __post_init__(self) -> None:
        self.notices = Notices(now=self.clock)
        self.player = SoundPlayer(self.clock)

    def put_project(self, project: Project | None) -> None:
        """Show a project, with the tool that poses; None shows the welcome view."""
        self.project = project
        self.tools.reset()

    def quit(self) -> None:
        """Let the window close after this frame."""
        self.is_quitting = True

    def ask_file(
        self,
        title: str,
        suffixes: tuple[str, ...],
        chosen: Callable[[Path], Action],
        *,
        name: str = "",
    ) -> None:
        """Ask for a file to read, or for a file to write if there is a suggested `name`."""
        self.dialogs.show(
            FileDialog(
                title=title,
                folder=self.settings.usual_folder,
                name=name,
                suffixes=suffixes,
                writes=bool(name),
                chosen=chosen,
            )
        )


def with_project(
    verb: Callable[Concatenate[Session, Project, P], None],
) -> Callable[Concatenate[Session, P], None]:
    """Pass the open project to a verb; without a project the verb does nothing."""

    @wraps(verb)
    def given(session: Session, /, *args: P.args, **kwargs: P.kwargs) -> None:
        if session.project is not None:
            verb(session, session.project, *args, **kwargs)

    return given

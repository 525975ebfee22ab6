"""The state of one window: all values that may change, without drawing."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import wraps
from pathlib import Path
from typing import Concatenate, Literal, ParamSpec, Protocol

from app.document import Baseline, Variant
from app.editor.action import Action
from app.editor.overlay_shapes import Cursor, OverlayShape
from app.editor.parts.clipboard import Clipboard
from app.editor.parts.diagnostics import Diagnostics
from app.editor.parts.dialogs import DialogState, FileDialog
from app.editor.parts.export_state import ExportState
from app.editor.parts.notices import Notices
from app.editor.parts.settings import SessionSettings
from app.editor.project import Project
from app.editor.work.jobs import Jobs
from app.editor.work.revised import Revised
from app.export import ExportPlan

HeatMap = Literal["none", "k", "sigma_a", "sigma_b"]
CurveKind = Literal["relative", "absolute"]
CutTool = Literal["keep", "remove", "knife", "pick", "holes"]
Tint = Literal["depth", "stiffness"]
MaterialTool = Literal["stiff", "soft", "normal", "bone"]
TutorialStage = Literal["handle", "time", "pose", "play", "export", "done"]
CLICK = 3.0  # screen pixels that the pointer may move during a click
P = ParamSpec("P")


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlays:
    """Overlays of the viewport."""

    handles: bool = True
    wireframe: bool = False
    outline: bool = False
    cage: bool = False
    onion: bool = False
    mirror: bool = False  # the mirror axis of poses
    paths: bool = False  # of the selected handles
    heat_map: HeatMap = "none"


@dataclass(frozen=True, slots=True, kw_only=True)
class CompareView:
    """The compared method, and the division of the viewport."""

    method: Variant | Baseline  # method of all layers in the right part
    divider: float = 0.5  # place of the divider, as a share of the viewport's width
    # Whether both methods are shown whole, side by side, instead of under a divider.
    is_side_by_side: bool = False


@dataclass(frozen=True, slots=True)
class Hint:
    """A hint about the pointer: gesture and effect as one text, and the key to hold."""

    text: str
    key: Literal["", "ctrl", "shift", "alt", "ctrl+shift"] = ""


class ActiveTool(Protocol):
    """A tool that has the pointer in the viewport; places are in the scene."""

    def move(self, session: "Session", place: complex) -> None:
        """Follow the pointer to another place."""

    def type(self, session: "Session", characters: str) -> None:
        """Take characters that are typed during the drag."""

    def end(self, session: "Session", place: complex) -> None:
        """End at the pointer's place."""

    def cancel(self, session: "Session") -> None:
        """End, and undo all edits."""

    @property
    def cursor(self) -> Cursor:
        """The cursor until the release."""

    @property
    def snaps(self) -> bool:
        """Whether it moves in steps while Ctrl is held."""

    def shapes(self, place: complex, em: float) -> Iterable[OverlayShape]:
        """Return what the tool draws over the drawing, with the pointer at a place."""

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        """The hints until the release."""


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
class Session(Revised):
    """All values that one window changes while it runs."""

    clock: Callable[[], float]
    jobs: Jobs
    settings: SessionSettings
    project: Project | None = None
    notices: Notices = field(init=False)
    dialogs: DialogState = field(default_factory=DialogState)
    clipboard: Clipboard = field(default_factory=Clipboard)
    diagnostics: Diagnostics = field(default_factory=Diagnostics)
    overlays: Overlays = field(default_factory=Overlays)
    screen: tuple[int, int] = (640, 480)  # pixels of the viewport
    full_detail: bool = True  # whether the full mesh is drawn fast enough in motion
    export: ExportState = field(default_factory=ExportState)
    tutorial: TutorialState | None = None  # None without a tutorial
    named_layer: int | None = None  # layer whose name is edited
    pointed_layer: int | None = None  # layer whose list row is under the pointer
    panel_to_focus: str = ""  # to be brought to the front in the next frame
    curves: CurveKind = "relative"
    compare_view: CompareView | None = None  # None shows the drawing alone
    last_compare_view: CompareView = CompareView(method=Variant.LINEAR)  # before it was closed
    active_tool: ActiveTool | None = None
    cutting: CutTool | None = None  # the selected cut-out tool; None poses
    material: MaterialTool | None = None  # the selected stiffness tool
    strength: float = 10.0  # factor of the stiffness brush
    softness: float = 0.5  # part of the brush's radius over which it fades
    moves: bool = False  # whether drags and arrow keys move the whole layer
    records: bool = False  # whether the next drag of a handle is recorded
    recording_speed: float = 1.0  # of the animation's speed
    is_snapping: bool = False  # whether pointer moves snap to steps
    is_forcing_targets: bool = False  # whether released targets beyond reach stay
    # Whether actions on the selection mean the timeline: it has the pointer, or else the focus.
    is_timeline_focused: bool = False
    is_space_used: bool = False  # whether Space was held to pan the view
    hovered: int | None = None  # the handle under the pointer
    hint: str = ""  # about the item under the pointer
    tint: Tint | None = None  # quantity that colours the drawing
    is_quitting: bool = False

    def __post_init__(self) -> None:
        self.notices = Notices(clock=self.clock)

    @property
    def is_posing(self) -> bool:
        """Whether drags pose, and no other tool is selected."""
        drafts = self.project is not None and self.project.motion_setup is not None
        return not (drafts or self.moves) and self.cutting is None and self.material is None

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

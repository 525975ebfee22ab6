"""The state of one window: everything that may change, and nothing that is drawn."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import wraps
from itertools import count
from pathlib import Path
from typing import Concatenate, Literal, ParamSpec, Protocol

from app.document import Baseline, Document, Keyframe, Layer, Meshing, Track, TrackKey, Variant
from app.editor.action import Action
from app.editor.dialogs import Dialog, FileDialog
from app.editor.project import Project
from app.editor.work import Jobs
from app.errors import display_message, printable
from app.export import CachedVertices, ExportPlan
from app.motion import BoundingBox
from app.storage import Autosave, Cancellation, Preferences, home_folder
from engine.arrays import Bytes

HeatMap = Literal["none", "k", "sigma_a", "sigma_b"]
CurveKind = Literal["relative", "absolute"]
CutTool = Literal["keep", "remove", "knife", "pick", "holes"]
Tint = Literal["depth", "stiffness"]
MaterialTool = Literal["stiff", "soft", "normal", "bone"]
Tone = Literal["info", "good", "error"]
TutorialStage = Literal["handle", "time", "pose", "play", "export", "done"]
CLICK = 3.0  # pixels of the screen that a click may wander
P = ParamSpec("P")


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlays:
    """What the viewport shows besides the drawing."""

    handles: bool = True
    wireframe: bool = False
    outline: bool = False
    cage: bool = False
    onion: bool = False
    mirror: bool = False  # the axis at which poses are flipped
    paths: bool = False  # of the selected handles
    heat_map: HeatMap = "none"


@dataclass(frozen=True, slots=True, kw_only=True)
class CompareView:
    """Another method beside the drawing's own: how the viewport is divided."""

    method: Variant | Baseline  # by which all layers are shown in the right part
    divider: float = 0.5  # of the divider, as a share of the viewport's width
    # Whether the two are side by side, each whole, and not under a divider over one place.
    is_side_by_side: bool = False


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Toast:
    """A message that shows for a while."""

    text: str
    tone: Tone
    born: float  # the clock's seconds
    place: int  # the first that no other one has: ImGui keeps a window for each for ever
    topic: str = ""  # a later message about the same takes its place
    details: str = ""  # what the person may copy, where there is anything to add
    label: str = ""  # of a button that does the action, such as "Open folder"
    action: Action | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class BoxOverlay:
    """A box that the pointer spans in the plane, from corner to corner."""

    corner: complex
    opposite: complex


@dataclass(frozen=True, slots=True, kw_only=True)
class RotationOverlay:
    """By how many radians the shape is turned around a handle, and how many the pointer swept."""

    handle: int
    angle: float
    swept_angle: float


@dataclass(frozen=True, slots=True, kw_only=True)
class NumericEntryOverlay:
    """What was typed during a drag, and the axis through a place that it keeps to, if any."""

    place: complex
    direction: complex | None
    text: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StrokeOverlay:
    """A stroke of the brush, in the plane, that is not done yet."""

    points: tuple[complex, ...]
    radius: float
    keeps: bool | None  # None of one that neither keeps nor removes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KnifeOverlay:
    """A line of the knife, in the plane, that is not done yet."""

    points: tuple[complex, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class AttachOverlay:
    """The way from an anchor to the pointer, and the layer there, which may be refused."""

    start: complex
    end: complex
    parent: int | None
    is_refused: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class BoneOverlay:
    """The way from a handle to the pointer, or to another handle, between which there may be none.

    Ends are in the plane.
    """

    start: complex
    end: complex
    is_refused: bool


Mark = (
    BoxOverlay
    | RotationOverlay
    | NumericEntryOverlay
    | StrokeOverlay
    | KnifeOverlay
    | AttachOverlay
    | BoneOverlay
)


@dataclass(frozen=True, slots=True, eq=False)
class CopiedKeys:
    """Keys of a layer to be pasted, or a pose as the only one, and the layer as it was then."""

    layer: Layer
    keys: tuple[Keyframe, ...]
    is_pose: bool = False  # whether it is a pose, and no way to the next key comes with it


@dataclass(frozen=True, slots=True, eq=False)
class CopiedTrack:
    """Keys of a track to be pasted, and the track and its layer as they were then."""

    layer: Layer
    track: Track
    keys: tuple[TrackKey, ...]


@dataclass(frozen=True, slots=True)
class Hint:
    """What can be done with the pointer: how, which key is held for it, and to what end."""

    how: str
    what: str
    key: Literal["", "ctrl", "shift", "alt", "ctrl+shift"] = ""


class ActiveTool(Protocol):
    """A tool that has the pointer in the viewport; places are of the plane."""

    def move(self, session: "Session", place: complex) -> None:
        """Follow the pointer to another place."""

    def type(self, session: "Session", characters: str) -> None:
        """Take what is typed meanwhile."""

    def end(self, session: "Session", place: complex) -> None:
        """End where the pointer is."""

    def cancel(self, session: "Session") -> None:
        """End, and take back all that was done."""

    @property
    def tool_overlays(self) -> tuple[Mark, ...]:
        """What is drawn of it over the picture."""

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        """What can be done meanwhile."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ExportRun:
    """An export that is under way: what it draws, how, and how many frames are drawn.

    Where it is for the clipboard, its file goes there and does not stay.
    """

    document: Document
    pictures: Mapping[int, Bytes]
    poses: Mapping[int, CachedVertices]
    plan: ExportPlan
    for_clipboard: bool = False
    done: int = 0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TutorialState:
    """How far somebody has come who is led through a first animation.

    Where the drawing is a sample, a handle is to be put at its `aim` and dragged to its `goal`.
    """

    project: Project | None = None  # None while the drawing is chosen and opened
    handles: frozenset[tuple[int, int]] = frozenset()  # those that were there, by layer and id
    handle_place: complex | None = None
    target_place: complex | None = None
    stage: TutorialStage = "handle"
    has_played: bool = False  # since it moves
    exported: ExportPlan | None = None  # the last export before the one that is awaited


@dataclass(slots=True, kw_only=True, eq=False)
class Session:
    """Everything that one window changes while it runs."""

    clock: Callable[[], float]
    jobs: Jobs
    folder: Path  # for settings and unsaved work
    preferences: Preferences = field(default_factory=Preferences)
    saved_preferences: Preferences = field(init=False)  # as they are on the disk
    autosave: Autosave = field(init=False)
    project: Project | None = None
    overlays: Overlays = field(default_factory=Overlays)
    screen: tuple[int, int] = (640, 480)  # pixels of the viewport
    full_detail: bool = True  # whether this machine draws the full mesh fast enough to move
    solver_seconds: float = 0.0
    # Whether what nobody looks at yet is prepared meanwhile: in-betweens, corrections, series for
    # smooth playback, measured distortion and the extent of the motion. Tests mostly go without.
    prepares_ahead: bool = True
    meshing: Meshing = field(default_factory=Meshing)  # of new pictures
    toasts: list[Toast] = field(default_factory=list)
    dialog: Dialog | None = None
    system_dialogs: bool = False  # whether the system's own file dialogs are used
    export: ExportRun | None = None
    exported: ExportPlan | None = None  # that was completed last
    cancellation: Cancellation = field(default_factory=Cancellation)  # of an export
    tutorial: TutorialState | None = None  # through a first animation
    named_layer: int | None = None  # for which a name is asked
    pointed_layer: int | None = None  # on whose row in the list the pointer is
    panel_to_focus: str = ""  # is brought to the front by the next frame of the window
    export_frame: BoundingBox | None = None  # shown in the viewport while the export's settings are
    is_aspect_locked: bool = True  # of an export whose size is entered
    curves: CurveKind = "relative"
    compare_view: CompareView | None = None  # None shows the drawing alone
    last_compare_view: CompareView = CompareView(
        method=Variant.LINEAR
    )  # as it was when it was put away
    active_tool: ActiveTool | None = None
    cutting: CutTool | None = None  # what is in hand that cuts out; None poses
    material: MaterialTool | None = None  # what is in hand that makes parts stiff or soft
    strength: float = 10.0  # how many times as stiff, or as soft, the brush makes what it covers
    softness: float = 0.5  # over which part of the brush's radius that becomes less
    moves: bool = False  # whether a drag, or an arrow, moves the whole layer
    records: bool = False  # whether the next drag of a handle is recorded while it plays
    recording_speed: float = 1.0  # times the animation's own
    is_snapping: bool = False  # whether what the pointer does goes in steps
    is_forcing_targets: bool = (
        False  # whether what it pulls beyond its reach is wanted there all the same
    )
    # Whether the timeline has the pointer, or else the focus: what is chosen there is meant.
    is_timeline_focused: bool = False
    copied: tuple[CopiedKeys, ...] = ()  # of each layer whose keys were copied together
    copied_tracks: tuple[CopiedTrack, ...] = ()  # of each track, likewise
    is_space_used: bool = False  # Space was held to move the view
    hovered: int | None = None  # the handle under the pointer
    hint: str = ""  # about what is under the pointer
    tint: Tint | None = None  # what the drawing shows by colours while that is set
    reported_failures: set[str] = field(default_factory=set)  # what cannot be kept, as was told
    graphics: str = ""  # what draws the window; empty before its first frame
    logged_actions: list[str] = field(default_factory=list)  # the names of the last actions
    last_error_trace: str = ""  # where the program itself failed last
    is_quitting: bool = False

    def __post_init__(self) -> None:
        """Take the preferences to be as they were read, and nothing to be kept yet."""
        self.saved_preferences = self.preferences
        self.autosave = Autosave(self.folder)

    @property
    def is_posing(self) -> bool:
        """Whether drags pose, and nothing else is in hand."""
        drafts = self.project is not None and self.project.motion_setup is not None
        return not (drafts or self.moves) and self.cutting is None and self.material is None

    @property
    def usual_folder(self) -> Path:
        """Where the person's files were last."""
        folder = self.preferences.folder
        return folder if folder is not None and folder.is_dir() else home_folder()

    def ask_file(
        self,
        title: str,
        suffixes: tuple[str, ...],
        chosen: Callable[[Path], Action],
        *,
        name: str = "",
    ) -> None:
        """Ask for a file to read, or for one to write if there is a `name` that it has at first."""
        self.dialog = FileDialog(
            title=title,
            folder=self.usual_folder,
            name=name,
            suffixes=suffixes,
            writes=bool(name),
            chosen=chosen,
        )

    def show_notice(
        self,
        text: str,
        *,
        tone: Tone = "info",
        topic: str = "",
        details: str = "",
        label: str = "",
        action: Action | None = None,
    ) -> None:
        """Show a message; one that shows already starts its time again."""
        text, details = display_message(text), printable(details, keeps_lines=True)
        self.toasts = [
            toast
            for toast in self.toasts
            if toast.text != text and not (topic == toast.topic != "")
        ]
        taken = {toast.place for toast in self.toasts}
        toast = Toast(
            text=text,
            tone=tone,
            born=self.clock(),
            place=next(place for place in count() if place not in taken),
            topic=topic,
            details=details,
            label=label,
            action=action,
        )
        self.toasts.append(toast)


def with_project(
    verb: Callable[Concatenate[Session, Project, P], None],
) -> Callable[Concatenate[Session, P], None]:
    """Hand a verb the project that is open; without one it does nothing."""

    @wraps(verb)
    def given(session: Session, /, *args: P.args, **kwargs: P.kwargs) -> None:
        if session.project is not None:
            verb(session, session.project, *args, **kwargs)

    return given

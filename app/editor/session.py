"""The state of one window: everything that may change, and nothing that is drawn."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path
from typing import Literal

from app.document import Clip, Document, Figure, History, Meshing, Playhead, Pose, Target, clip_of
from app.editor.action import Action
from app.editor.jobs import Jobs
from app.editor.timeline_view import Timing
from app.export import ExportPlan, Poses
from app.motion import Box, Build, Extent, Motion, Shown
from app.render import View, fit_view
from app.reports import Curves
from app.solving import Drag, Renewal, Rig
from app.storage import Autosave, Picture, Preferences
from engine.arrays import Bytes
from engine.maps import Bounds

HeatMap = Literal["none", "k", "sigma_a", "sigma_b"]
CurveKind = Literal["relative", "absolute"]
Tone = Literal["info", "good", "error"]
FIT_MARGIN = 0.08  # of the viewport, left free around a picture that is fitted into it


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlays:
    """What the viewport shows besides the drawing."""

    handles: bool = True
    wireframe: bool = False
    outline: bool = False
    cage: bool = False
    onion: bool = False
    heat_map: HeatMap = "none"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Toast:
    """A message that shows for a while.

    Parameters
    ----------
    text : str
    tone : str
    born : float
        The clock's seconds.
    details : str
        What the person may copy; empty where there is nothing to add.
    label, action
        A button, such as "Open folder".
    """

    text: str
    tone: Tone
    born: float
    details: str = ""
    label: str = ""
    action: Action | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FileDialog:
    """A question for a file: the system's own dialog, or our file browser where it has none.

    Parameters
    ----------
    title : str
    folder : Path
        Where it begins; in our browser, whose contents it lists.
    name : str
        Of the file to write, or what was typed.
    suffixes : tuple of str
        Which files it lists, such as ".png"; none where a folder is to be written.
    writes : bool
        Whether it asks for a file to write (else for one to read).
    chosen : callable
        Returns the action for the chosen path.
    marked : str
        The entry of our browser's list that is marked.
    """

    title: str
    folder: Path
    name: str = ""
    suffixes: tuple[str, ...]
    writes: bool
    chosen: Callable[[Path], Action]
    marked: str = ""

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
    """A question with up to three answers, the last of which is to do nothing."""

    title: str
    text: str
    answers: tuple[tuple[str, Action], ...]


@dataclass(frozen=True, slots=True)
class ShortcutSheet:
    """The list of all keys."""


Dialog = FileDialog | Question | ShortcutSheet


@dataclass(frozen=True, slots=True, kw_only=True)
class Pulling:
    """The pointer pulls handles; `places` are theirs at the start, by id, in the plane."""

    start: complex
    places: tuple[tuple[int, complex], ...] = ()
    moved: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Turning:
    """The pointer turns the shape around a handle, from an angle of `turn` radians on.

    A click, which turns nothing, may delete the handle.
    """

    identity: int
    centre: complex
    start: complex
    turn: float
    deletes: bool
    moved: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Boxing:
    """The pointer spans a box to select what is in it; `keeps` what is selected already."""

    start: complex
    keeps: bool


Gesture = Pulling | Turning | Boxing


@dataclass(slots=True, kw_only=True, eq=False)
class Grab:
    """Handles that are being pulled, and how far the solver has followed.

    Parameters
    ----------
    frame : int
        Where the pose belongs.
    targets : mapping
        What is wished now, for every handle.
    pose : Pose, optional
        Where it began; None where that is an in-between, which the worker has to find a map for.
    drag : Drag, optional
        None until the solver's first steps are done.
    anew : Drag, optional
        From the drawing at rest to the same wish, tried once the hand has let go of a shape that is
        held back: pulled through itself, it may be entangled.
    held : bool
        Whether the person still pulls.
    steps : int
        Newton steps since the wish changed last, or since `anew` began.
    """

    frame: int
    targets: Mapping[int, Target]
    pose: Pose | None
    drag: Drag | None = None
    anew: Drag | None = None
    held: bool = True
    steps: int = 0


@dataclass(slots=True, kw_only=True, eq=False)
class Puppet:
    """A figure as a window has it.

    Parameters
    ----------
    picture : Picture
        Decoded.
    is_opaque : bool
        Whether it has no transparency, so that its background was found by its colour.
    coarse, fine : Motion
        What can be shown of it, on a coarse mesh and on its own; `fine` may not be there yet.
    shown : Shown, optional
        None before the first frame of the window.
    rig : Rig, optional
        For the poses to come; None before the first of them.
    build : Build, optional
        The series that the worker makes when it has nothing else to do.
    unmovable : Clip, optional
        Its in-betweens failed; they are not tried again until it changes.
    """

    picture: Picture
    is_opaque: bool
    coarse: Motion
    fine: Motion | None = None
    shown: Shown | None = None
    rig: Rig | None = None
    build: Build | None = None
    unmovable: Clip | None = None


@dataclass(slots=True, kw_only=True, eq=False)
class Project:
    """The document that is open, and how the person looks at it.

    Parameters
    ----------
    name : str
        Of the picture or the project, without its suffix.
    path : Path, optional
        Of the project file; None for a new one.
    puppets : dict of int to Puppet
        One for each figure, by its id.
    active : int
        The id of the figure whose handles and keys are shown and changed.
    settling : Grab, optional
        Let go at a frame that the playhead has left since; the solver brings that pose to rest.
    unkeyed : Pose, optional
        Posed with auto-key off, held by no key.
    camera : View, optional
        None fits the picture into the viewport.
    unmeasurable : Clip, optional
        Likewise for its distortion.
    curves : Curves, optional
        Distortion over time, of the document that it names.
    meshing : Meshing, optional
        What the domain will be rebuilt with; None as long as that is what it has.
    drafted_bounds : Bounds, optional
        What the person drags them to.
    renewal : Renewal, optional
        Keys that are being solved again.
    export_to : Path, optional
        Where the next export goes: where the last one went, or was told to.
    replaceable : Path, optional
        Where exports may take the place of other files: the person agreed, or they are an export's.
    reach : Extent, optional
        Of the motion, as it was when the export's frame was looked at last.
    unreachable : tuple
        What of a document its reach could not be measured from.
    to_save : tuple, optional
        Where to save it, and what to do then, as soon as its pose has settled.
    moved_at : float
        The clock's seconds when the playhead was last seen to move.
    kept : Document, optional
        The one that the autosave holds, from the time `kept_at` on.
    gesture : object, optional
        Commands given while it lasts make one step of undo together.
    held : int
        The widget whose gesture that is.
    """

    name: str
    history: History
    path: Path | None
    puppets: dict[int, Puppet]
    active: int
    grab: Grab | None = None
    settling: Grab | None = None
    unmeasurable: Clip | None = None
    curves: Curves | None = None
    meshing: Meshing | None = None
    drafted_bounds: Bounds | None = None
    renewal: Renewal | None = None
    export_to: Path | None = None
    replaceable: Path | None = None
    reach: Extent | None = None
    unreachable: tuple[object, ...] = ()
    to_save: tuple[Path, Action | None] | None = None
    moved_at: float = -inf
    kept: Document | None = None
    kept_at: float = 0.0
    playhead: Playhead = field(default_factory=Playhead)
    timing: Timing = field(default_factory=Timing)
    selected: frozenset[int] = frozenset()  # ids of handles
    chosen: frozenset[int] = frozenset()  # frames of keys
    unkeyed: Pose | None = None
    camera: View | None = None
    gesture: object | None = None
    held: int = 0

    @property
    def document(self) -> Document:
        """The document as it is now."""
        return self.history.document

    @property
    def figure(self) -> Figure:
        """The figure that is posed, as it is now."""
        return self.document.figure(self.active)

    @property
    def clip(self) -> Clip:
        """The figure that is posed, in the time of its scene."""
        return clip_of(self.document, self.active)

    @property
    def puppet(self) -> Puppet:
        """The figure that is posed, as the window has it."""
        return self.puppets[self.active]

    @property
    def is_posing(self) -> bool:
        """Whether a pose is on its way, be it the one that is shown or not."""
        return self.grab is not None or self.settling is not None

    def view(self, screen: tuple[int, int]) -> View:
        """Return what the viewport shows on a screen of this size in pixels."""
        if self.camera is not None:
            return replace(self.camera, size=screen)
        margin = FIT_MARGIN * min(screen)
        return fit_view(0j, complex(*self.document.canvas), screen, margin=margin)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ExportRun:
    """An export that is under way: what it draws, how, and how many frames are drawn."""

    document: Document
    pictures: Mapping[int, Bytes]
    poses: Mapping[int, Poses]
    plan: ExportPlan
    done: int = 0


@dataclass(slots=True, kw_only=True, eq=False)
class Session:
    """Everything that one window changes while it runs."""

    clock: Callable[[], float]
    jobs: Jobs
    folder: Path  # for settings and unsaved work
    preferences: Preferences = field(default_factory=Preferences)
    kept_preferences: Preferences = field(init=False)  # as they are on the disk
    autosave: Autosave = field(init=False)
    project: Project | None = None
    overlays: Overlays = field(default_factory=Overlays)
    screen: tuple[int, int] = (640, 480)  # pixels of the viewport
    full_detail: bool = True  # whether this machine draws the full mesh fast enough to move
    solver_seconds: float = 0.0
    meshing: Meshing = field(default_factory=Meshing)  # of new pictures
    toasts: list[Toast] = field(default_factory=list)
    dialog: Dialog | None = None
    system_dialogs: bool = False  # whether the system's own file dialogs are used
    export: ExportRun | None = None
    export_frame: Box | None = None  # shown in the viewport while the export's settings are
    keeps_aspect: bool = True  # of an export whose size is entered
    curves: CurveKind = "relative"
    pointer: Gesture | None = None
    space_used: bool = False  # Space was held to move the view
    hovered: int | None = None  # the handle under the pointer
    hint: str = ""  # about what is under the pointer
    quitting: bool = False

    def __post_init__(self) -> None:
        """Take the preferences to be as they were read, and nothing to be kept yet."""
        self.kept_preferences = self.preferences
        self.autosave = Autosave(self.folder)

    @property
    def usual_folder(self) -> Path:
        """Where the person's files were last."""
        folder = self.preferences.folder
        return folder if folder is not None and folder.is_dir() else Path.home()

    def tell(
        self,
        text: str,
        *,
        tone: Tone = "info",
        details: str = "",
        label: str = "",
        action: Action | None = None,
    ) -> None:
        """Show a message; one that shows already starts its time again."""
        self.toasts = [toast for toast in self.toasts if toast.text != text]
        born = self.clock()
        toast = Toast(text=text, tone=tone, born=born, details=details, label=label, action=action)
        self.toasts.append(toast)

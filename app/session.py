"""The state of one window: everything that may change, and nothing that is drawn."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from app.actions.action import Action
from app.document.history import History
from app.document.keyframe import Pose
from app.document.model import Document
from app.document.playhead import Playhead
from app.jobs import Jobs
from app.picture import Picture
from app.render.view import View, fit_view

HeatMap = Literal["none", "k", "sigma_a", "sigma_b"]
ThemeName = Literal["dark", "light"]
Tone = Literal["info", "good", "error"]
FIT_MARGIN = 0.08  # of the viewport, left free around a picture that is fitted into it


@dataclass(frozen=True, slots=True, kw_only=True)
class Preferences:
    """What the person chose for all projects."""

    theme: ThemeName = "dark"
    scale: float = 1.0
    auto_key: bool = True
    recent: tuple[Path, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlays:
    """What the viewport shows besides the drawing."""

    handles: bool = True
    wireframe: bool = False
    outline: bool = False
    onion: bool = False
    heat_map: HeatMap = "none"
    ghosts_before: int = 2
    ghosts_after: int = 2
    ghost_step: int = 4
    backdrop: str = "checker"  # or "#rrggbb"


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
    """Our own file browser, for where the system has none.

    Parameters
    ----------
    title : str
    folder : Path
        Whose contents it lists.
    name : str
        Of the file to write; ignored where one is opened.
    suffixes : tuple of str
        Which files it lists, such as ".png".
    writes : bool
        Whether it asks for a file to write (else for one to read).
    chosen : callable
        Returns the action for the chosen path.
    """

    title: str
    folder: Path
    name: str = ""
    suffixes: tuple[str, ...]
    writes: bool
    chosen: Callable[[Path], Action]


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


@dataclass(slots=True, kw_only=True, eq=False)
class Project:
    """The document that is open, and how the person looks at it."""

    history: History
    picture: Picture
    path: Path | None
    playhead: Playhead = field(default_factory=Playhead)
    selected: frozenset[int] = frozenset()  # ids of handles
    chosen: frozenset[int] = frozenset()  # frames of keys
    loose: Pose | None = None  # posed with auto-key off, held by no key
    camera: View | None = None  # None: fit the picture into the viewport
    gesture: object | None = None  # commands given while it lasts make one step of undo

    @property
    def document(self) -> Document:
        """The document as it is now."""
        return self.history.document

    def view(self, screen: tuple[int, int]) -> View:
        """Return what the viewport shows on a screen of this size in pixels."""
        if self.camera is not None:
            return replace(self.camera, size=screen)
        margin = FIT_MARGIN * min(screen)
        return fit_view(0j, complex(*self.picture.size), screen, margin=margin)


@dataclass(slots=True, kw_only=True, eq=False)
class Session:
    """Everything that one window changes while it runs."""

    clock: Callable[[], float]
    jobs: Jobs
    preferences: Preferences = field(default_factory=Preferences)
    project: Project | None = None
    overlays: Overlays = field(default_factory=Overlays)
    screen: tuple[int, int] = (640, 480)  # pixels of the viewport
    toasts: list[Toast] = field(default_factory=list)
    dialog: Dialog | None = None
    hint: str = ""  # about what is under the pointer
    quitting: bool = False

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

"""The tools of the viewport: the selected one, and the one that has the pointer."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol, get_args

from app.editor.overlay_shapes import Cursor, OverlayShape
from app.editor.work.motion_setup import MotionSetup
from app.editor.work.revised import Revised
from app.sound import Response

CutTool = Literal["keep", "remove", "knife", "pick", "holes"]
StiffnessTool = Literal["stiff", "soft", "normal", "bone"]
# The selected tool by its name in the table of tools, such as "pose", "record" or a `CutTool`; or
# the draft of a motion whose joints are placed.
ToolMode = str | MotionSetup
CUT_TOOLS: tuple[CutTool, ...] = get_args(CutTool)
STIFFNESS_TOOLS: tuple[StiffnessTool, ...] = get_args(StiffnessTool)
CLICK = 3.0  # screen pixels that the pointer may move during a click


@dataclass(frozen=True, slots=True)
class Hint:
    """A hint about the pointer: gesture and effect as one text, and the key to hold."""

    text: str
    key: Literal["", "ctrl", "shift", "alt", "ctrl+shift"] = ""


class ActiveTool(Protocol):
    """A tool that has the pointer in the viewport; places are in the scene."""

    def move(self, session: Any, place: complex) -> None:
        """Follow the pointer to another place."""

    def type(self, session: Any, characters: str) -> None:
        """Take characters that are typed during the drag."""

    def end(self, session: Any, place: complex) -> None:
        """End at the pointer's place."""

    def cancel(self, session: Any) -> None:
        """End, and undo all edits."""

    @property
    def cursor(self) -> Cursor:
        """The cursor until the release."""

    @property
    def snaps(self) -> bool:
        """Whether it moves in steps while Ctrl is held."""

    @property
    def snaps_by_shift(self) -> bool:
        """Whether it moves in steps while Shift is held."""

    def shapes(self, place: complex, em: float) -> Iterable[OverlayShape]:
        """Return what the tool draws over the drawing, with the pointer at a place."""

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        """The hints until the release."""


@dataclass(slots=True, kw_only=True, eq=False)
class ToolState(Revised):
    """The selected tool with its settings, and what the pointer does."""

    mode: ToolMode = "pose"  # the selected tool
    last_motion_setup: MotionSetup | None = None  # the last draft that was left or applied
    active_tool: ActiveTool | None = None  # the tool that has the pointer
    strength: float = 10.0  # factor of the stiffness brush
    softness: float = 0.5  # part of the stiffness brush's radius over which it fades
    recording_speed: float = 1.0  # of the animation's speed
    response: Response = field(default_factory=Response)  # of mouths to the volume of a sound
    opening: complex = complex(0, -20)  # pixels by which a handle moves where a sound is loudest
    volume_target: str = ""  # what opens with the volume, by its name in the list
    is_snapping: bool = False  # whether pointer moves snap to steps
    is_forcing_targets: bool = False  # whether released targets beyond reach stay
    is_space_used: bool = False  # whether Space was held to pan the view
    hovered: int | None = None  # the handle under the pointer
    hint: str = ""  # about the item under the pointer
    hint_source: str = ""  # the panel that shows the hint, and takes it away again
    widget: int = 0  # number of the panel's widget in use; 0 for none
    is_widget_pressed: bool = False
    # Commands of a single use of a widget are one undo step.
    widget_gesture: object | None = None

    @property
    def is_posing(self) -> bool:
        """Whether drags pose or record, and no other tool is selected."""
        return self.mode in ("pose", "record")

    @property
    def is_cutting(self) -> bool:
        """Whether a tool for cutting out is selected."""
        return self.mode in CUT_TOOLS

    @property
    def stiffness_tool(self) -> StiffnessTool | None:
        return next((tool for tool in STIFFNESS_TOOLS if tool == self.mode), None)

    @property
    def motion_setup(self) -> MotionSetup | None:
        """The draft of a motion."""
        return self.mode if isinstance(self.mode, MotionSetup) else None

    def select(self, mode: ToolMode) -> None:
        """Select a tool; a draft of a motion that is left is remembered."""
        if self.motion_setup is not None and not isinstance(mode, MotionSetup):
            self.last_motion_setup = self.motion_setup
        self.mode = mode

    def toggle(self, mode: ToolMode) -> None:
        """Select a tool, or go back to posing if it is selected."""
        self.select("pose" if mode == self.mode else mode)

    def leave(self, mode: ToolMode) -> None:
        """Go back to posing if a tool is selected."""
        if mode == self.mode:
            self.select("pose")

    def begin(self, tool: ActiveTool | None) -> None:
        """Give the pointer to a tool."""
        self.active_tool = tool

    def end(self) -> ActiveTool | None:
        """Take the pointer from the active tool, and return this tool."""
        tool, self.active_tool = self.active_tool, None
        return tool

    def set_brush_strength(self, strength: float) -> None:
        self.strength = strength

    def set_brush_softness(self, softness: float) -> None:
        self.softness = softness

    def set_recording_speed(self, speed: float) -> None:
        self.recording_speed = speed

    def set_response(self, response: Response) -> None:
        self.response = response

    def set_opening(self, opening: complex) -> None:
        self.opening = opening

    def set_volume_target(self, target: str) -> None:
        self.volume_target = target

    def snap(self, *, snaps: bool) -> None:
        """Note whether this move of the pointer snaps to steps."""
        self.is_snapping = snaps

    def force_targets(self, *, forces: bool) -> None:
        """Note whether targets of this release stay beyond reach."""
        self.is_forcing_targets = forces

    def use_space(self, *, used: bool) -> None:
        """Note that Space pans the view, so that its release does not play; or that it does not."""
        self.is_space_used = used

    def hover(self, handle: int | None) -> None:
        """Note the handle under the pointer."""
        self.hovered = handle

    def show_hint(self, hint: str, source: str = "") -> None:
        self.hint, self.hint_source = hint, source

    def use_widget(self, widget: int, *, is_pressed: bool) -> None:
        """Note the widget in use, 0 for none, and whether the pointer presses it."""
        if widget != self.widget:
            self.widget, self.widget_gesture = widget, object() if widget else None
        self.is_widget_pressed = is_pressed

    @contextmanager
    def without_widget(self) -> Iterator[None]:
        """Let commands belong to no widget: those of keys and of finished jobs."""
        held = self.widget_gesture, self.is_widget_pressed
        self.widget_gesture, self.is_widget_pressed = None, False
        try:
            yield
        finally:
            self.widget_gesture, self.is_widget_pressed = held

    def reset(self) -> None:
        """Go back to posing, as for another project."""
        self.mode, self.active_tool, self.last_motion_setup = "pose", None, None

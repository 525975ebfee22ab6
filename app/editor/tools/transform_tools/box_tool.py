"""The base of the tools with a box: its grips turn and scale, and its pivot can be moved."""

from abc import abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import ClassVar, Final, Self

import numpy as np

from app.editor.overlay_shapes import OverlayShape, TagShape
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.numeric_entry import NumericEntry
from app.editor.tools.tool import PointerHit, Tool, handle_places, to_scene
from app.editor.tools.transform_tools.box import SMALLEST, BoxGrip, TransformBox
from app.editor.tools.transform_tools.turning import Turning
from app.motion import LayerFrame
from app.texts import _

# Where the knob may be: outside the top or the bottom, or inside the top.
KNOBS: Final[tuple[tuple[complex, int], ...]] = ((1j, 1), (-1j, 1), (1j, -1))
TOP = 3.0  # em: from the top of the view, where badges are
STICKY = 0.8  # em: a pivot this near to a handle, to the middle or to its home goes there


@dataclass(slots=True, kw_only=True, eq=False)
class BoxTool(Tool):
    """The pointer drags a grip of a box, or its pivot."""

    cursor = "hand"
    snaps = True
    snaps_by_shift = True
    # Whether `box`, `start` and `turning` are in the scene, or else in the active layer.
    is_in_scene: ClassVar[bool]
    box: TransformBox  # at the press
    grip: BoxGrip
    start: complex  # place of the press
    sticky: float  # distance at which a pivot sticks, in the active layer
    earlier_pivot: complex | None  # the moved pivot before the press, in the scene
    turning: Turning = field(init=False)
    scale: complex = 1.0 + 1j
    entry: NumericEntry = field(default_factory=NumericEntry)  # typed percents
    place: complex | None = None  # place of the pointer; None before it has moved
    moved: bool = False

    def __post_init__(self) -> None:
        super(BoxTool, self).__post_init__()
        self.turning = Turning(centre=self.box.pivot, start=self.start)

    @classmethod
    @abstractmethod
    def find_box(cls, session: Session, project: Project, em: float) -> TransformBox | None:
        """Return the box in the active layer's space; None if there is nothing to change."""

    @abstractmethod
    def apply(self, session: Session) -> None:
        """Change the dragged things by `scale` and `turning`."""

    @classmethod
    def has_gizmo_at(cls, session: Session, project: Project, spot: PointerHit) -> bool:
        return cls.grip_at(session, project, spot) is not None

    @classmethod
    def grip_at(cls, session: Session, project: Project, spot: PointerHit) -> BoxGrip | None:
        """Return the grip of the box at a place."""
        box = cls.find_box(session, project, spot.em)
        return None if box is None else box.find_grip(spot.place, spot.em)

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        grip = cls.grip_at(session, project, spot) if spot.on_gizmo else None
        if grip is None:
            return ()
        if grip.kind == "pivot":
            text = _("drag to move the pivot; the picture stays")
            return (Hint(text), Hint(_("double-click to put it back")))
        if grip.kind == "turn":
            return (Hint(_("drag to turn around the pivot")), Hint(_("← → turn"), "ctrl"))
        return (Hint(_("drag to scale from the pivot")), Hint(_("↑ ↓ scale"), "ctrl"))

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab a grip or the pivot; a double click puts the pivot back."""
        shown = project.layer_runtime.shown
        box = cls.find_box(session, project, spot.em) if spot.on_gizmo else None
        grip = None if box is None else box.find_grip(spot.place, spot.em)
        if shown is None or box is None or grip is None:
            return None
        if grip.kind == "pivot" and spot.is_double:
            project.selection.set_pivot(None)
            box = replace(box, pivot=box.home)
        return cls(
            project=project,
            box=box.moved_by(shown.placement) if cls.is_in_scene else box,
            grip=grip,
            start=to_scene(project, spot.place) if cls.is_in_scene else spot.place,
            sticky=STICKY * spot.em,
            earlier_pivot=project.selection.pivot,
        )

    def move(self, session: Session, place: complex) -> None:
        """Turn, scale, or move the pivot to the pointer."""
        here = to_scene(self.project, place) if self.is_in_scene else place
        if not (self.moved or self.is_away(session, self.start, here)):
            return
        self.place, self.moved = here, True
        if self.grip.kind == "pivot":
            self._move_pivot(place)
        elif self.grip.kind == "scale":
            self._scale(session)
        elif self.turning.follow(here, snaps=session.tools.is_snapping):
            self.apply(session)

    def type(self, session: Session, characters: str) -> None:
        """Turn by the typed degrees, or scale to the typed percents, along an axis if typed."""
        if self.grip.kind == "turn" and self.turning.type(characters):
            self.moved = True
            self.apply(session)
        if self.grip.kind == "scale":
            self.entry.type(characters)
            if not self.box.has_sides:
                self.entry.axis = ""
            self.moved = self.moved or self.entry.value is not None
            self._scale(session)

    def _scale(self, session: Session) -> None:
        if not self.moved:
            return
        typed, place = self.entry.value, self.start if self.place is None else self.place
        keeps = session.tools.is_snapping or not self.box.has_sides
        scale = self.box.scale_towards(self.grip, self.start, place, keeps_proportions=keeps)
        if typed is not None:
            share = max(typed / 100, SMALLEST)
            is_corner = bool(self.grip.way.real and self.grip.way.imag)
            scale = complex(
                share if is_corner or keeps or self.grip.way.real else 1.0,
                share if is_corner or keeps or self.grip.way.imag else 1.0,
            )
        if self.entry.axis == "x":
            scale = complex(scale.real, 1.0)
        elif self.entry.axis == "y":
            scale = complex(1.0, scale.imag)
        self.scale = scale
        self.apply(session)

    def _move_pivot(self, place: complex) -> None:
        """Move the pivot to a place of the active layer, or to what is near it."""
        project, shown = self.project, self.project.layer_runtime.shown
        if shown is None:
            return
        own = self.box.moved_by(shown.placement.inverse) if self.is_in_scene else self.box
        stations = [*handle_places(project).values(), own.home, own.place(0)]
        nearest = min(stations, key=lambda each: abs(each - place))
        place = nearest if abs(nearest - place) <= self.sticky else place
        in_scene = to_scene(project, place)
        project.selection.set_pivot(in_scene)
        self.box = replace(self.box, pivot=in_scene if self.is_in_scene else place)

    def end(self, session: Session, place: complex) -> None:  # noqa: ARG002 - of a tool
        """Release the grip."""
        self.project.history.release(self)

    def cancel(self, session: Session) -> None:
        """Undo the drag, and put the pivot back."""
        super(BoxTool, self).cancel(session)
        self.project.selection.set_pivot(self.earlier_pivot)

    @classmethod
    def idle_shapes(
        cls, session: Session, project: Project, spot: PointerHit
    ) -> Iterable[OverlayShape]:
        """Return the box with its grips."""
        is_idle = session.tools.active_tool is None
        box = cls.find_box(session, project, spot.em) if is_idle else None
        if box is None:
            return ()
        hot = box.find_grip(spot.place, spot.em) if spot.on_gizmo else None
        return box.idle_shapes(spot.em, hot)

    def shapes(self, _place: complex, em: float) -> Iterable[OverlayShape]:
        """Yield the changed box with its numbers, and the typed text."""
        shown = self.project.layer_runtime.shown
        if shown is None:
            return
        box = self.box.moved_by(shown.placement.inverse) if self.is_in_scene else self.box
        yield from box.drag_shapes(self.scale, self.turning.angle, em)
        if self.grip.kind == "turn":
            yield TagShape(text=self.turning.text, place=box.pivot + 1.6j * em)
            yield from self.turning.entry_shapes(box.pivot)
        elif self.grip.kind == "scale":
            x, y = round(100 * self.scale.real), round(100 * self.scale.imag)
            text = f"{x} %" if x == y else f"{x} × {y} %"
            yield TagShape(text=text, place=box.pivot + 1.6j * em)
            yield from self.entry.shapes(box.pivot, "%")

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        if self.grip.kind == "pivot":
            return (Hint(_("let go at a handle to turn around it")),)
        if self.grip.kind == "turn":
            return (Hint(_("turn in steps of 15°"), "shift"), Hint(_("type a number of degrees")))
        typed = Hint(_("type a number of percent"))
        if not self.box.has_sides:
            return (typed,)
        return (Hint(_("keep the proportions"), "shift"), typed)


def finish_box(session: Session, project: Project, box: TransformBox, em: float) -> TransformBox:
    """Return a box of the active layer with the moved pivot, and with its knob in view."""
    pivot, view = project.selection.pivot, project.view_on(session.display.screen)
    shown = project.layer_runtime.shown
    if pivot is not None and shown is not None:
        box = replace(box, pivot=shown.placement.apply_inverse(pivot))
    sides = [replace(box, knob=knob) for knob in KNOBS]
    places = [to_scene(project, each.knob_place(em)) for each in sides]
    pixels = view.to_pixels(np.array(places))
    is_seen = (pixels.real > 0) & (pixels.real < view.size[0])
    is_seen &= (pixels.imag > TOP * em * view.scale) & (pixels.imag < view.size[1])
    return next((each for each, seen in zip(sides, is_seen, strict=True) if seen), box)


def screen_axis(session: Session, project: Project, shown: LayerFrame) -> complex:
    """Return the screen's direction to the right, in the space of a layer."""
    turn = project.view_on(session.display.screen).turn * shown.placement.factor
    return turn.conjugate() / abs(turn)

"""Tools of the mode Move that turn, scale and pull the pressed layer at its joint."""

import cmath
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar, Literal, Self

from app.document import Transform
from app.editor.actions import playback
from app.editor.layering.layer_posing import find_pull, set_ik_target, set_transforms
from app.editor.layering.layer_selection import set_active_layer
from app.editor.overlay_shapes import (
    CircleShape,
    ColourRole,
    KnobShape,
    LineShape,
    OverlayShape,
    TagShape,
)
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.numeric_entry import NumericEntry
from app.editor.tools.tool import PointerHit, Tool, to_scene
from app.editor.tools.transform_tools.rotate_tool import BAND, KNOB, RING, STEP
from app.motion import LayerPull
from app.texts import _

Grip = Literal["", "ring", "scale"]
GRIP_ANGLE = cmath.exp(-0.25j * math.pi)  # direction of the scale grip from the joint


@dataclass(slots=True, kw_only=True, eq=False)
class PullTool(Tool):
    """The pointer pulls an attached layer by a point; its parents bend as bones.

    While Ctrl is held, the layer turns alone. With Shift at the press, it moves off its joint.
    """

    cursor = "hand"
    snaps = True
    pull: LayerPull
    start: complex  # place of the press in the scene
    shifts: bool  # whether the layer moves off its joint
    last: int  # the active layer before the press
    moved: bool = False

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        layer = _pressed_layer(session, project, spot)
        if layer is None:
            return ()
        frame = playback.current_frame(session, project)
        name = project.document.layer(layer).name
        if len(project.document.parent_chain(layer, frame)) < 2:
            return ()
        return (
            Hint(_("drag to pull {layer}; its parents bend").format(layer=name)),
            Hint(_("drag to turn it alone"), "ctrl"),
            Hint(_("drag to move it off its joint"), "shift"),
        )

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab the attached layer under the pointer, and make it active."""
        layer = _pressed_layer(session, project, spot)
        if layer is None or spot.ctrl or spot.alt:
            return None
        pull = find_pull(session, project, layer)
        frame = playback.current_frame(session, project)
        if pull is None or len(project.document.parent_chain(layer, frame)) < 2:
            return None
        start, last = to_scene(project, spot.place), project.selection.active
        set_active_layer(session, layer)
        return cls(project=project, pull=pull, start=start, shifts=spot.shift, last=last)

    def move(self, session: Session, place: complex) -> None:
        """Pull the layer to the pointer."""
        here = to_scene(self.project, place)
        self.moved = self.moved or self.is_away(session, self.start, here)
        if not self.moved or (not self.shifts and _tell_if_planted(session, self.pull)):
            return
        target, alone = self.pull.target, session.tools.is_snapping
        if self.shifts:
            self._set(session, self.pull.moved(here - self.start), _("Move layer"))
        elif target is not None and target.mix > 0 and not alone:
            own = self.pull.present_target()
            wanted = replace(own, place=own.place + here - self.start, mix=target.mix)
            set_ik_target(session, self.pull.layer, wanted, gesture=self)
        else:
            pulled = self.pull.pulled(self.start, here, alone=alone)
            self._set(session, pulled, _("Turn layer"))

    def _set(self, session: Session, found: Mapping[int, Transform], label: str) -> None:
        set_transforms(session, found, label=label, gesture=self)

    def end(self, _session: Session, _place: complex) -> None:
        """Release the layer."""
        self.project.history.release(self)

    def cancel(self, session: Session) -> None:
        """Undo the drag, and make the earlier layer active."""
        set_active_layer(session, self.last)
        super(PullTool, self).cancel(session)


@dataclass(slots=True, kw_only=True, eq=False)
class JointGripTool(Tool):
    """The pointer turns or scales the active layer by the ring or the grip around its joint."""

    cursor = "hand"
    snaps = True
    pull: LayerPull
    grip: Grip
    start: complex  # place of the press in the scene
    change: float = 0.0  # angle in radians, or logarithm of the scale
    entry: NumericEntry = field(default_factory=NumericEntry)  # typed degrees, or percent
    unit: ClassVar[Mapping[Grip, str]] = {"ring": "°", "scale": "%"}

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        texts = {
            "": (),
            "ring": (Hint(_("drag to turn the layer at its joint")),),
            "scale": (Hint(_("drag to scale the layer at its joint")),),
        }
        return texts[_find_grip(session, project, spot)]

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab the ring or the scale grip of the active layer."""
        grip = _find_grip(session, project, spot)
        pull = find_pull(session, project, project.selection.active) if grip else None
        if pull is None:
            return None
        return cls(project=project, pull=pull, grip=grip, start=to_scene(project, spot.place))

    def move(self, session: Session, place: complex) -> None:
        """Turn by the pointer's angle around the joint, or scale by its distance."""
        here, joint = to_scene(self.project, place), self.pull.joint
        ratio = (here - joint) / ((self.start - joint) or 1)
        if not ratio or self.entry.value is not None:
            return
        if self.grip == "scale":
            self.change = math.log(abs(ratio))
        else:
            # The nearest angle to the present one, so that full turns add up.
            step = cmath.phase(ratio * cmath.exp(-1j * self.change))
            angle = self.change + step
            self.change = STEP * round(angle / STEP) if session.tools.is_snapping else angle
        self._apply(session)

    def type(self, session: Session, characters: str) -> None:
        """Turn by the typed degrees, or scale to the typed percents of the present size."""
        self.entry.type(characters)
        self.entry.axis = ""
        if self.entry.value is not None:
            share = max(self.entry.value / 100, 0.01)
            self.change = (
                math.log(share) if self.grip == "scale" else math.radians(self.entry.value)
            )
            self._apply(session)

    def _apply(self, session: Session) -> None:
        if self.grip == "ring" and _tell_if_planted(session, self.pull):
            return
        if self.grip == "scale":
            found, label = self.pull.scaled(math.exp(self.change)), _("Scale layer")
        else:
            found, label = self.pull.turned(self.change), _("Turn layer")
        set_transforms(session, found, label=label, gesture=self)

    def end(self, _session: Session, _place: complex) -> None:
        """Release the grip."""
        self.project.history.release(self)

    @classmethod
    def idle_shapes(
        cls, session: Session, project: Project, spot: PointerHit
    ) -> Iterable[OverlayShape]:
        """Return the ring around the active layer's joint, with its knob and the scale grip."""
        found = _joint(session, project) if session.tools.active_tool is None else None
        return [] if found is None else _ring(*found, spot.em, _find_grip(session, project, spot))

    def shapes(self, _place: complex, em: float) -> Iterable[OverlayShape]:
        """Return the ring with the change so far, and the typed text."""
        shown = self.project.layer_runtime.shown
        if shown is None:
            return []
        centre = shown.placement.apply_inverse(self.pull.joint)
        size = em / abs(shown.placement.factor)
        text = f"{math.degrees(self.change):+.0f}°".replace("-", "−")
        if self.grip == "scale":
            text = f"{100 * math.exp(self.change):.0f} %"
        return [
            *_ring(centre, 1 / abs(shown.placement.factor), em, self.grip),
            TagShape(text=text, place=centre + (RING + 0.8) * size * 1j),
            *self.entry.shapes(centre, self.unit[self.grip]),
        ]

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        if self.grip == "scale":
            return (Hint(_("type a number of percent")),)
        return (Hint(_("turn in steps of 15°"), "ctrl"), Hint(_("type a number of degrees")))


def _tell_if_planted(session: Session, pull: LayerPull) -> bool:
    """Show a notice if an IK target bends the layer, so that it cannot turn by itself."""
    end = pull.planted_end
    if end is not None:
        text = _("{layer} bends to the IK target of {end}. Drag {end}, or release it first.")
        name = pull.document.layer(pull.layer).name
        session.notices.show(text.format(layer=name, end=end.name), topic="planted")
    return end is not None


def _pressed_layer(session: Session, project: Project, spot: PointerHit) -> int | None:
    """Return the layer under the pointer in the mode Move, unless it is locked."""
    if session.tools.mode != "move" or spot.layer is None:
        return None
    return None if project.document.layer(spot.layer).locked else spot.layer


def _joint(session: Session, project: Project) -> tuple[complex, float] | None:
    """Return the joint of the active layer in its own space, and the size of a scene's pixel."""
    shown, own = project.layer_runtime.shown, project.layer
    is_idle = session.tools.mode == "move" and project.timeline.playhead.since is None
    if shown is None or own.locked or not is_idle:
        return None
    pull = find_pull(session, project, own.id)
    if pull is None:
        return None
    return shown.placement.apply_inverse(pull.joint), 1 / abs(shown.placement.factor)


def _find_grip(session: Session, project: Project, spot: PointerHit) -> Grip:
    """Return the grip of the active layer's joint under the pointer."""
    found = _joint(session, project)
    if found is None or spot.ctrl or spot.shift or spot.alt:
        return ""
    centre, pixel = found
    em, away = spot.em * pixel, spot.place - centre
    if abs(away - RING * em * GRIP_ANGLE) < 2 * KNOB * em:
        return "scale"
    return "ring" if abs(abs(away) - RING * em) < BAND * em else ""


def _ring(centre: complex, pixel: float, em: float, grip: Grip) -> list[OverlayShape]:
    """Return the ring around a joint; the grip under the pointer stands out."""
    size = em * pixel
    roles: dict[Grip, ColourRole] = {"ring": "text", "scale": "text", "": "text"}
    roles[grip] = "accent"
    corner = centre + RING * size * GRIP_ANGLE
    half = KNOB * size
    square = [corner + half * complex(x, y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return [
        CircleShape(centre=centre, radius=RING * size, role=roles["ring"]),
        KnobShape(centre=centre, radius=0.6 * KNOB * size, role="text"),
        KnobShape(centre=centre + RING * size * 1j, radius=KNOB * size, role=roles["ring"]),
        LineShape(points=square, role=roles["scale"], closed=True),
    ]

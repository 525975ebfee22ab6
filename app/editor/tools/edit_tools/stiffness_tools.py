"""Stiffness tools: a brush that makes parts stiff or soft, and bones between handles."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

from app.editor.actions.layer_setup import cut_out_editing, stiffness_editing
from app.editor.overlay_shapes import AreaShape, ColourRole, LineShape, OverlayShape
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.edit_tools.cut_out_tools import brush_ring, brush_stroke, is_brush_shown
from app.editor.tools.tool import PointerHit, Tool, handle_places
from app.texts import _

STEP = 0.25  # of the brush's radius: least distance of a stroke's points
REACH = 14.0  # screen pixels: reach of the pointer around a handle
WIDEST, AT = 0.09, 0.2  # of a bone's length: half its width, and where it is widest
MOST = 0.7  # em: half a bone's width at most
MODES = {
    "stiff": _("Making parts stiff"),
    "soft": _("Making parts soft"),
    "normal": _("Making parts normal again"),
    "bone": _("Drawing bones from handle to handle"),
}


@dataclass(slots=True, kw_only=True, eq=False)
class StiffnessBrushTool(Tool):
    """The pointer draws a stroke; the stiffness changes at the release."""

    places: list[complex]
    radius: float
    stiffens: bool | None

    @classmethod
    def mode(cls, session: Session, _project: Project) -> str:
        return MODES.get(session.tools.stiffness_tool or "", "")

    @classmethod
    def hints(cls, session: Session, _project: Project, _spot: PointerHit) -> tuple[Hint, ...]:
        text = {
            "stiff": _("drag to make a part stiff"),
            "soft": _("drag to make a part soft"),
            "normal": _("drag to make a part normal again"),
        }.get(session.tools.stiffness_tool or "")
        return () if text is None else (Hint(text), Hint(_("[ and ] for the brush size")))

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        if session.tools.stiffness_tool not in stiffness_editing.BRUSHES:
            return None
        return cls(
            project=project,
            places=[spot.place],
            radius=cut_out_editing.brush_radius(project),
            stiffens=stiffness_editing.BRUSHES[session.tools.stiffness_tool],
        )

    def move(self, _: Session, place: complex) -> None:
        if abs(place - self.places[-1]) >= STEP * self.radius:
            self.places.append(place)

    def end(self, session: Session, place: complex) -> None:
        """Paint the area of the stroke."""
        if place != self.places[-1]:
            self.places.append(place)
        stiffness_editing.paint_stiffness(session, self.places)

    @classmethod
    def idle_shapes(
        cls, session: Session, project: Project, spot: PointerHit
    ) -> Iterable[OverlayShape]:
        """Return the ring of the brush."""
        if session.tools.stiffness_tool not in stiffness_editing.BRUSHES or not is_brush_shown(
            session, spot
        ):
            return ()
        stiffens = stiffness_editing.BRUSHES[session.tools.stiffness_tool]
        return brush_ring(spot.place, cut_out_editing.brush_radius(project), stiffens, spot.em)

    def shapes(self, place: complex, em: float) -> Iterable[OverlayShape]:
        return brush_stroke(self.places, place, self.radius, self.stiffens, em)


@dataclass(slots=True, kw_only=True, eq=False)
class BoneTool(Tool):
    """The pointer draws a bone from handle to handle."""

    handle: int
    place: complex
    other: int | None = None  # the handle under the pointer, if any
    refusal: str | None = None  # why there can be no bone

    @classmethod
    def hints(cls, session: Session, _project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        if session.tools.mode != "bone":
            return ()
        if spot.handle is None:
            return (Hint(_("drag from handle to handle to add a bone")),)
        return (Hint(_("drag to another handle to add a bone")),)

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin a bone at a handle."""
        if session.tools.mode != "bone" or spot.handle is None:
            return None
        return cls(project=project, handle=spot.handle, place=spot.place)

    def move(self, session: Session, place: complex) -> None:
        """Follow the pointer, and snap to a handle near it."""
        self.place, before = place, self.other
        self.other = self._near(session, place)
        if self.other is not None and self.other != before:
            self.refusal = stiffness_editing.bone_disabled_reason(
                self.project, (self.handle, self.other)
            )

    def end(self, session: Session, place: complex) -> None:
        """Add the bone."""
        self.move(session, place)
        if self.other is not None:
            stiffness_editing.add_bone(session, (self.handle, self.other))

    def shapes(self, _place: complex, em: float) -> Iterable[OverlayShape]:
        places = handle_places(self.project)
        end = self.place if self.other is None else places.get(self.other, self.place)
        is_refused = self.other is not None and self.refusal is not None
        start = places.get(self.handle, self.place)
        return bone_shapes(start, end, "danger" if is_refused else "accent", em)

    def _near(self, session: Session, place: complex) -> int | None:
        """Return the other handle nearest to a place, within reach."""
        reach = REACH / self.project.view_on(session.display.screen).scale
        away = {
            i: abs(at - place) for i, at in handle_places(self.project).items() if i != self.handle
        }
        nearest = min(away, key=lambda i: away[i], default=None)
        return nearest if nearest is not None and away[nearest] <= reach else None


def layer_bones(project: Project, em: float) -> Iterable[OverlayShape]:
    """Yield the visible bones of the active layer, as thin diamonds from handle to handle."""
    places = handle_places(project)
    for bone in project.layer.bones:
        if bone.is_shown and places.keys() >= set(bone.ends):
            start, end = (places[handle] for handle in bone.ends)
            yield from bone_shapes(start, end, "text", em)


def bone_shapes(
    start: complex, end: complex, role: ColourRole, em: float
) -> Iterable[OverlayShape]:
    way = end - start
    if not way:
        return ()
    aside = 1j * way / abs(way) * min(WIDEST * abs(way), MOST * em)
    diamond = [start, start + AT * way + aside, end, start + AT * way - aside]
    return (
        AreaShape(points=diamond, role=role, opacity=0.3),
        LineShape(points=diamond, role=role, closed=True, width=0.08),
    )

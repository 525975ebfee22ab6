"""Cut-out tools: a round brush, a knife, a pipette, and clicks on holes."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from app.cut_out import CutLine, Stroke
from app.document import shape_commands
from app.editor.actions import editing
from app.editor.actions.layer_setup import cut_out_editing
from app.editor.overlay_shapes import CircleShape, ColourRole, LineShape, OverlayShape, StrokeShape
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.tool import PointerHit, Tool
from app.texts import _
from engine.domain import CUT_WIDTH
from engine.geometry import box_diagonal

STEP = 0.12  # of the brush's radius: least distance of a stroke's points
REACH = 8.0  # screen pixels: a click within this distance of a line is on the line


@dataclass(slots=True, kw_only=True, eq=False)
class CutBrushTool(Tool):
    """The pointer draws a stroke; the cut-out changes at the release."""

    places: list[complex]
    radius: float
    keeps: bool

    @classmethod
    def hints(cls, session: Session, _project: Project, _spot: PointerHit) -> tuple[Hint, ...]:
        if session.tools.mode not in {"keep", "remove"}:
            return ()
        keep, remove = _("drag to keep"), _("drag to remove")
        is_keeping = session.tools.mode == "keep"
        return (
            Hint(keep if is_keeping else remove),
            Hint(remove if is_keeping else keep, "ctrl"),
            Hint(_("[ and ] for the brush size")),
            Hint(_("X to swap")),
        )

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin a stroke; with Ctrl or Alt, swap keep and remove."""
        if session.tools.mode not in {"keep", "remove"}:
            return None
        keeps = (session.tools.mode == "keep") != spot.is_opposite
        radius = cut_out_editing.brush_radius(project)
        return cls(project=project, places=[spot.place], radius=radius, keeps=keeps)

    def move(self, _: Session, place: complex) -> None:
        if abs(place - self.places[-1]) >= STEP * self.radius:
            self.places.append(place)

    def end(self, session: Session, place: complex) -> None:
        """Keep or remove the area of the stroke."""
        if place != self.places[-1]:
            self.places.append(place)
        points = np.array(self.places) - self.project.layer.corner
        stroke = Stroke(points=points, radius=self.radius, keeps=self.keeps)
        editing.edit_layer(session, shape_commands.cut_with_brush, stroke)

    @classmethod
    def mode(cls, _session: Session, _project: Project) -> str:
        return _("Cutting out")

    @classmethod
    def idle_shapes(
        cls, session: Session, project: Project, spot: PointerHit
    ) -> Iterable[OverlayShape]:
        """Yield the strokes that the worker has not processed yet, and the ring of the brush."""
        layer, known = project.layer, project.layer_runtime.cut.source
        for stroke in layer.cut_out.strokes[0 if known is None else len(known.strokes) :]:
            points = (stroke.points + layer.corner).tolist()
            yield StrokeShape(points=points, radius=stroke.radius, role=brush_role(stroke.keeps))
        if session.tools.mode in {"keep", "remove"} and is_brush_shown(session, spot):
            keeps = (session.tools.mode == "keep") != spot.is_opposite
            yield from brush_ring(spot.place, cut_out_editing.brush_radius(project), keeps, spot.em)

    def shapes(self, place: complex, em: float) -> Iterable[OverlayShape]:
        return brush_stroke(self.places, place, self.radius, self.keeps, em)


@dataclass(slots=True, kw_only=True, eq=False)
class KnifeTool(Tool):
    """The pointer draws a line along which the knife cuts; a click with Ctrl removes a line."""

    places: list[complex]
    parts: bool

    @classmethod
    def hints(cls, session: Session, _project: Project, _spot: PointerHit) -> tuple[Hint, ...]:
        if session.tools.mode != "knife":
            return ()
        return (
            Hint(_("draw a line between the parts, from outside inwards")),
            Hint(_("click on a line to delete it"), "ctrl"),
        )

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin a line; with Ctrl or Alt, begin a click on a line."""
        if session.tools.mode != "knife":
            return None
        return cls(project=project, places=[spot.place], parts=not spot.is_opposite)

    def move(self, session: Session, place: complex) -> None:
        if self.is_away(session, self.places[-1], place):
            self.places.append(place)

    def end(self, session: Session, place: complex) -> None:
        """Cut along the line, or remove a line."""
        view = self.project.view_on(session.display.screen)
        if not self.parts:
            cut_out_editing.remove_knife_cut(session, place, REACH / view.scale)
            return
        if place != self.places[-1]:
            self.places.append(place)
        if len(self.places) < 2 or not self.is_away(session, self.places[0], place):
            return  # a click draws no line
        cut_out_editing.cut_with_knife(
            session, CutLine(points=np.array(self.places) - self.project.layer.corner)
        )

    @classmethod
    def idle_shapes(
        cls, _session: Session, project: Project, _spot: PointerHit
    ) -> Iterable[OverlayShape]:
        """Yield the finished cuts."""
        for slit in project.layer.cut_out.cut_lines:
            yield _cut(project, (slit.points + project.layer.corner).tolist())

    def shapes(self, _place: complex, _em: float) -> Iterable[OverlayShape]:
        return (_cut(self.project, tuple(self.places)),) if self.parts else ()


@dataclass(slots=True, kw_only=True, eq=False)
class CutClickTool(Tool):
    """A click picks the background colour, or swaps a hole, at the release."""

    @classmethod
    def hints(cls, session: Session, _project: Project, _spot: PointerHit) -> tuple[Hint, ...]:
        match session.tools.mode:
            case "pick":
                return (Hint(_("click on the background to remove its colour")),)
            case "holes":
                return (Hint(_("click in a hole to keep it open, or to fill it")),)
            case _:
                return ()

    @classmethod
    def press(cls, session: Session, project: Project, _: PointerHit) -> Self | None:
        return cls(project=project) if session.tools.mode in {"pick", "holes"} else None

    def end(self, session: Session, place: complex) -> None:
        act = (
            cut_out_editing.pick_background_colour
            if session.tools.mode == "pick"
            else cut_out_editing.toggle_hole
        )
        act(session, place)


def _cut(project: Project, points: Sequence[complex]) -> LineShape:
    """Return a cut line, as wide as the slit it makes."""
    breadth = CUT_WIDTH * box_diagonal(project.layer.domain.outline)
    return LineShape(points=points, width=0.1, breadth=breadth)


def is_brush_shown(session: Session, spot: PointerHit) -> bool:
    """Return whether a brush shows its ring before a press."""
    return spot.is_over and session.tools.active_tool is None


def brush_role(keeps: bool | None) -> ColourRole:  # noqa: FBT001 - the only argument
    """Return the colour of a stroke that keeps or stiffens, removes or softens, or neither."""
    return "accent" if keeps is None else "good" if keeps else "danger"


def brush_stroke(
    points: Sequence[complex],
    place: complex,
    radius: float,
    keeps: bool | None,  # noqa: FBT001 - one of three
    em: float,
) -> Iterable[OverlayShape]:
    """Yield an unfinished stroke, and the ring of the brush at the pointer."""
    yield StrokeShape(points=tuple(points), radius=radius, role=brush_role(keeps))
    yield from brush_ring(place, radius, keeps, em)


def brush_ring(
    place: complex,
    radius: float,
    keeps: bool | None,  # noqa: FBT001 - one of three
    em: float,
) -> Iterable[OverlayShape]:
    """Yield the ring of a brush, with a plus if it keeps and a minus if it removes."""
    role, sign = brush_role(keeps), 0.35 * em
    yield CircleShape(centre=place, radius=radius, role=role, width=0.1)
    if keeps is not None:
        yield LineShape(points=[place - sign, place + sign], role=role, width=0.12)
    if keeps:
        yield LineShape(points=[place - 1j * sign, place + 1j * sign], role=role, width=0.12)

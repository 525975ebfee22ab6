"""Cut-out tools: a round brush, a knife, a pipette, and clicks on holes."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from app.cut_out import CutLine, Stroke
from app.editor.actions.layer_setup import cut_out_editing
from app.editor.project import Project
from app.editor.session import Hint, KnifeOverlay, Mark, Session, StrokeOverlay
from app.editor.tools.tool import PointerHit, Tool
from app.texts import _

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
        if session.cutting not in {"keep", "remove"}:
            return ()
        keep, remove = _("drag to keep"), _("drag to remove")
        is_keeping = session.cutting == "keep"
        return (
            Hint(keep if is_keeping else remove),
            Hint(remove if is_keeping else keep, "alt"),
            Hint(_("[ and ] for the brush size")),
            Hint(_("X to swap")),
        )

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin a stroke; with Alt, swap keep and remove."""
        if session.cutting not in {"keep", "remove"}:
            return None
        keeps = (session.cutting == "keep") != spot.alt
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
        cut_out_editing.cut_with_brush(
            session, Stroke(points=points, radius=self.radius, keeps=self.keeps)
        )

    @property
    def tool_overlays(self) -> tuple[Mark, ...]:
        return (StrokeOverlay(points=tuple(self.places), radius=self.radius, keeps=self.keeps),)


@dataclass(slots=True, kw_only=True, eq=False)
class KnifeTool(Tool):
    """The pointer draws a line along which the knife cuts; a click with Alt removes a line."""

    places: list[complex]
    parts: bool

    @classmethod
    def hints(cls, session: Session, _project: Project, _spot: PointerHit) -> tuple[Hint, ...]:
        if session.cutting != "knife":
            return ()
        return (
            Hint(_("draw a line between the parts, from outside inwards")),
            Hint(_("click on a line to delete it"), "alt"),
        )

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin a line; with Alt, begin a click on a line."""
        if session.cutting != "knife":
            return None
        return cls(project=project, places=[spot.place], parts=not spot.alt)

    def move(self, session: Session, place: complex) -> None:
        if self.is_away(session, self.places[-1], place):
            self.places.append(place)

    def end(self, session: Session, place: complex) -> None:
        """Cut along the line, or remove a line."""
        view = self.project.view(session.screen)
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

    @property
    def tool_overlays(self) -> tuple[Mark, ...]:
        return (KnifeOverlay(points=tuple(self.places)),) if self.parts else ()


@dataclass(slots=True, kw_only=True, eq=False)
class CutClickTool(Tool):
    """A click picks the background colour, or swaps a hole, at the release."""

    @classmethod
    def hints(cls, session: Session, _project: Project, _spot: PointerHit) -> tuple[Hint, ...]:
        match session.cutting:
            case "pick":
                return (Hint(_("click on the background to remove its colour")),)
            case "holes":
                return (Hint(_("click in a hole to keep it open, or to fill it")),)
            case _:
                return ()

    @classmethod
    def press(cls, session: Session, project: Project, _: PointerHit) -> Self | None:
        return cls(project=project) if session.cutting in {"pick", "holes"} else None

    def end(self, session: Session, place: complex) -> None:
        act = (
            cut_out_editing.pick_background_colour
            if session.cutting == "pick"
            else cut_out_editing.toggle_hole
        )
        act(session, place)

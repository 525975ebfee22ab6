"""Stiffness tools: a brush that makes parts stiff or soft, and bones between handles."""

from dataclasses import dataclass
from typing import Self

from app.editor.actions.layer_setup import cut_out_editing, stiffness_editing
from app.editor.project import Project
from app.editor.session import BoneOverlay, Hint, Mark, Session, StrokeOverlay
from app.editor.tools.tool import PointerHit, Tool
from app.texts import _

STEP = 0.25  # of the brush's radius: least distance of a stroke's points
REACH = 14.0  # screen pixels: reach of the pointer around a handle


@dataclass(slots=True, kw_only=True, eq=False)
class StiffnessBrushTool(Tool):
    """The pointer draws a stroke; the stiffness changes at the release."""

    places: list[complex]
    radius: float
    stiffens: bool | None

    @classmethod
    def hints(cls, session: Session, _project: Project, _spot: PointerHit) -> tuple[Hint, ...]:
        text = {
            "stiff": _("drag to make a part stiff"),
            "soft": _("drag to make a part soft"),
            "normal": _("drag to make a part normal again"),
        }.get(session.material or "")
        return () if text is None else (Hint(text), Hint(_("[ and ] for the brush size")))

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        if session.material not in stiffness_editing.BRUSHES:
            return None
        return cls(
            project=project,
            places=[spot.place],
            radius=cut_out_editing.brush_radius(project),
            stiffens=stiffness_editing.BRUSHES[session.material],
        )

    def move(self, _: Session, place: complex) -> None:
        if abs(place - self.places[-1]) >= STEP * self.radius:
            self.places.append(place)

    def end(self, session: Session, place: complex) -> None:
        """Paint the area of the stroke."""
        if place != self.places[-1]:
            self.places.append(place)
        stiffness_editing.paint_stiffness(session, self.places)

    @property
    def tool_overlays(self) -> tuple[Mark, ...]:
        points = tuple(self.places)
        return (StrokeOverlay(points=points, radius=self.radius, keeps=self.stiffens),)


@dataclass(slots=True, kw_only=True, eq=False)
class BoneTool(Tool):
    """The pointer draws a bone from handle to handle; a click with Alt removes a bone."""

    handle: int
    place: complex
    other: int | None = None  # the handle under the pointer, if any
    refusal: str | None = None  # why there can be no bone

    @classmethod
    def hints(cls, session: Session, _project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        if session.material != "bone":
            return ()
        if spot.handle is None:
            return (Hint(_("drag from handle to handle to add a bone")),)
        return (Hint(_("drag to another handle to add a bone")),)

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin a bone at a handle."""
        if session.material != "bone" or spot.handle is None:
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

    @property
    def tool_overlays(self) -> tuple[Mark, ...]:
        places = self._places()
        end = self.place if self.other is None else places.get(self.other, self.place)
        return (
            BoneOverlay(
                start=places.get(self.handle, self.place),
                end=end,
                is_refused=self.other is not None and bool(self.refusal),
            ),
        )

    def _places(self) -> dict[int, complex]:
        """Return the places of the handles, by id."""
        shown = self.project.layer_runtime.shown
        if shown is None:
            return {}
        handles = shown.clip.layer.handles
        places = shown.handle_positions.tolist()
        return {handle.id: place for handle, place in zip(handles, places, strict=True)}

    def _near(self, session: Session, place: complex) -> int | None:
        """Return the other handle nearest to a place, within reach."""
        reach = REACH / self.project.view(session.screen).scale
        away = {i: abs(at - place) for i, at in self._places().items() if i != self.handle}
        nearest = min(away, key=lambda i: away[i], default=None)
        return nearest if nearest is not None and away[nearest] <= reach else None

"""Material by hand: a brush that makes parts stiff or soft, and bones from handle to handle."""

from dataclasses import dataclass
from typing import Self

from app.editor.actions.layer_setup import cut_out_editing, stiffness_editing
from app.editor.project import Project
from app.editor.session import BoneOverlay, Hint, Mark, Session, StrokeOverlay
from app.editor.tools.tool import PointerHit, Tool

STEP = 0.25  # of the brush's radius: points of a stroke are no nearer together
REACH = 14.0  # pixels of the screen: a handle so near to the pointer is meant


@dataclass(slots=True, kw_only=True, eq=False)
class StiffnessBrushTool(Tool):
    """The pointer draws a stroke through places; what it covers changes when it is let go."""

    places: list[complex]
    radius: float
    stiffens: bool | None

    @classmethod
    def hints(cls, session: Session, _: Project, __: PointerHit) -> tuple[Hint, ...]:
        """Tell what the brush does, and how it is changed."""
        what = {
            "stiff": "to make a part stiff",
            "soft": "to make a part soft",
            "normal": "to make a part as usual again",
        }.get(session.material or "")
        return () if what is None else (Hint("drag", what), Hint("[ and ]", "for its size"))

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin a stroke."""
        if session.material not in stiffness_editing.BRUSHES:
            return None
        return cls(
            project=project,
            places=[spot.place],
            radius=cut_out_editing.brush_radius(project),
            stiffens=stiffness_editing.BRUSHES[session.material],
        )

    def move(self, _: Session, place: complex) -> None:
        """Go on to the pointer."""
        if abs(place - self.places[-1]) >= STEP * self.radius:
            self.places.append(place)

    def end(self, session: Session, place: complex) -> None:
        """Change what it covers."""
        if place != self.places[-1]:
            self.places.append(place)
        stiffness_editing.paint_stiffness(session, self.places)

    @property
    def tool_overlays(self) -> tuple[Mark, ...]:
        """What it covers."""
        points = tuple(self.places)
        return (StrokeOverlay(points=points, radius=self.radius, keeps=self.stiffens),)


@dataclass(slots=True, kw_only=True, eq=False)
class BoneTool(Tool):
    """The pointer draws a bone from one handle to another one; a click with Alt takes one away."""

    handle: int
    place: complex
    other: int | None = None  # the handle under the pointer
    refusal: str = ""

    @classmethod
    def hints(cls, session: Session, _: Project, spot: PointerHit) -> tuple[Hint, ...]:
        """Tell how a bone is made."""
        if session.material != "bone":
            return ()
        if spot.handle is None:
            return (Hint("drag", "from one handle to another one for a bone"),)
        return (Hint("drag", "to another handle for a bone"),)

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin at a handle."""
        if session.material != "bone" or spot.handle is None:
            return None
        return cls(project=project, handle=spot.handle, place=spot.place)

    def move(self, session: Session, place: complex) -> None:
        """Go on to the pointer, and to a handle that is near to it."""
        self.place, before = place, self.other
        self.other = self._near(session, place)
        if self.other is not None and self.other != before:
            self.refusal = stiffness_editing.bone_disabled_reason(
                self.project, (self.handle, self.other)
            )

    def end(self, session: Session, place: complex) -> None:
        """Put the bone there."""
        self.move(session, place)
        if self.other is not None:
            stiffness_editing.add_bone(session, (self.handle, self.other))

    @property
    def tool_overlays(self) -> tuple[Mark, ...]:
        """The bone."""
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
        """Return where the handles are, by their ids."""
        shown = self.project.layer_runtime.shown
        if shown is None:
            return {}
        handles = shown.clip.layer.handles
        places = shown.handle_positions.tolist()
        return {handle.id: place for handle, place in zip(handles, places, strict=True)}

    def _near(self, session: Session, place: complex) -> int | None:
        """Return the other handle that is nearest to a place, if it is near enough."""
        reach = REACH / self.project.view(session.screen).scale
        away = {i: abs(at - place) for i, at in self._places().items() if i != self.handle}
        nearest = min(away, key=lambda i: away[i], default=None)
        return nearest if nearest is not None and away[nearest] <= reach else None

"""Tool that moves the mirror axis of poses."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Self

from app.editor.overlay_shapes import OverlayShape
from app.editor.parts.tools import Hint
from app.editor.poses import flipping
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.numeric_entry import NumericEntry
from app.editor.tools.tool import PointerHit, Tool
from app.texts import _


@dataclass(slots=True, kw_only=True, eq=False)
class MirrorAxisTool(Tool):
    """The pointer moves the axis; the last flipped poses are flipped again at the release."""

    cursor = "resize"
    axis: float  # the axis before the drag
    start: complex  # place of the press
    place: complex  # place of the pointer
    typed: NumericEntry = field(default_factory=NumericEntry)

    @classmethod
    def hints(cls, _session: Session, _project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        return (Hint(_("drag to move the mirror axis")),) if spot.on_axis else ()

    @classmethod
    def press(cls, _: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab the axis."""
        if not spot.on_axis:
            return None
        axis = project.layer.axis
        return cls(project=project, axis=axis, start=spot.place, place=spot.place)

    def move(self, session: Session, place: complex) -> None:
        """Move the axis by the pointer's horizontal offset."""
        self.place = place
        self._move(session)

    def type(self, session: Session, characters: str) -> None:
        """Move the axis by the typed offset."""
        self.typed.type(characters)
        self._move(session)

    def _move(self, session: Session) -> None:
        self.typed.axis = "x"
        way = self.typed.constrain_offset(self.place - self.start).real
        flipping.move_mirror_axis(session, self.axis + way, gesture=self)

    def end(self, session: Session, _: complex) -> None:
        """Flip the last flipped poses again."""
        flipping.flip_pose_again(session, gesture=self)
        self.project.history.release(self)

    def shapes(self, _place: complex, _em: float) -> Iterable[OverlayShape]:
        return self.typed.shapes(self.start, "px") if self.typed.text else ()

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        return (Hint(_("type a number of pixels")),)

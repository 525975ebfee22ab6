"""Setting the anchor, the point of the shape that in-betweens follow."""

from dataclasses import dataclass
from typing import Self

from app.editor.actions import posing
from app.editor.project import Project
from app.editor.session import Hint, Session
from app.editor.tools.tool import PointerHit, Tool


@dataclass(slots=True, kw_only=True, eq=False)
class AnchorTool(Tool):
    """The pointer has set the anchor; until it is let go, that can be taken back."""

    @classmethod
    def hints(cls, _: Session, __: Project, spot: PointerHit) -> tuple[Hint, ...]:
        """Tell that a click with Ctrl sets it."""
        if spot.on_ring:
            return ()
        if spot.handle is not None:
            return (Hint("click", "for the anchor", "ctrl"),)
        return (
            (Hint("click", "for the anchor, which stays calm between keys", "ctrl"),)
            if spot.on_shape
            else ()
        )

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Set it where the shape is pressed; the handle that is it already gives it back."""
        if not spot.ctrl or spot.on_ring or not (spot.on_shape or spot.handle is not None):
            return None
        anchoring = cls(project=project)
        if spot.handle is not None:
            posing.toggle_anchor_at_handle(session, spot.handle, gesture=anchoring)
        else:
            posing.set_anchor(session, spot.place, gesture=anchoring)
        return anchoring

"""Tool that sets the anchor, the point of the shape that in-betweens follow."""

from dataclasses import dataclass
from typing import Self

from app.editor.layering.anchors import set_anchor, toggle_anchor_at_handle
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.tool import PointerHit, Tool
from app.texts import _


@dataclass(slots=True, kw_only=True, eq=False)
class AnchorTool(Tool):
    """A press sets the anchor; until the release it can be cancelled."""

    @classmethod
    def hints(cls, _session: Session, _project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        if spot.on_gizmo:
            return ()
        if spot.handle is not None:
            return (Hint(_("click to place the anchor"), "ctrl"),)
        return (
            (Hint(_("click to place the anchor, around which in-betweens turn"), "ctrl"),)
            if spot.on_shape
            else ()
        )

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Set the anchor where the shape is pressed; a press on the anchor's handle resets it."""
        if not spot.ctrl or spot.on_gizmo or not (spot.on_shape or spot.handle is not None):
            return None
        anchoring = cls(project=project)
        if spot.handle is not None:
            toggle_anchor_at_handle(session, spot.handle, gesture=anchoring)
        else:
            set_anchor(session, spot.place, gesture=anchoring)
        return anchoring

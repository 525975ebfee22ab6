"""All tools: adding one is adding it here."""

from typing import Final

from app.editor.session import Session
from app.editor.tools.anchoring import Anchoring
from app.editor.tools.brushes import (
    Boning,
    Brushing,
    Jointing,
    Parting,
    Pointing,
    Stiffening,
)
from app.editor.tools.joining import Joining
from app.editor.tools.mirroring import Mirroring
from app.editor.tools.moving import Moving
from app.editor.tools.pulling import Pulling
from app.editor.tools.selecting import Choosing, Selecting
from app.editor.tools.tool import Tool
from app.editor.tools.turning import Turning

CUTTING_TOOLS: Final[tuple[type[Tool], ...]] = (Brushing, Parting, Pointing)
MATERIAL_TOOLS: Final[tuple[type[Tool], ...]] = (Stiffening, Boning)
JOINT_TOOLS: Final[tuple[type[Tool], ...]] = (Jointing,)
MOVING_TOOLS: Final[tuple[type[Tool], ...]] = (Mirroring, Moving, Anchoring)
# A press is for the first that takes it; hints are told in this order.
TOOLS: Final[tuple[type[Tool], ...]] = (
    Mirroring,
    Moving,
    Joining,
    Choosing,
    Pulling,
    Turning,
    Anchoring,
    Selecting,
)


def tools_of(session: Session) -> tuple[type[Tool], ...]:
    """Return the tools of what the person does now: cut out, give a motion, move, or pose."""
    if session.project is not None and session.project.draft is not None:
        return JOINT_TOOLS
    if session.cutting is not None:
        return CUTTING_TOOLS
    if session.material is not None:
        return MATERIAL_TOOLS
    return MOVING_TOOLS if session.moves else TOOLS

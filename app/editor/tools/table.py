"""All tools: adding one is adding it here."""

from typing import Final

from app.editor.session import Session
from app.editor.tools.anchoring import Anchoring
from app.editor.tools.choosing import Choosing
from app.editor.tools.cutting_tools import Brushing, Parting, Pointing
from app.editor.tools.joining import Joining
from app.editor.tools.mirroring import Mirroring
from app.editor.tools.pulling import Pulling
from app.editor.tools.selecting import Selecting
from app.editor.tools.tool import Tool
from app.editor.tools.turning import Turning

CUTTING_TOOLS: Final[tuple[type[Tool], ...]] = (Brushing, Parting, Pointing)
# A press is for the first that takes it; hints are told in this order.
TOOLS: Final[tuple[type[Tool], ...]] = (
    Mirroring,
    Joining,
    Choosing,
    Pulling,
    Turning,
    Anchoring,
    Selecting,
)


def tools_of(session: Session) -> tuple[type[Tool], ...]:
    """Return the tools of what the person does now: cut out, or pose."""
    return TOOLS if session.cutting is None else CUTTING_TOOLS

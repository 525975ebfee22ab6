"""All tools: adding one is adding it here."""

from typing import Final

from app.editor.tools.anchoring import Anchoring
from app.editor.tools.choosing import Choosing
from app.editor.tools.mirroring import Mirroring
from app.editor.tools.pulling import Pulling
from app.editor.tools.selecting import Selecting
from app.editor.tools.tool import Tool
from app.editor.tools.turning import Turning

# A press is for the first that takes it; hints are told in this order.
TOOLS: Final[tuple[type[Tool], ...]] = (
    Mirroring,
    Choosing,
    Pulling,
    Turning,
    Anchoring,
    Selecting,
)

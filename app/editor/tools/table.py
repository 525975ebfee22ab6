"""The table of all tools."""

from typing import Final

from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.anchor_tool import AnchorTool
from app.editor.tools.attach_tool import AttachTool
from app.editor.tools.edit_tools.cut_out_tools import CutBrushTool, CutClickTool, KnifeTool
from app.editor.tools.edit_tools.joint_tools import JointTool
from app.editor.tools.edit_tools.stiffness_tools import BoneTool, StiffnessBrushTool
from app.editor.tools.mirror_axis_tool import MirrorAxisTool
from app.editor.tools.move_tool import MoveTool
from app.editor.tools.pose_tool import PoseTool
from app.editor.tools.rotate_tool import RotateTool
from app.editor.tools.select_tools import PickLayerTool, SelectTool
from app.editor.tools.tool import PointerHit, Tool

CUTTING_TOOLS: Final[tuple[type[Tool], ...]] = (CutBrushTool, KnifeTool, CutClickTool)
STIFFNESS_TOOLS: Final[tuple[type[Tool], ...]] = (StiffnessBrushTool, BoneTool)
JOINT_TOOLS: Final[tuple[type[Tool], ...]] = (JointTool,)
MOVING_TOOLS: Final[tuple[type[Tool], ...]] = (MirrorAxisTool, MoveTool, AnchorTool)
# The first tool that takes a press gets it; hints are shown in this order.
TOOLS: Final[tuple[type[Tool], ...]] = (
    MirrorAxisTool,
    MoveTool,
    AttachTool,
    PickLayerTool,
    PoseTool,
    RotateTool,
    AnchorTool,
    SelectTool,
)


def pointed_tool(session: Session, project: Project, spot: PointerHit) -> type[Tool] | None:
    """Return the tool that gets a press at a place while no key is held, by its hints."""
    for tool in tools_of(session):
        if any(not hint.key for hint in tool.hints(session, project, spot)):
            return tool
    return None


def tools_of(session: Session) -> tuple[type[Tool], ...]:
    """Return the tools of the present mode: cut out, set up a motion, move, or pose."""
    if session.tools.motion_setup is not None:
        return JOINT_TOOLS
    if session.tools.is_cutting:
        return CUTTING_TOOLS
    if session.tools.stiffness_tool is not None:
        return STIFFNESS_TOOLS
    return MOVING_TOOLS if session.tools.mode == "move" else TOOLS

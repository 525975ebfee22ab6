"""The table of all tools."""

from typing import Final

from app.editor.parts.tools import CUT_TOOLS, STIFFNESS_TOOLS
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.anchor_tool import AnchorTool
from app.editor.tools.edit_tools.cut_out_tools import CutBrushTool, CutClickTool, KnifeTool
from app.editor.tools.edit_tools.joint_tools import JointTool
from app.editor.tools.edit_tools.stiffness_tools import BoneTool, StiffnessBrushTool
from app.editor.tools.layer_tools.attach_tool import AttachTool
from app.editor.tools.layer_tools.pull_tool import PullTool
from app.editor.tools.mirror_axis_tool import MirrorAxisTool
from app.editor.tools.move_tool import MoveTool
from app.editor.tools.pose_tool import PoseTool
from app.editor.tools.select_tools import PickLayerTool, SelectTool
from app.editor.tools.tool import PointerHit, Tool
from app.editor.tools.transform_tools.handle_box_tool import HandleBoxTool
from app.editor.tools.transform_tools.layer_box_tool import LayerBoxTool
from app.editor.tools.transform_tools.rotate_tool import RotateTool
from app.editor.work.motion_setup import MotionSetup

# The first tool that takes a press gets it; hints are shown in this order.
TOOLS: Final[tuple[type[Tool], ...]] = (
    MirrorAxisTool,
    HandleBoxTool,
    MoveTool,
    AttachTool,
    PickLayerTool,
    PoseTool,
    RotateTool,
    AnchorTool,
    SelectTool,
)
# The tools of each mode; of the modes that are not listed, `TOOLS`.
MODES: Final[dict[str, tuple[type[Tool], ...]]] = {
    **dict.fromkeys(CUT_TOOLS, (CutBrushTool, KnifeTool, CutClickTool)),
    **dict.fromkeys(STIFFNESS_TOOLS, (StiffnessBrushTool, BoneTool)),
    "move": (MirrorAxisTool, LayerBoxTool, PullTool, MoveTool, AnchorTool),
}


def pointed_tool(session: Session, project: Project, spot: PointerHit) -> type[Tool] | None:
    """Return the tool that gets a press at a place while no key is held, by its hints."""
    for tool in tools_of(session):
        if any(not hint.key for hint in tool.hints(session, project, spot)):
            return tool
    return None


def is_on_gizmo(session: Session, project: Project, spot: PointerHit) -> bool:
    """Return whether a ring, or a grip of the box, is at a place."""
    return any(tool.has_gizmo_at(session, project, spot) for tool in tools_of(session))


def tools_of(session: Session) -> tuple[type[Tool], ...]:
    """Return the tools of the present mode."""
    mode = session.tools.mode
    return (JointTool,) if isinstance(mode, MotionSetup) else MODES.get(mode, TOOLS)

"""Tools that edit a layer's cut-out, stiffness, bones and joints.

In: the pointer's places.
Out: strokes, bones, and the joints of a motion.
Imports: `app.editor.actions`, `app.editor.tools.tool`.
"""

from app.editor.tools.edit_tools.cut_out_tools import (
    CutBrushTool as CutBrushTool,
    CutClickTool as CutClickTool,
    KnifeTool as KnifeTool,
)
from app.editor.tools.edit_tools.joint_tools import (
    JointTool as JointTool,
    find_joint_near as find_joint_near,
)
from app.editor.tools.edit_tools.stiffness_tools import (
    BoneTool as BoneTool,
    StiffnessBrushTool as StiffnessBrushTool,
)

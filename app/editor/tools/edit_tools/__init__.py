"""Tools that say what a layer is made of: brushes, the knife, the pipette, bones, joints.

In: where the pointer goes.
Out: strokes and bones, and where the joints of a motion are.
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

"""Tools that say what a layer is made of: brushes, the knife, the pipette, bones, joints.

In: where the pointer goes.
Out: strokes and bones, and where the joints of a motion are.
Imports: `app.editor.actions`, `app.editor.tools.tool`.
"""

from app.editor.tools.brushes.cutting_tools import (
    Brushing as Brushing,
    Parting as Parting,
    Pointing as Pointing,
)
from app.editor.tools.brushes.joint_tools import Jointing as Jointing, pointed as pointed
from app.editor.tools.brushes.material_tools import Boning as Boning, Stiffening as Stiffening

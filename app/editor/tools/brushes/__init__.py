"""Tools that say what a figure is made of: brushes, the knife, the pipette, bones.

In: where the pointer goes.
Out: strokes and bones.
Imports: `app.editor.actions`, `app.editor.tools.tool`.
"""

from app.editor.tools.brushes.cutting_tools import (
    Brushing as Brushing,
    Parting as Parting,
    Pointing as Pointing,
)
from app.editor.tools.brushes.material_tools import Boning as Boning, Stiffening as Stiffening

"""The deformer over a base: corrections of a motion's frames, within the bounds.

In: a map on the boundary and at some points, not necessarily of the span, and where the points are
wanted.
Out: the rigid motion and the map of the span that are to be added.
Imports: `engine.maps`, `engine.deform.model`.
"""

from engine.deform.relative.corrector import (
    Corrected as Corrected,
    Corrector as Corrector,
)
from engine.deform.relative.pins import Pins as Pins

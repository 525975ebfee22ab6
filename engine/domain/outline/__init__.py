"""From a mask to its outline, a polygon of few edges, and the cage around it.

In: the mask of a subject in its picture.
Out: an `Enclosure`: an outline and a cage of as many vertices, strictly apart.
Imports: `engine.domain.picture`, `engine.geometry`.
"""

from engine.domain.outline.cage import offset_cage as offset_cage
from engine.domain.outline.cuts import CUT_WIDTH as CUT_WIDTH
from engine.domain.outline.enclosure import (
    LARGEST_OUTLINE as LARGEST_OUTLINE,
    MARGINS as MARGINS,
    Detail as Detail,
    Enclosure as Enclosure,
    enclose_subject as enclose_subject,
)
from engine.domain.outline.holes import (
    HoleMap as HoleMap,
    find_holes as find_holes,
    make_hole as make_hole,
)

"""From the pixels of a picture to the mask of its subject.

In: a picture, uint8 (h, w, 4).
Out: the subject's mask, in a grid that is neither too coarse nor too fine, in one piece.
Imports: nothing above `engine.arrays`.
"""

from engine.domain.picture.background import BackgroundColour
from engine.domain.picture.grid import WorkingGrid, working_grid
from engine.domain.picture.mask import subject_mask
from engine.domain.picture.parts import WholePiece, join_parts

__all__ = [
    "BackgroundColour",
    "WholePiece",
    "WorkingGrid",
    "join_parts",
    "subject_mask",
    "working_grid",
]

"""From the pixels of a picture to the mask of its subject.

In: a picture, uint8 (h, w, 4), and what tells its subject from the rest.
Out: the subject's mask, in a grid that is neither too coarse nor too fine, in one piece; and the
    picture with its background transparent.
Imports: nothing above `engine.arrays`.
"""

from engine.domain.picture.cut_out import (
    MOST_STROKE_POINTS,
    BackgroundColour,
    CutOut,
    Enclosed,
    Holes,
    Mask,
    Stroke,
)
from engine.domain.picture.grid import WorkingGrid, working_grid
from engine.domain.picture.mask import Subject, subject_mask
from engine.domain.picture.matte import matted
from engine.domain.picture.parts import WholePiece, join_parts

__all__ = [
    "MOST_STROKE_POINTS",
    "BackgroundColour",
    "CutOut",
    "Enclosed",
    "Holes",
    "Mask",
    "Stroke",
    "Subject",
    "WholePiece",
    "WorkingGrid",
    "join_parts",
    "matted",
    "subject_mask",
    "working_grid",
]

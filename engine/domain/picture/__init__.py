"""From the pixels of a picture to the mask of its subject.

In: a picture, uint8 (h, w, 4), and the settings of the cut-out.
Out: the subject's mask, in a grid that is neither too coarse nor too fine, in one piece; and the
picture with its background transparent.
Imports: nothing above `engine.arrays`.
"""

from engine.domain.picture.cut_out import (
    HOLES as HOLES,
    MOST_STROKE_POINTS as MOST_STROKE_POINTS,
    BackgroundColour as BackgroundColour,
    CutLine as CutLine,
    CutOut as CutOut,
    Enclosed as Enclosed,
    Holes as Holes,
    Mask as Mask,
    Stroke as Stroke,
)
from engine.domain.picture.grid import WorkingGrid as WorkingGrid, working_grid as working_grid
from engine.domain.picture.mask import Subject as Subject, subject_mask as subject_mask
from engine.domain.picture.matte import matte_picture as matte_picture
from engine.domain.picture.parts import WholePiece as WholePiece, join_parts as join_parts

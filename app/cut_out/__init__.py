"""From the pixels of a picture to its subject: the mask, and the picture without its background.

In: a picture, uint8 (h, w, 4), and the settings of the cut-out.
Out: the subject's mask and domain; the picture with its background transparent.
Imports: `engine`.
"""

from app.cut_out.cut_out import (
    MOST_STROKE_POINTS as MOST_STROKE_POINTS,
    CutLine as CutLine,
    CutOut as CutOut,
    Mask as Mask,
    Stroke as Stroke,
)
from app.cut_out.mask import Subject as Subject, subject_mask as subject_mask
from app.cut_out.picture_domain import (
    build_picture_domain as build_picture_domain,
    texture as texture,
)

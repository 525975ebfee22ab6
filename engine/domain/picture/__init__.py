"""From the pixels of a picture to the mask of its subject.

In: a picture, uint8 (h, w, 4), and the settings of the cut-out.
Out: the subject's mask, in a grid that is neither too coarse nor too fine, in one piece; and the
picture with its background transparent.
Imports: nothing above `engine.arrays`.
"""

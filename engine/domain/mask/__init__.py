"""The mask of a subject in a grid that is neither too coarse nor too fine, in one piece.

In: a mask, bool (h, w), first row on top.
Out: the grid's mask with y up, without specks, its parts joined and its holes numbered.
Imports: nothing above `engine.arrays`.
"""

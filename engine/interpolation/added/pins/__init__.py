"""Corrections of in-betweens as series in time, for pinned handles in a segment.

In: in-betweens, and targets for handles during a segment.
Out: h and q (`engine.deform.correction`) as few functions times series in time, added to
in-betweens.
Imports: `engine.deform.correction`, `engine.interpolation.keyframe_blend` and its series.
"""

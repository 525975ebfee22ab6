"""Limbs by the lines inside a drawing seen from the side, which a silhouette does not show.

In: the outlines, the picture, and joints by name.
Out: the legs that stand on the ground, their joints, which limb of a pair is nearer, and the line
along which a near limb parts from a far one.
Imports: `app.rigging.motions`, the parts of shapes beside it, `engine`.
"""

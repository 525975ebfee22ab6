"""Limbs by the lines inside a drawing seen from the side, which a silhouette does not show.

In: the outlines, the picture, and joints by name.
Out: the legs that stand on the ground, their joints, and which limb of a pair is nearer.
Imports: `app.rigging.motions`, the parts of shapes beside it, `engine`.
"""

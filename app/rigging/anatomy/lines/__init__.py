"""Limbs by the lines inside a drawing, which a silhouette does not show.

In: the outlines, the picture, and joints by name.
Out: the legs that stand on the ground, their joints, which limb of a pair is nearer, and the
lines along which limbs part from each other and from the trunk.
Imports: `app.rigging.motions`, the parts of shapes beside it, `engine`.
"""

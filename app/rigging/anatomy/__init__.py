"""Anatomy of a shape: suggested handles, and suggested joints of a body.

In: the outline and the outlines of the holes.
Out: places for handles, and their names; the kind of body, and its joints.
Imports: `app.rigging.motions`, `engine`.
"""

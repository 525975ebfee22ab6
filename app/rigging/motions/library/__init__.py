"""Motion presets as data: angles of bones in degrees, steps in lengths of a leg.

In: nothing.
Out: motions by name. They are our own, after the common textbooks of animation, and in the public
domain (CC0).
Imports: the templates of motions in `app.rigging.motions`.
"""

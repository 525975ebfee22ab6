"""Drags of a layer's pose, and its limbs.

In: a layer, a pose or a displayed frame, and targets of handles.
Out: certified poses, step by step; joints follow the ends of their chains.
Imports: `app.document`, `app.motion`, `app.rigging`, `engine`.
"""

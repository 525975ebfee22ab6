"""Tools that move whole layers.

In: presses and drags of the pointer in the mode *Move*.
Out: keys of transforms and of IK targets.
Imports: `app.editor`, `app.document`, `app.motion`.
"""

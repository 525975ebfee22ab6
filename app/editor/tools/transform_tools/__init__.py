"""Tools that turn and scale: the ring around one handle, and the box around several or a layer.

In: presses and drags of the pointer, and typed numbers.
Out: targets of handles, and keys of transforms.
Imports: `app.editor`, `app.document`, `app.motion`.
"""

"""States of layers at a frame: visibility, order, compositing, clipping, depth and camera.

In: documents.
Out: derived values; the document does not change.
Imports: the values of `app.document`.
"""

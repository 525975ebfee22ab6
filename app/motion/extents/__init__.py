"""Bounding boxes of animations, with few frames or very many.

In: documents, and positions of their layers in a frame.
Out: boxes.
Imports: `app.document`, `app.errors`, the other packages of `app.motion`.
"""

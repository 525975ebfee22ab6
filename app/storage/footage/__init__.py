"""Footage: videos, animated pictures and numbered pictures, read picture by picture.

In: paths, and the footage of layers.
Out: footage with its rate and size; its pictures, exact and in any order.
Imports: `app.document`, `app.storage.pictures`, `app.storage.files`, Pillow; PyAV only for a video.
"""

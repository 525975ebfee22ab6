"""The export formats: each has one module and one entry of a table.

In: a plan, and its frames as straight-alpha pixels, or its layers as meshes.
Out: files that are whole or absent.
Imports: `app.export.plan`, `app.export.morph_mesh`, `app.storage`, Pillow; PyAV only for a video.
"""

"""Objects on the graphics card: contexts, programs, textures, buffers.

In: arrays of pixels and vertices.
Out: textures, vertex buffers and targets, released by their owners.
Imports: `app.motion`, `app.storage`, ModernGL.
"""

"""Pictures, single or layered, as pixels in sRGB with straight alpha.

In: the bytes of a picture file.
Out: decoded pictures, and notices about changes of their contents.
Imports: `app.document`, `app.storage.preferences`, `engine.arrays`.
"""

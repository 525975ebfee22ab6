"""New scenes from pictures and layered drawings, and scenes as flat pictures.

In: paths of pictures, and decoded drawings.
Out: documents with their decoded pictures; layers; flat pictures.
Imports: `app.document`, `app.cut_out`, `app.storage.pictures`, `app.storage.files`.
"""

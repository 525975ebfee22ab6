"""Arrays in files, which commands exchange: holes, meshes, keyframes, deformations, in-betweens.

In: NPZ and OBJ files.
Out: arrays by name.
Imports: `app.document`, `app.storage`, `engine`.
"""

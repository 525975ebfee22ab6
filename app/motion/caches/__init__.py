"""Caches of a layer's in-betweens and corrections, known by their content, and their jobs.

In: clips, meshes and the results of jobs.
Out: the vertices at a frame, if computed; the next jobs.
Imports: `app.document`, `app.motion.inbetweens`, `app.motion.meshes`, `engine`.
"""

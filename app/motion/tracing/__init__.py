"""Points of a layer over time, and motion paths of its handles.

In: a clip and points.
Out: positions in every frame, each computed once.
Imports: `app.document`, `app.motion.inbetweens`.
"""

"""Corrections added to a blend: they close the periods around holes and keep pinned handles.

In: in-betweens, and their periods or target errors.
Out: functions times series in time; corrections for pinned handles are in the room `pins`.
Imports: `engine.deform.correction`, `engine.interpolation.series`, `engine.maps`, `engine.paths`.
"""

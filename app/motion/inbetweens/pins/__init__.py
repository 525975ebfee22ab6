"""Corrections of segments: auto-pins, and bones that keep their lengths.

In: a clip, and in-betweens of its poses.
Out: corrections as series in time, added to in-betweens.
Imports: `app.document`, `engine.interpolation`.
"""

"""Motions of single places.

In: places at frames, or recorded at any times.
Out: a spring's offsets from a place, at any time; few keys for a recording.
Imports: `engine`.
"""

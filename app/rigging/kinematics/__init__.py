"""Motions of single places.

In: places at frames, or recorded at any times.
Out: a spring's offsets from a place, at any time, and the spring that is late by a delay; few keys
for a recording.
Imports: `engine`.
"""

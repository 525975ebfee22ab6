"""What is added to a blend: by which periods around holes close, and by which handles stay.

In: in-betweens, and what they lack.
Out: rooms with faces of their own, of functions that are added as series in time.
Imports: `engine.interpolation.series`.
"""

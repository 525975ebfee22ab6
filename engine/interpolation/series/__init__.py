"""Functions of time as Chebyshev series, alone or multiplied by functions of space.

In: functions of time.
Out: series on pieces of time; a few functions of space, each times a series.
Imports: `engine.arrays`.
"""

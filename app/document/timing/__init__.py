"""Time between keys, and motion of single handles: easing, cycles, tracks and springs.

In: numbers and ids of handles.
Out: frozen values, checked by their constructors.
Imports: `app.errors`, and the checks of `app.document`.
"""

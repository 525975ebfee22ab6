"""The rows of the timeline: groups, switches, layers, cycles, and the empty area around keys.

In: the bands of the timeline.
Out: actions.
Imports: `app.ui.style`, the keys and tracks of `app.ui.timeline`.
"""

"""The rows of the timeline: groups, switches and layers, their names and their visibility.

In: the bands of the timeline.
Out: actions.
Imports: `app.ui.style`, the keys and tracks of `app.ui.timeline`.
"""

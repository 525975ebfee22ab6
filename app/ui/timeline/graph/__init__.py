"""The graph in the timeline: channels as curves over time, with their keys and tangents.

In: the curves of the selected channels.
Out: actions on their points and tangents.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.timeline`.
"""

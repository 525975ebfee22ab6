"""The ruler with frames, playhead, markers, camera row, and range ends.

In: the bands of the timeline.
Out: actions on time.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.timeline.layout`.
"""

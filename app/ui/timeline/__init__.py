"""The timeline: transport, ruler, tracks, easing.

In: the document's keys and the playhead.
Out: actions on keys and time.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.bars`.
"""

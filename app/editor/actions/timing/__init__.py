"""Actions in time: keys of poses and of tracks, and the pointer in the timeline.

In: a session, and keys by their layers, handles and frames.
Out: the document's keys and tracks, and the key selection.
Imports: the other `app.editor.actions`.
"""

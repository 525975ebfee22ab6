"""Track drags: handles that are dragged along their tracks, and recorded drags.

In: a session, a handle, and the pointer's place.
Out: keys of the handle's track.
Imports: `app.editor`, `app.document`, `app.motion`.
"""

"""Editing layers: selecting, ordering, hiding, replacing and attaching them.

In: a session, and the ids of layers.
Out: changed or reordered layers; the active layer.
Imports: `app.editor`, `app.document`, `app.motion`, `app.solving`, `app.storage`.
"""

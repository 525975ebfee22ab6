"""Values derived from a document: segments, tangents, tracks, target errors, layer states.

In: layers, poses and handles.
Out: derived values; the document does not change.
Imports: the values of `app.document`.
"""

"""Changed pictures under a rig: a layer's other picture, and a changed file of a drawing.

In: a document, decoded pictures, and a drawing that was read again.
Out: the changes of each layer, and the document with the same handles, keys and joints.
Imports: `app.document`, `app.storage`, `app.solving.resolve_keys`.
"""

"""Deform groups: several layers as members of one mesh.

In: layers, and their pictures.
Out: the group with its mesh, handles and keys; its members as they were, when it is parted.
Imports: `app.document`, `app.storage`, `app.solving.reload`, `app.solving.resolve_keys`.
"""

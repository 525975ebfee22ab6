"""Relations and channels of layers: groups, attachments, visibility, switches, layer keys.

In: ids of layers, and frames.
Out: groups, attachments, visibility keys, switch groups; keys of the camera and of whole layers.
Imports: the values of `app.document`.
"""

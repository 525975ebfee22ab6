"""Commands on layers: order, groups, attachments, switch groups, visibility and channels.

In: a document, and ids of its layers.
Out: the changed document.
Imports: the values of `app.document`, commands on handles and keys.
"""

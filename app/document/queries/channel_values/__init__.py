"""The keys and values of channels, and how they repeat in cycles.

In: a document, a channel, a frame.
Out: keys and values.
Imports: `app.document`'s values and queries.
"""

"""Commands on keys: of all channels alike, and what only poses, tracks and cycles have.

In: keys by channel, values.
Out: commands.
Imports: `app.document`'s values and queries, `app.document.commands.command`.
"""

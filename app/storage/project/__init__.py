"""Contents of a project file: a document in JSON, and the pictures and arrays of its layers.

In: documents; the members of a zip file.
Out: the members, and their document, checked and certified again.
Imports: `app.document`, `app.storage.json_values`, `app.storage.pictures`.
"""

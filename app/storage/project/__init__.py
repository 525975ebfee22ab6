"""What a project file holds: a document in JSON, and the pictures and arrays of its figures.

In: documents; the members of a zip file.
Out: the members, and the document that they are of, checked and proven anew.
Imports: `app.document`, `app.storage.json_values`, `app.storage.pictures`.
"""

from app.storage.project.archive import MEBIBYTE, Archive, write_archive
from app.storage.project.content import SCHEMA, read_document, write_document
from app.storage.project.members import figure_members

__all__ = [
    "MEBIBYTE",
    "SCHEMA",
    "Archive",
    "figure_members",
    "read_document",
    "write_archive",
    "write_document",
]

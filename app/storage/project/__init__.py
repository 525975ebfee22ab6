"""Contents of a project file: a document in JSON, and the pictures and arrays of its layers.

In: documents; the members of a zip file.
Out: the members, and their document, checked and certified again.
Imports: `app.document`, `app.storage.json_values`, `app.storage.pictures`.
"""

from app.storage.project.archive import (
    MEBIBYTE as MEBIBYTE,
    NO_PROJECT as NO_PROJECT,
    Archive as Archive,
    write_archive as write_archive,
)
from app.storage.project.document_json import (
    SCHEMA as SCHEMA,
    read_document as read_document,
    write_document as write_document,
)
from app.storage.project.members import layer_members as layer_members

"""The window's title."""

from app.editor import Session
from app.errors import display_name

NAME = "Lissom"


def window_title(session: Session) -> str:
    """Return the name of the open project, with a star if it has unsaved changes."""
    project = session.project
    if project is None:
        return NAME
    name = (
        display_name(project.file.path.name) if project.file.path is not None else project.file.name
    )
    mark = "" if project.history.is_saved else "*"
    return f"{name}{mark} – {NAME}"

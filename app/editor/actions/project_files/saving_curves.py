"""Saving the curves of the distortion."""

from pathlib import Path

from app.editor.action import do
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.reports import draw_curves, write_curves
from app.storage import check_writable, write_atomically
from app.texts import _


def ask_curves_csv(session: Session) -> None:
    _ask_curves(session, ".csv")


def ask_curves_png(session: Session) -> None:
    _ask_curves(session, ".png")


@with_project
def save_curves(session: Session, project: Project, path: Path) -> None:
    """Save the curves as a picture, or as numbers if the name does not end in .png."""
    curves = project.measured.curves.value
    if curves is None:
        return
    check_writable(path, sources=project.file.sources)
    if path.suffix.lower() == ".png":
        picture = draw_curves(curves)
        write_atomically(path, lambda file: file.write(picture))
    else:
        write_curves(path, curves)
    session.notices.show(_("Saved {name}.").format(name=path.name), tone="good")


@with_project
def _ask_curves(session: Session, project: Project, suffix: str) -> None:
    name = _("{project} distortion").format(project=project.file.name) + suffix
    session.ask_file(_("Save the curves"), (suffix,), lambda path: do(save_curves, path), name=name)

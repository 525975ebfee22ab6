"""Opening pictures and projects."""

import traceback
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from app.actions.action import Action, do
from app.assets import sample_images
from app.document.history import History
from app.document.model import Document, PictureFile, new_document
from app.document.settings import Meshing
from app.errors import EXPECTED_ERRORS, LissomError
from app.jobs import Job
from app.picture import Picture, decode_picture
from app.session import FileDialog, Project, Question, Session
from engine.domain import build_domain

PROJECT = ".lissom"
PICTURES = (
    *(".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".ppm", ".tga", ".ico"),
    ".avif",
)
OPENING = "Opening"
MOST_RECENT = 10


class Sample(NamedTuple):
    """A picture, or a project with its picture, that ships with Lissom."""

    name: str
    file: Path
    picture: Path
    what: str


def samples() -> list[Sample]:
    """Return the samples, animated ones first."""
    found = []
    for picture in sorted(sample_images().glob("*.png")):
        project = picture.with_suffix(PROJECT)
        is_animated = project.is_file()
        found.append(
            Sample(
                picture.stem.capitalize(),
                project if is_animated else picture,
                picture,
                "animated" if is_animated else "picture",
            )
        )
    return sorted(found, key=lambda sample: sample.what)


class Opened(NamedTuple):
    """What reading a file gives."""

    document: Document
    picture: Picture
    notices: tuple[str, ...]


def ask_open(session: Session) -> None:
    """Ask for a picture or a project."""
    session.dialog = FileDialog(
        title="Open image or project",
        folder=_folder(session),
        suffixes=(PROJECT, *PICTURES),
        writes=False,
        chosen=lambda path: do(open_file, path),
    )


def open_file(session: Session, path: Path) -> None:
    """Open a picture or a project, unless there are changes to be lost; then ask first."""
    if _has_changes(session):
        session.dialog = _question(session, do(load, path))
    else:
        load(session, path)


def load(session: Session, path: Path) -> None:
    """Read a file on the worker, and show it when it is there."""
    session.jobs.put(
        Job(
            kind=f"{OPENING} {path.name}",
            work=lambda: _read_picture(path),
            done=lambda opened: show(session, path, opened),
            failed=lambda error: fail(session, f"{path.name} cannot be opened", error),
        )
    )


def show(session: Session, path: Path, opened: Opened) -> None:
    """Make what was read the project of the window."""
    is_project = path.suffix == PROJECT
    session.project = Project(
        history=History(opened.document, saved=True),
        picture=opened.picture,
        path=path if is_project else None,
    )
    recent = (path, *(other for other in session.preferences.recent if other != path))
    session.preferences = replace(session.preferences, recent=recent[:MOST_RECENT])
    for notice in opened.notices:
        session.tell(notice[:1].upper() + notice[1:] + ".")


def close(session: Session) -> None:
    """Go back to the welcome view."""
    session.project = None


def fail(session: Session, what: str, error: Exception) -> None:
    """Tell that a job failed, and why."""
    expected = isinstance(error, EXPECTED_ERRORS)
    text = f"{what}: {error}" if expected else f"{what}."
    details = "" if expected else "".join(traceback.format_exception(error))
    session.tell(text, tone="error", details=details)


def _read_picture(path: Path) -> Opened:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise LissomError(f"cannot read {path}: {error.strerror or error}") from error
    picture = decode_picture(data, path.name)
    meshing = Meshing()
    domain, notices = build_domain(
        picture.rgba,
        triangles=meshing.triangles,
        detail=meshing.detail,
        tolerance=meshing.tolerance,
    )
    file = PictureFile(data=data, suffix=path.suffix.lower(), size=picture.size)
    document = new_document(file, domain, meshing)
    return Opened(document, picture, picture.notices + notices)


def _folder(session: Session) -> Path:
    recent = [path.parent for path in session.preferences.recent if path.parent.is_dir()]
    return recent[0] if recent else Path.home()


def _has_changes(session: Session) -> bool:
    return session.project is not None and not session.project.history.is_saved


def _question(session: Session, then: Action) -> Question:
    name = session.project.path.name if session.project and session.project.path else "this project"
    return Question(
        title="Unsaved changes",
        text=f"The changes of {name} are not saved.",
        answers=(("Discard them", then),),
    )

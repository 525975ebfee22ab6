"""Opening pictures and projects."""

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from app.actions.action import Action, do
from app.actions.failures import report
from app.assets import sample_images
from app.document.history import History
from app.document.model import Document
from app.document.project_file import load_project
from app.document.settings import Meshing
from app.jobs import Job
from app.motion import Figure, Motion, prepare_motion
from app.opening import open_picture
from app.picture import Picture, decode_picture
from app.session import FileDialog, Project, Question, Session

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
    sketch: Motion
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
            work=lambda: _read(path),
            done=lambda opened: show(session, path, opened),
            failed=lambda error: report(session, f"{path.name} cannot be opened", error),
        )
    )


def show(session: Session, path: Path, opened: Opened) -> None:
    """Make what was read the project of the window."""
    is_project = path.suffix == PROJECT
    session.project = Project(
        history=History(opened.document, saved=True),
        picture=opened.picture,
        sketch=opened.sketch,
        path=path if is_project else None,
    )
    recent = (path, *(other for other in session.preferences.recent if other != path))
    session.preferences = replace(session.preferences, recent=recent[:MOST_RECENT])
    for notice in opened.notices:
        session.tell(notice[:1].upper() + notice[1:] + ".")


def close(session: Session) -> None:
    """Go back to the welcome view."""
    session.project = None


def _read(path: Path) -> Opened:
    return _read_project(path) if path.suffix.lower() == PROJECT else _read_picture(path)


def _read_project(path: Path) -> Opened:
    document = load_project(path)
    picture = decode_picture(document.picture.data, f"the picture of {path.name}")
    rest = Motion.at_rest(document, Figure.sketch(document.domain))
    return Opened(document, picture, prepare_motion(document, rest), ())


def _read_picture(path: Path) -> Opened:
    document, picture, notices = open_picture(path, Meshing())
    sketch = Motion.at_rest(document, Figure.sketch(document.domain))
    return Opened(document, picture, sketch, notices)


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

"""The curves of the distortion: how they are shown, and where they are saved."""

from pathlib import Path

from app.editor.action import do
from app.editor.dialogs import FileDialog
from app.editor.session import CurveKind, Session
from app.reports import draw_curves, write_curves
from app.storage import write_atomically


def show_curves(session: Session, kind: CurveKind) -> None:
    """Show the curves relative to the keys, or as they are."""
    session.curves = kind


def ask_csv(session: Session) -> None:
    """Ask where to save the curves as numbers."""
    _ask(session, ".csv")


def ask_png(session: Session) -> None:
    """Ask where to save the curves as a picture."""
    _ask(session, ".png")


def save(session: Session, path: Path) -> None:
    """Save the curves as a picture, or as numbers if the name does not end in .png."""
    curves = session.project.curves.value if session.project else None
    if curves is None:
        return
    if path.suffix.lower() == ".png":
        picture = draw_curves(curves)
        write_atomically(path, lambda file: file.write(picture))
    else:
        write_curves(path, curves)
    session.tell(f"Saved {path.name}.", tone="good")


def _ask(session: Session, suffix: str) -> None:
    project = session.project
    if project is None:
        return
    session.dialog = FileDialog(
        title="Save the curves",
        folder=session.usual_folder,
        name=f"{project.name} distortion{suffix}",
        suffixes=(suffix,),
        writes=True,
        chosen=lambda path: do(save, path),
    )

"""The curves of the distortion: measured beside the work, and saved."""

from functools import partial
from pathlib import Path

from app.document import intervals
from app.editor.action import do
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.session import CurveKind, FileDialog, Project, Session
from app.reports import Curves, draw_curves, measure_curves, write_curves
from app.storage import write_atomically

MEASURING = "Measuring"


def keep_up(session: Session) -> None:
    """Measure the document again if it changed and its in-betweens are there."""
    project = session.project
    if project is None or project.is_posing or MEASURING in session.jobs.kinds:
        return
    clip, motion = project.clip, project.puppet.coarse
    is_current = project.curves is not None and project.curves.clip == clip
    is_possible = bool(intervals(clip)) and motion.knows(clip)
    if is_current or not is_possible or project.unmeasurable == clip:
        return

    def failed(error: Exception) -> None:
        project.unmeasurable = clip
        report(session, "The distortion could not be measured", error)

    session.jobs.put(
        Job(
            kind=MEASURING,
            work=lambda: measure_curves(clip, motion),
            done=partial(_show, project),
            failed=failed,
        )
    )


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
    if session.project is None or session.project.curves is None:
        return
    curves = session.project.curves
    if path.suffix.lower() == ".png":
        picture = draw_curves(curves)
        write_atomically(path, lambda file: file.write(picture))
    else:
        write_curves(path, curves)
    session.tell(f"Saved {path.name}.", tone="good")


def _show(project: Project, curves: Curves) -> None:
    project.curves = curves


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

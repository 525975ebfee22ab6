"""Exports: asked for here, drawn by the window, a few frames at a time."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

from app.actions import editing, posing
from app.actions.action import do
from app.actions.failures import report
from app.animation import Animation
from app.document import settings_commands
from app.document.settings import ExportSettings
from app.errors import LissomError
from app.export.plan import SUFFIXES, ExportRequest, check_request, plan_export
from app.jobs import Job
from app.session import ExportRun, FileDialog, Session

PREPARING = "Preparing the export"


def ask(session: Session) -> None:
    """Ask where to export to."""
    project = session.project
    if project is None or session.export is not None:
        return
    format_ = project.document.export.format
    suffixes = SUFFIXES[format_]
    name = f"{project.name}{suffixes[0]}" if suffixes else f"{project.name} frames"
    out = project.exported_to
    folder = out.parent if out is not None else session.usual_folder
    session.dialog = FileDialog(
        title="Export into a file" if suffixes else "Export into a folder",
        folder=folder,
        name=out.name if out is not None and out.suffix in (suffixes or ("",)) else name,
        suffixes=suffixes,
        writes=True,
        chosen=lambda path: do(start, path),
    )


def repeat(session: Session) -> None:
    """Export again where the last export went, or ask if there was none."""
    project = session.project
    if project is not None and project.exported_to is not None:
        start(session, project.exported_to)
    else:
        ask(session)


def start(session: Session, out: Path) -> None:
    """Export into a folder or a file."""
    project = session.project
    if project is None or session.export is not None:
        return
    posing.drop(session)
    document, picture = project.document, project.picture.rgba
    request = ExportRequest(out=out, settings=document.export)
    check_request(document, request)
    stage = project.full.stage if project.full is not None else None

    def work() -> ExportRun:
        animation = Animation(document, stage=stage)
        plan = plan_export(document, request, animation)
        return ExportRun(document=document, picture=picture, poses=animation, plan=plan)

    def done(run: ExportRun) -> None:
        session.export = run
        project.exported_to = out

    session.jobs.put(
        Job(
            kind=PREPARING,
            work=work,
            done=done,
            failed=lambda error: report(session, "The export could not begin", error),
        )
    )


def cancel(session: Session) -> None:
    """Give the export up; frames that are written stay."""
    session.jobs.drop(PREPARING)
    if session.export is not None:
        session.export = None
        session.tell("The export was cancelled. Frames that were written stay.")


def advance(session: Session, run: ExportRun, done: int) -> None:
    """Note how many frames are drawn."""
    if session.export is run:
        session.export = replace(run, done=done)


def finish(session: Session, run: ExportRun) -> None:
    """Tell that an export is complete."""
    session.export = None
    folder = run.plan.out if run.plan.out.is_dir() else run.plan.out.parent
    count = len(run.plan.times)
    frames = "1 frame" if count == 1 else f"{count} frames"
    session.tell(
        f"Exported {frames} to {run.plan.out.name}.",
        tone="good",
        label="Open folder",
        action=do(open_folder, folder),
    )
    for notice in run.plan.notices:
        session.tell(notice[:1].upper() + notice[1:] + ".")


def fail(session: Session, error: Exception) -> None:
    """Tell that an export failed."""
    session.export = None
    report(session, "The export failed", error)


def set_export(session: Session, export: ExportSettings) -> None:
    """Set what the next export makes."""
    editing.edit(session, settings_commands.set_export(export))


def open_folder(session: Session, folder: Path) -> None:
    """Show a folder in the system's file manager."""
    try:
        if sys.platform == "win32":
            os.startfile(folder)  # noqa: S606 - a folder that was just written to
            return
        opener = "open" if sys.platform == "darwin" else "xdg-open"
        subprocess.Popen([opener, folder], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # noqa: S603
    except OSError:
        raise LissomError(f"no file manager was found; the folder is {folder}") from None
    session.hint = str(folder)

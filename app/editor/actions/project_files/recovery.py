"""Unsaved work of earlier sessions."""

from contextlib import suppress
from pathlib import Path

from app.document import History
from app.editor.action import do
from app.editor.actions.action_spec import named_action
from app.editor.actions.project_files import saving
from app.editor.actions.project_files.files import OpenedFile, decode_project
from app.editor.error_reports import run_job
from app.editor.parts.dialogs import RecoverableFile, RecoveryDialog
from app.editor.parts.project_file import ProjectFile
from app.editor.parts.selection import Selection, foremost_posable
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.jobs import JobKind
from app.editor.work.layer_runtime import LayerRuntimes
from app.storage import (
    SourceInfo,
    find_recoverable_files,
    load_recoverable_file,
    read_source_info,
    remove_recoverable_file,
)
from app.texts import _


def ask_recovery(session: Session) -> None:
    """If there is unsaved work of an earlier session, ask about it."""
    candidates = list_recoverable_files(session)
    if candidates:
        session.dialogs.show(RecoveryDialog(candidates))


@named_action(_("Unsaved work…"), needs_project=False)
def show_recovery(session: Session) -> None:
    """Show the unsaved work of earlier sessions, or a notice that there is none."""
    ask_recovery(session)
    if not isinstance(session.dialogs.current, RecoveryDialog):
        session.notices.show(_("There is no unsaved work from earlier sessions."))


def list_recoverable_files(session: Session) -> tuple[RecoverableFile, ...]:
    """Return the unsaved work of closed windows, the newest first."""
    found = []
    for path in find_recoverable_files(session.settings.folder):
        with suppress(OSError):  # another window has just taken it
            status = path.stat()
            found.append(
                RecoverableFile(path, read_source_info(path), status.st_mtime, status.st_size)
            )
    return tuple(found)


def recover_file(session: Session, path: Path) -> None:
    """Open unsaved work; its autosave stays until the work is saved."""
    kind = JobKind(_("Opening unsaved work"), _("The unsaved work cannot be opened"))

    def done(read: tuple[OpenedFile, SourceInfo]) -> None:
        saving.confirm_unsaved(session, do(install_recovered, path, *read))

    run_job(session, kind, lambda: _read_recoverable_file(path), done)


def _read_recoverable_file(path: Path) -> tuple[OpenedFile, SourceInfo]:
    document, origin = load_recoverable_file(path)
    return decode_project(document, origin.name), origin


def discard_recoverable_file(session: Session, path: Path) -> None:
    """Delete unsaved work, and show the rest of the list."""
    remove_recoverable_file(path)
    session.notices.show(_("The unsaved work was discarded."))
    ask_recovery(session)


def install_recovered(session: Session, path: Path, opened: OpenedFile, origin: SourceInfo) -> None:
    """Open unsaved work under its own name; it stays unsaved."""
    saving.set_project(
        session,
        Project(
            file=ProjectFile(name=origin.name, path=origin.path, is_recovered=True),
            history=History(opened.document, saved=False),
            runtimes=LayerRuntimes(layers=opened.layer_runtimes),
            selection=Selection(active=foremost_posable(opened.document)),
        ),
    )
    session.settings.autosave.write(opened.document, origin)
    remove_recoverable_file(path)
    text = _("This is your unsaved work. Save the project to keep it.")
    if origin.path:
        text = _("This is your unsaved work on {name}. Save the project to keep it.")
        text = text.format(name=origin.path.name)
    session.notices.show(text, tone="good")

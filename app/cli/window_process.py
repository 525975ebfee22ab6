"""The process of the window, from its start to its end."""

import os
import sys
import time
from contextlib import AbstractContextManager, nullcontext, suppress
from pathlib import Path

from app.cli.console import exit_with_error, print_notice
from app.cli.process import (
    PATIENCE,
    SignalHandler,
    exit_within,
    has_running_threads,
    on_display_lost,
    redirect_faulthandler,
    set_switch_interval,
)
from app.editor import Jobs, Session, error_reports
from app.editor.actions.project_files import autosaving, files, recovery
from app.editor.parts.dialogs import DialogState
from app.editor.parts.settings import SessionSettings
from app.errors import EXPECTED_ERRORS
from app.folders import settings_folder
from app.render import Renderer
from app.render.gpu.context import window_context
from app.storage import (
    load_preferences,
    make_settings_folder,
    open_fault_log,
    save_preferences,
)
from app.texts import _, message_of
from app.ui.dialogs.native_dialog import find_system_dialogs
from app.ui.window.desktop import has_display
from app.ui.window.memory import limit_arenas
from app.ui.window.window import Window

EXIT_FAILED = 1
DISPLAY_GONE = _("the display is gone")
WORK_KEPT = _("your unsaved work was backed up; Lissom offers it at the next start")
START_ERRORS = (*EXPECTED_ERRORS, ImportError, MemoryError, OSError, RuntimeError)
# Seconds for workers to end: after the person has closed the window, and after other ends.
LEISURE, HURRY = 6.0, 2.0


def run_window(file: Path | None) -> int:
    """Open the window, with a file if one is given; return the exit status at its end."""
    if not has_display():
        exit_with_error(
            _(
                "there is no display for the window. The command line works without a display, "
                "for example 'lissom export PROJECT --out DIR'"
            )
        )
    set_switch_interval()
    limit_arenas()
    folder = settings_folder()
    session = Session(
        clock=time.perf_counter,
        jobs=Jobs(),
        settings=SessionSettings(folder=folder, preferences=load_preferences(folder)),
        dialogs=DialogState(uses_system=find_system_dialogs() is not None),
    )
    _make(folder, session)
    autosaving.remove_temporary_files(session)
    with suppress(*EXPECTED_ERRORS):
        error_reports.keep_fault_report(session)
    recovery.ask_recovery(session)
    error_reports.offer_kept_report(session)
    if file is not None:
        files.open_file(session, file.resolve())
    window = Window(session, lambda: Renderer(window_context()))
    handler = on_display_lost(lambda: _keep_at_lost_display(session), EXIT_FAILED)
    with SignalHandler(window.wake) as endings, _log_faults(folder):
        status = _show(window, endings)
        del handler
        have_ended = session.jobs.close(LEISURE if session.is_quitting else HURRY)
        if session.is_quitting:
            # Also an autosave that was being written when the person left.
            session.settings.autosave.remove()
    if status == EXIT_FAILED or not have_ended or has_running_threads():
        # Do not take down libraries under a worker that never ends. After an exception their state
        # is unknown.
        sys.stderr.flush()
        os._exit(status)
    return status


def _show(window: Window, endings: SignalHandler) -> int:
    """Show the window until it is closed; return the program's exit status."""
    session, was_open = window.session, False

    def farewell() -> None:
        nonlocal was_open
        was_open = True
        if not session.is_quitting:
            _keep(session)
        with suppress(*EXPECTED_ERRORS):
            save_preferences(session.settings.folder, session.settings.preferences)
        if session.is_quitting:
            exit_within(PATIENCE, 0)
        else:
            exit_within(2 * HURRY, endings.exit_status if endings.is_signalled else EXIT_FAILED)

    try:
        window.run(is_over=lambda: endings.is_signalled, farewell=farewell)
    except Exception as error:
        # Errors at the start have messages of their own.
        if not was_open and isinstance(error, START_ERRORS):
            raise
        _report(session, error)
        return EXIT_FAILED
    return 0 if session.is_quitting else endings.exit_status


def _report(session: Session, error: Exception) -> None:
    """Print the error that ended the window, and keep a report of it."""
    notice = _("the window failed; the report above was stored, and nothing is sent")
    try:
        text = error_reports.keep_crash_report(session, error)
    except EXPECTED_ERRORS as reason:
        text = error_reports.problem_report_text(session)
        notice = _(
            "the window failed, and the report above cannot be stored ({reason}). Nothing is sent"
        )
        notice = notice.format(reason=message_of(reason))
    print(text, file=sys.stderr)
    print_notice(notice)


def _log_faults(folder: Path) -> AbstractContextManager[None]:
    """Write Python's traceback of a crash to the fault log, if the log can be opened."""
    try:
        return redirect_faulthandler(open_fault_log(folder))
    except OSError:
        return nullcontext()


def _make(folder: Path, session: Session) -> None:
    """Make the folder for settings and unsaved work; after a failure the window still opens."""
    try:
        make_settings_folder(folder)
    except EXPECTED_ERRORS as error:
        session.notices.show(
            _("Unsaved work and settings cannot be backed up: {error}. Save often.").format(
                error=message_of(error)
            ),
            tone="error",
        )
        session.diagnostics.note_failure(
            autosaving.AUTOSAVING.complaint, autosaving.WRITING.complaint
        )


def _keep_at_lost_display(session: Session) -> None:
    """Autosave unsaved work, and print why the window ends."""
    exit_within(PATIENCE, EXIT_FAILED)
    print_notice(DISPLAY_GONE)
    if not session.is_quitting:
        _keep(session)
    sys.stderr.flush()


def _keep(session: Session) -> None:
    """Autosave unsaved work after an end that the person did not request."""
    try:
        autosaving.autosave_now(session)
    except EXPECTED_ERRORS as error:
        print_notice(
            _("unsaved work could not be backed up: {error}").format(error=message_of(error))
        )
        return
    if session.project is not None and not session.project.history.is_saved:
        print_notice(WORK_KEPT)

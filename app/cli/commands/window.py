"""`lissom` and `lissom FILE`: the window."""

import argparse
import os
import signal
import sys
import time
import traceback
from pathlib import Path

from app.cli.console import fail, notice
from app.editor import Jobs, Session
from app.editor.actions import files, saving
from app.errors import EXPECTED_ERRORS
from app.render import Renderer
from app.render.gpu import window_context
from app.storage import load_preferences, save_preferences, settings_folder
from app.ui.dialogs import find_system_dialogs
from app.ui.window import Window, has_display

# Seconds after which a worker hands Python's lock over. A frame takes it some twenty times; with
# the usual 5 ms a job that seldom lets go would leave two frames a second.
SWITCH = 0.0005
# What the system sends when the person logs out, and when the terminal is closed.
ENDINGS = ("SIGTERM", "SIGHUP")
EXIT_FAILED = 1


def run(arguments: argparse.Namespace) -> int:
    """Open the window, and close it when the person does."""
    if not has_display():
        fail(
            "there is no display for the window; the command line works without one, for example "
            "'lissom export PROJECT --out DIR'"
        )
    sys.setswitchinterval(SWITCH)
    for name in ENDINGS:
        signal.signal(getattr(signal, name, signal.SIGINT), signal.default_int_handler)
    folder = settings_folder()
    session = Session(
        clock=time.perf_counter,
        jobs=Jobs(),
        folder=folder,
        preferences=load_preferences(folder),
        system_dialogs=find_system_dialogs() is not None,
    )
    _make(folder, session)
    saving.clear_up(session)
    files.offer_recovery(session)
    if arguments.file is not None:
        files.open_file(session, arguments.file.resolve())
    try:
        Window(session, lambda: Renderer(window_context())).run()
    finally:
        have_ended = session.jobs.close()
        if session.quitting:
            # One that was being written when the person left.
            session.autosave.forget()
        else:
            _keep(session)
        save_preferences(folder, session.preferences)
        if not have_ended:
            # What a worker that never ends uses must not be taken down under it.
            if sys.exception() is not None:
                traceback.print_exc()
            sys.stderr.flush()
            os._exit(0 if session.quitting else EXIT_FAILED)
    return 0


def _make(folder: Path, session: Session) -> None:
    """Make the folder for settings and unsaved work; without one, the window opens all the same."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        session.tell(
            f"Unsaved work and settings cannot be kept: the folder {folder} cannot be made "
            f"({error.strerror}). Save often.",
            tone="error",
        )


def _keep(session: Session) -> None:
    """Keep unsaved work when something else than the person has ended the window."""
    try:
        saving.keep_now(session)
    except EXPECTED_ERRORS as error:
        notice(f"unsaved work could not be kept: {error}")
        return
    if session.project is not None and not session.project.history.is_saved:
        notice("your unsaved work was kept; it is offered when Lissom starts again")

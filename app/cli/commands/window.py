"""`lissom` and `lissom FILE`: the window."""

import argparse
import sys
import time

from app.cli.console import fail
from app.editor import Jobs, Session
from app.editor.actions import files
from app.render import Renderer
from app.render.gpu import window_context
from app.storage import load_preferences, save_preferences, settings_folder
from app.ui.dialogs import find_system_dialogs
from app.ui.window import Window, has_display

# Seconds after which a worker hands Python's lock over. A frame takes it some twenty times; with
# the usual 5 ms a job that seldom lets go would leave two frames a second.
SWITCH = 0.0005


def run(arguments: argparse.Namespace) -> int:
    """Open the window, and close it when the person does."""
    if not has_display():
        fail(
            "there is no display for the window; the command line works without one, for example "
            "'lissom export PROJECT --out DIR'"
        )
    sys.setswitchinterval(SWITCH)
    folder = settings_folder()
    folder.mkdir(parents=True, exist_ok=True)
    session = Session(
        clock=time.perf_counter,
        jobs=Jobs(),
        folder=folder,
        preferences=load_preferences(folder),
        system_dialogs=find_system_dialogs() is not None,
    )
    files.offer_recovery(session)
    if arguments.file is not None:
        files.open_file(session, arguments.file.resolve())
    try:
        Window(session, lambda: Renderer(window_context())).run()
    finally:
        session.jobs.close()
        if session.quitting:
            # One that was being written when the person left.
            session.autosave.forget()
        save_preferences(folder, session.preferences)
    return 0

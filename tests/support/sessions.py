"""Sessions of the editor without a window, and what is waited for in them."""

from pathlib import Path

import numpy as np
from projects import project_of

from app.document import Document
from app.editor import Jobs, Session, pending_changes
from app.editor.actions import playback
from app.editor.actions.updates.frame_update import STEPS
from app.editor.parts.settings import SessionSettings
from engine.arrays import Bytes

BLANK = np.zeros((90, 120, 4), np.uint8)


def run_update_steps(session: Session) -> None:
    """Do what the window does in a frame after a change."""
    for step in STEPS:
        step(session)


def session_of(
    document: Document,
    folder: Path,
    picture: Bytes = BLANK,
    *,
    prepares_ahead: bool = False,
) -> Session:
    """Return a session of a document, at rest, whose clock stands still.

    It prepares only what is shown, or all that the program does.
    """
    project = project_of(document, picture, "blob")
    session = Session(
        clock=lambda: 0.0,
        jobs=Jobs(),
        project=project,
        settings=SessionSettings(folder=folder, prepares_ahead=prepares_ahead),
    )
    settle(session)
    return session


def settle(session: Session) -> None:
    """Let the worker do all that there is to do."""
    while True:
        pending_changes.run_deferred_actions(session)
        run_update_steps(session)
        if not session.jobs.kinds:
            return
        assert session.jobs.wait_until_idle()
        session.jobs.deliver()


def go(session: Session, frame: int) -> None:
    """Move the playhead, and wait for what is shown there."""
    playback.scrub(session, frame)
    settle(session)

"""What the worker does for layers."""

from collections.abc import Callable
from typing import TypeVar

from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.session import Session

T = TypeVar("T")


def put(
    session: Session, kind: str, work: Callable[[], T], done: Callable[[T], None], complaint: str
) -> None:
    """Let the worker do something with a layer, and tell where that fails."""
    session.jobs.put(
        Job(
            kind=kind,
            work=work,
            done=done,
            failed=lambda error: report(session, complaint, error),
        )
    )

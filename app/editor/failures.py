"""Jobs whose failure is told, and how."""

import traceback
from collections.abc import Callable
from functools import partial
from typing import TypeVar

from app.editor.session import Session
from app.editor.work import Job, Kind
from app.errors import EXPECTED_ERRORS

Result = TypeVar("Result")


def sentence(text: str) -> str:
    """Return a text as a sentence; that of an exception begins in lower case, and does not end."""
    begins_with_name = not text.partition(" ")[0].isalpha()
    text = text if begins_with_name else text[:1].upper() + text[1:]
    return text if text.endswith((".", "?", "…")) else f"{text}."


def ask_worker(
    session: Session,
    kind: Kind,
    work: Callable[[], Result],
    done: Callable[[Result], None],
    failed: Callable[[Exception], None] | None = None,
) -> None:
    """Let a worker do something in place of an unfinished job of its kind; tell where it fails."""
    complain = partial(report, session, kind.complaint)
    session.jobs.put(Job(kind=kind, work=work, done=done, failed=failed or complain))


def report_once(session: Session, what: str, error: Exception) -> None:
    """Show what failed that is tried again and again; `mended` lets it be shown anew."""
    if what not in session.failing:
        session.failing.add(what)
        report(session, what, error)


def mended(session: Session, what: str) -> None:
    """Take note that something works that may have failed before."""
    session.failing.discard(what)


def report(session: Session, what: str, error: Exception) -> None:
    """Show what failed, and why; a surprise comes with details to copy."""
    if isinstance(error, EXPECTED_ERRORS):
        session.tell(sentence(f"{what}: {error}"), tone="error")
    else:
        details = "".join(traceback.format_exception(error))
        session.tell(f"{what}.", tone="error", details=details)

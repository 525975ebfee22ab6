"""Promises: what is on its way to the document, and the one verb that waits for it.

Whatever the worker is to bring into the document is promised here first, and stays promised until
it is there, has failed or is given up. Saving, closing, exporting and all else that needs the
document as the person sees it coming asks `once_settled`.
"""

from collections.abc import Callable
from functools import partial
from math import inf
from typing import TypeVar

from app.editor.action import Action
from app.editor.error_reports import report_failure
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work import Afterwards, Job, JobKind, Promise, Pull

Result = TypeVar("Result")


def begin_pending_change(
    session: Session,
    project: Project,
    kind: JobKind,
    work: Callable[[], Result],
    done: Callable[[Result], None],
    failed: Callable[[Exception], None] | None = None,
    *,
    promise: Promise | None = None,
) -> Promise:
    """Let the worker bring something into the document, which is promised until it is there.

    Parameters
    ----------
    kind : JobKind
        Of the job.
    work : callable
        Runs on the worker's thread.
    done : callable
        Takes the result, unless it was given up or the project was closed.
    failed : callable, optional
        Takes the error where that fails; by default it is told.
    promise : Promise, optional
        By default a new one.
    """
    promised = promise or Promise(label=kind.label)
    project.pending.append(promised)

    def arrived(result: Result) -> None:
        if _end_pending_change(session, project, promised):
            done(result)

    def lost(error: Exception) -> None:
        if _end_pending_change(session, project, promised):
            (failed or partial(report_failure, session, kind.complaint))(error)

    session.jobs.add(Job(kind=kind, work=work, done=arrived, failed=lost))
    return promised


def _end_pending_change(session: Session, project: Project, promise: Promise) -> bool:
    """End a promise; tell whether anybody still waits for what it was about."""
    if promise not in project.pending:
        return False
    project.pending.remove(promise)
    return session.project is project


def is_document_idle(project: Project, *, after_saves: bool = False) -> bool:
    """Tell whether nothing is on its way to the document any more.

    With `after_saves`, a save that is under way counts, too.
    """
    if project.stale_layer is not None:
        return False

    def is_over(promise: Promise) -> bool:
        if isinstance(promise, Pull):
            # One that was taken back goes on only for the case that it is done again.
            return promise.is_settled or not promise.is_in(project.history)
        return not (promise.changes or after_saves)

    return all(map(is_over, project.pending))


@with_project
def run_when_idle(
    session: Session,
    project: Project,
    then: Action,
    what: str,
    *,
    changes: bool = True,
    after_saves: bool = False,
    patience: float = inf,
) -> None:
    """Do something as soon as nothing is on its way to the document any more; at once if so.

    Parameters
    ----------
    then : Action
    what : str
        The same in words, for the status bar.
    changes : bool
        Whether it changes the document, and undo takes it back as long as it waits.
    after_saves : bool
        Whether it also waits for a save that is under way.
    patience : float
        Seconds after which it is done whatever is still on its way.
    """
    until = session.clock() + patience
    position = project.history.position if changes else None
    waiting = Afterwards(
        then=then, what=what, after_saves=after_saves, until=until, position=position
    )
    project.afterwards.append(waiting)
    run_deferred_actions(session)


@with_project
def run_deferred_actions(session: Session, project: Project) -> None:
    """Do what has waited for the document, in order, as far as that has settled or time is up."""
    for waiting in tuple(project.afterwards):
        is_due = session.clock() >= waiting.until
        if not (is_due or is_document_idle(project, after_saves=waiting.after_saves)):
            continue
        # What was done just now may have done this, too, or closed the project.
        if waiting in project.afterwards and session.project is project:
            project.afterwards.remove(waiting)
            waiting.then.apply(session)


def cancel_deferred_action(project: Project) -> str | None:
    """Take back the change that waits and was asked for last, if nothing was done since.

    Returns it in words, for the person to be told; None if there is none.
    """
    position = project.history.position
    since = [each for each in project.afterwards if each.position == position]
    if not since:
        return None
    project.afterwards.remove(since[-1])
    return since[-1].what


def deferred_label(project: Project) -> str:
    """Return in words what is done once the document has settled; empty where there is nothing."""
    if not project.afterwards:
        return ""
    return f"{pending_label(project)}, then: {project.afterwards[0].what}"


def pending_label(project: Project) -> str:
    """Return in words what is on its way to the document or the disk."""
    labels = [promise.label for promise in project.pending]
    if project.stale_layer is not None:
        labels.append("Cutting out")
    return ", ".join(dict.fromkeys(labels))

"""Pending changes of the document, and the one verb that waits for them.

Each worker result for the document is first noted here as pending, until it arrives, fails or is
cancelled. Saving, closing, exporting and other actions that need the final document use
`run_when_idle`.
"""

from collections.abc import Callable
from functools import partial
from math import inf
from typing import TypeVar

from app.editor.action import Action, do
from app.editor.error_reports import report_failure
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import Job, JobKind
from app.editor.work.pending_change import DeferredAction, PendingChange
from app.texts import _

Result = TypeVar("Result")


def begin_pending_change(
    session: Session,
    project: Project,
    kind: JobKind,
    work: Callable[[], Result],
    done: Callable[[Result], None],
    failed: Callable[[Exception], None] | None = None,
    *,
    change: PendingChange | None = None,
) -> PendingChange:
    """Start a job that changes the document, and note it as pending until it ends.

    Parameters
    ----------
    done : callable
        Takes the result, unless the change was cancelled or the project was closed.
    failed : callable, optional
        Takes the error of a failure; by default it is reported.
    """
    pending = change or PendingChange(label=kind.label)
    project.pending.add(pending)

    def arrived(result: Result) -> None:
        if _end_pending_change(session, project, pending):
            if not (project.history.is_unfinished and pending.changes):
                done(result)
            else:
                # The drag goes on under the hand.
                run_when_idle(session, do(_call, done, result), pending.label)

    def lost(error: Exception) -> None:
        if _end_pending_change(session, project, pending):
            (failed or partial(report_failure, session, kind.complaint))(error)

    session.jobs.add(Job(kind=kind, work=work, done=arrived, failed=lost))
    return pending


def _call(_: Session, done: Callable[[Result], None], result: Result) -> None:
    done(result)


def _end_pending_change(session: Session, project: Project, change: PendingChange) -> bool:
    """Remove a pending change; return whether its result is still needed."""
    if change not in project.pending.changes:
        return False
    project.pending.remove(change)
    return session.project is project


def cancel_pending_change(session: Session, project: Project, kind: JobKind) -> None:
    """Cancel the pending changes of a kind."""
    session.jobs.drop(kind)
    project.pending.drop(kind.label)


def is_document_idle(project: Project, *, after_saves: bool = False) -> bool:
    """Return whether no change of the document is pending.

    With `after_saves`, a running save counts as well.
    """
    if project.stale_layer is not None or project.history.is_held:
        return False
    return not any(change.changes or after_saves for change in project.pending.changes)


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
    """Run an action as soon as no change of the document is pending; at once if none is.

    Parameters
    ----------
    what : str
        The action's label, for the status bar.
    changes : bool
        Whether it changes the document, so that undo cancels it while it waits.
    after_saves : bool
        Whether it also waits for a running save.
    patience : float
        Seconds after which it runs even if changes are pending.
    """
    until = session.clock() + patience
    position = project.history.position if changes else None
    waiting = DeferredAction(
        then=then, what=what, after_saves=after_saves, until=until, position=position
    )
    project.pending.defer(waiting)
    run_deferred_actions(session)


@with_project
def run_deferred_actions(session: Session, project: Project) -> None:
    """Run waiting actions in order, while the document is idle or their time is up."""
    for waiting in tuple(project.pending.deferred):
        is_due = session.clock() >= waiting.until
        if not (is_due or is_document_idle(project, after_saves=waiting.after_saves)):
            continue
        # The action before may have run this action as well, or closed the project.
        if waiting in project.pending.deferred and session.project is project:
            project.pending.drop_deferred([waiting])
            waiting.then.apply(session)


def cancel_deferred_action(project: Project) -> str | None:
    """Cancel the last waiting action that changes the document, if no edit came since.

    Return its label for a notice; None if there is none.
    """
    position = project.history.position
    since = [each for each in project.pending.deferred if each.position == position]
    if not since:
        return None
    project.pending.drop_deferred(since[-1:])
    return since[-1].what


def deferred_label(project: Project) -> str:
    """Return what waits for a pending change, for the status bar; empty if nothing does."""
    if project.drag is not None and project.drag.is_awaited:
        return project.drag.label
    return with_deferred(project, pending_label(project)) if project.pending.deferred else ""


def with_deferred(project: Project, tasks: str) -> str:
    """Return a text about pending tasks with the action that waits for them, if any."""
    if not project.pending.deferred:
        return tasks
    text = _("{tasks}, then: {action}")
    return text.format(tasks=tasks, action=project.pending.deferred[0].what)


def pending_label(project: Project) -> str:
    """Return the label of a pending change or save."""
    labels = [change.label for change in project.pending.changes]
    if project.history.is_held and project.drag is None:
        labels.append(project.history.undo_label or "")
    if project.stale_layer is not None:
        labels.append(_("Cutting out"))
    return ", ".join(dict.fromkeys(labels))

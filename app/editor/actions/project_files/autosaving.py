"""Autosaves and preferences, which are written when they are due."""

from functools import partial

from app.document import Document
from app.editor import pending_changes
from app.editor.actions.posing.pose_commit import key_pose_command, preview_pose
from app.editor.actions.project_files.saving import has_unsaved_changes
from app.editor.error_reports import report_first_failure, run_job
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.storage import SECONDS, remove_abandoned_files, save_preferences
from app.texts import _

AUTOSAVING = JobKind(_("Autosaving"), _("Unsaved work cannot be autosaved"), "keep")
WRITING = JobKind(_("Saving preferences"), _("The preferences cannot be saved"), "keep")
CLEARING = JobKind(
    _("Cleaning up"), _("Unfinished files of earlier saves were not removed"), "keep"
)


def write_due_files(session: Session) -> None:
    """Write unsaved work and preferences when they are due; once a frame."""
    autosave(session)
    write_preferences(session)


def remove_temporary_files(session: Session) -> None:
    """Remove temporary files of interrupted saves from the person's folders; at the start."""
    folders = {session.settings.folder, *session.settings.preferences.written}

    def work() -> None:
        for folder in folders:
            remove_abandoned_files(folder)

    # The folders may be on a slow disk.
    run_job(session, CLEARING, work, lambda _: None)


def write_preferences(session: Session) -> None:
    """Write the preferences if they have changed."""
    preferences, folder = session.settings.preferences, session.settings.folder
    if preferences == session.settings.saved_preferences:
        return
    session.settings.note_saved()
    run_job(
        session,
        WRITING,
        lambda: save_preferences(folder, preferences),
        lambda _: session.diagnostics.note_success(WRITING.complaint),
        partial(report_first_failure, session, WRITING.complaint),
    )


@with_project
def autosave(session: Session, project: Project) -> None:
    """Write unsaved changes to the autosave at intervals."""
    file = project.file
    if not has_unsaved_changes(project):
        if file.autosaved is not None:
            file.revert_autosave(None)
            session.settings.autosave.remove()
        file.note_unchanged()
        return
    if file.autosaved == (project.document, project.history.preview_pose):
        file.note_unchanged()
        return
    now = session.clock()
    since = file.note_change(now)
    # An autosave would disturb a drag, so it waits for the end of the drag. A very long drag must
    # not delay it for ever.
    may_write = pending_changes.is_document_idle(project) or now - since >= SECONDS
    if is_autosave_due(session) and may_write and AUTOSAVING not in session.jobs.kinds:
        _begin_autosave(session, project, now)


def is_autosave_due(session: Session) -> bool:
    """Return whether there are changes, and the last autosave is some time ago."""
    project = session.project
    if project is None or project.file.changed_at is None:
        return False
    return session.clock() - project.file.autosaved_at >= SECONDS


@with_project
def autosave_now(session: Session, project: Project) -> None:
    """Write unsaved changes to the autosave on this thread, before the program ends.

    Raises
    ------
    LissomError
        If the autosave cannot be written.
    """
    if project.drag is not None and project.drag.newest is not None:
        preview_pose(project, project.drag, project.drag.newest)
    kept = project.document, project.history.preview_pose
    is_kept = project.file.autosaved == kept and AUTOSAVING not in session.jobs.kinds
    if is_kept or not has_unsaved_changes(project):
        return
    # An autosave that waits is older, and must not replace this one.
    session.jobs.drop(AUTOSAVING)
    session.settings.autosave.write(_all_keyed(session, project), project.file.origin)
    project.file.note_autosave(kept, session.clock())


def _all_keyed(session: Session, project: Project) -> Document:
    """Return the document with the unkeyed pose as a key, since files store keys only."""
    unkeyed = project.history.preview_pose
    if unkeyed is None:
        return project.document
    return key_pose_command(session, project, unkeyed)(project.document)


def _begin_autosave(session: Session, project: Project, now: float) -> None:
    document, origin, earlier = (
        _all_keyed(session, project),
        project.file.origin,
        project.file.autosaved,
    )
    kept = project.document, project.history.preview_pose
    project.file.note_autosave(kept, now)

    def done(_: None) -> None:
        session.diagnostics.note_success(AUTOSAVING.complaint)
        # The project may have been saved or closed meanwhile.
        if session.project is not project or project.file.autosaved != kept:
            session.settings.autosave.remove()

    def failed(error: Exception) -> None:
        # The disk may have room again next time.
        if project.file.autosaved == kept:
            project.file.revert_autosave(earlier)
        report_first_failure(session, AUTOSAVING.complaint, error)

    work = partial(session.settings.autosave.write, document, origin)
    run_job(session, AUTOSAVING, work, done, failed)

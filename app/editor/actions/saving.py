"""Saving, autosave, recovery, and the questions before changes are lost."""

from functools import partial
from pathlib import Path

from app.document import Document
from app.editor import pending_changes
from app.editor.action import Action, do
from app.editor.actions import exporting
from app.editor.actions.posing.inserting import insert_key_at
from app.editor.actions.posing.pose_commit import key_pose_command
from app.editor.actions.posing.pose_lifecycle import commit_all_poses
from app.editor.dialogs import FileDialog, Question
from app.editor.error_reports import (
    clear_reported_failure,
    report_failure,
    report_first_failure,
    run_job,
)
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import Job, JobKind
from app.editor.work.promise import Promise
from app.errors import display_name
from app.reports import draw_curves, write_curves
from app.storage import (
    SECONDS,
    FileLock,
    FileLockedError,
    check_writable,
    draw_thumbnail,
    flatten_layers,
    project_digest,
    remove_abandoned_files,
    save_preferences,
    save_project,
    write_atomically,
)
from app.texts import N_, _, message_of

PROJECT = ".lissom"
PATIENCE = 10.0  # seconds that saving and closing wait for pending changes
UNSAVED = _("Unsaved changes")
NOT_FINISHED = N_("Not finished: {tasks}.")
SAVING = JobKind(_("Saving"), _("The project was not saved"), "keep")
AUTOSAVING = JobKind(_("Autosaving"), _("Unsaved work cannot be kept"), "keep")
WRITING = JobKind(_("Saving preferences"), _("The preferences cannot be kept"), "keep")
CLEARING = JobKind(
    _("Clearing up"), _("Unfinished files of earlier saves were not removed"), "keep"
)


def save(session: Session) -> None:
    """Save the project to its own file; ask for a file if it is new or recovered."""
    save_then(session, None)


def save_as(session: Session) -> None:
    _ask_where(session, None)


@with_project
def save_then(session: Session, project: Project, then: Action | None) -> None:
    """Save the project; after success run an action that closes it, such as quit."""
    if project.path is None or project.is_recovered:
        _ask_where(session, then)
    else:
        write_project(session, project.path, then)


def write_project(session: Session, path: Path, then: Action | None) -> None:
    """Save the project to a file as soon as no change is pending.

    A change that arrived after the save would show as unsaved. A second save at the same time would
    take the first save's file for a file of another program.
    """
    writing = do(write_project_now, path, then)
    pending_changes.run_when_idle(
        session, writing, _("Save"), changes=False, after_saves=True, patience=PATIENCE
    )


@with_project
def overwrite_changed_file(
    session: Session, project: Project, path: Path, then: Action | None
) -> None:
    """Save the project to a file, even if another program has changed the file."""
    project.read_as = None
    write_project(session, path, then)


@with_project
def write_project_now(session: Session, project: Project, path: Path, then: Action | None) -> None:
    """Save the project to a file as it is, without waiting for pending changes."""
    document, known = project.document, project.read_as if path == project.path else None
    textures = {
        layer: runtime.cut.value.texture for layer, runtime in project.layer_runtimes.items()
    }
    drawings = tuple(project.drawings)

    def work() -> str:
        if known is not None and project_digest(path) not in (None, known):
            raise _ChangedError
        check_writable(path, sources=drawings)
        picture = flatten_layers(document, textures)
        return save_project(path, document, thumbnail=draw_thumbnail(picture))

    def done(digest: str) -> None:
        project.pending.remove(saving)
        project.history.mark_saved(document)
        project.name, project.path, project.is_recovered = display_name(path.stem), path, False
        project.read_as = digest
        _lock_saved_file(session, project, path)
        session.preferences = session.preferences.with_recent(path)
        session.show_notice(_("Saved {name}.").format(name=path.name), tone="good")
        if then is not None:
            # The project may have new changes by now.
            confirm_unsaved(session, then)

    def failed(error: Exception) -> None:
        project.pending.remove(saving)
        if not isinstance(error, _ChangedError):
            report_failure(session, SAVING.complaint, error)
        elif session.project is project:
            session.dialog = Question(
                title=_("Changed by somebody else"),
                text=_(
                    "{name} is not as it was when you opened or saved it: another window or "
                    "program has changed it since."
                ).format(name=path.name),
                answers=(
                    (_("Save under another name"), do(_ask_where, then)),
                    (_("Replace it"), do(overwrite_changed_file, path, then)),
                ),
            )

    saving = Promise(label=SAVING.label, changes=False)
    project.pending.append(saving)
    session.jobs.add(Job(kind=SAVING, work=work, done=done, failed=failed))


class _ChangedError(Exception):
    """The file has changed since it was opened or saved here."""


def lock_project_file(session: Session, path: Path) -> FileLock | None:
    """Lock a project's file for this window; show a notice if the disk allows no locks.

    Raises
    ------
    FileLockedError
        If the project is open in another window.
    """
    project = session.project
    if project is not None and project.file_lock is not None and project.file_lock.path == path:
        return project.file_lock
    try:
        return FileLock(path)
    except OSError as error:
        reason = error.strerror or str(error)
        session.show_notice(
            _(
                "Whether {name} is open in another window cannot be seen in {folder} ({reason}). "
                "You are asked before it replaces what somebody else has saved."
            ).format(name=path.name, folder=path.parent, reason=reason)
        )
        return None


def set_project(session: Session, project: Project | None) -> None:
    """Open a project in the window, or None; unlock the file of the previous project."""
    before, session.project = session.project, project
    session.active_tool = session.cutting = session.material = None
    session.moves = False
    hold = before.file_lock if before is not None else None
    if hold is not None and (project is None or project.file_lock is not hold):
        hold.release()


def _lock_saved_file(session: Session, project: Project, path: Path) -> None:
    """Lock the file that a project was saved to, in place of the previous file."""
    if session.project is not project or (
        project.file_lock is not None and project.file_lock.path == path
    ):
        return
    before = project.file_lock
    try:
        project.file_lock = lock_project_file(session, path)
    except FileLockedError as error:
        project.file_lock = None
        text = _("{name} is open elsewhere, too: {where}.")
        session.show_notice(text.format(name=path.name, where=message_of(error)), tone="error")
    if before is not None:
        before.release()


def ask_curves_csv(session: Session) -> None:
    _ask_curves(session, ".csv")


def ask_curves_png(session: Session) -> None:
    _ask_curves(session, ".png")


@with_project
def save_curves(session: Session, project: Project, path: Path) -> None:
    """Save the curves as a picture, or as numbers if the name does not end in .png."""
    curves = project.curves.value
    if curves is None:
        return
    check_writable(path, sources=project.sources)
    if path.suffix.lower() == ".png":
        picture = draw_curves(curves)
        write_atomically(path, lambda file: file.write(picture))
    else:
        write_curves(path, curves)
    session.show_notice(_("Saved {name}.").format(name=path.name), tone="good")


@with_project
def _ask_curves(session: Session, project: Project, suffix: str) -> None:
    name = _("{project} distortion").format(project=project.name) + suffix
    session.ask_file(_("Save the curves"), (suffix,), lambda path: do(save_curves, path), name=name)


def confirm_unsaved(session: Session, then: Action) -> None:
    """Run an action that closes the project, but ask first if it has changes.

    Pending changes and saves finish first, for at most `PATIENCE` seconds.
    """
    project = session.project
    if project is None:
        then.apply(session)
        return
    asked = [each for each in project.afterwards if _asks_about(each.then, then)]
    if asked:
        project.afterwards = [each for each in project.afterwards if each not in asked]
        ask_unsaved_now(session, then)
        return
    if not pending_changes.is_document_idle(project, after_saves=True):
        text = _("Lissom finishes first: {tasks}.")
        session.show_notice(
            text.format(tasks=pending_changes.pending_label(project)), topic="settling"
        )
    asking = do(ask_unsaved_now, then)
    pending_changes.run_when_idle(
        session, asking, _("Close"), changes=False, after_saves=True, patience=PATIENCE
    )


def _asks_about(waiting: Action, then: Action) -> bool:
    """Return whether a waiting action is the question before the action `then`."""
    return waiting.verb is ask_unsaved_now and waiting.arguments[0].verb is then.verb


@with_project
def ask_unsaved_now(session: Session, project: Project, then: Action) -> None:
    """Run an action that closes the project, but ask first if it has changes now."""
    unkeyed = project.history.preview_pose
    is_settled = pending_changes.is_document_idle(project, after_saves=True)
    if is_settled and not has_unsaved_changes(project):
        then.apply(session)
        return
    if project.path:
        sentences = [_("{name} has changes that are not saved.").format(name=project.path.name)]
    else:
        sentences = [_("This project has changes that are not saved.")]
    save = do(save_then, then)
    if not is_settled:
        unfinished = pending_changes.pending_label(project)
        sentences.append(_(NOT_FINISHED).format(tasks=unfinished))
    if unkeyed is not None:
        text = _("The pose at frame {frame} is in no key: saving makes a key of it.")
        sentences.append(text.format(frame=unkeyed.frame))
        save = do(key_and_save, then)
    session.dialog = Question(
        title=UNSAVED,
        text=" ".join(sentences),
        answers=((_("Save"), save), (_("Don't save"), then)),
    )


@with_project
def key_and_save(session: Session, project: Project, then: Action) -> None:
    """Key the unkeyed pose, and save the project."""
    unkeyed = project.history.preview_pose
    if unkeyed is not None:
        insert_key_at(session, unkeyed.layer, unkeyed.frame)
    save_then(session, then)


def close_project(session: Session) -> None:
    """Go back to the welcome view; ask first if there are changes."""
    confirm_unsaved(session, do(discard_project))


def discard_project(session: Session) -> None:
    """Close the project and drop its changes."""
    set_project(session, None)
    session.autosave.remove()


def request_quit(session: Session) -> None:
    """Close the window; ask first if an export runs or there are changes."""
    exporting.confirm_ending_export(session, do(confirm_unsaved, do(close_window)))


def close_window(session: Session) -> None:
    session.autosave.remove()
    if session.project is not None and session.project.file_lock is not None:
        session.project.file_lock.release()
        session.project.file_lock = None
    session.is_quitting = True


def write_due_files(session: Session) -> None:
    """Write unsaved work and preferences when they are due; once a frame."""
    autosave(session)
    write_preferences(session)


def remove_temporary_files(session: Session) -> None:
    """Remove temporary files of interrupted saves from the person's folders; at the start."""
    folders = {session.folder, *session.preferences.written}

    def work() -> None:
        for folder in folders:
            remove_abandoned_files(folder)

    # The folders may be on a slow disk.
    run_job(session, CLEARING, work, lambda _: None)


def write_preferences(session: Session) -> None:
    """Write the preferences if they have changed."""
    preferences, folder = session.preferences, session.folder
    if preferences == session.saved_preferences:
        return
    session.saved_preferences = preferences
    run_job(
        session,
        WRITING,
        lambda: save_preferences(folder, preferences),
        lambda _: clear_reported_failure(session, WRITING.complaint),
        partial(report_first_failure, session, WRITING.complaint),
    )


@with_project
def autosave(session: Session, project: Project) -> None:
    """Write unsaved changes to the autosave at intervals."""
    if not has_unsaved_changes(project):
        if project.autosaved is not None:
            project.autosaved = None
            session.autosave.remove()
        project.changed_at = None
        return
    if project.autosaved == (project.document, project.history.preview_pose):
        project.changed_at = None
        return
    now = session.clock()
    if project.changed_at is None:
        project.changed_at = now
    # An autosave would disturb a drag, so it waits for the end of the drag. A very long drag must
    # not delay it for ever.
    may_write = pending_changes.is_document_idle(project) or now - project.changed_at >= SECONDS
    is_due = now - project.autosaved_at >= SECONDS
    if is_due and may_write and AUTOSAVING not in session.jobs.kinds:
        _begin_autosave(session, project, now)


@with_project
def autosave_now(session: Session, project: Project) -> None:
    """Write unsaved changes to the autosave on this thread, before the program ends.

    Raises
    ------
    LissomError
        If the autosave cannot be written.
    """
    commit_all_poses(session, project)
    kept = project.document, project.history.preview_pose
    is_kept = project.autosaved == kept and AUTOSAVING not in session.jobs.kinds
    if is_kept or not has_unsaved_changes(project):
        return
    # An autosave that waits is older, and must not replace this one.
    session.jobs.drop(AUTOSAVING)
    session.autosave.write(_all_keyed(session, project), project.origin)
    project.autosaved, project.autosaved_at = kept, session.clock()


def has_unsaved_changes(project: Project) -> bool:
    """Return whether there are changes that no file has; an unkeyed pose is a change."""
    return not project.history.is_saved or project.history.preview_pose is not None


def _all_keyed(session: Session, project: Project) -> Document:
    """Return the document with the unkeyed pose as a key, since files store keys only."""
    unkeyed = project.history.preview_pose
    if unkeyed is None:
        return project.document
    return key_pose_command(session, project, unkeyed)(project.document)


def _begin_autosave(session: Session, project: Project, now: float) -> None:
    document, origin, earlier = _all_keyed(session, project), project.origin, project.autosaved
    kept = project.document, project.history.preview_pose
    project.autosaved, project.autosaved_at = kept, now

    def done(_: None) -> None:
        clear_reported_failure(session, AUTOSAVING.complaint)
        # The project may have been saved or closed meanwhile.
        if session.project is not project or project.autosaved != kept:
            session.autosave.remove()

    def failed(error: Exception) -> None:
        # The disk may have room again next time.
        if project.autosaved == kept:
            project.autosaved = earlier
        report_first_failure(session, AUTOSAVING.complaint, error)

    work = partial(session.autosave.write, document, origin)
    run_job(session, AUTOSAVING, work, done, failed)


@with_project
def _ask_where(session: Session, project: Project, then: Action | None) -> None:
    session.dialog = FileDialog(
        title=_("Save the project"),
        folder=project.path.parent if project.path else session.usual_folder,
        name=project.path.name if project.path else f"{project.name}{PROJECT}",
        suffixes=(PROJECT,),
        writes=True,
        chosen=lambda path: do(write_project, path, then),
    )

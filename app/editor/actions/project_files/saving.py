"""Saving, autosave, recovery, and the questions before changes are lost."""

from pathlib import Path

from app.editor import pending_changes
from app.editor.action import Action, do
from app.editor.actions.action_spec import named_action
from app.editor.actions.posing.inserting import insert_key_at
from app.editor.actions.project_files import exporting
from app.editor.error_reports import report_failure
from app.editor.parts.dialogs import FileDialog
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import Job, JobKind
from app.editor.work.pending_change import PendingChange
from app.storage import (
    FileLock,
    FileLockedError,
    check_writable,
    draw_thumbnail,
    flatten_layers,
    project_digest,
    save_project,
)
from app.texts import N_, _, message_of

PROJECT = ".lissom"
PATIENCE = 10.0  # seconds that saving and closing wait for pending changes
UNSAVED = _("Unsaved changes")
NOT_FINISHED = N_("Not finished: {tasks}.")
SAVING = JobKind(_("Saving"), _("The project was not saved"), "keep")


@named_action(_("Save"), "Ctrl+S")
def save(session: Session) -> None:
    """Save the project to its own file; ask for a file if it is new or recovered."""
    save_then(session, None)


@named_action(_("Save as…"), "Ctrl+Shift+S")
def save_as(session: Session) -> None:
    _ask_where(session, None)


@with_project
def save_then(session: Session, project: Project, then: Action | None) -> None:
    """Save the project; after success run an action that closes it, such as quit."""
    if project.file.path is None or project.file.is_recovered:
        _ask_where(session, then)
    else:
        write_project(session, project.file.path, then)


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
    project.file.forget_digest()
    write_project(session, path, then)


@with_project
def write_project_now(session: Session, project: Project, path: Path, then: Action | None) -> None:
    """Save the project to a file as it is, without waiting for pending changes."""
    document, known = project.document, project.file.digest if path == project.file.path else None
    textures = {
        layer: runtime.cut.value.texture for layer, runtime in project.runtimes.layers.items()
    }
    drawings = tuple(project.file.drawings)

    def work() -> str:
        if known is not None and project_digest(path) not in (None, known):
            raise _ChangedError
        check_writable(path, sources=drawings)
        picture = flatten_layers(document, textures)
        return save_project(path, document, thumbnail=draw_thumbnail(picture))

    def done(digest: str) -> None:
        project.pending.remove(saving)
        project.history.mark_saved(document)
        project.file.note_saved(path, digest)
        _lock_saved_file(session, project, path)
        session.settings.add_recent(path)
        session.notices.show(_("Saved {name}.").format(name=path.name), tone="good")
        if then is not None:
            # The project may have new changes by now.
            confirm_unsaved(session, then)

    def failed(error: Exception) -> None:
        project.pending.remove(saving)
        if not isinstance(error, _ChangedError):
            report_failure(session, SAVING.complaint, error)
        elif session.project is project:
            session.dialogs.ask(
                title=_("Changed elsewhere"),
                text=_(
                    "Another window or program has changed {name} since you opened or saved it."
                ).format(name=path.name),
                answers=(
                    (_("Save as…"), do(_ask_where, then)),
                    (_("Replace"), do(overwrite_changed_file, path, then)),
                ),
            )

    saving = PendingChange(label=SAVING.label, changes=False)
    project.pending.add(saving)
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
    if project is not None and project.file.is_locked_for(path):
        return project.file.lock
    try:
        return FileLock(path)
    except OSError as error:
        reason = error.strerror or str(error)
        session.notices.show(
            _(
                "Lissom cannot tell whether {name} in {folder} is open elsewhere ({reason}). "
                "It asks before it replaces another person's changes."
            ).format(name=path.name, folder=path.parent, reason=reason)
        )
        return None


def set_project(session: Session, project: Project | None) -> None:
    """Open a project in the window, or None; unlock the file of the previous project."""
    before = session.project
    session.put_project(project)
    hold = before.file.lock if before is not None else None
    if hold is not None and (project is None or project.file.lock is not hold):
        hold.release()


def _lock_saved_file(session: Session, project: Project, path: Path) -> None:
    """Lock the file that a project was saved to, in place of the previous file."""
    if session.project is not project or project.file.is_locked_for(path):
        return
    lock = None
    try:
        lock = lock_project_file(session, path)
    except FileLockedError as error:
        text = _("{name} is also open elsewhere: {where}.")
        session.notices.show(text.format(name=path.name, where=message_of(error)), tone="error")
    project.file.replace_lock(lock)


def confirm_unsaved(session: Session, then: Action) -> None:
    """Run an action that closes the project, but ask first if it has changes.

    Pending changes and saves finish first, for at most `PATIENCE` seconds.
    """
    project = session.project
    if project is None:
        then.apply(session)
        return
    asked = [each for each in project.pending.deferred if _asks_about(each.then, then)]
    if asked:
        project.pending.drop_deferred(asked)
        ask_unsaved_now(session, then)
        return
    if not pending_changes.is_document_idle(project, after_saves=True):
        text = _("Lissom finishes first: {tasks}.")
        session.notices.show(
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
    if project.file.path:
        sentences = [
            _("{name} has changes that are not saved.").format(name=project.file.path.name)
        ]
    else:
        sentences = [_("This project has changes that are not saved.")]
    save = do(save_then, then)
    if not is_settled:
        unfinished = pending_changes.pending_label(project)
        sentences.append(_(NOT_FINISHED).format(tasks=unfinished))
    if unkeyed is not None:
        text = _("The pose at frame {frame} has no key yet. Saving sets a key.")
        sentences.append(text.format(frame=unkeyed.frame))
        save = do(key_and_save, then)
    session.dialogs.ask(
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


@named_action(_("Close"), "Ctrl+W")
def close_project(session: Session) -> None:
    """Go back to the welcome view; ask first if there are changes."""
    confirm_unsaved(session, do(discard_project))


def discard_project(session: Session) -> None:
    """Close the project and drop its changes."""
    set_project(session, None)
    session.settings.autosave.remove()


@named_action(_("Quit"), "Ctrl+Q", needs_project=False)
def request_quit(session: Session) -> None:
    """Close the window; ask first if an export runs or there are changes."""
    exporting.confirm_ending_export(session, do(confirm_unsaved, do(close_window)))


def close_window(session: Session) -> None:
    session.settings.autosave.remove()
    if session.project is not None:
        session.project.file.replace_lock(None)
    session.quit()


def has_unsaved_changes(project: Project) -> bool:
    """Return whether there are changes that no file has; an unkeyed pose is a change."""
    is_saved = project.history.is_saved and project.drag is None
    return not is_saved or project.history.preview_pose is not None


@with_project
def _ask_where(session: Session, project: Project, then: Action | None) -> None:
    session.dialogs.show(
        FileDialog(
            title=_("Save the project"),
            folder=project.file.path.parent if project.file.path else session.settings.usual_folder,
            name=project.file.path.name if project.file.path else f"{project.file.name}{PROJECT}",
            suffixes=(PROJECT,),
            writes=True,
            chosen=lambda path: do(write_project, path, then),
        )
    )

"""Saving, and what must not be lost: questions before, autosave, recovery."""

from pathlib import Path

from app.editor.action import Action, do
from app.editor.actions import exporting
from app.editor.dialogs import FileDialog, Question
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.project import Project
from app.editor.session import Session
from app.reports import draw_curves, write_curves
from app.storage import (
    SECONDS,
    draw_thumbnail,
    flattened,
    save_preferences,
    save_project,
    write_atomically,
)

PROJECT = ".lissom"
SAVING, AUTOSAVING, WRITING = "Saving", "Autosaving", "Saving preferences"


def save(session: Session) -> None:
    """Save the project where it was saved or opened; ask where if it is new or recovered."""
    save_then(session, None)


def save_as(session: Session) -> None:
    """Ask where to save the project."""
    _ask_where(session, None)


def save_then(session: Session, then: Action | None) -> None:
    """Save the project, and do something that gives it up once that has worked."""
    project = session.project
    if project is None:
        return
    if project.path is None or project.is_recovered:
        _ask_where(session, then)
    else:
        write(session, project.path, then)


def write(session: Session, path: Path, then: Action | None) -> None:
    """Save the project in a file."""
    project = session.project
    if project is None:
        return
    if project.is_posing and not (project.posing is not None and project.posing.is_held):
        # To settle afterwards would be a change again, which nobody made.
        project.to_save = (path, then)
        return
    document = project.document
    textures = {figure: puppet.cut.value.texture for figure, puppet in project.puppets.items()}

    def work() -> None:
        picture = flattened(document, textures)
        save_project(path, document, thumbnail=draw_thumbnail(picture))

    def done(_: None) -> None:
        project.history.mark_saved(document)
        project.name, project.path, project.is_recovered = path.stem, path, False
        session.preferences = session.preferences.with_recent(path)
        session.tell(f"Saved {path.name}.", tone="good")
        if then is not None:
            # There may be changes again.
            unless_unsaved(session, then)

    session.jobs.put(
        Job(
            kind=SAVING,
            work=work,
            done=done,
            failed=lambda error: report(session, "The project was not saved", error),
            lane="hand",
        )
    )


def ask_curves_csv(session: Session) -> None:
    """Ask where to save the curves of the distortion as numbers."""
    _ask_curves(session, ".csv")


def ask_curves_png(session: Session) -> None:
    """Ask where to save the curves of the distortion as a picture."""
    _ask_curves(session, ".png")


def save_curves(session: Session, path: Path) -> None:
    """Save the curves as a picture, or as numbers if the name does not end in .png."""
    curves = session.project.curves.value if session.project else None
    if curves is None:
        return
    if path.suffix.lower() == ".png":
        picture = draw_curves(curves)
        write_atomically(path, lambda file: file.write(picture))
    else:
        write_curves(path, curves)
    session.tell(f"Saved {path.name}.", tone="good")


def _ask_curves(session: Session, suffix: str) -> None:
    project = session.project
    if project is None:
        return
    session.dialog = FileDialog(
        title="Save the curves",
        folder=session.usual_folder,
        name=f"{project.name} distortion{suffix}",
        suffixes=(suffix,),
        writes=True,
        chosen=lambda path: do(save_curves, path),
    )


def unless_unsaved(session: Session, then: Action) -> None:
    """Do something that gives up the project, but ask first if it has changes."""
    project = session.project
    if project is None or project.history.is_saved:
        then.apply(session)
        return
    name = project.path.name if project.path else "This project"
    session.dialog = Question(
        title="Unsaved changes",
        text=f"{name} has changes that are not saved.",
        answers=(("Save", do(save_then, then)), ("Don't save", then)),
    )


def close(session: Session) -> None:
    """Go back to the welcome view, after a question if there are changes."""
    unless_unsaved(session, do(give_up))


def give_up(session: Session) -> None:
    """Close the project, whatever it holds."""
    session.project = session.pointer = session.cutting = None
    session.autosave.forget()


def quit_lissom(session: Session) -> None:
    """Close the window, after questions if an export is under way or there are changes."""
    exporting.unless_running(session, do(unless_unsaved, do(leave)))


def leave(session: Session) -> None:
    """Close the window."""
    session.autosave.forget()
    session.quitting = True


def maintain(session: Session) -> None:
    """Write what is due: a project that has settled, unsaved work, preferences; once a frame."""
    project = session.project
    if project is not None and not project.is_posing and project.to_save is not None:
        path, then = project.to_save
        project.to_save = None
        write(session, path, then)
    autosave(session)
    write_preferences(session)


def write_preferences(session: Session) -> None:
    """Write the preferences when they have changed."""
    preferences, folder = session.preferences, session.folder
    if preferences == session.saved_preferences:
        return
    session.saved_preferences = preferences
    session.jobs.put(
        Job(
            kind=WRITING,
            work=lambda: save_preferences(folder, preferences),
            done=lambda _: None,
            failed=lambda error: report(session, "The preferences cannot be kept", error),
            lane="hand",
        )
    )


def autosave(session: Session) -> None:
    """Keep changes that are not saved, every now and then."""
    project = session.project
    now = session.clock()
    if project is None or project.is_posing:
        return
    if project.history.is_saved:
        if project.autosaved is not None:
            project.autosaved = None
            session.autosave.forget()
        return
    is_due = now - project.autosaved_at >= SECONDS and project.autosaved is not project.document
    if is_due and AUTOSAVING not in session.jobs.kinds:
        _autosave_now(session, project, now)


def _autosave_now(session: Session, project: Project, now: float) -> None:
    document, origin = project.document, project.origin
    project.autosaved, project.autosaved_at = document, now

    def done(_: None) -> None:
        # In the meantime it may have been saved, or closed.
        if session.project is not project or project.autosaved is not document:
            session.autosave.forget()

    session.jobs.put(
        Job(
            kind=AUTOSAVING,
            work=lambda: session.autosave.write(document, origin),
            done=done,
            failed=lambda error: report(session, "Unsaved work cannot be kept", error),
        )
    )


def _ask_where(session: Session, then: Action | None) -> None:
    project = session.project
    if project is None:
        return
    session.dialog = FileDialog(
        title="Save the project",
        folder=project.path.parent if project.path else session.usual_folder,
        name=project.path.name if project.path else f"{project.name}{PROJECT}",
        suffixes=(PROJECT,),
        writes=True,
        chosen=lambda path: do(write, path, then),
    )

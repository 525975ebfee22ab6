"""Drawings whose files changed: found, compared, and reloaded under their rigs."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path

from app.document import Document, DrawingFile, clip_of
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions.action_spec import named_action
from app.editor.actions.layer_setup.layer_runtimes import update_layer_runtimes
from app.editor.actions.project_files.files import PICTURES
from app.editor.error_reports import as_sentence
from app.editor.parts.dialogs import ReloadDialog
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import Job, JobKind
from app.editor.work.layer_runtime import LayerRuntime
from app.editor.work.pending_change import PendingChange
from app.errors import few_notices
from app.solving import (
    Change,
    Reloading,
    ReloadPlan,
    find_drawing,
    plan_reload,
    start_reload,
    step_reload,
)
from app.storage import LAYERED, Picture, file_time, read_drawing, read_file
from app.texts import _

READING = JobKind(_("Comparing the drawing"), _("The drawing was not reloaded"))
RELOADING = JobKind(_("Reloading the drawing"), _("The drawing was not reloaded"))
LOOKING = JobKind(_("Looking for changes of the file"), _("The file was not read"), "keep")
CHANGED = _("The project changed meanwhile, so the drawing was not reloaded. Start again.")


@named_action(
    _("Reload drawing"),
    "Ctrl+Shift+R",
    hint=_("Read the changed file of the drawing again, and keep handles, keys and joints"),
)
@with_project
def reload_drawing(session: Session, project: Project) -> None:
    """Compare the drawing of the active layer with its file, and ask before anything changes."""
    drawing = _drawing_of(project)
    path = None if drawing is None else find_file(session, project, drawing)
    if path is None:
        ask_changed_file(session)
    else:
        compare_drawing(session, path)


@with_project
def ask_changed_file(session: Session, project: Project, *only: int) -> None:
    """Ask for the changed file of a drawing; only some layers may be reloaded."""
    drawing = _drawing_of(project)
    name = project.file.name if drawing is None else drawing.name
    session.ask_file(
        _("Reload {name}").format(name=name),
        (*LAYERED, *PICTURES),
        lambda path: do(compare_drawing, path, *only),
    )


@with_project
def reload_layers(session: Session, project: Project, *identities: int) -> None:
    """Compare only these layers with their file."""
    drawing = project.document.drawing_of(project.document.layer(identities[0]))
    path = None if drawing is None else find_file(session, project, drawing)
    if path is None:
        ask_changed_file(session, *identities)
    else:
        compare_drawing(session, path, *identities)


def compare_drawing(session: Session, path: Path, *only: int) -> None:
    """Read a changed file on the worker, and show its changes in a dialog."""
    pending_changes.run_when_idle(session, do(_compare, path, *only), _("Reload drawing"))


@with_project
def _compare(session: Session, project: Project, path: Path, *only: int) -> None:
    document = project.document
    pictures = _pictures(project)
    active = document.drawing_of(document.layer(only[0] if only else project.selection.active))

    def work() -> ReloadPlan:
        drawing = active or find_drawing(document, path.name)
        changed = read_drawing(path, is_merged=drawing.is_merged)
        return plan_reload(document, drawing, changed, pictures, only=only or None)

    def done(plan: ReloadPlan) -> None:
        project.file.add_drawings(path)
        if plan.is_empty:
            session.notices.show(_("{name} has not changed.").format(name=path.name))
        else:
            session.dialogs.show(ReloadDialog(path=path, plan=plan, document=document))

    change = PendingChange(label=READING.label, changes=False)
    pending_changes.begin_pending_change(session, project, READING, work, done, change=change)


@with_project
def begin_reload(session: Session, project: Project, dialog: ReloadDialog) -> None:
    """Reload a drawing whose changes were shown."""
    if project.document is not dialog.document:
        session.notices.show(CHANGED, tone="error")
        return
    _go_on(session, project, dialog.document, lambda: start_reload(dialog.plan))


def _go_on(
    session: Session, project: Project, before: Document, step: Callable[[], Reloading]
) -> None:
    def work() -> tuple[Reloading, _Reloaded | None]:
        reloading = step()
        return reloading, _Reloaded.of(reloading, before) if reloading.is_over else None

    def done(made: tuple[Reloading, _Reloaded | None]) -> None:
        reloading, reloaded = made
        if project.document is not before:
            session.notices.show(CHANGED, tone="error")
        elif reloaded is None:
            _go_on(session, project, before, lambda: step_reload(reloading))
        else:
            _accept(session, project, reloading, reloaded)

    pending_changes.begin_pending_change(session, project, RELOADING, work, done)


def _accept(
    session: Session, project: Project, reloading: Reloading, reloaded: "_Reloaded"
) -> None:
    """Make a finished reload one undo step."""
    gesture = object()
    for file, picture in reloading.pictures.items():
        project.runtimes.keep_picture(file, picture)
    project.history.do(
        replace(reloading.command, change=lambda _: reloaded.document), gesture=gesture
    )
    project.history.set_preview_pose(None, gesture=gesture)
    for identity, runtime in reloaded.runtimes.items():
        project.runtimes.put(identity, runtime)
    update_layer_runtimes(project)
    plan = reloading.plan
    counts = [
        text.format(count=count)
        for text, count in (
            (_("{count} redrawn"), plan.count(Change.REDRAWN, Change.REDRAWN_AND_MOVED)),
            (_("{count} moved"), plan.count(Change.MOVED)),
            (_("{count} new"), plan.count(Change.NEW)),
            (_("{count} gone"), plan.count(Change.GONE)),
        )
        if count
    ]
    text = _("Reloaded {name}: {counts}.").format(
        name=plan.now.name, counts=", ".join(counts) or _("only settings changed")
    )
    session.notices.show(text, tone="good", topic=f"changed {plan.now.name}")
    for notice in few_notices(reloading.all_notices):
        session.notices.show(as_sentence(notice))


@dataclass(frozen=True, slots=True, eq=False)
class _Reloaded:
    """The document after a reload, and runtimes of the layers with other pictures."""

    document: Document
    runtimes: Mapping[int, LayerRuntime]

    @classmethod
    def of(cls, reloading: Reloading, before: Document) -> "_Reloaded":
        after, pictures = reloading.command(before), reloading.pictures
        # Each takes a tenth of a second, so they are made on the worker and not in the window.
        runtimes = {
            layer.id: LayerRuntime.of(
                clip_of(after, layer.id), pictures[layer.picture], among=len(after.layers)
            )
            for layer in after.layers
            if layer.picture in pictures
        }
        return cls(after, runtimes)


def _drawing_of(project: Project) -> DrawingFile | None:
    """Return the drawing of the active layer, or the only one."""
    document = project.document
    found = document.drawing_of(project.layer)
    return document.drawings[0] if found is None and len(document.drawings) == 1 else found


def find_file(session: Session, project: Project, drawing: DrawingFile) -> Path | None:
    """Return the file of a drawing: where it was opened, or else beside the project."""
    folders = [] if project.file.path is None else [project.file.path.parent]
    likely = [
        *project.file.drawings,
        *(folder / drawing.name for folder in folders),
        *session.settings.preferences.recent,
    ]
    return next((path for path in likely if path.name == drawing.name and file_time(path)), None)


def _pictures(project: Project) -> dict[int, Picture]:
    return {identity: each.picture for identity, each in project.runtimes.layers.items()}


@with_project
def watch_drawings(session: Session, project: Project) -> None:
    """Offer to reload drawings whose files have changed; called every few seconds."""
    for drawing in project.document.drawings:
        path = find_file(session, project, drawing)
        if path is None:
            continue
        time = file_time(path)
        if time != project.file.times.get(path):
            project.file.note_time(path, time)
            _look(session, project, drawing, path)


def _look(session: Session, project: Project, drawing: DrawingFile, path: Path) -> None:
    """Offer a reload if the contents of a file have changed."""

    def work() -> bool:
        return sha256(read_file(path)).hexdigest() != drawing.sha256

    def done(*, has_changed: bool) -> None:
        if has_changed and session.project is project and drawing in project.document.drawings:
            session.notices.show(
                _("{name} has changed.").format(name=path.name),
                topic=f"changed {path.name}",
                label=_("Reload…"),
                action=do(compare_drawing, path),
            )

    # A file that is just being written is looked at again when its time changes.
    job = Job(kind=LOOKING, work=work, done=lambda found: done(has_changed=found), failed=_ignore)
    session.jobs.add(job)


def _ignore(_: Exception) -> None:
    """Leave a file that cannot be read alone: nobody asked for it."""

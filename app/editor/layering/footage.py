"""Footage as layers and references: added, found again, and reloaded."""

from dataclasses import replace
from pathlib import Path

from app.document import (
    Footage,
    FrameRange,
    Layer,
    clip_of,
    combine_commands,
    footage_commands,
    layer_commands,
    scene_commands,
)
from app.editor import pending_changes
from app.editor.action import Action, do
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action
from app.editor.actions.layer_setup.layer_runtimes import update_layer_runtimes
from app.editor.actions.project_files.files import PICTURES
from app.editor.error_reports import as_sentence, run_job
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.reloading import watch_drawings
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.layer_runtime import LayerRuntime
from app.errors import LissomError, display_name
from app.storage import (
    VIDEOS,
    OpenedFootage,
    copy_footage,
    file_time,
    inspect_footage,
    make_footage_layer,
    require_memory,
)
from app.texts import _

ADDING_FOOTAGE = JobKind(_("Adding footage"), _("The footage cannot be added"))
FINDING = JobKind(_("Finding footage"), _("The footage was not replaced"))
COLLECTING = JobKind(_("Copying footage"), _("The footage was not copied"), "keep")
MOVING = (*VIDEOS, *PICTURES)
# Numbered pictures whose times are compared; of more, only the folder's.
MOST_WATCHED = 500
OTHER_FOOTAGE = _(
    "{name} has {width} × {height} pixels, but the footage of {layer} has another size"
)


@named_action(
    _("Add footage…"),
    icon="FILM",
    hint=_("Add a video, an animated picture or numbered pictures as a layer"),
)
def ask_footage_to_add(session: Session) -> None:
    session.ask_file(_("Add footage"), MOVING, lambda path: do(add_footage, path))


@named_action(
    _("Add reference…"),
    icon="CLAPPERBOARD",
    hint=_("Add footage to work after: dimmed, locked, and left out of exports"),
)
def ask_reference_to_add(session: Session) -> None:
    title = _("Add a reference")
    session.ask_file(title, MOVING, lambda path: do(add_footage, path, is_reference=True))


@with_project
def add_footage(
    session: Session, project: Project, path: Path, *, is_reference: bool = False
) -> None:
    """Read footage on the worker, and add it in front of all layers, from the playhead on."""
    before, start = project.document, playback.current_frame(session, project)
    start = before.frames.clamp(start)

    def work() -> tuple[OpenedFootage, Layer, LayerRuntime]:
        opened = inspect_footage(path, before.fps)
        require_memory([*(layer.picture.size for layer in before.layers), opened.footage.size])
        width, height = (
            (ours - its) // 2 for ours, its in zip(before.canvas, opened.footage.size, strict=True)
        )
        layer = make_footage_layer(opened, start, complex(width, height), is_reference=is_reference)
        layer = replace(layer, id=layer_commands.next_layer_id(before))
        document = layer_commands.add_layer(layer)(before)
        return opened, layer, LayerRuntime.of(clip_of(document, layer.id), opened.first)

    def done(made: tuple[OpenedFootage, Layer, LayerRuntime]) -> None:
        opened, layer, runtime = made
        identity = layer_commands.next_layer_id(project.document)
        project.runtimes.keep_picture(layer.picture, opened.first)
        project.history.do(layer_commands.add_layer(replace(layer, id=identity)))
        if identity == layer.id:
            project.runtimes.put(identity, runtime)
        update_layer_runtimes(project)
        set_active_layer(session, identity)
        session.display.focus_panel("Layers")
        for notice in opened.notices:
            session.notices.show(as_sentence(notice))
        _show_added(session, project, opened.footage, start)

    pending_changes.begin_pending_change(session, project, ADDING_FOOTAGE, work, done)


def _show_added(session: Session, project: Project, footage: Footage, start: int) -> None:
    """Say how long added footage is, and offer to extend a shorter scene."""
    text = _("Added {name}: {seconds:.1f} s, {fps:.4g} frames a second.")
    shown = text.format(name=footage.name, seconds=footage.seconds, fps=footage.fps)
    document = project.document
    last = start + max(round(footage.seconds * document.fps) - 1, 0)
    if last <= document.frames.last:
        session.notices.show(shown, tone="good")
        return
    frames = FrameRange(document.frames.first, last)
    session.notices.show(
        shown
        + " "
        + _("The scene ends before it, at frame {last}.").format(last=document.frames.last),
        tone="good",
        label=_("Extend scene"),
        action=do(editing.edit_document, scene_commands.set_frames(frames)),
    )


@with_project
def ask_footage_files(session: Session, project: Project, identity: int) -> None:
    """Ask where the files of a layer's footage are."""
    layer = project.document.layer(identity)
    title = _("Find the footage of {layer}").format(layer=layer.name)
    session.ask_file(title, MOVING, lambda path: do(replace_footage, identity, path))


@with_project
def replace_footage(session: Session, project: Project, identity: int, path: Path) -> None:
    """Give a layer other footage; other layers with missing files look for them there, too."""
    layer = project.document.layer(identity)
    old = layer.footage
    if old is None:
        return

    def work() -> OpenedFootage:
        opened = inspect_footage(path, old.fps)
        width, height = opened.footage.size
        if (width, height) != old.size:
            text = OTHER_FOOTAGE.format(
                name=opened.footage.name, width=width, height=height, layer=layer.name
            )
            raise LissomError(text)
        return opened

    def done(opened: OpenedFootage) -> None:
        found = opened.footage
        changes = {old: found}
        for other in {each.footage for each in project.document.layers} - {None, old}:
            if other is not None and _is_missing(other):
                moved = replace(other, folder=found.folder)
                changes |= {} if _is_missing(moved) else {other: moved}
        _change_footage(session, project, changes)
        for notice in opened.notices:
            session.notices.show(as_sentence(notice))

    run_job(session, FINDING, work, done)


def _change_footage(session: Session, project: Project, changes: dict[Footage, Footage]) -> None:
    """Replace footage in all layers, in one undo step, and read it anew."""
    commands = [
        footage_commands.set_footage(layer.id, changes[layer.footage])
        for layer in project.document.layers
        if layer.footage in changes and changes[layer.footage] != layer.footage
    ]
    for old, new in changes.items():
        project.footage.forget(old)
        project.footage.forget(new)
    if commands:
        editing.edit_document(session, combine_commands(_("Replace footage"), commands))


def _is_missing(footage: Footage) -> bool:
    return not all(Path(footage.folder, name).is_file() for name in footage.files)


@with_project
def reload_footage(session: Session, project: Project, identity: int) -> None:
    """Read the changed files of a layer's footage again."""
    footage = project.document.layer(identity).footage
    if footage is not None:
        replace_footage(session, identity, Path(footage.folder, footage.files[0]))


@named_action(
    _("Collect footage"),
    hint=_("Copy the files of all footage into a folder beside the project"),
    why_disabled=lambda _, project: _why_nothing_collects(project),
)
@with_project
def collect_footage(session: Session, project: Project) -> None:
    """Copy all files of footage on the worker, and let the layers use the copies."""
    path = project.file.path
    if path is None:
        return
    target = path.parent / _("{name} footage").format(name=path.stem)
    used = {each.footage for each in project.document.layers if each.footage is not None}

    def work() -> dict[Footage, Footage]:
        copied = {footage: copy_footage(footage, target) for footage in used}
        return {footage: copy for footage, copy in copied.items() if copy != footage}

    def done(copied: dict[Footage, Footage]) -> None:
        _change_footage(session, project, copied)
        text = _("The footage is in {folder}. Save the project.").format(folder=target.name)
        session.notices.show(text, tone="good")

    run_job(session, COLLECTING, work, done)


def _why_nothing_collects(project: Project) -> str | None:
    if all(layer.footage is None for layer in project.document.layers):
        return _("There is no footage.")
    return None if project.file.path is not None else _("Save the project first.")


@with_project
def watch_files(session: Session, project: Project) -> None:
    """Offer to reload drawings and footage whose files have changed; called every few seconds.

    A window that rests without such files makes as few calls as possible.
    """
    document = project.document
    if document.drawings:
        watch_drawings(session)
    for layer in document.layers:
        if layer.footage is not None:
            _watch_footage(session, project, layer.id, layer.footage)


def _watch_footage(session: Session, project: Project, identity: int, footage: Footage) -> None:
    has_changed = project.footage.note_times(footage, _times(footage))
    if has_changed and not _is_missing(footage):
        reload: Action = do(reload_footage, identity)
        session.notices.show(
            _("{name} has changed.").format(name=display_name(footage.name)),
            topic=f"changed {footage.name}",
            label=_("Reload"),
            action=reload,
        )


def _times(footage: Footage) -> tuple[int, ...]:
    """Return when the files of footage were changed."""
    folder = Path(footage.folder)
    names = footage.files if len(footage.files) <= MOST_WATCHED else ()
    own = tuple(file_time(folder / name) for name in names)
    return (file_time(folder), *own) if footage.is_numbered else own

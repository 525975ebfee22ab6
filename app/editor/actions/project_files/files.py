"""Opening pictures and projects."""

import os
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from app.document import Document, History, Meshing, clip_of, motion_notices
from app.editor.action import Action, do
from app.editor.actions import dialog_actions, playback
from app.editor.actions.action_spec import named_action
from app.editor.actions.layer_setup import cut_out_editing
from app.editor.actions.project_files import saving
from app.editor.actions.project_files.saving import PROJECT
from app.editor.error_reports import as_sentence, run_job
from app.editor.parts.project_file import ProjectFile
from app.editor.parts.selection import Selection, foremost_posable
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.jobs import JobKind
from app.editor.work.layer_runtime import LayerRuntime, LayerRuntimes
from app.errors import display_name
from app.solving import suggest_deform_groups
from app.storage import (
    LAYERED,
    VIDEOS,
    FileLock,
    FileLockedError,
    OpenedScene,
    Picture,
    decode_pictures,
    is_layered,
    load_project,
    move_to_disk,
    open_layered,
    open_merged,
    open_picture,
    open_pictures,
    open_video,
    project_digest,
    refuse_program_file,
    run_parallel,
    sample_images,
)
from app.texts import _, message_of, ngettext

PICTURES = (
    *(".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".ppm", ".tga", ".ico"),
    ".avif",
)
OPENABLE = (PROJECT, *PICTURES, *LAYERED, *VIDEOS)
ONE_PICTURE = _("Open as one picture")
LOOK = 2.0  # seconds between two checks whether files still exist


def recent_files(session: Session) -> tuple[tuple[Path, bool], ...]:
    """Return the recent files, and whether each still exists."""
    # The files may be on a slow disk, and every frame asks for this list.
    return _found(session.settings.preferences.recent, int(session.clock() / LOOK))


@lru_cache(maxsize=1)
def _found(paths: tuple[Path, ...], _: int) -> tuple[tuple[Path, bool], ...]:
    return tuple((path, os.path.isfile(path)) for path in paths)  # noqa: PTH113 - never raises


def open_recent_file(session: Session, path: Path) -> None:
    """Open a recent file; a missing file is removed from the list."""
    if os.path.isfile(path):  # noqa: PTH113 - never raises
        open_file(session, path)
        return
    session.settings.remove_recent(path)
    text = _("{name} is no longer in {folder}. It was removed from the recent files.")
    session.notices.show(text.format(name=path.name, folder=path.parent), tone="error")


class NextStep(NamedTuple):
    """A suggestion for the person's next step."""

    text: str
    label: str
    action: Action


class OpenedFile(NamedTuple):
    """The result of reading a file."""

    document: Document
    layer_runtimes: dict[int, LayerRuntime]
    notices: tuple[str, ...] = ()
    next_step: NextStep | None = None
    read_as: str | None = None
    drawings: tuple[Path, ...] = ()
    bending: tuple[tuple[int, ...], ...] = ()  # layers that may bend as one


@named_action(_("Open…"), "Ctrl+O", needs_project=False)
def ask_file_to_open(session: Session) -> None:
    session.ask_file(_("Open image or project"), OPENABLE, lambda path: do(open_file, path))


def open_file(session: Session, path: Path, *, as_one_picture: bool = False) -> None:
    """Read a picture or a project on the worker, and open it.

    If the project has unsaved changes by then, a question comes first. The layers of a drawing
    may be merged into one picture.
    """
    meshing = session.settings.default_meshing
    kind = JobKind(
        display_name(_("Opening {name}").format(name=path.name)),
        _("{name} cannot be opened").format(name=path.name),
    )
    _open(session, path, kind, lambda: _read(path, meshing, as_one_picture=as_one_picture))


def open_files_as_layers(session: Session, paths: Sequence[Path]) -> None:
    """Read several pictures on the worker, and open them as the layers of one scene."""
    meshing = session.settings.default_meshing
    text = ngettext("Opening {count} picture", "Opening {count} pictures", len(paths))
    kind = JobKind(text.format(count=len(paths)), _("The pictures cannot be opened"))

    def read() -> OpenedFile:
        return with_layer_runtimes(open_pictures(paths, meshing))._replace(drawings=tuple(paths))

    _open(session, paths[0], kind, read)


def _open(session: Session, path: Path, kind: JobKind, read: Callable[[], OpenedFile]) -> None:
    def done(opened: OpenedFile) -> None:
        saving.confirm_unsaved(session, do(install_opened_file, path, opened))

    run_job(session, kind, read, done)


def open_dropped_files(session: Session, paths: Sequence[Path]) -> None:
    """Open dropped files: a project, a drawing, or several pictures as layers."""
    usable = [path for path in paths if path.suffix.lower() in OPENABLE and not path.is_dir()]
    pictures = [path for path in usable if path.suffix.lower() in PICTURES]
    if len(pictures) > 1:
        open_files_as_layers(session, pictures)
    elif usable:
        if len(paths) > 1:
            text = _("Opened {name}; only one file at a time.")
            session.notices.show(text.format(name=usable[0].name))
        open_file(session, usable[0])
    elif paths:
        name = paths[0].name
        if paths[0].is_dir():
            text = _("{name} is a folder. Drop a picture (PNG, JPEG, WebP, …) or a {suffix} file.")
        else:
            text = _(
                "{name} is neither a picture nor a project. Drop a picture (PNG, JPEG, WebP, …) "
                "or a {suffix} file."
            )
        advice = refuse_program_file(name) or text.format(name=name, suffix=PROJECT)
        session.notices.show(as_sentence(advice), tone="error")


def install_opened_file(session: Session, path: Path, opened: OpenedFile) -> None:
    """Open a read file in the window; ask first if another window has it open."""
    # A sample must not be saved over.
    if path.suffix.lower() != PROJECT or path.parent == sample_images():
        _install(session, path, opened, None)
        return
    try:
        hold = saving.lock_project_file(session, path)
    except FileLockedError as error:
        session.dialogs.ask(
            title=_("Already open"),
            text=_(
                "{name} is already open {where}. If you save here and there, each save "
                "replaces the other."
            ).format(name=path.name, where=message_of(error)),
            answers=(
                (_("Open a copy"), do(install_copy, path, opened)),
                (_("Open anyway"), do(install_anyway, path, opened)),
            ),
        )
        return
    _install(session, path, opened, path, hold)


def install_copy(session: Session, path: Path, opened: OpenedFile) -> None:
    """Open a read file as a new project that has no file yet."""
    _install(session, path, opened, None)


def install_anyway(session: Session, path: Path, opened: OpenedFile) -> None:
    """Open a read file, although another window has it open."""
    _install(session, path, opened, path)


def _install(
    session: Session, path: Path, opened: OpenedFile, own: Path | None, hold: FileLock | None = None
) -> None:
    """Open a read file in the window; `own` is the project's own file."""
    session.settings.autosave.remove()
    name, drawings = display_name(path.stem), set(opened.drawings)
    project = Project(
        file=ProjectFile(name=name, path=own, digest=opened.read_as, drawings=drawings, lock=hold),
        history=History(opened.document, saved=True),
        runtimes=LayerRuntimes(layers=opened.layer_runtimes),
        selection=Selection(active=foremost_posable(opened.document)),
    )
    project.layer_list.suggest_bending(opened.bending)
    saving.set_project(session, project)
    if path.parent != sample_images():
        session.settings.add_recent(path)
    elif any(len(layer.keys) > 1 for layer in opened.document.layers):
        playback.toggle_play(session)
    for notice in opened.notices:
        session.notices.show(as_sentence(notice))
    if opened.drawings:
        dialog_actions.show_import_notice(session, project, opened.document.import_log)
    if opened.next_step:
        session.notices.show(tone="good", **opened.next_step._asdict())


def with_layer_runtimes(opened: OpenedScene) -> OpenedFile:
    """Add the layer runtimes to a scene."""
    runtimes = _layer_runtimes(opened.document, opened.pictures)
    bending = suggest_deform_groups(opened.document, opened.pictures)
    return OpenedFile(opened.document, runtimes, opened.notices, bending=bending)


def _layer_runtimes(document: Document, pictures: Mapping[int, Picture]) -> dict[int, LayerRuntime]:
    if len(pictures) > 1:
        distinct = {id(each): each for each in pictures.values()}
        kept = dict(zip(distinct, move_to_disk(list(distinct.values())), strict=True))
        pictures = {identity: kept[id(each)] for identity, each in pictures.items()}
    made = run_parallel(
        lambda identity: LayerRuntime.of(
            clip_of(document, identity), pictures[identity], among=len(document.layers)
        ),
        pictures,
        (picture.size for picture in pictures.values()),
    )
    return dict(zip(pictures, made, strict=True))


def _read(path: Path, meshing: Meshing | None, *, as_one_picture: bool) -> OpenedFile:
    if path.suffix.lower() == PROJECT:
        return _read_project(path)
    if path.suffix.lower() in VIDEOS:
        return with_layer_runtimes(open_video(path))
    read = open_picture
    if is_layered(path):
        read = open_merged if as_one_picture else open_layered
    opened = with_layer_runtimes(read(path, meshing))
    next_step = _next_step(path, tuple(opened.layer_runtimes.values()))
    return opened._replace(next_step=next_step, drawings=(path,))


def _read_project(path: Path) -> OpenedFile:
    # The digest comes first: a save by another program during the read must count as a change.
    digest = project_digest(path)
    return decode_project(load_project(path), path.name)._replace(read_as=digest)


def decode_project(document: Document, name: str) -> OpenedFile:
    """Return a project's document with its layer runtimes."""
    files = list(dict.fromkeys(layer.picture for layer in document.layers))
    title = _("the picture of {name}").format(name=name)
    decoded = decode_pictures([(file.data, title) for file in files])
    by_file = dict(zip(files, decoded, strict=True))
    pictures = {layer.id: by_file[layer.picture] for layer in document.layers}
    return OpenedFile(document, _layer_runtimes(document, pictures), motion_notices(document))


def _next_step(path: Path, runtimes: Sequence[LayerRuntime]) -> NextStep | None:
    """Return a suggestion for a drawing that was just opened: an opaque picture, or layers."""
    if len(runtimes) > 1:
        text = _("{count} layers were opened. Pose each one with handles of its own.")
        merge = do(open_file, path, as_one_picture=True)
        step = NextStep(text.format(count=len(runtimes)), ONE_PICTURE, merge)
        return None if path.parent == sample_images() else step
    cut = runtimes[0].cut.value
    if runtimes[0].is_opaque and cut.is_all:
        return NextStep(
            text=_(
                "The whole picture is the drawing. Choose Cut out, and brush the rest away or pick "
                "the background's colour."
            ),
            label=_("Cut out"),
            action=do(cut_out_editing.toggle_cut_brush),
        )
    if cut.holes is not None and cut.holes.shut:
        text = _("Does the background show through inside the drawing? Click there to cut a hole.")
        if cut.background_like is not None:
            text = _(
                "Parts inside have the background's colour, as eyes do, and stayed. Click those "
                "that belong to the background."
            )
        return NextStep(
            text=text,
            label=_("Show holes"),
            action=do(cut_out_editing.toggle_cut_tool, "holes"),
        )
    return None

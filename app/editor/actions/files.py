"""Opening pictures and projects."""

import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cache, lru_cache
from pathlib import Path
from typing import NamedTuple

from app.document import Document, History, Meshing, clip_of, motion_notices
from app.editor.action import Action, do
from app.editor.actions import playback, saving
from app.editor.actions.layer_setup import cut_out_editing
from app.editor.actions.saving import PROJECT
from app.editor.dialogs import Question, RecoverableFile, RecoveryDialog
from app.editor.error_reports import as_sentence, run_job
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.layer_runtime import LayerRuntime
from app.errors import ImportLog, display_name
from app.storage import (
    FileLock,
    FileLockedError,
    OpenedScene,
    Picture,
    SourceInfo,
    decode_pictures,
    find_recoverable_files,
    is_layered,
    load_project,
    load_recoverable_file,
    move_to_disk,
    open_layered,
    open_picture,
    open_pictures,
    project_digest,
    read_source_info,
    remove_recoverable_file,
    run_parallel,
    sample_images,
)
from app.texts import N_, _, message_of, ngettext

PICTURES = (
    *(".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff", ".ppm", ".tga", ".ico"),
    ".avif",
)
LAYERED = (".ora", ".psd")
OPENABLE = (PROJECT, *PICTURES, *LAYERED)
LOOK = 2.0  # seconds between two checks whether files still exist


# Short descriptions of the samples by their names, as long as a card has room for.
STORIES = {
    N_("Bar"): _("A bar to bend as you like"),
    N_("Character"): _("Waves a hand"),
    N_("Dragon"): _("Nods and sweeps its tail"),
    N_("Friend"): _("Layers that wave and laugh"),
    N_("Giraffe"): _("Bends down and comes up"),
    N_("Octopus"): _("Arms that curl without end"),
    N_("Ring"): _("A hole that opens and closes"),
    N_("S"): _("A spine to curl or straighten"),
}


class SampleFile(NamedTuple):
    """A picture, or a project with its picture, that ships with Lissom."""

    name: str
    file: Path
    picture: Path
    what: str
    story: str
    moving: Path  # a small animation; the file may be missing


@cache
def sample_files() -> tuple[SampleFile, ...]:
    """Return the samples, animated ones first."""
    found = []
    projects = {path.stem: path for path in sample_images().glob(f"*{PROJECT}")}
    pictures = {path.stem: path for path in sample_images().glob("*.png")}
    # A layered drawing has no picture but the thumbnail in its project.
    for name in sorted(projects.keys() | pictures.keys()):
        picture = pictures.get(name, projects.get(name, Path()))
        is_animated = name in projects
        found.append(
            SampleFile(
                name=picture.stem.capitalize(),
                file=projects.get(name, picture),
                picture=picture,
                what=_("animated") if is_animated else _("picture"),
                story=STORIES.get(picture.stem.capitalize(), ""),
                moving=sample_images() / "moving" / f"{name}.webp",
            )
        )
    return tuple(sorted(found, key=lambda sample: sample.file.suffix != PROJECT))


def recent_files(session: Session) -> tuple[tuple[Path, bool], ...]:
    """Return the recent files, and whether each still exists."""
    # The files may be on a slow disk, and every frame asks for this list.
    return _found(session.preferences.recent, int(session.clock() / LOOK))


@lru_cache(maxsize=1)
def _found(paths: tuple[Path, ...], _: int) -> tuple[tuple[Path, bool], ...]:
    return tuple((path, os.path.isfile(path)) for path in paths)  # noqa: PTH113 - never raises


def open_recent_file(session: Session, path: Path) -> None:
    """Open a recent file; a missing file is removed from the list."""
    if os.path.isfile(path):  # noqa: PTH113 - never raises
        open_file(session, path)
        return
    session.preferences = session.preferences.without_recent(path)
    session.show_notice(
        _("{name} is not in {folder} any more. It was taken off the recent files.").format(
            name=path.name, folder=path.parent
        ),
        tone="error",
    )


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


def ask_file_to_open(session: Session) -> None:
    session.ask_file(_("Open image or project"), OPENABLE, lambda path: do(open_file, path))


def open_file(session: Session, path: Path) -> None:
    """Read a picture or a project on the worker, and open it.

    If the project has unsaved changes by then, a question comes first.
    """
    meshing = session.meshing
    kind = JobKind(
        display_name(_("Opening {name}").format(name=path.name)),
        _("{name} cannot be opened").format(name=path.name),
    )
    _open(session, path, kind, lambda: _read(path, meshing))


def open_files_as_layers(session: Session, paths: Sequence[Path]) -> None:
    """Read several pictures on the worker, and open them as the layers of one scene."""
    meshing = session.meshing
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
            session.show_notice(text.format(name=usable[0].name))
        open_file(session, usable[0])
    elif paths:
        if paths[0].is_dir():
            text = _("{name} is a folder. Drop a picture (PNG, JPEG, WebP, …) or a {suffix} file.")
        else:
            text = _(
                "{name} is neither a picture nor a project. Drop a picture (PNG, JPEG, WebP, …) "
                "or a {suffix} file."
            )
        session.show_notice(text.format(name=paths[0].name, suffix=PROJECT), tone="error")


def install_opened_file(session: Session, path: Path, opened: OpenedFile) -> None:
    """Open a read file in the window; ask first if another window has it open."""
    # A sample must not be saved over.
    if path.suffix.lower() != PROJECT or path.parent == sample_images():
        _install(session, path, opened, None)
        return
    try:
        hold = saving.lock_project_file(session, path)
    except FileLockedError as error:
        session.dialog = Question(
            title=_("Open elsewhere"),
            text=_(
                "{name} is open already {where}. What is saved here and there takes the place of "
                "each other."
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
    session.autosave.remove()
    project = Project(
        name=display_name(path.stem),
        history=History(opened.document, saved=True),
        layer_runtimes=opened.layer_runtimes,
        active=_foremost(opened.document),
        path=own,
        read_as=opened.read_as,
        drawings=set(opened.drawings),
        file_lock=hold,
    )
    saving.set_project(session, project)
    if path.parent != sample_images():
        session.preferences = session.preferences.with_recent(path)
    elif any(len(layer.keys) > 1 for layer in opened.document.layers):
        playback.toggle_play(session)
    for notice in opened.notices:
        session.show_notice(as_sentence(notice))
    if opened.drawings:
        show_import_notice(session, project, opened.document.import_log)
    if opened.next_step:
        session.show_notice(tone="good", **opened.next_step._asdict())


def show_import_notice(session: Session, project: Project, summary: ImportLog) -> None:
    """Show a notice about effects of a drawing that its import lost."""
    if not summary.warnings:
        return
    project.is_import_log_open = True
    count = len(summary.warnings)
    session.show_notice(
        ngettext(
            "One thing looks different here; the tab Layers lists it.",
            "{count} things look different here; the tab Layers lists them.",
            count,
        ).format(count=count),
        topic="import",
        label=_("Show"),
        action=do(show_import_log),
    )


@with_project
def show_import_log(session: Session, project: Project) -> None:
    """Show the import log in the panel of layers."""
    project.is_import_log_open = True
    session.panel_to_focus = "Layers"


@with_project
def toggle_import_log(_: Session, project: Project) -> None:
    """Show or hide the import log in the panel of layers."""
    project.is_import_log_open = not project.is_import_log_open


def _foremost(document: Document) -> int:
    """Return the layer to pose first: the front one, still pictures aside."""
    return next(
        (layer.id for layer in reversed(document.layers) if not layer.still),
        document.layers[-1].id,
    )


def with_layer_runtimes(opened: OpenedScene) -> OpenedFile:
    """Add the layer runtimes to a scene."""
    runtimes = _layer_runtimes(opened.document, opened.pictures)
    return OpenedFile(opened.document, runtimes, opened.notices)


def _layer_runtimes(document: Document, pictures: Mapping[int, Picture]) -> dict[int, LayerRuntime]:
    if len(pictures) > 1:
        kept = {id(each): move_to_disk(each) for each in pictures.values()}
        pictures = {identity: kept[id(each)] for identity, each in pictures.items()}
    made = run_parallel(
        lambda identity: LayerRuntime.of(
            clip_of(document, identity), pictures[identity], among=len(document.layers)
        ),
        pictures,
        (picture.size for picture in pictures.values()),
    )
    return dict(zip(pictures, made, strict=True))


def _read(path: Path, meshing: Meshing) -> OpenedFile:
    if is_layered(path):
        return with_layer_runtimes(open_layered(path, meshing))._replace(drawings=(path,))
    is_project = path.suffix.lower() == PROJECT
    return _read_project(path) if is_project else _read_picture(path, meshing)


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


def _read_picture(path: Path, meshing: Meshing) -> OpenedFile:
    opened = with_layer_runtimes(open_picture(path, meshing))
    (runtime,) = opened.layer_runtimes.values()
    return opened._replace(next_step=_next_step(runtime), drawings=(path,))


def _next_step(runtime: LayerRuntime) -> NextStep | None:
    """Return a suggestion for an opaque picture that was just opened."""
    cut = runtime.cut.value
    if runtime.is_opaque and cut.is_all:
        return NextStep(
            text=_(
                "The whole picture is the drawing. Brush away what does not belong to it, or pick "
                "the background's colour in the tab Cut-out."
            ),
            label=_("Cut out"),
            action=do(cut_out_editing.toggle_cut_brush),
        )
    if cut.holes is not None and cut.holes.shut:
        return NextStep(
            text=_(
                "Does the background show through inside the drawing? A click opens it as a hole."
            ),
            label=_("Show where"),
            action=do(cut_out_editing.toggle_cut_tool, "holes"),
        )
    return None


def ask_recovery(session: Session) -> None:
    """If there is unsaved work of an earlier session, ask about it."""
    candidates = list_recoverable_files(session)
    if candidates:
        session.dialog = RecoveryDialog(candidates)


def show_recovery(session: Session) -> None:
    """Show the unsaved work of earlier sessions, or a notice that there is none."""
    ask_recovery(session)
    if not isinstance(session.dialog, RecoveryDialog):
        session.show_notice(_("There is no unsaved work of an earlier time."))


def list_recoverable_files(session: Session) -> tuple[RecoverableFile, ...]:
    """Return the unsaved work of closed windows, the newest first."""
    found = []
    for path in find_recoverable_files(session.folder):
        with suppress(OSError):  # another window has just taken it
            status = path.stat()
            found.append(
                RecoverableFile(path, read_source_info(path), status.st_mtime, status.st_size)
            )
    return tuple(found)


def recover_file(session: Session, path: Path) -> None:
    """Open unsaved work; its autosave stays until the work is saved."""
    kind = JobKind(_("Opening unsaved work"), _("The unsaved work cannot be opened"))

    def done(read: tuple[OpenedFile, SourceInfo]) -> None:
        saving.confirm_unsaved(session, do(install_recovered, path, *read))

    run_job(session, kind, lambda: _read_recoverable_file(path), done)


def _read_recoverable_file(path: Path) -> tuple[OpenedFile, SourceInfo]:
    document, origin = load_recoverable_file(path)
    return decode_project(document, origin.name), origin


def discard_recoverable_file(session: Session, path: Path) -> None:
    """Delete unsaved work, and show the rest of the list."""
    remove_recoverable_file(path)
    session.show_notice(_("The unsaved work was discarded."))
    ask_recovery(session)


def install_recovered(session: Session, path: Path, opened: OpenedFile, origin: SourceInfo) -> None:
    """Open unsaved work under its own name; it stays unsaved."""
    saving.set_project(
        session,
        Project(
            name=origin.name,
            history=History(opened.document, saved=False),
            layer_runtimes=opened.layer_runtimes,
            active=_foremost(opened.document),
            path=origin.path,
            is_recovered=True,
        ),
    )
    session.autosave.write(opened.document, origin)
    remove_recoverable_file(path)
    text = _("This is your unsaved work. Save it to keep it.")
    if origin.path:
        text = _("This is your unsaved work on {name}. Save it to keep it.")
        text = text.format(name=origin.path.name)
    session.show_notice(text, tone="good")

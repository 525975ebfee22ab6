"""Pictures that become layers, or replace a layer's picture."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from app.document import (
    Document,
    Group,
    Layer,
    Meshing,
    clip_of,
    group_commands,
    layer_commands,
)
from app.editor import pending_changes
from app.editor.action import Action, do
from app.editor.actions import dialog_actions, editing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.layer_setup.layer_runtimes import update_layer_runtimes
from app.editor.actions.project_files import files
from app.editor.actions.timing import sounds
from app.editor.error_reports import as_sentence
from app.editor.layering.deform_groups import replace_member, replacing
from app.editor.layering.footage import add_footage
from app.editor.layering.layer_selection import set_active_layer
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.layer_runtime import LayerRuntime
from app.errors import EMPTY_IMPORT_LOG, ImportLog, LissomError, NoticeCollector
from app.solving import (
    KeyResolver,
    distance_notices,
    find_new_corner,
    start_picture_replacement,
)
from app.sound import SUFFIXES
from app.storage import (
    LAYERED,
    ImportedLayer,
    LayeredPicture,
    Picture,
    decode_picture,
    is_footage,
    is_layered,
    is_video,
    make_posable_layer,
    make_still_layer,
    make_still_picture,
    place_as_layer,
    read_drawing,
    read_file,
    require_memory,
)
from app.texts import _, message_of, ngettext

ADDING = JobKind(_("Adding a layer"), _("The layer cannot be added"))
LONGEST = 28  # most characters of a name on a button


class _LoadedLayer(NamedTuple):
    """A layer, its decoded picture, a sentence about its import, and its runtime."""

    layer: Layer
    picture: Picture
    notices: tuple[str, ...]
    layer_runtime: LayerRuntime | None = None


@with_project
def make_still(session: Session, project: Project, identity: int) -> None:
    """Turn a layer into a still picture, without handles and keys."""
    still = make_still_layer(project.document.layer(identity))
    command = layer_commands.replace_layer(identity, still)
    editing.edit_document(session, replace(command, label=_("Make still picture")))


@with_project
def make_posable(session: Session, project: Project, identity: int) -> None:
    """Make a still picture posable: find its shape; its drawn pose stays."""
    layer, picture = project.document.layer(identity), project.runtimes.layers[identity].picture
    imported = ImportedLayer(
        name=layer.name, data=layer.picture.data, picture=picture, corner=layer.corner
    )
    meshing = session.settings.default_meshing

    def work() -> Layer:
        return place_as_layer(_shape(imported, identity, meshing).layer, layer)

    def done(made: Layer) -> None:
        command = layer_commands.replace_layer(identity, made)
        editing.edit_document(session, replace(command, label=_("Make posable")))
        set_active_layer(session, identity)

    kind = JobKind(_("Finding a shape"), _("{layer} cannot be posed").format(layer=layer.name))
    pending_changes.begin_pending_change(session, project, kind, work, done)


def _shape(imported: ImportedLayer, identity: int, meshing: Meshing | None) -> _LoadedLayer:
    """Return a posable layer for an imported layer."""
    # A plain background of an opaque picture is removed first.
    is_cut_out = bool((imported.picture.rgba[..., 3] == 0).any())
    made, notices = make_posable_layer(imported, identity, meshing, is_cut_out=is_cut_out)
    if made.still:
        reasons = "; ".join(map(message_of, notices))
        raise LissomError(_("there is no shape on it ({reasons})").format(reasons=reasons))
    return _LoadedLayer(made, imported.picture, (*imported.picture.notices, *notices))


def replace_picture(session: Session, identity: int, path: Path) -> None:
    """Replace a layer's picture; its handles, keys and joints stay."""
    pending_changes.run_when_idle(
        session, do(_replace_picture, identity, path), _("Replace the picture")
    )


@with_project
def _replace_picture(session: Session, project: Project, identity: int, path: Path) -> None:
    if identity not in project.runtimes.layers:
        return
    before, canvas = project.document.layer(identity), project.document.canvas
    if before.deform_group is not None:
        replace_member(session, project, before, path)
        return
    scene, shown = project.document.layers, project.runtimes.layers[identity].picture.rgba

    def work() -> tuple[KeyResolver, _LoadedLayer]:
        data = read_file(path)
        picture = decode_picture(data, path.name)
        _require_room([each for each in scene if each is not before], [picture])
        if before.still:
            made = _LoadedLayer(make_still_picture(data, picture), picture, picture.notices)
        else:
            imported = ImportedLayer(name=before.name, data=data, picture=picture)
            made = _shape(imported, identity, before.meshing)
        corner = find_new_corner(before, picture, canvas, shown)
        return start_picture_replacement(before, made.layer, corner), made

    def done(begun: tuple[KeyResolver, _LoadedLayer]) -> None:
        resolver, made = begun
        project.file.add_drawings(path)
        project.runtimes.keep_picture(made.layer.picture, made.picture)
        resolving.begin_solving_keys(session, resolver)
        if resolver.before in project.document.layers:
            set_active_layer(session, identity)
            for notice in (*made.notices, *distance_notices(resolver)):
                session.notices.show(as_sentence(notice))

    pending_changes.begin_pending_change(session, project, replacing(before), work, done)


@with_project
def add_layers(session: Session, project: Project, paths: Sequence[Path]) -> None:
    """Add pictures, and the layers of drawings, in front of all layers."""
    meshing, before = session.settings.default_meshing, project.document
    canvas = before.canvas

    def work() -> tuple[list[_LoadedLayer], ImportLog, Sequence[Group]]:
        document, summary, notices_by_layer = before, EMPTY_IMPORT_LOG, NoticeCollector()
        made: list[_LoadedLayer] = []
        for path in paths:
            drawing = _with_free_groups(read_drawing(path), document)
            _require_room(document.layers, [imported.picture for imported in drawing.layers])
            document = group_commands.add_groups(drawing.groups)(document)
            summary += drawing.summary
            is_cut_out = is_layered(path) and not drawing.is_opaque
            across, up = ((ours - its) // 2 for ours, its in zip(canvas, drawing.size, strict=True))
            for imported in drawing.layers:
                moved = replace(imported, corner=imported.corner + complex(across, up))
                identity = layer_commands.next_layer_id(document)
                layer, notices = make_posable_layer(moved, identity, meshing, is_cut_out=is_cut_out)
                document = layer_commands.add_layer(layer)(document)
                # This takes a tenth of a second, so it runs on the worker and not in the window.
                runtime = LayerRuntime.of(clip_of(document, identity), imported.picture)
                for notice in imported.picture.notices + notices:
                    notices_by_layer.add_note(document.layers[-1].name, notice)
                made.append(_LoadedLayer(layer, imported.picture, (), runtime))
        return made, summary + notices_by_layer.import_log, document.groups[len(before.groups) :]

    def done(read: tuple[list[_LoadedLayer], ImportLog, Sequence[Group]]) -> None:
        made, summary, groups = read
        project.file.add_drawings(*paths)
        gesture = object()
        project.history.do(layer_commands.append_import_log(summary), gesture=gesture)
        project.history.do(group_commands.add_groups(groups), gesture=gesture)
        for layer, picture, _notices, runtime in made:
            identity = layer_commands.next_layer_id(project.document)
            project.runtimes.keep_picture(layer.picture, picture)
            command = layer_commands.add_layer(replace(layer, id=identity))
            project.history.do(command, gesture=gesture)
            if runtime is not None and identity == layer.id:
                project.runtimes.put(identity, runtime)
        update_layer_runtimes(project)
        set_active_layer(session, identity)
        dialog_actions.show_import_notice(session, project, summary)

    pending_changes.begin_pending_change(session, project, ADDING, work, done)


def _require_room(layers: Iterable[Layer], pictures: Iterable[Picture]) -> None:
    """Refuse more pictures than could be opened together."""
    there = {layer.picture for layer in layers}
    require_memory([*(file.size for file in there), *(picture.size for picture in pictures)])


def _with_free_groups(drawing: LayeredPicture, document: Document) -> LayeredPicture:
    """Rename the groups of a drawing whose names the document already uses."""
    taken = {group.name for group in document.groups}

    def free(path: str) -> str:
        outermost, slash, inner = path.partition("/")
        return path and layer_commands.unique_name(outermost, taken) + slash + inner

    return replace(
        drawing,
        layers=tuple(replace(imported, group=free(imported.group)) for imported in drawing.layers),
        groups=tuple(replace(group, name=free(group.name)) for group in drawing.groups),
    )


def ask_pictures_to_add(session: Session) -> None:
    suffixes = (*files.PICTURES, *LAYERED)
    session.ask_file(_("Add a picture as a layer"), suffixes, lambda path: do(add_layers, [path]))


@with_project
def ask_replacement_picture(session: Session, project: Project, identity: int) -> None:
    layer = project.document.layer(identity).name
    title = _("Replace the picture of {layer}").format(layer=layer)
    session.ask_file(title, files.PICTURES, lambda path: do(replace_picture, identity, path))


@with_project
def set_drop_target(_: Session, project: Project, identity: int) -> None:
    """Note the layer row under the pointer in this frame."""
    project.layer_list.point_at(identity)


def _only_moves(path: Path) -> bool:
    """Return whether a dropped file can only be footage: a video, or a folder of pictures."""
    return (is_video(path) or path.is_dir()) and is_footage([path])


def drop_files(session: Session, paths: Sequence[Path]) -> None:
    """Open dropped files, and add sounds; ask whether pictures join the open scene."""
    sound_files = [path for path in paths if path.suffix.lower() in SUFFIXES]
    if session.project is not None and sound_files:
        sounds.add_sounds(session, sound_files)
        paths = [path for path in paths if path not in sound_files]
        if not paths:
            return
    project = session.project
    if project is not None and paths and all(map(_only_moves, paths)):
        for path in paths:
            add_footage(session, path)
        return
    kinds = (*files.PICTURES, *LAYERED)
    pictures = [path for path in paths if path.suffix.lower() in kinds and not path.is_dir()]
    if project is None or not pictures or len(pictures) < len(paths):
        files.open_dropped_files(session, paths)
        return
    (first, *others) = pictures
    is_one = not others and not is_layered(first)
    answers: list[tuple[str, Action]] = [
        (_("New layer") if is_one else _("New layers"), do(add_layers, pictures)),
        *([(_("Footage"), do(add_footage, first))] if is_footage(pictures) else []),
        (_("New scene"), do(files.open_dropped_files, pictures)),
    ]
    text = _("New layers lie in front of the others and share their timeline.")
    if is_one:
        onto = project.layer_list.pointed_layer
        identity = project.selection.active if onto is None else onto
        name = project.document.layer(identity).name
        name = name if len(name) <= LONGEST else f"{name[: LONGEST - 1].rstrip()}…"
        answer = _("Replace {layer}").format(layer=name)
        answers.insert(onto is None, (answer, do(replace_picture, identity, first)))
        text = _(
            "A new layer lies in front of the others and shares their timeline. A layer whose "
            "picture is replaced keeps its handles, keys and joints."
        )
    if others:
        title = ngettext(
            "Add {count} picture to this scene?",
            "Add {count} pictures to this scene?",
            len(pictures),
        ).format(count=len(pictures))
    else:
        title = _("Add {name} to this scene?").format(name=first.name)
    session.dialogs.ask(title=title, text=text, answers=tuple(answers))

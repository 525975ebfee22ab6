"""Deform groups: layers that bend as one, and parting them again."""

from collections.abc import Iterable
from pathlib import Path

from app.document import Command, Document, Layer, PictureFile, ancestor_paths
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import editing
from app.editor.error_reports import as_sentence
from app.editor.layering.layer_selection import set_active_layer
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.errors import join_names
from app.solving import (
    BendingAsOne,
    bend_as_one,
    find_new_corner,
    part_deform_group,
    replace_member_picture,
    start_picture_replacement,
)
from app.storage import Picture, decode_picture, make_still_picture, read_file, require_memory
from app.texts import _

BENDING = JobKind(_("Bending layers as one"), _("The layers cannot bend as one"))
PARTING = JobKind(_("Parting a deform group"), _("The deform group was not parted"))


def moving_layers(document: Document, identities: Iterable[int]) -> tuple[int, ...]:
    """Return the layers that move these layers: a member of a deform group moves with it."""
    bent = (document.deform_layer(document.layer(each)).id for each in identities)
    return tuple(dict.fromkeys(bent))


def why_not_bend_as_one(project: Project, identities: Iterable[int]) -> str | None:
    """Return why layers cannot become members of a deform group; None if they can."""
    document, chosen = project.document, tuple(identities)
    if len(chosen) < 2:
        return _("Select several layers first: ink, shadow and colour of one part, for example.")
    if any(
        document.is_deform_group(each) or document.layer(each).deform_group is not None
        for each in chosen
    ):
        return _("One of them is already in a deform group.")
    return None


def bending_suggestions(project: Project) -> tuple[tuple[int, ...], ...]:
    """Return the layers of an opened drawing that may bend as one, as far as they can."""
    document = project.document
    return tuple(
        layers
        for layers in project.layer_list.bending_suggestions
        if all(document.find_layer(each) is not None for each in layers)
        and why_not_bend_as_one(project, layers) is None
    )


@with_project
def dismiss_bending_suggestion(_: Session, project: Project, *layers: int) -> None:
    """Stop suggesting that these layers bend as one."""
    project.layer_list.dismiss_bending(layers)


def bend_layers_as_one(session: Session, *identities: int) -> None:
    """Let one mesh with one set of handles bend layers, which stay layers in all else."""
    pending_changes.run_when_idle(session, do(_bend_as_one, *identities), _("Bend as one"))


@with_project
def _bend_as_one(session: Session, project: Project, *identities: int) -> None:
    document = project.document
    pictures = {each: project.runtimes.layers[each].picture for each in identities}
    name = _name_of(document, identities)

    def done(made: BendingAsOne) -> None:
        if project.document is not document:
            session.notices.show(
                _("The layers do not bend as one: the project changed meanwhile. Try again."),
                tone="error",
            )
            return
        project.runtimes.keep_picture(made.group.picture, made.picture)
        editing.edit_document(session, made.command)
        set_active_layer(session, made.group.id)
        if made.resting:
            text = _("Handles and keys of {layers} are back when the group is parted.")
            names = join_names([each.name for each in made.resting])
            session.notices.show(text.format(layers=names))
        for notice in made.notices:
            session.notices.show(as_sentence(notice))

    pending_changes.begin_pending_change(
        session,
        project,
        BENDING,
        lambda: bend_as_one(document, identities, pictures, name=name),
        done,
    )


def _name_of(document: Document, identities: Iterable[int]) -> str | None:
    """Return the name of the innermost group that holds exactly these layers, if any."""
    chosen = set(identities)
    for path in reversed(ancestor_paths(document.layer(min(chosen)).group)):
        if {each.id for each in document.member_layers(path)} == chosen:
            return path.rpartition("/")[2]
    return None


def part_group(session: Session, identity: int) -> None:
    """Give the members of a deform group their own meshes, handles and keys back."""
    parting = do(_part_group, identity)
    pending_changes.run_when_idle(session, parting, _("Part deform group"))


@with_project
def _part_group(session: Session, project: Project, identity: int) -> None:
    document = project.document
    members = document.deform_members(identity)
    if not members:
        return
    group = document.layer(identity)
    pictures = {each.id: project.runtimes.layers[each.id].picture for each in members}

    def done(made: tuple[Command, tuple[str, ...]]) -> None:
        command, notices = made
        if project.document is not document:
            session.notices.show(
                _("The deform group was not parted: the project changed meanwhile. Try again."),
                tone="error",
            )
            return
        editing.edit_document(session, command)
        project.layer_list.dismiss_bending(tuple(each.id for each in members))
        set_active_layer(session, members[-1].id)
        if group.handles or group.keys[1:]:
            text = _("The handles and keys of {group} are gone; its layers are as before.")
            session.notices.show(text.format(group=group.name))
        for notice in notices:
            session.notices.show(as_sentence(notice))

    pending_changes.begin_pending_change(
        session, project, PARTING, lambda: part_deform_group(document, identity, pictures), done
    )


def replace_member(session: Session, project: Project, before: Layer, path: Path) -> None:
    """Give a member another picture; the shape of its deform group follows."""
    document = project.document
    pictures = {each: runtime.picture for each, runtime in project.runtimes.layers.items()}

    def work() -> tuple[Command, dict[PictureFile, Picture], tuple[str, ...]]:
        data = read_file(path)
        picture = decode_picture(data, path.name)
        there = {each.picture for each in document.layers if each is not before}
        require_memory([picture.size, *(file.size for file in there)])
        corner = find_new_corner(before, picture, document.canvas, pictures[before.id].rgba)
        made = start_picture_replacement(before, make_still_picture(data, picture), corner)
        member = made.new_layer or before
        command, known, notices = replace_member_picture(document, member, picture, pictures)
        return command, known, (*picture.notices, *notices)

    def done(made: tuple[Command, dict[PictureFile, Picture], tuple[str, ...]]) -> None:
        command, known, notices = made
        if project.document is not document:
            text = _("The picture of {layer} was not replaced: the project changed meanwhile.")
            session.notices.show(text.format(layer=before.name), tone="error")
            return
        project.file.add_drawings(path)
        for file, picture in known.items():
            project.runtimes.keep_picture(file, picture)
        editing.edit_document(session, command)
        for notice in notices:
            session.notices.show(as_sentence(notice))

    pending_changes.begin_pending_change(session, project, replacing(before), work, done)


def replacing(layer: Layer) -> JobKind:
    """Return the kind of the jobs that replace a layer's picture."""
    text = _("The picture of {layer} was not replaced").format(layer=layer.name)
    return JobKind(_("Replacing a picture"), text)

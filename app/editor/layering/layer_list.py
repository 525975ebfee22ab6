"""Which layer is posed, in what order they lie, and when they are seen."""

from collections.abc import Sequence
from functools import reduce

import numpy as np

from app.document import (
    BlendMode,
    ancestor_paths,
    combine_commands,
    common_path,
    group_commands,
    is_visible,
    layer_commands,
    layers_in_draw_order,
    switch_group_commands,
)
from app.editor.actions import editing, playback
from app.editor.layering.layer_selection import set_active_layer
from app.editor.project import Project
from app.editor.session import Session, with_project
from engine.geometry import contains


def layer_at(
    project: Project, place: complex, *, below: int | None = None, besides: int | None = None
) -> int | None:
    """Return the layer that is seen in front at a place of the scene, None where there is none.

    Still, hidden and locked ones are passed through.

    Parameters
    ----------
    place : complex
    below : int, optional
        Where that layer is there, too, the next one behind it is returned, or at last the first.
    besides : int, optional
        A layer that is passed through.
    """
    shown = project.layer_runtime.shown
    frame = project.playhead.frame if shown is None else shown.frame
    found = (
        each.id
        for each in reversed(layers_in_draw_order(project.document, frame))
        if each.id != besides
        and not (each.still or each.locked)
        and is_layer_at(project, each.id, place)
    )
    if below is None:
        return next(found, None)
    there = list(found)
    if below in there:
        return there[(there.index(below) + 1) % len(there)]
    return there[0] if there else None


def is_layer_at(project: Project, identity: int, place: complex) -> bool:
    """Tell whether a layer is seen at a place of the scene."""
    shown = project.layer_runtimes[identity].shown
    document = project.document
    if shown is None or (project.solo and identity not in project.solo):
        return False
    outline = shown.positions[: len(shown.mesh.domain.outline)]
    place = shown.placement.apply_inverse(place)
    # Most layers are elsewhere, which their boxes tell at once.
    x, y = outline.real, outline.imag
    if not (x.min() <= place.real <= x.max() and y.min() <= place.imag <= y.max()):
        return False
    if not is_visible(document, document.layer(identity), shown.frame):
        return False
    return bool(contains(outline, np.array([place]))[0])


def rename_layer(session: Session, identity: int, name: str) -> None:
    """Give a layer another name."""
    if name.strip():
        editing.edit_document(session, layer_commands.rename_layer(identity, name))


def move_layer(session: Session, identity: int, index: int) -> None:
    """Put a layer at an index in the order from back to front."""
    editing.edit_document(session, layer_commands.move_layer(identity, index))


@with_project
def move_layers_beside(
    session: Session,
    project: Project,
    beside: int,
    in_front: bool,  # noqa: FBT001 - of an action
    *identities: int,
) -> None:
    """Put layers in front of another one, or behind it, in the order that they have.

    All of a group stay one.
    """
    whole = _whole_group(project, identities)
    if whole:
        editing.edit_document(
            session, group_commands.reorder_group(whole, beside, in_front=in_front)
        )
        return
    order = [layer.id for layer in project.document.layers]
    moved = [each for each in order if each in identities and each != beside]
    commands = []
    for count, each in enumerate(moved):
        order.remove(each)
        index = order.index(moved[count - 1] if count else beside) + (count > 0 or in_front)
        order.insert(index, each)
        commands.append(layer_commands.move_layer(each, index))
    editing.edit_document(session, combine_commands(_of("Move", moved), commands))


@with_project
def toggle_layers_hidden(session: Session, project: Project, *identities: int) -> None:
    """Hide layers, or show them again: the other way than the first of them is."""
    hidden = not project.document.layer(identities[0]).hidden
    commands = [layer_commands.set_hidden(each, hidden=hidden) for each in identities]
    editing.edit_document(
        session, combine_commands(_of("Hide" if hidden else "Show", identities), commands)
    )


@with_project
def toggle_layers_locked(session: Session, project: Project, *identities: int) -> None:
    """Let clicks on the drawing pass through layers, or stop at them: other than at the first."""
    locked = not project.document.layer(identities[0]).locked
    commands = [layer_commands.set_locked(each, locked=locked) for each in identities]
    editing.edit_document(
        session, combine_commands(_of("Lock" if locked else "Unlock", identities), commands)
    )


def put_layers_in_group(session: Session, path: str, *identities: int) -> None:
    """Put layers in a group, or with "" out of all groups."""
    editing.edit_document(session, group_commands.group_layers(identities, path))


@with_project
def group_layers(session: Session, project: Project) -> None:
    """Put the chosen layers in a new group, in the innermost one that all of them are in."""
    document, chosen = project.document, project.selected_layers
    around = reduce(common_path, (document.layer(each).group for each in chosen))
    taken = {each.name for each in document.groups}
    free = layer_commands.unique_name(f"{around}/group".removeprefix("/"), taken)
    put_layers_in_group(session, free, *chosen)


@with_project
def add_layers_to_group(session: Session, project: Project, path: str, *identities: int) -> None:
    """Take layers into a group; all of another group stay one in it."""
    whole = _whole_group(project, identities)
    if whole:
        editing.edit_document(session, group_commands.move_group_into(whole, path))
    else:
        put_layers_in_group(session, path, *identities)


def _whole_group(project: Project, identities: Sequence[int]) -> str:
    """Return the path of the outermost group that is made of several layers; "" if none is."""
    document = project.document
    for path in ancestor_paths(document.layer(identities[0]).group):
        inside = {each.id for each in document.layers if path in ancestor_paths(each.group)}
        if len(inside) > 1 and inside == set(identities):
            return path
    return ""


def ungroup_layers(session: Session, path: str) -> None:
    """Let the layers of a group be by themselves."""
    editing.edit_document(session, group_commands.ungroup_layers(path))


def rename_group(session: Session, path: str, name: str) -> None:
    """Give a group another name."""
    editing.edit_document(session, group_commands.rename_group(path, name))


def _of(verb: str, identities: Sequence[int]) -> str:
    return f"{verb} {'layer' if len(identities) == 1 else f'{len(identities)} layers'}"


@with_project
def toggle_reference(session: Session, project: Project, identity: int) -> None:
    """Leave a layer out of exports, or take it in again."""
    reference = project.document.layer(identity).reference
    editing.edit_document(session, layer_commands.set_reference(identity, reference=not reference))


def set_layer_opacity(session: Session, identity: int, opacity: float) -> None:
    """Set how opaque a layer is."""
    editing.edit_document(session, layer_commands.set_opacity(identity, opacity))


def set_blend_mode(session: Session, identity: int, mode: BlendMode) -> None:
    """Set how a layer's colours meet those behind it."""
    editing.edit_document(session, layer_commands.set_blend(identity, mode))


@with_project
def toggle_clipping(session: Session, project: Project, identity: int) -> None:
    """Let a layer be seen only where what lies below it is, or everywhere again."""
    clipped = project.document.layer(identity).clipped
    editing.edit_document(session, layer_commands.set_clipped(identity, clipped=not clipped))


def set_group_opacity(session: Session, path: str, opacity: float) -> None:
    """Set how opaque a group is."""
    editing.edit_document(session, group_commands.set_group_opacity(path, opacity))


@with_project
def toggle_group_hidden(session: Session, project: Project, path: str) -> None:
    """Hide a group, or show it again."""
    hidden = project.document.group(path).hidden
    editing.edit_document(session, group_commands.set_group_hidden(path, hidden=not hidden))


@with_project
def toggle_visibility_key(session: Session, project: Project, identity: int) -> None:
    """Show or hide a layer from the present frame on: the other way than it is there.

    One that takes turns with others is shown in place of them.
    """
    frame = playback.current_frame(session, project)
    document = project.document
    visible = not is_visible(document, document.layer(identity), frame)
    if document.switch_group_of(identity) is None:
        editing.edit_document(
            session, layer_commands.key_visibility(identity, frame, visible=visible)
        )
    elif visible:
        editing.edit_document(session, switch_group_commands.choose_at(identity, frame))


@with_project
def delete_visibility_key(session: Session, project: Project, identity: int) -> None:
    """Take back that a layer is shown or hidden from the present frame on."""
    frame = playback.current_frame(session, project)
    editing.edit_document(session, layer_commands.key_visibility(identity, frame, visible=None))


@with_project
def note_listed_layer(_: Session, project: Project) -> None:
    """Note that the list of layers shows the one that is posed."""
    project.last_listed_layer = project.active


def ask_layer_name(session: Session, identity: int | None) -> None:
    """Ask for a layer's name where layers are listed; None asks for none any more."""
    session.named_layer = identity


@with_project
def duplicate_layer(session: Session, project: Project, identity: int) -> None:
    """Put a copy of a layer in front of it, and choose it."""
    free = layer_commands.next_layer_id(project.document)
    editing.edit_document(session, layer_commands.duplicate_layer(identity))
    set_active_layer(session, free)

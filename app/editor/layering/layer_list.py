"""The list of layers: picking, ordering, grouping, visibility and blending."""

from collections.abc import Sequence
from functools import reduce

import numpy as np

from app.document import (
    ancestor_paths,
    combine_commands,
    common_path,
    deform_group_commands,
    group_commands,
    is_visible,
    layer_commands,
    layers_in_draw_order,
    switch_group_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action
from app.editor.layering.layer_selection import set_active_layer
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.texts import _, ngettext
from engine.geometry import contains


def layer_at(
    project: Project, place: complex, *, below: int | None = None, besides: int | None = None
) -> int | None:
    """Return the front layer at a place of the scene; None if there is none.

    Still, hidden and locked layers are skipped.

    Parameters
    ----------
    below : int, optional
        If this layer is at the place, the next layer behind it is returned, and after the last
        layer the first.
    besides : int, optional
        A layer that is skipped.
    """
    shown = project.layer_runtime.shown
    frame = project.timeline.playhead.frame if shown is None else shown.frame
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
    """Return whether a layer is visible at a place of the scene."""
    shown = project.runtimes.layers[identity].shown
    document = project.document
    if shown is None or (project.layer_list.solo and identity not in project.layer_list.solo):
        return False
    outline = shown.positions[: len(shown.mesh.domain.outline)]
    place = shown.placement.apply_inverse(place)
    # Most layers are elsewhere, and the test of their boxes is cheap.
    x, y = outline.real, outline.imag
    if not (x.min() <= place.real <= x.max() and y.min() <= place.imag <= y.max()):
        return False
    if not is_visible(document, document.layer(identity), shown.frame):
        return False
    return bool(contains(outline, np.array([place]))[0])


def rename_layer(session: Session, identity: int, name: str) -> None:
    if name.strip():
        editing.edit_document(session, layer_commands.rename_layer(identity, name))


@with_project
def move_layers_beside(
    session: Session,
    project: Project,
    beside: int,
    in_front: bool,  # noqa: FBT001 - of an action
    *identities: int,
) -> None:
    """Move layers in front of another layer or behind it; their own order stays.

    Layers of a group stay together.
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
    label = ngettext("Move layer", "Move {count} layers", len(moved)).format(count=len(moved))
    editing.edit_document(session, combine_commands(label, commands))


@with_project
def toggle_layers_hidden(session: Session, project: Project, *identities: int) -> None:
    """Hide or show layers: the opposite of the first layer's state."""
    hidden = not project.document.layer(identities[0]).hidden
    commands = [layer_commands.set_hidden(each, hidden=hidden) for each in identities]
    count = len(identities)
    if hidden:
        label = ngettext("Hide layer", "Hide {count} layers", count)
    else:
        label = ngettext("Show layer", "Show {count} layers", count)
    editing.edit_document(session, combine_commands(label.format(count=count), commands))


@with_project
def toggle_layers_locked(session: Session, project: Project, *identities: int) -> None:
    """Lock or unlock layers against clicks: the opposite of the first layer's state."""
    locked = not project.document.layer(identities[0]).locked
    commands = [layer_commands.set_locked(each, locked=locked) for each in identities]
    count = len(identities)
    if locked:
        label = ngettext("Lock layer", "Lock {count} layers", count)
    else:
        label = ngettext("Unlock layer", "Unlock {count} layers", count)
    editing.edit_document(session, combine_commands(label.format(count=count), commands))


def put_layers_in_group(session: Session, path: str, *identities: int) -> None:
    """Put layers in a group; with "" remove them from all groups."""
    editing.edit_document(session, group_commands.group_layers(identities, path))


@with_project
def group_layers(session: Session, project: Project) -> None:
    """Put the selected layers in a new group, inside their innermost common group."""
    document, chosen = project.document, project.selected_layers
    around = reduce(common_path, (document.layer(each).group for each in chosen))
    taken = {each.name for each in document.groups}
    free = layer_commands.unique_name(f"{around}/group".removeprefix("/"), taken)
    put_layers_in_group(session, free, *chosen)


@with_project
def add_layers_to_group(session: Session, project: Project, path: str, *identities: int) -> None:
    """Add layers to a group; a whole group among them stays a group inside it."""
    whole = _whole_group(project, identities)
    if whole:
        editing.edit_document(session, group_commands.move_group_into(whole, path))
    else:
        put_layers_in_group(session, path, *identities)


def _whole_group(project: Project, identities: Sequence[int]) -> str:
    """Return the path of the outermost group that consists of these layers; "" if none."""
    document = project.document
    for path in ancestor_paths(document.layer(identities[0]).group):
        inside = {each.id for each in document.layers if path in ancestor_paths(each.group)}
        if len(inside) > 1 and inside == set(identities):
            return path
    return ""


@with_project
def toggle_reference(session: Session, project: Project, identity: int) -> None:
    """Exclude a layer from exports, or include it again."""
    reference = project.document.layer(identity).reference
    editing.edit_document(session, layer_commands.set_reference(identity, reference=not reference))


@with_project
def toggle_clipping(session: Session, project: Project, identity: int) -> None:
    """Clip a layer to the layer below, or release it."""
    clipped = project.document.layer(identity).clipped
    editing.edit_document(session, layer_commands.set_clipped(identity, clipped=not clipped))


@with_project
def toggle_group_hidden(session: Session, project: Project, path: str) -> None:
    hidden = project.document.group(path).hidden
    editing.edit_document(session, group_commands.set_group_hidden(path, hidden=not hidden))


@with_project
def toggle_visibility_key(session: Session, project: Project, identity: int) -> None:
    """Key the opposite of a layer's visibility at the present frame.

    A layer of a switch is shown instead of the switch's other layers.
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
def note_listed_layer(_: Session, project: Project) -> None:
    """Note that the list of layers has scrolled to the active layer."""
    project.layer_list.note_listed(project.selection.listed)


@with_project
def ask_layer_name(_: Session, project: Project, identity: int | None) -> None:
    """Edit a layer's name in the list of layers; None ends the editing."""
    project.layer_list.edit_name(identity)


@named_action(_("Rename layer"), "F2")
@with_project
def rename_active_layer(session: Session, project: Project) -> None:
    session.display.focus_panel("Layers")
    ask_layer_name(session, project.selection.listed)


@with_project
def duplicate_layer(session: Session, project: Project, identity: int) -> None:
    """Put a copy of a layer in front of it, and select the copy."""
    free = layer_commands.next_layer_id(project.document)
    is_group = project.document.is_deform_group(identity)
    copy = (
        deform_group_commands.duplicate_deform_group if is_group else layer_commands.duplicate_layer
    )
    editing.edit_document(session, copy(identity))
    set_active_layer(session, free)

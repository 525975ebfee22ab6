"""Handles: adding, deleting and setting them, also in the unkeyed pose."""

from dataclasses import replace

import numpy as np

from app import rigging
from app.document import (
    Handle,
    handle_commands,
    layer_commands,
    mirrored_handles_by_name,
    mirrored_name,
)
from app.editor.action import do
from app.editor.actions.action_spec import UNLESS_HANDLES, named_action
from app.editor.actions.posing.pose_solver import finish_drag
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.errors import join_names
from app.motion import LayerFrame
from app.texts import _, ngettext
from engine.domain import MeshedDomain
from engine.geometry import contains, diameter

NEAR = 0.05  # of the diameter: least distance of a suggested handle from another handle


@with_project
def add_handle(
    _: Session, project: Project, place: complex, *, gesture: object | None = None
) -> None:
    """Add a handle at a shown place of the shape; nothing moves."""
    if project.layer_runtime.shown is None:
        return
    rest = find_rest_place(project.layer_runtime.shown, place)
    identity = project.layer.next_handle
    project.history.do(
        handle_commands.add_handle(project.selection.active, rest), gesture=gesture or object()
    )
    project.pose_edits.note_new_handles(project.document)
    project.selection.select_handles(frozenset({identity}))


@with_project
def remove_handles(
    session: Session,
    project: Project,
    identities: frozenset[int],
    *,
    gesture: object | None = None,
) -> None:
    """Delete handles; poses stay. A notice names bones that are deleted with them."""
    finish_drag(session, project)
    layer = project.layer
    bones = [bone for bone in layer.bones if not identities.isdisjoint(bone.ends)]
    command = handle_commands.remove_handles(project.selection.active, identities)
    project.history.do(command, gesture=gesture or object())
    project.selection.deselect_handles(identities)
    if bones:
        names = [" – ".join(layer.handle(end).name for end in bone.ends) for bone in bones]
        text = ngettext(
            "Deleted with the handle: the bone {bones}. Undo brings it back.",
            "Deleted with the handle: the bones {bones}. Undo brings them back.",
            len(bones),
        )
        session.notices.show(text.format(bones=join_names(names)), topic="material")


@named_action(
    _("Suggest handles"),
    icon="WAND_MAGIC_SPARKLES",
    hint=_("Add named handles on body and head, and at tips and joints of limbs"),
)
@with_project
def suggest_handles(session: Session, project: Project) -> None:
    """Add handles on the body, at tips and joints of limbs that have none."""
    layer = project.layer
    suggested = rigging.suggest_handles(layer.domain.loops)
    near = NEAR * diameter(layer.domain.outline)
    taken = np.array([handle.position for handle in layer.handles], dtype=np.complex128)
    free = [handle for handle in suggested if not (np.abs(taken - handle.place) < near).any()]
    if not free:
        session.notices.show(_("All suggested places already have handles."))
        return
    names = {handle.name for handle in layer.handles}
    handles = [
        Handle(id=0, name=layer_commands.unique_name(name, names), position=place)
        for place, name in free
    ]
    gesture = object()
    project.history.do(
        handle_commands.add_handles(project.selection.active, handles), gesture=gesture
    )
    project.pose_edits.note_new_handles(project.document)
    added = {handle.id for handle in project.layer.handles} - {h.id for h in layer.handles}
    project.selection.clear()
    count = len(added)
    session.notices.show(
        ngettext(
            "{count} handle was added. Drag it to pose.",
            "{count} handles were added. Drag one to pose.",
            count,
        ).format(count=count),
        label=_("Take back"),
        action=do(_take_suggestions_back, project, frozenset(added), gesture),
    )


def _take_suggestions_back(
    session: Session, project: Project, added: frozenset[int], gesture: object
) -> None:
    """Remove the suggested handles; later edits stay."""
    if session.project is not project:
        return
    finish_drag(session, project)
    project.history.revert(gesture)
    remaining = added & {handle.id for handle in project.layer.handles}
    if remaining:
        remove_handles(session, remaining)
    project.selection.deselect_handles(added)


@named_action(
    _("Mirror"),
    icon="LEFT_RIGHT",
    hint=_("Add partners on the other side, named .L and .R or left and right"),
    why_disabled=UNLESS_HANDLES,
)
@with_project
def mirror_handles(session: Session, project: Project) -> None:
    """Add a partner of each selected handle across the mirror axis, with the matching name."""
    layer, words = project.layer, project.document.pairs
    pairs = mirrored_handles_by_name(layer.handles, words)
    alone = [
        handle for handle in layer.handles if handle.id in project.selection.handles - pairs.keys()
    ]
    gesture, outside = object(), 0
    partners: list[Handle] = []
    for handle in alone:
        place = complex(2 * layer.axis - handle.position.real, handle.position.imag)
        if place == handle.position or not _is_inside(layer.domain, place):
            outside += 1
            continue
        name = handle.name
        if mirrored_name(name, words) is None:
            name += ".L" if handle.position.real < layer.axis else ".R"
            command = handle_commands.rename_handle(project.selection.active, handle.id, name)
            project.history.do(command, gesture=gesture)
        partners.append(replace(handle, name=mirrored_name(name, words) or name, position=place))
    if partners:
        project.history.do(
            handle_commands.add_handles(project.selection.active, partners), gesture=gesture
        )
    if outside:
        session.notices.show(
            _(
                "The mirrored handle would lie outside the drawing. Move the handle or the mirror "
                "axis."
            )
        )
    elif not partners:
        session.notices.show(_("Every selected handle already has a partner on the other side."))


def _is_inside(domain: MeshedDomain, place: complex) -> bool:
    outline, *holes = domain.loops
    return bool(contains(outline, np.array([place]), holes=holes)[0])


def find_rest_place(shown: LayerFrame, place: complex) -> complex:
    """Return the rest place of the point shown at a place."""
    found = shown.mesh.locate(np.array([place]), shown.positions)
    return complex(found.positions_on(shown.mesh.domain.mesh.vertices)[0])

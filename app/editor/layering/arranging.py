"""Which layer is posed, in what order they lie, and when they are seen."""

import numpy as np

from app.document import BlendMode, group_commands, is_visible, layer_commands
from app.editor.actions import editing, playback, posing
from app.editor.project import Project
from app.editor.session import Session, with_project
from engine.geometry import contains


@with_project
def choose(session: Session, project: Project, identity: int) -> None:
    """Let a figure be the one whose handles and keys are shown and changed."""
    if identity == project.active:
        return
    posing.let_go(session)
    project.active = identity
    project.selected = project.chosen = frozenset()
    project.chosen_track = None
    project.meshing = project.drafted_bounds = None
    session.hovered = None


def figure_at(
    project: Project, place: complex, *, below: int | None = None, besides: int | None = None
) -> int | None:
    """Return the figure that is seen in front at a place of the scene, None where there is none.

    Still, hidden and locked ones are passed through.

    Parameters
    ----------
    place : complex
    below : int, optional
        Where that figure is there, too, the next one behind it is returned, or at last the first.
    besides : int, optional
        A figure that is passed through.
    """
    found = [
        each.id
        for each in reversed(project.document.figures)
        if each.id != besides and not (each.still or each.locked) and is_at(project, each.id, place)
    ]
    if below in found:
        return found[(found.index(below) + 1) % len(found)]
    return found[0] if found else None


def is_at(project: Project, identity: int, place: complex) -> bool:
    """Tell whether a figure is seen at a place of the scene."""
    shown = project.puppets[identity].shown
    document = project.document
    if shown is None or not is_visible(document, document.figure(identity), shown.frame):
        return False
    outline = shown.positions[: len(shown.mesh.domain.outline)]
    return bool(contains(outline, np.array([shown.placement.back(place)]))[0])


def rename(session: Session, identity: int, name: str) -> None:
    """Give a layer another name."""
    if name.strip():
        editing.edit(session, layer_commands.rename_figure(identity, name))


def move(session: Session, identity: int, index: int) -> None:
    """Put a layer at an index in the order from back to front."""
    editing.edit(session, layer_commands.move_figure(identity, index))


@with_project
def show(session: Session, project: Project, identity: int) -> None:
    """Hide a layer, or show it again."""
    hidden = project.document.figure(identity).hidden
    editing.edit(session, layer_commands.set_hidden(identity, hidden=not hidden))


@with_project
def lock(session: Session, project: Project, identity: int) -> None:
    """Let clicks on the drawing pass through a layer, or stop at it again."""
    locked = project.document.figure(identity).locked
    editing.edit(session, layer_commands.set_locked(identity, locked=not locked))


@with_project
def refer(session: Session, project: Project, identity: int) -> None:
    """Leave a layer out of exports, or take it in again."""
    reference = project.document.figure(identity).reference
    editing.edit(session, layer_commands.set_reference(identity, reference=not reference))


def fade(session: Session, identity: int, opacity: float) -> None:
    """Set how opaque a layer is."""
    editing.edit(session, layer_commands.set_opacity(identity, opacity))


def blend(session: Session, identity: int, mode: BlendMode) -> None:
    """Set how a layer's colours meet those behind it."""
    editing.edit(session, layer_commands.set_blend(identity, mode))


@with_project
def clip(session: Session, project: Project, identity: int) -> None:
    """Let a layer be seen only where what lies below it is, or everywhere again."""
    clipped = project.document.figure(identity).clipped
    editing.edit(session, layer_commands.set_clipped(identity, clipped=not clipped))


def fade_group(session: Session, path: str, opacity: float) -> None:
    """Set how opaque a group is."""
    editing.edit(session, group_commands.set_group_opacity(path, opacity))


@with_project
def show_group(session: Session, project: Project, path: str) -> None:
    """Hide a group, or show it again."""
    hidden = project.document.group(path).hidden
    editing.edit(session, group_commands.set_group_hidden(path, hidden=not hidden))


@with_project
def switch_here(session: Session, project: Project, identity: int) -> None:
    """Show or hide a layer from the present frame on: the other way than it is there."""
    frame = playback.current_frame(session, project)
    document = project.document
    visible = not is_visible(document, document.figure(identity), frame)
    editing.edit(session, layer_commands.switch_at(identity, frame, visible=visible))


@with_project
def unswitch_here(session: Session, project: Project, identity: int) -> None:
    """Take back that a layer is shown or hidden from the present frame on."""
    frame = playback.current_frame(session, project)
    editing.edit(session, layer_commands.switch_at(identity, frame, visible=None))


@with_project
def list_active(_: Session, project: Project) -> None:
    """Note that the list of layers shows the one that is posed."""
    project.listed = project.active


def ask_name(session: Session, identity: int | None) -> None:
    """Ask for a layer's name where layers are listed; None asks for none any more."""
    session.named_layer = identity


@with_project
def duplicate(session: Session, project: Project, identity: int) -> None:
    """Put a copy of a layer in front of it, and choose it."""
    free = layer_commands.free_identity(project.document)
    editing.edit(session, layer_commands.duplicate_figure(identity))
    choose(session, free)


@with_project
def remove(session: Session, project: Project, identity: int) -> None:
    """Delete a layer; where it was the one that is posed, its neighbour is now."""
    order = [figure.id for figure in project.document.figures]
    index, was_active = order.index(identity), identity == project.active
    editing.edit(session, layer_commands.remove_figure(identity))
    if was_active:
        choose(session, (order[:index][-1:] or order[index + 1 :])[0])

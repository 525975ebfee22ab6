"""The anchor of a layer, which is also the joint of an attached layer. Setting it moves nothing."""

import numpy as np

from app.document import shape_commands
from app.editor.actions import playback
from app.editor.actions.posing.handles import find_rest_place
from app.editor.layering.parenting import attach_layer
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.texts import _


@with_project
def toggle_anchor_at_handle(
    session: Session, project: Project, identity: int, *, gesture: object | None = None
) -> None:
    """Make a handle's point the anchor; if it is the anchor, let the engine choose again.

    An attached layer keeps its anchor.
    """
    shown, place = project.layer_runtime.shown, project.layer.handle(identity).position
    layers = [] if shown is None else [each.id for each in shown.clip.layer.handles]
    if project.layer.has_parent and project.layer.anchor == place:
        session.notices.show(_("The layer is attached here. Detach it, or choose another point."))
    elif _is_attached(session, project) and shown is not None and identity in layers:
        _move_joint(session, project, complex(shown.handle_positions[layers.index(identity)]))
    else:
        anchor = None if project.layer.anchor == place else place
        command = shape_commands.set_anchor(project.selection.active, anchor)
        project.history.do(command, gesture=gesture)


@with_project
def set_anchor(
    session: Session, project: Project, place: complex, *, gesture: object | None = None
) -> None:
    """Make the shape's point at a shown place the anchor."""
    shown = project.layer_runtime.shown
    if shown is not None and _is_attached(session, project):
        _move_joint(session, project, place)
    elif shown is not None:
        rest = find_rest_place(shown, place)
        command = shape_commands.set_anchor(project.selection.active, rest)
        project.history.do(command, gesture=gesture)


def _is_attached(session: Session, project: Project) -> bool:
    joint = project.layer.attachment_key_at(playback.current_frame(session, project))
    return joint is not None and joint.parent is not None


def _move_joint(session: Session, project: Project, place: complex) -> None:
    """Move the joint of the active layer with its anchor to a shown place."""
    layer, shown = project.layer, project.layer_runtime.shown
    joint = layer.attachment_key_at(playback.current_frame(session, project))
    if shown is not None and joint is not None and joint.parent is not None:
        at = complex(shown.placement.apply(np.array([place]))[0])
        attach_layer(session, layer.id, joint.parent, joint.inherits_rotation, at)

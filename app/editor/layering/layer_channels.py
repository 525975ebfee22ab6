"""Keys of the camera, and of opacity, transform and draw order of layers."""

from dataclasses import replace

import numpy as np

from app.document import CameraKey, DrawOrderKey, camera_at, filming_commands
from app.editor.actions import editing, playback
from app.editor.project import Project, fit_view_around
from app.editor.session import Session, with_project
from app.motion import BoundingBox


@with_project
def key_camera(session: Session, project: Project) -> None:
    """Key the camera at the playhead with the viewport's view.

    The rotation is kept if the viewport is upright.
    """
    document, frame = project.document, playback.current_frame(session, project)
    shot, view = camera_at(document, frame), project.view(session.screen)
    whole = fit_view_around(BoundingBox(0j, complex(*document.canvas)), session.screen)
    turn = 0.0 if shot is None else shot.turn
    if view.turn != 1:
        # The nearest angle among those whole turns apart.
        turn += float(np.angle(view.turn * np.exp(-1j * turn)))
    key = CameraKey(
        frame=document.frames.clamp(frame),
        centre=view.centre,
        zoom=view.scale / whole.scale,
        turn=turn,
    )
    editing.edit_document(session, filming_commands.key_camera(key))


@with_project
def toggle_camera_view(_: Session, project: Project) -> None:
    """Show the camera's view in the viewport, or the earlier view again."""
    project.is_camera_view = not project.is_camera_view


@with_project
def change_camera_key(
    session: Session,
    project: Project,
    frame: int,
    *,
    zoom: float | None = None,
    turn: float | None = None,
) -> None:
    """Set the zoom or the rotation of a camera key."""
    for key in project.document.camera:
        if key.frame == frame:
            zoom, turn = key.zoom if zoom is None else zoom, key.turn if turn is None else turn
            changed = replace(key, zoom=zoom, turn=turn)
            editing.edit_document(session, filming_commands.key_camera(changed))


def delete_camera_key(session: Session, frame: int) -> None:
    editing.edit_document(session, filming_commands.delete_camera_key(frame))


@with_project
def key_opacity(session: Session, project: Project, identity: int, opacity: float) -> None:
    frame = playback.current_frame(session, project)
    editing.edit_document(session, filming_commands.key_opacity(identity, frame, opacity))


@with_project
def delete_opacity_key(session: Session, project: Project, identity: int) -> None:
    frame = playback.current_frame(session, project)
    editing.edit_document(session, filming_commands.delete_opacity_key(identity, frame))


@with_project
def key_transform(
    session: Session, project: Project, identity: int, shift: complex, turn: float
) -> None:
    frame = playback.current_frame(session, project)
    editing.edit_document(session, filming_commands.key_movement(identity, frame, shift, turn))


@with_project
def delete_transform_key(session: Session, project: Project, identity: int) -> None:
    frame = playback.current_frame(session, project)
    editing.edit_document(session, filming_commands.delete_movement_key(identity, frame))


@with_project
def key_draw_order(
    session: Session,
    project: Project,
    identity: int,
    beside: int | None,
    in_front: bool = True,  # noqa: FBT001, FBT002 - of an action
) -> None:
    """Key a layer's draw order at the playhead: beside another layer, or at its own place."""
    frame = playback.current_frame(session, project)
    key = DrawOrderKey(frame, beside, in_front)
    editing.edit_document(session, filming_commands.place_at(identity, key))


@with_project
def delete_draw_order_key(session: Session, project: Project, identity: int) -> None:
    frame = playback.current_frame(session, project)
    editing.edit_document(session, filming_commands.unplace_at(identity, frame))

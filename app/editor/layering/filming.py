"""What the camera shows, and how layers fade in time."""

from dataclasses import replace

from app.document import CameraKey, camera_at, filming_commands
from app.editor.actions import editing, playback, viewing
from app.editor.project import Project, view_around
from app.editor.session import Session, with_project
from app.motion import Box
from app.render import View


@with_project
def key_camera(session: Session, project: Project) -> None:
    """Let the camera show at the playhead what the viewport shows, turned as it is there."""
    document, frame = project.document, playback.current_frame(session, project)
    shot, view = camera_at(document, frame), project.view(session.screen)
    key = CameraKey(
        frame=document.frames.clamp(frame),
        centre=view.centre,
        zoom=view.scale / _canvas_view(session, project).scale,
        turn=0.0 if shot is None else shot.turn,
    )
    editing.edit(session, filming_commands.key_camera(key))


@with_project
def fit_camera(session: Session, project: Project) -> None:
    """Let the viewport show what the camera does at the playhead, upright."""
    shot = camera_at(project.document, playback.current_frame(session, project))
    view = _canvas_view(session, project)
    if shot is not None:
        view = replace(view, centre=shot.centre, scale=view.scale * shot.zoom)
    viewing.look_from(session, view)


@with_project
def change_camera_key(
    session: Session,
    project: Project,
    frame: int,
    *,
    zoom: float | None = None,
    turn: float | None = None,
) -> None:
    """Let a key of the camera be zoomed or turned otherwise, where that is told."""
    for key in project.document.camera:
        if key.frame == frame:
            zoom, turn = key.zoom if zoom is None else zoom, key.turn if turn is None else turn
            changed = replace(key, zoom=zoom, turn=turn)
            editing.edit(session, filming_commands.key_camera(changed))


def delete_camera_key(session: Session, frame: int) -> None:
    """Delete a key of the camera."""
    editing.edit(session, filming_commands.delete_camera_key(frame))


def _canvas_view(session: Session, project: Project) -> View:
    return view_around(Box(0j, complex(*project.document.canvas)), session.screen)


@with_project
def fade_here(session: Session, project: Project, identity: int, opacity: float) -> None:
    """Set how opaque a layer is from key to key, at the playhead."""
    frame = playback.current_frame(session, project)
    editing.edit(session, filming_commands.key_opacity(identity, frame, opacity))


@with_project
def unfade_here(session: Session, project: Project, identity: int) -> None:
    """Take back what is said of a layer's opacity at the playhead."""
    frame = playback.current_frame(session, project)
    editing.edit(session, filming_commands.delete_opacity_key(identity, frame))

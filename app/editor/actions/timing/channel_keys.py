"""Keys of channels with values: set, insert and delete at the present frame."""

from typing import Any

import numpy as np

from app.document import (
    CAMERA,
    OPACITY,
    SLIDER,
    Camera,
    Channel,
    camera_at,
    channel_commands,
    frames_in,
    layer_commands,
    slider_commands,
    source_frame,
    value_at,
)
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.parts.viewport_state import fit_view_around
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.motion import BoundingBox
from app.texts import _


@with_project
def set_channel_value(
    session: Session, project: Project, channel: Channel[Any], value: Any
) -> None:
    """Set a channel's value at the present frame by a key.

    An opacity without keys is set for all frames; without auto-key, so is a slider.
    """
    frame = playback.current_frame(session, project)
    command = channel_commands.set_key(channel, frame, value)
    is_keyed = bool(frames_in(project.document, channel))
    if channel.kind is OPACITY and channel.layer is not None and not is_keyed:
        command = layer_commands.set_opacity(channel.layer, value)
    is_free = not (is_keyed or session.settings.preferences.auto_key)
    if channel.kind is SLIDER and channel.layer is not None and is_free:
        command = slider_commands.set_slider_value(channel.layer, str(channel.part), value)
    editing.edit_document(session, command)


@with_project
def insert_channel_key(session: Session, project: Project, channel: Channel[Any]) -> None:
    """Insert a key with the channel's value at the present frame."""
    frame = playback.current_frame(session, project)
    value = value_at(project.document, channel, frame)
    editing.edit_document(session, channel_commands.set_key(channel, frame, value))


@with_project
def delete_channel_key(session: Session, project: Project, channel: Channel[Any]) -> None:
    """Delete a channel's key at the present frame; in repeats, the key that repeats."""
    frame = source_frame(project.document, channel, playback.current_frame(session, project))
    if frame is not None:
        keys = {channel: frozenset({frame})}
        editing.edit_document(session, channel_commands.delete_keys(keys))


@named_action(
    _("Key the camera"),
    icon="VIDEO",
    hint=_("Key the camera at this frame: it shows what the viewport shows now"),
)
@with_project
def key_camera(session: Session, project: Project) -> None:
    """Key the camera at the playhead with the viewport's view.

    The rotation is kept if the viewport is upright.
    """
    document, frame = project.document, playback.current_frame(session, project)
    shot, view = camera_at(document, frame), project.view_on(session.display.screen)
    whole = fit_view_around(BoundingBox(0j, complex(*document.canvas)), session.display.screen)
    turn = 0.0 if shot is None else shot.turn
    if view.turn != 1:
        # The nearest angle among those whole turns apart.
        turn += float(np.angle(view.turn * np.exp(-1j * turn)))
    camera = Camera(view.centre, view.scale / whole.scale, turn)
    frame = document.frames.clamp(frame)
    editing.edit_document(session, channel_commands.set_key(Channel(CAMERA), frame, camera))


@named_action(
    _("Look through the camera"),
    hint=_("Show the camera's picture in each frame, until you move the view"),
    why_disabled=unless(
        lambda _, project: project.document.camera, _("There is no camera. Key the camera first.")
    ),
    active=lambda session: session.project and session.project.viewport.is_camera_view,
)
@with_project
def toggle_camera_view(_: Session, project: Project) -> None:
    """Show the camera's view in the viewport, or the earlier view again."""
    project.viewport.toggle_camera_view()

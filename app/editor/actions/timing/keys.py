"""Actions on whole keys, and settings of time."""

from typing import Any

from app.document import (
    LAST_FRAME,
    LINEAR,
    MARKER,
    PARENT,
    POSE,
    PRESETS,
    Channel,
    Command,
    Easing,
    FrameRange,
    KeysByChannel,
    TangentMode,
    channel_commands,
    combine_commands,
    frames_in,
    key_commands,
    keys_in,
    scene_commands,
    source_frame,
)
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import ActionSpec, named_action, unless
from app.editor.actions.posing.inserting import IS_KEYED, insert_key
from app.editor.actions.timing import channel_keys, tracks
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.errors import LissomError
from app.texts import N_, _

NO_LAST_FRAME = N_(
    "The last frame must be after frame {first} and at most {most:,}, not {last:,}. Type "
    "another number."
)
GOES_ON_SMOOTHLY = N_(
    "The key at frame {frame} is smooth, so the motion bends before it. Make it a corner for a "
    "straight motion."
)


@with_project
def edit_timing(
    session: Session, project: Project, command: Command, *, gesture: object = None
) -> None:
    """Run a command that changes frames; the playhead stays at its frame or the nearest one."""
    before = playback.current_frame(session, project)
    editing.edit_document(session, command, gesture=gesture)
    frame = project.document.frames.clamp(before)
    if playback.current_frame(session, project) != frame:
        project.timeline.seek(frame, session.clock())


def _insert_disabled_reason(session: Session, project: Project) -> str | None:
    frame = playback.current_frame(session, project)
    if project.selected_track is None:
        frame = playback.edited_frame(session, project)
    if project.unkeyed_pose is not None or project.selection.other_layers:
        return None
    if project.channel.kind in (MARKER, PARENT):
        return _("Use “Add marker” for markers, and the Layers tab for parents.")
    is_keyed = playback.is_frame_keyed(project, frame)
    return _(IS_KEYED).format(frame=frame) if is_keyed else None


@named_action(
    _("Insert key"),
    "I",
    icon="DIAMOND",
    hint=_("Set a key with the current pose"),
    why_disabled=_insert_disabled_reason,
)
@with_project
def insert_key_in_row(session: Session, project: Project) -> None:
    """Insert a key at the present frame into the selected channel, with its present value."""
    channel = project.channel
    if channel.kind is POSE or project.unkeyed_pose is not None:
        insert_key(session)
    elif project.selected_track is not None:
        tracks.key_handles_at_playhead(session, (project.selected_track,))
    else:
        channel_keys.insert_channel_key(session, channel)


def insert_key_in_row_at(session: Session, frame: int) -> None:
    """Put the playhead on a frame, and insert a key into the selected channel, or say why not."""
    playback.scrub(session, frame)
    reason = insert_key_in_row.disabled_reason(session)
    if reason is None:
        insert_key_in_row(session)
    else:
        session.notices.show(reason)


@with_project
def set_easing(session: Session, project: Project, keys: KeysByChannel, easing: Easing) -> None:
    """Set the easing after keys; a notice says where a linear motion still bends."""
    editing.edit_document(session, channel_commands.set_easing(keys, easing))
    smooth = _smooth_ends(project, keys) if easing == LINEAR else {}
    if smooth:
        frame = min(map(min, smooth.values()))
        sharpen = channel_commands.set_tangent_mode(smooth, TangentMode.CORNER)
        session.notices.show(
            _(GOES_ON_SMOOTHLY).format(frame=frame),
            topic="easing",
            label=_("Make it a corner"),
            action=do(editing.edit_document, sharpen),
        )


def _smooth_ends(project: Project, keys: KeysByChannel) -> KeysByChannel:
    """Return the smooth keys, between two others, at which segments after keys end."""
    found: dict[Channel[Any], frozenset[int]] = {}
    for channel, frames in keys.items():
        row = keys_in(project.document, channel)
        ends = {
            end.frame
            for key, end, _after in zip(row, row[1:], row[2:], strict=False)
            if key.frame in frames and end.shown_tangent_mode is TangentMode.SMOOTH
        }
        if ends and not channel.kind.is_held:
            found[channel] = frozenset(ends)
    return found


def set_revolutions(session: Session, keys: KeysByChannel, turns: int) -> None:
    """Set the full turns of the shape after pose keys."""
    commands = [
        key_commands.set_revolutions(channel.layer, frames, turns)
        for channel, frames in keys.items()
        if channel.kind is POSE and channel.layer is not None
    ]
    editing.edit_document(session, combine_commands(_("Set turns"), commands))


@named_action(_("Next tangent mode"), "T")
@with_project
def use_next_tangent_mode(session: Session, project: Project) -> None:
    """Set the next tangent mode of the selected keys, or of the key at or before the playhead."""
    keys = _selected_or_at_playhead(session, project)
    passings = list(TangentMode)
    channel = project.channel if project.channel in keys else next(iter(keys))
    frame, row = min(keys[channel]), keys_in(project.document, channel)
    first = next(key.shown_tangent_mode for key in row if key.frame == frame)
    mode = passings[(passings.index(first) + 1) % len(passings)]
    editing.edit_document(session, channel_commands.set_tangent_mode(keys, mode))


@with_project
def ease_selected_keys(session: Session, project: Project, easing: Easing) -> None:
    """Set the easing of the selected keys, or of the key at or before the playhead."""
    set_easing(session, _selected_or_at_playhead(session, project), easing)


EASE_KEYS = tuple(
    ActionSpec(do(ease_selected_keys, PRESETS[preset]), label, keys)
    for label, preset, keys in (
        (_("Ease in and out"), "in-out", "F9"),
        (_("Ease in"), "in", "Shift+F9"),
        (_("Ease out"), "out", "Ctrl+Shift+F9"),
        (_("Linear"), "linear", "Alt+F9"),
    )
)


def _selected_or_at_playhead(session: Session, project: Project) -> KeysByChannel:
    """Return the selected keys, or the selected channel's key at or before the playhead.

    In repeats, it is the key that repeats.
    """
    if project.selection.keys:
        return project.selection.keys
    here, channel = playback.current_frame(session, project), project.channel
    own = source_frame(project.document, channel, here)
    here = project.document.frames.first if own is None else own
    frames = frames_in(project.document, channel)
    frame = max((each for each in frames if each <= here), default=min(frames))
    return {channel: frozenset({frame})}


def set_default_easing(session: Session, easing: Easing) -> None:
    """Set the easing of new keys."""
    session.settings.prefer(easing=easing)


@with_project
def reverse_selected_keys(session: Session, project: Project) -> None:
    """Reverse the selected keys in time, or the selected channel if fewer are selected."""
    keys = project.selection.keys
    if project.selection.key_count < 2:
        keys = {project.channel: frames_in(project.document, project.channel)}
    _rearrange(session, project, channel_commands.reverse_keys(keys))


@with_project
def scale_selected_keys(session: Session, project: Project, factor: float) -> None:
    """Scale the time of the selected keys, or of the animation if fewer than two are selected.

    If all keys are selected, the ranges of frames are scaled, too.
    """
    keys = project.selection.keys
    is_all = project.selection.key_count < 2 or keys == editing.movable_keys(project.document)
    scale = scene_commands.scale_time(factor)
    _rearrange(session, project, scale if is_all else channel_commands.scale_keys(keys, factor))


def _rearrange(session: Session, project: Project, command: Command) -> None:
    """Run a command that moves the selected keys, and select them at their new frames."""
    keys, everything = project.selection.keys, project.selection.key_count < 2
    others = {channel: frames_in(project.document, channel) - keys[channel] for channel in keys}
    edit_timing(session, command)
    chosen = {channel: frames_in(project.document, channel) - others[channel] for channel in keys}
    editing.select_channel_keys(session, {} if everything else chosen)


@named_action(
    _("Loop"),
    "L",
    icon="REPEAT",
    hint=_("Loop the animation: its end continues at its start"),
    active=lambda session: session.project and session.project.document.loop,
)
@with_project
def toggle_loop(session: Session, project: Project) -> None:
    edit_timing(session, scene_commands.set_loop(loop=not project.document.loop))


def set_fps(session: Session, fps: float) -> None:
    """Set the frame rate; playback continues at the same frame."""
    edit_timing(session, scene_commands.set_fps(fps))


@with_project
def set_last_frame(session: Session, project: Project, last: int) -> None:
    first = project.document.frames.first
    if not first < last <= LAST_FRAME:
        raise LissomError(_(NO_LAST_FRAME).format(first=first, most=LAST_FRAME, last=last))
    edit_timing(session, scene_commands.set_frames(FrameRange(first, last)))


@named_action(
    _("Play all frames"),
    "Alt+P",
    why_disabled=unless(
        lambda _, project: project.document.preview, _("All frames are already played.")
    ),
)
def clear_preview_range(session: Session) -> None:
    """Play all frames."""
    edit_timing(session, scene_commands.set_preview(None))


@named_action(_("Set preview start"), "B")
@with_project
def start_preview_at_playhead(session: Session, project: Project) -> None:
    frame = playback.current_frame(session, project)
    _set_preview(session, project, frame, max(frame, project.document.played_frames.last))


@named_action(_("Set preview end"), "N")
@with_project
def end_preview_at_playhead(session: Session, project: Project) -> None:
    frame = playback.current_frame(session, project)
    _set_preview(session, project, min(frame, project.document.played_frames.first), frame)


def _set_preview(session: Session, project: Project, first: int, last: int) -> None:
    preview = FrameRange(first, last)
    whole = preview == project.document.frames
    edit_timing(session, scene_commands.set_preview(None if whole else preview))


@with_project
def add_marker(session: Session, project: Project, frame: int) -> None:
    """Add a marker at a frame, unless it has one."""
    if any(marker.frame == frame for marker in project.document.markers):
        text = _("Frame {frame} already has a marker. Double-click the marker to name it.")
        session.notices.show(text.format(frame=frame))
    else:
        editing.edit_document(session, scene_commands.add_marker(frame))


@named_action(_("Add marker"), "M")
@with_project
def add_marker_at_playhead(session: Session, project: Project) -> None:
    add_marker(session, playback.current_frame(session, project))


def delete_marker(session: Session, frame: int) -> None:
    keys = {Channel(MARKER): frozenset({frame})}
    editing.edit_document(session, channel_commands.delete_keys(keys))

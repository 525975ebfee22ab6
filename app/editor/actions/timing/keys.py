"""Actions on whole keys, and settings of time."""

from dataclasses import replace

from app.document import (
    LAST_FRAME,
    Command,
    Easing,
    FrameRange,
    TangentMode,
    Variant,
    key_commands,
    scene_commands,
    shape_commands,
    track_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.posing.inserting import insert_key
from app.editor.actions.timing import tracks
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.timeline_view import KeysByRow, frames_in, keys_in, source_frame
from app.errors import LissomError
from app.texts import N_, _

NO_LAST_FRAME = N_(
    "The last frame must be after frame {first} and at most {most:,}, not {last:,}. Type "
    "another number."
)
EASE = editing.KeyVerb(key_commands.set_easing, track_commands.set_track_easing)
PASS = editing.KeyVerb(key_commands.set_tangent_mode, track_commands.set_track_passing)
REVERSE = editing.KeyVerb(key_commands.reverse_keys, track_commands.reverse_track_keys)
SCALE = editing.KeyVerb(key_commands.scale_keys, track_commands.scale_track_keys)
TURN = editing.KeyVerb(key_commands.set_revolutions)  # track keys store whole turns


@with_project
def edit_timing(session: Session, project: Project, command: Command) -> None:
    """Run a command that changes frames; the playhead stays at its frame or the nearest one."""
    before = playback.current_frame(session, project)
    editing.edit_document(session, command)
    frame = project.document.frames.clamp(before)
    if playback.current_frame(session, project) != frame:
        project.playhead = project.playhead.seek(frame, session.clock())


@with_project
def insert_key_in_row(session: Session, project: Project) -> None:
    """Insert a key at the present frame into the selected row: of the pose, or of a track."""
    track = project.selected_track
    if track is None or project.unkeyed_pose is not None:
        insert_key(session)
    else:
        tracks.key_handles_at_playhead(session, (track,))


def insert_key_in_row_at(session: Session, frame: int) -> None:
    """Put the playhead on a frame, and insert a key into the selected row."""
    playback.scrub(session, frame)
    insert_key_in_row(session)


def set_easing(session: Session, keys: KeysByRow, easing: Easing) -> None:
    editing.edit_document(session, editing.change_keys(EASE, keys, easing))


def set_tangent_mode(session: Session, keys: KeysByRow, passing: TangentMode) -> None:
    editing.edit_document(session, editing.change_keys(PASS, keys, passing))


def set_revolutions(session: Session, keys: KeysByRow, turns: int) -> None:
    """Set the full turns of the shape after pose keys."""
    editing.edit_document(session, editing.change_keys(TURN, keys, turns))


@with_project
def use_next_tangent_mode(session: Session, project: Project) -> None:
    """Set the next tangent mode of the selected keys, or of the key at or before the playhead."""
    keys = _selected_or_at_playhead(session, project)
    passings = list(TangentMode)
    row = project.row if project.row in keys else next(iter(keys))
    frame = min(keys[row])
    first = next(k.shown_tangent_mode for k in keys_in(project.document, row) if k.frame == frame)
    set_tangent_mode(session, keys, passings[(passings.index(first) + 1) % len(passings)])


@with_project
def ease_selected_keys(session: Session, project: Project, easing: Easing) -> None:
    """Set the easing of the selected keys, or of the key at or before the playhead."""
    set_easing(session, _selected_or_at_playhead(session, project), easing)


def _selected_or_at_playhead(session: Session, project: Project) -> KeysByRow:
    """Return the selected keys, or the selected row's key at or before the playhead."""
    if project.selected_keys:
        return project.selected_keys
    here, row = playback.current_frame(session, project), project.row
    if (track := project.track_in(row)) is not None:
        own = source_frame(project.document, track, here)
        here = project.document.frames.first if own is None else own
    frames = frames_in(project.document, row)
    frame = max((each for each in frames if each <= here), default=min(frames))
    return {row: frozenset({frame})}


def set_default_easing(session: Session, easing: Easing) -> None:
    """Set the easing of new keys."""
    session.preferences = replace(session.preferences, easing=easing)


@with_project
def reverse_selected_keys(session: Session, project: Project) -> None:
    """Reverse the selected keys in time, or the whole row if fewer than two are selected."""
    keys = project.selected_keys
    if project.selected_key_count < 2:
        keys = {project.row: frames_in(project.document, project.row)}
    _rearrange(session, project, editing.change_keys(REVERSE, keys, _span(keys)))


@with_project
def scale_selected_keys(session: Session, project: Project, factor: float) -> None:
    """Scale the time of the selected keys, or of the animation if fewer than two are selected.

    Tracks without selected keys keep their time.
    """
    command = scene_commands.scale_time(factor)
    if project.selected_key_count >= 2:
        first, _ = _span(project.selected_keys)
        command = editing.change_keys(SCALE, project.selected_keys, factor, first)
    _rearrange(session, project, command)


def _span(keys: KeysByRow) -> tuple[int, int]:
    return min(map(min, keys.values())), max(map(max, keys.values()))


def _rearrange(session: Session, project: Project, command: Command) -> None:
    """Run a command that moves the selected keys, and select them at their new frames."""
    chosen_of, everything = project.selected_keys, project.selected_key_count < 2
    others = {row: frames_in(project.document, row) - chosen_of[row] for row in chosen_of}
    edit_timing(session, command)
    chosen = {row: frames_in(project.document, row) - others[row] for row in others}
    editing.select_keys_in_rows(session, {} if everything else chosen)


def match_loop_ends(session: Session) -> None:
    """Give the last key the pose of the first key."""
    editing.edit_layer(session, key_commands.match_loop_ends)


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


def clear_preview_range(session: Session) -> None:
    """Play all frames."""
    edit_timing(session, scene_commands.set_preview(None))


@with_project
def start_preview_at_playhead(session: Session, project: Project) -> None:
    frame = playback.current_frame(session, project)
    _set_preview(session, project, frame, max(frame, project.document.played_frames.last))


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
        text = _("Frame {frame} has a marker already. Double-click the marker to name it.")
        session.show_notice(text.format(frame=frame))
    else:
        editing.edit_document(session, scene_commands.add_marker(frame))


@with_project
def add_marker_at_playhead(session: Session, project: Project) -> None:
    add_marker(session, playback.current_frame(session, project))


def rename_marker(session: Session, frame: int, name: str) -> None:
    editing.edit_document(session, scene_commands.rename_marker(frame, name))


def delete_marker(session: Session, frame: int) -> None:
    editing.edit_document(session, scene_commands.delete_marker(frame))


def set_inbetween_method(session: Session, variant: Variant) -> None:
    editing.edit_layer(session, shape_commands.set_variant, variant)

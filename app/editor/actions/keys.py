"""What is done with keys as a whole, and the settings of time beside them."""

from dataclasses import replace

from app.document import (
    Command,
    Easing,
    FrameRange,
    Passing,
    Variant,
    figure_commands,
    key_commands,
    scene_commands,
)
from app.editor.actions import editing, playback, posing
from app.editor.project import Project
from app.editor.session import Session


def retime(session: Session, command: Command) -> None:
    """Run a command that changes time itself; the playhead stays where it is, or near."""
    project = session.project
    if project is None:
        return
    before = playback.current_frame(session, project)
    editing.edit(session, command)
    frame = project.document.frames.clamp(before)
    if playback.current_frame(session, project) != frame:
        project.playhead = project.playhead.seek(frame, session.clock())


def insert_at(session: Session, frame: int) -> None:
    """Put the playhead on a frame, and hold what is shown there in a key."""
    playback.scrub(session, frame)
    posing.insert_key(session)


def set_easing(session: Session, frames: frozenset[int], easing: Easing) -> None:
    """Set how time runs from the keys at these frames on."""
    editing.edit_figure(session, key_commands.set_easing, frames, easing)


def set_passing(session: Session, frames: frozenset[int], passing: Passing) -> None:
    """Set how the motion passes the keys at these frames."""
    editing.edit_figure(session, key_commands.set_passing, frames, passing)


def pass_otherwise(session: Session) -> None:
    """Pass the chosen keys in the next way, or the key at the playhead or before it."""
    project = session.project
    if project is None:
        return
    frames = _chosen_or_here(session, project)
    passings = list(Passing)
    first = project.figure.key(min(frames)).shown_passing
    set_passing(session, frames, passings[(passings.index(first) + 1) % len(passings)])


def _chosen_or_here(session: Session, project: Project) -> frozenset[int]:
    """Return the frames of the chosen keys, or of the one at the playhead or before it."""
    if project.chosen:
        return project.chosen
    here = playback.current_frame(session, project)
    before = [frame for frame in project.figure.key_frames if frame <= here]
    return frozenset({max(before, default=project.figure.keys[0].frame)})


def ease(session: Session, easing: Easing) -> None:
    """Set how time runs from the chosen keys on, or from the key at the playhead or before it."""
    if session.project:
        set_easing(session, _chosen_or_here(session, session.project), easing)


def ease_new_keys(session: Session, easing: Easing) -> None:
    """Set how time runs from keys that will be made."""
    session.preferences = replace(session.preferences, easing=easing)


def set_turns(session: Session, frames: frozenset[int], turns: int) -> None:
    """Set how often the shape turns round after the keys at these frames."""
    editing.edit_figure(session, key_commands.set_turns, frames, turns)


def reverse(session: Session) -> None:
    """Let the chosen keys run backwards, or all if fewer than two are chosen."""
    if session.project:
        project = session.project
        frames = project.chosen if len(project.chosen) > 1 else project.figure.key_frames
        _rearrange(session, key_commands.reverse_keys(project.active, frames))


def scale(session: Session, factor: float) -> None:
    """Stretch the time of the chosen keys, or of everything if fewer than two are chosen."""
    if session.project:
        active, chosen = session.project.active, session.project.chosen
        several = len(chosen) > 1
        _rearrange(
            session,
            key_commands.scale_keys(active, chosen, factor)
            if several
            else scene_commands.scale_time(factor),
        )


def match_ends(session: Session) -> None:
    """Give the last key the pose of the first one."""
    editing.edit_figure(session, key_commands.match_ends)


def toggle_loop(session: Session) -> None:
    """Let the end lead back to the beginning, or not."""
    if session.project:
        retime(session, scene_commands.set_loop(loop=not session.project.document.loop))


def set_fps(session: Session, fps: float) -> None:
    """Set how fast the animation plays; it goes on from where it is."""
    retime(session, scene_commands.set_fps(fps))


def set_last_frame(session: Session, last: int) -> None:
    """Set where the animation ends."""
    if session.project:
        first = session.project.document.frames.first
        retime(session, scene_commands.set_frames(FrameRange(first, last)))


def play_all(session: Session) -> None:
    """Play all frames, and not a preview range."""
    retime(session, scene_commands.set_preview(None))


def start_preview_here(session: Session) -> None:
    """Let the preview range begin at the playhead."""
    project = session.project
    if project:
        frame = playback.current_frame(session, project)
        _set_preview(session, frame, max(frame, project.document.played.last))


def end_preview_here(session: Session) -> None:
    """Let the preview range end at the playhead."""
    project = session.project
    if project:
        frame = playback.current_frame(session, project)
        _set_preview(session, min(frame, project.document.played.first), frame)


def add_marker(session: Session, frame: int) -> None:
    """Mark a frame, unless it is marked already."""
    project = session.project
    if project is None:
        return
    if any(marker.frame == frame for marker in project.document.markers):
        session.tell(f"Frame {frame} has a marker already. Double-click it to name it.")
    else:
        editing.edit(session, scene_commands.add_marker(frame))


def mark_here(session: Session) -> None:
    """Mark the frame at the playhead."""
    if session.project:
        add_marker(session, playback.current_frame(session, session.project))


def rename_marker(session: Session, frame: int, name: str) -> None:
    """Give a marker another name."""
    editing.edit(session, scene_commands.rename_marker(frame, name))


def delete_marker(session: Session, frame: int) -> None:
    """Take a marker away."""
    editing.edit(session, scene_commands.delete_marker(frame))


def set_variant(session: Session, variant: Variant) -> None:
    """Set how in-betweens are made."""
    editing.edit_figure(session, figure_commands.set_variant, variant)


def _set_preview(session: Session, first: int, last: int) -> None:
    preview = FrameRange(first, last)
    if session.project:
        whole = preview == session.project.document.frames
        retime(session, scene_commands.set_preview(None if whole else preview))


def _rearrange(session: Session, command: Command) -> None:
    """Run a command that moves the chosen keys, and choose them where they are then."""
    project = session.project
    if project is None:
        return
    others = project.figure.key_frames - project.chosen
    everything = len(project.chosen) < 2
    retime(session, command)
    frames = project.figure.key_frames
    project.chosen = frozenset() if everything else frozenset(frames - others)

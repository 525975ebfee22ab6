"""What is done with keys as a whole, and the settings of time beside them."""

from collections.abc import Callable, Mapping
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
from app.editor.session import Session, with_project

# The frames of keys, by the ids of their figures.
KeysOf = Mapping[int, frozenset[int]]


@with_project
def retime(session: Session, project: Project, command: Command) -> None:
    """Run a command that changes time itself; the playhead stays where it is, or near."""
    before = playback.current_frame(session, project)
    editing.edit(session, command)
    frame = project.document.frames.clamp(before)
    if playback.current_frame(session, project) != frame:
        project.playhead = project.playhead.seek(frame, session.clock())


def insert_at(session: Session, frame: int) -> None:
    """Put the playhead on a frame, and insert a key of what is shown there."""
    playback.scrub(session, frame)
    posing.insert_key(session)


def set_easing(session: Session, keys: KeysOf, easing: Easing) -> None:
    """Set how time runs from keys on."""
    _change(session, keys, lambda figure, at: key_commands.set_easing(figure, at, easing))


def set_passing(session: Session, keys: KeysOf, passing: Passing) -> None:
    """Set how the motion passes keys."""
    _change(session, keys, lambda figure, at: key_commands.set_passing(figure, at, passing))


def set_turns(session: Session, keys: KeysOf, turns: int) -> None:
    """Set how often the shape turns round after keys."""
    _change(session, keys, lambda figure, at: key_commands.set_turns(figure, at, turns))


def _change(
    session: Session, keys: KeysOf, change: Callable[[int, frozenset[int]], Command]
) -> None:
    editing.edit(session, editing.change_keys(change, keys))


@with_project
def pass_otherwise(session: Session, project: Project) -> None:
    """Pass the chosen keys in the next way, or the key at the playhead or before it."""
    keys = _chosen_or_here(session, project)
    passings = list(Passing)
    figure = project.active if project.active in keys else next(iter(keys))
    first = project.document.figure(figure).key(min(keys[figure])).shown_passing
    set_passing(session, keys, passings[(passings.index(first) + 1) % len(passings)])


@with_project
def ease(session: Session, project: Project, easing: Easing) -> None:
    """Set how time runs from the chosen keys on, or from the key at the playhead or before it."""
    set_easing(session, _chosen_or_here(session, project), easing)


def _chosen_or_here(session: Session, project: Project) -> KeysOf:
    """Return the chosen keys, or that of the active figure at the playhead or before it."""
    if project.chosen_of:
        return project.chosen_of
    here = playback.current_frame(session, project)
    before = [frame for frame in project.figure.key_frames if frame <= here]
    frame = max(before, default=project.figure.keys[0].frame)
    return {project.active: frozenset({frame})}


def ease_new_keys(session: Session, easing: Easing) -> None:
    """Set how time runs from keys that will be made."""
    session.preferences = replace(session.preferences, easing=easing)


@with_project
def reverse(session: Session, project: Project) -> None:
    """Let the chosen keys run backwards, or all of the figure's if fewer than two are chosen."""
    keys = project.chosen_of
    if project.count_chosen < 2:
        keys = {project.active: project.figure.key_frames}
    span = _span(keys)
    _rearrange(
        session,
        project,
        editing.change_keys(lambda figure, at: key_commands.reverse_keys(figure, at, span), keys),
    )


@with_project
def scale(session: Session, project: Project, factor: float) -> None:
    """Stretch the time of the chosen keys, or of everything if fewer than two are chosen."""
    command = scene_commands.scale_time(factor)
    if project.count_chosen >= 2:
        first, _ = _span(project.chosen_of)
        command = editing.change_keys(
            lambda figure, at: key_commands.scale_keys(figure, at, factor, first),
            project.chosen_of,
        )
    _rearrange(session, project, command)


def _span(keys: KeysOf) -> tuple[int, int]:
    """Return the first and the last frame of keys."""
    return min(map(min, keys.values())), max(map(max, keys.values()))


def _rearrange(session: Session, project: Project, command: Command) -> None:
    """Run a command that moves the chosen keys, and choose them where they are then."""
    chosen_of, everything = project.chosen_of, project.count_chosen < 2
    others = {i: project.document.figure(i).key_frames - chosen_of[i] for i in chosen_of}
    retime(session, command)
    chosen = {i: project.document.figure(i).key_frames - others[i] for i in others}
    editing.choose_keys_of(session, {} if everything else chosen)


def match_ends(session: Session) -> None:
    """Give the last key the pose of the first one."""
    editing.edit_figure(session, key_commands.match_ends)


@with_project
def toggle_loop(session: Session, project: Project) -> None:
    """Let the end lead back to the beginning, or not."""
    retime(session, scene_commands.set_loop(loop=not project.document.loop))


def set_fps(session: Session, fps: float) -> None:
    """Set how fast the animation plays; it goes on from where it is."""
    retime(session, scene_commands.set_fps(fps))


@with_project
def set_last_frame(session: Session, project: Project, last: int) -> None:
    """Set where the animation ends."""
    frames = FrameRange(project.document.frames.first, last)
    retime(session, scene_commands.set_frames(frames))


def play_all(session: Session) -> None:
    """Play all frames, and not a preview range."""
    retime(session, scene_commands.set_preview(None))


@with_project
def start_preview_here(session: Session, project: Project) -> None:
    """Let the preview range begin at the playhead."""
    frame = playback.current_frame(session, project)
    _set_preview(session, project, frame, max(frame, project.document.played.last))


@with_project
def end_preview_here(session: Session, project: Project) -> None:
    """Let the preview range end at the playhead."""
    frame = playback.current_frame(session, project)
    _set_preview(session, project, min(frame, project.document.played.first), frame)


def _set_preview(session: Session, project: Project, first: int, last: int) -> None:
    preview = FrameRange(first, last)
    whole = preview == project.document.frames
    retime(session, scene_commands.set_preview(None if whole else preview))


@with_project
def add_marker(session: Session, project: Project, frame: int) -> None:
    """Mark a frame, unless it is marked already."""
    if any(marker.frame == frame for marker in project.document.markers):
        session.tell(f"Frame {frame} has a marker already. Double-click it to name it.")
    else:
        editing.edit(session, scene_commands.add_marker(frame))


@with_project
def mark_here(session: Session, project: Project) -> None:
    """Mark the frame at the playhead."""
    add_marker(session, playback.current_frame(session, project))


def rename_marker(session: Session, frame: int, name: str) -> None:
    """Give a marker another name."""
    editing.edit(session, scene_commands.rename_marker(frame, name))


def delete_marker(session: Session, frame: int) -> None:
    """Take a marker away."""
    editing.edit(session, scene_commands.delete_marker(frame))


def set_variant(session: Session, variant: Variant) -> None:
    """Set how in-betweens are made."""
    editing.edit_figure(session, figure_commands.set_variant, variant)

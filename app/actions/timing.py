"""Gestures in the timeline, and the settings beside it."""

from app.actions import editing, playback
from app.document import key_commands, settings_commands
from app.document.easing import Easing
from app.document.settings import FrameRange, Variant
from app.session import Session, Shifting, TimeGesture

NARROWEST = 4.0  # frames that the timeline shows at least


def begin(session: Session, gesture: TimeGesture | None) -> None:
    """Begin, change or end a gesture."""
    session.time_pointer = gesture


def choose(session: Session, frames: frozenset[int]) -> None:
    """Select keys."""
    editing.choose_keys(session, frames)


def drop_keys(session: Session, gesture: Shifting, copies: bool) -> None:  # noqa: FBT001 - both named
    """Let the keys that were dragged stay where they are, or copies of them."""
    session.time_pointer = None
    if gesture.by:
        (editing.copy_keys if copies else editing.move_keys)(session, gesture.by)


def look_at(session: Session, first: float, last: float) -> None:
    """Show a stretch of the timeline; all of it where that is as long."""
    if session.project is None:
        return
    frames = session.project.document.frames
    if last - first >= frames.last - frames.first:
        session.project.span = None
        return
    length = max(last - first, NARROWEST)
    first = min(max(first, float(frames.first)), max(frames.last - length, float(frames.first)))
    session.project.span = (first, first + length)


def trim(session: Session, frame: int, last: bool) -> None:  # noqa: FBT001 - both named
    """Move an end of the work range; all of the frames need no range."""
    if session.project is None:
        return
    document = session.project.document
    frame = document.frames.clamp(frame)
    work = document.played
    ends = (min(work.first, frame), frame) if last else (frame, max(work.last, frame))
    chosen = FrameRange(*ends)
    whole = chosen == document.frames
    editing.edit(session, settings_commands.set_work_range(None if whole else chosen))


def use_all_frames(session: Session) -> None:
    """Play all frames."""
    editing.edit(session, settings_commands.set_work_range(None))


def set_frames(session: Session, first: int, last: int) -> None:
    """Set the first and last frame of the animation."""
    editing.edit(session, settings_commands.set_frames(FrameRange(first, last)))
    if session.project:
        session.project.span = None
        playback.seek(session, playback.current_frame(session, session.project))


def set_fps(session: Session, fps: float) -> None:
    """Set how fast the animation plays; it goes on from where it is."""
    project = session.project
    if project is None:
        return
    frame = playback.current_frame(session, project)
    editing.edit(session, settings_commands.set_fps(fps))
    project.playhead = project.playhead.seek(frame, session.clock())


def toggle_loop(session: Session) -> None:
    """Let the end lead back to the beginning, or not."""
    project = session.project
    if project is None:
        return
    frame = playback.current_frame(session, project)
    editing.edit(session, settings_commands.set_loop(loop=not project.document.loop))
    project.playhead = project.playhead.seek(frame, session.clock())


def set_variant(session: Session, variant: Variant) -> None:
    """Set how in-betweens are made."""
    editing.edit(session, settings_commands.set_variant(variant))


def set_easing(session: Session, easing: Easing) -> None:
    """Set how time runs after the chosen keys."""
    if session.project:
        editing.edit(session, key_commands.set_easing(session.project.chosen, easing))


def reverse(session: Session) -> None:
    """Let the chosen keys run backwards, or all if fewer than two are chosen."""
    if session.project:
        editing.edit(session, key_commands.reverse_keys(_several(session)))


def scale(session: Session, factor: float) -> None:
    """Stretch the time of the chosen keys, or of everything."""
    project = session.project
    if project is None:
        return
    if len(project.chosen) < 2:
        editing.edit(session, key_commands.scale_time(factor))
    else:
        editing.edit(session, key_commands.scale_keys(project.chosen, factor))
    project.chosen = frozenset()
    project.span = None


def match_ends(session: Session) -> None:
    """Give the last key the pose of the first one."""
    editing.edit(session, key_commands.match_ends())


def _several(session: Session) -> frozenset[int]:
    project = session.project
    if project is None:
        return frozenset()
    if len(project.chosen) > 1:
        return project.chosen
    return frozenset(key.frame for key in project.document.keys)

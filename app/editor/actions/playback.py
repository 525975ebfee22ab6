"""Moving along the timeline."""

from bisect import bisect_left

from app.document import display_frame, frames_in
from app.editor.action import do
from app.editor.actions.action_spec import ActionSpec, named_action
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.texts import _

SPEEDS = (0.25, 0.5, 1.0, 2.0)


@with_project
def seek(session: Session, project: Project, frame: int) -> None:
    """Put the playhead on a frame of the animation; a drag under the hand ends."""
    frame = project.document.frames.clamp(frame)
    if frame != current_frame(session, project):
        project.history.interrupt()
    project.timeline.seek(frame, session.clock())


def scrub(session: Session, frame: int) -> None:
    """Stop playback, and put the playhead on a frame."""
    stop_playback(session)
    seek(session, frame)


@named_action(
    _("Play"),
    icon="PLAY",
    hint=_("Play or stop"),
    active=lambda session: session.project and session.project.timeline.playhead.since is not None,
    key_text=_("Space"),
)
@with_project
def toggle_play(session: Session, project: Project) -> None:
    project.timeline.toggle_play(project.document, session.clock())


def toggle_play_on_space(session: Session) -> None:
    """Play or stop when Space is released, unless Space was held to pan the view."""
    if not session.tools.is_space_used:
        toggle_play(session)
    session.tools.use_space(used=False)


@with_project
def stop_playback(session: Session, project: Project) -> None:
    """Stop playback at the present frame."""
    project.timeline.pause(project.document, session.clock())


@with_project
def stop_playback_at_end(session: Session, project: Project) -> None:
    """Stop an animation that does not loop at its end; once a frame."""
    if project.timeline.playhead.is_over(project.document, session.clock()):
        stop_playback(session)


@with_project
def step_frames(session: Session, project: Project, frames: int) -> None:
    """Move the playhead by a number of frames."""
    stop_playback(session)
    seek(session, current_frame(session, project) + frames)


PREVIOUS_FRAME = ActionSpec(
    do(step_frames, -1),
    _("Previous frame"),
    "PageUp",
    icon="BACKWARD_STEP",
    repeats_while_held=True,
)
NEXT_FRAME = ActionSpec(
    do(step_frames, 1), _("Next frame"), "PageDown", icon="FORWARD_STEP", repeats_while_held=True
)


@with_project
def go_to_key(session: Session, project: Project, direction: int) -> None:
    """Go to the next key (1) of the selected row, or the previous one (−1); stop at the ends."""
    _go_to_next(session, project, keyed_frames(project), direction)


PREVIOUS_KEY = ActionSpec(
    do(go_to_key, -1), _("Previous key"), "DownArrow", icon="ANGLES_LEFT", repeats_while_held=True
)
NEXT_KEY = ActionSpec(
    do(go_to_key, 1), _("Next key"), "UpArrow", icon="ANGLES_RIGHT", repeats_while_held=True
)


def keyed_frames(project: Project) -> list[int]:
    """Return the frames, in order, at which the selected row shows keys."""
    return list(_keyed_frames(project))


def _keyed_frames(project: Project) -> tuple[int, ...]:
    document, channel, keyed = project.document, project.channel, project.timeline.keyed_frames
    if not keyed.follows((document, channel)):
        keys = frames_in(document, channel)
        frames = sorted(display_frame(document, channel, frame) for frame in keys)
        keyed.set((document, channel), tuple(frames))
    return keyed.value


def is_frame_keyed(project: Project, frame: int) -> bool:
    """Return whether the selected row shows a key at a frame."""
    frames = _keyed_frames(project)
    at = bisect_left(frames, frame)
    return at < len(frames) and frames[at] == frame


@with_project
def go_to_marker(session: Session, project: Project, direction: int) -> None:
    """Go to the next marker (1) or the previous one (−1); stop at the ends."""
    marked = [marker.frame for marker in project.document.markers]
    frames = project.document.frames
    _go_to_next(session, project, [frame for frame in marked if frame in frames], direction)


PREVIOUS_MARKER = ActionSpec(
    do(go_to_marker, -1), _("Previous marker"), "Shift+PageUp", repeats_while_held=True
)
NEXT_MARKER = ActionSpec(
    do(go_to_marker, 1), _("Next marker"), "Shift+PageDown", repeats_while_held=True
)


def _go_to_next(session: Session, project: Project, frames: list[int], direction: int) -> None:
    stop_playback(session)
    here = current_frame(session, project)
    if direction > 0:
        there = next((frame for frame in frames if frame > here), None)
    else:
        there = next((frame for frame in reversed(frames) if frame < here), None)
    if there is not None:
        seek(session, there)


@named_action(_("First frame"), "Ctrl+PageUp", icon="BACKWARD_FAST")
@with_project
def go_to_start(session: Session, project: Project) -> None:
    """Go to the first frame that plays."""
    seek(session, project.document.played_frames.first)


@named_action(_("Last frame"), "Ctrl+PageDown", icon="FORWARD_FAST")
@with_project
def go_to_end(session: Session, project: Project) -> None:
    """Go to the last frame that plays."""
    seek(session, project.document.played_frames.last)


@with_project
def set_playback_speed(session: Session, project: Project, speed: float) -> None:
    """Set the speed as a multiple of the document's frame rate."""
    project.timeline.set_speed(speed, project.document, session.clock())


def current_frame(session: Session, project: Project) -> int:
    return project.timeline.playhead.frame_at(project.document, session.clock())


def edited_frame(session: Session, project: Project) -> int:
    """Return the frame at which the active layer is keyed for the present frame.

    In a repeat of a cycle this is a frame of the cycle's first pass.
    """
    return project.layer.source_of(current_frame(session, project))

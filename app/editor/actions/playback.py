"""Moving along the timeline."""

from app.editor.project import Project
from app.editor.session import Session

SPEEDS = (0.25, 0.5, 1.0, 2.0)


def seek(session: Session, frame: int) -> None:
    """Put the playhead on a frame of the animation."""
    if session.project:
        project = session.project
        frame = project.document.frames.clamp(frame)
        project.playhead = project.playhead.seek(frame, session.clock())


def scrub(session: Session, frame: int) -> None:
    """Halt, and put the playhead on a frame."""
    halt(session)
    seek(session, frame)


def toggle_play(session: Session) -> None:
    """Play, or halt."""
    if session.project:
        project = session.project
        now = session.clock()
        turn = project.playhead.play if project.playhead.since is None else project.playhead.pause
        project.playhead = turn(project.document, now)


def tap_space(session: Session) -> None:
    """Play or halt where Space is let go, unless it was held to move the view."""
    if not session.space_used:
        toggle_play(session)
    session.space_used = False


def halt(session: Session) -> None:
    """Stop where the playhead is."""
    if session.project:
        project = session.project
        project.playhead = project.playhead.pause(project.document, session.clock())


def halt_at_end(session: Session) -> None:
    """Stop an animation that does not loop when it is over; called once a frame."""
    project = session.project
    if project and project.playhead.is_over(project.document, session.clock()):
        halt(session)


def step(session: Session, frames: int) -> None:
    """Go on or back by a number of frames."""
    halt(session)
    if session.project:
        seek(session, current_frame(session, session.project) + frames)


def to_key(session: Session, direction: int) -> None:
    """Go to the next key (1) or the previous one (-1); at the ends stay."""
    if session.project:
        _to_next(
            session, session.project, [k.frame for k in session.project.figure.keys], direction
        )


def to_marker(session: Session, direction: int) -> None:
    """Go to the next marker (1) or the previous one (-1); at the ends stay."""
    if session.project:
        frames = session.project.document.frames
        marked = [marker.frame for marker in session.project.document.markers]
        _to_next(
            session, session.project, [frame for frame in marked if frame in frames], direction
        )


def _to_next(session: Session, project: Project, frames: list[int], direction: int) -> None:
    halt(session)
    here = current_frame(session, project)
    if direction > 0:
        there = next((frame for frame in frames if frame > here), None)
    else:
        there = next((frame for frame in reversed(frames) if frame < here), None)
    if there is not None:
        seek(session, there)


def to_start(session: Session) -> None:
    """Go to the first frame that plays."""
    if session.project:
        seek(session, session.project.document.played.first)


def to_end(session: Session) -> None:
    """Go to the last frame that plays."""
    if session.project:
        seek(session, session.project.document.played.last)


def set_speed(session: Session, speed: float) -> None:
    """Play at a multiple of the document's own speed."""
    if session.project:
        project = session.project
        project.playhead = project.playhead.at_speed(speed, project.document, session.clock())


def current_frame(session: Session, project: Project) -> int:
    """Return the frame that is shown now."""
    return project.playhead.frame_at(project.document, session.clock())

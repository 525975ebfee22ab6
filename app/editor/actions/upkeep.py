"""What follows the document by itself: in-betweens, their distortion, the pose on the screen."""

from functools import partial

from app.document import Clip, clip_of
from app.editor.actions import measuring, playback, posing
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.session import Project, Puppet, Session
from app.motion import (
    Build,
    Motion,
    PosableMesh,
    PoseSampler,
    next_build,
    prepare_motion,
    show,
    with_series,
)

STILL = 0.15  # seconds after which the playhead is taken to stay where it is
SKETCHING, REFINING, STREAMING = "In-betweens", "Finer in-betweens", "Smooth playback"


def keep_up(session: Session) -> None:
    """Ask the worker for in-betweens that are missing, and settle what is drawn; once a frame."""
    project = session.project
    if project is None:
        return
    posing.settle(session)
    _ask(session, project)
    frame = playback.current_frame(session, project)
    for figure, puppet in project.puppets.items():
        if puppet.shown is not None and puppet.shown.frame != frame:
            project.moved_at = session.clock()
        pose = project.unkeyed if figure == project.active else None
        motions = _motions(session, project, puppet)
        puppet.shown = show(clip_of(project.document, figure), frame, pose, motions, puppet.shown)


def _ask(session: Session, project: Project) -> None:
    """Ask for what is missing most, of any figure."""
    clips = [
        (clip_of(project.document, figure), puppet) for figure, puppet in project.puppets.items()
    ]
    movable = [(clip, puppet) for clip, puppet in clips if puppet.unmovable != clip]
    for clip, puppet in movable:
        if not puppet.coarse.knows(clip, roughly=True):
            # Where nobody sees them before the hand rests, they are not to hold up what follows it.
            if session.overlays.onion or posing.POSING not in session.jobs.kinds:
                _prepare(session, clip, puppet, SKETCHING, roughly=True)
            return
    if project.is_posing:
        # What follows takes longer than the hand stays where it is.
        return
    for clip, puppet in movable:
        if not puppet.coarse.knows(clip):
            _prepare(session, clip, puppet, SKETCHING)
            return
        is_own = puppet.coarse.mesh.domain is clip.figure.domain
        if not is_own and (puppet.fine is None or not puppet.fine.knows(clip)):
            _prepare(session, clip, puppet, REFINING)
            return
    for clip, puppet in movable:
        _stream(session, project, clip, puppet)
    if len(movable) == len(clips):
        measuring.keep_up(session)


def _prepare(
    session: Session, clip: Clip, puppet: Puppet, kind: str, *, roughly: bool = False
) -> None:
    if kind in session.jobs.kinds:
        return
    earlier = puppet.coarse if kind == SKETCHING else puppet.fine

    def done(motion: Motion) -> None:
        if kind == SKETCHING:
            puppet.coarse = motion
        else:
            puppet.fine = motion

    session.jobs.put(
        Job(
            kind=kind,
            work=partial(_motion, clip, earlier, kind, puppet.coarse.sampler, roughly=roughly),
            done=done,
            failed=partial(_give_up, session, clip, puppet),
        )
    )


def _motion(
    clip: Clip,
    earlier: Motion | None,
    kind: str,
    sibling: PoseSampler | None,
    *,
    roughly: bool,
) -> Motion:
    domain = clip.figure.domain
    if earlier is None or earlier.mesh.source is not domain:
        make = PosableMesh.coarse if kind == SKETCHING else PosableMesh.fine
        is_sibling = sibling is not None and sibling.domain.cage is domain.cage
        sibling = sibling if is_sibling else None
        earlier = Motion.at_rest(clip, make(domain))
    # Exact ones an interval at a time: the next drag is not to wait for its ghosts.
    return prepare_motion(clip, earlier, sibling, roughly=roughly, at_most=None if roughly else 1)


def _stream(session: Session, project: Project, clip: Clip, puppet: Puppet) -> None:
    """Let the worker go on with a series for a while."""
    if STREAMING in session.jobs.kinds:
        return
    motions = [motion for motion in (puppet.coarse, puppet.fine) if motion is not None]
    if puppet.build is None or not any(puppet.build.is_of(motion) for motion in motions):
        frame = playback.current_frame(session, project)
        heat = session.overlays.heat_map != "none"
        builds = (next_build(motion, clip, frame, heat=heat) for motion in motions)
        puppet.build = next(filter(None, builds), None)
    if puppet.build is not None:
        session.jobs.put(
            Job(
                kind=STREAMING,
                work=puppet.build.advance,
                done=partial(_keep_series, session, project, clip, puppet),
                failed=partial(_give_up, session, clip, puppet),
            )
        )


def _keep_series(
    session: Session, project: Project, clip: Clip, puppet: Puppet, build: Build
) -> None:
    if build.series is None or puppet.build is not build:
        return
    puppet.build = None
    frame = playback.current_frame(session, project)
    clip = clip_of(project.document, clip.figure.id)
    puppet.coarse = with_series(puppet.coarse, build, clip, frame)
    if puppet.fine is not None:
        puppet.fine = with_series(puppet.fine, build, clip, frame)


def _give_up(session: Session, clip: Clip, puppet: Puppet, error: Exception) -> None:
    puppet.unmovable = clip
    report(session, "The in-betweens of these keys cannot be made", error)


def _motions(session: Session, project: Project, puppet: Puppet) -> tuple[Motion, ...]:
    is_scrubbed = session.clock() - project.moved_at < STILL
    is_moving = project.grab is not None or project.playhead.since is not None or is_scrubbed
    if puppet.fine is None or (is_moving and not session.full_detail):
        return (puppet.coarse,)
    return (puppet.fine, puppet.coarse)

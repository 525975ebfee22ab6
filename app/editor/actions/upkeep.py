"""What follows the document by itself: in-betweens, their distortion, the pose on the screen."""

from functools import partial

from app.document import Document
from app.editor.actions import measuring, playback, posing
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.session import Project, Session
from app.motion import Build, Figure, Motion, Stage, next_build, prepare_motion, show, with_series

STILL = 0.15  # seconds after which the playhead is taken to stay where it is
SKETCHING, REFINING, STREAMING = "In-betweens", "Finer in-betweens", "Smooth playback"


def keep_up(session: Session) -> None:
    """Ask the worker for in-betweens that are missing, and settle what is drawn; once a frame."""
    project = session.project
    if project is None:
        return
    posing.settle(session)
    document = project.document
    if project.unmovable is not document:
        _ask(session, project, document)
    frame = playback.current_frame(session, project)
    if project.shown is not None and project.shown.frame != frame:
        project.moved_at = session.clock()
    project.shown = show(document, frame, project.loose, _motions(session, project), project.shown)


def _ask(session: Session, project: Project, document: Document) -> None:
    if not project.sketch.knows(document, roughly=True):
        # Where nobody sees them before the hand rests, they are not to hold up what follows it.
        if session.overlays.onion or posing.POSING not in session.jobs.kinds:
            _prepare(session, project, SKETCHING, roughly=True)
    elif project.is_posing:
        # What follows takes longer than the hand stays where it is.
        return
    elif not project.sketch.knows(document):
        _prepare(session, project, SKETCHING)
    elif project.sketch.figure.domain is not document.domain and (
        project.full is None or not project.full.knows(document)
    ):
        _prepare(session, project, REFINING)
    else:
        _stream(session, project, document)
        measuring.keep_up(session)


def _prepare(session: Session, project: Project, kind: str, *, roughly: bool = False) -> None:
    if kind in session.jobs.kinds:
        return
    document = project.document
    earlier = project.sketch if kind == SKETCHING else project.full

    def done(motion: Motion) -> None:
        if kind == SKETCHING:
            project.sketch = motion
        else:
            project.full = motion

    session.jobs.put(
        Job(
            kind=kind,
            work=partial(_motion, document, earlier, kind, project.sketch.stage, roughly=roughly),
            done=done,
            failed=lambda error: _give_up(session, project, document, error),
        )
    )


def _motion(
    document: Document,
    earlier: Motion | None,
    kind: str,
    kin: Stage | None,
    *,
    roughly: bool,
) -> Motion:
    if earlier is None or earlier.figure.source is not document.domain:
        make = Figure.sketch if kind == SKETCHING else Figure.full
        is_kin = kin is not None and kin.domain.cage is document.domain.cage
        kin = kin if is_kin else None
        earlier = Motion.at_rest(document, make(document.domain))
    # Exact ones an interval at a time: the next drag is not to wait for its ghosts.
    return prepare_motion(document, earlier, kin, roughly=roughly, at_most=None if roughly else 1)


def _stream(session: Session, project: Project, document: Document) -> None:
    """Let the worker go on with a series for a while."""
    if STREAMING in session.jobs.kinds:
        return
    motions = [motion for motion in (project.sketch, project.full) if motion is not None]
    build = project.build
    if build is None or not any(build.is_of(motion) for motion in motions):
        frame = playback.current_frame(session, project)
        heat = session.overlays.heat_map != "none"
        builds = (next_build(motion, document, frame, heat=heat) for motion in motions)
        project.build = build = next(filter(None, builds), None)
    if build is not None:
        session.jobs.put(
            Job(
                kind=STREAMING,
                work=build.advance,
                done=partial(_keep_series, session, project),
                failed=lambda error: _give_up(session, project, document, error),
            )
        )


def _keep_series(session: Session, project: Project, build: Build) -> None:
    if build.series is None or project.build is not build:
        return
    project.build = None
    frame = playback.current_frame(session, project)
    project.sketch = with_series(project.sketch, build, project.document, frame)
    if project.full is not None:
        project.full = with_series(project.full, build, project.document, frame)


def _give_up(session: Session, project: Project, document: Document, error: Exception) -> None:
    project.unmovable = document
    report(session, "The in-betweens of these keys cannot be made", error)


def _motions(session: Session, project: Project) -> tuple[Motion, ...]:
    is_scrubbed = session.clock() - project.moved_at < STILL
    is_moving = project.grab is not None or project.playhead.since is not None or is_scrubbed
    if project.full is None or (is_moving and not session.full_detail):
        return (project.sketch,)
    return (project.full, project.sketch)

"""What follows the document by itself: in-betweens, what is measured of them, what is drawn."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from app.document import Clip, clip_of, intervals, time_of
from app.editor.actions import playback, posing, rebuilding, viewing
from app.editor.derived import Derivation
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.project import Project, Puppet
from app.editor.session import Session
from app.editor.timeline_view import measure_shortfalls
from app.motion import (
    Build,
    Glimpse,
    Joints,
    Motion,
    PosableMesh,
    PoseSampler,
    can_glimpse,
    extent_source,
    glimpse_at,
    hang_shown,
    joints_source,
    measure_extent,
    next_build,
    prepare_motion,
    show,
    trace_paths,
    with_series,
)
from app.reports import measure_curves
from app.storage import Cut, cut_picture, shrink
from engine.arrays import Bytes
from engine.domain import CutOut

STILL = 0.15  # seconds after which the playhead is taken to stay where it is
GLIMPSING = "In-between"
SKETCHING, REFINING, STREAMING = "In-betweens", "Finer in-betweens", "Smooth playback"
UNMADE = "The in-betweens of these keys cannot be made"
MOST_UNASKED = 1000  # frames whose extent is measured before anybody asks
CUTTING = "Cutting out"
MEASURING, SPANNING = "Measuring", "Measuring the motion"
SHRINKING = "Small pictures"
SMALL_SIDE = 96  # pixels of a picture in the list of layers
HANGING, TRACING = "Joints", "Motion paths"
COMPARING = "Other in-betweens"


def maintain(session: Session) -> None:
    """Ask the worker for what is missing, and settle what is drawn; once a frame."""
    project = session.project
    if project is None:
        return
    posing.keep_up(session, project)
    project.extent.recall(extent_source(project.document))
    rebuilding.keep_up(session)
    project.pair_up(session.split.method if session.split else None)
    for derivation in missing(session, project):
        derive(session, derivation)
    shortfalls, figure = project.timing.shortfalls, project.figure
    if not shortfalls.follows(figure):
        # Little work: of the poses that were not measured before, and there is one at a time.
        shortfalls.take(figure, measure_shortfalls(figure, shortfalls))
    _show(session, project)
    if project.awaits_extent:
        _fit_motion(session, project)


def give_up(session: Session, kind: str) -> None:
    """End a job that takes too long, or never ends; what it was for is told to have failed."""
    session.jobs.leave(kind)


def derive(session: Session, derivation: Derivation[Any, Any]) -> None:
    """Let the worker derive a value, unless it is at it."""
    if derivation.kind in session.jobs.kinds:
        return
    into, source = derivation.into, derivation.source

    def failed(error: Exception) -> None:
        into.failure = source
        report(session, derivation.complaint, error)

    session.jobs.put(
        Job(
            kind=derivation.kind,
            work=derivation.work,
            done=derivation.done or partial(into.take, source),
            failed=failed,
            lane=derivation.lane,
        )
    )


def missing(session: Session, project: Project) -> Iterator[Derivation[Any, Any]]:
    """Yield what the worker is to derive next: what is missed most, of any figure."""
    document = project.document
    yield from _cut(project)
    yield from _shrink(project)
    clips = [(clip_of(document, figure), puppet) for figure, puppet in project.puppets.items()]
    movable = [(clip, puppet) for clip, puppet in clips if not puppet.coarse.has_failed(clip)]
    # First of all: they are watched while the hand moves, and are of few points only.
    yield from _trace(session, project)
    yield from _glimpse(session, project)
    if _awaits_glimpse(session, project):
        # On few cores it would come much later beside them.
        return
    for clip, puppet in movable:
        if not puppet.coarse.value.knows(clip):
            # Where nobody sees them before the hand rests, they are not worked out for each move.
            is_seen = session.overlays.onion or not project.pulls
            if is_seen or posing.POSING not in session.jobs.kinds:
                yield _sketch(session, project, clip, puppet)
                return
            break
    if project.pulls:
        # What follows takes longer than the hand stays where it is.
        return
    is_awaited = session.export_frame is not None or project.awaits_extent
    if is_awaited and len(movable) == len(clips):
        yield from _span(project)
    yield from _compare(session, project)
    for clip, puppet in movable:
        if not _has_fine(clip, puppet) and not puppet.fine.has_failed(clip):
            yield _refine(clip, puppet)
            return
    yield from _hang(project)
    for clip, puppet in movable:
        yield from _stream(session, project, clip, puppet)
    if len(movable) == len(clips):
        yield from _measure(project)
        shown = document.frames
        if shown.last - shown.first < MOST_UNASKED:
            yield from _span(project)


def _cut(project: Project) -> Iterator[Derivation[CutOut, Cut]]:
    """Yield what is to be cut out of pictures anew."""
    for figure in project.document.figures:
        cut = project.puppets[figure.id].cut
        if not (cut.follows(figure.cut_out) or cut.has_failed(figure.cut_out)):
            yield Derivation(
                kind=CUTTING,
                into=cut,
                source=figure.cut_out,
                work=partial(cut_picture, project.puppets[figure.id].picture, figure.cut_out),
                complaint="The picture cannot be cut out so",
            )


def _shrink(project: Project) -> Iterator[Derivation[Cut, Bytes | None]]:
    """Yield the small pictures that the list of layers shows."""
    for puppet in project.puppets.values():
        cut, small = puppet.cut.value, puppet.small
        if not (small.follows(cut) or small.has_failed(cut)):
            yield Derivation(
                kind=SHRINKING,
                into=small,
                source=cut,
                work=partial(shrink, cut.texture, SMALL_SIDE),
                complaint="The picture of a layer cannot be made small",
                # It takes a few milliseconds, and is not to wait until all in-betweens are there.
                lane="hand",
            )


def _glimpse(
    session: Session, project: Project
) -> Iterator[Derivation[tuple[Clip, int], Glimpse | None]]:
    """Yield the in-between that is awaited, before and beside all others of its interval."""
    frame = playback.current_frame(session, project)
    for figure, puppet in project.puppets.items():
        clip, motion, seen = clip_of(project.document, figure), puppet.coarse.value, puppet.seen
        is_posed = figure == project.active and project.unkeyed is not None
        # What fails at one frame would at others, and is told of once.
        has_failed = seen.failure is not None and seen.failure[0] == clip
        if is_posed or has_failed or seen.follows((clip, frame)):
            continue
        if can_glimpse(clip, motion, frame):
            yield Derivation(
                kind=GLIMPSING,
                into=seen,
                source=(clip, frame),
                work=partial(glimpse_at, clip, motion, frame),
                complaint=UNMADE,
                lane="hand",
            )


def _awaits_glimpse(session: Session, project: Project) -> bool:
    """Tell whether a glimpse is on its way, the first one of the interval at the playhead."""
    if GLIMPSING not in session.jobs.kinds:
        return False
    frame = playback.current_frame(session, project)
    for figure, puppet in project.puppets.items():
        clip, seen = clip_of(project.document, figure), puppet.seen.value
        is_first = seen is None or not seen.is_of(clip, time_of(clip, frame).interval)
        if is_first and puppet.coarse.value.lacks(clip, frame):
            return True
    return False


def _sketch(
    session: Session, project: Project, clip: Clip, puppet: Puppet
) -> Derivation[Clip, Motion]:
    earlier, frame = puppet.coarse.value, playback.current_frame(session, project)
    # An interval at a time, so that what is wanted next need not wait long; all at once where the
    # hand has changed those around one key, and the ghosts are to stay together.
    at_most = None if session.overlays.onion and bool(project.pulls) else 1
    return Derivation(
        kind=SKETCHING,
        into=puppet.coarse,
        source=clip,
        work=_coarse_motion(project, clip, earlier, frame, at_most=at_most),
        complaint=UNMADE,
    )


def _trace(session: Session, project: Project) -> Iterator[Derivation[Any, Any]]:
    """Yield the paths of the active figure's handles, while some are shown."""
    clip, paths = project.clip, project.paths
    if not (session.overlays.paths and project.selected):
        return
    if paths.follows(clip) or paths.has_failed(clip):
        return
    earlier, sibling = paths.value, project.puppet.coarse.value.sampler
    yield Derivation(
        kind=TRACING,
        into=paths,
        source=clip,
        work=lambda: trace_paths(clip, earlier, sibling),
        complaint="The paths of the handles cannot be traced",
    )


def _hang(project: Project) -> Iterator[Derivation[Any, Any]]:
    """Yield the joints of what hangs."""
    document, joints = project.document, project.joints
    source, earlier = joints_source(document), joints.value
    if not source or joints.follows(source) or joints.has_failed(source):
        return
    samplers = {figure: puppet.coarse.value.sampler for figure, puppet in project.puppets.items()}
    siblings = {figure: sampler for figure, sampler in samplers.items() if sampler is not None}
    yield Derivation(
        kind=HANGING,
        into=joints,
        source=source,
        work=lambda: Joints(document, siblings, earlier).prepare(),
        complaint="The joints cannot be followed between the keys",
    )


def _compare(session: Session, project: Project) -> Iterator[Derivation[Clip, Motion]]:
    """Yield the in-betweens by the method that the viewport shows beside the figures' own."""
    if session.split is None:
        return
    for puppet in project.puppets.values():
        if puppet.twin is None:
            continue
        clip, motion = puppet.twin.clip(project.document), puppet.twin.motion
        sibling = puppet.coarse.value.sampler
        if not motion.value.knows(clip) and not motion.has_failed(clip):
            yield Derivation(
                kind=COMPARING,
                into=motion,
                source=clip,
                work=partial(prepare_motion, clip, motion.value, sibling, at_most=1),
                complaint="The in-betweens to compare with cannot be made",
            )
            return


def _refine(clip: Clip, puppet: Puppet) -> Derivation[Clip, Motion | None]:
    earlier, sibling = puppet.fine.value, puppet.coarse.value.sampler
    return Derivation(
        kind=REFINING,
        into=puppet.fine,
        source=clip,
        work=lambda: _fine_motion(clip, earlier, sibling),
        complaint="The in-betweens cannot be made in full detail",
    )


def _stream(
    session: Session, project: Project, clip: Clip, puppet: Puppet
) -> Iterator[Derivation[Clip, Build | None]]:
    """Yield some steps of a series that is in the making or that is wanted next."""
    if STREAMING in session.jobs.kinds or puppet.build.has_failed(clip):
        return
    motions = [motion for motion in (puppet.coarse.value, puppet.fine.value) if motion is not None]
    build = puppet.build.value
    if build is None or not any(build.is_of(motion) for motion in motions):
        frame = playback.current_frame(session, project)
        heat = session.overlays.heat_map != "none"
        builds = (next_build(motion, clip, frame, heat=heat) for motion in motions)
        build = next(filter(None, builds), None)
    # While the worker has it, it is nowhere else: should a step fail, none follows.
    puppet.build.value = None
    if build is not None:
        yield Derivation(
            kind=STREAMING,
            into=puppet.build,
            source=clip,
            work=build.advance,
            complaint="Playback cannot be made smooth",
            done=partial(_take_series, session, project, clip, puppet),
        )


def _take_series(
    session: Session, project: Project, clip: Clip, puppet: Puppet, build: Build | None
) -> None:
    if build is None or build.series is None:
        puppet.build.take(clip, build)
        return
    frame = playback.current_frame(session, project)
    clip = clip_of(project.document, clip.figure.id)
    puppet.coarse.value = with_series(puppet.coarse.value, build, clip, frame)
    if puppet.fine.value is not None:
        puppet.fine.value = with_series(puppet.fine.value, build, clip, frame)


def _measure(project: Project) -> Iterator[Derivation[Any, Any]]:
    """Yield what is measured of the in-betweens."""
    twin = project.puppet.twin
    wanted = [(project.clip, project.puppet.coarse.value, project.curves)]
    if twin is not None:
        wanted.append((twin.clip(project.document), twin.motion.value, project.twin_curves))
    for clip, motion, curves in wanted:
        is_known = curves.follows(clip) or curves.has_failed(clip) or not motion.knows(clip)
        if intervals(clip) and not is_known:
            yield Derivation(
                kind=MEASURING,
                into=curves,
                source=clip,
                work=partial(measure_curves, clip, motion),
                complaint="The distortion could not be measured",
            )
            return


def _span(project: Project) -> Iterator[Derivation[Any, Any]]:
    """Yield the measurement of where the motion reaches."""
    document, extent = project.document, project.extent
    source = extent_source(document)
    motions = {figure: puppet.coarse.value for figure, puppet in project.puppets.items()}
    if not (extent.follows(source) or extent.has_failed(source)):
        yield Derivation(
            kind=SPANNING,
            into=extent,
            source=source,
            work=lambda: measure_extent(document, motions),
            complaint="The extent of the motion could not be measured",
        )


def _fit_motion(session: Session, project: Project) -> None:
    source = extent_source(project.document)
    if project.extent.follows(source) and project.extent.value is not None:
        viewing.look_at(session, project.extent.value)
    elif project.extent.has_failed(source):
        project.awaits_extent = False


def _show(session: Session, project: Project) -> None:
    """Settle what is drawn in the next frame."""
    frame = playback.current_frame(session, project)
    source, poses = joints_source(project.document), {}
    shown = {}
    for figure, puppet in project.puppets.items():
        if puppet.shown is not None and puppet.shown.frame != frame:
            project.moved_at = session.clock()
        pose = project.unkeyed if figure == project.active else None
        motions = _motions(session, project, puppet)
        clip, seen = clip_of(project.document, figure), puppet.seen.value
        shown[figure] = show(clip, frame, pose, motions, puppet.shown, seen=seen)
        if pose is not None:
            poses[figure] = pose
    joints = project.joints.value if project.joints.follows(source) else None
    for figure, hung in hang_shown(project.document, shown, joints, poses).items():
        project.puppets[figure].shown = hung
    _show_twins(project, frame)


def _show_twins(project: Project, frame: int) -> None:
    """Settle what is drawn beside that; what a pose shows is the same in both."""
    shown = {}
    for figure, puppet in project.puppets.items():
        twin = puppet.twin
        if twin is None or puppet.shown is None:
            return
        pose = project.unkeyed if figure == project.active else None
        earlier = twin.shown or puppet.shown
        shown[figure] = show(
            twin.clip(project.document), frame, pose, (twin.motion.value,), earlier
        )
    # By the meshes alone: the joints that are followed exactly are of the figures' own methods.
    for figure, hung in hang_shown(project.document, shown, None, {}).items():
        if (twin := project.puppets[figure].twin) is not None:
            twin.shown = hung


def _motions(session: Session, project: Project, puppet: Puppet) -> tuple[Motion, ...]:
    is_scrubbed = session.clock() - project.moved_at < STILL
    is_moving = bool(project.pulls) or project.playhead.since is not None or is_scrubbed
    coarse, fine = puppet.coarse.value, puppet.fine.value
    if fine is None or (is_moving and not session.full_detail):
        return (coarse,)
    return (fine, coarse)


def _has_fine(clip: Clip, puppet: Puppet) -> bool:
    coarse, fine = puppet.coarse.value, puppet.fine.value
    is_own = coarse.mesh.domain is clip.figure.domain
    return is_own or (fine is not None and fine.knows(clip))


def _coarse_motion(
    project: Project, clip: Clip, earlier: Motion, frame: int, *, at_most: int | None
) -> Callable[[], Motion]:
    """Return what prepares the motion on few triangles, and keeps what undo and redo lead to."""
    figure, among = clip.figure, len(project.document.figures)
    recalled = [
        clip_of(document, figure.id)
        for document in project.history.nearby
        if figure.id in [other.id for other in document.figures]
    ]

    def prepare() -> Motion:
        known = earlier
        if known.mesh.source is not figure.domain:
            known = Motion.at_rest(clip, PosableMesh.coarse(figure.domain, among=among))
        return prepare_motion(clip, known, at_most=at_most, frame=frame, recalled=recalled)

    return prepare


def _fine_motion(clip: Clip, earlier: Motion | None, sibling: PoseSampler | None) -> Motion:
    domain = clip.figure.domain
    if earlier is None or earlier.mesh.source is not domain:
        earlier = Motion.at_rest(clip, PosableMesh.fine(domain))
    is_sibling = sibling is not None and sibling.domain.cage is domain.cage
    return prepare_motion(clip, earlier, sibling if is_sibling else None, at_most=1)

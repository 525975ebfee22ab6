"""What follows the document by itself: in-betweens, what is measured of them, what is drawn."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Final, TypeVar

from app.document import Clip, clip_of, time_of
from app.editor.actions import playback, posing, rebuilding, viewing
from app.editor.derived import Derived
from app.editor.failures import report
from app.editor.jobs import Job, LaneName
from app.editor.project import Project, Puppet
from app.editor.session import Session
from app.editor.timeline_view import measure_shortfalls
from app.motion import (
    IntervalStore,
    Joints,
    Part,
    PosableMesh,
    PoseSampler,
    extent_source,
    hang_shown,
    joints_source,
    measure_extent,
    show,
    trace_paths,
)
from app.reports import measure_curves
from app.storage import cut_picture, shrink

STILL = 0.15  # seconds after which the playhead is taken to stay where it is
GLIMPSING = "In-between"
SKETCHING, REFINING, STREAMING = "In-betweens", "Finer in-betweens", "Smooth playback"
COMPARING = "Other in-betweens"
UNMADE = "The in-betweens of these keys cannot be made"
# What of a clip's in-betweens the jobs make, and what is said where that cannot be.
PARTS: Final[Mapping[str, tuple[Part, str]]] = {
    GLIMPSING: ("frame", UNMADE),
    SKETCHING: ("in-betweens", UNMADE),
    COMPARING: ("in-betweens", "The in-betweens to compare with cannot be made"),
    REFINING: ("fine", "The in-betweens cannot be made in full detail"),
    STREAMING: ("series", "Playback cannot be made smooth"),
}
MOST_UNASKED = 1000  # frames whose extent is measured before anybody asks
CUTTING = "Cutting out"
MEASURING, SPANNING = "Measuring", "Measuring the motion"
SHRINKING = "Small pictures"
SMALL_SIDE = 96  # pixels of a picture in the list of layers
HANGING, TRACING = "Joints", "Motion paths"

Source = TypeVar("Source")
Value = TypeVar("Value")


def maintain(session: Session) -> None:
    """Ask the worker for what is missing, and settle what is drawn; once a frame."""
    project = session.project
    if project is None:
        return
    posing.settle(session)
    posing.catch_up(session, project)
    project.extent.recall(extent_source(project.document))
    rebuilding.keep_up(session)
    project.pair_up(session.split.method if session.split else None)
    _pin(session, project)
    for job in missing(session, project):
        if job.kind not in session.jobs.kinds:
            session.jobs.put(job)
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


def missing(session: Session, project: Project) -> Iterator[Job]:
    """Yield what the worker is to do next: what is missed most, of any figure."""
    yield from _cut(session, project)
    # First of all: they are watched while the hand moves, and are of few points only.
    yield from _trace(session, project)
    yield from _make_frames(session, project)
    if _awaits_frame(session, project):
        # On few cores it would come much later beside others.
        return
    urgent = next(_own_in_betweens(session, project), None)
    if urgent is not None:
        yield urgent
        return
    if project.is_posing:
        # What follows takes longer than the hand stays where it is.
        return
    if session.export_frame is not None or project.awaits_extent:
        yield from _span(session, project)
    later = next(_other_in_betweens(session, project), None)
    if later is not None:
        yield later
        return
    yield from _hang(session, project)
    yield from _stream(session, project)
    yield from _measure(session, project)
    shown = project.document.frames
    if shown.last - shown.first < MOST_UNASKED:
        yield from _span(session, project)


def _derive(
    session: Session,
    into: Derived[Source, Value],
    source: Source,
    work: Callable[[], Value],
    *,
    kind: str,
    complaint: str,
    lane: LaneName = "display",
    done: Callable[[Value], None] | None = None,
) -> Iterator[Job]:
    """Yield the job that works out the value of a source, unless it is there or cannot be."""

    def failed(error: Exception) -> None:
        into.failure = source
        report(session, complaint, error)

    if not (into.follows(source) or into.has_failed(source)):
        done = done or partial(into.take, source)
        yield Job(kind=kind, work=work, done=done, failed=failed, lane=lane)


def _cut(session: Session, project: Project) -> Iterator[Job]:
    """Yield what is to be cut out of pictures anew, and the small ones of the list of layers."""
    for figure in project.document.figures:
        puppet = project.puppets[figure.id]
        yield from _derive(
            session,
            puppet.cut,
            figure.cut_out,
            partial(cut_picture, puppet.picture, figure.cut_out),
            kind=CUTTING,
            complaint="The picture cannot be cut out so",
        )
    for puppet in project.puppets.values():
        yield from _derive(
            session,
            puppet.small,
            puppet.cut.value,
            partial(shrink, puppet.cut.value.texture, SMALL_SIDE),
            kind=SHRINKING,
            complaint="The picture of a layer cannot be made small",
            # It takes a few milliseconds, and is not to wait until all in-betweens are there.
            lane="hand",
        )


def _pin(session: Session, project: Project) -> None:
    """Tell all stores which clips are present, and to which ones undo and redo lead."""
    frame, tried = playback.current_frame(session, project), posing.tried_clips(session, project)
    for figure, puppet in project.puppets.items():
        own, twin = clip_of(project.document, figure), puppet.twin
        present = [own, *(clip for clip in tried if clip.figure.id == figure)]
        if twin is not None:
            present.append(twin.clip(project.document))
        nearby = [
            clip_of(document, figure)
            for document in project.history.nearby
            if figure in [other.id for other in document.figures]
        ]
        puppet.store.pin(present, nearby, frame)
        if puppet.fine is not None:
            puppet.fine.pin([own], nearby, frame)


def _job(
    session: Session,
    kind: str,
    puppet: Puppet,
    clip: Clip,
    *,
    work: Callable[[], Value],
    done: Callable[[Value], None],
) -> Job:
    """Return a job for some in-betweens of a clip; where it fails, that is told and remembered."""
    part, complaint = PARTS[kind]

    def failed(error: Exception) -> None:
        puppet.store.fail(part, clip)
        report(session, complaint, error)

    lane: LaneName = "hand" if kind == GLIMPSING else "display"
    return Job(kind=kind, work=work, done=done, failed=failed, lane=lane)


def _movable(project: Project) -> list[tuple[Clip, Puppet]]:
    """Return the clips whose in-betweens are there or can be, with their figures."""
    clips = [(clip_of(project.document, figure), each) for figure, each in project.puppets.items()]
    return [(clip, puppet) for clip, puppet in clips if not puppet.store.has_failed(clip)]


def _make_frames(session: Session, project: Project) -> Iterator[Job]:
    """Yield the in-betweens at the playhead, before and beside all others of their intervals."""
    frame = playback.current_frame(session, project)
    for figure, puppet in project.puppets.items():
        clip, store = clip_of(project.document, figure), puppet.store
        is_posed = figure == project.active and project.unkeyed is not None
        # What fails at one frame would at others, and is told of once.
        if is_posed or store.has_failed(clip, "frame"):
            continue
        work = store.making_frame(clip, frame)
        if work is not None:
            yield _job(session, GLIMPSING, puppet, clip, work=work, done=store.take)


def _awaits_frame(session: Session, project: Project) -> bool:
    """Tell whether the first frame of the interval at the playhead is on its way."""
    frame = playback.current_frame(session, project)
    clips = [(clip_of(project.document, figure), each) for figure, each in project.puppets.items()]
    return GLIMPSING in session.jobs.kinds and any(
        not puppet.store.is_exact(clip, frame)
        and puppet.store.interval(clip, time_of(clip, frame).interval) is None
        for clip, puppet in clips
    )


def _own_in_betweens(session: Session, project: Project) -> Iterator[Job]:
    """Yield the document's in-betweens, those at the playhead first, and those of poses tried."""
    frame = playback.current_frame(session, project)
    # Where nobody sees them before the hand rests, they are not worked out for each move.
    is_seen = session.overlays.onion or project.posing is None
    if is_seen or posing.POSING not in session.jobs.kinds:
        # All at once where the hand has changed those around one key, so that the ghosts stay
        # together.
        at_most = None if session.overlays.onion and project.posing is not None else 1
        # Those that something stands in for come first.
        for clip, puppet in sorted(
            _movable(project), key=lambda each: each[1].store.is_exact(each[0], frame)
        ):
            yield from _prepare(session, project, SKETCHING, puppet, clip, at_most=at_most)
    for clip in posing.tried_clips(session, project):
        yield from _prepare(session, project, SKETCHING, project.puppets[clip.figure.id], clip)


def _other_in_betweens(session: Session, project: Project) -> Iterator[Job]:
    """Yield the in-betweens by the method that is compared, and those in full detail."""
    for puppet in project.puppets.values():
        clip = None if puppet.twin is None else puppet.twin.clip(project.document)
        if clip is not None:
            yield from _prepare(session, project, COMPARING, puppet, clip)
    for clip, puppet in _movable(project):
        if puppet.store.mesh.domain is not clip.figure.domain:
            yield from _prepare(session, project, REFINING, puppet, clip)


def _prepare(
    session: Session,
    project: Project,
    kind: str,
    puppet: Puppet,
    clip: Clip,
    *,
    at_most: int | None = 1,
) -> Iterator[Job]:
    """Yield what prepares the nearest in-betweens that a store lacks, or its mesh."""
    is_fine, frame = kind == REFINING, playback.current_frame(session, project)
    store = puppet.fine if is_fine else puppet.store
    if puppet.store.has_failed(clip, PARTS[kind][0]):
        return
    if store is None or store.mesh.source is not clip.figure.domain:
        yield _mesh(session, project, kind, puppet, clip)
    elif (lacking := store.missing(clip, frame)[:at_most]) and (not is_fine or store.has_room()):
        sibling = puppet.store.sampler if is_fine else None
        work = store.preparing(clip, lacking, sibling)
        yield _job(session, kind, puppet, clip, work=work, done=store.take)


def _mesh(session: Session, project: Project, kind: str, puppet: Puppet, clip: Clip) -> Job:
    """Return what makes the mesh of a figure whose domain is another than before."""
    domain, among = clip.figure.domain, len(project.document.figures)

    def work() -> IntervalStore:
        if kind == REFINING:
            return IntervalStore(mesh=PosableMesh.fine(domain))
        return IntervalStore(mesh=PosableMesh.coarse(domain, among=among))

    def done(store: IntervalStore) -> None:
        if kind == REFINING:
            puppet.fine = store
        else:
            puppet.store = store

    return _job(session, kind, puppet, clip, work=work, done=done)


def _trace(session: Session, project: Project) -> Iterator[Job]:
    """Yield the paths of the active figure's handles, while some are shown."""
    clip, paths = project.clip, project.paths
    if session.overlays.paths and project.selected:
        yield from _derive(
            session,
            paths,
            clip,
            partial(trace_paths, clip, paths.value, project.puppet.store.sampler),
            kind=TRACING,
            complaint="The paths of the handles cannot be traced",
        )


def _hang(session: Session, project: Project) -> Iterator[Job]:
    """Yield some frames of the joints of what hangs."""
    document, joints = project.document, project.joints
    source = joints_source(document)
    if not source or joints.follows(source) or HANGING in session.jobs.kinds:
        return
    begun_of, begun = joints.begun or (None, joints.value)
    if begun is None or begun_of != source:
        begun = Joints(document, siblings_of(project), begun)

    def done(advanced: Joints | None) -> None:
        if advanced is not None and advanced.is_whole:
            joints.take(source, advanced)
        else:
            joints.begun = source, advanced

    yield from _derive(
        session,
        joints,
        source,
        begun.advance,
        kind=HANGING,
        complaint="The joints cannot be followed between the keys",
        done=done,
    )


def siblings_of(project: Project) -> dict[int, PoseSampler]:
    """Return what is known of the figures' outlines, by their ids."""
    samplers = {figure: puppet.store.sampler for figure, puppet in project.puppets.items()}
    return {figure: sampler for figure, sampler in samplers.items() if sampler is not None}


def _stream(session: Session, project: Project) -> Iterator[Job]:
    """Yield some steps of a series that is in the making or that is wanted next."""
    if STREAMING in session.jobs.kinds:
        return
    frame, heat = playback.current_frame(session, project), session.overlays.heat_map != "none"
    for clip, puppet in _movable(project):
        if puppet.store.has_failed(clip, "series"):
            continue
        for store in filter(None, (puppet.store, puppet.fine)):
            build = store.next_build(clip, frame, heat=heat)
            if build is not None:
                done = store.take_build
                yield _job(session, STREAMING, puppet, clip, work=build.advance, done=done)
                return


def _measure(session: Session, project: Project) -> Iterator[Job]:
    """Yield what is measured of the in-betweens."""
    store, twin = project.puppet.store, project.puppet.twin
    wanted = [(project.clip, project.curves)]
    if twin is not None:
        wanted.append((twin.clip(project.document), project.twin_curves))
    for clip, curves in wanted:
        inbetweens = store.prepared(clip)
        if inbetweens:
            yield from _derive(
                session,
                curves,
                clip,
                partial(measure_curves, clip, inbetweens),
                kind=MEASURING,
                complaint="The distortion could not be measured",
            )


def _span(session: Session, project: Project) -> Iterator[Job]:
    """Yield the measurement of where the motion reaches."""
    document, extent = project.document, project.extent
    source, stores = extent_source(document), {}
    if extent.follows(source):
        return
    for figure, puppet in project.puppets.items():
        if not puppet.store.has(clip_of(document, figure)):
            return
        stores[figure] = puppet.store.snapshot()
    yield from _derive(
        session,
        extent,
        source,
        partial(measure_extent, document, stores, project.joints.value),
        kind=SPANNING,
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
        clip, stores = clip_of(project.document, figure), _stores(session, project, puppet)
        shown[figure] = show(clip, frame, pose, stores, puppet.shown)
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
        clip = twin.clip(project.document)
        shown[figure] = show(clip, frame, pose, [puppet.store], earlier)
    # By the meshes alone: the joints that are followed exactly are of the figures' own methods.
    for figure, hung in hang_shown(project.document, shown, None, {}).items():
        if (twin := project.puppets[figure].twin) is not None:
            twin.shown = hung


def _stores(session: Session, project: Project, puppet: Puppet) -> list[IntervalStore]:
    """Return where to look for what is drawn of a figure, the preferred mesh first."""
    is_scrubbed = session.clock() - project.moved_at < STILL
    is_moving = project.posing is not None or project.playhead.since is not None or is_scrubbed
    if puppet.fine is None or (is_moving and not session.full_detail):
        return [puppet.store]
    return [puppet.fine, puppet.store]

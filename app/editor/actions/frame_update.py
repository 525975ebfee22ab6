"""Per-frame updates of derived values: in-betweens, measurements and the shown frame."""

from collections.abc import Callable, Iterator
from functools import partial
from math import inf
from typing import TypeVar

from app.document import Clip, clip_of, keyed_pose_at, segment_time_at
from app.editor.actions import playback, viewing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.actions.posing.pose_commit import POSING
from app.editor.actions.posing.pose_solver import update_drag
from app.editor.actions.posing.reach_limit import show_stopped_drag
from app.editor.actions.tracking.correction_jobs import (
    correction_jobs_for_shown_frame,
    next_correction_jobs,
)
from app.editor.actions.tracking.recording import update_track_drags
from app.editor.error_reports import report_failure
from app.editor.parts.timeline import measure_key_errors
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.derived import Derived
from app.editor.work.jobs import Job, JobKind
from app.editor.work.layer_runtime import LayerRuntime
from app.editor.work.revised import revision_getter
from app.motion import (
    DeformMesh,
    Evaluator,
    InbetweenCache,
    InbetweenPart,
    LayerStages,
    MotionPaths,
    ParentTransforms,
    SeriesBuild,
    extent_key,
    find_parent_motion,
    measure_extent,
    parenting_key,
    reuse_corrections,
    trace_paths,
)
from app.reports import CorrectedSample, measure_curves
from app.storage import cut_picture, shrink_picture
from app.texts import _
from engine.domain import MeshedDomain

STILL = 0.15  # seconds after which the playhead counts as resting
MOST_UNASKED = 1000  # frames whose extent is measured unasked
SMALL_SIDE = 96  # pixels of a picture in the list of layers
UNMADE = _("The in-betweens of these keys cannot be made")
# Awaited jobs and jobs of a few milliseconds run on the "hand" lane, ahead of long in-betweens.
GLIMPSING = JobKind(_("In-between"), UNMADE, "hand")
SKETCHING = JobKind(_("In-betweens"), UNMADE)
COMPARING = JobKind(_("Comparison"), _("The compared in-betweens cannot be made"))
REFINING = JobKind(_("Finer in-betweens"), _("The in-betweens cannot be made in full detail"))
STREAMING = JobKind(_("Smooth playback"), _("Playback cannot be made smooth"))
CUTTING = JobKind(_("Cutting out"), _("The picture cannot be cut out with these settings"))
SHRINKING = JobKind(_("Thumbnails"), _("A layer's thumbnail cannot be drawn"), "hand")
ATTACHING = JobKind(_("Joints"), _("The joints cannot be followed between the keys"))
TRACING = JobKind(_("Motion paths"), _("The paths of the handles cannot be traced"))
MEASURING = JobKind(_("Measuring"), _("The distortion could not be measured"))
SPANNING = JobKind(_("Measuring the motion"), _("The extent of the motion could not be measured"))
SESSION_REVISIONS = revision_getter(Session, "jobs")
PROJECT_REVISIONS = revision_getter(Project, "history")

Source = TypeVar("Source")
Value = TypeVar("Value")


@with_project
def bring_poses(session: Session, project: Project) -> None:
    """Show the pose of a drag, and commit it when it rests."""
    update_drag(session, project)
    show_stopped_drag(session, resolving.relax_limits_and_solve)


@with_project
def bring_tracks(session: Session, project: Project) -> None:
    """Commit track drags to the document."""
    update_track_drags(session, project)


@with_project
def ask_for_missing(session: Session, project: Project) -> None:
    """Queue jobs for missing values."""
    inputs = _inputs(session, project)
    # Nothing is missing while the inputs are those of the last complete poll.
    if inputs != project.pending.polled:
        project.pending.note_poll(inputs)
        _follow_document(session, project)
        for job in due_jobs(session, project):
            if job.kind not in session.jobs.kinds:
                session.jobs.put(job)
    target_errors, layer = project.timeline.target_errors, project.layer
    if not target_errors.follows(layer):
        # Cheap: only new poses are measured, and they come one at a time.
        target_errors.set(layer, measure_key_errors(layer, target_errors))


@with_project
def settle_shown(session: Session, project: Project) -> None:
    """Update the shown frame."""
    # Unchanged inputs mean an unchanged frame. The test costs the same for any number of layers.
    if _drawn_of(session, project) != project.pending.settled:
        _show(session, project)
        project.pending.note_shown(_drawn_of(session, project))
    if session.clock() - project.timeline.moved_at >= STILL:
        project.timeline.note_rest()
    if project.viewport.awaits_extent:
        _fit_motion(session, project)


# These run in this order, in a frame after a change. If a step fails, the window goes on with the
# next one.
STEPS: tuple[Callable[[Session], None], ...] = (
    bring_poses,
    bring_tracks,
    resolving.rebuild_changed_cut_out,
    preset_setup.update_motion_setup,
    ask_for_missing,
    settle_shown,
)


def session_revision(session: Session) -> tuple[int, ...]:
    """Return a value that differs after any change that a step of the frame depends on."""
    project = session.project
    own = SESSION_REVISIONS(session)
    return own if project is None else own + PROJECT_REVISIONS(project)


def is_due_in_time(session: Session) -> bool:
    """Return whether a step depends on the clock, or on a drag that is not at rest."""
    project = session.project
    if project is None:
        return session.tutorial.state is not None
    return (
        project.timeline.playhead.since is not None
        or session.tutorial.state is not None
        or project.layer_setup.stale is not None
        or project.timeline.moved_at > -inf
        or bool(project.pending.changes or project.pending.deferred)
        or session.tools.active_tool is not None
    )


@with_project
def follow_playhead(session: Session, project: Project) -> None:
    """Update the shown frame to the present time while the playhead runs."""
    if project.timeline.playhead.since is not None:
        _show(session, project)


def _inputs(session: Session, project: Project) -> tuple[object, ...]:
    """Return all values that decide which jobs are due."""
    take, history, chosen = project.timeline.recording, project.history, project.selection
    return (
        *(project.document, history.position, history.is_held, history.is_unfinished),
        *(chosen.active, chosen.handles),
        *(playback.current_frame(session, project), project.timeline.playhead.since is None),
        *(session.jobs.kinds, session.jobs.delivered, session.settings.prepares_ahead),
        *(session.display.overlays, session.display.compare_view, session.export.frame_box),
        *(project.viewport.awaits_extent, session.tools.active_tool, session.tools.mode),
        *(project.selected_track, take, take and (take.is_over, len(take.samples))),
        *(project.unkeyed_pose, tuple(project.pending.changes)),
        tuple(runtime.store for runtime in project.runtimes.layers.values()),
    )


def _drawn_of(session: Session, project: Project) -> tuple[object, ...]:
    """Return all values that decide the shown frame, and the shown frame itself."""
    runtimes = project.runtimes.layers.values()
    return (
        *(_inputs(session, project), _is_moving(session, project)),
        *((each.shown, each.fine, each.corrected, each.comparison) for each in runtimes),
    )


def _follow_document(session: Session, project: Project) -> None:
    """Update or recall derived values after a change of the document."""
    for identity, runtime in project.runtimes.layers.items():
        runtime.corrected = reuse_corrections(project.document, identity, runtime.corrected)
    project.measured.extent.recall(extent_key(project.document))
    project.update_comparisons(
        session.display.compare_view.method if session.display.compare_view else None
    )
    if project.visible_drag is None or _is_final(session, project):
        _pin(session, project)


def _is_final(session: Session, project: Project) -> bool:
    """Return whether in-betweens are worth preparing: a drag changes them until it rests."""
    is_at_rest = project.drag is not None and project.drag.is_at_rest
    return not project.history.is_unfinished or is_at_rest or session.display.overlays.onion


def give_up(session: Session, kind: JobKind) -> None:
    """Abandon a job that takes too long; its work is reported as failed."""
    session.jobs.abandon(kind)


def _pin(session: Session, project: Project) -> None:
    """Note in all caches the present clips, and the clips that undo and redo lead to."""
    frame = playback.current_frame(session, project)
    for clip, runtime in _clips(project):
        layer, comparison = clip.layer.id, runtime.comparison
        others = [] if comparison is None else [comparison.clip(project.document)]
        nearby = [
            clip_of(document, layer)
            for document in project.history.nearby
            if layer in [other.id for other in document.layers]
        ]
        runtime.store.set_needed_clips([clip, *others], nearby, frame)
        if runtime.fine is not None:
            runtime.fine.set_needed_clips([clip], nearby, frame)


def due_jobs(session: Session, project: Project) -> Iterator[Job]:
    """Yield the next jobs of any layer, the most urgent first."""
    yield from _cut(session, project)
    # Motion paths come first: the person watches them during a drag, and they are of few points.
    yield from _trace(session, project)
    if _asks_extent(session, project) and not project.history.is_unfinished:
        yield from _span(session, project)
    yield from _make_frames(session, project)
    yield from correction_jobs_for_shown_frame(session, project)
    if _awaits_frame(session, project):
        # On few cores other jobs would delay this frame.
        return
    for kind, runtime, clip in _wanted(session, project):
        if not runtime.store.has_failed(clip, _part(kind)):
            job = _prepare(session, project, kind, runtime, clip)
            if job is not None:
                room = None
                if runtime is not project.layer_runtime and project.is_crowded:
                    if STREAMING in session.jobs.kinds:
                        return
                    room = next(_stream(session, project), None)
                yield room or job
                return
    if project.history.is_unfinished:
        # The jobs below take longer than a pause of the drag.
        return
    if _prepares_all(session, project):
        yield from next_correction_jobs(session, project)
    yield from _compute_joints(session, project)
    if not session.settings.prepares_ahead:
        return
    yield from _stream(session, project)
    yield from _measure(session, project)
    if project.document.frames.last - project.document.frames.first < MOST_UNASKED:
        yield from _span(session, project)


def _asks_extent(session: Session, project: Project) -> bool:
    """Return whether the extent of the motion is awaited."""
    return session.export.frame_box is not None or project.viewport.awaits_extent


def _prepares_all(session: Session, project: Project) -> bool:
    """Return whether all frames are prepared, not only the shown one."""
    return (
        session.settings.prepares_ahead
        or session.display.overlays.onion
        or _asks_extent(session, project)
    )


def _clips(project: Project) -> list[tuple[Clip, LayerRuntime]]:
    return [(each.clip(project.document), each) for each in project.runtimes.layers.values()]


def _make_frames(session: Session, project: Project) -> Iterator[Job]:
    """Yield jobs for the in-between at the playhead, ahead of the rest of its segment."""
    frame = playback.current_frame(session, project)
    for clip, runtime in _clips(project):
        is_posed = clip.layer.id == project.selection.active and project.unkeyed_pose is not None
        # A failure at one frame would repeat at others; it is reported once.
        if not is_posed and not runtime.store.has_failed(clip, "frame"):
            work = runtime.store.frame_job(clip, frame)
            if work is not None:
                done = runtime.store.add
                yield _interval_job(session, GLIMPSING, runtime, clip, work=work, done=done)


def _awaits_frame(session: Session, project: Project) -> bool:
    """Return whether the first frame of the segment at the playhead is pending."""
    if GLIMPSING not in session.jobs.kinds:
        return False
    frame = playback.current_frame(session, project)
    moments = ((segment_time_at(clip, frame), clip, runtime) for clip, runtime in _clips(project))
    return any(
        keyed_pose_at(clip, moment) is None
        and not runtime.store.is_exact(clip, frame)
        and runtime.store.segment(clip, moment.segment) is None
        for moment, clip, runtime in moments
    )


def _wanted(session: Session, project: Project) -> Iterator[tuple[JobKind, LayerRuntime, Clip]]:
    """Yield the clips that need in-betweens, the most urgent first."""
    frame, clips = playback.current_frame(session, project), _clips(project)
    clips = [(clip, runtime) for clip, runtime in clips if not runtime.store.has_failed(clip)]
    prepares_all = _is_final(session, project) and _prepares_all(session, project)

    def is_wanted(clip: Clip, store: InbetweenCache) -> bool:
        return prepares_all or not store.is_exact(clip, frame)

    # In-betweens that are not visible during a drag are not computed for each move.
    is_seen = session.display.overlays.onion or project.visible_drag is None
    if is_seen or POSING not in session.jobs.kinds:
        # Clips whose shown frame is an approximation come first.
        for clip, runtime in sorted(clips, key=lambda each: each[1].store.is_exact(each[0], frame)):
            if is_wanted(clip, runtime.store):
                yield SKETCHING, runtime, clip
    if project.history.is_unfinished:
        return
    for runtime in project.runtimes.layers.values():
        if runtime.comparison is not None:
            comparison = runtime.comparison.clip(project.document)
            if is_wanted(comparison, runtime.store):
                yield COMPARING, runtime, comparison
    for clip, runtime in clips:
        if runtime.store.mesh.domain is not clip.layer.domain and (
            runtime.fine is None or is_wanted(clip, runtime.fine)
        ):
            yield REFINING, runtime, clip


def _prepare(
    session: Session, project: Project, kind: JobKind, runtime: LayerRuntime, clip: Clip
) -> Job | None:
    """Return the job for the nearest in-betweens that a clip lacks, or for its mesh."""
    domain, among = clip.layer.domain, len(project.runtimes.layers)
    is_fine, frame = kind == REFINING, playback.current_frame(session, project)
    store = runtime.fine if is_fine else runtime.store
    if store is None or store.mesh.source is not domain:
        make = DeformMesh.fine if is_fine else partial(DeformMesh.coarse, among=among)

        def begin(mesh: DeformMesh) -> None:
            setattr(runtime, "fine" if is_fine else "store", InbetweenCache(mesh=mesh))

        work = partial(_prepared, make, domain)
        return _interval_job(session, kind, runtime, clip, work=work, done=begin)
    is_edited = runtime is project.layer_runtime and not is_fine
    lacking = store.missing_segments(clip, frame, is_edited=is_edited)
    if store.lacks_sampler(clip):
        # A correction of a frame at a key needs no in-betweens.
        lacking = []
    elif not lacking:
        return None
    if is_fine and not store.has_room():
        return None
    # During a drag with onion skin all are made at once, so that the ghosts stay together.
    # Otherwise one at a time, so that more urgent jobs do not wait long.
    if not (session.display.overlays.onion and project.visible_drag is not None):
        lacking = lacking[:1]
    prepare = store.segments_job(clip, lacking, runtime.store.sampler)
    return _interval_job(session, kind, runtime, clip, work=prepare, done=store.add)


def _prepared(make: Callable[[MeshedDomain], DeformMesh], domain: MeshedDomain) -> DeformMesh:
    return make(domain).prepared()


def _stream(session: Session, project: Project) -> Iterator[Job]:
    """Yield some steps of a series in progress or of the next series."""
    frame, heat = (
        playback.current_frame(session, project),
        session.display.overlays.heat_map != "none",
    )
    for clip, runtime in _clips(project):
        for store in filter(None, (runtime.store, runtime.fine)):
            if STREAMING in session.jobs.kinds or runtime.store.has_failed(clip, "series"):
                break
            build = store.next_build(clip, frame, heat=heat)
            if build is not None:
                done = partial(_take_build, project, store)
                yield _interval_job(
                    session, STREAMING, runtime, clip, work=build.advance, done=done
                )


def _take_build(project: Project, store: InbetweenCache, build: SeriesBuild) -> None:
    """Store a series; if memory is crowded, free its intermediate values."""
    store.add_build(build)
    project.free_memory()


def _part(kind: JobKind) -> InbetweenPart:
    parts: dict[JobKind, InbetweenPart] = {
        GLIMPSING: "frame",
        REFINING: "fine",
        STREAMING: "series",
    }
    return parts.get(kind, "in-betweens")


def _interval_job(
    session: Session,
    kind: JobKind,
    runtime: LayerRuntime,
    clip: Clip,
    *,
    work: Callable[[], Value],
    done: Callable[[Value], None],
) -> Job:
    """Return a job for in-betweens; a failed job is not repeated for the same keys."""
    return _job(session, kind, work, done, lambda: runtime.store.mark_failed(_part(kind), clip))


def _job(
    session: Session,
    kind: JobKind,
    work: Callable[[], Value],
    done: Callable[[Value], None],
    fail: Callable[[], None],
) -> Job:
    def failed(error: Exception) -> None:
        fail()
        report_failure(session, kind.complaint, error)

    return Job(kind=kind, work=work, done=done, failed=failed)


def _derive(
    session: Session,
    kind: JobKind,
    into: Derived[Source, Value],
    source: Source,
    work: Callable[[], Value],
) -> Iterator[Job]:
    """Yield the job for the value of a source, unless the value exists or has failed."""
    if not (into.follows(source) or into.has_failed(source)):
        yield _job(session, kind, work, partial(into.set, source), partial(into.fail, source))


def _cut(session: Session, project: Project) -> Iterator[Job]:
    """Yield jobs for new cut-outs, and for the small pictures of the list of layers."""
    for layer in project.document.layers:
        runtime, cut_out = project.runtimes.layers[layer.id], layer.cut_out
        cut = partial(cut_picture, runtime.picture, cut_out)
        yield from _derive(session, CUTTING, runtime.cut, cut_out, cut)
        whole = runtime.cut.value
        small = partial(shrink_picture, whole.texture, SMALL_SIDE)
        yield from _derive(session, SHRINKING, runtime.small, whole, small)


def _trace(session: Session, project: Project) -> Iterator[Job]:
    """Yield the job for motion paths of the active layer's handles, while some are shown."""
    clip, paths = project.clip, project.measured.paths
    if session.display.overlays.paths and project.selection.handles:
        document, known, siblings = project.document, paths.value, project.samplers
        sibling = project.layer_runtime.store.sampler

        def trace() -> MotionPaths:
            carried = find_parent_motion(document, clip.layer.id, siblings)
            return trace_paths(clip, known, sibling, carried)

        yield from _derive(session, TRACING, paths, clip, trace)


def _compute_joints(session: Session, project: Project) -> Iterator[Job]:
    """Yield a job for some frames of the joints of attached layers."""
    joints, source = project.measured.parent_transforms, parenting_key(project.document)
    is_settled = not source or joints.follows(source) or joints.has_failed(source)
    if is_settled or ATTACHING in session.jobs.kinds:
        return
    begun_of, begun = joints.begun or (None, joints.value)
    if begun is None or begun_of != source:
        begun = ParentTransforms(project.document, project.samplers, begun)

    def done(advanced: ParentTransforms) -> None:
        joints.begun = source, advanced
        if advanced.is_whole:
            joints.set(source, advanced)

    yield _job(session, ATTACHING, begun.advance, done, partial(joints.fail, source))


def _measure(session: Session, project: Project) -> Iterator[Job]:
    """Yield jobs that measure the distortion of the in-betweens."""
    comparison, wanted = project.layer_runtime.comparison, [(project.clip, project.measured.curves)]
    if comparison is not None:
        wanted.append((comparison.clip(project.document), project.measured.comparison_curves))
    store, corrected = project.layer_runtime.store, project.layer_runtime.corrected
    for clip, curves in wanted:
        inbetweens = store.prepared(clip)
        own = corrected if corrected is not None and corrected.corrects(clip) else None
        if inbetweens and (own is None or own.is_whole):
            at = None
            if own is not None and store.sampler is not None:
                at = CorrectedSample(own, store.sampler)
            measure = partial(measure_curves, clip, inbetweens, at)
            yield from _derive(session, MEASURING, curves, clip, measure)


def _span(session: Session, project: Project) -> Iterator[Job]:
    """Yield the job that measures the extent of the motion, once all in-betweens exist."""
    document, extent, source = (
        project.document,
        project.measured.extent,
        extent_key(project.document),
    )
    clips = _clips(project)
    if extent.follows(source) or not all(each.store.has(clip) for clip, each in clips):
        return
    if not all(each.corrected is None or each.corrected.is_whole for _, each in clips):
        return
    stages = {
        layer: LayerStages(layer_id=layer, store=each.store.snapshot(), corrected=each.corrected)
        for layer, each in project.runtimes.layers.items()
    }
    evaluator = Evaluator(layers=stages, transforms=project.measured.parent_transforms.value)
    span = partial(measure_extent, document, evaluator)
    yield from _derive(session, SPANNING, extent, source, span)


def _fit_motion(session: Session, project: Project) -> None:
    source = extent_key(project.document)
    if project.measured.extent.follows(source) and project.measured.extent.value is not None:
        viewing.zoom_to_box(session, project.measured.extent.value)
    elif project.measured.extent.has_failed(source):
        project.viewport.stop_awaiting_extent()


def _show(session: Session, project: Project) -> None:
    """Update the shown frame, and the frame of the compared method."""
    frame, document = playback.current_frame(session, project), project.document
    if project.timeline.recording is not None and project.layer_runtime.corrected is not None:
        project.layer_runtime.corrected.lead(frame)
    runtimes = project.runtimes.layers
    if any(each.shown and each.shown.frame != frame for each in runtimes.values()):
        project.timeline.note_move(session.clock())
    pose, active = project.unkeyed_pose, project.selection.active
    poses = {} if pose is None else {active: pose}
    is_coarse = _is_moving(session, project)
    displayed = project.evaluator.evaluate(
        document, frame, "display", poses=poses, is_coarse=is_coarse
    )
    # Without transforms by parents, which belong to the layers' own methods. An unkeyed pose is the
    # same in both methods.
    others = {layer: each.comparison for layer, each in runtimes.items() if each.comparison}
    compared = Evaluator(layers=others).evaluate(document, frame, "display", poses=poses)
    project.runtimes.show(displayed, compared)


def _is_moving(session: Session, project: Project) -> bool:
    """Return whether the shown frame changes too fast for fine meshes."""
    is_scrubbed = session.clock() - project.timeline.moved_at < STILL
    is_moving = (
        project.visible_drag is not None
        or project.timeline.playhead.since is not None
        or is_scrubbed
    )
    return is_moving and not session.display.full_detail

"""Jobs for stages that frames lack: of the shown frame first, then of the others."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import TypeVar

from app.document import Clip, keyed_pose_at, segment_time_at
from app.editor.actions import playback
from app.editor.actions.posing.pose_commit import POSING
from app.editor.actions.updates.correction_jobs import (
    correction_jobs_for_shown_frame,
    next_correction_jobs,
)
from app.editor.actions.updates.measuring_jobs import (
    asks_extent,
    cut_out_jobs,
    distortion_jobs,
    extent_jobs,
    make_job,
    motion_path_jobs,
)
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.jobs import Job, JobKind
from app.editor.work.layer_runtime import LayerRuntime
from app.motion import (
    DeformMesh,
    InbetweenCache,
    InbetweenPart,
    ParentTransforms,
    SeriesBuild,
    parenting_key,
)
from app.texts import _

UNMADE = _("The in-betweens of these keys cannot be made")
# Awaited jobs and jobs of a few milliseconds run on the "hand" lane, ahead of long in-betweens.
GLIMPSING = JobKind(_("In-between"), UNMADE, "hand")
SKETCHING = JobKind(_("In-betweens"), UNMADE)
COMPARING = JobKind(_("Comparison"), _("The compared in-betweens cannot be made"))
REFINING = JobKind(
    _("In-betweens in full detail"), _("The in-betweens cannot be made in full detail")
)
STREAMING = JobKind(_("Smooth playback"), _("Playback cannot be made smooth"))
ATTACHING = JobKind(_("Joints"), _("The joints cannot be followed between the keys"))
MOST_UNASKED = 1000  # frames whose extent is measured unasked

Value = TypeVar("Value")


def due_jobs(session: Session, project: Project) -> Iterator[Job]:
    """Yield the next jobs of any layer, the most urgent first."""
    yield from cut_out_jobs(session, project)
    # Motion paths come first: the person watches them during a drag, and they are of few points.
    yield from motion_path_jobs(session, project)
    if asks_extent(session, project) and not project.history.is_unfinished:
        yield from extent_jobs(session, project)
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
    if _is_unfinished(project):
        # The jobs below take longer than a pause of the drag.
        return
    if _prepares_all(session, project):
        yield from next_correction_jobs(session, project)
    yield from _compute_joints(session, project)
    if not session.settings.prepares_ahead:
        return
    yield from _stream(session, project)
    yield from distortion_jobs(session, project)
    if project.document.frames.last - project.document.frames.first < MOST_UNASKED:
        yield from extent_jobs(session, project)


def give_up(session: Session, kind: JobKind) -> None:
    """Abandon a job that takes too long; its work is reported as failed."""
    session.jobs.abandon(kind)


def _make_frames(session: Session, project: Project) -> Iterator[Job]:
    """Yield jobs for the in-between at the playhead, ahead of the rest of its segment."""
    frame = playback.current_frame(session, project)
    for clip, runtime in project.clips:
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
    moments = ((segment_time_at(clip, frame), clip, runtime) for clip, runtime in project.clips)
    return any(
        keyed_pose_at(clip, moment) is None
        and not runtime.store.is_exact(clip, frame)
        and runtime.store.segment(clip, moment.segment) is None
        for moment, clip, runtime in moments
    )


def _wanted(session: Session, project: Project) -> Iterator[tuple[JobKind, LayerRuntime, Clip]]:
    """Yield the clips that need in-betweens, the most urgent first."""
    frame, clips = playback.current_frame(session, project), project.clips
    clips = [(clip, runtime) for clip, runtime in clips if not runtime.store.has_failed(clip)]
    prepares_all = is_worth_preparing(session, project) and _prepares_all(session, project)

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
    if _is_unfinished(project):
        return
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
            store = InbetweenCache(mesh=mesh, budget=project.runtimes.budget)
            setattr(runtime, "fine" if is_fine else "store", store)

        def work() -> DeformMesh:
            return make(domain).prepared(clip, frame)

        return _interval_job(session, kind, runtime, clip, work=work, done=begin)
    if runtime is project.layer_runtime and store.mesh.is_released:
        prepare_mesh, done = partial(store.mesh.prepared, clip, frame), lambda _mesh: None
        return _interval_job(session, kind, runtime, clip, work=prepare_mesh, done=done)
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


def _stream(session: Session, project: Project) -> Iterator[Job]:
    """Yield some steps of a series in progress or of the next series."""
    frame, heat = (
        playback.current_frame(session, project),
        session.display.overlays.heat_map != "none",
    )
    for clip, runtime in project.clips:
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
    return make_job(session, kind, work, done, lambda: runtime.store.mark_failed(_part(kind), clip))


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

    yield make_job(session, ATTACHING, begun.advance, done, partial(joints.fail, source))


def _prepares_all(session: Session, project: Project) -> bool:
    """Return whether all frames are prepared, not only the shown one."""
    return (
        session.settings.prepares_ahead
        or session.display.overlays.onion
        or asks_extent(session, project)
    )


def is_worth_preparing(session: Session, project: Project) -> bool:
    """Return whether in-betweens are worth preparing: a drag changes them until it rests."""
    is_at_rest = project.drag is not None and project.drag.is_at_rest
    return not _is_unfinished(project) or is_at_rest or session.display.overlays.onion


def _is_unfinished(project: Project) -> bool:
    """Return whether more of the last change is to come, such as the first drag of a new handle.

    A new handle moves nothing, but others move by it once it is dragged. In-betweens that the
    person watches are made at once.
    """
    is_new = project.pose_edits.with_new_handles is project.document
    awaits_drag = is_new and project.timeline.playhead.since is None
    return project.history.is_unfinished or awaits_drag

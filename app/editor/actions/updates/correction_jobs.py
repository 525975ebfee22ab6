"""Jobs for corrected frames: the shown frame first, then all others."""

from collections.abc import Callable, Iterator
from functools import partial

from app.document import Clip
from app.editor.actions import playback
from app.editor.actions.updates.measuring_jobs import make_job
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.jobs import Job, JobKind
from app.editor.work.layer_runtime import LayerRuntime
from app.motion import CorrectedFrames, CorrectionUpdate
from app.texts import _

COMPLAINT = _("The handles cannot follow their tracks")
CORRECTING = JobKind(_("Motion of tracks and springs"), COMPLAINT)
CORRECTING_SHOWN_FRAME = JobKind(_("Tracks and springs of this frame"), COMPLAINT, "hand")
# Base motions of tracks whose handles may be dragged.
FINDING_BASE_FRAMES = JobKind(_("Places on tracks"), COMPLAINT, "hand")

Work = Callable[[], CorrectionUpdate]


def next_correction_jobs(session: Session, project: Project) -> Iterator[Job]:
    """Yield the job for corrections of some frames, nearest to the playhead first."""
    frame = playback.current_frame(session, project)
    if CORRECTING not in session.jobs.kinds:
        for clip, runtime, corrected in _corrected(project):
            work = corrected.missing(project.document, frame, project.samplers)
            if work is not None:
                yield _job(session, project, CORRECTING, runtime, clip, work)
                return


def correction_jobs_for_shown_frame(session: Session, project: Project) -> Iterator[Job]:
    """Yield jobs for the shown frame's correction, and for base motions that drags need."""
    # A visible pose drag comes first.
    if not (session.settings.prepares_ahead and project.visible_drag is not None):
        yield from _follow(session, project)
        yield from _ground(session, project)


def _follow(session: Session, project: Project) -> Iterator[Job]:
    is_playing = project.timeline.playhead.since is not None
    if CORRECTING_SHOWN_FRAME in session.jobs.kinds or (
        is_playing and project.timeline.recording is None
    ):
        # During playback the correction would come too late.
        return
    frame, is_urgent = playback.current_frame(session, project), project.history.is_unfinished
    for clip, runtime, corrected in _corrected(project):
        work = corrected.missing_here(project.document, frame, project.samplers)
        # The next pose drag must not wait until all frames are prepared.
        is_wanted = corrected.is_begun or is_urgent or not session.settings.prepares_ahead
        if work is not None and is_wanted:
            yield _job(session, project, CORRECTING_SHOWN_FRAME, runtime, clip, work)
            return


def _ground(session: Session, project: Project) -> Iterator[Job]:
    wanted = (
        session.tools.mode == "record"
        or project.selected_track is not None
        or project.pending_track_keys
        or project.timeline.recording
    )
    if not wanted or FINDING_BASE_FRAMES in session.jobs.kinds:
        return
    frames = [pending.target.frame for pending in project.pending_track_keys]
    frame = frames[0] if frames else playback.current_frame(session, project)
    for clip, runtime, corrected in _corrected(project):
        if clip.layer.id == project.selection.active:
            work = corrected.missing_ground(project.document, frame, project.samplers)
            if work is not None:
                yield _job(session, project, FINDING_BASE_FRAMES, runtime, clip, work)


def _corrected(project: Project) -> Iterator[tuple[Clip, LayerRuntime, CorrectedFrames]]:
    for clip, runtime in project.clips:
        if runtime.corrected is not None and not runtime.store.has_failed(clip, "correction"):
            yield clip, runtime, runtime.corrected


def _job(
    session: Session, project: Project, kind: JobKind, runtime: LayerRuntime, clip: Clip, work: Work
) -> Job:
    """Return a job for corrections; a failed job is not repeated for the same keys."""

    def done(found: CorrectionUpdate) -> None:
        # The drag may have moved on meanwhile.
        if runtime.corrected is not None:
            runtime.corrected.take(found, is_newest=kind == CORRECTING_SHOWN_FRAME)
            project.free_memory()

    fail = partial(runtime.store.mark_failed, "correction", clip)
    return make_job(session, kind, work, done, fail)

"""Per-frame updates of derived values: in-betweens, measurements and the shown frame."""

from collections.abc import Callable
from math import inf

from app.document import clip_of
from app.editor.actions import playback, viewing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.actions.posing.pose_solver import update_drag
from app.editor.actions.posing.reach_limit import show_stopped_drag
from app.editor.actions.timing import sounds
from app.editor.actions.tracking.recording import update_track_keys
from app.editor.actions.updates.footage_jobs import decode_footage
from app.editor.actions.updates.stage_jobs import due_jobs, is_worth_preparing
from app.editor.parts.timeline.timeline_state import measure_key_errors
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.revised import revision_getter
from app.motion import (
    Evaluator,
    extent_key,
    reuse_corrections,
)

STILL = 0.15  # seconds after which the playhead counts as resting
SESSION_REVISIONS = revision_getter(Session, "jobs")
PROJECT_REVISIONS = revision_getter(Project, "history")


@with_project
def bring_poses(session: Session, project: Project) -> None:
    """Show the pose of a drag, and commit it when it rests."""
    update_drag(session, project)
    show_stopped_drag(session, resolving.relax_limits_and_solve)


@with_project
def bring_tracks(session: Session, project: Project) -> None:
    """Key what is dragged or recorded on tracks."""
    update_track_keys(session, project)


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
    decode_footage,
    sounds.update_waveforms,
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
    if not project.history.is_unfinished:
        project.measured.extent.recall(extent_key(project.document))
    project.update_comparisons(
        session.display.compare_view.method if session.display.compare_view else None
    )
    if project.visible_drag is None or is_worth_preparing(session, project):
        _pin(session, project)


def _pin(session: Session, project: Project) -> None:
    """Note in all caches the present clips, and the clips that undo and redo lead to."""
    frame = playback.current_frame(session, project)
    for clip, runtime in project.clips:
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
    if project.motion_job is not None and project.visible_drag is None:
        displayed = project.motion_job.show_pose(displayed)
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

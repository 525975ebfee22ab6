"""Drags that are recorded while the timeline plays, and fitted by few keys."""

from dataclasses import replace

from app.document import (
    Track,
    TrackKey,
    track_at,
    track_commands,
    track_source_frame,
)
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.posing.pose_drag import release_drag
from app.editor.actions.tracking.smoothing import fit_recording
from app.editor.actions.tracking.track_dragging import key_pending_targets, key_track_target
from app.editor.actions.tracking.track_space import base_frame_at, handle_index
from app.editor.error_reports import report_failure
from app.editor.parts.tools import CLICK
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.track_keys import RecordedSample, Recording, TrackTarget
from app.errors import LissomError
from app.motion import BaseMotionFrame, reuse_corrections
from app.texts import _
from engine.geometry import Similarity

RECORDING_SPEEDS = (1.0, 0.5, 0.25)
SMOOTHING = 0.3  # initial value
NO_RECORDING = _("The recording could not be keyed")
IDLE = _("Nothing is being recorded.")


@named_action(
    _("Record drag"),
    "R",
    icon="CIRCLE",
    hint=_("Record the next drag of a handle, while the timeline plays"),
    why_disabled=unless(
        lambda session, project: session.tools.mode == "record" or project.layer.handles,
        _("Click on the drawing to add a handle. Then drag it to record."),
    ),
    active=lambda session: session.tools.mode == "record",
)
def toggle_recording_armed(session: Session) -> None:
    """Arm the next drag of a handle for recording, or disarm it; earlier recordings stay."""
    accept_recording(session)
    if session.tools.mode == "record":
        session.tools.select("pose")
    else:
        playback.stop_playback(session)
        release_drag(session)
        session.tools.select("record")


def set_recording_speed(session: Session, speed: float) -> None:
    """Set the playback speed while a drag is recorded."""
    session.tools.set_recording_speed(speed)


@with_project
def start_recording(
    session: Session, project: Project, handle: int, place: complex, *, gesture: object
) -> None:
    """Begin to record a drag of a handle, which is at a place of the scene."""
    session.tools.select("pose")
    track, document = project.layer.track_of(handle), project.document
    standing = project.timeline.playhead
    running = replace(standing, speed=session.tools.recording_speed).play(document, session.clock())
    frames, played = document.frames, document.played_frames
    # A recording goes on over a loop's end, at most once round. The end of a preview range jumps.
    goes_round = document.loop and played == frames
    take = Recording(
        layer=project.selection.active,
        handle=handle if track is None else track.handles[0],
        gesture=gesture,
        playhead=running,
        last=running.frame + frames.last - frames.first if goes_round else played.last,
        speed=standing.speed,
        place=place,
        scale=project.view_on(session.display.screen).scale,
        smoothing=SMOOTHING,
    )
    project.history.hold(gesture)
    project.timeline.start_recording(take)


@with_project
def drag_recorded_handle(_: Session, project: Project, place: complex) -> None:
    """Set the target of the recorded handle, a place of the scene."""
    if project.timeline.recording is not None:
        project.timeline.recording.place = place


@with_project
def stop_recording(session: Session, project: Project, *, has_moved: bool = True) -> None:
    """End a recording; the playhead goes back. Without a move, it is kept if the body moved."""
    take = project.timeline.recording
    if take is None or take.is_over:
        return
    if session.tools.active_tool is take.gesture:
        session.tools.end()
    take.is_over, take.has_moved = True, has_moved
    project.history.release(take.gesture)
    project.timeline.stop_recording()
    if take.layer == project.selection.active:
        project.selection.select_track(project.layer, take.handle)
        project.timeline.show_lanes(take.layer)


def accept_recording(session: Session) -> None:
    """Keep the recorded keys."""
    stop_recording(session)
    if session.project is not None:
        session.project.timeline.forget_recording()


@named_action(
    _("Discard recording"),
    "Escape",
    why_disabled=unless(
        lambda session, project: session.tools.mode == "record" or project.timeline.recording, IDLE
    ),
)
@with_project
def discard_recording(session: Session, project: Project) -> None:
    """Undo the recording, or disarm recording."""
    take = project.timeline.recording
    session.tools.leave("record")
    if take is not None:
        stop_recording(session)
        editing.revert_gesture(session, take.gesture)
        project.timeline.forget_recording()


def retry_recording(session: Session) -> None:
    """Undo the recording, and arm the next drag."""
    discard_recording(session)
    session.tools.select("record")


@with_project
def smooth_recording(_: Session, project: Project, smoothing: float) -> None:
    """Smooth the recorded motion, from 0 to 1."""
    take = project.timeline.recording
    if take is not None and take.is_written and project.history.is_open(take.gesture):
        take.smoothing = smoothing
        _write(project, take)


def update_track_keys(session: Session, project: Project) -> None:
    """Advance pending keys of tracks, and the recording; once a frame."""
    if not (project.pending_track_keys or project.timeline.recording):
        return
    active, runtime = project.selection.active, project.layer_runtime
    runtime.corrected = reuse_corrections(project.document, active, runtime.corrected)
    key_pending_targets(session, project)
    take = project.timeline.recording
    if take is None:
        return
    is_here = take.layer == active and take.handle in [h.id for h in project.layer.handles]
    is_cut = take.is_written and not project.history.is_open(take.gesture)
    if not is_here or is_cut or project.history.has_ended(take.gesture):
        # A later edit or undo ends the recording.
        accept_recording(session)
    elif not take.is_over:
        _record(session, project, take)
    elif not take.is_written and _is_click(project, take):
        discard_recording(session)
    elif not take.is_written:
        try:
            _write(project, take)
        except LissomError as error:
            report_failure(session, NO_RECORDING, error)
            discard_recording(session)


def _record(session: Session, project: Project, take: Recording) -> None:
    """Add a sample of the handle's place at this moment, and show it."""
    since, now, shown = take.playhead.since, session.clock(), project.layer_runtime.shown
    if since is None:
        return
    gone = (now - since) * project.document.fps * take.playhead.speed
    time = min(take.playhead.frame + gone, float(take.last))
    sample = RecordedSample(time, take.place)
    if take.samples and take.samples[-1].time == time:
        take.samples[-1] = sample
    else:
        take.samples.append(sample)
    if shown is not None:
        frame = playback.current_frame(session, project)
        (placement,) = project.placements([frame], shown.placement)
        target = TrackTarget(
            layer=take.layer,
            handle=take.handle,
            frame=frame,
            place=placement.apply_inverse(take.place),
        )
        key_track_target(session, project, target, take.gesture)
    if project.timeline.playhead is not take.playhead or time == take.last:
        stop_recording(session)


def _is_click(project: Project, take: Recording) -> bool:
    """Return whether the pointer rested on a body that is not known to have moved."""
    if take.has_moved:
        return False
    times = [sample.time for sample in take.samples]
    if not times or times[-1] < times[0] + 1.0:
        return True
    values = _values(project, take)
    return values is not None and max(abs(v - values[0]) for v in values) * take.scale <= CLICK


def _write(project: Project, take: Recording) -> None:
    """Write the recorded motion to the track, once its base motion is known."""
    clip = project.clip
    before = project.history.committed.layer(take.layer).track_of(take.handle)
    values = _values(project, take)
    if values is None:
        return
    fresh = before or Track(handles=(take.handle,), keys=(TrackKey(frame=0, place=0),))
    fitted = fit_recording(take, values, project.document.frames.last)

    def own(frame: int) -> int | None:
        return track_source_frame(project.document, fresh, _wrapped(project, frame))

    start, end = fitted[0][0], fitted[-1][0]
    recorded = {own(frame) for frame in range(start, end + 1)}
    keys = {} if before is None else {k.frame: k for k in before.keys if k.frame not in recorded}
    # After a whole round of a loop, the start counts and not the end.
    for frame, place, velocity in reversed(fitted):
        at, number = track_at(fresh, clip, _wrapped(project, frame)), own(frame)
        if number is not None:
            turn = 0.0 if before is None or at is None else at.turn
            keys[number] = TrackKey(frame=number, place=place, turn=turn, velocity=velocity)
    seam, first = own(clip.frames.last), own(clip.frames.first)
    if end > clip.frames.last and seam in keys and first is not None:
        keys[first] = replace(keys[seam], frame=first)
    row = tuple(keys[frame] for frame in sorted(keys))
    command = track_commands.put_track(take.layer, replace(fresh, keys=row))
    project.history.do(replace(command, label=_("Record drag")), gesture=take.gesture)
    take.is_written = True


def _values(project: Project, take: Recording) -> list[complex] | None:
    """Convert the samples to values of track keys; None until all base motions are known."""
    before = project.history.committed.layer(take.layer).track_of(take.handle)
    if before is not None and before.is_scene_space:
        return [sample.place for sample in take.samples]
    index, values = handle_index(project, take.handle), []
    for time, place in take.samples:
        frame = int(time)
        ends = [_wrapped(project, each) for each in (frame, frame + 1)]
        grounds = [
            each for each in (base_frame_at(project, end) for end in ends) if each is not None
        ]
        placements = project.placed_at(project.selection.active, ends)
        if len(grounds) < len(ends) or placements is None:
            return None
        # The body moves between two frames, so the sample is converted at both.
        one, other = (
            _beside(ground, placement, index, place)
            for ground, placement in zip(grounds, placements, strict=True)
        )
        values.append(one + (time - frame) * (other - one))
    return values


def _beside(ground: BaseMotionFrame, placement: Similarity, index: int, place: complex) -> complex:
    """Return the offset of a scene place from a handle, in the axes of the shape."""
    beside = placement.apply_inverse(place) - ground.positions[index]
    return complex(beside * ground.rotations[index].conjugate())


def _wrapped(project: Project, frame: int) -> int:
    """Return the frame of the animation for a frame that counts on over the end of a loop."""
    frames = project.document.frames
    if project.document.loop and frame > frames.last:
        return frames.first + (frame - frames.first) % (frames.last - frames.first)
    return frames.clamp(frame)

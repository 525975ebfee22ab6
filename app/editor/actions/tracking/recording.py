"""Drags that are recorded while the timeline plays, and fitted by as few keys as will do."""

from dataclasses import replace

from app.document import Track, TrackKey, track_at, track_commands
from app.editor.actions import editing, playback, posing
from app.editor.actions.tracking.track_dragging import commit_track_drags, commit_track_key
from app.editor.actions.tracking.track_space import base_frame_at, handle_index
from app.editor.error_reports import report_failure
from app.editor.project import Project
from app.editor.session import CLICK, Session, with_project
from app.editor.timeline_view import source_frame
from app.editor.work import RecordedSample, Recording, TrackDrag
from app.errors import LissomError
from app.motion import BaseMotionFrame, reuse_corrections
from engine.geometry import RigidMotion
from engine.geometry.kinematics import fit_keys

RECORDING_SPEEDS = (1.0, 0.5, 0.25)
# How far a fitted motion may be from what was recorded, in pixels of the screen, on which hands
# tremble: at no smoothing and at all of it.
CLOSEST, SMOOTHEST = 0.3, 12.0
SMOOTHING = 0.5  # at first
NO_RECORDING = "The recording could not be kept"


@with_project
def toggle_recording_armed(session: Session, project: Project) -> None:
    """Let the next drag of a handle be recorded, or not any more; what was recorded is kept."""
    accept_recording(session)
    if session.records:
        session.records = False
    elif not project.layer.handles:
        session.show_notice("Click on the drawing to add a handle; then record how it is dragged.")
    else:
        playback.stop_playback(session)
        posing.release_drag(session)
        session.records, session.moves = True, False


def set_recording_speed(session: Session, speed: float) -> None:
    """Set how fast the timeline plays while a drag is recorded."""
    session.recording_speed = speed


@with_project
def start_recording(
    session: Session, project: Project, handle: int, place: complex, *, gesture: object
) -> None:
    """Begin to record a drag of a handle, which is at a place of the scene."""
    session.records = False
    track, document, standing = project.layer.track_of(handle), project.document, project.playhead
    running = replace(standing, speed=session.recording_speed).play(document, session.clock())
    frames, played = document.frames, document.played_frames
    # Over the seam of a loop it goes on, at most once round; that of a part of it is a jump.
    goes_round = document.loop and played == frames
    project.playhead = running
    project.recording = Recording(
        layer=project.active,
        handle=handle if track is None else track.handles[0],
        gesture=gesture,
        before=track,
        playhead=running,
        last=running.frame + frames.last - frames.first if goes_round else played.last,
        speed=standing.speed,
        place=place,
        scale=project.view(session.screen).scale,
        smoothing=SMOOTHING,
    )


@with_project
def drag_recorded_handle(_: Session, project: Project, place: complex) -> None:
    """Want the handle that is recorded at another place of the scene."""
    if project.recording is not None:
        project.recording.place = place


@with_project
def stop_recording(session: Session, project: Project, *, has_moved: bool = True) -> None:
    """End a recording where it is; the playhead goes back to where that began.

    Where the hand has not moved it is kept if the body moved under it.
    """
    take = project.recording
    if take is None or take.is_over:
        return
    if session.active_tool is take.gesture:
        session.active_tool = None
    take.is_over, take.has_moved = True, has_moved
    project.playhead = replace(take.playhead, since=None, speed=take.speed)
    if take.layer == project.active:
        project.selected_track = take.handle
        project.timeline.expanded_layers |= {take.layer}


def accept_recording(session: Session) -> None:
    """Keep what was recorded, as it is."""
    stop_recording(session)
    if session.project is not None:
        session.project.recording = None


@with_project
def discard_recording(session: Session, project: Project) -> None:
    """Take back what was recorded, or record nothing."""
    session.records, take = False, project.recording
    if take is not None:
        stop_recording(session)
        editing.revert_gesture(session, take.gesture)
        project.recording = None


def retry_recording(session: Session) -> None:
    """Take back what was recorded, and let the next drag be recorded in its place."""
    discard_recording(session)
    session.records = True


@with_project
def smooth_recording(_: Session, project: Project, smoothing: float) -> None:
    """Smooth what was recorded, from 0 to 1."""
    take = project.recording
    if take is not None and take.after is not None:
        take.smoothing = smoothing
        _write(project, take)


def update_track_drags(session: Session, project: Project) -> None:
    """Go on with what hands do with tracks; once a frame."""
    if not (project.track_drags or project.recording):
        return
    project.layer_runtime.corrected = reuse_corrections(
        project.document, project.active, project.layer_runtime.corrected
    )
    commit_track_drags(session, project)
    take = project.recording
    if take is None:
        return
    is_here = take.layer == project.active and any(
        take.handle == each.id for each in project.layer.handles
    )
    if not is_here or (take.after is not None and take.after is not project.document):
        # What was done since, even that it was taken back, is what the person goes on with.
        accept_recording(session)
    elif not take.is_over:
        _record(session, project, take)
    elif take.after is None and _is_click(project, take):
        discard_recording(session)
    elif take.after is None:
        try:
            _write(project, take)
        except LissomError as error:
            report_failure(session, NO_RECORDING, error)
            discard_recording(session)


def _record(session: Session, project: Project, take: Recording) -> None:
    """Take note of where the handle is dragged at this moment, and show that."""
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
        held = TrackDrag(
            layer=take.layer,
            handle=take.handle,
            frame=frame,
            gesture=take.gesture,
            place=placement.apply_inverse(take.place),
        )
        commit_track_key(session, project, held)
    if project.playhead is not take.playhead or time == take.last:
        stop_recording(session)


def _is_click(project: Project, take: Recording) -> bool:
    """Tell whether the hand has rested on a body that has not moved, as far as that is known."""
    if take.has_moved:
        return False
    times = [sample.time for sample in take.samples]
    if not times or times[-1] < times[0] + 1.0:
        return True
    values = _values(project, take)
    return values is not None and max(abs(v - values[0]) for v in values) * take.scale <= CLICK


def _write(project: Project, take: Recording) -> None:
    """Let the track have what was recorded, once it is known what that is relative to."""
    clip, before = project.clip, take.before
    values = _values(project, take)
    if values is None:
        return
    fresh = before or Track(handles=(take.handle,), keys=(TrackKey(frame=0, place=0),))
    fitted = _fitted(project, take, values)

    def own(frame: int) -> int | None:
        return source_frame(project.document, fresh, _wrapped(project, frame))

    start, end = fitted[0][0], fitted[-1][0]
    recorded = {own(frame) for frame in range(start, end + 1)}
    keys = {} if before is None else {k.frame: k for k in before.keys if k.frame not in recorded}
    # After a whole round of a loop, where it began counts and not where it ended.
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
    project.history.do(replace(command, label="Record drag"), gesture=take.gesture)
    take.after = project.document


def _fitted(
    project: Project, take: Recording, values: list[complex]
) -> list[tuple[int, complex, complex]]:
    """Return frames, places and velocities of as few keys as will do.

    They go on over a loop's seam. There is one at the seam: the last frame of a loop is its first
    one again.
    """
    tolerance = CLOSEST * (SMOOTHEST / CLOSEST) ** take.smoothing / take.scale
    times, seam = [sample.time for sample in take.samples], project.document.frames.last
    fitted = fit_keys(times, values, tolerance, required=(seam,))
    return list(zip(*(each.tolist() for each in fitted), strict=True))


def _values(project: Project, take: Recording) -> list[complex] | None:
    """Return what was recorded as the track's keys have it; None until all of it is known."""
    if take.before is not None and take.before.is_scene_space:
        return [sample.place for sample in take.samples]
    index, values = handle_index(project, take.handle), []
    for time, place in take.samples:
        frame = int(time)
        ends = [_wrapped(project, each) for each in (frame, frame + 1)]
        grounds = [
            each for each in (base_frame_at(project, end) for end in ends) if each is not None
        ]
        placements = project.placed_at(project.active, ends)
        if len(grounds) < len(ends) or placements is None:
            return None
        # The body moves on from frame to frame, and the place of the hand is beside it in both.
        one, other = (
            _beside(ground, placement, index, place)
            for ground, placement in zip(grounds, placements, strict=True)
        )
        values.append(one + (time - frame) * (other - one))
    return values


def _beside(ground: BaseMotionFrame, placement: RigidMotion, index: int, place: complex) -> complex:
    """Return by how much a place of the scene is beside a handle's, in the axes of the shape."""
    beside = placement.apply_inverse(place) - ground.positions[index]
    return complex(beside * ground.rotations[index].conjugate())


def _wrapped(project: Project, frame: int) -> int:
    """Return a frame that goes on over the seam of a loop where it is in the animation."""
    frames = project.document.frames
    if project.document.loop and frame > frames.last:
        return frames.first + (frame - frames.first) % (frames.last - frames.first)
    return frames.clamp(frame)

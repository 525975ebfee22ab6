"""Pointer gestures in the timeline, and the time range that it shows."""

from collections.abc import Iterable
from dataclasses import replace
from itertools import count
from typing import Any

from app.document import (
    LAST_FRAME,
    POSE,
    Channel,
    Command,
    Document,
    FrameRange,
    KeysByChannel,
    channel_commands,
    channels_of,
    cycle_commands,
    display_frame,
    frames_in,
    scene_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action
from app.editor.actions.timing.keys import edit_timing
from app.editor.actions.timing.sounds import drag_sound
from app.editor.parts.timeline.gestures import (
    CycleDrag,
    EdgeDrag,
    KeyBox,
    KeyDrag,
    PointBox,
    PointDrag,
    PointScale,
    ScrubDrag,
    SoundDrag,
    TimeDrag,
    TimeGesture,
)
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.errors import LissomError
from app.texts import _


@with_project
def set_time_range(_: Session, project: Project, strip: TimeRangeView | None) -> None:
    """Show a range of time; None fits all frames."""
    project.timeline.show_range(strip)


@named_action(
    _("Fit timeline"), "Ctrl+Home", icon="ARROWS_LEFT_RIGHT_TO_LINE", hint=_("Show all frames")
)
@with_project
def fit_timeline(session: Session, project: Project) -> None:
    """Show all frames; the graph shows all numbers, too."""
    set_time_range(session, None)
    project.graph.show_ranges(None)


@with_project
def scroll_to_playhead(
    session: Session, project: Project, frame: int, strip: TimeRangeView | None
) -> None:
    """Note the playhead's frame, and show a range of time around it if one is given."""
    project.timeline.note_shown_frame(frame)
    if strip is not None:
        set_time_range(session, strip)


@with_project
def scroll_rows(_: Session, project: Project, to: float) -> None:
    """Scroll the rows to a number of em below the first row; the selected row counts as shown."""
    project.timeline.scroll_rows(to, project.channel)


@with_project
def begin_timeline_drag(
    _: Session, project: Project, gesture: TimeGesture, strip: TimeRangeView
) -> None:
    """Begin a gesture; the shown range of time is fixed until it ends."""
    if isinstance(gesture, TimeDrag):
        # The keys move with poses at rest.
        project.history.commit()
    project.timeline.begin_gesture(gesture, strip)


@with_project
def move_timeline_drag(
    session: Session, project: Project, frame: float, channel: Channel[Any]
) -> None:
    """Follow the pointer to another frame and lane."""
    match project.timeline.gesture:
        case KeyBox() as box:
            editing.select_channel_keys(session, _inside(project, box, frame, channel))
        case ScrubDrag(offset=offset):
            playback.scrub(session, round(frame + offset))
        case TimeDrag() as drag:
            _drag(session, project, drag, frame)


@with_project
def end_timeline_drag(_: Session, project: Project) -> None:
    if isinstance(project.timeline.gesture, TimeDrag):
        project.history.release(project.timeline.gesture.gesture)
    project.timeline.end_gesture()


@with_project
def cancel_timeline_drag(session: Session, project: Project) -> None:
    """End the gesture, and undo its edits."""
    gesture = project.timeline.gesture
    if isinstance(gesture, KeyBox):
        editing.select_channel_keys(session, gesture.keeps)
    elif isinstance(gesture, TimeDrag) and project.history.is_open(gesture.gesture):
        editing.cancel_change(session)
        if isinstance(gesture, (KeyDrag, PointScale)):
            editing.select_channel_keys(session, gesture.keys)
    if isinstance(gesture, (PointBox, PointDrag, PointScale)):
        project.graph.select_points(gesture.points)
    end_timeline_drag(session)


@with_project
def toggle_lanes(_: Session, project: Project, layer: int) -> None:
    """Show or hide the lanes of a layer's channels; a hidden channel is deselected."""
    if not project.timeline.toggle_lanes(layer) and layer == project.selection.active:
        project.selection.select_channel(None)


def _inside(project: Project, box: KeyBox, frame: float, channel: Channel[Any]) -> KeysByChannel:
    """Return the keys in a box that ends at a frame and a lane, and the keys that it keeps."""
    document, order = project.document, project.lanes
    low, high = sorted((box.start, frame))
    if box.channel not in order or channel not in order:
        return box.keeps
    first, last = sorted(map(order.index, (box.channel, channel)))
    inside = dict(box.keeps)
    for lane in order[first : last + 1]:
        for each in _boxed_channels(project, lane):
            frames = frozenset(
                key
                for key in frames_in(document, each)
                if low <= display_frame(document, each, key) <= high
            )
            if frames:
                inside[each] = inside.get(each, frozenset()) | frames
    return inside


def _boxed_channels(project: Project, lane: Channel[Any]) -> Iterable[Channel[Any]]:
    """Return the channels whose keys a lane shows: a folded layer shows all of its channels."""
    layer = None if lane.layer is None else project.document.layer(lane.layer)
    if layer is None or lane.kind is not POSE:
        return (lane,)
    is_folded = layer.id not in project.timeline.expanded_layers
    shown = channels_of(layer) if is_folded else (lane,)
    return [each for each in shown if not (layer.still and each.kind is POSE)]


def drag_offset(document: Document, keys: KeysByChannel, wanted: int, *, copies: bool) -> int:
    """Return the number of frames nearest to `wanted` by which keys can be moved.

    Parameters
    ----------
    copies : bool
        Whether the original keys stay; then 0 means no copies.
    """
    there = {channel: frames_in(document, channel) for channel in keys}
    taken = there if copies else {channel: there[channel] - keys[channel] for channel in keys}
    low, high = -min(map(min, keys.values())), LAST_FRAME - max(map(max, keys.values()))
    wanted = min(max(wanted, low), high)
    for distance in count():
        # The pointer's side comes first: keys stop before a key that is in the way.
        for by in (wanted - distance, wanted + distance)[:: 1 if wanted > 0 else -1]:
            if by == 0 or (
                low <= by <= high
                and not any(
                    key + by in taken[channel] for channel, frames in keys.items() for key in frames
                )
            ):
                return by
    raise AssertionError("unreachable: 0 is always possible")


def _drag(session: Session, project: Project, drag: TimeDrag, frame: float) -> None:
    """Move the dragged item to the pointer's frame, unless another edit came meanwhile."""
    before = project.history.committed
    moved = _moved(before, drag, frame)
    if moved is None:
        return
    if project.history.has_ended(drag.gesture):
        end_timeline_drag(session)
        return
    drag, command = moved
    try:
        document = command(before)
    except LissomError:
        # Keys before a cycle stay where they are.
        return
    edit_timing(session, Command(command.label, lambda _: document), gesture=drag.gesture)
    if isinstance(drag, KeyDrag):
        by = drag.by
        chosen = {
            channel: frozenset(key + by for key in frames) for channel, frames in drag.keys.items()
        }
        editing.select_channel_keys(session, chosen)
    project.timeline.move_gesture(drag)


def _moved(before: Document, drag: TimeDrag, frame: float) -> tuple[TimeDrag, Command] | None:
    """Return the drag, moved as near to a frame as possible, and its command.

    The command is for the document before the drag. None if nothing moves.
    """
    match drag:
        case EdgeDrag():
            return drag, _trim(before, drag, frame)
        case CycleDrag():
            return drag, _end_cycle(before, drag, round(frame))
        case KeyDrag(keys=keys, copies=copies):
            by = drag_offset(before, keys, round(frame - drag.start), copies=copies)
            change = channel_commands.copy_keys if copies else channel_commands.move_keys
            command = change(keys, by)
            if not by:
                command = Command(command.label, lambda document: document)
            return None if by == drag.by else (replace(drag, by=by), command)
        case SoundDrag():
            return drag, drag_sound(before, drag, frame)
    raise AssertionError("unreachable: there are no other drags")


def _end_cycle(before: Document, drag: CycleDrag, frame: int) -> Command:
    """Return the command that puts the dragged end of a cycle as near to a frame as possible."""
    layer = before.layer(drag.layer)
    cycle = cycle_commands.cycle_starting_at(layer, drag.first)
    last, until = cycle.last, cycle.until
    if drag.is_stretch:
        cycle = cycle_commands.with_cycle_end(layer, cycle, min(frame, before.frames.last))
        last, until = cycle.last, cycle.until
    else:
        until = cycle_commands.nearest_cycle_end(layer, cycle, frame, before.frames.last)
    return cycle_commands.set_cycle(drag.layer, drag.first, last, until)


def _trim(document: Document, drag: EdgeDrag, pointed: float) -> Command:
    """Return the command that puts the dragged end at the pointer."""
    frames, played = document.frames, document.played_frames
    frame = frames.clamp(round(pointed))
    match drag.edge:
        case "animation end":
            least = max(document.keyed_range[1], frames.first + 1)
            last = min(max(round(pointed), least), LAST_FRAME)
            return scene_commands.set_frames(FrameRange(frames.first, last))
        case "preview start":
            preview = FrameRange(max(min(frame, played.last - 1), frames.first), played.last)
        case "preview end":
            preview = FrameRange(played.first, min(max(frame, played.first + 1), frames.last))
        case "preview range":
            by = round(pointed - drag.start)
            by = min(max(by, frames.first - played.first), frames.last - played.last)
            preview = FrameRange(played.first + by, played.last + by)
    return scene_commands.set_preview(None if preview == frames else preview)

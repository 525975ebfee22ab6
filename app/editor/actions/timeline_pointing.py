"""Gestures of the pointer in the timeline, from press to release, and what it shows."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import count

from app.document import (
    LAST_FRAME,
    Command,
    Document,
    FrameRange,
    key_commands,
    layer_commands,
    scene_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.keys import retime
from app.editor.project import Project
from app.editor.session import Session
from app.editor.timeline_view import (
    EdgeDrag,
    KeyBox,
    KeyDrag,
    MarkerDrag,
    Scrub,
    Strip,
    SwitchDrag,
    TimeGesture,
)


def look_at(session: Session, strip: Strip | None) -> None:
    """Show a stretch of time; None fits all frames."""
    if session.project:
        timing = session.project.timing
        if timing.gesture is None:
            timing.strip = strip
        else:
            timing.held = strip


def fit(session: Session) -> None:
    """Show all frames."""
    look_at(session, None)


def follow(session: Session, frame: int, strip: Strip | None) -> None:
    """Note that the playhead is at a frame, and show a stretch of time that it is in, if given."""
    if session.project:
        session.project.timing.seen = frame
        if strip is not None:
            look_at(session, strip)


def scroll_rows(session: Session, to: float) -> None:
    """Scroll the rows of figures to a number of em below the first one; the active one is seen."""
    if session.project:
        timing = session.project.timing
        timing.scrolled, timing.seen_row = to, session.project.active


def begin(session: Session, gesture: TimeGesture, strip: Strip) -> None:
    """Begin a gesture; what is shown stays until it ends."""
    if session.project:
        session.project.timing.gesture = gesture
        session.project.timing.held = strip


def move(session: Session, frame: float, row: int) -> None:
    """Follow the pointer to another time, on the row of a figure."""
    project = session.project
    if project is None:
        return
    match project.timing.gesture:
        case KeyDrag() as drag:
            _drag_keys(session, project, drag, frame)
        case EdgeDrag() as drag:
            _drag_edge(session, project, drag, frame)
        case MarkerDrag() as drag:
            _drag_marker(session, project, drag, frame)
        case SwitchDrag() as drag:
            _drag_switch(session, project, drag, frame)
        case KeyBox() as box:
            editing.choose_keys_of(session, _inside(project.document, box, frame, row))
        case Scrub(offset=offset):
            playback.scrub(session, round(frame + offset))


def end(session: Session) -> None:
    """End the gesture where it is."""
    if session.project:
        timing = session.project.timing
        if timing.strip is not None:
            timing.strip = timing.held
        timing.gesture = timing.held = None


def _inside(
    document: Document, box: KeyBox, frame: float, row: int
) -> Mapping[int, frozenset[int]]:
    """Return the keys within a box that ends at a frame and a row, and those that it keeps."""
    low, high = sorted((box.start, frame))
    order = [figure.id for figure in document.figures]
    first, last = sorted(map(order.index, (box.row, row)))
    inside = dict(box.keeps)
    for figure in document.figures[first : last + 1]:
        if figure.still:
            continue
        frames = frozenset(key for key in figure.key_frames if low <= key <= high)
        inside[figure.id] = inside.get(figure.id, frozenset()) | frames
    return inside


def cancel(session: Session) -> None:
    """End the gesture, and take back what it did."""
    if session.project is None:
        return
    match session.project.timing.gesture:
        case KeyDrag(before=before, after=after, keys=keys) if session.project.document is after:
            _become(session, before, "Move keys")
            editing.choose_keys_of(session, keys)
        case EdgeDrag(before=before, after=after) if session.project.document is after:
            _become(session, before, "Set preview range")
        case MarkerDrag(before=before, after=after) if session.project.document is after:
            _become(session, before, "Move marker")
        case SwitchDrag(before=before, after=after) if session.project.document is after:
            _become(session, before, "Move visibility")
        case KeyBox(keeps=keeps):
            editing.choose_keys_of(session, keeps)
    end(session)


def shift_of(
    document: Document, keys: Mapping[int, frozenset[int]], wanted: int, *, copies: bool
) -> int:
    """Return the number of frames next to `wanted` by which keys can be moved.

    Parameters
    ----------
    document : Document
    keys : mapping of int to frozenset of int
        Their frames, by the ids of their figures.
    wanted : int
    copies : bool
        Whether they stay as well; then 0 stands for no copies.
    """
    there = {figure: document.figure(figure).key_frames for figure in keys}
    taken = there if copies else {figure: there[figure] - keys[figure] for figure in keys}
    low, high = -min(map(min, keys.values())), LAST_FRAME - max(map(max, keys.values()))
    wanted = min(max(wanted, low), high)
    for distance in count():
        # On the side from which the pointer comes first: keys wait before one that is in the way.
        for by in (wanted - distance, wanted + distance)[:: 1 if wanted > 0 else -1]:
            if by == 0 or (
                low <= by <= high
                and not any(
                    key + by in taken[figure] for figure, frames in keys.items() for key in frames
                )
            ):
                return by
    raise AssertionError("unreachable: 0 is always possible")


def _drag_keys(session: Session, project: Project, drag: KeyDrag, frame: float) -> None:
    wanted = round(frame - drag.start)
    by = shift_of(drag.before, drag.keys, wanted, copies=drag.copies)
    if by == drag.by:
        return
    if project.document is not drag.after:
        end(session)
        return
    change = key_commands.copy_keys if drag.copies else key_commands.move_keys
    command = editing.change_keys(lambda figure, frames: change(figure, frames, by), drag.keys)
    _become(session, command(drag.before) if by else drag.before, command.label)
    editing.choose_keys_of(
        session,
        {figure: frozenset(key + by for key in frames) for figure, frames in drag.keys.items()},
    )
    project.timing.gesture = replace(drag, by=by, after=project.document)


def _drag_edge(session: Session, project: Project, drag: EdgeDrag, frame: float) -> None:
    if project.document is not drag.after:
        end(session)
        return
    command = _trim(drag, frame)
    _become(session, command(drag.before), command.label)
    project.timing.gesture = replace(drag, after=project.document)


def _drag_marker(session: Session, project: Project, drag: MarkerDrag, frame: float) -> None:
    if project.document is not drag.after:
        end(session)
        return
    wanted = min(max(drag.marker + round(frame - drag.start), 0), LAST_FRAME)
    others = {marker.frame for marker in drag.before.markers} - {drag.marker}
    if wanted == drag.at or wanted in others:
        return
    command = scene_commands.move_marker(drag.marker, wanted)
    _become(session, command(drag.before), command.label)
    project.timing.gesture = replace(drag, at=wanted, after=project.document)


def _drag_switch(session: Session, project: Project, drag: SwitchDrag, frame: float) -> None:
    if project.document is not drag.after:
        end(session)
        return
    document = drag.before
    wanted = document.frames.clamp(drag.switch + round(frame - drag.start))
    others = {switch.frame for switch in document.figure(drag.figure).switches} - {drag.switch}
    if wanted == drag.at or wanted in others:
        return
    command = layer_commands.move_switch(drag.figure, drag.switch, wanted)
    _become(session, command(document), command.label)
    project.timing.gesture = replace(drag, at=wanted, after=project.document)


def _trim(drag: EdgeDrag, pointed: float) -> Command:
    """Return the command that puts the dragged end where the pointer is."""
    document = drag.before
    frames, played = document.frames, document.played
    frame = frames.clamp(round(pointed))
    match drag.edge:
        case "animation end":
            last_key = max(figure.keys[-1].frame for figure in document.figures)
            least = max(last_key, frames.first + 1)
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


def _become(session: Session, document: Document, label: str) -> None:
    """Go on to another document, as part of the gesture's one step of undo."""
    retime(session, Command(label, lambda _: document))

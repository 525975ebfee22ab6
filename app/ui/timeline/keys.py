"""Keys of all figures, marked by how they are passed, and the box that chooses them."""

from collections.abc import Mapping
from itertools import pairwise

from imgui_bundle import ImVec2, ImVec4, icons_fontawesome_6 as icons, imgui

from app.document import LAST_FRAME, Figure, Keyframe, Passing
from app.editor import Action, KeyBox, KeyDrag, Project, TimeGesture, do, layering
from app.editor.actions import editing, keys, timeline_pointing
from app.ui.shortcuts import CTRL, with_key
from app.ui.style import begin_tip, in_hand, ink, is_pressed
from app.ui.timeline.menus import PASSINGS, key_menu, track_menu
from app.ui.timeline.track import ROUNDING, FigureRow, Track, in_seconds, tag, was_dragged

REACH, SMALLEST = 0.55, 0.26  # em: half a key's diagonal, with room and among many
SMALLER = 0.7  # keys of figures that are not the active one, as a part of what theirs would be
GRIP = 1.45  # half the side of the box in which the pointer takes a key, as a part of that


def draw_ground(track: Track) -> list[Action]:
    """Draw the frames that there are, and take what the pointer does where nothing else is."""
    palette, draw_list = track.look.palette, imgui.get_window_draw_list()
    low, high = ImVec2(track.left, track.track_top), ImVec2(track.right, track.track_bottom)
    draw_list.add_rect_filled(low, high, ink(palette.desk), ROUNDING * track.look.em)
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    document = track.project.document
    for frames, alpha in ((document.frames, 0.45), (document.played, 1.0)):
        begin, end = track.x(frames.first), track.x(frames.last)
        draw_list.add_rect_filled(
            ImVec2(begin, low.y), ImVec2(end, high.y), ink(palette.panel, alpha)
        )
    draw_list.pop_clip_rect()
    return _press_ground(track, low, high)


def _press_ground(track: Track, low: ImVec2, high: ImVec2) -> list[Action]:
    actions: list[Action] = []
    clicked = track.button("ground", low, high, right=True)
    if is_pressed():
        actions += begin_box(track)
    if clicked and is_plain_click():
        actions += choose_row(track, {})
    twice = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
    if twice and round(track.pointed) in track.project.document.frames:
        actions.append(do(keys.insert_at, round(track.pointed)))
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        if not track.pointed_row.is_active:
            actions += choose_row(track, {})
        imgui.open_popup("menu of track")
    return actions + track_menu(track)


def choose_row(track: Track, chosen_of: Mapping[int, frozenset[int]]) -> list[Action]:
    """Let the figure of the row under the pointer be the active one, and choose keys."""
    return [
        do(layering.choose, track.pointed_row.figure.id),
        do(editing.choose_keys_of, chosen_of),
    ]


def begin_box(track: Track) -> list[Action]:
    """Begin to choose keys by a box; with Shift besides those that are chosen."""
    keeps = track.project.chosen_of if imgui.get_io().key_shift else {}
    box = KeyBox(start=track.pointed, row=track.pointed_row.figure.id, keeps=keeps)
    return [do(timeline_pointing.begin, box, track.strip)]


def is_plain_click() -> bool:
    """Tell whether the left button was let go just now where it was pressed, without Shift."""
    released = imgui.is_mouse_released(imgui.MouseButton_.left)
    return released and not was_dragged() and not imgui.get_io().key_shift


def draw_box(track: Track) -> None:
    """Draw the box that the pointer spans."""
    gesture = track.project.timing.gesture
    if not isinstance(gesture, KeyBox) or not was_dragged():
        return
    draw_list, accent = imgui.get_window_draw_list(), track.look.palette.accent
    mouse = imgui.get_mouse_pos()
    delta = imgui.get_mouse_drag_delta(imgui.MouseButton_.left)
    top, bottom = sorted((mouse.y - delta.y, mouse.y))
    left, right = sorted((track.x(gesture.start), mouse.x))
    low = ImVec2(left, max(top, track.track_top))
    high = ImVec2(right, min(bottom, track.track_bottom))
    draw_list.add_rect_filled(low, high, ink(accent, 0.14), 2.0)
    draw_list.add_rect(low, high, ink(accent, 0.8), 2.0)


def draw_keys(track: Track) -> list[Action]:
    """Draw the keys of all figures, and take what the pointer does to them."""
    actions: list[Action] = []
    track.push_clip()
    for row in track.rows:
        if not row.figure.still or row.is_active:
            # The same buttons when another figure becomes the active one.
            imgui.push_id(f"row {row.figure.id}")
            actions += _draw_row(track, row)
            imgui.pop_id()
    imgui.pop_clip_rect()
    return actions


def _draw_row(track: Track, row: FigureRow) -> list[Action]:
    actions: list[Action] = []
    radius = _radius(track, row)
    grip = GRIP * radius
    gesture, identity = track.project.timing.gesture, row.figure.id
    for key in row.figure.keys:
        x = track.x(key.frame)
        if not track.shows(x - grip, x + grip):
            continue
        box = ImVec2(x - grip, row.middle - grip), ImVec2(x + grip, row.middle + grip)
        origin = _origin(gesture, row.figure, key.frame)
        track.button(f"key {origin}", *box, right=True)
        is_dragged = row.is_active and _is_dragged(gesture, key.frame)
        _draw_key(track, row, key, 1.15 * radius if in_hand() or is_dragged else radius)
        if is_pressed():
            actions += _press(track, identity, key.frame)
        if imgui.is_item_clicked(imgui.MouseButton_.right):
            if key.frame not in track.project.chosen_of.get(identity, ()):
                actions += choose_row(track, {identity: frozenset({key.frame})})
            elif not row.is_active:
                actions += choose_row(track, track.project.chosen_of)
            imgui.open_popup(f"menu of key {key.frame}")
        if gesture is None:
            _tell(track, row, key)
        actions += key_menu(track, identity, key)
    return actions


def _radius(track: Track, row: FigureRow) -> float:
    """Return how large keys are, in pixels: smaller where they would cover each other."""
    pairs = pairwise(row.figure.keys)
    gap = min((later.frame - key.frame for key, later in pairs), default=LAST_FRAME)
    part = 1.0 if row.is_active else SMALLER
    return part * min(max(0.48 * gap * track.strip.scale, SMALLEST), REACH) * track.look.em


def _is_dragged(gesture: TimeGesture | None, frame: int) -> bool:
    """Tell whether a key of the active figure is the one that is dragged."""
    return isinstance(gesture, KeyDrag) and frame == gesture.pressed + gesture.by


def _origin(gesture: TimeGesture | None, figure: Figure, frame: int) -> int:
    """Return at which frame a key was before the drag, so that its button stays the same one."""
    if isinstance(gesture, KeyDrag) and not gesture.copies:
        before = frame - gesture.by
        return before if before in gesture.keys.get(figure.id, ()) else frame
    return frame


def _press(track: Track, figure: int, frame: int) -> list[Action]:
    chosen_of, io = track.project.chosen_of, imgui.get_io()
    chosen = chosen_of.get(figure, frozenset())
    if io.key_shift:
        return [do(editing.choose_keys_of, {**chosen_of, figure: chosen ^ {frame}})]
    if frame not in chosen:
        chosen_of = {figure: frozenset({frame})}
    drag = KeyDrag(
        keys=chosen_of,
        pressed=frame,
        start=track.pointed,
        copies=io.key_ctrl,
        before=track.project.document,
        after=track.project.document,
    )
    return [
        do(layering.choose, figure),
        do(editing.choose_keys_of, chosen_of),
        do(timeline_pointing.begin, drag, track.strip),
    ]


def _draw_key(track: Track, row: FigureRow, key: Keyframe, radius: float) -> None:
    palette, draw_list, em = track.look.palette, imgui.get_window_draw_list(), track.look.em
    x, y = track.x(key.frame), row.middle
    chosen = key.frame in track.project.chosen_of.get(row.figure.id, ())
    warns = _warning(track, row, key)
    fill = palette.accent if chosen else warns or (palette.text if row.is_active else palette.dim)
    passing, centre = key.shown_passing, ImVec2(x, y)
    if chosen:
        _mark(passing, centre, radius + 0.24 * em, ink(palette.accent, 0.35))
    _mark(passing, centre, radius + 0.12 * em, ink(palette.desk))
    _mark(passing, centre, radius, ink(fill))
    gesture = track.project.timing.gesture
    if (
        row.is_active
        and isinstance(gesture, KeyDrag)
        and gesture.by
        and _is_dragged(gesture, key.frame)
    ):
        tag(track, x, f"{key.frame}  ({gesture.by:+d})")
    if warns and chosen:
        _mark(passing, centre, 0.45 * radius, ink(warns))
    if warns and row.is_active:
        draw_list.add_circle_filled(ImVec2(x, track.bar_top - 0.1 * em), 0.2 * em, ink(warns))


def _warning(track: Track, row: FigureRow, key: Keyframe) -> ImVec4 | None:
    """Return the colour of a key's warning if there is one."""
    palette = track.look.palette
    if not key.pose.certificate.certified:
        return palette.danger
    return palette.warning if row.is_active and lags(track.project, key) else None


def _mark(passing: Passing, centre: ImVec2, radius: float, colour: int) -> None:
    """Draw a key's mark: round where the motion goes on, pointed, pinched, or square for a hold."""
    draw_list, x, y = imgui.get_window_draw_list(), centre.x, centre.y
    across = radius / 2**0.5
    match passing:
        case Passing.THROUGH:
            draw_list.add_circle_filled(centre, 0.86 * radius, colour)
        case Passing.HOLD:
            half = 1.06 * across
            draw_list.add_rect_filled(
                ImVec2(x - half, y - half), ImVec2(x + half, y + half), colour
            )
        case Passing.STOP:
            half, waist = 1.1 * across, 0.3 * across
            for side in (-1, 1):
                draw_list.add_quad_filled(
                    ImVec2(x - half, y + side * half),
                    ImVec2(x + half, y + side * half),
                    ImVec2(x + waist, y),
                    ImVec2(x - waist, y),
                    colour,
                )
        case _:
            draw_list.add_quad_filled(
                ImVec2(x, y - radius),
                ImVec2(x + radius, y),
                ImVec2(x, y + radius),
                ImVec2(x - radius, y),
                colour,
            )


def lags(project: Project, key: Keyframe) -> list[str]:
    """Return which handles fall short of their targets in a key of the active figure, in words."""
    short = project.timing.shortfalls.value.get(key.pose, {})
    names = {handle.id: handle.name for handle in project.figure.handles}
    return [
        f"{names[identity]} is {lag:.0f} px short of its target"
        for identity, lag in short.items()
        if identity in names
    ]


def _tell(track: Track, row: FigureRow, key: Keyframe) -> None:
    """Explain a key in a tooltip."""
    if not begin_tip():
        return
    palette, document = track.look.palette, track.project.document
    imgui.text_unformatted(f"Key at frame {key.frame}")
    imgui.same_line()
    imgui.text_disabled(in_seconds(key.frame, document.fps))
    name, hint = PASSINGS[key.shown_passing]
    imgui.text_unformatted(f"{name}: {hint[0].lower()}{hint[1:]}")
    if not key.pose.certificate.certified:
        imgui.text_colored(
            palette.danger,
            f"{icons.ICON_FA_TRIANGLE_EXCLAMATION}  Beyond the limits: in-betweens may fold here",
        )
    for text in lags(track.project, key) if row.is_active else ():
        imgui.text_colored(palette.warning, f"{icons.ICON_FA_TRIANGLE_EXCLAMATION}  {text}")
    imgui.text_disabled(f"Drag to move, {with_key(CTRL, 'drag')} to copy, right click for more")
    imgui.end_tooltip()

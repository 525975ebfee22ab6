"""Keys on the track, marked by how they are passed, and the box that chooses them."""

from itertools import pairwise

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from app.document import LAST_FRAME, Keyframe, Passing
from app.editor import Action, KeyBox, KeyDrag, Project, TimeGesture, do
from app.editor.actions import editing, keys, timeline_pointing
from app.ui.shortcuts import with_key
from app.ui.style import begin_tip, ink
from app.ui.timeline.menus import PASSINGS, key_menu, track_menu
from app.ui.timeline.track import (
    ROUNDING,
    Track,
    in_hand,
    in_seconds,
    is_pressed,
    was_dragged,
    write_tag,
)

CTRL = int(imgui.Key.mod_ctrl)
REACH, SMALLEST = 0.55, 0.26  # em: half a key's diagonal, with room and among many
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
        actions.append(do(editing.choose_keys, frozenset()))
    twice = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
    if twice and round(track.pointed) in track.project.document.frames:
        actions.append(do(keys.insert_at, round(track.pointed)))
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        imgui.open_popup("menu of track")
    return actions + track_menu(track)


def begin_box(track: Track) -> list[Action]:
    """Begin to choose keys by a box; with Shift besides those that are chosen."""
    keeps = track.project.chosen if imgui.get_io().key_shift else frozenset()
    return [do(timeline_pointing.begin, KeyBox(start=track.pointed, keeps=keeps), track.strip)]


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
    """Draw the keys, and take what the pointer does to them."""
    actions: list[Action] = []
    radius = _radius(track)
    grip = GRIP * radius
    gesture = track.project.timing.gesture
    draw_list = imgui.get_window_draw_list()
    low, high = ImVec2(track.left, track.track_top), ImVec2(track.right, track.track_bottom)
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    for key in track.project.figure.keys:
        x = track.x(key.frame)
        if not track.shows(x - grip, x + grip):
            continue
        box = ImVec2(x - grip, track.middle - grip), ImVec2(x + grip, track.middle + grip)
        origin = _origin(gesture, key.frame)
        track.button(f"key {origin}", *box, right=True)
        is_held = isinstance(gesture, KeyDrag) and key.frame == gesture.pressed + gesture.by
        _draw_key(track, key, 1.15 * radius if in_hand() or is_held else radius)
        if is_pressed():
            actions += _press(track, key.frame)
        if imgui.is_item_clicked(imgui.MouseButton_.right):
            if key.frame not in track.project.chosen:
                actions.append(do(editing.choose_keys, frozenset({key.frame})))
            imgui.open_popup(f"menu of key {key.frame}")
        if gesture is None:
            _tell(track, key)
        actions += key_menu(track, key)
    draw_list.pop_clip_rect()
    return actions


def _radius(track: Track) -> float:
    """Return how large keys are, in pixels: smaller where they would cover each other."""
    pairs = pairwise(track.project.figure.keys)
    gap = min((later.frame - key.frame for key, later in pairs), default=LAST_FRAME)
    return min(max(0.48 * gap * track.strip.scale, SMALLEST), REACH) * track.look.em


def _origin(gesture: TimeGesture | None, frame: int) -> int:
    """Return at which frame a key was before the drag, so that its button stays the same one."""
    if isinstance(gesture, KeyDrag) and not gesture.copies and frame - gesture.by in gesture.keys:
        return frame - gesture.by
    return frame


def _press(track: Track, frame: int) -> list[Action]:
    chosen, io = track.project.chosen, imgui.get_io()
    if io.key_shift:
        return [do(editing.choose_keys, chosen ^ {frame})]
    chosen = chosen if frame in chosen else frozenset({frame})
    drag = KeyDrag(
        keys=chosen,
        pressed=frame,
        start=track.pointed,
        copies=io.key_ctrl,
        before=track.project.document,
        after=track.project.document,
    )
    return [do(editing.choose_keys, chosen), do(timeline_pointing.begin, drag, track.strip)]


def _draw_key(track: Track, key: Keyframe, radius: float) -> None:
    palette, draw_list, em = track.look.palette, imgui.get_window_draw_list(), track.look.em
    x, y = track.x(key.frame), track.middle
    fill, warns = _colour(track, key)
    chosen = key.frame in track.project.chosen
    passing, centre = key.shown_passing, ImVec2(x, y)
    if chosen:
        _mark(passing, centre, radius + 0.24 * em, ink(palette.accent, 0.35))
    _mark(passing, centre, radius + 0.12 * em, ink(palette.desk))
    _mark(passing, centre, radius, ink(fill))
    gesture = track.project.timing.gesture
    if isinstance(gesture, KeyDrag) and gesture.by and key.frame == gesture.pressed + gesture.by:
        write_tag(track, x, f"{key.frame}  ({gesture.by:+d})")
    if warns and chosen:
        _mark(passing, centre, 0.45 * radius, ink(warns))
    if warns:
        draw_list.add_circle_filled(ImVec2(x, track.bar_top - 0.1 * em), 0.2 * em, ink(warns))


def _colour(track: Track, key: Keyframe) -> tuple[ImVec4, ImVec4 | None]:
    """Return the colour of a key, and that of its warning if there is one."""
    palette = track.look.palette
    warns = None
    if not key.pose.certificate.certified:
        warns = palette.danger
    elif lags(track.project, key):
        warns = palette.warning
    return (palette.accent if key.frame in track.project.chosen else warns or palette.text), warns


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
    """Return which handles fall short of their targets in a key, in words."""
    short = project.timing.shortfalls.value.get(key.pose, {})
    names = {handle.id: handle.name for handle in project.figure.handles}
    return [
        f"{names[identity]} is {lag:.0f} px short of its target"
        for identity, lag in short.items()
        if identity in names
    ]


def _tell(track: Track, key: Keyframe) -> None:
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
    for text in lags(track.project, key):
        imgui.text_colored(palette.warning, f"{icons.ICON_FA_TRIANGLE_EXCLAMATION}  {text}")
    imgui.text_disabled(f"Drag to move, {with_key(CTRL, 'drag')} to copy, right click for more")
    imgui.end_tooltip()

"""The drawing, and everything that the pointer does to it."""

from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import handle_commands
from app.editor import (
    Action,
    BoxMark,
    EntryMark,
    Hint,
    JointMark,
    Project,
    Session,
    StrokeMark,
    SweepMark,
    do,
    layering,
)
from app.editor.actions import editing, posing, viewing
from app.editor.poses import flipping
from app.editor.tools import Spot, pointing, tools_of
from app.motion import Shown
from app.render import View
from app.ui.shortcuts import ALT, CTRL, SHIFT, with_key
from app.ui.style import Look, in_hand, ink, is_pressed
from app.ui.viewport.badges import draw_badges, draw_cutting
from app.ui.viewport.cut_view import draw_brush, draw_stroke
from app.ui.viewport.entry import draw_entry, typed
from app.ui.viewport.joint import draw_joint, is_on_anchor
from app.ui.viewport.marks import moved_loops
from app.ui.viewport.mirror_axis import axis_grip, draw_axis
from app.ui.viewport.ring import Ring, draw_ring
from app.ui.viewport.split_view import SplitTextures, divide, draw_divider, draw_pictures
from engine.arrays import Complexes
from engine.geometry import contains

KEYS = {"ctrl": CTRL, "shift": SHIFT, "alt": ALT}
ZOOM_STEP = 1.15  # a notch of the wheel
GRIP = 0.75  # em: radius within which a handle is grabbed
SMALLEST_ZOOM, LARGEST_ZOOM = 0.02, 64.0


def draw(session: Session, look: Look, project: Project, pictures: SplitTextures) -> list[Action]:
    """Show the pictures that were drawn of the project, and take what the pointer does there.

    Where the viewport is divided into two, `pictures` has the other method's picture, too.
    """
    corner = imgui.get_window_pos()
    whole = imgui.get_window_size()
    parts = divide(session, corner, whole)
    room = parts.room
    imgui.set_cursor_screen_pos(corner)
    density = imgui.get_io().display_framebuffer_scale.x or 1.0
    screen = (max(1, round(room.x * density)), max(1, round(room.y * density)))
    actions: list[Action] = []
    if screen != session.screen:
        actions.append(do(viewing.resize, *screen))
    if project.puppet.shown is None or pictures.own is None or min(room.x, room.y) < 1:
        return actions
    draw_pictures(parts, pictures.own, pictures.twin)
    canvas = _Canvas(project, project.puppet.shown, project.view(session.screen), corner, density)
    # Before the canvas: what comes first gets the pointer. Were they laid over it, a press in the
    # frame in which the pointer arrives would be the canvas's, or nobody's.
    imgui.push_clip_rect(corner, corner + room, intersect_with_current_clip_rect=True)
    hovered, pressed, over_handles = _handles(session, look, canvas)
    axis = _axis(session, look, canvas)
    pressed = pressed or axis.is_pressed
    imgui.pop_clip_rect()
    actions += draw_divider(session, look, parts, whole.x)
    imgui.set_cursor_screen_pos(corner)
    imgui.invisible_button("canvas", room, _ANY_BUTTON)
    on_canvas = imgui.is_item_hovered()
    over = imgui.is_window_hovered() or imgui.is_item_active()
    ring = _ring(session, canvas)
    on_ring = ring is not None and on_canvas and hovered is None and ring.is_pointed(look)
    spot = replace(_spot(canvas, look, hovered, on_ring=on_ring), on_axis=axis.is_hot)
    if pressed or _is_canvas_pressed():
        actions.append(do(pointing.press, spot))
    actions += _navigate(canvas, over=over)
    actions += over_handles
    actions += _go_on(session, look, canvas)
    if hovered != session.hovered:
        actions.append(do(pointing.hover, hovered))
    if axis.x is not None:
        draw_axis(look, axis.x, hot=axis.is_hot)
    if ring is not None:
        draw_ring(look, ring, is_pointed=on_ring and session.pointer is None)
    hint = _hint(session, canvas, spot) if on_canvas or hovered is not None or axis.is_hot else ""
    if hint != session.hint:
        actions.append(do(pointing.explain, hint))
    if session.cutting is not None:
        _strokes_on_their_way(look, canvas)
        if on_canvas or session.pointer is not None:
            draw_brush(session, look, imgui.get_mouse_pos(), canvas.view.scale / density)
        return actions + draw_cutting(look, corner, room)
    actions += draw_badges(look, project, corner, room)
    return actions


RIGHT = imgui.MouseButton_.right
_ANY_BUTTON = (
    imgui.ButtonFlags_.mouse_button_left
    | imgui.ButtonFlags_.mouse_button_right
    | imgui.ButtonFlags_.mouse_button_middle
)


class _Canvas:
    """Where the picture is on the screen."""

    def __init__(
        self, project: Project, shown: Shown, view: View, corner: ImVec2, density: float
    ) -> None:
        self.project = project
        self.shown = shown
        self.view = view
        self._corner = complex(corner.x, corner.y)
        self.density = density

    @property
    def pointer(self) -> complex:
        """The place under the pointer, as the figure is by itself."""
        mouse = imgui.get_mouse_pos()
        return self.place(complex(mouse.x, mouse.y))

    @property
    def pixel(self) -> complex:
        """The pixel of the picture under the pointer."""
        mouse = imgui.get_mouse_pos()
        pixel = (complex(mouse.x, mouse.y) - self._corner) * self.density
        # Of a picture beside it, the same pixel.
        return complex(pixel.real % self.view.size[0], pixel.imag)

    def place(self, point: complex) -> complex:
        """Return the place under a point of the screen, as the figure is by itself."""
        return self.shown.placement.back(self._plane(point))

    def _plane(self, point: complex) -> complex:
        return self.view.to_plane((point - self._corner) * self.density)

    def point(self, place: complex) -> ImVec2:
        (point,) = self.points(self.shown.placement.on(np.array([place])))
        return point

    def points(self, on_plane: Complexes) -> list[ImVec2]:
        """Return the points of the screen at places of the scene."""
        pixels = self.view.to_pixels(on_plane) / self.density + self._corner
        return [ImVec2(pixel.real, pixel.imag) for pixel in pixels.tolist()]

    def figure(self, *, through: bool) -> int | None:
        """The figure under the pointer, or, `through` the one that is posed, the next behind it."""
        if len(self.project.document.figures) == 1:
            return None
        mouse = imgui.get_mouse_pos()
        below = self.project.active if through else None
        return layering.figure_at(self.project, self._plane(complex(mouse.x, mouse.y)), below=below)

    def is_on_shape(self, place: complex) -> bool:
        outline, *holes = moved_loops(self.shown)
        return bool(contains(outline, np.array([place]), holes=holes)[0])


def _spot(canvas: _Canvas, look: Look, handle: int | None, *, on_ring: bool) -> Spot:
    """Return where the pointer is, and what is under it."""
    io, place = imgui.get_io(), canvas.pointer
    # Places that are so near are under the pointer.
    reach = GRIP * look.em * canvas.density / canvas.view.scale
    return Spot(
        place=place,
        handle=handle,
        on_anchor=is_on_anchor(canvas.project, handle, place, reach),
        on_ring=on_ring,
        on_shape=canvas.is_on_shape(place),
        figure=canvas.figure(through=io.key_alt),
        ctrl=io.key_ctrl,
        shift=io.key_shift,
        alt=io.key_alt,
    )


class _Axis(NamedTuple):
    """Where the axis is on the screen at which poses are flipped, if it is shown, and its grip."""

    x: float | None = None
    is_hot: bool = False
    is_pressed: bool = False


def _axis(session: Session, look: Look, canvas: _Canvas) -> _Axis:
    if not flipping.shows_axis(session, canvas.project):
        return _Axis()
    x = canvas.point(complex(canvas.project.figure.axis)).x
    return _Axis(x, *axis_grip(look, x))


def _ring(session: Session, canvas: _Canvas) -> Ring | None:
    """Return the ring around the one handle that is selected, where it can be turned."""
    project, gesture = canvas.project, session.pointer
    held = next((m for m in gesture.marks if isinstance(m, SweepMark)), None) if gesture else None
    if not session.overlays.handles or project.playhead.since is not None or session.cutting:
        return None
    if any(project.figure.is_locked(handle) for handle in project.selected):
        return None
    if len(project.selected) != 1 or not (gesture is None or held is not None):
        return None
    handles = canvas.shown.clip.figure.handles
    found = zip(handles, canvas.shown.handle_places, canvas.shown.handle_turns, strict=True)
    for handle, place, turn in found:
        if handle.id in project.selected:
            centre = canvas.point(complex(place))
            if held is not None:
                return Ring(centre, held.turn, is_held=True, swept=held.swept)
            return Ring(centre, turn, is_held=False, swept=0.0)
    return None


def _is_canvas_pressed() -> bool:
    """Tell whether the canvas, the last item, was pressed, and not to move the view."""
    return is_pressed() and not imgui.is_key_down(imgui.Key.space)


def _navigate(canvas: _Canvas, *, over: bool) -> list[Action]:
    """Pan by the middle button or Space and the left one; zoom by the wheel at the pointer."""
    io = imgui.get_io()
    view = canvas.view
    with_space = imgui.is_key_down(imgui.Key.space) and imgui.is_mouse_down(0)
    if over and (imgui.is_mouse_down(imgui.MouseButton_.middle) or with_space):
        delta = complex(io.mouse_delta.x, io.mouse_delta.y) * canvas.density
        actions = [do(pointing.use_space)] if with_space else []
        return [*actions, do(viewing.look_from, view.panned(delta))] if delta else actions
    if over and io.mouse_wheel:
        scale = min(max(view.scale * ZOOM_STEP**io.mouse_wheel, SMALLEST_ZOOM), LARGEST_ZOOM)
        return [do(viewing.look_from, view.zoomed(scale / view.scale, canvas.pixel))]
    return []


def _handles(
    session: Session, look: Look, canvas: _Canvas
) -> tuple[int | None, bool, list[Action]]:
    """Lay a button over each handle.

    Return the one under the pointer, whether it was pressed, and what its menu asks for.
    """
    hovered: int | None = None
    pressed = False
    actions: list[Action] = []
    is_hidden = not session.overlays.handles or session.cutting is not None
    if is_hidden or canvas.project.playhead.since is not None:
        return hovered, pressed, actions
    radius = GRIP * look.em
    handles = zip(canvas.shown.clip.figure.handles, canvas.shown.handle_places, strict=True)
    # The one that is drawn last lies on top.
    for handle, place in reversed(list(handles)):
        centre = canvas.point(complex(place))
        imgui.set_cursor_screen_pos((centre.x - radius, centre.y - radius))
        imgui.invisible_button(
            f"handle {handle.id}",
            (2 * radius, 2 * radius),
            imgui.ButtonFlags_.mouse_button_left | imgui.ButtonFlags_.mouse_button_right,
        )
        hovered = handle.id if in_hand() else hovered
        pressed = pressed or is_pressed()
        if session.pointer is None and imgui.is_item_clicked(imgui.MouseButton_.right):
            imgui.open_popup(f"menu of handle {handle.id}")
        actions += _menu(canvas, handle.id)
    return hovered, pressed, actions


def _menu(canvas: _Canvas, identity: int) -> list[Action]:
    actions: list[Action] = []
    if not imgui.begin_popup(f"menu of handle {identity}"):
        return actions
    handle = canvas.project.figure.handle(identity)
    target = canvas.shown.pose.targets.get(identity) if canvas.shown.pose else None
    item = imgui.internal.menu_item_ex  # as menu_item_simple, with icons in a column
    if item("Delete", icons.ICON_FA_TRASH, with_key(ALT, "click")):
        actions.append(do(posing.remove_handles, frozenset({identity})))
    is_anchor = handle.position == canvas.project.figure.anchor
    if item("Unlock" if handle.locked else "Lock", icons.ICON_FA_LOCK):
        command = handle_commands.lock_handles
        chosen = frozenset({identity})
        actions.append(do(editing.edit_figure, partial(command, locked=not handle.locked), chosen))
    label = "Automatic anchor" if is_anchor else "Make it the anchor"
    if item(label, icons.ICON_FA_ANCHOR, with_key(CTRL, "click")):
        actions.append(do(posing.anchor_at, identity))
    is_turned = target is not None and target.rotation is not None
    if item("Let it turn freely", icons.ICON_FA_ROTATE, enabled=is_turned):
        actions.append(do(posing.free_turn, identity))
    imgui.end_popup()
    return actions


def _go_on(session: Session, look: Look, canvas: _Canvas) -> list[Action]:
    """Follow the pointer in what it began; end it where the button is let go."""
    gesture = session.pointer
    if gesture is None:
        return []
    if imgui.is_key_pressed(imgui.Key.escape) or imgui.is_mouse_clicked(RIGHT):
        return [do(pointing.cancel)]
    for mark in gesture.marks:
        if isinstance(mark, BoxMark):
            low, high = canvas.point(mark.corner), canvas.point(mark.opposite)
            draw_list = imgui.get_window_draw_list()
            accent = imgui.get_style_color_vec4(imgui.Col_.nav_cursor)
            draw_list.add_rect_filled(low, high, ink(accent, 0.12))
            draw_list.add_rect(low, high, ink(accent, 0.8))
        elif isinstance(mark, StrokeMark):
            _draw_stroke(look, canvas, mark)
        elif isinstance(mark, JointMark):
            parent = None if mark.parent is None else canvas.project.puppets[mark.parent].shown
            draw_joint(look, mark, canvas.point, canvas.points, parent)
        elif isinstance(mark, EntryMark):
            draw_entry(look, mark, canvas.point)
    io, pointer = imgui.get_io(), canvas.pointer
    actions: list[Action] = []
    # Only what is turned goes by steps; Ctrl let go after Ctrl+Z is not to pull once more.
    is_turning = any(isinstance(mark, SweepMark) for mark in gesture.marks)
    is_stepped = is_turning and io.key_ctrl != session.snaps
    if io.mouse_delta.x or io.mouse_delta.y or is_stepped:
        move = pointing.move_in_steps if io.key_ctrl else pointing.move
        actions.append(do(move, pointer))
    characters = typed()
    if characters:
        actions.append(do(pointing.type_in, characters))
    is_entered = any(map(imgui.is_key_pressed, (imgui.Key.enter, imgui.Key.keypad_enter)))
    if is_entered or not imgui.is_mouse_down(imgui.MouseButton_.left):
        actions.append(do(pointing.end, pointer))
    return actions


def _strokes_on_their_way(look: Look, canvas: _Canvas) -> None:
    """Draw the strokes that the worker has not come to yet."""
    figure, known = canvas.project.figure, canvas.project.puppet.cut.source
    done = () if known is None else known.strokes
    for stroke in figure.cut_out.strokes[len(done) :]:
        places = tuple(complex(place) for place in stroke.points + figure.corner)
        mark = StrokeMark(points=places, radius=stroke.radius, keeps=stroke.keeps)
        _draw_stroke(look, canvas, mark)


def _draw_stroke(look: Look, canvas: _Canvas, mark: StrokeMark) -> None:
    points = [canvas.point(place) for place in mark.points]
    draw_stroke(look, mark, points, canvas.view.scale / canvas.density)


def _hint(session: Session, canvas: _Canvas, spot: Spot) -> str:
    """Return what can be done where the pointer is."""
    if session.pointer is not None:
        told = [f"{_how(hint)} {hint.what}" for hint in session.pointer.ways]
        return _sentence([*told, "Esc takes it back"])
    if session.cutting is not None:
        found = [
            hint for tool in tools_of(session) for hint in tool.hints(session, canvas.project, spot)
        ]
        return _sentence([*(f"{_how(hint)} {hint.what}" for hint in found), "Esc goes back"])
    if canvas.project.playhead.since is not None:
        return "Space stops"
    if not session.overlays.handles:
        return "The handles are hidden: H shows them"
    found = [
        hint for tool in tools_of(session) for hint in tool.hints(session, canvas.project, spot)
    ]
    told = [f"{_how(hint)} {hint.what}" for hint in found]
    if spot.handle is not None:
        names = {handle.id: handle.name for handle in canvas.shown.clip.figure.handles}
        return f"{names[spot.handle]}: {', '.join(told)}"
    if not (spot.on_shape or spot.on_ring):
        told += ["wheel to zoom", "middle drag to move the view"]
    return _sentence(told)


def _sentence(parts: list[str]) -> str:
    text = ", ".join(parts)
    return text[:1].upper() + text[1:]


def _how(hint: Hint) -> str:
    return with_key(KEYS[hint.key], hint.how) if hint.key else hint.how

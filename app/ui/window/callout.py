"""The card that leads through a first animation: what to do next, beside where it is done."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Action, Guide, GuideStep, Project, Session, do
from app.editor.actions import exporting, guiding
from app.ui.panel import is_in_front
from app.ui.shortcuts import BINDINGS
from app.ui.style import SMALL, Look, ink, main_button, sized, tip
from app.ui.viewport import Screen
from engine.arrays import Complexes

Places = Mapping[str, tuple[ImVec2, ImVec2]]
WIDTH, GAP, MARGIN = 19.0, 1.6, 0.8  # em: of the card, between it and what it points at, around it
RING, REACH = 1.3, 5.0  # em: around a place of the drawing; how near a handle counts as there
SPARSE = 16  # one vertex of so many tells where the drawing is
COVERS = 1e5  # pixels of distance that it is worth not to cover the whole drawing
STEPS = 9  # places that are tried along each side of the room
NAME = "Guide"
TITLES: dict[GuideStep, str] = {
    "handle": "Add a handle",
    "time": "Go to another frame",
    "pose": "Pose again",
    "play": "Play",
    "export": "Export a GIF",
    "done": "Your first animation",
}
FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.always_auto_resize
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_focus_on_appearing
    | imgui.WindowFlags_.no_nav
    | imgui.WindowFlags_.no_move
)


class _Box(NamedTuple):
    """A rectangle of the screen."""

    low: ImVec2
    high: ImVec2

    @property
    def middle(self) -> ImVec2:
        return (self.low + self.high) / 2

    def grown(self, by: float) -> "_Box":
        return _Box(self.low - ImVec2(by, by), self.high + ImVec2(by, by))

    def meets(self, other: "_Box") -> bool:
        return (
            self.low.x < other.high.x
            and other.low.x < self.high.x
            and self.low.y < other.high.y
            and other.low.y < self.high.y
        )

    def nearest(self, point: ImVec2) -> ImVec2:
        """Return its point that is nearest to another one."""
        x = min(max(point.x, self.low.x), self.high.x)
        return ImVec2(x, min(max(point.y, self.low.y), self.high.y))


class _Lead(NamedTuple):
    """What the card says, what it points at, and where that is to be dragged."""

    text: str
    at: _Box | None = None
    to: _Box | None = None
    is_round: bool = False
    # Whether the card may lie over panels, too.
    anywhere: bool = False

    @property
    def kept_free(self) -> tuple[_Box, ...]:
        """What the card does not cover: what it points at, and the way of the hand from there."""
        if self.at is None:
            return ()
        if self.to is None:
            return (self.at,)
        low = ImVec2(min(self.at.low.x, self.to.low.x), min(self.at.low.y, self.to.low.y))
        high = ImVec2(max(self.at.high.x, self.to.high.x), max(self.at.high.y, self.to.high.y))
        return self.at, _Box(low, high)


class Callout:
    """Draws the card, and keeps it where it is while the hand is at what it tells."""

    def __init__(self) -> None:
        self.told = ""  # by the card
        self._size = ImVec2(0, 0)  # of the card in the frame before
        self._key: tuple[object, ...] = ()
        self._corner = ImVec2(0, 0)

    def draw(self, session: Session, look: Look, places: Places) -> list[Action]:
        """Draw the card of the step that is next, if there is a guide; no dialog is covered.

        `places` has where things were drawn in the frame before, by their names.
        """
        guide, project = session.guide, session.project
        if guide is None or guide.project is not project or project is None:
            return []
        viewport = imgui.internal.find_window_by_name("###Viewport")
        shown = project.puppet.shown
        if session.dialog is not None or viewport is None or shown is None:
            return []
        screen = Screen(session, project, shown, viewport.pos)
        lead = _lead(session, look, guide, screen, places)
        self.told = lead.text
        around = imgui.get_main_viewport() if lead.anywhere else viewport
        room = _Box(around.pos, around.pos + around.size).grown(-MARGIN * look.em)
        self._settle(session, look, guide, lead, screen, room)
        imgui.set_next_window_pos(self._corner)
        imgui.push_style_var(imgui.StyleVar_.window_border_size, 1.5)
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.6 * look.em)
        imgui.push_style_color(imgui.Col_.window_bg, look.palette.panel)
        imgui.push_style_color(imgui.Col_.border, look.palette.accent)
        imgui.begin(f"{NAME}###guide", flags=FLAGS)
        if not imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
            imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())
        actions = _contents(session, look, guide, lead.text)
        self._size = imgui.get_window_size()
        _point(look, _Box(self._corner, self._corner + self._size), lead)
        imgui.end()
        imgui.pop_style_color(2)
        imgui.pop_style_var(2)
        return actions

    def _settle(
        self,
        session: Session,
        look: Look,
        guide: Guide,
        lead: _Lead,
        screen: Screen,
        room: _Box,
    ) -> None:
        """Find the card's place, unless it has one for what it tells now."""
        project = screen.project
        if self._key and (session.pointer or project.timing.gesture):
            return
        boxes = lead.kept_free
        corners = [corner for box in (room, *boxes) for corner in box]
        sides = (side / 4 for corner in corners for side in corner)
        # While it plays, the card stays where it is.
        pose = None if project.playhead.since is not None else screen.shown.pose
        key = (guide.step, lead.text, *self._size, pose, *map(round, sides))
        if key == self._key:
            return
        self._key = key
        placement = screen.shown.placement
        around = placement.on(screen.shown.positions[::SPARSE])
        self._corner = _free_corner(self._size, boxes, room, _pixels(screen, around), GAP * look.em)


def _pixels(screen: Screen, places: Complexes) -> Complexes:
    """Return where places of the scene are on the screen."""
    points = screen.points(places)
    return np.array([complex(point.x, point.y) for point in points])


def _free_corner(
    size: ImVec2, boxes: Sequence[_Box], room: _Box, drawing: Complexes, gap: float
) -> ImVec2:
    """Return where a card covers nothing that it points at, least of the drawing, and is near."""
    ends = room.high - size
    xs = list(np.linspace(room.low.x, max(ends.x, room.low.x), STEPS))
    ys = list(np.linspace(room.low.y, max(ends.y, room.low.y), STEPS))
    for box in boxes:
        xs += [box.low.x - size.x - gap, box.middle.x - size.x / 2, box.high.x + gap]
        ys += [box.low.y - size.y - gap, box.middle.y - size.y / 2, box.high.y + gap]
    target = boxes[0].middle if boxes else ImVec2(ends.x, room.low.y)
    found, least = ImVec2(xs[STEPS - 1], ys[0]), np.inf
    for x, y in product(xs, ys):
        corner = ImVec2(max(min(x, ends.x), room.low.x), max(min(y, ends.y), room.low.y))
        card = _Box(corner, corner + size)
        if any(card.meets(box.grown(gap / 2)) for box in boxes):
            continue
        covered = (
            (drawing.real > card.low.x)
            & (drawing.real < card.high.x)
            & (drawing.imag > card.low.y)
            & (drawing.imag < card.high.y)
        )
        way = target - card.nearest(target)
        cost = COVERS * float(covered.mean()) + float(np.hypot(way.x, way.y))
        if cost < least:
            found, least = corner, cost
    return found


def _lead(session: Session, look: Look, guide: Guide, screen: Screen, places: Places) -> _Lead:
    match guide.step:
        case "handle":
            return _to_handle(look, guide, screen)
        case "time":
            ruler = _box(places, "ruler")
            to = None if ruler is None else _Box(ruler.middle, ruler.middle)
            return _Lead(
                "Drag the playhead along the ruler, to about the middle.",
                _box(places, "playhead"),
                to,
            )
        case "pose":
            return _to_pose(look, guide, screen)
        case "play":
            keys = BINDINGS["play"].keys_in_words
            return _Lead(
                f"Click here, or press {keys}: what lies between the poses fills itself in.",
                _box(places, "play"),
            )
        case "export":
            return _to_export(session, screen.project, places)
        case "done":
            exported = session.exported
            name = "The GIF" if exported is None else exported.out.name
            return _Lead(
                f"{name} is there. The project is yours to go on with: add keys, drag their ends "
                "in time, save it."
            )


def _to_handle(look: Look, guide: Guide, screen: Screen) -> _Lead:
    if guide.aim is None:
        return _Lead(
            "Click on a part that is to stay where it is, then on one that is to move. Each click "
            "adds a handle."
        )
    return _Lead(
        "Click on the nose. The handles that are there already hold legs and body in place.",
        _ring(look, screen, guide.aim),
        is_round=True,
    )


def _to_pose(look: Look, guide: Guide, screen: Screen) -> _Lead:
    if screen.project.unkeyed is not None:
        insert = BINDINGS["insert key"]
        return _Lead(
            f"Auto-key is off, so that no key has this pose: {insert.label} "
            f"({insert.keys_in_words}) makes one."
        )
    if guide.aim is None or guide.goal is None:
        return _Lead("Drag one of the handles. A key with the new pose makes itself.")
    figure, places = screen.shown.clip.figure, screen.shown.handle_places
    near = {
        abs(handle.position - guide.aim): complex(place)
        for handle, place in zip(figure.handles, places, strict=False)
    }
    reach = REACH * look.em / screen.scale
    held = near[min(near)] if near and min(near) < reach else guide.aim
    return _Lead(
        "Drag the nose down to the ground. A key with the new pose makes itself.",
        _ring(look, screen, held),
        _ring(look, screen, guide.goal),
        is_round=True,
    )


def _to_export(session: Session, project: Project, places: Places) -> _Lead:
    if exporting.is_under_way(session):
        return _Lead("The GIF is being made.")
    if not is_in_front("Export"):
        window = imgui.internal.find_window_by_name("###Export")
        tab = None if window is None else window.dc.dock_tab_item_rect
        at = None if tab is None else _Box(tab.min, tab.max)
        return _Lead("Open the tab Export.", at, anywhere=True)
    if project.document.export.format != guiding.FORMAT:
        return _Lead("Choose GIF as the format.", _box(places, "format"))
    return _Lead("Click Export, and choose where the GIF goes.", _box(places, "start export"))


def _box(places: Places, name: str) -> _Box | None:
    return _Box(*places[name]) if name in places else None


def _ring(look: Look, screen: Screen, place: complex) -> _Box:
    """Return the box of a ring around a place of the drawing."""
    point = screen.point(place)
    return _Box(point, point).grown(RING * look.em)


def _contents(session: Session, look: Look, guide: Guide, text: str) -> list[Action]:
    """Write the card; return what its buttons ask for."""
    actions: list[Action] = []
    palette, steps = look.palette, guiding.STEPS
    is_done = guide.step == "done"
    with sized(1.0, look.bold):
        imgui.text(TITLES[guide.step])
    count = (
        f"{len(steps)} steps done" if is_done else f"{steps.index(guide.step) + 1} of {len(steps)}"
    )
    width = WIDTH * look.em
    with sized(SMALL):
        imgui.same_line(imgui.get_cursor_start_pos().x + width - imgui.calc_text_size(count).x)
        imgui.text_colored(palette.dim, count)
    imgui.push_text_wrap_pos(imgui.get_cursor_start_pos().x + width)
    imgui.text_unformatted(text)
    imgui.pop_text_wrap_pos()
    exported = session.exported
    if is_done and exported is not None:
        if main_button(look, f"{icons.ICON_FA_FOLDER_OPEN}  Open folder"):
            actions.append(do(exporting.open_folder, exported.out.parent))
        imgui.same_line()
    elif not is_done:
        _dots(look, steps.index(guide.step), len(steps))
    words = "Close" if is_done else "Leave"
    style = imgui.get_style()
    button = imgui.calc_text_size(words).x + 2 * style.frame_padding.x
    imgui.same_line(imgui.get_cursor_start_pos().x + width - button)
    if imgui.button(f"{words}###leave"):
        actions.append(do(guiding.leave))
    tip("End the guide; what you made stays", BINDINGS["leave guide"].keys_in_words)
    return actions


def _dots(look: Look, done: int, count: int) -> None:
    """Draw a dot for each step, those up to the present one filled."""
    corner, height = imgui.get_cursor_screen_pos(), imgui.get_frame_height()
    draw_list, radius = imgui.get_window_draw_list(), 0.25 * look.em
    for number in range(count):
        centre = ImVec2(corner.x + radius + number * 0.95 * look.em, corner.y + height / 2)
        colour = look.palette.accent if number <= done else look.palette.pressed
        draw_list.add_circle_filled(centre, radius, ink(colour))
    imgui.dummy(ImVec2(count * 0.95 * look.em, height))


def _point(look: Look, card: _Box, lead: _Lead) -> None:
    """Draw a line from the card to what it points at, and from there to where it is to be dragged.

    They are drawn with the card, below menus and dialogs; the pointer goes through them.
    """
    if lead.at is None:
        return
    draw_list, em = imgui.get_window_draw_list(), look.em
    colour, width = ink(look.palette.accent), 0.13 * em
    draw_list.push_clip_rect_full_screen()
    at = lead.at if lead.is_round else lead.at.grown(0.15 * em)
    if lead.is_round:
        draw_list.add_circle(at.middle, RING * em, colour, 0, width)
    else:
        draw_list.add_rect(*at, colour, 0.45 * em, width)
    begin = card.nearest(at.middle)
    end = _towards(at, begin, is_round=lead.is_round)
    draw_list.add_line(begin, end, colour, width)
    if lead.to is not None:
        to = lead.to
        if lead.is_round:
            draw_list.add_circle(to.middle, RING * em, colour, 0, width)
        _arrow(
            look,
            _towards(at, to.middle, is_round=lead.is_round),
            _towards(to, at.middle, is_round=lead.is_round),
        )
    draw_list.pop_clip_rect()


def _towards(box: _Box, point: ImVec2, *, is_round: bool) -> ImVec2:
    """Return the point of a ring's or a box's edge that faces another point."""
    if not is_round:
        return box.nearest(point)
    way = point - box.middle
    length = max(float(np.hypot(way.x, way.y)), 1e-6)
    return box.middle + way * ((box.high.x - box.low.x) / 2 / length)


def _arrow(look: Look, begin: ImVec2, end: ImVec2) -> None:
    """Draw an arrow from a point to another one."""
    draw_list, em, colour = imgui.get_window_draw_list(), look.em, ink(look.palette.accent)
    way = end - begin
    length = float(np.hypot(way.x, way.y))
    if length < em:
        return
    along = way / length
    across = ImVec2(-along.y, along.x) * (0.45 * em)
    neck = end - along * (0.8 * em)
    draw_list.add_line(begin, neck, colour, 0.13 * em)
    draw_list.add_triangle_filled(end, neck + across, neck - across, colour)

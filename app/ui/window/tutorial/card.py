"""The tutorial's card: the next step, beside the place where it is done."""

import numpy as np
from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Action, Session, TutorialStage, TutorialState, do
from app.editor.actions import tutorials
from app.editor.actions.project_files import exporting
from app.texts import _, ngettext
from app.ui.shortcuts.keys import shown_keys
from app.ui.style.theme import SMALL, Look, colour_u32
from app.ui.style.widgets import draw_tooltip, main_button, push_text_size
from app.ui.viewport.screen import ScreenMapping
from app.ui.window.tutorial.layout import Rect, find_free_corner
from app.ui.window.tutorial.steps import RING, Places, TutorialStep, find_tutorial_step
from engine.arrays import Complexes

WIDTH, GAP, MARGIN = 19.0, 1.6, 0.8  # em: of the card: width, distance from its target, margin
SPARSE = 16  # one vertex of this many stands for the drawing
NAME = _("Guide")
TITLES: dict[TutorialStage, str] = {
    "handle": _("Add a handle"),
    "time": _("Go to another frame"),
    "pose": _("Pose again"),
    "play": _("Play"),
    "export": _("Export a GIF"),
    "done": _("Your first animation"),
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


class Callout:
    """Draws the card, and keeps its place while the person does the step."""

    def __init__(self) -> None:
        self.shown_text = ""  # on the card
        self._size = ImVec2(0, 0)  # of the card in the frame before
        self._key: tuple[object, ...] = ()
        self._corner = ImVec2(0, 0)

    def draw(self, session: Session, look: Look, places: Places) -> list[Action]:
        """Draw the card of the next step, if the tutorial is active. It covers no dialog.

        `places` has the rectangles of items in the frame before, by their names.
        """
        guide, project = session.tutorial.state, session.project
        if guide is None or guide.project is not project or project is None:
            return []
        viewport = imgui.internal.find_window_by_name("###Viewport")
        shown = project.layer_runtime.shown
        if session.dialogs.current is not None or viewport is None or shown is None:
            return []
        screen = ScreenMapping(session, project, shown, viewport.pos)
        lead = find_tutorial_step(session, look, guide, screen, places)
        self.shown_text = lead.text
        window = imgui.get_main_viewport()
        whole = Rect(window.work_pos, window.work_pos + window.work_size)
        rooms = [] if lead.anywhere else [Rect(viewport.pos, viewport.pos + viewport.size)]
        rooms = [room.grown(-MARGIN * look.em) for room in (*rooms, whole)]
        self._settle(session, look, guide, lead, screen, rooms)
        imgui.set_next_window_pos(self._corner)
        imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.1 * look.em)
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.6 * look.em)
        imgui.push_style_color(imgui.Col_.window_bg, look.palette.panel)
        imgui.push_style_color(imgui.Col_.border, look.palette.accent)
        imgui.begin(f"{NAME}###guide", flags=FLAGS)
        if not imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
            imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())
        actions = _contents(session, look, guide, lead.text)
        self._size = imgui.get_window_size()
        _point(look, Rect(self._corner, self._corner + self._size), lead)
        imgui.end()
        imgui.pop_style_color(2)
        imgui.pop_style_var(2)
        return actions

    def _settle(
        self,
        session: Session,
        look: Look,
        guide: TutorialState,
        lead: TutorialStep,
        screen: ScreenMapping,
        rooms: list[Rect],
    ) -> None:
        """Choose the card's place, unless the card already has one for this step."""
        project = screen.project
        if self._key and (session.tools.active_tool or project.timeline.gesture):
            return
        boxes = lead.uncovered
        corners = [corner for box in (*rooms, *boxes) for corner in box]
        sides = (side / 4 for corner in corners for side in corner)
        # During playback the card stays in place.
        pose = None if project.timeline.playhead.since is not None else screen.shown.pose
        key = (guide.stage, lead.text, *self._size, pose, *map(round, sides))
        if key == self._key:
            return
        self._key = key
        placement = screen.shown.placement
        around = placement.apply(screen.shown.positions[::SPARSE])
        drawing = _pixels(screen, around)
        self._corner = find_free_corner(self._size, boxes, rooms, drawing, GAP * look.em)


def _pixels(screen: ScreenMapping, places: Complexes) -> Complexes:
    """Return points of the screen, in pixels, of places of the scene."""
    points = screen.points(places)
    return np.array([complex(point.x, point.y) for point in points])


def _contents(session: Session, look: Look, guide: TutorialState, text: str) -> list[Action]:
    """Write the card. Return the actions of its buttons."""
    actions: list[Action] = []
    palette, steps = look.palette, tutorials.STEPS
    is_done = guide.stage == "done"
    with push_text_size(1.0, look.bold):
        imgui.text(TITLES[guide.stage])
    count = (
        ngettext("{count} step done", "{count} steps done", len(steps)).format(count=len(steps))
        if is_done
        else _("{step} of {count}").format(step=steps.index(guide.stage) + 1, count=len(steps))
    )
    width = WIDTH * look.em
    with push_text_size(SMALL):
        imgui.same_line(imgui.get_cursor_start_pos().x + width - imgui.calc_text_size(count).x)
        imgui.text_colored(palette.dim, count)
    imgui.push_text_wrap_pos(imgui.get_cursor_start_pos().x + width)
    imgui.text_unformatted(text)
    imgui.pop_text_wrap_pos()
    exported = session.export.completed
    if is_done and exported is not None:
        if main_button(look, f"{icons.ICON_FA_FOLDER_OPEN}  {_('Open folder')}"):
            actions.append(do(exporting.open_folder, exported.out.parent))
        imgui.same_line()
    elif not is_done:
        _dots(look, steps.index(guide.stage), len(steps))
    words = _("Close") if is_done else _("End guide")
    style = imgui.get_style()
    button = imgui.calc_text_size(words).x + 2 * style.frame_padding.x
    imgui.same_line(imgui.get_cursor_start_pos().x + width - button)
    if imgui.button(f"{words}###leave"):
        actions.append(do(tutorials.end_tutorial))
    draw_tooltip(_("End the guide. Your work stays."), shown_keys(tutorials.end_tutorial))
    return actions


def _dots(look: Look, done: int, count: int) -> None:
    """Draw a dot for each step, filled up to the present step."""
    corner, height = imgui.get_cursor_screen_pos(), imgui.get_frame_height()
    draw_list, radius = imgui.get_window_draw_list(), 0.25 * look.em
    for number in range(count):
        centre = ImVec2(corner.x + radius + number * 0.95 * look.em, corner.y + height / 2)
        colour = look.palette.accent if number <= done else look.palette.pressed
        draw_list.add_circle_filled(centre, radius, colour_u32(colour))
    imgui.dummy(ImVec2(count * 0.95 * look.em, height))


def _point(look: Look, card: Rect, lead: TutorialStep) -> None:
    """Draw a line from the card to the step's item, and from there to the drop place.

    Both are drawn with the card, below menus and dialogs, and ignore the pointer.
    """
    if lead.at is None:
        return
    draw_list, em = imgui.get_window_draw_list(), look.em
    colour, width = colour_u32(look.palette.accent), 0.13 * em
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


def _towards(box: Rect, point: ImVec2, *, is_round: bool) -> ImVec2:
    """Return the point on a ring's or a box's edge that faces another point."""
    if not is_round:
        return box.nearest(point)
    way = point - box.middle
    length = max(float(np.hypot(way.x, way.y)), 1e-6)
    return box.middle + way * ((box.high.x - box.low.x) / 2 / length)


def _arrow(look: Look, begin: ImVec2, end: ImVec2) -> None:
    draw_list, em, colour = imgui.get_window_draw_list(), look.em, colour_u32(look.palette.accent)
    way = end - begin
    length = float(np.hypot(way.x, way.y))
    if length < em:
        return
    along = way / length
    across = ImVec2(-along.y, along.x) * (0.45 * em)
    neck = end - along * (0.8 * em)
    draw_list.add_line(begin, neck, colour, 0.13 * em)
    draw_list.add_triangle_filled(end, neck + across, neck - across, colour)

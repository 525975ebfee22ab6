"""What the viewport says over the drawing: the next step, or that no key holds the pose."""

from imgui_bundle import ImVec2, imgui

from app.document import Figure
from app.editor import Action, Project, do
from app.editor.actions import posing
from app.ui.shortcuts import BINDINGS
from app.ui.style import Look, ink, tip
from engine.maps import HarmonicMap

HINTS = (
    "Click on the drawing to add a handle.",
    "Drag a handle to pose; a second one holds another part in place.",
    "Move the playhead, then drag again: that makes the second key.",
)


def draw_badges(look: Look, project: Project, corner: ImVec2, room: ImVec2) -> list[Action]:
    """Tell what is special now: a pose that no key holds, or what to do next."""
    if project.unkeyed is not None:
        return _pill(
            look,
            "Unkeyed pose",
            ImVec2(corner.x + room.x / 2, corner.y + look.em),
            warn=True,
            button=BINDINGS["insert key"],
        )
    step = first_step(project)
    if step is not None:
        place = ImVec2(corner.x + room.x / 2, corner.y + room.y - 3.2 * look.em)
        return _pill(look, HINTS[step], place)
    return []


def draw_cutting(look: Look, corner: ImVec2, room: ImVec2) -> list[Action]:
    """Tell that the picture is shown at rest, to be cut out, and how to go back."""
    keys = BINDINGS["stop cutting"].keys_in_words
    place = ImVec2(corner.x + room.x / 2, corner.y + look.em)
    return _pill(look, f"Cutting out: {keys} goes back to posing", place)


def first_step(project: Project) -> int | None:
    """Return which hint a new project is at; None where the person has found the way."""
    figure = project.figure
    if not figure.handles:
        return 0
    if len(figure.keys) > 1 or project.playhead.since is not None:
        return None
    return 2 if _is_posed(figure) else 1


def _is_posed(figure: Figure) -> bool:
    """Tell whether the first pose is another than the one in which the picture was drawn."""
    pose = figure.keys[0].pose
    rest = HarmonicMap.identity(figure.domain.cage, figure.domain.holes)
    return not figure.map_of(pose).is_same(rest)


def _pill(
    look: Look, text: str, place: ImVec2, *, warn: bool = False, button: object = None
) -> list[Action]:
    actions: list[Action] = []
    padding = 0.7 * look.em
    size = imgui.calc_text_size(text)
    label = "Insert key" if button is not None else ""
    extra = imgui.calc_text_size(label).x + 1.6 * look.em if label else 0.0
    width, height = size.x + 2 * padding + extra, 2.1 * look.em
    low = ImVec2(place.x - width / 2, place.y)
    high = ImVec2(place.x + width / 2, place.y + height)
    palette = look.palette
    draw_list = imgui.get_window_draw_list()
    draw_list.add_rect_filled(low, high, ink(palette.panel, 0.92), height / 2)
    edge = palette.warning if warn else palette.line
    draw_list.add_rect(low, high, ink(edge), height / 2, 1.2)
    text_place = ImVec2(low.x + padding, low.y + (height - size.y) / 2)
    draw_list.add_text(text_place, ink(palette.warning if warn else palette.text), text)
    if label:
        slim = imgui.get_frame_height() - 0.1 * look.em
        left = high.x - extra - 0.2 * look.em
        imgui.set_cursor_screen_pos((left, low.y + (height - slim) / 2))
        imgui.push_style_var(imgui.StyleVar_.frame_rounding, slim / 2)
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (0, 0))
        if imgui.button(label, (extra, slim)):
            actions.append(do(posing.insert_key))
        imgui.pop_style_var(2)
        tip("Keep this pose in a key", BINDINGS["insert key"].keys_in_words)
    return actions

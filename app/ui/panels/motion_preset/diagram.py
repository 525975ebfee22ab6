"""Small diagrams of bodies, with the joints of each kind."""

import math
from collections.abc import Collection, Mapping

from imgui_bundle import ImVec2, imgui

from app.editor import Action, do
from app.editor.actions.posing.motion_presets import joint_placement
from app.editor.tools.edit_tools.joint_tools import joint_role
from app.editor.work.motion_setup import MotionSetup
from app.rigging import BodyKind
from app.texts import _
from app.ui.style.drawing import draw_knob
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip, is_pressed
from app.ui.viewport.interaction.shapes import role_colour

DOT, LIMB, THIN = 0.34, 0.14, 0.09  # em: dot and line of the large diagram, line of the buttons
MARGIN = 0.6  # em
# Positions of joints: from the middle to the right, and up, in body heights.
_FRONT = {
    "hips": (0.0, 0.48),
    "chest": (0.0, 0.68),
    "neck": (0.0, 0.78),
    "head": (0.0, 0.94),
    "tail": (-0.2, 0.34),
    "shoulder.L": (0.13, 0.7),
    "elbow.L": (0.24, 0.57),
    "hand.L": (0.32, 0.44),
    "hip.L": (0.09, 0.44),
    "knee.L": (0.11, 0.24),
    "foot.L": (0.12, 0.04),
}
_OTHERS = {
    name.replace(".L", ".R"): (-x, y) for name, (x, y) in _FRONT.items() if name.endswith(".L")
}
_SIDE = {
    "hips": (0.0, 0.48),
    "chest": (0.03, 0.7),
    "neck": (0.04, 0.8),
    "head": (0.09, 0.94),
    "tail": (-0.3, 0.36),
    "shoulder.L": (-0.03, 0.68),
    "elbow.L": (-0.12, 0.55),
    "hand.L": (-0.13, 0.4),
    "shoulder.R": (0.09, 0.68),
    "elbow.R": (0.18, 0.56),
    "hand.R": (0.31, 0.52),
    "hip.L": (0.06, 0.44),
    "knee.L": (0.15, 0.28),
    "foot.L": (0.17, 0.04),
    "hip.R": (-0.05, 0.44),
    "knee.R": (-0.04, 0.24),
    "foot.R": (-0.19, 0.06),
}
_FOUR = {
    "hips": (-0.36, 0.62),
    "chest": (0.3, 0.62),
    "neck": (0.44, 0.8),
    "head": (0.62, 0.88),
    "tail": (-0.62, 0.48),
    "hip.L": (-0.42, 0.5),
    "knee.L": (-0.45, 0.33),
    "foot.L": (-0.47, 0.04),
    "hip.R": (-0.3, 0.5),
    "knee.R": (-0.28, 0.33),
    "foot.R": (-0.3, 0.04),
    "shoulder.R": (0.22, 0.5),
    "elbow.R": (0.2, 0.33),
    "hand.R": (0.18, 0.04),
    "shoulder.L": (0.36, 0.5),
    "elbow.L": (0.38, 0.33),
    "hand.L": (0.38, 0.04),
}
PLACES: Mapping[str, Mapping[str, tuple[float, float]]] = {
    kind: {
        **places,
        **{
            f"tail.{number}": (
                places["hips"][0] + number / 5 * (places["tail"][0] - places["hips"][0]),
                places["hips"][1] + number / 5 * (places["tail"][1] - places["hips"][1]),
            )
            for number in range(1, 5)
        },
    }
    for kind, places in (
        ("biped-front", {**_FRONT, **_OTHERS}),
        ("biped-side", _SIDE),
        ("four-legs", _FOUR),
    )
}
# Missing joints that the diagram shows in addition to the usual ones.
OFFERED = ("neck", "tail")
GHOST = (
    (-0.26, 0.06), (-0.26, 0.66), (-0.2, 0.82), (-0.08, 0.92), (0.08, 0.92), (0.2, 0.82),
    (0.26, 0.66), (0.26, 0.06), (0.13, 0.16), (0.0, 0.06), (-0.13, 0.16), (-0.26, 0.06),
)  # fmt: skip


def draw_body_diagram(look: Look, kind: BodyKind, low: ImVec2, size: ImVec2, colour: int) -> None:
    """Draw a kind of body as a few lines into a box."""
    draw_list = imgui.get_window_draw_list()
    if not kind.parents:
        points = [_in_box(low, size, place) for place in GHOST]
        draw_list.add_polyline(list(points), colour, THIN * look.em, 0)
        return
    points_of = {name: _in_box(low, size, at) for name, at in _places(kind, kind.usual).items()}
    for name, point in points_of.items():
        before = kind.parent(name, points_of)
        if before:
            draw_list.add_line(points_of[before], point, colour, THIN * look.em)
    if "head" in points_of:
        draw_list.add_circle_filled(points_of["head"], 0.3 * look.em, colour)


def draw_joint_diagram(look: Look, draft: MotionSetup, size: ImVec2) -> list[Action]:
    """Draw the joints of a setup: filled if present. A click adds or removes a joint."""
    kind, actions = draft.body_kind, list[Action]()
    low = imgui.get_cursor_screen_pos()
    names = [*kind.usual, *OFFERED, *draft.joints]
    shown = {name: at for name, at in _places(kind, names).items() if name in names}
    points = {name: _in_box(low, size, at) for name, at in shown.items()}
    draw_list = imgui.get_window_draw_list()
    for name, point in points.items():
        before = kind.parent(name, points)
        if before:
            is_there = name in draft.joints
            tone = role_colour(look, joint_role(name)) if is_there else look.palette.line
            draw_list.add_line(points[before], point, colour_u32(tone), LIMB * look.em)
    grip = ImVec2(1.3 * look.em, 1.3 * look.em)
    for name, point in points.items():
        is_there = name in draft.joints
        imgui.set_cursor_screen_pos(point - grip / 2)
        imgui.invisible_button(f"joint {name}", grip)
        is_hot = imgui.is_item_hovered()
        if is_pressed():
            actions.append(
                do(
                    joint_placement.exclude_joint if is_there else joint_placement.include_joint,
                    name,
                )
            )
        text = _("{name}: click to leave it out") if is_there else _("{name}: click to add it")
        draw_tooltip(text.format(name=name))
        radius = DOT * (1.25 if is_hot or name == draft.selected_joint else 1.0)
        colour = role_colour(look, joint_role(name))
        if is_there:
            draw_knob(look, point, radius, colour)
        else:
            draw_list.add_circle_filled(point, radius * look.em, colour_u32(look.palette.panel))
            draw_list.add_circle(point, radius * look.em, colour_u32(look.palette.dim), 0, 1.5)
    imgui.set_cursor_screen_pos(low)
    imgui.dummy(size)
    return actions


def _places(kind: BodyKind, names: Collection[str]) -> dict[str, tuple[float, float]]:
    """Return the diagram's positions of a kind's joints, in order."""
    known = PLACES.get(kind.name)
    if known is not None:
        return {name: known[name] for name in kind.parents if name in names}
    links = [name for name in kind.parents if name in names]
    last = max(len(links) - 1, 1)
    return {
        name: (0.62 - 1.24 * at / last, 0.5 + 0.22 * math.sin(7.5 * at / last))
        for at, name in enumerate(links)
    }


def _in_box(low: ImVec2, size: ImVec2, place: tuple[float, float]) -> ImVec2:
    x, y = place
    scale = min(size.y, size.x / 1.4)
    return ImVec2(low.x + size.x / 2 + scale * x, low.y + size.y / 2 - scale * (y - 0.5))

"""Texts stand out from all that they are written on, in both themes."""

from itertools import cycle, product

import numpy as np
import pytest
from imgui_bundle import imgui
from layered import openraster
from legibility import LEAST, contrast, glyphs
from PIL import Image

from app.document import Variant, layer_commands
from app.document.keyframe import Target
from app.editor import FileDialog, Question, do
from app.editor.actions import dialog_actions, editing, playback, viewing
from app.editor.actions.dialog_actions import close_dialog, show_dialog
from app.editor.actions.layer_setup import cut_out_editing
from app.editor.actions.posing.pose_drag import nudge_handles, set_targets
from app.editor.actions.timing import timeline_drag
from app.editor.layering.layer_list import (
    toggle_layers_hidden,
    toggle_visibility_key,
)
from app.editor.layering.layer_selection import set_active_layer
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.work.pending_change import PendingChange
from app.solving import KeyResolver
from app.storage.assets import sample_images
from app.ui.style.theme import PALETTES

FADED = 0.5  # seconds
TABS = ("Handle", "Layers", "Animate", "Shape", "Export", "Measure")
OPEN = imgui.test_engine.TestAction.open
TEXTS = ("text", "dim", "accent", "good", "warning", "danger", "anchor")
SURFACES = ("desk", "panel", "raised", "hovered", "pressed")
FILLED = (("on_accent", "accent"), ("on_accent", "warning"), ("on_accent", "text"))


def show_in(window, theme):
    if window.session.settings.preferences.theme != theme:
        viewing.toggle_theme(window.session)
    window.frames(3)


@pytest.fixture(params=["by turns", pytest.param("both", marks=pytest.mark.long)])
def check(window, request):
    """Checks all that is written in the window as it is, and says where a text is hard to read.

    That is shown in one theme and the next state in the other one, or each in both.
    """
    turns = cycle(PALETTES)

    def look(state):
        window.settle()
        # Messages have faded in by then.
        window.clock.now += FADED
        for theme in PALETTES if request.param == "both" else (next(turns),):
            show_in(window, theme)
            seen = [glyph for glyph in glyphs(window) if is_enabled(glyph)]
            assert len(seen) > 15, (theme, state)
            faint = {(each.ink, each.ground): each for each in seen if each.contrast < LEAST}
            assert not faint, (theme, state, *faint.values())

    return look


def is_enabled(glyph):
    """Tell whether a glyph is not dimmed by a dialog in front of it."""
    dialog = imgui.internal.get_top_most_popup_modal()
    corners = (imgui.ImVec2(*glyph.box[:2]), imgui.ImVec2(*glyph.box[2:]))
    return dialog is None or all(map(dialog.rect().contains, corners))


def levels(colour):
    return 255 * np.array([colour.x, colour.y, colour.z])


def over(colour, ground):
    """Return a translucent colour on another one."""
    return ground + colour.w * (levels(colour) - ground)


@pytest.mark.parametrize("theme", PALETTES)
def test_each_colour_of_texts_stands_out_from_each_surface(window, theme):
    show_in(window, theme)
    palette = PALETTES[theme]
    surfaces = {name: levels(getattr(palette, name)) for name in SURFACES}
    surfaces["chosen row"] = over(imgui.get_style_color_vec4(imgui.Col_.header), surfaces["panel"])
    texts = {name: levels(getattr(palette, name)) for name in TEXTS}
    found = {
        (text, surface): contrast(texts[text], surfaces[surface])
        for text, surface in product(texts, surfaces)
    }
    for ink, ground in FILLED:
        found[ink, ground] = contrast(*(levels(getattr(palette, name)) for name in (ink, ground)))
    for colour in ("text_selected_bg", "plot_histogram"):
        filled = over(imgui.get_style_color_vec4(imgui.Col_[colour]), surfaces["raised"])
        found["text", colour] = contrast(texts["text"], filled)
    assert not {pair: value for pair, value in found.items() if value < LEAST}


def test_the_welcome_view(window, tmp_path, check):
    preferences = window.session.settings.preferences
    for path in (sample_images() / "bar.png", tmp_path / "gone.png"):
        preferences = preferences.with_recent(path)
    window.session.settings.preferences = preferences
    check("welcome")

    def point(robot):
        robot.set_ref("Welcome")
        robot.mouse_move("**/###recent 1")

    window.run(point)
    check("a recent file")


def test_all_tabs_of_a_pose_that_falls_short(window, loose, check):
    session = window.session
    width, height = loose.document.canvas
    set_targets(session, {1: Target(position=complex(2.4 * width, 0.5 * height))})
    window.settle()
    viewing.compare_with_method(session, Variant.LINEAR)
    for tab in TABS:
        window.show_tab(tab)
        check(tab)
    solved = loose.layer.poses[:-1]
    resolver = KeyResolver(before=loose.layer, bounds=loose.layer.bounds, poses=solved)
    loose.pending.add(PendingChange(label="Solving the keys", key_resolver=resolver))
    window.show_tab("Shape")
    check("progress")


@pytest.mark.usefixtures("loose")
def test_rows_buttons_and_keys_under_the_pointer(window, check):
    window.show_tab("Shape")

    def hold(robot, ref, item):
        robot.set_ref(ref)
        robot.mouse_move(item)
        robot.mouse_down(0)
        robot.yield_(2)

    for ref, item in (("//Measure", "**/###key 24"), ("//Shape", "**/###Stiff")):
        window.show_tab(ref.removeprefix("//"))
        window.run(lambda robot, ref=ref, item=item: hold(robot, ref, item))
        check(item)
        window.run(lambda robot: robot.mouse_up(0))
    window.run(lambda robot: robot.mouse_move("//Timeline/**/key 24"))
    window.frames(60)
    check("key")


def test_a_pose_that_no_key_holds_and_a_cut_out(window, loose, check):
    session = window.session
    viewing.toggle_auto_key(session)
    loose.selection.handles = frozenset({1})
    nudge_handles(session, 30j)
    window.settle()
    assert loose.unkeyed_pose is not None
    check("unkeyed")
    cut_out_editing.toggle_cut_tool(session, "remove")
    window.run(lambda robot: robot.item_click("//###mode/###cut-out settings"))
    check("cut-out")


def test_layers_that_are_chosen_hidden_and_switched(window, tmp_path, check):
    names = ("arm", "body", "wall")
    stack = "".join(f'<layer name="{n}" src="data/{i}.png"/>' for i, n in enumerate(names))
    picture = Image.new("RGBA", (240, 200))
    picture.paste((40, 40, 200, 255), (60, 25, 110, 180))
    path = tmp_path / "man.ora"
    path.write_bytes(openraster((240, 200), stack, [picture] * 3))
    project = window.open(path)
    session = window.session
    (wall, _, arm) = (layer.id for layer in project.document.layers)
    editing.edit_document(session, layer_commands.set_opacity(arm, 0.5))
    toggle_layers_hidden(session, arm)
    toggle_visibility_key(session, wall)
    playback.seek(session, 12)
    timeline_drag.set_time_range(session, TimeRangeView(0.0, 1.0))
    for identity in (arm, wall):
        set_active_layer(session, identity)
        window.show_tab("Layers")
        check(identity)


@pytest.mark.usefixtures("loose")
def test_menus_messages_and_dialogs(window, tmp_path, check):
    session = window.session
    for tone in ("info", "good", "error"):
        session.notices.show(f"A message that is {tone}.", tone=tone, details="Its details")
    session.tools.hint = "A hint"
    editing.select_handles(session, frozenset({0, 1}))
    check("messages")
    session.notices.toasts = []

    def open_menu(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_action(OPEN, "Edit")
        robot.mouse_move("//$FOCUSED/###Copy")

    window.run(open_menu)
    check("menu")
    window.run(lambda robot: robot.popup_close_all())
    dialog_actions.show_shortcuts(session)
    check("keys")
    close_dialog(session)
    answers = (("Yes", do(close_dialog)), ("No", do(close_dialog)))
    show_dialog(session, Question(title="Question", text="?", answers=answers))
    check("question")
    for name in ("one.png", "two.png"):
        (tmp_path / name).write_bytes(b"")
    show_dialog(
        session,
        FileDialog(
            title="Save",
            folder=tmp_path,
            name="one.png",
            suffixes=(".png",),
            writes=True,
            chosen=lambda _: do(close_dialog),
        ),
    )
    window.frames(3)
    window.run(lambda robot: robot.item_click("//###dialog/**/###entry two.png"))
    check("files")

"""Questions answered by keys, menus closed by them, and keys in words."""

import pytest
from bars import open_bar
from harness import Harness
from imgui_bundle import imgui

from app.editor import Question, do
from app.editor.actions import viewing
from app.editor.actions.dialog_actions import show_dialog
from app.storage.assets import sample_images
from app.ui.panel import is_in_front
from app.ui.shortcuts import keys as shortcut_keys
from app.ui.shortcuts.keys import chords_of, format_chord, format_modified, parse_chords
from app.ui.shortcuts.table import ACTIONS, MENUS, SUBMENUS

OPEN = imgui.test_engine.TestAction.open
CTRL, SHIFT, ALT = (
    int(key) for key in (imgui.Key.mod_ctrl, imgui.Key.mod_shift, imgui.Key.mod_alt)
)


@pytest.fixture
def asked(window):
    """A question with two answers and Cancel; returns which of them were given."""
    given = []

    def give(_, what):
        given.append(what)

    answers = tuple((text, do(give, text)) for text in ("Save", "Don't save"))
    window.act(show_dialog, Question(title="Unsaved changes", text="?", answers=answers))
    window.frames(3)
    return given


def press(window, *keys):
    def play(robot):
        robot.yield_()  # until the window knows that it has the keys
        for key in keys:
            robot.key_press(int(key))

    window.run(play)


@pytest.mark.parametrize("key", [imgui.Key.enter, imgui.Key.keypad_enter, imgui.Key.space])
def test_enter_gives_the_first_answer(window, asked, key):
    press(window, key)
    assert asked == ["Save"]
    assert window.session.dialogs.current is None


@pytest.mark.parametrize("key", [imgui.Key.tab, imgui.Key.right_arrow])
def test_keys_lead_to_the_other_answers(window, asked, key):
    press(window, key, imgui.Key.enter)
    assert asked == ["Don't save"]


def test_keys_lead_to_cancel_and_escape_is_cancel(window, asked):
    press(window, imgui.Key.tab, imgui.Key.tab, imgui.Key.enter)
    assert window.session.dialogs.current is None
    window.act(show_dialog, Question(title="Again", text="?", answers=()))
    press(window, imgui.Key.escape)
    assert window.session.dialogs.current is None
    assert asked == []


def test_after_a_question_arrows_nudge_again(window, asked):
    del asked
    press(window, imgui.Key.escape)
    project = window.again(open_bar, 0.5)
    place = complex(*project.layer_runtime.picture.size) / 2
    press(window, imgui.Key.up_arrow)
    window.settle()
    target = project.layer.keys[0].pose.targets[0].position
    assert target == pytest.approx(place + 1j, abs=1e-9)


def count_menus():
    return imgui.get_current_context().open_popup_stack.size()


def test_escape_closes_a_menu_and_the_next_click_counts(window):
    project = window.open(sample_images() / "bar.png")

    def play(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_action(OPEN, "View")
        assert count_menus() == 1
        robot.key_press(int(imgui.Key.escape))
        robot.yield_()
        assert count_menus() == 0
        robot.mouse_move_to_pos(window.point(complex(*project.layer_runtime.picture.size) / 2))
        robot.mouse_click(0)

    window.run(play)
    assert len(project.layer.handles) == 1


def test_escape_closes_a_menu_with_those_that_lead_to_it(window):
    window.open(sample_images() / "bar.png")

    def play(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_action(OPEN, "View/Backdrop")
        assert count_menus() == 2
        robot.key_press(int(imgui.Key.escape))
        robot.yield_()
        assert count_menus() == 0

    window.run(play)


@pytest.mark.usefixtures("loose")
def test_escape_in_a_field_of_a_popup_leaves_the_popup(window):
    def play(robot):
        robot.set_ref("Timeline")
        robot.item_click("**/more")
        robot.set_ref("//$FOCUSED")
        robot.menu_action(OPEN, "###Scale time")
        robot.item_click("//$FOCUSED/###percent")
        assert imgui.get_io().want_text_input
        count = count_menus()
        robot.key_press(int(imgui.Key.escape))
        robot.yield_()
        assert not imgui.get_io().want_text_input
        assert count_menus() == count

    window.run(play)


def test_keys_are_written_as_the_system_writes_them():
    chord = CTRL | SHIFT | int(imgui.Key.s)
    assert format_chord(chord, is_mac=False) == "Ctrl+Shift+S"
    assert format_chord(chord, is_mac=True) == "⇧⌘S"
    assert format_chord(ALT | int(imgui.Key.up_arrow), is_mac=True) == "⌥Up"
    assert format_modified(ALT, "drag", is_mac=False) == "Alt+drag"
    assert format_modified(ALT, "drag", is_mac=True) == "⌥ drag"


def test_keys_have_names_of_the_persons_language(monkeypatch):
    monkeypatch.setattr(shortcut_keys, "_", {"Ctrl": "Strg"}.get)
    assert format_chord.__wrapped__(CTRL | int(imgui.Key.s), is_mac=False) == "Strg+S"
    assert format_modified.__wrapped__(CTRL, "drag", is_mac=False) == "Strg+drag"
    assert parse_chords.__wrapped__("Ctrl+S") == (CTRL | int(imgui.Key.s),)


def test_chords_are_read_as_the_table_has_them():
    key = imgui.Key
    undone_again = (CTRL | SHIFT | int(key.z), CTRL | int(key.y))
    assert parse_chords("Ctrl+Shift+Z, Ctrl+Y") == undone_again
    named = (int(key.page_up), int(key._1), CTRL | int(key.keypad_add), ALT | int(key.f9))
    assert parse_chords("PageUp, 1, Ctrl+KeypadAdd, Alt+F9") == named
    assert parse_chords("") == ()
    with pytest.raises(KeyError):
        parse_chords("Ctrl+Zed")


def test_the_fonts_have_the_signs_of_all_keys(window):
    window.frames()
    font = imgui.get_font()
    signs = {
        sign
        for binding in ACTIONS.values()
        for key in chords_of(binding)
        for sign in format_chord(key)
    }
    for sign in signs | set("⌥⇧⌘σ×−…“”–"):
        assert font.is_glyph_in_font(ord(sign)), sign


@pytest.mark.usefixtures("loose")
def test_menus_are_made_from_the_table(window):
    """Each entry is in its menu."""
    found = []

    def look(robot):
        robot.set_ref("##MainMenuBar")
        for menu, groups in MENUS.items():
            robot.menu_click(menu)
            popup = imgui.get_current_context().open_popup_stack[0].window.name
            for group in groups:
                where = f"//{popup}"
                if group[0] in SUBMENUS:
                    robot.mouse_move(f"//{popup}/{SUBMENUS[group[0]]}")
                    robot.yield_(20)
                    where = "//###Menu_01"
                for spec in group:
                    path = f"{where}/{'###' if spec.detail else ''}{spec.label}"
                    if robot.item_exists(path):
                        found.append(spec.label)
            robot.popup_close_all()

    window.run(look)
    assert found == list(ACTIONS)


def test_greyed_entries_tell_what_is_on_without_a_project(window):
    window.act(viewing.toggle_overlay, "paths")
    checked = {}

    def look(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_click("View")
        for label in ("Motion paths", "Handles", "Outline"):
            checked[label] = robot.item_is_checked(f"//$FOCUSED/{label}")
            assert robot.item_info(f"//$FOCUSED/{label}").item_flags & imgui.ItemFlags_.disabled
        robot.popup_close_all()

    window.run(look)
    assert checked == {"Motion paths": True, "Handles": True, "Outline": False}
    assert not ACTIONS["Loop"].is_active(window.session)


def test_the_layout_can_be_put_back(window):
    window.again(Harness.open, sample_images() / "ring.png")
    panel = imgui.internal.find_window_by_name("###Timeline").dock_node
    before = panel.size.y
    imgui.internal.dock_builder_set_node_size(panel.id_, imgui.ImVec2(panel.size.x, 500))
    window.frames(3)

    def reset(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_click("View/Reset layout")

    window.run(reset)
    window.frames(3)
    after = imgui.internal.find_window_by_name("###Timeline").dock_node.size.y
    assert after == pytest.approx(before, abs=1)


@pytest.mark.parametrize("place", ["welcome", "menu"])
def test_recent_files_that_are_gone_are_marked_and_taken_off_by_a_click(window, tmp_path, place):
    there, gone = tmp_path / "there.png", tmp_path / "gone.png"
    there.write_bytes((sample_images() / "bar.png").read_bytes())
    preferences = window.session.settings.preferences
    for path in (gone, there):
        preferences = preferences.with_recent(path)
    window.session.settings.preferences = preferences
    window.frames(3)

    def open_gone(robot):
        if place == "menu":
            robot.set_ref("##MainMenuBar")
            robot.menu_click("File/Open recent/###recent 1")
        else:
            robot.set_ref("Welcome")
            robot.item_click("**/###recent 1")

    window.run(open_gone)
    window.settle()
    assert window.session.project is None
    assert window.session.settings.preferences.recent == (there,)
    (toast,) = window.session.notices.toasts
    assert toast.text.startswith(f"gone.png is no longer in {tmp_path}.")

    def open_recent(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_click("File/Open recent/###recent 0")

    window.run(open_recent)
    window.settle()
    assert window.session.project.file.name == "there"


@pytest.mark.usefixtures("loose")
def test_no_frame_stays_around_a_button_when_a_question_is_gone(window):
    def press_a_button(robot):
        robot.set_ref("//Measure")
        robot.item_click("**/###key 24")

    window.show_tab("Measure")
    window.run(press_a_button)
    imgui.get_io().add_mouse_pos_event(5.0, 795.0)
    window.settle()
    window.frames(30)
    before = window.picture()
    window.act(show_dialog, Question(title="?", text="?", answers=()))
    window.frames(5)
    press(window, imgui.Key.tab, imgui.Key.escape)
    imgui.get_io().add_mouse_pos_event(5.0, 795.0)
    window.frames(30)
    assert window.picture() == before


@pytest.mark.parametrize("is_mac", [False, True])
def test_no_two_actions_have_the_same_key(is_mac):
    # Esc ends one thing after the other: cutting out, a recording, a guide, then what is
    # selected.
    ended = {"Back to posing", "Discard recording", "End guide"}
    ended |= {"Cancel motion preset", "Cancel rigging"}
    bindings = [binding for name, binding in ACTIONS.items() if name not in ended]
    chords = [int(key) for binding in bindings for key in chords_of(binding, is_mac=is_mac)]
    assert len(set(chords)) == len(chords)


def test_no_action_has_a_key_that_macos_takes():
    """Dear ImGui takes the command key for Ctrl there."""
    key = imgui.Key
    taken = {
        *(CTRL | int(each) for each in (key.m, key.h, key.tab, key.space, key.grave_accent)),
        *(CTRL | int(each) for each in (key.comma, key.f5)),
        *(CTRL | ALT | int(each) for each in (key.m, key.h, key.d, key.w, key.space, key.escape)),
        *(CTRL | SHIFT | int(each) for each in (key.q, key.tab, key.slash, key.grave_accent)),
        *(CTRL | SHIFT | int(each) for each in (key._3, key._4, key._5, key._6)),
        *(CTRL | ALT | SHIFT | int(each) for each in (key.q, key.escape)),
        int(key.f11),
    }
    for name, binding in ACTIONS.items():
        assert taken.isdisjoint(chords_of(binding, is_mac=True)), name
        assert (CTRL | int(key.q) in chords_of(binding, is_mac=True)) == (name == "Quit")


def test_the_mirror_axis_has_another_key_on_macos():
    axis = ACTIONS["Mirror axis"]
    assert [format_chord(chord, is_mac=True) for chord in chords_of(axis, is_mac=True)] == ["⇧⌘M"]
    assert [format_chord(chord, is_mac=False) for chord in chords_of(axis, is_mac=False)] == [
        "Ctrl+M"
    ]


def test_a_tab_that_is_out_of_view_is_found_by_its_name(window):
    window.again(Harness.open, sample_images() / "ring.png")
    window.resize((1280, 800), 2.0)

    def choose(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_click("View/Tabs/###Export")

    window.show_tab("Handle")
    window.run(choose)
    window.frames(3)
    assert is_in_front("Export")
    assert not is_in_front("Handle")
    window.resize((1280, 800))

"""Keys that act by what they type, and keys that the person chooses."""

import pytest
from imgui_bundle import imgui

from app.editor.actions import dialog_actions, viewing
from app.editor.actions.layer_setup import cut_out_editing
from app.storage.preferences import load_preferences, save_preferences
from app.ui.shortcuts.keys import chord_text, chords_of, parse_chords, shown_keys
from app.ui.shortcuts.table import ACTIONS
from app.ui.window.events import keyboard_layout

Key = imgui.Key
CTRL, SHIFT = int(Key.mod_ctrl), int(Key.mod_shift)


@pytest.fixture
def sheet(window, bar):
    """The list of shortcuts, with the person's own keys as before at the end."""
    del bar
    before = window.session.settings.preferences
    window.act(dialog_actions.show_shortcuts)
    window.frames(3)
    yield window
    window.session.settings.prefer(keys=before.keys)
    window.act(dialog_actions.close_dialog)
    window.frames(2)


def press(window, chord):
    window.run(lambda robot: robot.key_press(int(chord)))
    window.frames(2)


def click(window, name):
    window.run(lambda robot: robot.item_click(f"//###dialog/**/{name}"))
    window.frames(2)


def chosen(window):
    return dict(window.session.settings.preferences.keys)


def leave(window):
    press(window, Key.escape)
    assert window.session.dialogs.current is None


def test_an_action_gets_other_keys(sheet):
    click(sheet, "keys of Wireframe")
    press(sheet, CTRL | int(Key.f7))
    assert chosen(sheet) == {"Wireframe": "Ctrl+F7"}
    assert shown_keys(viewing.WIREFRAME) == "Ctrl+F7"
    leave(sheet)
    display = sheet.session.display
    shown = display.overlays
    press(sheet, Key.w)
    assert display.overlays == shown
    press(sheet, CTRL | int(Key.f7))
    assert display.overlays != shown
    press(sheet, CTRL | int(Key.f7))


def test_keys_of_another_action_are_taken_only_when_asked_for(sheet):
    click(sheet, "keys of Wireframe")
    press(sheet, Key.h)
    assert chosen(sheet) == {}
    click(sheet, "Use it for “Wireframe”")
    assert chosen(sheet) == {"Handles": "", "Wireframe": "H"}
    assert not chords_of(viewing.HANDLES)
    click(sheet, "keys of Wireframe")
    click(sheet, "Reset to W")
    assert chosen(sheet) == {"Handles": ""}
    click(sheet, "Reset all keys")
    assert chosen(sheet) == {}
    assert shown_keys(viewing.HANDLES) == "H"


def test_an_action_that_loses_a_key_keeps_its_others(sheet):
    click(sheet, "keys of Wireframe")
    press(sheet, CTRL | int(Key.equal))
    click(sheet, "Use it for “Wireframe”")
    assert chosen(sheet) == {
        "Larger interface": "Ctrl+Shift+Equal, Ctrl+KeypadAdd",
        "Wireframe": "Ctrl+Equal",
    }


def test_escape_ends_the_question_and_then_the_list(sheet):
    click(sheet, "keys of Wireframe")
    press(sheet, Key.escape)
    assert sheet.session.dialogs.current.changed == ""
    assert chosen(sheet) == {}
    leave(sheet)


def test_the_search_finds_actions_without_keys(sheet):
    named = next(label for label, spec in ACTIONS.items() if not shown_keys(spec))
    edit = dialog_actions.edit_shortcut_sheet
    sheet.act(edit, dialog_actions.ShortcutSheet(search=named.upper()))
    sheet.frames(2)
    click(sheet, f"keys of {named}")
    press(sheet, SHIFT | int(Key.f8))
    assert chosen(sheet) == {named: "Shift+F8"}


def test_keys_are_kept_with_the_preferences(sheet, tmp_path):
    sheet.session.settings.prefer(keys={"Undo": "Ctrl+U", "Handles": "", "Gone": "Ctrl+F1"})
    save_preferences(tmp_path, sheet.session.settings.preferences)
    kept = load_preferences(tmp_path)
    assert kept.keys == {"Undo": "Ctrl+U", "Handles": "", "Gone": "Ctrl+F1"}
    (tmp_path / "preferences.json").write_text(
        '{"keys": {"Undo": 5, "Redo": "Ctrl+No", "Loop": "Q"}}'
    )
    sheet.session.settings.prefer(keys=load_preferences(tmp_path).keys)
    sheet.frames(2)
    shown = {name: shown_keys(ACTIONS[name]) for name in ("Undo", "Redo", "Loop")}
    assert shown == {"Undo": "Ctrl+Z", "Redo": "Ctrl+Shift+Z", "Loop": "Q"}


def test_every_chord_is_written_as_it_is_read():
    for spec in ACTIONS.values():
        for chord in chords_of(spec):
            assert parse_chords(chord_text(chord)) == (chord,)


def test_typed_signs_act_as_their_keys(window, bar):
    session = window.session
    window.act(cut_out_editing.toggle_cut_brush)
    window.frames(2)
    radius = cut_out_editing.brush_radius(session.project)
    for sign, is_larger in (("]", True), ("[", False)):
        before = cut_out_editing.brush_radius(session.project)
        imgui.get_io().add_input_character(ord(sign))
        window.frames(2)
        after = cut_out_editing.brush_radius(session.project)
        assert (after > before) == is_larger
        assert after != before
    assert cut_out_editing.brush_radius(session.project) == pytest.approx(radius)
    window.act(cut_out_editing.toggle_cut_brush)
    del bar


def test_plus_enlarges_wherever_its_key_is(window, bar, monkeypatch):
    del bar
    german = {keyboard_layout.glfw.KEY_RIGHT_BRACKET: "+", keyboard_layout.glfw.KEY_SLASH: "-"}
    monkeypatch.setattr(keyboard_layout.glfw, "get_key_name", lambda key, _: german.get(key, "ü"))
    assert keyboard_layout.find_plus_key() == Key.right_bracket
    settings, shell = window.session.settings, window.program.shell
    scale = settings.preferences.scale
    shell.follow_layout(keyboard_layout.find_plus_key)
    press(window, CTRL | int(Key.right_bracket))
    assert settings.preferences.scale > scale
    press(window, CTRL | int(Key.minus))
    assert settings.preferences.scale == pytest.approx(scale)
    shell.follow_layout(lambda: None)

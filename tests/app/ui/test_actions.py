"""Named actions: a disabled one says why, in its tooltip and when its key is pressed."""

import re

import pytest
from imgui_bundle import imgui

from app.document import MARKER, Channel
from app.editor.actions import editing, playback
from app.editor.actions.layer_setup import cut_out_editing, stiffness_editing
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.actions.timing import keys
from app.editor.actions.tracking import recording
from app.editor.poses import copying
from app.editor.tools import move_tool, tool_pointer
from app.editor.tools.tool import PointerHit
from app.ui.shortcuts import widgets
from app.ui.shortcuts.table import ACTIONS, MENUS
from app.ui.style import widgets as style_widgets

SENTENCE = re.compile(r"[A-Z“][^.]*\.( [A-Z“][^.]*\.)*")
WITHOUT_PROJECT = {
    *(
        "Open…",
        "Unsaved work…",
        "Quit",
        "Light or dark",
        "Larger interface",
        "Smaller interface",
        "Reset layout",
        "Manual",
    ),
    *("Keys and mouse", "Your first animation", "Report a problem…"),
}
DISABLED = {  # while two handles of a bar with two keys are selected
    *("Bend layers other way", "Plant layer", "Release layer"),
    *("Paste on this limb", "Paste flipped on limb", "Paste swapped on limb"),
    *(
        "Redo",
        "Bend other way",
        "Copy poses of all layers",
        "Paste",
        "Paste flipped",
        "Paste swapped",
        "Paste on selected handles",
    ),
    *(
        "Paste flipped on selected",
        "Smaller brush",
        "Larger brush",
        "Back to posing",
        "Ungroup",
        "Mirror joints",
    ),
    *(
        "Detect joints",
        "Cancel motion preset",
        "Cancel rigging",
        "Look through the camera",
        "Discard recording",
        "Play all frames",
    ),
    *("Insert key", "Bake repeats", "Stop repeating", "End guide", "Import log", "Collect footage"),
    "Speed graph",
}
HANDLES = {
    *(
        "Deselect",
        "Delete",
        "Pin here",
        "Lock",
        "Key this handle only",
        "Add bone",
        "Group",
        "Mirror",
    ),
    "Select partners",
}
PASTES = {"Paste", "Paste flipped", "Paste on selected handles", "Paste flipped on selected"}
BRUSH = {"Smaller brush", "Larger brush", "Back to posing"}


def drag_handle(session):
    tool_pointer.press_pointer(session, PointerHit(place=0j, handle=1))
    assert session.tools.active_tool is not None


# The actions that a state makes possible, and those that it makes impossible.
STATES = {
    "selected": (lambda _: None, set(), set()),
    "deselected": (editing.deselect_all, set(), HANDLES),
    "playing": (playback.toggle_play, set(), set()),
    "dragging": (drag_handle, set(), {"Add bone", "Group"}),
    "moving": (move_tool.toggle_move_tool, {"Back to posing"}, set()),
    "cutting out": (cut_out_editing.toggle_cut_brush, BRUSH, {"Delete"}),
    "making stiff": (stiffness_editing.MAKE_STIFF.action.apply, BRUSH, set()),
    "drawing bones": (stiffness_editing.DRAW_BONES.action.apply, {"Back to posing"}, set()),
    "setting joints": (
        preset_setup.begin_motion_setup,
        {"Back to posing", "Detect joints"},
        HANDLES,
    ),
    "recording": (recording.toggle_recording_armed, {"Discard recording"}, set()),
    "copied": (copying.copy_pose_or_keys, PASTES, set()),
}


def disabled(session):
    """Return the names of disabled actions, which all have a sentence."""
    reasons = {name: spec.disabled_reason(session) for name, spec in ACTIONS.items()}
    found = {name: reason for name, reason in reasons.items() if reason is not None}
    assert [reason for reason in found.values() if not SENTENCE.fullmatch(reason)] == []
    return found.keys()


def test_actions_give_a_reason_without_a_project(window):
    assert disabled(window.session) == ACTIONS.keys() - WITHOUT_PROJECT


@pytest.mark.parametrize("state", STATES)
def test_actions_give_a_reason_in_each_state(window, loose, state):
    session, (change, possible, impossible) = window.session, STATES[state]
    editing.select_handles(session, frozenset(handle.id for handle in loose.layer.handles))
    window.settle()
    change(session)
    if state == "playing":
        window.frames(2)  # it would play to its end while a slow worker does its jobs
    else:
        window.settle()
    assert disabled(session) == (DISABLED - possible) | impossible


def test_actions_have_names_of_their_own():
    specs = [spec for groups in MENUS.values() for group in groups for spec in group]
    assert len(ACTIONS) == len(specs)


def test_greyed_entries_show_their_reasons(window, loose, monkeypatch):
    shown = []
    monkeypatch.setattr(widgets, "draw_tooltip", lambda text, *_: shown.append(text))
    editing.select_handles(window.session, frozenset())

    def look(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_click("Handles")
        shown.clear()
        robot.yield_()
        robot.popup_close_all()

    window.run(look)
    assert loose is window.session.project
    assert set(shown) >= {
        *("Select a handle first.", "Select several handles first."),
        *("Select two handles first.", "Select a handle of a group first."),
    }


@pytest.mark.usefixtures("loose")
@pytest.mark.parametrize(
    ("key", "reasons"),
    [("p", ["Select a handle first."]), ("k", []), ("escape", [])],
)
def test_keys_of_disabled_actions_show_the_reason(window, key, reasons):
    editing.select_handles(window.session, frozenset())
    window.session.notices.toasts = []
    window.run(lambda robot: robot.key_press(imgui.Key.__members__[key]))
    window.frames(2)
    assert [toast.text for toast in window.session.notices.toasts] == reasons


@pytest.mark.usefixtures("loose")
def test_esc_ends_one_thing_at_a_time(window):
    session = window.session
    editing.select_handles(session, frozenset({1}))
    move_tool.toggle_move_tool(session)
    recorded = []
    for _ in range(3):
        window.run(lambda robot: robot.key_press(imgui.Key.escape))
        window.frames(2)
        recorded.append((session.tools.mode == "move", bool(session.project.selection.handles)))
    assert recorded == [(False, True), (False, False), (False, False)]


@pytest.mark.usefixtures("loose")
def test_an_arrow_nudges_and_does_not_go_to_a_key(window):
    session = window.session
    playback.scrub(session, 6)
    editing.select_handles(session, frozenset({1}))
    window.run(lambda robot: robot.key_press(imgui.Key.up_arrow))
    assert session.project.timeline.playhead.frame == 6
    editing.select_handles(session, frozenset())
    window.run(lambda robot: robot.key_press(imgui.Key.up_arrow))
    window.frames(2)
    assert session.project.timeline.playhead.frame == 24


def test_greyed_buttons_of_panels_show_their_reasons(window, loose, monkeypatch):
    shown = []
    monkeypatch.setattr(style_widgets, "draw_tooltip", lambda text, *_: shown.append(text))
    for tab in ("Layers", "Shape"):
        window.show_tab(tab)
        window.frames(3)
    window.run(lambda robot: robot.item_open("//Shape/**/###more of shape"))
    window.frames(3)
    assert loose is window.session.project
    assert set(shown) >= {
        *("A scene needs at least one layer.", "The layer is already in front of all others."),
        *("There are no strokes.", "Brush over a part or draw a bone first."),
        "Change a setting above first.",
    }


@pytest.mark.usefixtures("loose")
def test_the_row_of_markers_says_how_they_are_added(window):
    session, project = window.session, window.session.project
    keys.add_marker(session, 2)
    project.selection.select_channel(Channel(MARKER))
    before = project.document
    keys.insert_key_in_row_at(session, 6)
    assert project.document is before
    assert session.notices.toasts[-1].text.startswith("Use “Add marker” for markers")

"""The modes of the viewport: what each says under the pointer, and what is kept when it is left."""

import pytest
from imgui_bundle import imgui

from app.editor.actions import editing, playback
from app.editor.actions.layer_setup import cut_out_editing, stiffness_editing
from app.editor.actions.posing.handles import remove_handles
from app.editor.actions.posing.motion_presets import joint_placement, preset_setup
from app.editor.actions.tracking import recording
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.pictures import make_still
from app.editor.tools import move_tool, tool_pointer
from app.editor.tools.tool import PointerHit
from app.ui.panels.motion_preset import tab
from app.ui.viewport.interaction import hints


@pytest.fixture
def hint_at(window):
    """The hint under the pointer at a place of the scene."""

    def ask(place):
        found = []

        def point(robot):
            robot.mouse_move_to_pos(window.point(place))
            robot.yield_(2)
            found.append(window.session.tools.hint)

        window.run(point)
        return found[0]

    return ask


def draft_with_a_joint_moved(window, project):
    preset_setup.begin_motion_setup(window.session)
    window.settle()
    draft = window.session.tools.motion_setup
    name, *_ = draft.joints
    place = complex(*project.document.canvas) / 2
    joint_placement.move_joint(window.session, name, place)
    window.frames(2)
    return name, place


@pytest.mark.parametrize("is_layer", [True, False], ids=["layer", "tool"])
def test_a_left_draft_is_kept_and_the_panel_says_so(window, loose, monkeypatch, is_layer):
    session, first = window.session, loose.selection.active
    duplicate_layer(session, first)
    set_active_layer(session, first)
    window.settle()
    name, place = draft_with_a_joint_moved(window, loose)
    if is_layer:
        set_active_layer(session, loose.document.layers[-1].id)
        window.frames(3)
        assert session.tools.motion_setup is None
        assert preset_setup.kept_motion_setup(session, loose) is None
        set_active_layer(session, first)
    else:
        move_tool.toggle_move_tool(session)
    texts = []
    monkeypatch.setattr(tab, "small_text", lambda _look, text, *_: texts.append(text))
    window.show_tab("Animate")
    window.frames(3)
    assert any(text.endswith("are kept.") for text in texts)
    preset_setup.begin_motion_setup(session)
    assert session.tools.motion_setup.joints[name] == place


def test_hint_names_one_effect_of_a_click_and_of_a_double_click(window, loose, hint_at):
    session, first = window.session, loose.selection.active
    duplicate_layer(session, first)
    set_active_layer(session, first)
    window.settle()
    shown = loose.layer_runtime.shown
    left, right = shown.placement.apply(shown.handle_positions).tolist()
    hint = hint_at(left + 0.25 * (right - left))
    assert hint.startswith("Double-click to pose bar copy, click to add a handle, Ctrl+click")


def test_hint_offers_no_handle_on_a_still_picture(window, loose, hint_at):
    make_still(window.session, loose.selection.active)
    window.settle()
    assert "handle" not in hint_at(complex(*loose.document.canvas) / 2)


def test_hint_promises_no_move_of_a_still_picture(window, loose, hint_at):
    make_still(window.session, loose.selection.active)
    move_tool.toggle_move_tool(window.session)
    window.settle()
    assert "move" not in hint_at(complex(*loose.document.canvas) / 2)
    window.session.notices.toasts = []
    move_tool.nudge_layer(window.session, 1.0)
    (toast,) = window.session.notices.toasts
    assert toast.text.endswith("Make it posable first.")


def test_hint_while_a_drag_is_recorded_names_no_ring(window, loose, hint_at):
    recording.toggle_recording_armed(window.session)
    shown = loose.layer_runtime.shown
    hint = hint_at(complex(shown.placement.apply(shown.handle_positions)[0]))
    assert "drag to record" in hint
    assert "ring" not in hint


def test_hint_of_bones_says_that_handles_are_hidden(window, loose, hint_at):
    stiffness_editing.DRAW_BONES.action.apply(window.session)
    window.session.display.show_overlays(handles=False)
    hint = hint_at(complex(*loose.document.canvas) / 2)
    assert hint == "The handles are hidden: H shows them"


def test_recording_is_armed_from_every_mode(window, loose):
    session = window.session
    for select in (cut_out_editing.toggle_cut_brush, move_tool.toggle_move_tool):
        select(session)
        window.run(lambda robot: robot.key_press(imgui.Key.r))
        assert session.tools.mode == "record"
        recording.discard_recording(session)
    remove_handles(session, frozenset(handle.id for handle in loose.layer.handles))
    window.settle()
    reason = recording.toggle_recording_armed.disabled_reason(session)
    assert reason == "Click on the drawing to add a handle. Then drag it to record."


@pytest.mark.usefixtures("loose")
def test_badge_of_a_mode_is_within_a_narrow_viewport(window, monkeypatch):
    stiffness_editing.DRAW_BONES.action.apply(window.session)
    rooms, widths = [], {}
    pill, size = hints._draw_pill, imgui.calc_text_size

    def measure(text, *more, **options):
        found = size(text, *more, **options)
        widths[text] = found.x
        return found

    def draw(look, text, place, room, *more):
        rooms.append(room)
        return pill(look, text, place, room, *more)

    window.resize((1400, 900), 2.0)
    monkeypatch.setattr(imgui, "calc_text_size", measure)
    monkeypatch.setattr(hints, "_draw_pill", draw)
    window.frames(2)
    monkeypatch.undo()
    window.resize((1280, 800))
    assert widths["Drawing bones from handle to handle: Esc goes back to posing"] < rooms[-1]


def test_a_press_moves_nothing_if_the_layer_is_made_still(window, loose):
    session, place = window.session, complex(*loose.document.canvas) / 2
    move_tool.toggle_move_tool(session)
    tool_pointer.press_pointer(session, PointerHit(place=place))
    gesture = session.tools.active_tool
    make_still(session, loose.selection.active)
    window.settle()
    before = loose.document
    gesture.move(session, place + 30j)
    assert loose.document is before


@pytest.mark.usefixtures("loose")
def test_cutting_out_stops_playback(window):
    session = window.session
    playback.toggle_play(session)
    window.frames(3)
    cut_out_editing.toggle_cut_brush(session)
    assert session.project.timeline.playhead.since is None


def test_keys_change_no_hidden_handle_while_cutting_out(window, loose):
    editing.select_handles(window.session, frozenset({loose.layer.handles[0].id}))
    cut_out_editing.toggle_cut_brush(window.session)
    before = loose.document
    for key in (imgui.Key.left_arrow, imgui.Key.delete):
        window.run(lambda robot, key=key: robot.key_press(key))
        window.settle()
    assert loose.document is before

"""A part of the window that fails takes no other one along."""

from functools import partial

import pytest
from imgui_bundle import imgui, implot

from app.document import layer_commands
from app.editor.actions import dialog_actions, editing, playback
from app.editor.parts.dialogs import Question
from app.ui.viewport import viewport
from app.ui.window import guard
from app.ui.window.guard import FrameStep, format_failure

FRAMES = 30  # half a second


class Broken:
    """Draws something that is left open, and raises; how often it was asked."""

    def __init__(self, leave_open=lambda: None):
        self.leave_open = leave_open
        self.asked = 0

    def __call__(self, *_, **__):
        self.asked += 1
        self.leave_open()
        raise ZeroDivisionError("a bug")


def leave_styles():
    imgui.push_style_color(imgui.Col_.text, (1, 0, 0, 1))
    imgui.push_style_var(imgui.StyleVar_.alpha, 0.5)
    imgui.push_font(None, 30.0)


def leave_ids():
    imgui.push_id("one")
    imgui.begin_group()
    imgui.push_item_width(3.0)
    imgui.begin_disabled()


def leave_windows():
    imgui.begin("another")
    imgui.begin_child("within")
    imgui.push_clip_rect((0, 0), (1, 1), intersect_with_current_clip_rect=True)
    imgui.begin_table("table", 2)
    imgui.table_next_column()


def leave_popup():
    imgui.open_popup("popup")
    imgui.begin_popup("popup")


def leave_modal():
    imgui.open_popup("modal")
    imgui.begin_popup_modal("modal")


def leave_plot():
    assert implot.begin_plot("plot")


LEFT_OPEN = (leave_styles, leave_ids, leave_windows, leave_popup, leave_modal, leave_plot)


@pytest.fixture
def parts(window, capfd):
    """The parts of the window, which work again afterwards, and whose failures were expected."""
    parts = window.program.shell.parts
    before = {name: part.draw for name, part in parts.items()}
    yield parts
    for name, draw in before.items():
        parts[name].draw = draw
        parts[name].try_again()
    window.session.notices.toasts = []
    window.session.dialogs.current = None
    window.frames(3)
    capfd.readouterr()


@pytest.fixture
def reported(monkeypatch):
    """The texts that the window writes, of all frames since it was cleared."""
    texts = []
    write = imgui.text_unformatted

    def written(text):
        texts.append(text)
        write(text)

    monkeypatch.setattr(imgui, "text_unformatted", written)
    return texts


@pytest.mark.usefixtures("bar")
@pytest.mark.parametrize("name", ["The panel Timeline", "The panel Viewport", "The panel Layers"])
def test_failing_panel_shows_a_notice_and_is_asked_once(window, parts, reported, name):
    window.show_tab(name.removeprefix("The panel "))
    parts[name].draw = broken = Broken()
    window.frames(FRAMES)
    assert broken.asked == 1
    assert format_failure(name) in reported
    assert "a bug" in parts[name].failure.trace
    (toast,) = window.session.notices.toasts
    assert toast.text == format_failure(name)
    assert "a bug" in toast.details
    assert all(part.failure is None for other, part in parts.items() if other != name)


@pytest.mark.usefixtures("bar")
@pytest.mark.parametrize("leave_open", LEFT_OPEN)
def test_failing_panels_leave_nothing_open(window, parts, leave_open):
    window.show_tab("Measure")
    alpha, colour = imgui.get_style().alpha, imgui.get_style().color_(imgui.Col_.text)
    for name in ("The panel Timeline", "The panel Viewport", "The panel Measure", "The guide"):
        parts[name].draw = Broken(leave_open)
    window.frames(3)
    for part in parts.values():
        part.try_again()
    window.frames(3)
    assert imgui.get_style().alpha == alpha
    assert imgui.get_style().color_(imgui.Col_.text) == colour
    assert imgui.get_current_context().open_popup_stack.size() == 0
    assert implot.get_current_context().current_plot is None
    failed = {name for name, part in parts.items() if part.failure is not None}
    assert len(failed) == 4


@pytest.mark.usefixtures("bar")
def test_all_parts_can_fail_at_once_and_come_back(window, parts):
    draws = {name: part.draw for name, part in parts.items()}
    for part in parts.values():
        part.draw = Broken()
    window.session.dialogs.current = Question(title="Well", text="Well?", answers=())
    window.frames(FRAMES)
    seen = [part.draw.asked for part in parts.values() if part.failure is not None]
    assert set(seen) == {1}
    assert len(seen) >= 10
    for name, part in parts.items():
        part.draw = draws[name]
    window.act(dialog_actions.close_dialog)
    window.frames(3)
    assert all(part.failure is None for name, part in parts.items() if "The menu " not in name)


def test_failing_panel_is_asked_again_when_its_state_changes(window, parts, bar):
    name = "The panel Timeline"
    draw = parts[name].draw
    changes = (
        partial(editing.edit_document, command=layer_commands.rename_layer(0, "arm")),
        partial(editing.select_handles, handles=frozenset({bar.layer.handles[0].id})),
        partial(playback.scrub, frame=2),
    )
    parts[name].draw = broken = Broken()
    for count, change in enumerate(changes, start=1):
        window.frames(3)
        assert broken.asked == count, change
        change(window.session)
    parts[name].draw = draw
    parts[name].try_again()
    window.frames(2)
    assert parts[name].failure is None


@pytest.mark.usefixtures("bar")
def test_failing_panel_is_left_alone_while_it_plays(window, parts):
    parts["The panel Timeline"].draw = broken = Broken()
    window.act(playback.toggle_play)
    window.frames(FRAMES)
    assert broken.asked == 1
    window.act(playback.toggle_play)
    window.frames(2)
    assert broken.asked == 2


@pytest.mark.usefixtures("bar")
def test_failing_panel_is_asked_again_by_a_button(window, parts, monkeypatch):
    copied = []
    monkeypatch.setattr(imgui, "set_clipboard_text", copied.append)
    name = "The panel Timeline"
    draw, parts[name].draw = parts[name].draw, Broken()
    window.frames(3)
    parts[name].draw = draw

    def press(robot):
        robot.item_click(f"**/{guard.COPY}")
        robot.item_click(f"**/{guard.TRY_AGAIN}")

    window.run(press)
    assert parts[name].failure is None
    assert "a bug" in copied[0]


def test_failing_viewport_still_shows_the_drawing(window, parts, bar):
    before = window.picture()
    parts["The panel Viewport"].draw = Broken()
    window.frames(3)
    after = window.picture()
    at = window.point(bar.layer.domain.outline.mean())
    place = round(at.x), round(at.y)
    assert after.getpixel(place) == before.getpixel(place)


@pytest.mark.usefixtures("bar")
def test_failing_menu_of_a_handle_leaves_nothing_open(window, parts, bar, monkeypatch):
    place = window.point(bar.layer_runtime.shown.handle_positions[0])

    def open_menu(robot):
        robot.mouse_move_to_pos(place)
        robot.mouse_click(1)
        robot.yield_(2)

    window.run(open_menu)
    assert imgui.get_current_context().open_popup_stack.size() == 1
    monkeypatch.setattr(viewport, "format_modified", Broken())
    window.frames(2)
    assert parts["The panel Viewport"].failure
    assert imgui.get_current_context().open_popup_stack.size() == 0


def test_failing_dialog_can_be_closed(window, parts):
    parts["The dialog"].draw = Broken()
    window.session.dialogs.current = Question(title="Well", text="Well?", answers=())
    window.frames(3)
    window.run(lambda robot: robot.item_click(f"**/{guard.CLOSE}"))
    assert window.session.dialogs.current is None


@pytest.mark.usefixtures("bar")
def test_failing_keys_take_nothing_along(window, parts, monkeypatch):
    monkeypatch.setattr("app.ui.window.window_frame.collect_key_actions", Broken())
    window.frames(3)
    assert all(part.failure is None for part in parts.values())


@pytest.mark.usefixtures("bar")
def test_failing_step_rests_until_something_changes(window, monkeypatch):
    broken = Broken()
    monkeypatch.setattr(window.program.shell, "_update_steps", [FrameStep(broken, lambda _: None)])
    window.frames(FRAMES)
    assert broken.asked == 1
    window.clock.now += guard.PAUSE
    window.frames(1)
    assert broken.asked == 2
    window.act(editing.edit_document, layer_commands.rename_layer(0, "arm"))
    window.frames(2)
    assert broken.asked == 3

"""The drawing comes first: few controls, and most of the window for the drawing."""

import pytest
from bars import open_bar
from calm import SIZES, measure_calm
from harness import Harness
from imgui_bundle import ImVec2, hello_imgui, imgui

from app.editor.actions import viewing
from app.editor.actions.dialog_actions import show_notice
from app.storage.assets import sample_images
from app.ui.panel import is_in_front
from app.ui.style.widgets import TOAST

MOST_CONTROLS = 28
# Of the window, by its size: 1280 × 800, 1024 × 700, 1600 × 1000 at 200 %.
LEAST_SHARES = (0.55, 0.50, 0.38)


@pytest.fixture
def drawing(window):
    """A drawing that was just opened, with nothing selected."""
    yield window.again(Harness.open, sample_images() / "ring.png")
    window.resize((1280, 800))


@pytest.mark.parametrize(("size", "least"), [*zip(SIZES, LEAST_SHARES, strict=True)])
@pytest.mark.usefixtures("drawing")
def test_a_drawing_has_most_of_the_window_and_few_controls_beside_it(window, size, least):
    window.show_tab("Handle")
    window.resize(*size)
    window.frames(10)
    calm = measure_calm(window)
    assert calm.count <= MOST_CONTROLS, calm.controls
    assert calm.controls["tabs"] == 5
    assert calm.share >= least


@pytest.mark.usefixtures("drawing")
def test_a_folded_panel_gives_its_room_to_the_drawing_and_comes_back(window):
    window.show_tab("Shape")
    tab = int(imgui.Key.tab)
    window.run(lambda robot: robot.key_press(tab))
    window.frames(6)
    assert measure_calm(window).share >= 0.70
    window.run(lambda robot: robot.key_press(tab))
    window.frames(6)
    assert is_in_front("Shape")
    window.act(viewing.toggle_panel)
    window.act(viewing.show_tab, "Export")
    window.frames(6)
    assert is_in_front("Export"), "whoever shows a tab unfolds the panel"
    assert 0.55 < measure_calm(window).share < 0.70
    window.show_tab("Handle")


def test_the_timeline_grows_with_its_rows_until_a_person_sets_its_height(window):
    def height():
        return imgui.internal.find_window_by_name("###Timeline").dock_node.size.y

    window.again(Harness.open, sample_images() / "ring.png")
    low = height()
    window.open(sample_images() / "friend.lissom")
    window.frames(10)
    assert height() > 1.5 * low
    node = imgui.internal.find_window_by_name("###Timeline").dock_node
    imgui.internal.dock_builder_set_node_size(node.id_, imgui.ImVec2(node.size.x, 170))
    viewing.toggle_theme(window.session)
    window.frames(10)
    window.again(Harness.open, sample_images() / "ring.png")
    window.frames(10)
    window.resize((1280, 800))
    assert height() == pytest.approx(low, abs=1), "the layout was put back"


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.usefixtures("drawing")
def test_all_tabs_keep_their_words_while_measuring(window, size):
    window.resize(*size)
    window.act(viewing.toggle_measuring)
    window.frames(12)
    shown = hello_imgui.get_runner_params().docking_params.dockable_windows
    side = [tab.label for tab in shown if tab.dock_space_name == "side" and tab.is_visible]
    assert len(side) == 6
    assert all(label.split("###")[0] == label.split("###")[1] for label in side), side
    window.act(viewing.toggle_measuring)
    window.frames(6)
    window.show_tab("Handle")


def test_clicks_beside_the_buttons_of_a_message_go_to_the_drawing(window):
    project = window.again(open_bar)
    window.act(show_notice, "A message that lies over the drawing")
    window.frames(3)
    (toast,) = window.session.notices.toasts
    message = imgui.internal.find_window_by_name(f"{TOAST}{toast.place}")
    place, corner = message.pos + message.size * 0.5, message.pos + ImVec2(message.size.x, 0)
    selected = project.selection.handles
    assert selected

    def click(robot):
        robot.mouse_move_to_pos(place)
        robot.mouse_click(0)

    window.run(click)
    assert window.session.notices.toasts == [toast]
    assert not project.selection.handles, "a click beside the shape selects nothing"
    dismiss = corner + ImVec2(-1.2, 1.0) * window.text_height()

    def close(robot):
        robot.mouse_move_to_pos(dismiss)
        robot.yield_(2)
        robot.mouse_click(0)

    window.run(close)
    window.frames(2)
    assert not window.session.notices.toasts


def test_the_number_of_other_messages_lies_below_the_message(window, monkeypatch):
    lines = {}

    def watch(name):
        draw = getattr(imgui, name)

        def see(*arguments):
            draw(*arguments)
            lines[arguments[-1]] = imgui.get_item_rect_min().y, imgui.get_item_rect_max().y

        monkeypatch.setattr(imgui, name, see)

    watch("text_unformatted")
    watch("text_colored")
    long = "A message that is so long that it takes several lines below each other in its window."
    window.session.notices.show("The first message.")
    window.session.notices.show(long)
    window.frames(3)
    assert lines["1 more message"][0] >= lines[long][1]

import pytest
from imgui_bundle import ImVec2, imgui

from app.editor.actions import viewing
from app.storage.assets import sample_images
from app.ui.style.widgets import shortened


def test_welcome_offers_the_samples(window):
    window.frames(8)

    def play(robot):
        robot.set_ref("Welcome")
        assert robot.item_exists("**/sample Giraffe")

    window.run(play)


def test_theme_and_scale_change_at_once(window):
    before = window.picture()
    viewing.toggle_theme(window.session)
    window.frames(2)
    assert window.picture() != before
    text_size = window.text_height()
    viewing.scale_up(window.session)
    window.frames(2)
    assert window.text_height() > text_size


def test_changing_the_theme_changes_no_size(window):
    height = window.status_height()
    for _ in range(4):
        viewing.scale_up(window.session)
        window.frames(2)
        viewing.scale_down(window.session)
        viewing.toggle_theme(window.session)
        window.frames(2)
    assert window.status_height() == height


def test_f1_opens_the_sheet_of_keys(window):
    window.run(lambda robot: robot.key_press(int(window.Key.f1)))
    assert window.session.dialog is not None
    window.run(lambda robot: robot.key_press(int(window.Key.escape)))
    assert window.session.dialog is None


def test_scale_takes_docked_panels_along(window):
    window.open(sample_images() / "ring.png")
    tabs, timeline = _docked("Handle").size.x, _docked("Timeline").size.y
    viewing.scale_up(window.session)
    window.frames(3)
    scale = window.session.preferences.scale
    assert _docked("Timeline").size.y == pytest.approx(scale * timeline, abs=1)
    assert _docked("Handle").size.x == pytest.approx(scale * tabs, abs=1)
    viewing.scale_down(window.session)
    window.frames(3)
    assert _docked("Timeline").size.y == pytest.approx(timeline, abs=1)


def test_docked_panels_keep_the_size_that_a_person_gave_them(window):
    window.open(sample_images() / "ring.png")
    node = _docked("Timeline")
    imgui.internal.dock_builder_set_node_size(node.id_, ImVec2(node.size.x, 500))
    window.frames(3)
    assert _docked("Timeline").size.y == pytest.approx(500, abs=1)
    viewing.scale_up(window.session)
    window.frames(3)
    assert _docked("Timeline").size.y == pytest.approx(500, abs=1)
    viewing.scale_down(window.session)
    window.frames(3)
    assert _docked("Timeline").size.y == pytest.approx(500, abs=1)
    window.resize((1280, 800))


def test_docked_panels_leave_room_in_a_small_window(window):
    window.open(sample_images() / "ring.png")
    window.resize((900, 640), 2.0)
    assert _docked("Timeline").size.y <= 320
    assert _docked("Handle").size.x <= 432
    window.resize((1280, 800))


@pytest.mark.parametrize(
    ("size", "scale", "words"),
    [
        ((1280, 800), 1.0, "Handle"),
        ((2560, 1440), 2.0, "Handle"),
        ((1280, 800), 2.0, ""),
        ((900, 640), 2.0, ""),
    ],
)
def test_all_tabs_fit(window, size, scale, words):
    window.open(sample_images() / "ring.png")
    window.resize(size, scale)
    window.frames(3)
    bar = _docked("Handle").tab_bar
    assert len(bar.tabs) == 5
    assert bar.width_all_tabs_ideal <= bar.bar_rect.get_width()
    assert words in imgui.internal.find_window_by_name("###Handle").name.split("###")[0]
    window.resize((1280, 800))


def test_themes_change_nothing_else_at_a_larger_scale(window):
    window.resize((1280, 800), 2.0)
    viewing.show_shortcuts(window.session)
    window.frames(30)
    before = window.picture()
    for _ in range(4):
        viewing.toggle_theme(window.session)
        window.frames(2)
    assert window.picture() == before
    viewing.close_dialog(window.session)
    window.resize((1280, 800))


def _docked(title):
    return imgui.internal.find_window_by_name(f"###{title}").dock_node


def test_long_texts_are_shortened_to_their_room(window):
    window.frames(1)
    assert shortened("a name", 500.0) == "a name"
    text = shortened("a name that is much too long for its place " * 5, 100.0)
    assert text.endswith("…")
    assert 80.0 < imgui.calc_text_size(text).x <= 100.0

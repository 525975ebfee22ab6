import numpy as np
import pytest
from harness import Harness
from imgui_bundle import ImVec2, hello_imgui, imgui
from PIL import Image

from app.editor.actions import dialog_actions, editing, playback, viewing
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.project_files import saving
from app.editor.work.jobs import Job, JobKind
from app.storage.assets import sample_images
from app.ui.style.theme import PALETTES
from app.ui.style.widgets import shorten_text
from app.ui.window import desktop
from app.ui.window.desktop import window_title


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
    viewing.enlarge_interface(window.session)
    window.frames(2)
    assert window.text_height() > text_size


def test_language_is_chosen_for_the_next_start(window):
    def choose(name):
        def play(robot):
            robot.set_ref("##MainMenuBar")
            robot.menu_click(f"View/Language/{name}")

        window.run(play)
        return window.session.settings.preferences.language

    assert choose("Deutsch") == "de"
    assert "when Lissom starts again" in window.session.notices.toasts[-1].text
    assert [choose(name) for name in ("English", "As the system")] == ["en", ""]


def test_changing_the_theme_changes_no_size(window):
    height = window.status_height()
    for _ in range(4):
        viewing.enlarge_interface(window.session)
        window.frames(2)
        viewing.shrink_interface(window.session)
        viewing.toggle_theme(window.session)
        window.frames(2)
    assert window.status_height() == height


def test_shift_and_f1_open_the_sheet_of_keys(window):
    keys = int(window.Key.mod_shift | window.Key.f1)
    window.run(lambda robot: robot.key_press(keys))
    assert window.session.dialogs.current is not None
    window.run(lambda robot: robot.key_press(int(window.Key.escape)))
    assert window.session.dialogs.current is None


def test_scale_takes_docked_panels_along(window):
    window.again(Harness.open, sample_images() / "ring.png")
    tabs, timeline = _docked("Handle").size.x, _docked("Timeline").size.y
    viewing.enlarge_interface(window.session)
    window.frames(3)
    scale = window.session.settings.preferences.scale
    assert _docked("Timeline").size.y == pytest.approx(scale * timeline, abs=1)
    assert tabs < _docked("Handle").size.x < scale * tabs, "the drawing keeps most of the room"
    viewing.shrink_interface(window.session)
    window.frames(3)
    assert _docked("Timeline").size.y == pytest.approx(timeline, abs=1)


def test_docked_panels_keep_the_size_that_a_person_gave_them(window):
    window.again(Harness.open, sample_images() / "ring.png")
    node = _docked("Timeline")
    imgui.internal.dock_builder_set_node_size(node.id_, ImVec2(node.size.x, 500))
    window.frames(3)
    assert _docked("Timeline").size.y == pytest.approx(500, abs=1)
    viewing.enlarge_interface(window.session)
    window.frames(3)
    assert _docked("Timeline").size.y == pytest.approx(500, abs=1)
    viewing.shrink_interface(window.session)
    window.frames(3)
    assert _docked("Timeline").size.y == pytest.approx(500, abs=1)
    window.resize((1280, 800))


def test_docked_panels_leave_room_in_a_small_window(window):
    window.again(Harness.open, sample_images() / "ring.png")
    window.resize((900, 640), 2.0)
    assert _docked("Timeline").size.y <= 320
    assert _docked("Handle").size.x <= 468
    window.resize((1280, 800))


@pytest.mark.parametrize(
    ("size", "scale"),
    [
        ((1280, 800), 1.0),
        ((2560, 1440), 2.0),
        ((1280, 800), 1.5),
    ],
)
def test_all_tabs_fit_and_the_one_in_front_has_its_title(window, size, scale):
    window.again(Harness.open, sample_images() / "ring.png")
    window.resize(size, scale)
    for title in ("Handle", "Shape"):
        window.show_tab(title)
        bar = _docked(title).tab_bar
        assert len(bar.tabs) == 5
        assert bar.width_all_tabs_ideal <= bar.bar_rect.get_width()
        name = imgui.internal.find_window_by_name(f"###{title}").name.split("###")[0]
        assert name == title
    window.resize((1280, 800))


def test_tabs_have_their_names_as_far_as_there_is_room(window):
    window.again(Harness.open, sample_images() / "ring.png")
    window.show_tab("Export")
    named = []
    for width in (180, 200, 220, 240, 260, 300):
        node = _docked("Handle")
        imgui.internal.dock_builder_set_node_size(node.id_, ImVec2(width, node.size.y))
        window.frames(4)
        bar = _docked("Handle").tab_bar
        assert bar.width_all_tabs_ideal <= bar.bar_rect.get_width()
        titles = [tab.window.name.split("###") for tab in bar.tabs]
        named.append(sum(shown.endswith(title) for shown, title in titles))
    assert named[0] < 3
    assert named[-1] == len(bar.tabs)
    assert sorted(named) == named
    assert len(set(named)) > 3
    window.resize((1280, 800))


def test_themes_change_nothing_else_at_a_larger_scale(window):
    window.resize((1280, 800), 2.0)
    dialog_actions.show_shortcuts(window.session)
    window.frames(30)
    before = window.picture()
    for _ in range(4):
        viewing.toggle_theme(window.session)
        window.frames(2)
    assert window.picture() == before
    dialog_actions.close_dialog(window.session)
    window.resize((1280, 800))


@pytest.fixture
def fine_screen(window):
    """Gives the screen a scale of its own: a desktop's, or a density as on macOS."""

    def set_up(*, dpi=1.0, density=1.0):
        imgui.get_style().font_scale_dpi = dpi
        window.resize((int(1280 * dpi * density), int(800 * dpi * density)), density=density)
        window.settle()

    yield set_up
    set_up()


@pytest.mark.parametrize("scale", [{"dpi": 2.0}, {"density": 2.0}])
def test_a_finer_screen_shows_the_same_with_more_pixels(window, fine_screen, bar, scale):
    """Panels take the same part of the window, and handles the same part of the picture."""
    del bar
    editing.select_handles(window.session, frozenset())
    # Away from the handles, which look otherwise below the pointer.
    window.run(lambda robot: robot.mouse_move_to_pos(ImVec2(2, 2)))
    window.frames(3)
    width = _docked("Handle").size.x / imgui.get_io().display_size.x
    coarse = window.picture()
    fine_screen(**scale)
    assert _docked("Handle").size.x / imgui.get_io().display_size.x == pytest.approx(
        width, rel=0.02
    )
    fine = window.picture()
    assert fine.size == (2560, 1600)
    marks = [_blue(picture) for picture in (coarse, fine)]
    assert marks[0] > 100
    assert marks[1] == pytest.approx(4 * marks[0], rel=0.15)


def _blue(picture):
    """Return how many pixels of the viewport have the colour of a handle."""
    pixels = np.asarray(picture.crop((0, 0, picture.width * 2 // 3, picture.height * 2 // 3)))
    red, green, blue = (pixels[..., channel].astype(int) for channel in range(3))
    return int(((blue > 200) & (red < 80) & (green < 140)).sum())


def test_a_gesture_is_as_far_on_a_finer_screen(window, fine_screen, bar):
    fine_screen(density=2.0)
    start = complex(bar.layer_runtime.shown.handle_positions[1])

    def drag(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(start + 100j))
        robot.mouse_up(0)

    window.run(drag)
    window.settle()
    target = bar.document.layers[0].keys[0].pose.targets[1]
    assert abs(target.position - (start + 100j)) < 2


@pytest.fixture
def refreshes(monkeypatch):
    """How often the window asked for its next frame at once."""
    asked = []
    monkeypatch.setattr(hello_imgui, "request_refresh", lambda: asked.append(True))
    return asked


def test_nothing_is_drawn_anew_where_nothing_changes(window, refreshes, tmp_path):
    project = window.open(sample_images() / "bar.png")
    saving.write_project(window.session, tmp_path / "bar.lissom", None)
    window.settle()
    window.session.notices.toasts = []
    window.frames(60)
    refreshes.clear()
    window.frames(60)
    assert refreshes == []
    playback.toggle_play(window.session)
    window.frames(10)
    assert len(refreshes) == 10
    playback.toggle_play(window.session)
    window.frames(60)
    refreshes.clear()
    window.frames(10)
    assert refreshes == []
    assert project.timeline.playhead.since is None


def test_what_a_job_leads_to_is_drawn_at_once(window, refreshes):
    window.open(sample_images() / "bar.png")
    window.frames(120)
    done = []
    job = Job(kind=JobKind("A job"), work=lambda: 0, done=done.append, failed=done.append)
    window.session.jobs.put(job)
    window.session.jobs.wait_until_idle()
    window.frames(1)
    assert done == [0]
    refreshes.clear()
    window.frames(3)
    assert len(refreshes) == 3


def test_a_tooltip_covers_no_message(window, bar):
    del bar
    for number in range(3):
        window.session.notices.show(f"Message {number}", tone="error")

    places = []

    def find(robot):
        robot.set_ref("Timeline")
        places.append(robot.item_info("**/Play").rect_full.get_center())

    window.run(find)
    imgui.get_io().add_mouse_pos_event(places[0].x, places[0].y)
    window.frames(60)
    windows = [other for other in imgui.get_current_context().windows if other.active]
    toasts = [other.rect() for other in windows if other.name.startswith("##toast")]
    (tooltip,) = (other.rect() for other in windows if other.name.startswith("##Tooltip"))
    assert len(toasts) == 1, "one at a time"
    assert not any(toast.overlaps(tooltip) for toast in toasts)


def test_the_title_names_the_file_and_marks_changes(window, tmp_path):
    session = window.session
    assert window_title(session) == "Lissom"
    window.open(sample_images() / "bar.png")
    assert window_title(session) == "bar – Lissom"
    add_handle(session, complex(*session.project.layer_runtime.picture.size) / 2)
    assert window_title(session) == "bar* – Lissom"
    saving.write_project(session, tmp_path / "posed.lissom", None)
    window.settle()
    assert window_title(session) == "posed.lissom – Lissom"


@pytest.mark.parametrize("platform", ["PLATFORM_X11", "PLATFORM_WIN32", "PLATFORM_WAYLAND"])
def test_the_window_has_an_icon_where_windows_bring_one(monkeypatch, platform):
    glfw, shown = desktop.glfw, []
    monkeypatch.setattr(glfw, "get_platform", lambda: getattr(glfw, platform))
    monkeypatch.setattr(glfw, "set_window_icon", lambda *icon: shown.append(icon))
    monkeypatch.setattr(desktop.glfw_utils, "glfw_window_hello_imgui", lambda: "the window")
    desktop.show_icon()
    if platform == "PLATFORM_WAYLAND":
        assert shown == []
        return
    ((where, count, icons),) = shown
    assert (where, count) == ("the window", 3)
    for width, height, pixels in icons:
        assert np.shape(pixels) == (height, width, 4)
        assert pixels[0][0][3] == 0
        assert pixels[height // 2][width // 2][3] == 255


@pytest.mark.parametrize(
    ("theme", "level", "stands_out"),
    [("dark", 20, 60), ("dark", 160, None), ("light", 245, -120), ("light", 20, None)],
)
def test_a_drawing_stands_out_from_the_backdrop(window, tmp_path, theme, level, stands_out):
    """A drawing with a dark edge lies on grey in the dark theme, as one with a light edge in light.

    What is within the edge does not count.
    """
    drawing = np.full((200, 200, 4), level, np.uint8)
    drawing[60:140, 60:140, :3] = 255 - level
    drawing[..., 3] = 0
    drawing[50:150, 50:150, 3] = 255
    Image.fromarray(drawing).save(tmp_path / "plain.png")
    if theme != "dark":
        viewing.toggle_theme(window.session)
    project = window.open(tmp_path / "plain.png")
    window.frames(3)
    picture = window.picture()

    def seen(place):
        point = window.point(place)
        return picture.convert("L").getpixel((int(point.x), int(point.y)))

    assert seen(55 + 100j) == pytest.approx(level, abs=3)
    paper = seen(10 + 100j)
    if stands_out is None:
        assert paper == pytest.approx(_level(theme), abs=16)
    else:
        assert (paper - level) * np.sign(stands_out) > abs(stands_out)
    viewing.set_backdrop(window.session, "#808080")
    window.frames(3)
    picture = window.picture()
    assert seen(10 + 100j) == 128
    assert project.layer_runtime.picture.size == (200, 200)


def _level(theme):
    paper = PALETTES[theme].paper
    return 255 * (paper.x + paper.y + paper.z) / 3


def _docked(title):
    return imgui.internal.find_window_by_name(f"###{title}").dock_node


def test_long_texts_are_shortened_to_their_room(window):
    window.frames(1)
    assert shorten_text("a name", 500.0) == "a name"
    text = shorten_text("a name that is much too long for its place " * 5, 100.0)
    assert text.endswith("…")
    assert 80.0 < imgui.calc_text_size(text).x <= 100.0

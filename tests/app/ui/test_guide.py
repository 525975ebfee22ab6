"""A first animation in five steps: the real gestures lead on, and anything else is allowed."""

import numpy as np
import pytest
from imgui_bundle import ImVec2
from newcomer import Newcomer
from PIL import Image

from app.document import PRESETS, scene_commands, shape_commands
from app.document.keyframe import Target
from app.document.settings import ExportSettings
from app.editor.actions import dialog_actions, editing, playback, tutorials, viewing
from app.editor.actions.layer_setup import stiffness_editing
from app.editor.actions.posing.handles import add_handle, remove_handles
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.actions.project_files import exporting, saving
from app.editor.actions.timing import keys
from app.storage.assets import sample_images
from app.ui.window.tutorial.card import NAME
from app.ui.window.tutorial.layout import Rect, find_free_corner


class Pupil(Newcomer):
    """Whoever does what the card says, and nothing else."""

    @property
    def step(self):
        """The step that the card tells; empty where there is none."""
        guide = self.window.session.tutorial.state
        return "" if guide is None else guide.stage

    def wait(self):
        """Wait for a few pictures, and not for all that is measured of the drawing."""
        self.window.frames(5)

    def reach(self, step):
        """Wait until the card tells a step."""
        self.window.until(lambda: self.step == step)

    def tap(self, place):
        """Click on a place of the drawing."""

        def act(robot):
            robot.mouse_move_to_pos(self.window.point(place))
            robot.mouse_click(0)

        self.window.run(act)
        self.wait()

    def play(self):
        """Let it play, and stop it."""
        self.click("//Timeline/**/Play")
        self.window.frames(5)
        self.click("//Timeline/**/Play")

    def export(self, folder):
        """Export what the tab Export has, to where the dialog proposes it in a folder."""
        session = self.window.session
        session.settings.preferences = type(session.settings.preferences)(folder=folder)
        self.click("//Export/**/###start")
        self.click("//###dialog/Export")
        self.window.until(lambda: not exporting.is_export_under_way(session))
        self.window.frames(2)


@pytest.fixture
def pupil(window):
    return Pupil(window)


@pytest.fixture
def led(window, pupil):
    """Somebody who is led through an animation of the bar, at the first step."""
    window.frames(10)
    pupil.click("//Welcome/**/…or with your own drawing")
    dialog = window.session.dialogs.current
    window.act(dialog_actions.choose_file, dialog, sample_images() / "bar.png")
    window.settle()
    window.frames(2)
    assert pupil.step == "time", "handles are suggested"
    return pupil


def places_of_bar(window):
    width, height = window.session.project.document.canvas
    return complex(0.1 * width, height / 2), complex(0.9 * width, height / 2)


@pytest.mark.parametrize("seed", range(20))
def test_a_card_covers_nothing_that_it_points_at(seed):
    random = np.random.default_rng(seed)
    window = Rect(ImVec2(0, 25), ImVec2(*random.uniform((800, 600), (1600, 1000))))
    viewport = Rect(ImVec2(40, 25), ImVec2(0.6 * window.high.x, 0.65 * window.high.y))
    room = viewport if seed % 2 else window
    low = ImVec2(*random.uniform((room.low.x, room.low.y), (room.high.x - 40, room.high.y - 40)))
    box, size = Rect(low, low + ImVec2(40, 40)), ImVec2(*random.uniform((200, 80), (320, 140)))
    drawing = random.uniform(40, 500, 400) + 1j * random.uniform(25, 500, 400)
    corner = find_free_corner(size, [box], [viewport, window], drawing, 24.0)
    card = Rect(corner, corner + size)
    assert not card.meets(box)
    assert window.low.x <= card.low.x <= card.high.x <= window.high.x
    assert window.low.y <= card.low.y <= card.high.y <= window.high.y


def words(window):
    """What the card tells."""
    return window.program.shell.callout.shown_text


def test_the_giraffe_bows(window):
    window.frames(10)
    before = (sample_images() / tutorials.SAMPLE).read_bytes()
    pupil = Pupil(window)
    pupil.click("//Welcome/**/make it bow")
    pupil.reach("handle")
    session, project = window.session, window.session.project
    assert project.file.path is None
    assert [len(project.layer.keys), len(project.layer.handles)] == [1, 7]
    export = project.document.export
    assert (export.format, export.size) == (tutorials.FORMAT, tutorials.SIZE)
    window.frames(3)
    aim, goal = session.tutorial.state.handle_place, session.tutorial.state.target_place
    pupil.tap(aim)
    assert pupil.step == "time"
    pupil.drag_playhead(0.5)
    assert pupil.step == "pose"
    pupil.drag(aim, goal)
    pupil.reach("play")
    window.until(lambda: abs(complex(project.layer_runtime.shown.handle_positions[-1]) - goal) < 20)
    pupil.play()
    assert pupil.step == "export"
    assert (sample_images() / tutorials.SAMPLE).read_bytes() == before


def test_own_drawing_is_a_gif_after_few_clicks_and_two_drags(window, led, tmp_path):
    project = window.session.project
    assert project.document.loop
    assert project.document.export.format == tutorials.FORMAT
    assert project.layer.keys[0].easing == PRESETS["in-out"]
    # Neither is needed, but with them in-betweens and the export take less.
    window.act(editing.edit_layer, shape_commands.set_variant, "nu")
    window.act(keys.set_last_frame, 12)
    led.drag_playhead(0.5)
    led.reach("pose")
    start = max(project.layer_runtime.shown.handle_positions.tolist(), key=lambda at: at.real)
    led.drag(start, start + 100j)
    led.reach("play")
    led.click("//Timeline/**/Play")
    led.reach("export")
    assert project.timeline.playhead.since is not None
    led.show_tab("Export")
    window.act(
        editing.edit_document,
        scene_commands.set_export(ExportSettings(format=tutorials.FORMAT, size=(120, 40))),
    )
    window.frames(2)
    assert "Click Export" in words(window)
    led.export(tmp_path)
    assert project.timeline.playhead.since is None, "an export is not slower for being watched"
    led.reach("done")
    with Image.open(tmp_path / "bar.gif") as gif:
        assert gif.n_frames >= project.document.frames.last
    # The dialog that opens the drawing takes two more clicks.
    assert led.presses + 2 <= 8 + 2
    led.click(f"//{NAME}###guide/###leave")
    assert led.step == ""


def test_whoever_does_something_else_first_is_led_from_there(window, led):
    session = window.session
    first, second = places_of_bar(window)
    handles = {handle.id for handle in session.project.layer.handles}
    window.act(remove_handles, frozenset(handles))
    assert led.step == "handle"
    window.act(playback.toggle_play)
    assert led.step == "handle"
    window.act(stiffness_editing.toggle_stiffness_tool, "stiff")
    window.frames(2)
    assert "goes back" in words(window)
    window.run(lambda robot: robot.key_press(window.Key.escape))
    window.frames(2)
    assert session.tools.mode == "pose"
    assert "Click on a part" in words(window)
    window.act(playback.scrub, 20)
    assert led.step == "handle", "no handle is there yet"
    window.act(add_handle, first)
    window.act(add_handle, second)
    led.reach("pose")  # the playhead was moved before
    window.act(keys.insert_key_in_row)
    window.until(lambda: len(session.project.layer.keys) == 2)
    window.frames(2)
    assert led.step == "pose", "two keys with one pose do not move"
    window.act(playback.scrub, 0)
    assert led.step == "time"
    window.act(playback.scrub, 30)
    window.act(viewing.toggle_auto_key)
    set_targets(session, {1: Target(position=second + 100j)})
    window.settle()
    assert led.step == "pose", "no key has the pose"
    window.act(keys.insert_key_in_row)
    led.reach("play")
    window.act(editing.undo)
    led.reach("pose")
    window.act(editing.redo)
    led.reach("play")
    window.act(playback.toggle_play)
    window.frames(3)
    assert led.step == "export"
    window.act(saving.discard_project)
    assert led.step == "", "it was about that drawing"


@pytest.mark.usefixtures("led")
def test_a_guide_can_be_left_at_any_time(window):
    session = window.session

    def press(robot):
        robot.key_press(window.Key.escape)

    for place in places_of_bar(window):
        window.act(add_handle, place)
    window.settle()
    guide, selected = session.tutorial.state, session.project.selection.handles
    assert selected
    for step in tutorials.STEPS:
        session.tutorial.state = type(guide)(
            project=guide.project, handles=guide.handles, stage=step
        )
        # The hand is at something, so that the step stays.
        window.run(press)
        window.frames(2)
        assert session.tutorial.state is None, step
        assert session.project.selection.handles == selected, "only the guide is left"
    window.run(press)
    assert not session.project.selection.handles
    session.tutorial.state = guide
    window.frames(3)
    window.run(lambda robot: robot.item_click(f"//{NAME}###guide/###leave"))
    assert session.tutorial.state is None


def test_a_drawing_that_is_not_chosen_is_not_waited_for(window, pupil):
    window.frames(3)
    pupil.click("//Welcome/**/…or with your own drawing")
    window.run(lambda robot: robot.key_press(window.Key.escape))
    window.frames(2)
    assert window.session.dialogs.current is None
    assert pupil.step == ""
    window.open(sample_images() / "bar.png")
    assert pupil.step == ""


def test_samples_have_stories_and_move_under_the_pointer(window):
    for sample in tutorials.sample_files():
        assert sample.story, f"{sample.name} has no story"
        assert sample.moving.exists() == (sample.what == "animated"), sample.name
    window.frames(20)
    thumbnails = window.program.thumbnails
    assert not thumbnails.animated_files, "nothing moves before it is pointed at"

    def point(robot):
        # The way there may cross other samples.
        robot.mouse_move("//Welcome/**/sample Ring")
        for _ in range(3):
            robot.yield_()

    window.run(point)
    assert "ring" in {path.stem for path in thumbnails.animated_files}

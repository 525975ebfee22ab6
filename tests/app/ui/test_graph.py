"""The graph of channels over time, as a person changes its points and tangents with the hand."""

from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, disc_document
from imgui_bundle import ImVec2
from numpy.testing import assert_allclose
from projects import project_of

from app.document import (
    CAMERA,
    OPACITY,
    TRANSFORM,
    Camera,
    Channel,
    Keyframe,
    TangentMode,
    Transform,
    curves_of,
    find_velocity,
    frames_in,
    keys_in,
    pose_channel,
)
from app.document.settings import FrameRange
from app.editor import CurvePoint
from app.editor.actions import editing, playback
from app.editor.actions.timing import graph

MOVED, FADED, SHOTS, POSES = (
    Channel(TRANSFORM, 0),
    Channel(OPACITY, 0),
    Channel(CAMERA),
    pose_channel(0),
)
FRAMES = (0, 10, 24, 40)


def document():
    """A disc that moves by four keys, fades by three, is posed at three, and a camera."""
    scene = disc_document()
    (layer,) = scene.layers
    pose = layer.keys[0].pose
    values = (Transform(), Transform(60 + 20j, 0.4, 1.4), Transform(-30 - 25j), Transform())
    channels = {
        MOVED.id: tuple(map(TRANSFORM.key, FRAMES, values)),
        FADED.id: tuple(map(OPACITY.key, (0, 12, 30), (1.0, 0.3, 1.0))),
    }
    poses = tuple(Keyframe(frame=frame, pose=pose) for frame in (0, 20, 40))
    layer = replace(layer, keys=poses, channels=channels)
    camera = (CAMERA.key(6, Camera(CENTRE)), CAMERA.key(30, Camera(CENTRE, 2.0, 0.5)))
    return replace(scene.with_layer(layer), frames=FrameRange(0, 48), camera=camera)


def show(window):
    window.session.project = project_of(document(), np.full((200, 200, 4), 160, np.uint8), "disc")
    window.settle()


@pytest.fixture
def project(window):
    project = window.again(show)
    project.graph.open((MOVED,))
    project.selection.select_channel(MOVED)
    window.frames(8)
    yield project
    window.resize((1280, 800))


class Hand:
    """The robot's pointer on points of curves; its places are pixels from them."""

    def __init__(self, robot, project):
        self.robot, self.project = robot, project
        robot.set_ref("###Timeline")

    def curve(self, channel, label):
        curves = curves_of(self.project.document, channel)
        return next(each for each in curves if each.label == label)

    def name(self, channel, label, what):
        curve = self.curve(channel, label)
        parts = (channel.kind.name, channel.layer, channel.part, curve.field.name, curve.part)
        return f"**/{' '.join(map(str, parts))}/{what}"

    def centre(self, channel, label, what):
        return self.robot.item_info(self.name(channel, label, what)).rect_full.get_center()

    def step(self):
        """Pixels per frame."""
        first, last = (self.centre(MOVED, "X", f"point {each}") for each in (0, 40))
        return (last.x - first.x) / 40

    def go(self, place):
        self.robot.mouse_move_to_pos(place)
        self.robot.yield_(2)

    def drag(self, channel, label, what, by, *, keys=(), during=None):
        start = self.centre(channel, label, what)
        self.go(start)
        for key in keys:
            self.robot.key_down(int(key))
        self.robot.mouse_down(0)
        for share in (0.5, 1.0):
            self.go(ImVec2(start.x + share * by[0], start.y + share * by[1]))
        if during is not None:
            during(self)
        self.robot.mouse_up(0)
        for key in keys:
            self.robot.key_up(int(key))
        self.robot.yield_(2)

    def press(self, *keys):
        chord = 0
        for key in keys:
            chord |= int(key)
        self.robot.key_press(chord)
        self.robot.yield_(2)


@pytest.fixture
def play(window, project):
    """Let the robot play with the graph."""

    def play(what):
        window.run(lambda robot: what(Hand(robot, project)))
        window.settle()
        return project.document

    return play


def numbers(document, channel, label):
    """The numbers of a curve by frame."""
    (curve,) = (each for each in curves_of(document, channel) if each.label == label)
    return {key.frame: curve.number_at_key(document, key) for key in keys_in(document, channel)}


def test_a_key_opens_the_graph_and_closes_it(window, project):
    project.graph.close()
    window.frames(2)

    def press(robot):
        robot.set_ref("###Timeline")
        robot.key_press(int(window.Key.e))
        robot.yield_(4)

    window.run(press)
    assert project.graph.is_open
    assert graph.graphed_channels(project) == [MOVED]
    window.run(press)
    assert not project.graph.is_open


def test_a_point_is_dragged_in_time_and_value(window, project, play):
    before = project.document
    after = play(lambda hand: hand.drag(MOVED, "X", "point 10", (2 * hand.step(), -12)))
    assert frames_in(after, MOVED) == {0, 12, 24, 40}
    assert numbers(after, MOVED, "X")[12] > 62
    for label in ("Y", "Turn", "Scale"):
        assert_allclose(numbers(after, MOVED, label)[12], numbers(before, MOVED, label)[10])
    assert project.selection.keys == {MOVED: {12}}
    assert project.history.undo_label == "Move keys"
    window.act(editing.undo)
    assert project.document is before


def test_escape_gives_the_dragged_point_back(window, project, play):
    before = project.document

    def give_up(hand):
        hand.drag(
            MOVED, "X", "point 10", (30, -20), during=lambda hand: hand.press(window.Key.escape)
        )

    play(give_up)
    assert project.document is before
    assert project.selection.keys == {MOVED: {10}}


@pytest.mark.parametrize(("by", "moves"), [((30, -4), "time"), ((4, -20), "value")])
def test_shift_keeps_a_drag_on_one_axis(window, project, play, by, moves):
    before = project.document
    shift = window.Key.left_shift
    after = play(lambda hand: hand.drag(MOVED, "X", "point 10", by, keys=(shift,)))
    frame = max(each for each in frames_in(after, MOVED) if each < 24)
    assert (frame != 10) == (moves == "time")
    is_same = np.isclose(numbers(after, MOVED, "X")[frame], numbers(before, MOVED, "X")[10])
    assert is_same == (moves == "time")


def test_a_copy_is_dragged_off(window, project, play):
    before = project.document
    ctrl = window.Key.left_ctrl
    after = play(lambda hand: hand.drag(MOVED, "X", "point 10", (40, -10), keys=(ctrl,)))
    assert len(frames_in(after, MOVED)) == 5
    assert numbers(after, MOVED, "X")[10] == numbers(before, MOVED, "X")[10]


def select_box(hand, corners):
    hand.go(corners[0])
    hand.robot.mouse_down(0)
    for share in (0.5, 1.0):
        hand.go(corners[0] + (corners[1] - corners[0]) * share)
    hand.robot.mouse_up(0)
    hand.robot.yield_(2)


def test_a_box_selects_points_of_two_channels_that_move_together(window, project, play):
    project.graph.show_channels((MOVED, FADED))
    window.frames(3)
    before = project.document

    def move(hand):
        plane = hand.robot.item_info("**/plane").rect_full
        low = hand.centre(MOVED, "X", "point 10").x - 20
        high = hand.centre(FADED, "Opacity", "point 12").x + 20
        select_box(hand, (ImVec2(low, plane.min.y + 2), ImVec2(high, plane.max.y - 2)))
        assert project.selection.keys == {MOVED: {10}, FADED: {12}}
        assert len(graph.selected_points(project)) == 5
        hand.drag(FADED, "Opacity", "point 12", (-3 * hand.step(), -10))

    after = play(move)
    assert frames_in(after, MOVED) == {0, 7, 24, 40}
    assert frames_in(after, FADED) == {0, 9, 30}
    for label in ("X", "Y", "Turn", "Scale"):
        assert numbers(after, MOVED, label)[7] > numbers(before, MOVED, label)[10]
    assert numbers(after, FADED, "Opacity")[9] > 31
    window.act(editing.undo)
    assert project.document is before


def select(project, *points):
    curves = {each.label: each for each in curves_of(project.document, MOVED)}
    chosen = frozenset(CurvePoint(curves[label], frame) for label, frame in points)
    return lambda session: graph.select_points(session, chosen)


def test_grips_scale_value_and_time_of_the_selected_points(window, project, play):
    before = project.document
    window.act(select(project, ("X", 10), ("X", 24)))
    window.frames(2)

    def scale(hand, name, by):
        start = hand.robot.item_info(f"**/scale {name}").rect_full.get_center()
        hand.go(start)
        hand.robot.mouse_down(0)
        for share in (0.5, 1.0):
            hand.go(ImVec2(start.x + share * by[0], start.y + share * by[1]))
        hand.robot.mouse_up(0)
        hand.robot.yield_(2)

    after = play(lambda hand: scale(hand, "1 0", (7 * hand.step(), 0)))
    assert frames_in(after, MOVED) == {0, 10, 31, 40}
    assert numbers(after, MOVED, "X")[31] == numbers(before, MOVED, "X")[24]
    window.act(editing.undo)
    assert project.document is before
    window.act(select(project, ("X", 10), ("X", 24)))
    window.frames(2)
    after = play(lambda hand: scale(hand, "0 1", (0, -30)))
    assert frames_in(after, MOVED) == frames_in(before, MOVED)
    x = numbers(after, MOVED, "X")
    assert_allclose(x[10], 60, atol=1e-6)
    assert -28 < x[24] < 50
    assert numbers(after, MOVED, "Y") == numbers(before, MOVED, "Y")
    assert project.history.undo_label == "Scale keys"


def test_a_tangent_is_dragged(window, project, play):
    window.act(select(project, ("X", 10)))
    window.frames(2)
    before = project.document
    after = play(lambda hand: hand.drag(MOVED, "X", "tangent 10 1", (0, -8)))
    (x, y, *_rest) = curves_of(after, MOVED)
    assert find_velocity(after, x, 1) > find_velocity(before, x, 1) + 0.5
    assert_allclose(find_velocity(after, y, 1), find_velocity(before, y, 1))
    assert frames_in(after, MOVED) == frames_in(before, MOVED)
    # With Shift, it is level.
    shift = window.Key.left_shift
    after = play(lambda hand: hand.drag(MOVED, "X", "tangent 10 1", (5, 15), keys=(shift,)))
    assert_allclose(find_velocity(after, x, 1), 0.0, atol=1e-9)
    for _ in range(2):
        window.act(editing.undo)
    assert project.document is before


@pytest.mark.parametrize("is_double", [True, False])
def test_a_click_on_a_curve_adds_a_key_and_delete_deletes_it(window, project, play, is_double):
    def add(hand):
        # Midway, the curve of the opacity is a straight line.
        ends = [hand.centre(FADED, "Opacity", f"point {frame}") for frame in (12, 30)]
        hand.go((ends[0] + ends[1]) / 2)
        if is_double:
            hand.robot.mouse_double_click(0)
        else:
            hand.robot.key_down(int(window.Key.left_ctrl))
            hand.robot.mouse_click(0)
            hand.robot.key_up(int(window.Key.left_ctrl))
        hand.robot.yield_(4)

    project.graph.show_channels((FADED,))
    project.selection.select_channel(FADED)
    window.frames(3)
    before = project.document
    after = play(add)
    assert frames_in(after, FADED) == {0, 12, 21, 30}
    assert_allclose(numbers(after, FADED, "Opacity")[21], 65.0)

    def delete(hand):
        hand.robot.item_click(hand.name(FADED, "Opacity", "point 21"))
        hand.press(window.Key.delete)

    after = play(delete)
    assert keys_in(after, FADED) == keys_in(before, FADED)
    # Without a selected point, the channel stays.
    assert play(lambda hand: hand.press(window.Key.delete)) is after


def test_points_are_copied_and_pasted(window, play):
    def copy(hand):
        hand.robot.item_click(hand.name(MOVED, "X", "point 10"))
        hand.press(window.Key.mod_ctrl, window.Key.c)

    before = play(copy)
    playback.scrub(window.session, 30)
    after = play(lambda hand: hand.press(window.Key.mod_ctrl, window.Key.v))
    assert frames_in(after, MOVED) == {*FRAMES, 30}
    assert keys_in(after, MOVED)[3].value == keys_in(before, MOVED)[1].value


def test_speed_is_dragged(window, project, play):
    graph.toggle_speed(window.session)
    window.frames(3)
    before = project.document
    after = play(lambda hand: hand.drag(MOVED, "X", "point 24", (0, -20)))
    (x, *_rest) = curves_of(after, MOVED)
    assert find_velocity(after, x, 2) > find_velocity(before, x, 2) + 0.5
    assert numbers(after, MOVED, "X") == numbers(before, MOVED, "X")
    assert project.history.undo_label == "Set velocity"


def test_poses_move_in_time_only_and_their_tangents_are_the_easing(window, project, play):
    project.graph.show_channels((POSES, MOVED))
    window.frames(3)
    before = project.document
    after = play(lambda hand: hand.drag(POSES, "Pose number", "point 20", (4 * hand.step(), -30)))
    assert frames_in(after, POSES) == {0, 24, 40}
    assert [key.pose for key in keys_in(after, POSES)] == [
        key.pose for key in keys_in(before, POSES)
    ]
    after = play(lambda hand: hand.drag(POSES, "Pose number", "tangent 24 1", (20, 12)))
    x, y = keys_in(after, POSES)[1].easing.curve[:2]
    assert x > 1 / 3 > y


def test_numbers_are_zoomed_and_fitted(window, project, play):
    window.act(select(project, ("X", 10), ("X", 24)))
    window.frames(2)

    def zoom(hand):
        hand.go(hand.centre(MOVED, "X", "point 10"))
        hand.robot.key_down(int(window.Key.left_shift))
        hand.robot.mouse_wheel_y(3.0)
        hand.robot.key_up(int(window.Key.left_shift))
        hand.robot.yield_(2)

    play(zoom)
    low, high = project.graph.ranges["px"]
    assert high - low < 100

    def fit(hand):
        hand.robot.item_click(hand.name(MOVED, "X", "point 10"))
        hand.press(window.Key.f)
        hand.robot.yield_(3)

    play(fit)
    low, high = project.graph.ranges["px"]
    assert low < 60 < high
    assert project.timeline.time_range is not None
    play(lambda hand: hand.press(window.Key.mod_ctrl, window.Key.home))
    assert project.graph.ranges is None
    assert project.timeline.time_range is None


def test_the_list_shows_channels_and_hides_curves(window, project, play):
    def choose(hand):
        ctrl = int(window.Key.left_ctrl)
        hand.robot.key_down(ctrl)
        hand.robot.item_click("**/###camera None None")
        hand.robot.key_up(ctrl)
        hand.robot.item_click("**/###camera None None zoom 0")

    play(choose)
    assert graph.graphed_channels(project) == [MOVED, SHOTS]
    shown = [each.label for each in graph.shown_curves(project) if each.channel == SHOTS]
    assert shown == ["X", "Y", "Turn"]
    play(lambda hand: hand.robot.item_click("**/###pose 0 None"))
    assert graph.graphed_channels(project) == [POSES]


@pytest.mark.parametrize(("size", "scale"), [((1024, 700), 1.0), ((1600, 1000), 2.0)])
def test_graph_fits_a_small_window(window, play, size, scale):
    window.resize(size, scale)
    window.frames(6)

    def look(hand):
        plane = hand.robot.item_info("**/plane").rect_full
        em = window.text_height()
        assert plane.max.y - plane.min.y > 5 * em
        for label in ("X", "Y", "Turn", "Scale"):
            for frame in FRAMES:
                place = hand.centre(MOVED, label, f"point {frame}")
                assert plane.min.y < place.y < plane.max.y

    play(look)


def test_a_chosen_tangent_mode_ends_a_velocity(window, project, play):
    window.act(select(project, ("X", 10)))
    window.frames(2)
    play(lambda hand: hand.drag(MOVED, "X", "tangent 10 1", (0, -25)))
    assert keys_in(project.document, MOVED)[1].velocities
    play(lambda hand: hand.press(window.Key.t))
    key = keys_in(project.document, MOVED)[1]
    assert not key.velocities
    assert key.tangent_mode is TangentMode.CORNER

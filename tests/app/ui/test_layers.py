"""A scene of several layers in the window: chosen, ordered, hidden, joined and painted in front."""

import numpy as np
import pytest
from harness import Harness
from imgui_bundle import ImVec2
from layered import blob, openraster
from PIL import Image, ImageDraw

from app.cut_out import Stroke
from app.document import (
    DRAW_ORDER,
    OPACITY,
    PRESETS,
    TRANSFORM,
    VISIBILITY,
    Attachment,
    Channel,
    DrawOrder,
    TangentMode,
    Transform,
    channel_commands,
    clip_of,
    cycle_commands,
    key_commands,
    layer_commands,
    pose_channel,
    shape_commands,
)
from app.document.keyframe import Target
from app.editor import do
from app.editor.actions import dialog_actions, editing, playback
from app.editor.actions.dialog_actions import close_dialog
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.actions.project_files import saving
from app.editor.actions.project_files.files import ONE_PICTURE
from app.editor.actions.timing import keys, timeline_drag
from app.editor.layering.deletion import delete_layers
from app.editor.layering.layer_list import (
    duplicate_layer,
    layer_at,
    rename_layer,
    toggle_layers_hidden,
    toggle_visibility_key,
)
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import attach_layer, detach_layer
from app.editor.layering.pictures import (
    add_layers,
    drop_files,
    make_posable,
    make_still,
    replace_picture,
)
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.poses import pasting
from app.errors import EMPTY_IMPORT_LOG
from app.motion import ParentTransforms
from app.storage import load_project, save_project
from app.ui.panel import is_in_front
from app.ui.shortcuts.table import ACTIONS
from app.ui.window import memory

WIDTH, HEIGHT = 240, 200


def painted(box, colour):
    image = Image.new("RGBA", (WIDTH, HEIGHT))
    ImageDraw.Draw(image).rounded_rectangle(box, 12, fill=colour)
    return image


@pytest.fixture(scope="module")
def drawing(tmp_path_factory):
    path = tmp_path_factory.mktemp("layers") / "man.ora"
    names = ("arm", "body", "wall")
    stack = "".join(f'<layer name="{n}" src="data/{i}.png"/>' for i, n in enumerate(names))
    pictures = [
        painted((85, 70, 200, 95), (200, 40, 40, 255)),
        painted((60, 25, 110, 180), (40, 40, 200, 255)),
        Image.new("RGBA", (WIDTH, HEIGHT), (220, 230, 220, 255)),
    ]
    path.write_bytes(openraster((WIDTH, HEIGHT), stack, pictures))
    return path


@pytest.fixture
def scene(window, drawing):
    project = window.again(Harness.open, drawing)
    window.show_tab("Layers")
    return project


def test_layers_are_offered_as_one_picture(window, scene):
    (offer,) = (toast for toast in window.session.notices.toasts if toast.label == ONE_PICTURE)
    window.act(offer.action.apply)
    window.settle()
    merged = window.session.project
    (layer,) = merged.document.layers
    assert layer.picture.size == (WIDTH, HEIGHT)
    assert merged.document.canvas == scene.document.canvas


def identity(project, name):
    return next(layer.id for layer in project.document.layers if layer.name == name)


def test_a_click_chooses_the_layer_that_is_seen(window, scene):
    assert scene.layer.name == "arm"

    def click(place, key=None, *, double=False):
        def run(robot):
            robot.mouse_move_to_pos(
                window.point(scene.layer_runtime.shown.placement.apply_inverse(place))
            )
            if key is not None:
                robot.key_down(int(key))
            if double:
                robot.mouse_double_click(0)
            else:
                robot.mouse_click(0)
            if key is not None:
                robot.key_up(int(key))

        window.run(run)
        window.settle()

    click(80 + 60j)
    assert scene.layer.name == "body"
    assert not scene.layer.handles
    # The arm lies over the body here: a click stays on the body.
    click(100 + 118j)
    assert scene.layer.name == "body"
    assert len(scene.layer.handles) == 1
    editing.undo(window.session)
    window.settle()
    document = scene.document
    click(100 + 118j, double=True)
    assert scene.layer.name == "arm"
    assert scene.document is document, "the handle of the first click is gone"
    click(100 + 118j, window.Key.mod_alt)
    assert scene.layer.name == "body"
    # On the layer that is chosen a click adds a handle.
    click(80 + 60j)
    assert len(scene.layer.handles) == 1


def test_the_list_of_layers(window, scene):
    arm, body = identity(scene, "arm"), identity(scene, "body")

    def names():
        return [layer.name for layer in scene.document.layers]

    def click(*items):
        for item in items:
            in_list = item.split()[0] in {"row", "eye", "lock"}
            path = f"**/###{item}" if in_list else f"###{item}"
            window.run(lambda robot, path=path: (robot.set_ref("Layers"), robot.item_click(path)))
            window.frames(3)

    click(f"row {body}")
    assert scene.selection.active == body
    click("raise")
    assert names() == ["wall", "arm", "body"]
    click("lower", "copy layer")
    assert names() == ["wall", "body", "body copy", "arm"]
    assert scene.layer.name == "body copy"
    click("delete layer")
    assert names() == ["wall", "body", "arm"]
    click(f"eye {arm}", f"lock {body}")
    assert scene.document.layer(arm).hidden
    assert scene.document.layer(body).locked
    # What is hidden or locked is passed through.
    assert layer_at(scene, 100 + 118j) is None
    for _ in range(6):
        window.act(editing.undo)
    window.settle()
    assert names() == ["wall", "body", "arm"]
    assert not scene.document.layer(arm).hidden


class LayerList:
    """The robot's pointer on the list of layers."""

    def __init__(self, robot):
        self.robot = robot
        robot.set_ref("Layers")

    def row(self, identity):
        return self.robot.item_info(f"**/###row {identity}").rect_full

    def click(self, identity, button=0):
        self.robot.item_click(f"**/###row {identity}", button)

    def menu(self, identity, item):
        self.click(identity, 1)
        self.robot.item_click(f"//$FOCUSED/{item}")

    def drag(self, identity, to, share):
        """Drag a row to a share of another one's height, from its top on."""
        self.robot.mouse_move(f"**/###row {identity}")
        self.robot.mouse_down(0)
        target = self.row(to)
        x, height = target.get_center().x, target.max.y - target.min.y
        for y in (target.get_center().y, target.min.y + share * height):
            self.robot.mouse_move_to_pos(ImVec2(x, y))
            self.robot.yield_(2)
        self.robot.mouse_up(0)
        self.robot.yield_(2)


@pytest.fixture
def listed(window, scene):
    assert window.session.project is scene

    def play(what):
        window.run(lambda robot: what(LayerList(robot)))
        window.frames(3)

    return play


def test_a_row_is_dragged_between_two_others(window, scene, listed):
    wall, body, arm = (layer.id for layer in scene.document.layers)

    def order():
        return [layer.id for layer in scene.document.layers]

    listed(lambda rows: rows.drag(arm, body, 0.8))
    assert order() == [wall, arm, body]
    listed(lambda rows: rows.drag(wall, body, 0.2))
    assert order() == [arm, body, wall]
    listed(lambda rows: rows.drag(wall, body, 0.2))
    assert order() == [arm, body, wall]
    assert scene.history.undo_label == "Move layer"

    def give_up(rows):
        rows.robot.mouse_move(f"**/###row {wall}")
        rows.robot.mouse_down(0)
        rows.robot.mouse_move_to_pos(rows.row(arm).get_center())
        rows.robot.yield_(2)
        rows.robot.key_press(int(window.Key.escape))
        rows.robot.mouse_up(0)

    listed(give_up)
    assert order() == [arm, body, wall]
    window.act(editing.undo)
    window.act(editing.undo)
    assert order() == [wall, body, arm]


def test_a_layer_is_named_by_a_double_click_by_f2_and_from_its_menu(window, scene, listed):
    arm, body = identity(scene, "arm"), identity(scene, "body")

    def enter(rows, text, key=window.Key.enter):
        rows.robot.yield_(3)
        rows.robot.key_chars(text)
        rows.robot.key_press(int(key))

    def twice(rows):
        rows.robot.item_double_click(f"**/###row {body}")
        enter(rows, "trunk")

    listed(twice)
    assert scene.layer.name == "trunk"

    def by_key(rows):
        rows.robot.key_press(int(window.Key.f2))
        enter(rows, "torso")

    # From another tab, too.
    window.show_tab("Export")
    listed(by_key)
    assert scene.document.layer(body).name == "torso"
    window.act(set_active_layer, arm)
    window.show_tab("Layers")

    def by_menu(rows):
        rows.menu(body, "Rename…")
        # A name that is taken is not accepted; Esc leaves it as it was.
        enter(rows, "arm")
        rows.robot.key_press(int(window.Key.escape))

    listed(by_menu)
    assert scene.document.layer(body).name == "torso"
    assert scene.selection.active == arm
    assert window.session.project.layer_list.named_layer is None
    for _ in range(2):
        window.act(editing.undo)
    assert scene.document.layer(body).name == "body"


def test_the_menu_of_a_layer(window, scene, listed):
    arm, body = identity(scene, "arm"), identity(scene, "body")
    before = scene.document
    for item in ("Hide", "Lock", "Reference only", "Duplicate"):
        listed(lambda rows, item=item: rows.menu(body, item))
    layer = scene.document.layer(body)
    assert (layer.hidden, layer.locked, layer.reference) == (True, True, True)
    assert [each.name for each in scene.document.layers] == ["wall", "body", "body copy", "arm"]
    for item in ("Show", "Unlock", "Include in exports"):
        listed(lambda rows, item=item: rows.menu(body, item))
    layer = scene.document.layer(body)
    assert (layer.hidden, layer.locked, layer.reference) == (False, False, False)
    listed(lambda rows: rows.menu(arm, "Replace picture…"))
    assert window.session.dialogs.current.title == "Replace the picture of arm"
    window.act(close_dialog)
    # Undo attaches the children of a deleted layer to it again.
    joint = Attachment(parent=body, parent_point=95 + 118j)
    window.act(editing.edit_document, layer_commands.attach_layer(arm, 95 + 118j, joint))
    window.act(set_active_layer, body)
    joined = scene.document
    listed(lambda rows: rows.menu(body, "Delete"))
    window.settle()
    assert scene.document.layer(arm).attachments == ()
    assert scene.layer.name == "wall"
    window.act(editing.undo)
    assert scene.document is joined
    for _ in range(8):
        window.act(editing.undo)
    assert scene.document is before


def test_a_layer_is_seen_at_once_where_its_in_betweens_are_not_there_yet(window, keyed):
    arm = identity(keyed, "arm")
    window.act(playback.seek, 6)
    window.settle()
    window.session.notices.toasts = []
    window.act(duplicate_layer, arm)
    assert not window.session.notices.toasts
    assert keyed.layer_runtime.shown is not None
    assert keyed.layer.name == "arm copy"
    window.act(delete_layers, keyed.selection.active)
    window.act(editing.undo)
    assert all(runtime.shown is not None for runtime in keyed.runtimes.layers.values())


def test_the_list_shows_small_pictures(window, scene, listed):
    window.settle()
    arm = identity(scene, "arm")
    found = []
    listed(lambda rows: found.append(rows.row(arm)))
    low, high = found[0].min, found[0].max

    def red():
        part = np.asarray(window.picture()).astype(int)
        part = part[int(low.y) : int(high.y), int(low.x) : int(high.x)]
        return np.count_nonzero((part[..., 0] > 160) & (part[..., 1] < 80) & (part[..., 2] < 80))

    shown = red()
    assert shown > 100
    window.act(toggle_layers_hidden, arm)
    assert red() < shown / 4
    small = scene.runtimes.layers[arm].small.value
    assert max(small.shape[:2]) == 96
    # Made once, whatever else is done with the layer.
    window.act(editing.edit_document, layer_commands.set_opacity(arm, 0.5))
    window.settle()
    assert scene.runtimes.layers[arm].small.value is small


def enter(robot):
    robot.yield_()  # until the window knows that it has the keys
    robot.key_press(int(Harness.Key.enter))


def test_pictures_that_are_dropped_on_a_scene(window, scene, listed, tmp_path, drawing):
    body = identity(scene, "body")
    before = scene.document
    hat = saved(tmp_path / "hat.png", blob(90, 60, (250, 220, 0)))
    cap = saved(tmp_path / "cap.png", blob(80, 50))
    window.act(drop_files, [hat])
    question = window.session.dialogs.current
    assert [text for text, _ in question.answers] == ["New layer", "Replace arm", "New scene"]
    # Enter takes the first one.
    window.frames(3)
    window.run(enter)
    window.settle()
    assert scene.layer.name == "hat"
    assert scene.document.layers[-1] is scene.layer
    # On the row of a layer, that one is meant.

    def over(rows):
        rows.robot.mouse_move(f"**/###row {body}")
        window.session.dialogs.current = None
        window.program.queue_action(do(drop_files, [cap]))
        rows.robot.yield_(3)

    listed(over)
    texts = [text for text, _ in window.session.dialogs.current.answers]
    assert texts == ["Replace body", "New layer", "New scene"]
    window.run(enter)
    window.settle()
    assert scene.history.undo_label == "Replace picture"
    assert scene.document.layer(body).picture.size == (80, 50)
    for _ in range(2):
        window.act(editing.undo)
    assert scene.document is before
    # Several at once, and a drawing on layers, are one step.
    window.act(drop_files, [hat, cap, drawing])
    texts = [text for text, _ in window.session.dialogs.current.answers]
    assert texts == ["New layers", "New scene"]
    window.run(enter)
    window.settle()
    names = [layer.name for layer in scene.document.layers]
    assert names == ["wall", "body", "arm", "hat", "cap", "wall 2", "body 2", "arm 2"]
    window.act(editing.undo)
    assert scene.document is before
    window.session.notices.toasts = []


def test_attached_layer_follows_live_and_poses_around_its_joint(window, scene):
    arm, body = identity(scene, "arm"), identity(scene, "body")
    window.act(editing.edit_layer, shape_commands.set_anchor, 95 + 118j)
    window.act(attach_layer, arm, body)
    window.settle()
    window.act(set_active_layer, body)
    for place in (85 + 40j, 85 + 160j):
        window.act(add_handle, place)
        window.settle()
    window.act(playback.seek, 24)
    top = scene.layer.handles[1].id
    window.act(set_targets, {top: Target(position=110 + 155j)})
    window.settle()
    child, parent = scene.runtimes.layers[arm].shown, scene.runtimes.layers[body].shown
    joint = scene.document.layer(arm).attachments[0]
    at = parent.pivot_frame_at(joint.parent_point)
    place = child.placement.apply(np.array([child.pivot_frame_at(95 + 118j).position]))[0]
    assert abs(place - at.position) < 1e-6 * WIDTH
    assert abs(child.placement.factor - at.rotation) < 0.02
    assert child.placement.factor.imag < -0.05
    window.act(set_active_layer, arm)
    window.act(add_handle, 190 + 118j)
    window.settle()
    hand = scene.layer.handles[0].id
    window.act(set_targets, {hand: Target(position=170 + 170j)})
    window.settle()
    after = scene.runtimes.layers[arm].shown
    held = after.placement.apply(np.array([after.pivot_frame_at(95 + 118j).position]))[0]
    assert abs(held - at.position) < 1e-3 * WIDTH
    before = after.placement.apply(after.positions)
    window.act(detach_layer, arm)
    window.settle()
    loose = scene.runtimes.layers[arm].shown
    assert np.abs(loose.placement.apply(loose.positions) - before).max() < 1e-3


def test_a_layer_stands_still_and_is_posed_again(window, scene):
    arm = identity(scene, "arm")
    window.act(make_still, arm)
    window.settle()
    assert scene.document.layer(arm).still
    assert len(scene.document.layer(arm).domain.mesh.triangles) == 2
    window.run(lambda robot: robot.item_click("Layers/Make posable"))
    window.settle()
    assert not scene.document.layer(arm).still
    assert scene.layer.name == "arm"
    for _ in range(2):
        window.act(editing.undo)
    window.settle()
    assert not scene.document.layer(arm).still


def test_still_layer_keeps_parent_moves_and_fades(window, scene):
    arm, body = identity(scene, "arm"), identity(scene, "body")
    window.act(attach_layer, arm, body)
    window.settle()
    commands = (
        channel_commands.set_key(Channel(OPACITY, arm), 12, 0.5),
        channel_commands.set_key(Channel(TRANSFORM, body), 0, Transform(0j, 0.0)),
        channel_commands.set_key(Channel(TRANSFORM, body), 12, Transform(8 + 5j, 0.0)),
        channel_commands.set_key(Channel(DRAW_ORDER, arm), 6, DrawOrder(body, in_front=False)),
        cycle_commands.set_cycle(arm, 0, 24),
    )
    for command in commands:
        window.act(editing.edit_document, command)
    window.settle()
    before = scene.document.layer(arm)
    there = ParentTransforms(scene.document).placement(arm, 12)

    def as_layer():
        now = scene.document.layer(arm)
        assert abs(ParentTransforms(scene.document).placement(arm, 12).shift - there.shift) < 1e-6
        names = (
            "attachments",
            "channels",
            "cycles",
            "group",
            "blend",
            "hidden",
            "corner",
        )
        for name in names:
            assert getattr(now, name) == getattr(before, name)
        return now

    window.act(make_still, arm)
    window.settle()
    assert as_layer().still
    window.act(make_posable, arm)
    window.settle()
    assert not as_layer().still


def test_layers_take_turns(window, scene):
    arm = identity(scene, "arm")
    window.act(playback.seek, 12)
    window.settle()
    window.act(toggle_visibility_key, arm)
    window.settle()
    with_arm = np.asarray(window.picture()).astype(int)
    window.act(playback.seek, 11)
    window.settle()
    assert np.abs(np.asarray(window.picture()).astype(int) - with_arm).max() > 100
    assert [s.value for s in scene.document.layer(arm).keys_of(VISIBILITY)] == [True, False]


def test_depth_is_set_at_a_handle_and_shown_as_a_tint(window, scene):
    window.act(add_handle, 190 + 118j)
    window.settle()
    window.show_tab("Handle")
    tinted = []

    def point(robot):
        for item in ("##depth", "##name"):
            robot.mouse_move(f"Handle/{item}")
            robot.yield_(3)
            tinted.append(window.session.display.tint == "depth")

    window.run(point)
    assert tinted == [True, False]
    window.run(lambda robot: robot.item_input_value("Handle/##depth", 0.5))
    window.settle()
    assert scene.layer.handles[0].depth == 0.5


ARM, BODY = (0, 12, 24), (0, 18)


@pytest.fixture
def keyed(scene):
    """The scene with some keys: of the arm, which is the active layer, and of the body."""
    for name, frames in (("arm", ARM), ("body", BODY)):
        layer = scene.document.layer(identity(scene, name))
        for frame in frames[1:]:
            pose = layer.keys[0].pose
            scene.history.do(key_commands.insert_key(layer.id, frame, pose), gesture=None)
    return scene


def frames_of(project, name):
    return tuple(key.frame for key in project.document.layer(identity(project, name)).keys)


class Rows:
    """The robot's pointer on the rows of the timeline."""

    def __init__(self, robot, project):
        self.robot = robot
        self._project = project
        robot.set_ref("###Timeline")
        arm = identity(project, "arm")
        begin, end = self.place("arm", f"key {ARM[0]}"), self.place("arm", f"key {ARM[-1]}")
        assert project.selection.active == arm
        self._origin, self._step = begin.x, (end.x - begin.x) / ARM[-1]

    def name(self, layer, item):
        return f"**/row {identity(self._project, layer)}/{item}"

    def place(self, layer, item):
        return self.robot.item_info(self.name(layer, item)).rect_full.get_center()

    def go_to(self, frame, y):
        self.robot.mouse_move_to_pos(ImVec2(self._origin + frame * self._step, y))

    def click(self, layer, item, button=0):
        self.robot.item_click(self.name(layer, item), button)

    def drag(self, layer, item, frame):
        y = self.place(layer, item).y
        self.robot.mouse_move(self.name(layer, item))
        self.robot.mouse_down(0)
        self.go_to(frame - 1, y)
        self.go_to(frame, y)
        self.robot.mouse_up(0)

    def box(self, start, end):
        """Span a box between two places, each a frame and a row's middle."""
        self.go_to(*start)
        self.robot.mouse_down(0)
        self.go_to(end[0] - 1, end[1])
        self.go_to(*end)
        self.robot.mouse_up(0)


@pytest.fixture
def play(window, keyed):
    def play(what):
        window.run(lambda robot: what(Rows(robot, keyed)))
        window.frames(3)

    return play


def test_a_key_of_another_row_chooses_its_layer(window, keyed, play):
    arm, body = identity(keyed, "arm"), identity(keyed, "body")
    play(lambda rows: rows.click("body", "key 18"))
    assert keyed.selection.active == body
    assert keyed.selection.keys == {pose_channel(body): {18}}
    assert playback.current_frame(window.session, keyed) == 18
    window.run(lambda robot: robot.item_click(f"###Timeline/**/name {arm}"))
    assert keyed.selection.active == arm
    assert not keyed.selection.keys
    # So does what is between the keys of a row.
    play(lambda rows: (rows.go_to(22, rows.place("body", "key 18").y), rows.robot.mouse_click(0)))
    assert keyed.selection.active == body


def test_keys_of_several_rows_are_chosen_by_a_box_and_move_together(window, keyed, play):
    arm, body = identity(keyed, "arm"), identity(keyed, "body")
    before = keyed.document

    def box(rows):
        top, bottom = rows.place("arm", "key 12").y, rows.place("body", "key 18").y
        rows.box((8, top), (21, bottom))

    play(box)
    assert keyed.selection.active == arm
    assert keyed.selection.keys == {pose_channel(arm): {12}, pose_channel(body): {18}}
    # Taken by the one of the row that was not active.
    play(lambda rows: rows.drag("body", "key 18", 22))
    assert (frames_of(keyed, "arm"), frames_of(keyed, "body")) == ((0, 16, 24), (0, 22))
    assert keyed.selection.keys == {pose_channel(arm): {16}, pose_channel(body): {22}}
    assert keyed.selection.active == body
    window.act(editing.undo)
    assert keyed.document is before
    window.act(set_active_layer, arm)
    # One of them waits before a key that is in the way, and so does the other one.
    play(box)
    play(lambda rows: rows.drag("arm", "key 12", 24))
    assert (frames_of(keyed, "arm"), frames_of(keyed, "body")) == ((0, 23, 24), (0, 29))
    window.run(lambda robot: robot.key_press(int(window.Key.delete)))
    assert (frames_of(keyed, "arm"), frames_of(keyed, "body")) == ((0, 24), (0,))
    window.act(editing.undo)
    window.act(editing.undo)
    assert keyed.document is before


def test_a_box_within_a_row_leaves_the_others_and_esc_takes_it_back(window, keyed, play):
    arm, body = identity(keyed, "arm"), identity(keyed, "body")
    play(
        lambda rows: rows.box(
            (8, rows.place("body", "key 18").y), (21, rows.place("body", "key 18").y)
        )
    )
    assert keyed.selection.keys == {pose_channel(body): {18}}
    before = keyed.document

    def give_up(rows):
        rows.robot.mouse_move(rows.name("body", "key 18"))
        rows.robot.mouse_down(0)
        rows.go_to(30, rows.place("body", "key 18").y)
        rows.robot.key_press(int(window.Key.escape))
        rows.robot.mouse_up(0)

    play(give_up)
    assert keyed.document is before
    assert keyed.selection.keys == {pose_channel(body): {18}}
    window.act(
        editing.select_channel_keys,
        {pose_channel(arm): frozenset({12, 77}), pose_channel(body): frozenset({5})},
    )
    assert keyed.selection.keys == {pose_channel(arm): {12}}


def test_where_a_layer_is_hidden_is_marked_on_its_row(window, keyed, play):
    arm, body = identity(keyed, "arm"), identity(keyed, "body")
    window.act(playback.seek, 6)
    window.act(toggle_visibility_key, body)
    window.settle()
    assert [switch.frame for switch in keyed.document.layer(body).keys_of(VISIBILITY)] == [0, 6]
    window.act(playback.seek, 20)
    play(lambda rows: rows.click("body", "keys 6"))
    assert playback.current_frame(window.session, keyed) == 6
    assert keyed.selection.active == body
    window.act(set_active_layer, arm)

    def delete(rows):
        rows.click("body", "keys 6", 1)
        rows.robot.item_click("//$FOCUSED/###Delete")

    play(delete)
    assert [switch.frame for switch in keyed.document.layer(body).keys_of(VISIBILITY)] == [0]


def test_what_is_done_to_a_key_is_done_to_all_chosen_ones_of_other_rows(window, keyed, play):
    arm, body = identity(keyed, "arm"), identity(keyed, "body")
    before = keyed.document
    chosen = {pose_channel(arm): frozenset({12, 24}), pose_channel(body): frozenset({0})}
    window.act(editing.select_channel_keys, chosen)

    def ease(rows):
        rows.click("arm", "key 12", 1)
        rows.robot.set_ref("//$FOCUSED")
        rows.robot.menu_click("Easing/In-out")

    play(ease)
    assert keyed.selection.keys == chosen

    def values_by_layer(what):
        return {
            layer.name: [what(key) for key in layer.keys]
            for layer in keyed.document.layers
            if not layer.still
        }

    eased = values_by_layer(lambda key: key.easing == PRESETS["in-out"])
    assert eased == {"body": [True, False], "arm": [False, True, True]}
    window.act(keys.set_revolutions, keyed.selection.keys_with(pose_channel(body), 0), 2)
    assert values_by_layer(lambda key: key.revolutions) == {"body": [2, 0], "arm": [0, 2, 2]}
    window.act(keys.use_next_tangent_mode)
    passed = values_by_layer(lambda key: key.tangent_mode is TangentMode.CORNER)
    assert passed == {"body": [True, False], "arm": [False, True, True]}
    # One that is not chosen is alone.
    assert keyed.selection.keys_with(pose_channel(body), 18) == {pose_channel(body): {18}}
    for _ in range(3):
        window.act(editing.undo)
    assert keyed.document is before


def test_keys_of_several_rows_run_backwards_and_are_stretched_together(window, keyed):
    arm, body = identity(keyed, "arm"), identity(keyed, "body")
    window.act(
        editing.select_channel_keys,
        {pose_channel(arm): frozenset({0, 24}), pose_channel(body): frozenset({18})},
    )
    window.act(keys.reverse_selected_keys)
    assert (frames_of(keyed, "arm"), frames_of(keyed, "body")) == ((0, 12, 24), (0, 6))
    assert keyed.selection.keys == {pose_channel(arm): {0, 24}, pose_channel(body): {6}}
    window.act(editing.undo)
    window.act(
        editing.select_channel_keys,
        {pose_channel(arm): frozenset({12, 24}), pose_channel(body): frozenset({18})},
    )
    window.act(keys.scale_selected_keys, 0.5)
    assert (frames_of(keyed, "arm"), frames_of(keyed, "body")) == ((0, 12, 18), (0, 15))
    assert keyed.selection.keys == {pose_channel(arm): {12, 18}, pose_channel(body): {15}}


def test_keys_of_several_rows_are_copied_and_pasted_each_on_its_own(window, keyed):
    arm, body = identity(keyed, "arm"), identity(keyed, "body")
    window.act(keys.set_revolutions, {pose_channel(arm): frozenset({12})}, 1)
    before = keyed.document
    window.act(
        editing.select_channel_keys,
        {pose_channel(arm): frozenset({12}), pose_channel(body): frozenset({0, 18})},
    )
    window.run(lambda robot: robot.key_press(int(window.Key.mod_ctrl) | int(window.Key.c)))
    window.act(set_active_layer, identity(keyed, "wall"))
    window.act(playback.seek, 30)
    window.run(lambda robot: robot.key_press(int(window.Key.mod_ctrl) | int(window.Key.v)))
    window.settle()
    assert (frames_of(keyed, "arm"), frames_of(keyed, "body")) == ((0, 12, 24, 42), (0, 18, 30, 48))
    assert keyed.document.layer(arm).key(42).revolutions == 1
    assert keyed.selection.keys == {pose_channel(arm): {42}, pose_channel(body): {30, 48}}
    window.act(editing.undo)
    assert keyed.document is before
    # The rest can be pasted where one of the layers is gone.
    window.act(delete_layers, body)
    window.act(playback.seek, 40)
    window.act(pasting.paste_copied)
    assert frames_of(keyed, "arm") == (0, 12, 24, 40)


def test_where_a_layer_comes_to_be_seen_is_dragged_in_time(window, keyed, play):
    body = identity(keyed, "body")
    for frame, visible in ((6, False), (20, True)):
        window.act(
            editing.edit_document, layer_commands.key_visibility(body, frame, visible=visible)
        )
    before = keyed.document

    def frames():
        return [switch.frame for switch in keyed.document.layer(body).keys_of(VISIBILITY)]

    assert frames() == [0, 6, 20]
    play(lambda rows: rows.drag("body", "keys 6", 11))
    assert frames() == [0, 11, 20]
    assert keyed.document.layer(body).key_frames == {0, 18}
    # It is not put where there is another one, but beyond.
    window.act(set_active_layer, identity(keyed, "arm"))
    play(lambda rows: rows.drag("body", "keys 11", 20))
    assert frames() == [0, 19, 20]
    window.act(set_active_layer, identity(keyed, "arm"))
    play(lambda rows: rows.drag("body", "keys 19", 26))
    assert frames() == [0, 20, 26]
    assert [switch.value for switch in keyed.document.layer(body).keys_of(VISIBILITY)] == [
        True,
        True,
        False,
    ]

    def give_up(rows):
        rows.robot.mouse_move(rows.name("body", "keys 20"))
        rows.robot.mouse_down(0)
        rows.go_to(30, rows.place("body", "keys 20").y)
        assert frames() == [0, 26, 30]
        rows.robot.key_press(int(window.Key.escape))
        rows.robot.mouse_up(0)

    window.act(set_active_layer, identity(keyed, "arm"))
    play(give_up)
    assert frames() == [0, 20, 26]
    for _ in range(3):
        window.act(editing.undo)
    assert keyed.document is before


def test_the_overview_shows_the_keys_of_all_layers(window, keyed):
    window.act(timeline_drag.set_time_range, TimeRangeView(start=-1.0, scale=4.0))
    window.frames(3)
    found = []

    def find(robot):
        robot.set_ref("###Timeline")
        found.append(robot.item_info("**/overview").rect_full)

    window.run(find)
    strip = np.s_[int(found[0].min.y) + 1 : int(found[0].max.y) - 1]
    before = np.asarray(window.picture()).astype(int)[strip]
    layer = keyed.document.layer(identity(keyed, "body"))
    window.act(editing.edit_document, key_commands.insert_key(layer.id, 33, layer.keys[0].pose))
    window.frames(2)
    changed = np.abs(np.asarray(window.picture()).astype(int)[strip] - before).max(axis=(0, 2)) > 20
    # A dot of a few pixels.
    assert 1 <= np.count_nonzero(changed) <= 6


def test_rows_scroll_where_there_are_many(window, keyed):
    for _ in range(8):
        window.act(editing.edit_document, layer_commands.duplicate_layer(identity(keyed, "wall")))
    window.act(set_active_layer, identity(keyed, "arm"))
    window.frames(3)
    assert keyed.timeline.scrolled == 0
    window.act(set_active_layer, identity(keyed, "wall"))
    window.frames(3)
    low = keyed.timeline.scrolled
    assert low > 0

    def wheel(robot):
        robot.set_ref("###Timeline")
        robot.mouse_move(f"**/name {identity(keyed, 'wall')}")
        robot.mouse_wheel_y(2)

    window.run(wheel)
    assert keyed.timeline.scrolled < low


def test_handles_are_shown_of_the_layer_that_is_chosen_even_while_in_betweens_are_awaited(
    window, scene
):
    window.act(add_handle, 190 + 118j)
    window.settle()
    window.act(editing.select_handles, frozenset())
    # As long as the worker has not made them, no layer has a sampler.
    for runtime in scene.runtimes.layers.values():
        runtime.store.sampler = None
    before = np.asarray(window.picture()).astype(int)
    scene.selection.active = identity(scene, "body")
    after = np.asarray(window.picture()).astype(int)
    hand = window.point(190 + 118j)
    part = np.s_[int(hand.y) - 8 : int(hand.y) + 8, int(hand.x) - 8 : int(hand.x) + 8]
    assert np.abs(after[part] - before[part]).max() > 30


def saved(path, image):
    image.save(path)
    return path


def pixel(window, place):
    """The colour on the screen at a place of the canvas."""
    at = window.point(place)
    return tuple(int(part) for part in np.asarray(window.picture())[int(at.y), int(at.x), :3])


@pytest.fixture
def posed(window, scene):
    """The scene with the arm attached to the body, and raised by a handle at frame 24."""
    arm, body = identity(scene, "arm"), identity(scene, "body")
    joint = Attachment(parent=body, parent_point=95 + 118j)
    window.act(editing.edit_document, layer_commands.attach_layer(arm, 95 + 118j, joint))
    window.act(add_handle, 190 + 118j)
    window.act(playback.seek, 24)
    window.act(set_targets, {0: Target(position=170 + 160j)})
    window.settle()
    assert len(scene.layer.keys) == 2
    return scene


def test_another_picture_keeps_handles_keys_and_joints(window, posed, tmp_path):
    arm = identity(posed, "arm")
    window.act(rename_layer, arm, "limb")
    window.act(editing.edit_document, layer_commands.set_opacity(arm, 0.75))
    window.act(editing.edit_document, layer_commands.move_layer(arm, 1))
    before = posed.document
    green = saved(tmp_path / "green.png", painted((85, 66, 205, 99), (30, 180, 60, 255)))
    window.act(set_active_layer, identity(posed, "body"))
    window.act(replace_picture, arm, green)
    window.settle()
    assert posed.selection.active == arm
    layer, old = posed.document.layer(arm), before.layer(arm)
    assert posed.history.undo_label == "Replace picture"
    assert layer.picture is not old.picture
    assert (layer.name, layer.opacity, layer.handles) == ("limb", 0.75, old.handles)
    assert posed.document.layers.index(layer) == 1
    assert (layer.anchor, layer.attachments) == (old.anchor, old.attachments)
    assert [key.frame for key in layer.keys] == [0, 24]
    for key, earlier in zip(layer.keys, old.keys, strict=True):
        assert key.pose.certificate.is_certified
        assert key.pose.targets == earlier.pose.targets
        places = [
            f.map_of(k.pose)(np.array([190 + 118j]))[0] for f, k in ((layer, key), (old, earlier))
        ]
        assert abs(places[0] - places[1]) < 4
    window.act(playback.seek, 0)
    window.settle()
    red, green, blue = pixel(window, 180 + 118j)
    assert green > 1.5 * max(red, blue)
    window.act(editing.undo)
    assert posed.document is before
    window.settle()
    assert pixel(window, 180 + 118j)[0] > 150
    window.act(editing.redo)
    window.settle()
    path = tmp_path / "man.lissom"
    window.act(saving.write_project, path, None)
    window.settle()
    again = load_project(path).layer(arm)
    assert again.picture.sha256 == layer.picture.sha256
    assert (again.corner, again.attachments) == (layer.corner, layer.attachments)


def test_what_is_outside_of_another_picture_comes_into_it(window, posed, tmp_path):
    arm, body = identity(posed, "arm"), identity(posed, "body")
    window.act(set_active_layer, arm)
    before = posed.document
    # Smaller than the layer: it comes where the middle of the arm was, from 105 to 180.
    short = saved(tmp_path / "short.png", blob(76, 24))
    window.act(replace_picture, arm, short)
    window.settle()
    layer = posed.document.layer(arm)
    assert abs(layer.domain.outline.mean() - (142 + 117j)) < 3
    points = np.array([layer.anchor, *(handle.position for handle in layer.handles)])
    assert layer.domain.contains(points).all()
    assert layer.handles[0].position.real < 182
    rest, raised = layer.keys
    assert abs(rest.pose.targets[0].position - layer.handles[0].position) < 1e-9
    assert raised.pose.targets[0].position != before.layer(arm).keys[1].pose.targets[0].position
    assert layer.attachments == before.layer(arm).attachments
    # The body without the place where the arm is attached.
    legs = saved(tmp_path / "legs.png", painted((60, 120, 110, 180), (40, 40, 200, 255)))
    window.act(replace_picture, body, legs)
    window.settle()
    joint = posed.document.layer(arm).attachments[0]
    assert posed.document.layer(body).domain.contains(np.array([joint.parent_point])).all()
    assert joint.parent_point.imag < 82
    assert not posed.measured.parent_transforms.has_failed(posed.measured.parent_transforms.source)
    assert posed.measured.parent_transforms.value is not None
    for _ in range(2):
        window.act(editing.undo)
    assert posed.document is before


def test_a_picture_that_cannot_take_the_place_of_a_layers_changes_nothing(window, scene, tmp_path):
    arm, wall = identity(scene, "arm"), identity(scene, "wall")
    before = scene.document
    empty = saved(tmp_path / "empty.png", Image.new("RGBA", (60, 50)))
    for path, reason in ((empty, "there is no shape on it"), (tmp_path / "none.png", "none.png")):
        window.session.notices.toasts = []
        window.act(replace_picture, arm, path)
        window.settle()
        (toast,) = window.session.notices.toasts
        assert toast.text.startswith("The picture of arm was not replaced")
        assert reason in toast.text
    assert scene.document is before
    # A still layer takes any picture.
    path = saved(tmp_path / "sky.png", Image.new("RGBA", (240, 200), (90, 160, 250, 255)))
    window.act(replace_picture, wall, path)
    window.settle()
    assert scene.document.layer(wall).still
    window.session.notices.toasts = []  # above what is looked at
    assert pixel(window, 20 + 20j) == (90, 160, 250)


def test_a_layer_that_comes_after_one_is_gone_shows_its_own_picture(window, scene, tmp_path):
    gone = max(layer.id for layer in scene.document.layers)
    window.act(delete_layers, gone)
    window.settle()
    path = saved(tmp_path / "dot.png", blob(60, 40, (250, 220, 0)))
    window.act(add_layers, [path])
    window.settle()
    added = scene.document.layers[-1]
    assert (added.id, added.name, added.corner) == (gone, "dot", 90 + 80j)
    assert scene.selection.active == added.id
    assert pixel(window, 138 + 100j) == (250, 220, 0)


def test_added_flat_drawing_loses_its_plain_background(window, scene, tmp_path):
    flat = Image.new("RGBA", (90, 70), (255, 255, 255, 255))
    flat.alpha_composite(blob(60, 40, (250, 220, 0)), (15, 15))
    path = tmp_path / "flat.ora"
    path.write_bytes(openraster(flat.size, '<layer name="dot" src="data/0.png"/>', [flat]))
    window.act(add_layers, [path])
    window.settle()
    added = scene.document.layers[-1]
    assert (added.name, added.still) == ("dot", False)
    assert abs(added.domain.outline - (120 + 100j)).max() < 35


@pytest.fixture(scope="module")
def stranger(tmp_path_factory):
    """A drawing with what looks different here, and small matters."""
    path = tmp_path_factory.mktemp("layers") / "stranger.ora"
    stack = (
        '<layer name="glow" src="data/0.png" composite-op="svg:vivid-light"/>'
        '<layer name="shine" src="data/0.png" composite-op="svg:vivid-light"/>'
        '<stack name="limbs" opacity="0.5"><layer name="arm" src="data/0.png"/></stack>'
        '<layer name="body" src="data/1.png"/><layer name="wall" src="data/2.png"/>'
    )
    pictures = [
        painted((85, 70, 200, 95), (200, 40, 40, 255)),
        painted((60, 25, 110, 180), (40, 40, 200, 255)),
        Image.new("RGBA", (WIDTH, HEIGHT), (220, 230, 220, 255)),
    ]
    path.write_bytes(openraster((WIDTH, HEIGHT), stack, pictures))
    return path


def test_import_log_stays_in_the_panel(window, stranger):
    project = window.again(Harness.open, stranger)
    (toast,) = (toast for toast in window.session.notices.toasts if toast.topic == "import")
    assert "One thing looks different here" in toast.text
    log = project.document.import_log
    assert log.warnings == ("shine, glow: drawn normally, not in the mode 'vivid-light'",)
    assert "wall: the picture is opaque everywhere, so there is no shape to pose" in log.notes
    window.show_tab("Handle")
    window.act(toast.action.apply)
    window.frames(3)
    assert is_in_front("Layers")
    assert project.layer_list.is_import_log_open

    def fold(robot):
        robot.set_ref("Layers")
        robot.item_click("###summary")

    window.run(fold)
    window.frames(3)
    assert not project.layer_list.is_import_log_open
    assert ACTIONS["Import log"].disabled_reason(window.session) is None
    ACTIONS["Import log"].action.apply(window.session)
    assert project.layer_list.is_import_log_open


def test_import_log_is_saved_and_not_shown_again(window, stranger, tmp_path):
    document = window.again(Harness.open, stranger).document
    path = tmp_path / "log.lissom"
    save_project(path, document)
    window.session.notices.toasts = []
    project = window.open(path)
    assert project.document.import_log == document.import_log != EMPTY_IMPORT_LOG
    assert not window.session.notices.toasts
    assert not project.layer_list.is_import_log_open
    window.show_tab("Handle")
    ACTIONS["Import log"].action.apply(window.session)
    window.frames(3)
    assert is_in_front("Layers")
    assert project.layer_list.is_import_log_open


def test_import_log_of_added_layers_is_undone_with_them(window, scene, stranger):
    before = scene.document.import_log
    window.act(add_layers, [stranger])
    window.settle()
    losses = scene.document.import_log.warnings
    assert losses == ("shine, glow: drawn normally, not in the mode 'vivid-light'",)
    window.act(editing.undo)
    assert scene.document.import_log == before
    window.session.notices.toasts = []


def test_blends_clipping_and_groups_are_set_in_the_panel(window, stranger):
    project = window.again(Harness.open, stranger)
    arm = identity(project, "arm")
    window.act(set_active_layer, arm)
    window.show_tab("Layers")
    window.act(dialog_actions.toggle_import_log)

    def play(robot):
        robot.set_ref("Layers")
        robot.combo_click("##blend/multiply")
        robot.item_check("Clipped")
        robot.item_check("**/Hide all of limbs")
        robot.set_ref("Layers/limbs")
        robot.combo_click("##blend/linear dodge (add)")

    window.run(play)
    window.frames(3)
    layer = project.document.layer(arm)
    assert (layer.blend, layer.clipped, layer.group) == ("multiply", True, "limbs")
    (group,) = project.document.groups
    assert (group.opacity, group.blend, group.hidden) == (0.5, "linear-dodge", True)
    for _ in range(4):
        window.act(editing.undo)
    assert not project.document.groups[0].hidden
    assert project.document.layer(arm).blend == "normal"


@pytest.mark.usefixtures("painted")
def test_layers_of_one_picture_share_it_on_the_graphics_card_until_one_is_cut(window, stranger):
    project = window.again(Harness.open, stranger)
    window.settle()
    drawing = window.program.canvas.resources
    arm, glow, shine = (identity(project, name) for name in ("arm", "glow", "shine"))
    assert drawing.picture(arm) is drawing.picture(glow) is drawing.picture(shine)
    window.act(set_active_layer, glow)
    # Behind it are others with the same picture.
    project.layer_list.solo = frozenset({glow})
    before = window.picture()
    window.act(editing.edit_document, shape_commands.cut_with_brush(glow, brush_at(project, glow)))
    window.settle()
    assert drawing.picture(arm) is drawing.picture(shine) is not drawing.picture(glow)
    cut = window.picture()
    assert cut.tobytes() != before.tobytes()
    window.act(editing.undo)
    window.settle()
    assert drawing.picture(arm) is drawing.picture(glow)
    assert drawing.picture_count == 3


def brush_at(project, layer):
    domain = project.document.layer(layer).domain
    middle = domain.outline.mean() - project.document.layer(layer).corner
    return Stroke(points=np.array([middle, middle + 5]), radius=8, keeps=False)


@pytest.mark.usefixtures("everything")
def test_what_prepares_layers_that_nobody_edits_is_let_go_and_comes_again(
    window, keyed, monkeypatch
):
    window.act(set_active_layer, identity(keyed, "arm"))
    window.settle()
    arm, body = (keyed.runtimes.layers[identity(keyed, name)] for name in ("arm", "body"))
    body_id = identity(keyed, "body")
    for runtime in (arm, body):
        assert runtime.store.sampler.extension is not None  # made where nothing needed it yet
    window.clock.now += 2 * memory.REST
    window.act(playback.seek, 3)
    window.settle()
    window.clock.now += 2 * memory.REST
    window.frames(3)
    # Of few layers all is kept.
    assert body.store.sampler.extension_bytes
    monkeypatch.setattr("app.editor.project.MOST_RELEASABLE_BYTES", 0)
    window.act(playback.toggle_play)
    window.act(playback.stop_playback)
    window.clock.now += 2 * memory.REST
    window.frames(3)
    assert not body.store.sampler.extension_bytes
    assert arm.store.sampler.extension_bytes
    # Series show what nobody edits; what they are made from is made again when the layer is chosen.
    assert body.store.prepared(clip_of(keyed.document, body_id)) is None
    assert arm.store.prepared(keyed.clip) is not None
    assert body.shown.is_current
    window.act(set_active_layer, body_id)
    window.settle()
    assert body.store.prepared(keyed.clip) is not None
    window.act(
        editing.edit_document, channel_commands.move_keys({pose_channel(body_id): [BODY[1]]}, 1)
    )
    window.settle()
    assert body.store.has(clip_of(keyed.document, body_id))

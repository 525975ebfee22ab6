"""A layer is attached to another layer by a drag from its anchor, with the pointer."""

import re
from dataclasses import replace

import numpy as np
import pytest
from documents import differences
from layered import openraster
from messages import says
from PIL import Image, ImageDraw

from app.document import (
    DEPTH,
    TRANSFORM,
    Attachment,
    Channel,
    Command,
    FrameRange,
    Transform,
    channel_commands,
    clip_of,
    depth_points_at,
    key_commands,
    layer_commands,
    scene_commands,
    shape_commands,
    transform_at,
)
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup.layer_runtimes import update_layer_runtimes
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.actions.project_files import recovery
from app.editor.layering.layer_list import toggle_clipping
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import PARENT_IS_DESCENDANT, detach_layer
from app.editor.layering.pictures import add_layers
from app.motion import Evaluator, ParentTransforms
from app.motion.parenting.parent_transforms import layer_animation
from app.storage import Autosave, SourceInfo, make_still_layer
from app.ui.style.theme import PALETTES
from app.ui.viewport.marks import find_anchor, mark_all
from engine.geometry import IDENTITY_MOTION

WIDTH, HEIGHT = 240, 200
LAYERS = {
    "hand": ((175, 60, 225, 100), (250, 220, 40)),
    "arm": ((85, 70, 200, 95), (200, 40, 40)),
    "body": ((60, 25, 110, 180), (40, 40, 200)),
}
SHOULDER, HIP, BESIDE, PALM = 95 + 118j, 85 + 40j, 20 + 20j, 190 + 118j


@pytest.fixture(scope="module")
def drawing(tmp_path_factory):
    path = tmp_path_factory.mktemp("joint") / "man.ora"
    stack = "".join(f'<layer name="{n}" src="data/{i}.png"/>' for i, n in enumerate(LAYERS))
    pictures = []
    for box, colour in LAYERS.values():
        image = Image.new("RGBA", (WIDTH, HEIGHT))
        ImageDraw.Draw(image).rounded_rectangle(box, 12, fill=(*colour, 255))
        pictures.append(image)
    path.write_bytes(openraster((WIDTH, HEIGHT), stack, pictures))
    return path


@pytest.fixture
def scene(window, drawing):
    return window.again(open_with_arm, drawing)


def open_with_arm(window, drawing):
    project = window.open(drawing)
    window.act(set_active_layer, identity(project, "arm"))
    window.settle()


def identity(project, name):
    return next(layer.id for layer in project.document.layers if layer.name == name)


def on_scene(project, name):
    shown = project.runtimes.layers[identity(project, name)].shown
    return shown.placement.apply(shown.positions)


@pytest.fixture
def drag(window, scene):
    """Drags from the anchor over places of the scene; returns the hint at each place."""

    def drag(*places, key=None, gives_up=False):
        hints = []

        def run(robot):
            shown = scene.layer_runtime.shown
            start = find_anchor(scene, shown)
            start = shown.handle_positions[0] if start is None else start
            robot.mouse_move_to_pos(window.point(complex(start)))
            hints.append(window.session.tools.hint)
            if key is not None:
                robot.key_down(int(key))
            robot.mouse_down(0)
            for place in places:
                robot.mouse_move_to_pos(
                    window.point(scene.layer_runtime.shown.placement.apply_inverse(place))
                )
                robot.yield_(3)
                hints.append(window.session.tools.hint)
            if gives_up:
                robot.key_press(int(window.Key.escape))
            robot.mouse_up(0)
            if key is not None:
                robot.key_up(int(key))

        window.run(run)
        window.settle()
        return hints

    return drag


def test_the_anchor_is_dragged_onto_another_layer(window, scene, drag):
    arm, body = identity(scene, "arm"), identity(scene, "body")
    # In the middle of a motion.
    layer = scene.document.layer(arm)
    pose = layer.keys[0].pose
    cage = layer.domain.cage - 140
    turned = replace(pose, phi=140 + cage * np.exp(0.3j))
    scene.history.do(key_commands.insert_key(arm, 24, turned), gesture=None)
    window.act(playback.seek, 10)
    window.settle()
    before, was = scene.document, on_scene(scene, "arm")
    hints = drag(BESIDE, SHOULDER)
    assert "drag to attach it to another layer" in hints[0].lower()
    assert "over the layer to attach it to" in hints[1]
    assert "to attach arm to body" in hints[2]
    joint = scene.document.layer(arm).attachments[0]
    assert (joint.parent, joint.inherits_rotation) == (body, True)
    assert abs(joint.parent_point - SHOULDER) < 1
    assert np.abs(on_scene(scene, "arm") - was).max() < 1e-6 * WIDTH
    # One step of undo, which brings back the same document.
    window.act(editing.undo)
    assert scene.document is before
    window.act(editing.redo)
    assert scene.document.layer(arm).attachments[0].parent == body


def test_off_the_layer_itself_the_joint_is_where_both_are(scene, drag):
    drag(HIP)
    arm = scene.document.layer(identity(scene, "arm"))
    assert arm.attachments[0].parent == identity(scene, "body")
    assert 85 < arm.attachments[0].parent_point.real < 112
    assert 100 < arm.attachments[0].parent_point.imag < 132
    assert abs(arm.anchor - arm.attachments[0].parent_point) < 1e-6


def test_the_layer_under_the_pointer_is_marked(window, scene):
    accent = PALETTES["dark"].accent
    colour = np.array([round(255 * c) for c in (accent.x, accent.y, accent.z)])
    seen = []

    def look():
        corner = window.point(60 + 60j)  # at the left edge of the body
        x, y = round(corner.x), round(corner.y)
        part = np.asarray(window.picture()).astype(int)[y - 4 : y + 5, x - 9 : x + 10, :3]
        return int((np.abs(part - colour).max(axis=2) < 12).sum())

    def run(robot):
        start = complex(find_anchor(scene, scene.layer_runtime.shown))
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(HIP))
        robot.yield_(3)

    seen.append(look())
    window.run(run)
    seen.append(look())
    window.run(lambda robot: (robot.key_press(int(window.Key.escape)), robot.mouse_up(0)))
    seen.append(look())
    assert seen[0] == seen[2] == 0
    assert seen[1] > 5


def test_esc_and_a_drop_beside_all_layers_leave_it_as_it_was(window, scene, drag):
    before = scene.document
    drag(HIP, SHOULDER, gives_up=True)
    assert window.session.tools.active_tool is None
    drag(HIP, BESIDE)
    assert scene.document is before
    assert "over another layer" in window.session.notices.toasts[-1].text


def test_a_circle_is_refused_in_words(window, scene, drag):
    hand, arm, body = (identity(scene, name) for name in ("hand", "arm", "body"))
    drag(SHOULDER)
    window.act(set_active_layer, hand)
    window.settle()
    drag(170 + 118j)
    assert scene.document.layer(hand).attachments[0].parent == arm
    before = scene.document
    window.act(set_active_layer, body)
    window.settle()
    hints = drag(212 + 120j)
    assert "is attached to body and cannot be its parent" in hints[-1]
    assert scene.document is before
    assert window.session.notices.toasts[-1].tone == "error"
    assert re.search(
        says(PARENT_IS_DESCENDANT, name="hand", parent="body"),
        window.session.notices.toasts[-1].text,
    )


def test_a_click_on_the_anchor_adds_a_handle_there_as_ever(window, scene):
    place = complex(find_anchor(scene, scene.layer_runtime.shown))

    def click(robot):
        robot.mouse_move_to_pos(window.point(place))
        robot.mouse_click(0)

    window.run(click)
    window.settle()
    (handle,) = scene.layer.handles
    assert abs(handle.position - place) < 1


def test_a_handle_that_is_the_anchor_is_dragged_onto_another_layer_with_ctrl(window, scene, drag):
    window.act(add_handle, SHOULDER)
    window.settle()
    window.act(editing.edit_layer, shape_commands.set_anchor, scene.layer.handles[0].position)
    window.settle()
    drag(SHOULDER + 6, HIP, key=window.Key.mod_ctrl)
    arm = scene.document.layer(identity(scene, "arm"))
    assert arm.attachments[0].parent == identity(scene, "body")
    assert abs(arm.attachments[0].parent_point - SHOULDER) < 1
    # A click with it takes the anchor back, as ever.
    window.act(editing.undo)
    drag(key=window.Key.mod_ctrl)
    assert scene.layer.anchor is None


def test_unsaved_work_comes_back_with_its_joints_and_depths(window, scene, drag, tmp_path):
    arm, body = identity(scene, "arm"), identity(scene, "body")
    drag(SHOULDER)
    window.act(add_handle, PALM)
    window.settle()
    hand = scene.layer.handles[0].id
    window.act(editing.edit_document, layer_commands.set_depth(arm, hand, -0.5, 70.0))
    layer = scene.document.layer(body)
    pose = layer.keys[0].pose
    turned = replace(pose, phi=90 + (layer.domain.cage - 90) * np.exp(-0.4j))
    window.act(editing.edit_document, key_commands.insert_key(body, 12, turned))
    window.act(editing.edit_document, key_commands.insert_key(arm, 12, scene.layer.keys[0].pose))
    window.act(editing.edit_document, channel_commands.set_key(Channel(DEPTH, arm, hand), 12, 1.0))
    window.act(playback.seek, 6)
    window.settle()
    was = {name: on_scene(scene, name) for name in LAYERS}
    # As another window left it that ended unexpectedly.
    Autosave(tmp_path).write(scene.document, SourceInfo("man", None))
    (kept,) = tmp_path.glob("unsaved-*.lissom")
    window.session.project = None
    window.act(recovery.recover_file, kept)
    window.settle()
    again = window.session.project
    assert not differences(again.document, scene.document)
    window.act(playback.seek, 6)
    window.settle()
    for name, places in was.items():
        np.testing.assert_allclose(on_scene(again, name), places, rtol=0, atol=1e-3)
    clip = clip_of(again.document, arm)
    assert [depth_points_at(clip, frame)[0].depth for frame in (6, 12)] == [-0.5, 1.0]


@pytest.fixture
def swung(window, scene):
    """The arm is attached to the body, which turns; a motion path and ghosts are shown."""
    arm, body = identity(scene, "arm"), identity(scene, "body")
    window.act(add_handle, PALM)
    layer = scene.document.layer(body)
    pose = layer.keys[0].pose
    turned = replace(pose, phi=100 + (layer.domain.cage - 100) * np.exp(0.3j))
    scene.history.do(key_commands.insert_key(body, 24, turned), gesture=None)
    joint = layer_commands.attach_layer(
        arm, SHOULDER, Attachment(parent=body, parent_point=SHOULDER)
    )
    window.act(editing.edit_document, joint)
    window.act(playback.seek, 24)
    window.settle()
    for overlay in ("paths", "onion"):
        window.act(viewing.toggle_overlay, overlay)
    # The Export tab, which another test may have left in front, marks the frame of an export.
    window.show_tab("Layers")
    window.settle()
    return scene


def test_child_of_a_posed_parent_is_placed_with_the_correction(swung):
    arm, body = identity(swung, "arm"), identity(swung, "body")
    shown = {each: runtime.shown for each, runtime in swung.runtimes.layers.items()}
    # The pose alone is elsewhere than the parent, which is drawn with a correction.
    poses = {body: swung.document.layer(body).keys[0].pose}
    shown[body] = replace(shown[body], correction=object())
    exact = Evaluator(layers={}, transforms=swung.evaluator.transforms)
    placed = exact.placed(swung.document, shown, poses)
    drawn = Evaluator(layers={}).placed(swung.document, shown, poses)
    assert placed[arm].placement == drawn[arm].placement
    shown[body] = replace(shown[body], correction=None)
    alone = exact.placed(swung.document, shown, poses)
    assert abs(alone[arm].placement.shift - drawn[arm].placement.shift) > 5


def ways(window, project):
    """Return the ways of handles that are drawn."""
    lines, _ = mark_all(window.session, project, project.layer_runtime.shown, PALETTES["dark"])
    return [line.points for line in lines if len(line.points) > 2]


def test_a_layer_that_is_let_go_leaves_its_way_on_the_other_one(window, swung):
    (way,) = ways(window, swung)
    assert abs(way[-1] - way[0]) > 10
    window.act(detach_layer, identity(swung, "arm"))
    window.settle()
    assert ways(window, swung) == []
    window.act(editing.undo)
    window.settle()
    np.testing.assert_allclose(ways(window, swung), [way], rtol=0, atol=1e-9)


def test_a_layer_that_is_let_go_stays_where_it_is_though_it_moves_by_itself(window, swung):
    arm = identity(swung, "arm")
    moves = (TRANSFORM.key(0, Transform()), TRANSFORM.key(12, Transform(shift=20 + 5j, turn=0.4)))
    moved = replace(swung.document.layer(arm), channels={(TRANSFORM.name, None): moves})
    window.act(editing.edit_document, Command("Move", lambda document: document.with_layer(moved)))
    window.act(playback.seek, 6)
    window.settle()
    shown = swung.runtimes.layers[arm].shown
    before = shown.placement.apply(shown.positions)
    window.act(detach_layer, arm)
    window.settle()
    after = swung.runtimes.layers[arm].shown
    assert not swung.document.layer(arm).has_parent
    assert after.placement == transform_at(swung.document, swung.document.layer(arm), 6)
    np.testing.assert_allclose(after.placement.apply(after.positions), before, rtol=0, atol=0.01)


@pytest.mark.usefixtures("everything")
def test_joints_of_an_earlier_document_are_not_used(window, swung):
    (way,) = ways(window, swung)
    joints = swung.measured.parent_transforms.value
    layer = swung.document.layer(identity(swung, "body"))
    pose = replace(layer.keys[0].pose, phi=layer.domain.cage + 50)
    editing.edit_document(window.session, key_commands.replace_key_pose(layer.id, 0, pose))
    assert swung.measured.parent_transforms.value is joints
    assert swung.placements([0], IDENTITY_MOTION) == [IDENTITY_MOTION]
    assert swung.placed_at(swung.selection.active, [0]) is None
    assert ways(window, swung) == [], "a way at a place where its layer is no more"
    window.settle()
    (now,) = ways(window, swung)
    np.testing.assert_allclose([now[0], now[-1]], [way[0] + 50, way[-1]], rtol=0, atol=1e-6)


def test_a_layer_that_comes_to_a_scene_with_joints_has_its_own_way(window, swung, tmp_path):
    path = tmp_path / "ball.png"
    Image.new("RGBA", (40, 40), (90, 200, 90, 255)).save(path)
    window.act(add_layers, [path])
    window.settle()
    assert swung.layer.name == "ball"
    shown = swung.layer_runtime.shown
    window.act(add_handle, complex(shown.positions.mean()))
    window.act(nudge_handles, 12)
    window.settle()
    (way,) = ways(window, swung)
    assert abs(way[-1] - way[0] - 12) < 1e-6


def ghosts_of(window):
    """Return the picture without and with ghosts, as the viewport shows them."""
    pictures = []
    for onion in (False, True):
        if window.session.display.overlays.onion != onion:
            window.act(viewing.toggle_overlay, "onion")
        window.settle()
        pictures.append(np.asarray(window.picture()).astype(int)[..., :3])
    return pictures


def around(window, picture, place):
    point = window.point(place)
    return picture[round(point.y) - 2 : round(point.y) + 3, round(point.x) - 2 : round(point.x) + 3]


@pytest.fixture
def nodding(window, swung):
    """The same before a wall that stands still, at frame 12, with one ghost at either end."""
    wall = replace(
        swung.document.layers[0],
        id=layer_commands.next_layer_id(swung.document),
        name="wall",
        handles=(),
        keys=swung.document.layers[0].keys[:1],
        attachments=(),
    )
    wall = make_still_layer(wall)
    swung.history.do(layer_commands.add_layer(wall), gesture=None)
    update_layer_runtimes(swung)
    window.act(editing.edit_document, layer_commands.move_layer(wall.id, 0))
    window.act(viewing.set_onion_skin, 1, 1, 12)
    window.act(playback.seek, 12)
    window.act(viewing.toggle_overlay, "handles")
    window.act(viewing.toggle_overlay, "paths")
    window.settle()
    return swung


def placed(project, name, frame, place):
    """Return where a point of a layer at rest is in the scene at a frame, by its joints."""
    layer = project.document.layer(identity(project, name))
    joints = ParentTransforms(project.document, project.samplers)
    animation = layer_animation(
        project.document, layer.id, np.array([place]), project.samplers, None
    )
    own = animation.frame(frame).positions
    return complex(joints.placement(layer.id, frame).apply(own)[0])


def test_layers_clipped_to_a_still_one_have_ghosts(window, nodding):
    window.act(viewing.set_onion_skin_in_front, True)  # noqa: FBT003 - of an action
    _plain, own = ghosts_of(window)
    window.act(toggle_clipping, identity(nodding, "body"))
    window.settle()
    _plain, clipped = ghosts_of(window)
    for frame, place in {0: 105 + 60j, 24: 66 + 168j}.items():
        at = placed(nodding, "body", frame, place)
        was, now = (around(window, each, at) for each in (own, clipped))
        np.testing.assert_array_equal(now, was)


def test_ghosts_are_of_all_layers_where_their_joints_have_them_then(window, nodding):
    plain, ghosts = ghosts_of(window)
    # Edges of the arm, whose parent is the body, and of the body: both are empty at frame 12.
    edges = {
        "arm": {0: 168 + 108j, 24: 180 + 126j},
        "body": {0: 105 + 60j, 24: 66 + 168j},
    }
    for name, places in edges.items():
        for frame, place in places.items():
            at = placed(nodding, name, frame, place)
            was, now = (around(window, each, at) for each in (plain, ghosts))
            tint = ((now - was)[..., 0] - (now - was)[..., 2]).mean()
            assert tint > 20 if frame == 0 else tint < -20, (name, frame)


def test_ghosts_are_in_front_when_the_person_asks(window, nodding):
    plain, behind = ghosts_of(window)
    at = placed(nodding, "body", 12, 85 + 100j)  # within the body, now and then
    np.testing.assert_array_equal(around(window, behind, at), around(window, plain, at))

    def put(robot):
        robot.item_click("//##Left_2123243/###eye")
        robot.mouse_move("//$FOCUSED/Onion skin frames")
        robot.yield_(20)
        robot.item_click("//###Menu_00/Draw in front")
        robot.popup_close_all()

    window.run(put)
    assert window.session.settings.preferences.ghosts_in_front
    window.settle()
    front = np.asarray(window.picture()).astype(int)[..., :3]
    assert np.abs(around(window, front, at) - around(window, plain, at)).max() > 20


@pytest.mark.usefixtures("everything")
def test_attached_layer_has_no_ghost_until_its_place_is_known(window, nodding):
    ghosts_of(window)
    layer = nodding.document.layer(identity(nodding, "body"))
    pose = replace(layer.keys[0].pose, phi=layer.domain.cage + 40j)
    editing.edit_document(window.session, key_commands.replace_key_pose(layer.id, 0, pose))
    assert nodding.placed_at(identity(nodding, "arm"), [0]) is None
    assert nodding.placed_at(layer.id, [0]) == [IDENTITY_MOTION]
    window.settle()
    (there,) = nodding.placed_at(identity(nodding, "arm"), [0])
    assert there.apply(np.array([SHOULDER]))[0] == pytest.approx(SHOULDER + 40j, abs=1e-6)


def test_motion_path_stays_at_its_parent_during_a_drag(window, swung):
    window.act(playback.seek, 24)
    window.settle()
    (way,) = ways(window, swung)
    (handle,) = swung.layer.handles
    layer = swung.document.layer(swung.selection.active)
    other = replace(layer, handles=(replace(handle, weight=2.0),))
    swung.history.do(Command("Weigh", lambda document: document.with_layer(other)), gesture=None)
    assert swung.evaluator.current_transforms(swung.document) is None
    np.testing.assert_allclose(ways(window, swung), [way], rtol=0, atol=1e-9)


def test_ways_are_of_what_plays_or_of_some_frames_around_the_playhead(window, swung):
    (whole,) = ways(window, swung)
    assert len(whole) == 49
    window.act(editing.edit_document, scene_commands.set_preview(FrameRange(6, 20)))
    window.settle()
    (played,) = ways(window, swung)
    np.testing.assert_allclose(played, whole[6:21], rtol=0, atol=1e-9)
    window.act(playback.seek, 18)
    window.settle()

    def choose(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_click("View/Motion path frames/6 around playhead")

    window.run(choose)
    window.settle()
    (near,) = ways(window, swung)
    np.testing.assert_allclose(near, whole[12:21], rtol=0, atol=1e-9)


def test_cage_is_drawn_at_its_attached_layer(window, swung):
    window.act(viewing.toggle_overlay, "paths")
    window.act(viewing.toggle_overlay, "cage")
    window.settle()
    shown = swung.layer_runtime.shown
    assert abs(shown.placement.factor - 1) > 0.1
    lines, _ = mark_all(window.session, swung, shown, PALETTES["dark"])
    (cage,) = [line.points for line in lines if line.dash]
    np.testing.assert_allclose(cage, shown.placement.apply(swung.layer.domain.cage))

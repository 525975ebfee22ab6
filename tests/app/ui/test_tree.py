"""The tree of layers in the window: groups, switches, selections, parents over time."""

import re

import numpy as np
import pytest
from harness import Harness
from imgui_bundle import ImVec2
from layered import openraster
from messages import says
from PIL import Image, ImageDraw

from app.document import (
    DRAW_ORDER,
    OPACITY,
    TRANSFORM,
    Channel,
    cycle_commands,
    group_commands,
    is_visible,
    key_commands,
    layers_in_draw_order,
    switch_group_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.inserting import insert_key
from app.editor.actions.timing import channel_keys, timeline_drag
from app.editor.layering.deletion import delete_layers
from app.editor.layering.layer_list import layer_at, toggle_layers_hidden
from app.editor.layering.layer_selection import (
    select_layers,
    set_active_layer,
    solo_layers,
    toggle_tree_row,
)
from app.editor.layering.parenting import (
    PARENT_IS_DESCENDANT,
    attach_layer,
    delete_parent_key,
    reparent_layer,
)
from app.editor.layering.switches import create_switch, key_switch
from app.ui.panel import is_in_front

WIDTH, HEIGHT = 240, 200
FACES = {
    "oh": (110, 100, 130, 120),
    "ah": (110, 95, 130, 125),
    "hat": (80, 20, 160, 60),
    "head": (60, 40, 180, 160),
    "stick": (200, 20, 215, 180),
}


@pytest.fixture(scope="module")
def drawing(tmp_path_factory):
    path = tmp_path_factory.mktemp("tree") / "face.ora"
    stack = "".join(f'<layer name="{n}" src="data/{i}.png"/>' for i, n in enumerate(FACES))
    pictures = []
    for number, box in enumerate(FACES.values()):
        image = Image.new("RGBA", (WIDTH, HEIGHT))
        ImageDraw.Draw(image).rounded_rectangle(box, 6, fill=(40 * number, 90, 200, 255))
        pictures.append(image)
    path.write_bytes(openraster((WIDTH, HEIGHT), stack, pictures))
    return path


@pytest.fixture
def scene(window, drawing):
    project = window.again(Harness.open, drawing)
    window.show_tab("Layers")
    return project


@pytest.fixture
def ids(scene):
    return {layer.name: layer.id for layer in scene.document.layers}


@pytest.fixture
def use(window):
    """Use the tab of layers by the robot."""

    def play(what):
        def run(robot):
            robot.set_ref("Layers")
            what(robot)

        window.run(run)
        window.frames(3)

    return play


def row_of(key):
    return f"**/###row {key}"


def drop(robot, dragged, onto, share=0.5):
    """Drag a row to a share of another one's height, from its top on."""
    robot.mouse_move(row_of(dragged))
    robot.mouse_down(0)
    low, high = (getattr(robot.item_info(row_of(onto)).rect_full, end) for end in ("min", "max"))
    for at in (0.5, share):
        robot.mouse_move_to_pos(ImVec2((low.x + high.x) / 2, low.y + at * (high.y - low.y)))
        robot.yield_(2)
    robot.mouse_up(0)
    robot.yield_(2)


def seen(project, frame):
    document = project.document
    return {each.name for each in document.layers if is_visible(document, each, frame)}


def place(project, name, window):
    """Where the middle of a layer's outline is drawn in the scene."""
    window.settle()
    shown = project.runtimes.layers[
        next(f.id for f in project.document.layers if f.name == name)
    ].shown
    return complex(shown.placement.apply(shown.positions).mean())


def test_switch_is_created_by_one_click(window, scene, ids, use):
    def choose_both(robot):
        robot.item_click(row_of(ids["ah"]))
        robot.key_down(int(window.Key.mod_ctrl))
        robot.item_click(row_of(ids["oh"]))
        robot.key_up(int(window.Key.mod_ctrl))

    use(choose_both)
    assert set(scene.selected_layers) == {ids["ah"], ids["oh"]}

    def choose_create_switch(robot):
        robot.item_click(row_of(ids["ah"]), 1)
        robot.item_click("//$FOCUSED/Create switch")

    use(choose_create_switch)
    (switch_group,) = scene.document.switch_groups
    assert set(switch_group.members) == {ids["ah"], ids["oh"]}
    first = scene.document.layer(switch_group.member_at(0)).name
    other = ({"ah", "oh"} - {first}).pop()
    assert {"ah", "oh"} & seen(scene, 0) == {first}
    window.act(playback.seek, 12)
    use(lambda robot: robot.item_click(f"**/fold choice {switch_group.name}"))
    use(lambda robot: robot.item_click(f"**/###turn {ids[other]}"))
    assert {"ah", "oh"} & seen(scene, 11) == {first}
    assert {"ah", "oh"} & seen(scene, 12) == {other}
    window.settle()
    window.act(editing.undo)
    assert {"ah", "oh"} & seen(scene, 12) == {first}


def test_only_the_layer_that_is_seen_has_a_full_circle(window, scene, ids, use):
    window.act(
        editing.edit_document,
        switch_group_commands.create_switch_group("mouth", [ids["ah"], ids["oh"]]),
    )
    window.act(toggle_tree_row, "choice mouth")
    window.act(set_active_layer, ids["head"])
    window.settle()
    boxes = {}

    def look(robot):
        for name in ("ah", "oh"):
            boxes[name] = robot.item_info(f"**/###turn {ids[name]}").rect_full
        robot.mouse_move_to_pos(window.point(20 + 20j))

    use(look)
    picture = np.asarray(window.picture())[..., :3].astype(int)

    def inked(box):
        x, y = (round(value) for value in (box.get_center().x, box.get_center().y))
        half = round(window.text_height() / 2)
        around = picture[y - half : y + half, x - half : x + half]
        return np.count_nonzero(np.abs(around - around[0, 0]).sum(axis=2) > 90)

    on = scene.document.layer(scene.document.switch_groups[0].member_at(0)).name
    (off,) = {"ah", "oh"} - {on}
    assert 0 < inked(boxes[off]) < inked(boxes[on])


def test_where_a_turn_begins_is_dragged_in_the_timeline(window, scene, ids):
    window.act(
        editing.edit_document,
        switch_group_commands.create_switch_group("mouth", [ids["ah"], ids["oh"]]),
    )
    other = next(
        i for i in (ids["ah"], ids["oh"]) if i != scene.document.switch_groups[0].member_at(0)
    )
    window.act(editing.edit_document, switch_group_commands.choose_at(other, 12))
    window.frames(3)
    places = {}

    def measure(robot):
        robot.set_ref("###Timeline")
        for start in (0, 12):
            places[start] = robot.item_info(f"**/choice mouth/turn {start}").rect_full

    def drag(robot):
        robot.set_ref("###Timeline")
        step = (places[12].min.x - places[0].min.x) / 12
        robot.mouse_move("**/choice mouth/edge 12")
        robot.mouse_down(0)
        y = places[12].get_center().y
        for frame in (18, 20):
            robot.mouse_move_to_pos(ImVec2(places[12].min.x - 1 + (frame - 12) * step, y))
            robot.yield_(2)
        robot.mouse_up(0)

    window.run(measure)
    window.run(drag)
    window.frames(3)
    assert [turn.frame for turn in scene.document.switch_groups[0].keys][-1] == 20
    window.act(editing.undo)
    assert [turn.frame for turn in scene.document.switch_groups[0].keys][-1] == 12


@pytest.mark.usefixtures("scene")
def test_rows_stay_where_they_are_when_another_layer_is_chosen(window, ids):
    tops = []

    def look(robot):
        robot.set_ref("###Timeline")
        found = [robot.item_info(f"**/name {ids[each]}").rect_full.min.y for each in shown]
        tops.append(found)

    shown = ("oh", "ah", "hat")
    for name in shown:
        window.act(set_active_layer, ids[name])
        window.frames(2)
        window.run(look)
    assert all(each == tops[0] for each in tops)


def test_what_is_listed_stays_below_the_pointer_until_that_goes_back_to_the_drawing(
    window, scene, ids, use
):
    window.act(
        editing.edit_document,
        switch_group_commands.create_switch_group("mouth", [ids["ah"], ids["oh"]]),
    )
    window.act(set_active_layer, ids["ah"])
    window.frames(2)
    tops = []

    def click(robot):
        for _ in range(2):
            robot.item_click(row_of(ids["head"]))
            tops.append(robot.item_info(row_of(ids["head"])).rect_full.min.y)

    use(click)
    assert tops[0] == tops[1]
    assert ids["ah"] in {row.layers[0] for row in scene.tree if row.layer}
    window.run(lambda robot: robot.mouse_move_to_pos(window.point(20 + 20j)))
    assert ids["ah"] not in {row.layers[0] for row in scene.tree if row.layer}


def test_layers_are_grouped_folded_hidden_and_locked_together(window, scene, ids, use):
    window.act(select_layers, ids["hat"], ids["head"])
    use(lambda robot: robot.item_click("###group layers"))
    assert [each.name for each in scene.document.groups] == ["group"]
    key = next(row.key for row in scene.tree if row.group)
    use(lambda robot: robot.item_click(f"**/###eye {key}"))
    assert not {"hat", "head"} & seen(scene, 0)
    use(lambda robot: robot.item_click(f"**/###eye {key}"))
    use(lambda robot: robot.item_click(f"**/###lock {key}"))
    assert all(scene.document.layer(ids[each]).locked for each in ("hat", "head"))
    use(lambda robot: robot.item_click(f"**/fold {key}"))
    listed = [row.layer.name for row in scene.tree if row.layer]
    # What is posed is listed all the same.
    assert {"hat", "head"} & set(listed) <= {scene.layer.name}
    # Dropped onto its row, another layer is in it, too.
    use(lambda robot: drop(robot, ids["stick"], key))
    assert scene.document.layer(ids["stick"]).group == "group"


def test_row_is_attached_when_dropped_on_another_row(window, scene, ids, use):
    before = place(scene, "hat", window)
    use(lambda robot: drop(robot, ids["hat"], ids["head"]))
    window.settle()
    (joint,) = scene.document.layer(ids["hat"]).attachments
    assert joint.parent == ids["head"]
    assert abs(place(scene, "hat", window) - before) < 0.1
    # A layer that does not touch the other one is attached as well, and nothing moves.
    before = place(scene, "stick", window)
    use(lambda robot: drop(robot, ids["stick"], ids["head"]))
    window.settle()
    (joint,) = scene.document.layer(ids["stick"]).attachments
    assert abs(joint.offset) > 10
    assert abs(place(scene, "stick", window) - before) < 0.1
    # A circle is refused with a message, and nothing moves.
    before, window.session.notices.toasts = scene.document, []
    use(lambda robot: drop(robot, ids["head"], ids["hat"]))
    assert scene.document is before
    (toast,) = window.session.notices.toasts
    assert re.search(says(PARENT_IS_DESCENDANT, name="hat", parent="head"), toast.text)
    # An indirect circle is refused as well, also for one of several layers.
    window.act(attach_layer, ids["ah"], ids["hat"])
    window.settle()
    before, window.session.notices.toasts = scene.document, []
    window.act(select_layers, ids["head"], ids["oh"])
    use(lambda robot: drop(robot, ids["oh"], ids["ah"]))
    assert scene.document is before
    (toast,) = window.session.notices.toasts
    assert re.search(says(PARENT_IS_DESCENDANT, name="ah", parent="head"), toast.text)
    window.session.notices.toasts = []


def test_chosen_layers_are_dropped_together(window, scene, ids, use):
    before, both = scene.document, (ids["hat"], ids["stick"])
    places = [place(scene, name, window) for name in ("hat", "stick")]
    window.act(select_layers, *both)
    use(lambda robot: drop(robot, ids["stick"], ids["head"]))
    window.settle()
    assert [scene.document.layer(each).attachments[0].parent for each in both] == [ids["head"]] * 2
    for name, there in zip(("hat", "stick"), places, strict=True):
        assert abs(place(scene, name, window) - there) < 0.1
    assert scene.history.undo_label == "Attach 2 layers"
    window.act(editing.undo)
    assert scene.document is before
    use(lambda robot: drop(robot, ids["stick"], ids["oh"], 0.1))
    order = [each.name for each in reversed(scene.document.layers)]
    assert order == ["hat", "stick", "oh", "ah", "head"]
    window.act(editing.undo)
    assert scene.document is before


def test_chosen_layers_are_dropped_on_a_choice_together(window, scene, ids, use):
    window.act(create_switch, ids["ah"], ids["oh"])
    before = scene.document
    (switch_group,) = before.switch_groups
    (row,) = (row for row in scene.tree if row.switch_group is switch_group)
    window.act(select_layers, ids["hat"], ids["stick"])
    use(lambda robot: drop(robot, ids["stick"], row.key))
    (joined,) = scene.document.switch_groups
    assert set(joined.members) == {*switch_group.members, ids["hat"], ids["stick"]}
    window.act(editing.undo)
    assert scene.document is before


def test_children_get_the_grandparent_when_a_layer_is_deleted(window, scene, ids):
    for child, parent in (("ah", "hat"), ("hat", "head")):
        window.act(attach_layer, ids[child], ids[parent])
        window.settle()
    window.act(set_active_layer, ids["head"])
    window.act(add_handle, 120 + 100j)
    window.settle()
    before = scene.document
    there = place(scene, "ah", window)
    window.act(delete_layers, ids["hat"])
    window.settle()
    assert scene.document.layer(ids["ah"]).attachments[0].parent == ids["head"]
    assert abs(place(scene, "ah", window) - there) < 0.1
    assert scene.history.undo_label == "Delete layer"
    window.act(editing.undo)
    assert scene.document is before
    # Also where it is reparented to it at another time, and without a jump.
    window.act(attach_layer, ids["ah"], ids["stick"])
    window.settle()
    window.act(playback.seek, 10)
    window.act(reparent_layer, ids["ah"], ids["hat"])
    window.settle()
    there = place(scene, "ah", window)
    window.act(playback.seek, 0)
    window.act(delete_layers, ids["hat"])
    window.settle()
    joints = scene.document.layer(ids["ah"]).attachments
    assert [(each.frame, each.parent) for each in joints] == [(0, ids["stick"]), (10, ids["head"])]
    window.act(playback.seek, 10)
    assert abs(place(scene, "ah", window) - there) < 0.1


def test_layer_is_reparented_and_detached_without_a_jump(window, scene, ids, use):
    window.act(attach_layer, ids["stick"], ids["head"])
    window.settle()
    window.act(set_active_layer, ids["stick"])
    for frame, button in ((10, f"**/To hat###to {ids['hat']}"), (20, "**/Detach")):
        window.act(playback.seek, frame)
        window.settle()
        before = place(scene, "stick", window)

        def reparent(robot, frame=frame, button=button):
            robot.item_click(f"**/Reparent from frame {frame}…")
            robot.item_click(button.replace("**", "//$FOCUSED"))

        use(reparent)
        window.settle()
        assert scene.document.layer(ids["stick"]).attachments[-1].frame == frame
        assert abs(place(scene, "stick", window) - before) < 0.5
    assert [each.parent for each in scene.document.layer(ids["stick"]).attachments] == [
        ids["head"],
        ids["hat"],
        None,
    ]
    window.act(delete_parent_key, ids["stick"], 20)
    assert len(scene.document.layer(ids["stick"]).attachments) == 2


def test_reparenting_in_a_repeat_changes_all_repeats(window, scene, ids, use):
    window.act(attach_layer, ids["stick"], ids["head"])
    window.settle()
    window.act(editing.edit_document, cycle_commands.set_cycle(ids["stick"], 0, 12))
    window.act(set_active_layer, ids["stick"])
    window.act(playback.seek, 18)
    window.settle()
    before, document = place(scene, "stick", window), scene.document
    window.act(reparent_layer, ids["stick"], ids["hat"])
    window.settle()
    assert [joint.frame for joint in scene.document.layer(ids["stick"]).attachments] == [0, 6]
    assert abs(place(scene, "stick", window) - before) < 0.5
    parents = [
        scene.document.parent_chain(ids["stick"], frame)[1].id for frame in (5, 7, 14, 19, 30)
    ]
    assert parents == [ids[name] for name in ("head", "hat", "head", "hat", "hat")]
    use(lambda robot: robot.item_click("**/Delete parent key###joint"))
    assert (
        scene.document.layer(ids["stick"]).attachments == document.layer(ids["stick"]).attachments
    )


def test_a_layer_is_looked_at_alone_while_exports_have_all(window, scene, ids):
    def blue():
        return np.count_nonzero(np.asarray(window.picture())[..., 2] > 150)

    window.settle()
    whole = blue()
    window.act(solo_layers, ids["stick"])
    window.settle()
    assert blue() < whole / 2
    assert layer_at(scene, 120 + 100j) is None
    assert len(scene.document.exported_layers) == 5
    window.act(solo_layers, ids["stick"])
    window.settle()
    assert blue() == whole
    # What is deleted is looked at no more, and all others again.
    window.act(solo_layers, ids["hat"])
    window.act(delete_layers, ids["hat"])
    window.settle()
    assert scene.layer_list.solo == frozenset()


def test_several_layers_get_keys_together_and_go_together(window, scene, ids):
    for name in ("hat", "head"):
        layer = scene.document.layer(ids[name])
        command = key_commands.insert_key(layer.id, 24, layer.keys[0].pose)
        window.act(editing.edit_document, command)
    before = scene.document
    window.act(select_layers, ids["hat"], ids["head"])
    window.act(playback.seek, 12)
    window.act(insert_key)
    window.settle()
    for name in ("hat", "head"):
        assert 12 in scene.document.layer(ids[name]).key_frames
    window.act(editing.undo)
    assert scene.document is before
    window.act(delete_layers, *scene.selected_layers)
    window.settle()
    assert {layer.name for layer in scene.document.layers} == {"stick", "ah", "oh"}
    window.act(delete_layers, *(layer.id for layer in scene.document.layers))
    assert "at least one layer" in window.session.notices.toasts[-1].text


def test_what_is_hidden_at_all_times_is_switched_instead(window, scene, ids, use):
    window.act(toggle_layers_hidden, ids["hat"])
    window.act(set_active_layer, ids["hat"])
    window.act(playback.seek, 8)
    window.frames(3)
    use(lambda robot: robot.item_click("**/Show from frame 8 on"))
    assert "hat" not in seen(scene, 7)
    assert "hat" in seen(scene, 8)
    assert not scene.document.layer(ids["hat"]).hidden


def test_group_of_mouths_is_offered_as_a_switch(window, scene, ids, use):
    command = group_commands.group_layers([ids["ah"], ids["oh"]], "mouth")
    window.act(editing.edit_document, command)
    window.frames(3)
    use(lambda robot: robot.item_click("**/Create switch"))
    (switch_group,) = scene.document.switch_groups
    assert (switch_group.name, set(switch_group.members)) == ("mouth", {ids["ah"], ids["oh"]})
    window.act(editing.undo)
    window.frames(3)
    use(lambda robot: robot.item_click("**/No"))
    assert scene.layer_list.dismissed_suggestions == {"mouth"}


def test_no_row_moves_while_a_folded_group_is_dragged(window, scene, ids, use):
    command = group_commands.group_layers([ids["ah"], ids["oh"]], "mouth")
    window.act(editing.edit_document, command)
    window.act(set_active_layer, ids["hat"])
    window.frames(3)
    key = next(row.key for row in scene.tree if row.group)
    group = next(row for row in scene.tree if row.group)
    if group.is_open:
        window.act(toggle_tree_row, group.toggle)
    window.frames(3)
    before, places = [row.key for row in scene.tree], []

    def drag(robot):
        places.append(robot.item_info(row_of(ids["hat"])).rect_full.min.y)
        robot.mouse_move(row_of(key))
        robot.mouse_down(0)
        goal = robot.item_info(row_of(ids["stick"])).rect_full.get_center()
        robot.mouse_move_to_pos(goal)
        robot.yield_(2)
        places.append(robot.item_info(row_of(ids["hat"])).rect_full.min.y)
        assert [row.key for row in scene.tree] == before
        robot.key_press(window.Key.escape)
        robot.mouse_up(0)

    use(drag)
    assert places[0] == places[1]
    assert scene.selection.active == ids["hat"]


def test_folded_group_opens_under_a_drag_that_rests_and_takes_the_drop(window, scene, ids, use):
    command = group_commands.group_layers([ids["ah"], ids["oh"]], "mouth")
    window.act(editing.edit_document, command)
    window.act(set_active_layer, ids["hat"])
    window.frames(3)

    def group():
        return next(row for row in scene.tree if row.group)

    if group().is_open:
        window.act(toggle_tree_row, group().toggle)
        window.frames(3)
    opened = []

    def drag(robot):
        robot.mouse_move(row_of(ids["stick"]))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(robot.item_info(row_of(group().key)).rect_full.get_center())
        for _ in range(3):
            robot.yield_(15)
            opened.append(group().is_open)
        rect = robot.item_info(row_of(ids["ah"])).rect_full
        place = ImVec2(rect.get_center().x, rect.max.y - 0.1 * rect.get_height())
        robot.mouse_move_to_pos(place)
        robot.yield_(2)
        robot.mouse_up(0)
        robot.yield_(2)

    use(drag)
    assert opened == [False, False, True], "after 0.6 s"
    front = [row.layer.name for row in scene.tree if row.layer]
    assert front.index("stick") == front.index("ah") + 1, "it lands where the line was"


def test_a_group_is_dragged_by_its_row(window, scene, ids, use):
    for names, path in ((("ah", "oh"), "mouth"), (("head", "stick"), "body")):
        command = group_commands.group_layers([ids[name] for name in names], path)
        window.act(editing.edit_document, command)
    window.frames(3)

    def key(name):
        return next(row.key for row in scene.tree if row.group and row.name == name)

    def inside(path):
        return {each.name for each in scene.document.layers if each.group == path}

    # Onto a layer, all its layers are attached.
    before = scene.document
    use(lambda robot: drop(robot, key("mouth"), ids["hat"]))
    window.settle()
    assert [scene.document.layer(ids[name]).has_parent for name in ("ah", "oh")] == [True, True]
    assert scene.history.undo_label == "Attach 2 layers"
    window.act(editing.undo)
    assert scene.document is before
    # Onto another group, it is one in that.
    use(lambda robot: drop(robot, key("mouth"), key("body")))
    assert inside("body/mouth") == {"ah", "oh"}
    window.act(editing.undo)
    assert scene.document is before
    # Beside a layer, it lies there.
    use(lambda robot: drop(robot, key("body"), ids["hat"], 0.1))
    assert inside("body") == {"head", "stick"}
    assert [each.name for each in scene.document.layers].index("hat") == 0
    window.act(editing.undo)
    assert scene.document is before


def test_a_group_in_a_group_of_mouths_switches_as_one(window, scene, ids, use):
    for names, path in ((("ah", "oh", "hat", "stick"), "mouth"), (("hat", "stick"), "mouth/laugh")):
        command = group_commands.group_layers([ids[name] for name in names], path)
        window.act(editing.edit_document, command)
    window.frames(3)
    key = next(row.key for row in scene.tree if row.group and row.group.name == "mouth")

    def choose_create_switch(robot):
        robot.item_click(row_of(key), 1)
        robot.item_click("//$FOCUSED/Create switch")
        robot.key_press(int(window.Key.escape))

    use(choose_create_switch)
    (switch_group,) = scene.document.switch_groups
    assert set(switch_group.members) == {ids["ah"], ids["oh"], "mouth/laugh"}
    window.act(key_switch, "mouth/laugh")
    assert scene.document.switch_group(switch_group.name).member_at(0) == "mouth/laugh"


def test_a_layer_is_moved_and_ordered_in_time_by_the_tab(window, scene, ids, use):
    window.act(set_active_layer, ids["stick"])
    window.act(playback.seek, 12)
    window.frames(3)
    before = place(scene, "stick", window)
    use(lambda robot: robot.item_input_value("**/##moved right", 25.0))
    assert abs(place(scene, "stick", window) - before - 25) < 0.5
    assert [key.frame for key in scene.document.layer(ids["stick"]).keys_of(TRANSFORM)] == [0, 12]
    window.act(playback.seek, 3)
    window.run(lambda robot: robot.item_click(f"###Timeline/**/row {ids['stick']}/keys 12"))
    assert playback.current_frame(window.session, scene) == 12
    window.frames(3)
    use(lambda robot: robot.item_click("**/key transform"))
    assert [key.frame for key in scene.document.layer(ids["stick"]).keys_of(TRANSFORM)] == [0]

    def paint_in_front(robot):
        robot.item_click("##painted")
        robot.item_click(f"//$FOCUSED/###in front of {ids['oh']}")

    use(paint_in_front)
    assert [each.id for each in layers_in_draw_order(scene.document, 11)][-1] == ids["oh"]
    assert [each.id for each in layers_in_draw_order(scene.document, 12)][-1] == ids["stick"]
    use(lambda robot: robot.item_click("**/key draw_order"))
    assert scene.document.layer(ids["stick"]).keys_of(DRAW_ORDER) == ()


def test_rows_of_the_timeline_have_the_menus_of_layers_groups_and_channels(window, scene, ids):
    def choose(item, entry):
        def play(robot):
            robot.set_ref("Timeline")
            robot.item_click(f"**/{item}", 1)
            robot.set_ref("//$FOCUSED")
            robot.item_click(f"**/{entry}")

        window.run(play)
        window.settle()

    window.act(select_layers, ids["hat"], ids["head"])
    choose(f"name {ids['head']}", "Hide 2 layers")
    assert [each.name for each in scene.document.layers if each.hidden] == ["head", "hat"]
    choose(f"name {ids['hat']}", "Group layers")
    assert len(scene.document.groups) == 1
    choose("name", "Select its layers")
    assert set(scene.selected_layers) == {ids["hat"], ids["head"]}
    window.show_tab("Handle")
    choose(f"name {ids['stick']}", "Rename…")
    assert is_in_front("Layers")
    window.run(lambda robot: robot.key_chars_replace_enter("pole"))
    assert scene.document.layer(ids["stick"]).name == "pole"
    window.act(set_active_layer, ids["oh"])
    window.act(channel_keys.insert_channel_key, Channel(OPACITY, ids["oh"]))
    window.act(timeline_drag.toggle_lanes, ids["oh"])
    playback.scrub(window.session, 9)
    choose(f"lane {OPACITY.name} {ids['oh']} None/name", "###Insert key")
    assert 9 in [key.frame for key in scene.document.layer(ids["oh"]).channels[OPACITY.name, None]]

"""Poses that travel between layers, as a person has them travel: by keys, menus and the library."""

import re

import numpy as np
import pytest
from imgui_bundle import imgui
from messages import says
from walkers import walker

from app.document import layer_commands, pose_channel
from app.document.rig.mirror_names import NO_PAIR
from app.editor.actions import editing, playback
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.layering.layer_selection import set_active_layer
from app.storage import save_project

CTRL, SHIFT, ALT = (
    int(key) for key in (imgui.Key.mod_ctrl, imgui.Key.mod_shift, imgui.Key.mod_alt)
)
COPY, PASTE = CTRL | int(imgui.Key.c), CTRL | int(imgui.Key.v)
COPY_ALL, SWAP = CTRL | ALT | int(imgui.Key.c), CTRL | SHIFT | int(imgui.Key.x)


def open_walker(window, folder):
    """Somebody with two legs, of which the near one is raised at frame 0."""
    path = folder / "walker.lissom"
    save_project(path, walker())
    project = window.open(path)
    # No test is to have it from another one's hands.
    project.file.lock.release()
    project.file.lock = project.file.path = None
    choose(window, "near leg")
    for handle, way in ((1, 18 + 8j), (2, -20 + 30j)):
        editing.select_handles(window.session, frozenset({handle}))
        nudge_handles(window.session, way)
        window.settle()
    editing.select_handles(window.session, frozenset())
    return project


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("walker")


@pytest.fixture(autouse=True)
def project(window, folder):
    return window.again(open_walker, folder)


def layer(window, name):
    layers = window.session.project.document.layers
    return next(each for each in layers if each.name == name)


def choose(window, name):
    set_active_layer(window.session, layer(window, name).id)
    window.settle()


def go(window, frame):
    playback.scrub(window.session, frame)
    window.settle()


def press(window, *chords):
    for chord in chords:
        window.run(lambda robot, chord=chord: robot.key_press(chord))
        window.settle()


def ways(window, name, frame):
    one = layer(window, name)
    targets = one.key(frame).pose.targets
    return [targets[each.id].position - each.position for each in one.handles]


def notices(window):
    return [toast.text for toast in window.session.notices.toasts]


def test_the_opposite_step_is_two_keys_away(window, project):
    before = project.document
    press(window, COPY_ALL)
    assert notices(window)[-1] == "Poses of 3 layers at frame 0 copied."
    go(window, 12)
    press(window, SWAP)
    near, far = ways(window, "near leg", 0), ways(window, "far leg", 0)
    np.testing.assert_allclose(ways(window, "far leg", 12), near, rtol=0, atol=1e-6)
    np.testing.assert_allclose(ways(window, "near leg", 12), far, rtol=0, atol=1e-6)
    assert notices(window)[-1] == "Pasted onto 3 layers."
    assert project.history.undo_label == "Paste swapped"
    editing.undo(window.session)
    assert project.document is before


def test_keys_that_are_chosen_in_the_timeline_are_swapped(window):
    ids = [layer(window, name).id for name in ("near leg", "far leg")]
    chosen = {pose_channel(each): frozenset({0}) for each in ids}
    editing.select_channel_keys(window.session, chosen)

    def copy(robot):
        robot.mouse_move("###Timeline/**/ruler")
        robot.key_press(COPY)
        robot.yield_(2)

    window.run(copy)
    go(window, 8)
    press(window, SWAP)
    near = ways(window, "near leg", 0)
    np.testing.assert_allclose(ways(window, "far leg", 8), near, rtol=0, atol=1e-6)
    assert layer(window, "body").key_frames == {0}


def test_a_pose_is_pasted_onto_the_layer_that_is_chosen_then(window):
    press(window, COPY)
    choose(window, "far leg")
    go(window, 6)
    press(window, PASTE)
    near = ways(window, "near leg", 0)
    np.testing.assert_allclose(ways(window, "far leg", 6), near, rtol=0, atol=1e-6)


def test_what_cannot_be_pasted_says_why_in_its_menu_and_at_its_keys(window, project):
    press(window, COPY)
    choose(window, "body")
    go(window, 6)
    before = project.document
    reason = "“body” has no handle called hip, knee or foot."
    window.session.notices.toasts = []
    press(window, PASTE)
    assert notices(window) == [reason]
    entry, tips = [], []

    def look(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_action(imgui.test_engine.TestAction.hover, "Edit/###Paste")
        for _ in range(60):
            robot.yield_()
        entry.append(robot.item_info("//$FOCUSED/###Paste").item_flags)
        windows = imgui.get_current_context().windows
        tips.extend(each for each in windows if each.active and "Tooltip" in each.name)
        robot.popup_close_all()

    window.run(look)
    assert entry[0] & int(imgui.ItemFlags_.disabled)
    assert tips, "the greyed entry says nothing"
    assert project.document is before


def test_the_library_offers_poses_of_layers_with_the_same_names(window):
    press(window, SHIFT | int(window.Key.k))
    window.show_tab("Animate")
    choose(window, "body")
    window.frames(3)

    def offered(robot):
        robot.set_ref("###Animate")
        return robot.item_exists("**/pose Pose 1")

    found = []
    window.run(lambda robot: found.append(offered(robot)))
    choose(window, "far leg")
    go(window, 10)
    window.run(lambda robot: found.append(offered(robot)))
    assert found == [False, True]
    window.run(lambda robot: (robot.set_ref("###Animate"), robot.item_click("**/pose Pose 1")))
    window.settle()
    near = ways(window, "near leg", 0)
    np.testing.assert_allclose(ways(window, "far leg", 10), near, rtol=0, atol=1e-6)


def test_pairs_are_edited_where_poses_are_flipped(window, project):
    window.show_tab("Animate")
    for name, to in (("near leg", "one"), ("far leg", "two")):
        editing.edit_document(
            window.session, layer_commands.rename_layer(layer(window, name).id, to)
        )

    def enter(robot, text):
        robot.set_ref("###Animate")
        robot.item_open("**/###flip")
        robot.item_click("**/##pairs")
        robot.key_chars_replace_enter(text)

    window.run(lambda robot: enter(robot, "L/R, one"))
    window.settle()
    assert any(re.search(says(NO_PAIR), text) for text in notices(window))
    window.run(lambda robot: enter(robot, "L/R, one/two"))
    window.settle()
    assert project.document.pairs == (("L", "R"), ("one", "two"))
    press(window, COPY_ALL)
    go(window, 12)
    window.run(lambda robot: (robot.set_ref("###Animate"), robot.item_click("**/###Paste swapped")))
    window.settle()
    near = ways(window, "one", 0)
    np.testing.assert_allclose(ways(window, "two", 12), near, rtol=0, atol=1e-6)

"""Handles that are suggested, locked, grouped, mirrored and pinned, through the widgets."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from app.document.commands.keys import (
    key_commands,
)
from app.document.keyframe import Target
from app.editor.actions import editing, playback
from app.editor.actions.layer_setup import handle_editing
from app.editor.actions.posing.handles import remove_handles
from app.editor.actions.posing.pose_drag import nudge_handles, pin_selected_handles, set_targets


@pytest.fixture
def play(window):
    """A function that lets the robot play in the tab of handles."""

    def act(body):
        def within(robot):
            robot.set_ref("//Handle")
            body(robot)

        window.show_tab("Handle")
        window.run(within)
        window.settle()

    return act


def places(project):
    return dict(
        zip(
            (handle.id for handle in project.layer.handles),
            map(complex, project.layer_runtime.shown.handle_positions),
            strict=True,
        )
    )


def drag(window, start, end, *, key=None):
    def act(robot):
        robot.mouse_move_to_pos(window.point(start))
        if key is not None:
            robot.key_down(int(key))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point((start + end) / 2))
        robot.mouse_move_to_pos(window.point(end))
        robot.mouse_up(0)
        if key is not None:
            robot.key_up(int(key))

    window.run(act)
    window.settle()


def click(window, place, key=None):
    def act(robot):
        robot.mouse_move_to_pos(window.point(place))
        if key is not None:
            robot.key_down(int(key))
        robot.mouse_click(0)
        if key is not None:
            robot.key_up(int(key))

    window.run(act)


def test_handles_are_suggested_and_taken_back_by_a_click(window, bar, play):
    remove_handles(window.session, frozenset({0, 1}))
    window.frames(2)
    before = bar.document
    play(lambda robot: robot.item_click("**/###Suggest handles"))
    width, height = bar.document.canvas
    found = sorted(handle.position.real / width for handle in bar.layer.handles)
    assert_allclose(found, [0.06, 0.5, 0.94], rtol=0, atol=0.06)
    assert_allclose(
        [handle.position.imag for handle in bar.layer.handles], height / 2, rtol=0, atol=20
    )
    assert bar.history.undo_label == "Add handles"
    window.run(lambda robot: robot.item_click("**/Take back"))
    assert bar.document is before


def test_suggestions_are_taken_back_after_other_steps(window, bar, play):
    play(lambda robot: robot.item_click("**/###Suggest handles"))
    suggested = {handle.id for handle in bar.layer.handles} - {0, 1}
    assert len(suggested) == 1, "there are handles at both ends already"
    editing.select_handles(window.session, frozenset({0}))
    handle_editing.toggle_handles_locked(window.session)
    window.run(lambda robot: robot.item_click("**/Take back"))
    assert [(handle.id, handle.locked) for handle in bar.layer.handles] == [(0, True), (1, False)]


def test_a_locked_handle_is_not_dragged_and_holds_its_place(window, bar, play):
    editing.select_handles(window.session, frozenset({0}))
    play(lambda robot: robot.item_click("**/###Lock"))
    assert bar.layer.handle(0).locked
    playback.seek(window.session, 24)
    window.settle()
    before = bar.document
    start = places(bar)[0]
    drag(window, start, start + 60j)
    drag(window, start, start + 60j, key=window.Key.mod_alt)
    nudge_handles(window.session, 5j)
    window.settle()
    assert bar.document is before, "neither dragged nor turned, nudged or deleted"
    assert bar.selection.handles == {0}, "but selected"
    other = places(bar)[1]
    # Far beyond the limits: a free handle would be drawn along.
    drag(window, other, other + 0.4 * bar.document.canvas[0])
    set_targets(window.session, {1: Target(position=4 * other)})
    window.settle()
    layer = bar.layer
    lags = layer.target_errors(layer.key(24).pose)
    assert lags[0] < 0.5
    assert lags[1] > 50
    play(lambda robot: robot.item_click("**/###handle 0"))
    play(lambda robot: robot.item_click("**/###Lock"))
    assert not bar.layer.handle(0).locked


def test_a_group_is_taken_together(window, bar, play):
    editing.select_all(window.session)
    play(lambda robot: robot.item_click("**/###Group"))
    assert {handle.group for handle in bar.layer.handles} == {"group 1"}
    editing.select_handles(window.session, frozenset())
    playback.seek(window.session, 24)
    window.settle()
    before = places(bar)
    drag(window, before[0], before[0] + 40j)
    assert bar.selection.handles == {0, 1}
    moved = places(bar)
    assert_allclose([moved[i] - before[i] for i in (0, 1)], 40j, rtol=0, atol=2)
    click(window, moved[1], window.Key.mod_shift)
    assert bar.selection.handles == frozenset()
    click(window, moved[1])
    assert bar.selection.handles == {0, 1}
    play(lambda robot: robot.item_click("**/###Ungroup"))
    assert {handle.group for handle in bar.layer.handles} == {""}
    click(window, moved[1])
    assert bar.selection.handles == {1}


def test_how_firmly_handles_hold_is_said_in_words(window, bar, play):
    editing.select_all(window.session)
    play(lambda robot: robot.item_click("**/hold/###Firm"))
    assert {handle.weight for handle in bar.layer.handles} == {10.0}
    editing.select_handles(window.session, frozenset({1}))
    play(lambda robot: robot.item_click("**/hold/###Soft"))
    assert [handle.weight for handle in bar.layer.handles] == [10.0, 0.1]


def test_pinned_handles_are_wanted_where_they_are(window, loose, play):
    width, height = loose.document.canvas
    set_targets(window.session, {1: Target(position=complex(3 * width, 0.5 * height))})
    window.settle()
    layer = loose.layer
    assert max(layer.target_errors(layer.key(24).pose).values()) > 20
    before = places(loose)
    editing.select_all(window.session)
    play(lambda robot: robot.item_click("**/###Pin here"))
    layer = loose.layer
    assert max(layer.target_errors(layer.key(24).pose).values()) < 1.0
    after = places(loose)
    assert_allclose([after[i] for i in (0, 1)], [before[i] for i in (0, 1)], rtol=0, atol=1.0)


def test_partners_are_made_and_found_by_their_names(window, bar, play):
    remove_handles(window.session, frozenset({1}))
    editing.select_handles(window.session, frozenset({0}))
    window.frames(2)
    play(lambda robot: robot.item_click("**/###Mirror"))
    one, other = bar.layer.handles
    assert (one.name, other.name) == ("handle 1.L", "handle 1.R")
    axis = bar.document.canvas[0] / 2
    assert_allclose(other.position, 2 * axis - one.position.conjugate(), rtol=0, atol=6)
    editing.undo(window.session)
    assert [handle.name for handle in bar.layer.handles] == ["handle 1"], "one step"
    editing.redo(window.session)
    editing.select_handles(window.session, frozenset({one.id}))
    play(lambda robot: robot.item_click("**/###Select partners"))
    assert bar.selection.handles == {other.id}
    np.testing.assert_equal(len(bar.layer.handles), 2)


def test_a_click_on_one_of_several_selected_leaves_it_alone_selected(window, loose):
    before = loose.document
    editing.select_handles(window.session, frozenset({0, 1}))
    seen = []

    def press(robot):
        robot.mouse_move_to_pos(window.point(places(loose)[1]))
        robot.mouse_down(0)
        robot.yield_(2)
        seen.append(loose.selection.handles)
        robot.mouse_up(0)

    window.run(press)
    assert seen == [{0, 1}], "until it is let go both might be dragged"
    assert loose.selection.handles == {1}
    assert loose.document is before
    editing.select_handles(window.session, frozenset({0, 1}))
    start = places(loose)
    drag(window, start[1], start[1] + 20 + 10j)
    assert loose.selection.handles == {0, 1}
    targets = loose.layer.key(24).pose.targets
    for identity in (0, 1):
        assert abs(targets[identity].position - start[identity] - 20 - 10j) < 1.5


def test_a_click_on_one_of_several_selected_selects_its_group(window, loose):
    editing.select_handles(window.session, frozenset({0, 1}))
    handle_editing.group_handles(window.session)
    click(window, places(loose)[1])
    assert loose.selection.handles == {0, 1}


@pytest.fixture
def short(window, loose):
    """The bar with a handle that is wanted elsewhere, and has not arrived."""
    place, pose = places(loose)[1], loose.layer.key(24).pose
    targets = {**pose.targets, 1: Target(position=place - 120 + 80j)}
    command = key_commands.replace_key_pose(0, 24, replace(pose, targets=targets))
    editing.edit_document(window.session, command)
    window.settle()
    assert abs(targets[1].position - place) > 4 * window.grip(loose)
    return loose


WAY = -15 + 12j


@pytest.mark.parametrize("at_target", [True, False])
def test_a_handle_that_has_not_arrived_is_taken_where_it_is_wanted_too(window, short, at_target):
    place, target = places(short)[1], short.layer.key(24).pose.targets[1].position
    begin = target if at_target else place
    drag(window, begin, begin + WAY)
    assert short.selection.handles == {1}
    assert (
        abs(short.layer.key(24).pose.targets[1].position - begin - WAY)
        < 2 / short.view_on(window.session.display.screen).scale
    )
    editing.undo(window.session)
    assert short.layer.key(24).pose.targets[1].position == target


def test_where_a_handle_is_wanted_it_is_selected_and_has_its_menu(window, short):
    before = short.document
    editing.select_handles(window.session, frozenset({0}))
    target = short.layer.key(24).pose.targets[1].position
    click(window, target)
    assert short.selection.handles == {1}
    assert short.document is before

    def lock(robot):
        robot.mouse_move_to_pos(window.point(target))
        robot.mouse_click(1)
        robot.item_click("//$FOCUSED/Lock")

    window.run(lock)
    assert short.layer.handle(1).locked


def test_a_handle_is_taken_only_where_something_is_seen_of_it(window, short):
    target = short.layer.key(24).pose.targets[1].position
    editing.select_handles(window.session, frozenset({1}))
    pin_selected_handles(window.session)
    window.settle()
    click(window, target)
    assert not short.selection.handles

"""What the pointer does in the viewport: who takes a press, and that it can be taken back whole."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from animations import round_document
from sessions import run_update_steps, session_of, settle

from app.document.commands import handle_commands, scene_commands
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import remove_handles
from app.editor.overlay_shapes import TagShape
from app.editor.tools import tool_pointer
from app.editor.tools.table import TOOLS
from app.editor.tools.tool import PointerHit
from app.storage import Preferences

LEFT, RIGHT, FREE = 40 + 45j, 80 + 45j, 60 + 60j


@pytest.fixture
def session(tmp_path):
    """A blob with two handles, the first of which is selected; one step can be done again."""
    document = round_document()
    for place in (LEFT, RIGHT):
        document = handle_commands.add_handle(0, place)(document)
    session = session_of(document, tmp_path)
    session.project.history.do(scene_commands.set_fps(12))
    session.project.history.undo()
    editing.select_handles(session, frozenset({0}))
    settle(session)
    return session


def frames(session, count=2):
    """Let the worker take some steps."""
    for _ in range(count):
        run_update_steps(session)
        assert session.jobs.wait_until_idle()
        session.jobs.deliver()


def drag(session, spot, *places):
    tool_pointer.press_pointer(session, spot)
    for place in places:
        tool_pointer.move_pointer(session, place)
        frames(session)


def state(project):
    unkeyed = project.history.preview_pose
    return (
        project.document,
        unkeyed,
        project.selection.handles,
        project.selection.frames,
        project.visible_drag,
    )


AT_LEFT, AT_RIGHT = PointerHit(place=LEFT, handle=0), PointerHit(place=RIGHT, handle=1)
ON_SHAPE, BESIDE = PointerHit(place=FREE, on_shape=True), PointerHit(place=5 + 5j)
ON_RING = PointerHit(place=LEFT + 20, on_shape=True, on_gizmo=True)


@pytest.mark.parametrize(
    ("spot", "name"),
    [
        (AT_LEFT, "PoseTool"),
        (ON_SHAPE, "PoseTool"),
        (replace(ON_SHAPE, alt=True), "PoseTool"),
        (replace(AT_LEFT, alt=True), "RotateTool"),
        (ON_RING, "RotateTool"),
        (replace(AT_LEFT, ctrl=True), "AnchorTool"),
        (replace(ON_SHAPE, ctrl=True), "AnchorTool"),
        (replace(AT_LEFT, shift=True), "SelectTool"),
        (replace(ON_SHAPE, shift=True), "SelectTool"),
        (BESIDE, "SelectTool"),
        (replace(BESIDE, ctrl=True), "SelectTool"),
        (replace(BESIDE, ctrl=True, shift=True), "MoveTool"),
    ],
)
def test_a_press_is_for_one_tool(session, spot, name):
    tool_pointer.press_pointer(session, spot)
    assert type(session.tools.active_tool).__name__ == name


@pytest.mark.parametrize(("auto_key", "most_keys"), [(True, 3), (False, 1)])
def test_whatever_a_press_began_is_taken_back_wholly(session, auto_key, most_keys):
    project = session.project
    session.settings.preferences = Preferences(auto_key=auto_key)
    flags = [
        dict(zip(("ctrl", "shift", "alt"), held, strict=True))
        for held in product((0, 1), repeat=3)
        if sum(held) <= most_keys
    ]
    for spot in (AT_LEFT, AT_RIGHT, ON_SHAPE, BESIDE, ON_RING):
        for held in flags:
            before = state(project)
            drag(session, replace(spot, **held), spot.place + 6, spot.place + 9j)
            assert session.tools.active_tool is not None, (spot, held)
            tool_pointer.cancel_tool(session)
            frames(session)
            assert state(project) == before, (spot, held)
            assert session.tools.active_tool is None
            # What could be done again still can.
            assert project.history.redo_label == "Set frames per second"
            # The hand goes on, and lets go.
            tool_pointer.move_pointer(session, spot.place + 20)
            tool_pointer.release_pointer(session, spot.place + 20)
            frames(session)
            assert state(project) == before, (spot, held)


def test_a_press_on_the_shape_that_is_dragged_is_one_step(session):
    project, first = session.project, session.project.document
    drag(session, ON_SHAPE, FREE + 8, FREE + 8 + 8j)
    tool_pointer.release_pointer(session, FREE + 8 + 8j)
    settle(session)
    assert len(project.layer.handles) == 3
    target = project.layer.keys[0].pose.targets[2].position
    assert abs(target - (FREE + 8 + 8j)) < 1e-9
    editing.undo(session)
    assert project.document is first
    editing.redo(session)
    assert len(project.layer.handles) == 3


def test_undo_before_the_solver_has_begun_takes_the_new_handle_back(session):
    project, first = session.project, session.project.document
    tool_pointer.press_pointer(session, ON_SHAPE)
    tool_pointer.move_pointer(session, FREE + 8)
    assert len(project.layer.handles) == 3
    editing.undo(session)
    assert project.document is first
    settle(session)
    assert project.document is first


def test_selected_handles_are_pulled_together(session):
    project = session.project
    editing.select_handles(session, frozenset({0, 1}))
    drag(session, AT_RIGHT, RIGHT + 6j)
    tool_pointer.release_pointer(session, RIGHT + 6j)
    settle(session)
    targets = project.layer.keys[0].pose.targets
    assert [targets[i].position for i in (0, 1)] == pytest.approx([LEFT + 6j, RIGHT + 6j])
    # One that is not selected alone.
    editing.select_handles(session, frozenset({0}))
    drag(session, PointerHit(place=RIGHT + 6j, handle=1), RIGHT)
    tool_pointer.release_pointer(session, RIGHT)
    settle(session)
    targets = project.layer.keys[0].pose.targets
    assert [targets[i].position for i in (0, 1)] == pytest.approx([LEFT + 6j, RIGHT])


def test_a_turn_begins_where_the_pointer_leaves_the_handle(session):
    end = RIGHT + 15j * np.exp(0.2j)
    drag(session, replace(AT_RIGHT, alt=True), RIGHT + 15j, end)
    assert session.tools.active_tool.turning.angle == pytest.approx(0.2)
    assert tags(session) == ["+11°"]
    tool_pointer.release_pointer(session, end)
    settle(session)
    target = session.project.layer.keys[0].pose.targets[1]
    assert target.rotation == pytest.approx(0.2)


def test_a_click_with_alt_deletes_and_one_on_the_ring_does_not(session):
    for spot, left in ((ON_RING, 2), (replace(AT_LEFT, alt=True), 1)):
        tool_pointer.press_pointer(session, spot)
        tool_pointer.release_pointer(session, spot.place)
        assert len(session.project.layer.handles) == left


def test_the_anchor_goes_to_where_it_is_set_and_back_by_a_second_click(session):
    project = session.project
    for anchor in (RIGHT, None):
        tool_pointer.press_pointer(session, replace(AT_RIGHT, ctrl=True))
        tool_pointer.release_pointer(session, RIGHT)
        assert project.layer.anchor == anchor
    tool_pointer.press_pointer(session, replace(ON_SHAPE, ctrl=True))
    tool_pointer.release_pointer(session, FREE)
    assert project.layer.anchor == pytest.approx(FREE)


@pytest.mark.parametrize("shift", [False, True])
def test_a_box_selects_what_is_in_it(session, shift):
    kept = {0} if shift else set()
    for corner, opposite, inside in (
        (RIGHT - 5 + 5j, RIGHT + 5 - 5j, {1}),
        (5 + 5j, RIGHT + 5 + 5j, {0, 1}),
        (RIGHT + 5 + 5j, 5 + 5j, {0, 1}),
        (5 + 5j, 10 + 10j, set()),
    ):
        editing.select_handles(session, frozenset({0}))
        tool_pointer.press_pointer(session, PointerHit(place=corner, shift=shift))
        tool_pointer.move_pointer(session, opposite)
        area, edge = session.tools.active_tool.shapes(opposite, 1.0)
        assert area.points == edge.points
        assert area.points[::2] == [corner, opposite]
        tool_pointer.release_pointer(session, opposite)
        assert session.project.selection.handles == inside | kept


def test_drag_ends_when_the_playhead_leaves_its_frame(session):
    """The pose comes to rest at its frame; later moves of the hand are void."""
    project, first = session.project, session.project.document
    drag(session, AT_RIGHT, RIGHT + 6j)
    playback.scrub(session, 10)
    tool_pointer.move_pointer(session, RIGHT + 9j)
    frames(session)
    assert project.layer.key_frames == {0}
    assert project.document is not first
    tool_pointer.cancel_tool(session)
    settle(session)
    assert project.document is first


def test_handles_that_go_while_they_are_dragged_are_let_be(session):
    for spot in (AT_RIGHT, replace(AT_RIGHT, alt=True)):
        drag(session, spot, RIGHT + 15j)
        remove_handles(session, frozenset({1}))
        settle(session)
        before = session.project.document
        tool_pointer.move_pointer(session, RIGHT + 20)
        tool_pointer.release_pointer(session, RIGHT + 20)
        settle(session)
        assert session.project.document is before
        editing.undo(session)
        editing.undo(session)
        settle(session)


@pytest.mark.parametrize("spot", [AT_LEFT, ON_SHAPE, BESIDE, ON_RING])
def test_there_is_a_hint_wherever_something_can_be_done(session, spot):
    hints = [hint for tool in TOOLS for hint in tool.hints(session, session.project, spot)]
    assert hints
    for hint in hints:
        held = dict.fromkeys(filter(None, hint.key.split("+")), True)
        there = ON_RING if "its ring" in hint.text else spot
        tool_pointer.press_pointer(session, replace(there, **held))
        named = type(session.tools.active_tool)
        assert hint in named.hints(session, session.project, spot)
        tool_pointer.cancel_tool(session)


def tags(session):
    """Return the texts that the active tool shows."""
    shapes = session.tools.active_tool.shapes(0j, 1.0)
    return [shape.text for shape in shapes if isinstance(shape, TagShape)]


def target(session, identity=0):
    settle(session)
    return session.project.layer.keys[0].pose.targets[identity]


def test_a_drag_goes_as_far_as_is_typed_whatever_the_pointer_does(session):
    drag(session, AT_LEFT, LEFT + 3)
    tool_pointer.type_in_tool(session, "4")
    tool_pointer.type_in_tool(session, "0")
    assert tags(session) == ["40 px"]
    tool_pointer.move_pointer(session, LEFT + 6j)
    assert target(session).position == pytest.approx(LEFT + 40j)
    tool_pointer.type_in_tool(session, "y")
    assert tags(session) == ["Y 40 px"]
    assert target(session).position == pytest.approx(LEFT - 40j)
    tool_pointer.release_pointer(session, LEFT)
    assert target(session).position == pytest.approx(LEFT - 40j)
    editing.undo(session)
    assert session.project.history.undo_label is None


def test_a_handle_that_was_only_pressed_goes_where_it_is_typed_to(session):
    drag(session, AT_LEFT)
    for character in "x-5":
        tool_pointer.type_in_tool(session, character)
    tool_pointer.release_pointer(session, LEFT)
    assert target(session).position == pytest.approx(LEFT - 5)


def test_turning_takes_degrees_and_goes_in_steps(session):
    drag(session, ON_RING, LEFT + 20 + 1j)
    tool_pointer.move_pointer_in_steps(session, LEFT + 20 * np.exp(1j * np.radians(38)))
    assert target(session).rotation == pytest.approx(np.radians(45))
    tool_pointer.move_pointer(session, LEFT + 20 * np.exp(1j * np.radians(38)))
    assert target(session).rotation == pytest.approx(np.radians(38))
    tool_pointer.type_in_tool(session, "-12.5")
    tool_pointer.move_pointer(session, LEFT + 20j)
    assert target(session).rotation == pytest.approx(np.radians(-12.5))
    tool_pointer.release_pointer(session, LEFT + 20j)
    assert target(session).rotation == pytest.approx(np.radians(-12.5))

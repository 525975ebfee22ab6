"""Turning and scaling several selected handles by the box around them."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from animations import round_document
from sessions import run_update_steps, session_of, settle

from app.document.commands import handle_commands
from app.editor.actions import editing
from app.editor.tools import tool_pointer
from app.editor.tools.table import is_on_gizmo
from app.editor.tools.tool import PointerHit, handle_places
from app.editor.tools.transform_tools.box import BoxGrip, TransformBox
from app.editor.tools.transform_tools.handle_box_tool import (
    change_handles_by_key,
    find_handle_box,
)
from engine.geometry import Similarity

LEFT, RIGHT, TOP = 40 + 45j, 80 + 45j, 60 + 65j
MIDDLE = 60 + 55j
EM = 2.0


@pytest.fixture
def session(tmp_path):
    """A blob with three handles, all selected."""
    document = round_document()
    for place in (LEFT, RIGHT, TOP):
        document = handle_commands.add_handle(0, place)(document)
    session = session_of(document, tmp_path)
    editing.select_all(session)
    settle(session)
    return session


def places(session):
    return np.array(list(handle_places(session.project).values()))


def grab(session, kind, way=0j):
    box = find_handle_box(session, session.project, EM)
    at = {"turn": box.knob_place(EM), "scale": box.place(way), "pivot": box.pivot}[kind]
    spot = PointerHit(place=at, on_shape=True, em=EM)
    assert is_on_gizmo(session, session.project, spot)
    return replace(spot, on_gizmo=True)


def drag(session, spot, to, *, in_steps=False, typed=""):
    tool_pointer.press_pointer(session, spot)
    move = tool_pointer.move_pointer_in_steps if in_steps else tool_pointer.move_pointer
    for share in (0.5, 1.0):
        move(session, spot.place + share * (to - spot.place))
        run_update_steps(session)
    if typed:
        tool_pointer.type_in_tool(session, typed)
    tool_pointer.release_pointer(session, to)
    settle(session)


def test_knob_turns_all_handles_around_the_middle_in_one_step(session):
    project, document = session.project, session.project.document
    spot, turn = grab(session, "turn"), cmath.exp(0.6j)
    drag(session, spot, MIDDLE + turn * (spot.place - MIDDLE))
    wanted = MIDDLE + turn * (np.array([LEFT, RIGHT, TOP]) - MIDDLE)
    np.testing.assert_allclose(places(session), wanted, rtol=0, atol=0.05)
    # The whole drawing turns as a rigid thing.
    mesh = project.layer_runtime.shown
    rest = mesh.mesh.domain.outline
    np.testing.assert_allclose(
        mesh.positions[: len(rest)], MIDDLE + turn * (rest - MIDDLE), rtol=0, atol=0.05
    )
    editing.undo(session)
    assert project.document is document


def test_corner_scales_both_ways_and_with_shift_by_one_factor(session):
    spot = grab(session, "scale", 1 + 1j)
    arm = spot.place - MIDDLE
    drag(session, spot, MIDDLE + complex(0.8 * arm.real, 0.9 * arm.imag))
    wanted = [MIDDLE + complex(0.8 * a.real, 0.9 * a.imag) for a in arms()]
    targets = session.project.layer.keys[0].pose.targets
    reached = [targets[i].position for i in sorted(targets)]
    np.testing.assert_allclose(reached, wanted, rtol=0, atol=1.5)
    editing.undo(session)
    settle(session)
    drag(session, spot, MIDDLE + complex(0.8 * arm.real, 0.9 * arm.imag), in_steps=True)
    box = find_handle_box(session, session.project, 0.0)
    size = box.high - box.low
    assert size.imag / size.real == pytest.approx(0.5, rel=0.03)


def arms():
    return [place - MIDDLE for place in (LEFT, RIGHT, TOP)]


def test_side_scales_one_direction_and_takes_typed_percents(session):
    spot = grab(session, "scale", 1)
    drag(session, spot, spot.place + 3 + 9j, typed="90")
    box = find_handle_box(session, session.project, 0.0)
    assert (box.high - box.low).real == pytest.approx(36, abs=0.5)
    assert (box.high - box.low).imag == pytest.approx(20, abs=0.5)


def test_turn_snaps_to_steps_and_takes_typed_degrees(session):
    spot = grab(session, "turn")
    wanted = MIDDLE + cmath.exp(0.5j) * (spot.place - MIDDLE)
    drag(session, spot, wanted, in_steps=True)
    moved = places(session)
    assert cmath.phase((moved[1] - moved[0]) / 40) == pytest.approx(math.radians(30), abs=1e-2)
    editing.undo(session)
    settle(session)
    drag(session, grab(session, "turn"), wanted, typed="-20")
    moved = places(session)
    assert cmath.phase((moved[1] - moved[0]) / 40) == pytest.approx(-math.radians(20), abs=1e-2)


def test_moved_pivot_moves_nothing_and_is_what_turns_around(session):
    project, document = session.project, session.project.document
    spot = grab(session, "pivot")
    drag(session, spot, LEFT + 1)  # near a handle it goes to the handle
    assert project.document is document
    assert project.selection.pivot == pytest.approx(LEFT)
    spot = grab(session, "turn")
    drag(session, spot, LEFT + cmath.exp(0.4j) * (spot.place - LEFT))
    assert places(session)[0] == pytest.approx(LEFT, abs=0.05)
    assert places(session)[1] == pytest.approx(LEFT + 40 * cmath.exp(0.4j), abs=0.05)
    spot = replace(grab(session, "pivot"), is_double=True)
    tool_pointer.press_pointer(session, spot)
    tool_pointer.release_pointer(session, spot.place)
    assert project.selection.pivot is None


def test_escape_brings_back_the_pose_and_the_pivot(session):
    project, document = session.project, session.project.document
    for kind, to in (("pivot", 50 + 50j), ("turn", 20 + 20j), ("scale", 99 + 99j)):
        tool_pointer.press_pointer(session, grab(session, kind, 1 + 1j))
        tool_pointer.move_pointer(session, to)
        run_update_steps(session)
        tool_pointer.cancel_tool(session)
        settle(session)
        assert project.document is document, kind
        assert project.selection.pivot is None, kind


def test_locked_handles_stay_and_selecting_others_puts_the_pivot_back(session):
    project = session.project
    project.history.do(handle_commands.lock_handles(0, {2}, locked=True))
    settle(session)
    box = find_handle_box(session, project, 0.0)
    assert box.pivot == pytest.approx(60 + 45j)
    project.selection.set_pivot(70 + 45j)
    spot = grab(session, "turn")
    drag(session, spot, 70 + 45j + 1j * (spot.place - 70 - 45j))
    assert project.layer.keys[0].pose.targets[2].position == pytest.approx(TOP)
    editing.select_handles(session, frozenset({0, 1}))
    assert project.selection.pivot is None
    editing.select_handles(session, frozenset({0, 2}))
    assert find_handle_box(session, project, EM) is None, "one of two is locked"


def test_arrow_keys_turn_and_scale_on_and_on(session):
    for _ in range(3):
        change_handles_by_key(session, 0.1, 1.0)
    settle(session)
    moved = places(session)
    assert cmath.phase((moved[1] - moved[0]) / 40) == pytest.approx(0.3, abs=1e-3)
    editing.select_handles(session, frozenset({1}))
    change_handles_by_key(session, 0.1, 1.0)
    settle(session)
    assert session.project.layer.keys[0].pose.targets[1].rotation == pytest.approx(0.4, abs=1e-2)


def test_box_is_the_same_in_other_coordinates():
    box = TransformBox.around([1 + 2j, 5 + 3j], cmath.exp(0.3j), 0.5)
    motion = Similarity(2 * cmath.exp(1.1j), 3 - 4j)
    moved = box.moved_by(motion)
    for way in (1 + 1j, -1, 1j, 0):
        wanted = motion.factor * box.place(way) + motion.shift
        assert moved.place(way) == pytest.approx(wanted, abs=1e-12)
    assert moved.find_grip(moved.place(1 - 1j), 0.5) == BoxGrip("scale", 1 - 1j)


@pytest.mark.parametrize("degrees", [90, 180, -135])
def test_whole_drawing_turns_by_a_large_typed_angle(session, degrees):
    spot = grab(session, "turn")
    drag(session, spot, spot.place, typed=str(degrees))
    turn = cmath.exp(1j * math.radians(degrees))
    shown = session.project.layer_runtime.shown
    rest = shown.mesh.domain.outline
    np.testing.assert_allclose(
        shown.positions[: len(rest)], MIDDLE + turn * (rest - MIDDLE), rtol=0, atol=1e-3
    )

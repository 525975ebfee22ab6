"""Turning, scaling and pulling attached layers in the mode Move, by keys of their transforms."""

import cmath
import math

import numpy as np
import pytest
from animations import round_document
from sessions import run_update_steps, session_of, settle

from app.document import (
    IK_TARGET,
    TRANSFORM,
    Channel,
    Transform,
    joint_commands,
    shape_commands,
    shared_bone,
)
from app.editor.actions import editing, playback
from app.editor.actions.timing.channel_keys import set_channel_value
from app.editor.layering import layer_posing
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import attach_layer, detach_layer
from app.editor.tools import move_tool, tool_pointer
from app.editor.tools.tool import PointerHit
from app.editor.tools.transform_tools.layer_box_tool import (
    change_layer_by_key,
    find_layer_box,
)

HIP, KNEE, ANKLE = 40 + 70j, 60 + 45j, 80 + 25j
BODY, THIGH, SHIN, FOOT = range(4)
EM = 4.0


@pytest.fixture
def session(tmp_path):
    """Four blobs, each attached to the one before, in the mode Move."""
    session = session_of(round_document(), tmp_path)
    settle(session)
    for layer, place in ((THIGH, HIP), (SHIN, KNEE), (FOOT, ANKLE)):
        duplicate_layer(session, 0)
        settle(session)
        session.project.history.do(shape_commands.set_anchor(layer, place))
        settle(session)
        attach_layer(session, layer, layer - 1, place=place)
        settle(session)
    move_tool.toggle_move_tool(session)
    return session


def placements(session):
    return [session.project.runtimes.layers[layer].shown.placement for layer in range(4)]


def joints(session):
    places = (HIP, KNEE, ANKLE)
    return [
        complex(placed.apply(np.array([at]))[0])
        for placed, at in zip(placements(session)[1:], places, strict=True)
    ]


def drag(session, spot, to, *, in_steps=False):
    """Drag from a hit to a place of the scene."""
    tool_pointer.press_pointer(session, spot)
    move = tool_pointer.move_pointer_in_steps if in_steps else tool_pointer.move_pointer

    def local():
        return session.project.layer_runtime.shown.placement.apply_inverse(to)

    for _ in range(2):
        move(session, local())
        run_update_steps(session)
    tool_pointer.release_pointer(session, local())
    settle(session)


def pull(session, layer, start, to, **held):
    set_active_layer(session, layer)
    settle(session)
    place = session.project.layer_runtime.shown.placement.apply_inverse(start)
    in_steps = held.pop("in_steps", False)
    spot = PointerHit(place=place, layer=layer, on_shape=True, em=EM, **held)
    drag(session, spot, to, in_steps=in_steps)


def test_pulled_foot_bends_thigh_and_shin_and_keeps_its_angle(session):
    document, before = session.project.document, joints(session)
    poses = [layer.keys for layer in document.layers]
    way = -8 + 5j
    pull(session, FOOT, ANKLE + 3, ANKLE + 3 + way)
    after = joints(session)
    assert after[0] == pytest.approx(before[0], abs=1e-9)
    assert after[2] == pytest.approx(before[2] + way, abs=1e-6)
    assert abs(after[1] - after[0]) == pytest.approx(abs(before[1] - before[0]), abs=1e-6)
    assert placements(session)[FOOT].factor == pytest.approx(1, abs=1e-9)
    assert session.project.history.undo_label == "Turn layer"
    keyed = [bool(each.keys_of(TRANSFORM)) for each in session.project.document.layers]
    assert keyed == [False, True, True, True]
    assert [each.keys for each in session.project.document.layers] == poses, "nothing is solved"
    editing.undo(session)
    assert session.project.document is document


def test_pulled_foot_turns_alone_with_ctrl(session):
    before = joints(session)
    pull(session, FOOT, ANKLE + 10, ANKLE + 10j, in_steps=True)
    assert joints(session) == pytest.approx(before, abs=1e-9)
    assert placements(session)[FOOT].factor == pytest.approx(1j, abs=1e-6)


def test_pulled_shin_bends_with_the_thigh(session):
    grabbed, goal = ANKLE, ANKLE + 4 + 6j
    pull(session, SHIN, grabbed, goal)
    assert joints(session)[2] == pytest.approx(goal, abs=1e-6), "the foot goes along"


def test_thigh_of_a_branching_body_turns_at_the_hip(session):
    pull(session, THIGH, HIP + 10, HIP + 10j)
    assert placements(session)[THIGH].factor == pytest.approx(1j, abs=1e-6)
    assert joints(session)[0] == pytest.approx(HIP, abs=1e-9)


def test_shift_moves_a_layer_off_its_joint(session):
    pull(session, SHIN, KNEE, KNEE + 5 - 2j, shift=True)
    assert joints(session)[1] == pytest.approx(KNEE + 5 - 2j, abs=1e-6)
    assert session.project.history.undo_label == "Move layer"


def grab(session, kind, way=0j):
    """Return a hit of a grip of the active layer's box, and the grip's place in the scene."""
    shown = session.project.layer_runtime.shown.placement
    box = find_layer_box(session, session.project, EM)
    places = {"turn": box.knob_place(EM), "scale": box.place(way), "pivot": box.pivot}
    spot = PointerHit(place=places[kind], on_gizmo=True, em=EM)
    return spot, complex(shown.apply(np.array([places[kind]]))[0])


def test_box_turns_and_scales_at_the_joint(session):
    set_active_layer(session, SHIN)
    settle(session)
    spot, at = grab(session, "turn")
    drag(session, spot, KNEE + 1j * (at - KNEE))
    assert placements(session)[SHIN].factor == pytest.approx(1j, abs=1e-6)
    assert joints(session)[1] == pytest.approx(KNEE, abs=1e-9)
    spot, at = grab(session, "scale", 1 + 1j)
    drag(session, spot, KNEE + 1.5 * (at - KNEE))
    assert placements(session)[SHIN].factor == pytest.approx(1.5j, abs=1e-6)
    assert placements(session)[FOOT].factor == pytest.approx(1.5j, abs=1e-6)
    transform = session.project.document.layer(SHIN).keys_of(TRANSFORM)[0].value
    assert transform.turn == pytest.approx(math.pi / 2)


def test_moved_pivot_of_a_layer_stays_where_it_is(session):
    set_active_layer(session, SHIN)
    pull(session, SHIN, KNEE + 20, KNEE + 15 + 8j)
    before, document = placements(session), session.project.document
    spot, at = grab(session, "pivot")
    goal = at + 9 - 4j
    drag(session, spot, goal)
    assert session.project.document is document, "the picture does not move"
    assert session.project.selection.pivot == pytest.approx(goal)
    for kind, way, factor in (("turn", 0j, 1j), ("scale", 1 - 1j, 0.7)):
        spot, at = grab(session, kind, way)
        drag(session, spot, goal + factor * (at - goal))
    moved, point = placements(session), np.array([0j])
    for layer in (SHIN, FOOT):
        wanted = goal + 0.7j * (before[layer].apply(point) - goal)
        np.testing.assert_allclose(moved[layer].apply(point), wanted, rtol=0, atol=1e-6)
    assert moved[THIGH] == before[THIGH]
    editing.undo(session)
    editing.undo(session)
    assert session.project.document is document


def test_box_adds_up_full_turns_and_takes_typed_degrees(session):
    set_active_layer(session, SHIN)
    settle(session)
    spot, at = grab(session, "turn")
    tool_pointer.press_pointer(session, spot)
    for step in range(1, 16):
        shown = session.project.layer_runtime.shown.placement
        place = shown.apply_inverse(KNEE + (at - KNEE) * cmath.exp(0.5j * step))
        tool_pointer.move_pointer(session, place)
        run_update_steps(session)
    turn = session.project.document.layer(SHIN).keys_of(TRANSFORM)[0].value.turn
    assert turn == pytest.approx(7.5)
    tool_pointer.type_in_tool(session, "-30")
    tool_pointer.release_pointer(session, KNEE)
    turn = session.project.document.layer(SHIN).keys_of(TRANSFORM)[0].value.turn
    assert turn == pytest.approx(math.radians(-30))


def test_box_turns_the_ik_target_of_a_planted_layer(session):
    set_active_layer(session, FOOT)
    settle(session)
    layer_posing.plant_layer(session)
    settle(session)
    spot, at = grab(session, "turn")
    drag(session, spot, ANKLE + cmath.exp(0.4j) * (at - ANKLE))
    assert joints(session)[2] == pytest.approx(ANKLE, abs=1e-6)
    assert placements(session)[FOOT].factor == pytest.approx(cmath.exp(0.4j), abs=1e-6)


def test_arrow_keys_turn_and_scale_a_layer(session):
    set_active_layer(session, SHIN)
    settle(session)
    change_layer_by_key(session, 0.2, 1.0)
    settle(session)
    change_layer_by_key(session, 0.0, 1.1)
    settle(session)
    assert placements(session)[SHIN].factor == pytest.approx(1.1 * cmath.exp(0.2j), abs=1e-6)
    assert joints(session)[1] == pytest.approx(KNEE, abs=1e-9)


def test_first_key_at_a_later_frame_keeps_the_first_frame(session):
    playback.seek(session, 12)
    settle(session)
    pull(session, THIGH, HIP + 10, HIP + 10j)
    frames = [key.frame for key in session.project.document.layer(THIGH).keys_of(TRANSFORM)]
    assert frames == [0, 12]
    playback.seek(session, 0)
    settle(session)
    assert placements(session)[THIGH].factor == pytest.approx(1)


def test_planted_foot_stays_while_the_body_moves_and_is_released_without_a_jump(session):
    set_active_layer(session, FOOT)
    settle(session)
    layer_posing.plant_layer(session)
    playback.seek(session, 12)
    settle(session)
    move = Transform(shift=4 - 6j)
    set_channel_value(session, Channel(TRANSFORM, BODY), TRANSFORM.default)
    set_channel_value(session, Channel(TRANSFORM, BODY), move)
    settle(session)
    planted = placements(session)
    assert joints(session)[2] == pytest.approx(ANKLE, abs=1e-6)
    assert joints(session)[0] == pytest.approx(HIP + 4 - 6j, abs=1e-6)
    layer_posing.release_layer(session)
    settle(session)
    for before, after in zip(planted, placements(session), strict=True):
        np.testing.assert_allclose(after, before, rtol=0, atol=1e-6)
    playback.seek(session, 6)
    settle(session)
    assert joints(session)[2] == pytest.approx(ANKLE, abs=1e-6)
    assert [key.value.mix for key in session.project.document.layer(FOOT).keys_of(IK_TARGET)] == [
        1.0,
        0.0,
    ]


def test_pulled_layer_with_a_target_keys_the_target(session):
    set_active_layer(session, FOOT)
    layer_posing.plant_layer(session)
    settle(session)
    pull(session, FOOT, ANKLE, ANKLE - 6 + 6j)
    assert joints(session)[2] == pytest.approx(ANKLE - 6 + 6j, abs=1e-6)
    (key,) = session.project.document.layer(FOOT).keys_of(IK_TARGET)
    assert key.value.place == pytest.approx(ANKLE - 6 + 6j, abs=1e-6)


def test_knee_bends_the_other_way_by_one_click(session):
    pull(session, FOOT, ANKLE, ANKLE - 15 + 10j)
    before = joints(session)
    set_active_layer(session, SHIN)
    layer_posing.flip_layer_limb(session)
    settle(session)
    after = joints(session)
    assert after[2] == pytest.approx(before[2], abs=1e-6)
    way = before[2] - before[0]
    mirrored = before[0] + way * ((before[1] - before[0]) / way).conjugate()
    assert after[1] == pytest.approx(mirrored, abs=1e-6)


def test_anchor_of_an_attached_layer_moves_without_the_picture(session):
    pull(session, SHIN, KNEE + 20, KNEE + 20j)
    before = placements(session)
    set_active_layer(session, SHIN)
    settle(session)
    session.tools.select("pose")
    place = 62 + 40j
    spot = PointerHit(place=place, on_shape=True, ctrl=True)
    tool_pointer.press_pointer(session, spot)
    tool_pointer.release_pointer(session, place)
    settle(session)
    assert session.project.document.layer(SHIN).anchor == pytest.approx(place, abs=1e-6)
    for one, other in zip(before, placements(session), strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-6)


def test_detached_layer_keeps_its_place_and_its_scale(session):
    transform = Transform(scale=1.5, turn=0.4)
    layer_posing.set_transforms(session, {THIGH: transform}, label="Scale layer")
    settle(session)
    shown = session.project.runtimes.layers[SHIN].shown
    before = shown.placement.apply(shown.positions)
    detach_layer(session, SHIN)
    settle(session)
    shown = session.project.runtimes.layers[SHIN].shown
    np.testing.assert_allclose(shown.placement.apply(shown.positions), before, rtol=0, atol=1e-4)
    assert session.project.document.layer(SHIN).is_proven(session.project.layer.keys[0].pose)


def test_number_of_parents_that_bend_can_be_set(session):
    session.project.history.do(joint_commands.set_ik_parents(FOOT, 0))
    settle(session)
    pull(session, FOOT, ANKLE + 10, ANKLE + 10j)
    assert placements(session)[FOOT].factor == pytest.approx(1j, abs=1e-6)


def test_bone_of_a_planted_foot_is_not_turned_in_vain(session):
    set_active_layer(session, FOOT)
    layer_posing.plant_layer(session)
    settle(session)
    document = session.project.document
    pull(session, SHIN, KNEE + 5, KNEE + 9j)
    assert session.project.document is document
    toast = session.notices.toasts[-1].text
    assert "bends to the IK target of" in toast


def test_box_of_a_posed_root_turns_it_about_its_posed_anchor(session):
    set_active_layer(session, BODY)
    settle(session)
    session.project.history.do(shape_commands.set_anchor(BODY, HIP))
    settle(session)
    drag(session, PointerHit(place=HIP, layer=BODY, on_shape=True, em=EM), HIP + 20 + 10j)
    around = HIP + 20 + 10j
    shown = session.project.layer_runtime.shown
    before = shown.placement.apply(shown.positions)
    spot, at = grab(session, "turn")
    drag(session, spot, around + 1j * (at - around))
    shown = session.project.layer_runtime.shown
    wanted = around + 1j * (before - around)
    np.testing.assert_allclose(shown.placement.apply(shown.positions), wanted, rtol=0, atol=1e-3)


def test_anchor_of_a_turned_root_moves_without_the_picture(session):
    move = Transform(5 + 2j, 0.8, 1.3)
    layer_posing.set_transforms(session, {BODY: move}, label="Turn layer")
    settle(session)
    before = placements(session)
    session.project.history.do(shape_commands.set_anchor(BODY, 50 + 30j))
    settle(session)
    for one, other in zip(before, placements(session), strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9)


def test_bone_of_two_planted_layers_is_named(session):
    for layer in (FOOT, SHIN):
        set_active_layer(session, layer)
        session.project.history.do(joint_commands.set_ik_parents(layer, 2))
        settle(session)
        layer_posing.plant_layer(session)
        settle(session)
    found = shared_bone(session.project.document, FOOT, 0)
    assert found is not None
    assert [each.id for each in found] == [THIGH, SHIN]
    session.project.history.do(joint_commands.set_ik_parents(FOOT, 1))
    assert shared_bone(session.project.document, FOOT, 0) is None

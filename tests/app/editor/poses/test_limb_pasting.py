"""Poses pasted on a single limb, and poses of layers that turn at their joints."""

from functools import cache

import numpy as np
import pytest
from animations import round_document, still_document
from sessions import go, session_of, settle

from app.document import TRANSFORM, Transform, layer_commands, shape_commands
from app.editor.actions import editing
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.layer_posing import set_transforms
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import attach_layer
from app.editor.poses import copying, pasting, pasting_targets
from app.rigging import bend_side
from app.solving import pose_document
from app.solving.script.pose_script import parse_pose_script

PLACES = {
    "head": [200, 350],
    "hips": [200, 90],
    **{f"shoulder.{side}": [200 + way * 30, 300] for side, way in (("L", -1), ("R", 1))},
    **{f"elbow.{side}": [200 + way * 95, 302] for side, way in (("L", -1), ("R", 1))},
    **{f"hand.{side}": [200 + way * 165, 300] for side, way in (("L", -1), ("R", 1))},
}
BENT, AXIS = 9, 200


@cache
def figure():
    """A trunk with two arms, whose left one is bent upwards at frame 9."""
    picture = np.zeros((400, 400, 4), np.uint8)
    for left, right, bottom, top in ((150, 250, 60, 380), (15, 385, 285, 318)):
        picture[400 - top : 400 - bottom, left:right] = (200, 120, 60, 255)
    script = {
        "schema": 1,
        "handles": PLACES,
        "bones": [[f"{name}.{side}" for name in ("shoulder", "elbow", "hand")] for side in "LR"],
        "keys": [{"frame": 0}, {"frame": BENT, "targets": {"hand.L": [100, 380]}}],
    }
    parsed = parse_pose_script(script)
    return pose_document(still_document(picture), parsed, lambda _: None)[0]


@pytest.fixture
def session(tmp_path):
    session = session_of(figure(), tmp_path)
    settle(session)
    return session


def ids(session, *names):
    found = {handle.name: handle.id for handle in session.project.layer.handles}
    return [found[name] for name in names]


def places(session, frame):
    targets = session.project.layer.key(frame).pose.targets
    return {handle.name: targets[handle.id].position for handle in session.project.layer.handles}


def arm(session, frame, side):
    at = places(session, frame)
    return [at[f"{name}.{side}"] for name in ("shoulder", "elbow", "hand")]


def select(session, name):
    editing.select_handles(session, frozenset(ids(session, name)))


def test_pose_is_pasted_on_the_limb_of_the_selected_handle_alone(session):
    document, before = session.project.document, places(session, 0)
    go(session, BENT)
    copying.copy_pose_or_keys(session)
    go(session, 0)
    select(session, "elbow.L")
    pasting_targets.paste_on_limb(session, "as it is")
    settle(session)
    wanted, found = arm(session, BENT, "L"), arm(session, 0, "L")
    assert found[1:] == pytest.approx(wanted[1:], abs=5)
    assert bend_side(*found) == bend_side(*wanted) != 0
    after = places(session, 0)
    for name in ("head", "hips", "shoulder.R", "elbow.R", "hand.R"):
        # An arm raised as far as its limits allow pulls at the trunk.
        assert after[name] == pytest.approx(before[name], abs=5), name
    editing.undo(session)
    assert session.project.document is document


def test_pose_of_one_arm_is_flipped_onto_the_other(session):
    before = places(session, 0)
    go(session, BENT)
    copying.copy_pose_or_keys(session)
    go(session, 0)
    select(session, "hand.R")
    pasting_targets.paste_on_limb(session, "flipped")
    settle(session)
    mirrored = [2 * AXIS - place.conjugate() for place in arm(session, BENT, "L")]
    found = arm(session, 0, "R")
    assert found[1:] == pytest.approx(mirrored[1:], abs=6)
    assert bend_side(*found) == bend_side(*mirrored) != 0
    assert places(session, 0)["hand.L"] == pytest.approx(before["hand.L"], abs=0.5)


def test_flipped_pose_bends_the_other_elbow_to_its_mirrored_side(session):
    go(session, BENT)
    copying.copy_pose_or_keys(session)
    go(session, 5)
    pasting.paste_copied(session, "flipped")
    settle(session)
    mirrored = [2 * AXIS - place.conjugate() for place in arm(session, BENT, "L")]
    found = arm(session, 5, "R")
    assert found == pytest.approx(mirrored, abs=8)
    assert bend_side(*found) == bend_side(*mirrored) != 0


def test_pasting_on_a_limb_needs_a_handle_of_bones(session):
    copying.copy_pose_or_keys(session)
    select(session, "head")
    reason = pasting_targets.paste_on_limb_disabled_reason(session, session.project, "as it is")
    assert reason.startswith("Select a handle of a limb with bones first")


@pytest.fixture
def cut_out(tmp_path):
    """A body with two attached arms, of which the left one is turned at frame 6."""
    session = session_of(round_document(), tmp_path)
    settle(session)
    for layer, name, place in ((1, "arm.L", 30 + 45j), (2, "arm.R", 90 + 45j)):
        duplicate_layer(session, 0)
        settle(session)
        session.project.history.do(layer_commands.rename_layer(layer, name))
        session.project.history.do(shape_commands.set_anchor(layer, place))
        settle(session)
        attach_layer(session, layer, 0, place=place)
        settle(session)
    go(session, 6)
    set_transforms(session, {1: Transform(2 + 1j, 0.7, 1.2)}, label="Turn layer")
    settle(session)
    return session


@pytest.mark.parametrize(
    ("way", "wanted"),
    [("flipped", Transform(-2 + 1j, -0.7, 1.2)), ("swapped", Transform(2 + 1j, 0.7, 1.2))],
)
def test_pose_of_turned_layers_is_pasted_onto_their_partners(cut_out, way, wanted):
    copying.copy_all_poses(cut_out)
    go(cut_out, 12)
    set_active_layer(cut_out, 0)
    pasting.paste_copied(cut_out, way)
    settle(cut_out)
    left, right = (
        {key.frame: key.value for key in cut_out.project.document.layer(each).keys_of(TRANSFORM)}
        for each in (1, 2)
    )
    assert right[12] == wanted
    assert left[12] == Transform()
    assert right[0] == Transform(), "before its first key the arm stays as it was"


def test_pose_of_a_turned_layer_is_copied_by_itself(cut_out):
    set_active_layer(cut_out, 1)
    settle(cut_out)
    copying.copy_pose_or_keys(cut_out)
    go(cut_out, 3)
    pasting.paste_copied(cut_out)
    settle(cut_out)
    keys = cut_out.project.document.layer(1).keys_of(TRANSFORM)
    assert {key.frame: key.value for key in keys}[3] == Transform(2 + 1j, 0.7, 1.2)
    assert len(cut_out.project.document.layer(1).keys) == 1, "there was no pose to copy"

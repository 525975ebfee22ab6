"""Legs that touch in a drawing are parted when a motion preset is applied."""

from dataclasses import replace

import numpy as np
import pytest
from overlapping_legs import JOINTS, draw_person

from app.document import Meshing, handle_commands
from app.solving import MotionRequest, start_motion_solve, step_motion_solve
from app.solving.motion_preset import joint_guess
from app.storage import open_picture

FEW = Meshing(triangles=1500, detail="coarse")
WALK = MotionRequest(motion="walk", kind="biped-side", joints=JOINTS, facing=1)


@pytest.fixture(scope="module")
def person(tmp_path_factory):
    """The drawing as it was opened, and its picture."""
    path = tmp_path_factory.mktemp("person") / "person.png"
    draw_person("lines").save(path)
    opened = open_picture(path, FEW)
    layer = opened.document.layers[0]
    return replace(opened.document, fps=12), opened.pictures[layer.id].rgba


def leg_areas(layer, pose):
    """Return the areas of both legs in a pose, each over its area at rest."""
    mesh = layer.domain.mesh
    corners = mesh.vertices[mesh.triangles]
    places = layer.map_of(pose)(mesh.vertices)[mesh.triangles]
    joints = {handle.name: handle.position for handle in layer.handles}
    at = corners.mean(axis=1)
    found = []
    for one, other in ("RL", "LR"):
        mine = np.abs(at[:, None] - [joints[f"{name}.{one}"] for name in ("knee", "foot")])
        others = np.abs(at[:, None] - [joints[f"{name}.{other}"] for name in ("knee", "foot")])
        near = (mine.min(axis=1) < others.min(axis=1)) & (at.imag < joints["knee.R"].imag)
        found.append(area(places[near]).sum() / area(corners[near]).sum())
    return np.array(found)


def area(triangles):
    return ((triangles[:, 1] - triangles[:, 0]).conj() * (triangles[:, 2] - triangles[:, 0])).imag


def test_legs_keep_their_areas_when_they_are_parted(person):
    document, rgba = person
    solve = start_motion_solve(document, 0, WALK, rgba)
    assert solve.parted
    assert "parted along their drawn lines" in solve.notices[0]
    (line,) = solve.document.layer(0).cut_out.cut_lines
    assert len(line.points) > 10
    while not solve.is_solved:
        solve = step_motion_solve(solve)
    layer = solve.posed_layer
    assert not layer.is_stale
    assert layer.domain.closed is not None
    shares = np.array([leg_areas(layer, key.pose) for key in layer.keys])
    assert np.abs(shares - 1).max() < 0.12
    # Again the legs are apart already.
    again = start_motion_solve(solve.command(document), 0, WALK, rgba)
    assert not again.parted
    assert again.document.layer(0).cut_out.cut_lines == (line,)


def test_a_posed_handle_keeps_its_key_when_legs_are_parted(person):
    document, rgba = person
    document = handle_commands.add_handle(0, 148 + 460j, name="hat")(document)
    solve = start_motion_solve(document, 0, replace(WALK, first=0), rgba)
    assert solve.parted
    assert any(handle.name == "hat" for handle in solve.document.layer(0).handles)


def test_no_line_is_cut_through_a_handle(person):
    document, rgba = person
    line = start_motion_solve(document, 0, WALK, rgba).document.layer(0).cut_out.cut_lines[0]
    middle = complex(line.points[len(line.points) // 2])
    inside = document.layer(0).domain.nearest(np.array([middle])).tolist()[0]
    held = handle_commands.add_handle(0, inside, name="seam")(document)
    assert not start_motion_solve(held, 0, WALK, rgba).parted


def test_guessed_joints_are_apart_where_two_limbs_leave_the_body_at_one_place(person, monkeypatch):
    document, rgba = person
    meeting = {**JOINTS, "shoulder.L": 140 + 345j, "shoulder.R": 140 + 345j}
    monkeypatch.setattr(joint_guess, "suggest_joints", lambda *_: meeting)
    joints = joint_guess.guess_joints(document.layer(0), "biped-side", rgba).joints
    places = np.array(list(joints.values()))
    away = np.abs(places[:, None] - places) + np.eye(len(places)) * 1e9
    assert away.min() > 2

"""Springs of motion presets: the tip of a tail follows its base, late."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image, ImageDraw

from app.document import Document, Meshing, clip_of, find_motion_edits, track_commands
from app.motion import Animation
from app.rigging import Parameters
from app.solving import MotionRequest, start_motion_solve, step_motion_solve
from app.storage import load_project, open_picture, save_project

# A body that lies, with a long tail and one foot.
JOINTS = {
    "hips": 220 + 120j,
    "chest": 330 + 120j,
    "tail.1": 160 + 120j,
    "tail.2": 115 + 120j,
    "tail.3": 70 + 120j,
    "tail": 25 + 120j,
    "hip.R": 230 + 90j,
    "knee.R": 236 + 55j,
    "foot.R": 230 + 20j,
}
WAG = MotionRequest(motion="wag", kind="four-legs", joints=JOINTS, facing=1)


def apply_motion(document: Document, request: MotionRequest) -> Document:
    solve = start_motion_solve(document, document.layers[0].id, request)
    while not solve.is_over:
        solve = step_motion_solve(solve)
    return solve.command(document)


@pytest.fixture(scope="module")
def wagging(tmp_path_factory) -> Document:
    picture = Image.new("RGBA", (400, 200))
    draw = ImageDraw.Draw(picture)
    draw.ellipse([140, 30, 380, 130], fill="orchid")
    draw.rounded_rectangle([10, 70, 180, 90], 10, fill="orchid")
    draw.rounded_rectangle([218, 90, 244, 190], 10, fill="orchid")
    path = tmp_path_factory.mktemp("tail") / "tail.png"
    picture.save(path)
    opened = open_picture(path, Meshing(triangles=1000, detail="coarse")).document
    return apply_motion(replace(opened, fps=12), WAG)


def again(document: Document, **parameters: float) -> Document:
    """Apply the motion again, as the window does, with what was edited."""
    layer = document.layers[0]
    (motion,) = layer.motions
    request = replace(
        WAG,
        handles=motion.joints,
        parameters=Parameters(**parameters),
        edits=find_motion_edits(layer, motion),
        edited_period=motion.last - motion.start,
    )
    return apply_motion(document, request)


def test_tip_of_a_tail_swings_later_than_its_base_and_the_cycle_closes(wagging):
    layer = wagging.layers[0]
    (motion,) = layer.motions
    names = {handle: name for name, handle in motion.joints.items()}
    assert layer.springs == motion.springs
    assert [(names[each.handle], names[each.root]) for each in layer.springs] == [
        ("tail.3", "tail.2"),
        ("tail", "tail.2"),
    ]
    points = np.array([JOINTS[name] for name in ("tail.1", "tail.2", "tail.3", "tail")])
    sole = np.array([222 + 14j, 238 + 14j])
    moving = Animation(clip_of(wagging, layer.id), points=np.append(points, sole))
    frames = np.array([moving.positions(k) for k in range(motion.first, motion.last + 1)])
    assert_allclose(frames[-1], frames[0], atol=1e-6)
    # The tail swings twice in a cycle.
    angles = np.angle(np.diff(frames[:-1, :4], axis=1) / np.diff(points))
    base, middle, tip = np.fft.fft(angles, axis=0)[2]
    assert 0.2 < np.angle(base / middle) < np.angle(base / tip) < np.pi
    assert abs(tip) > abs(base)
    assert np.abs(frames[:, 4:] - frames[0, 4:]).max() < 0.3 * 400 / 1000


def test_springs_are_replaced_unless_they_were_edited(wagging):
    identity = wagging.layers[0].id
    tip = wagging.layers[0].springs[-1]
    slower = again(wagging, speed=0.5).layers[0]
    assert [each.frequency for each in slower.springs] == pytest.approx(
        [each.frequency / 2 for each in wagging.layers[0].springs]
    )
    edited = track_commands.put_spring(identity, replace(tip, lag=2.0))(wagging)
    kept = again(edited, speed=0.5)
    assert kept.layers[0].spring_of(tip.handle) == replace(tip, lag=2.0)
    assert len(kept.layers[0].springs) == 2
    assert again(kept).layers[0].spring_of(tip.handle) == replace(tip, lag=2.0)
    deleted = track_commands.remove_springs(identity, (tip.handle,))(wagging)
    assert again(deleted).layers[0].spring_of(tip.handle) is None


def test_springs_of_a_motion_survive_saving(wagging, tmp_path):
    save_project(tmp_path / "wag.lissom", wagging, thumbnail=None)
    read = load_project(tmp_path / "wag.lissom").layers[0]
    assert read.springs == read.motions[0].springs == wagging.layers[0].springs

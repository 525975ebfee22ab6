"""Pose sliders in pose scripts."""

from dataclasses import replace

import numpy as np
import pytest
from animations import bar_document
from messages import says
from numpy.testing import assert_allclose

from app.document import SLIDER, FrameRange, TangentMode, clip_of
from app.errors import LissomError
from app.motion import Animation
from app.solving import pose_document
from app.solving.script.pose_script import parse_pose_script
from app.storage import load_project, save_project

HANDLES = {"tip": [200, 40], "root": [40, 40]}
TURN = {
    "name": "turn",
    "poses": [
        {"at": -1, "targets": {"tip": [196, 52]}},
        {"at": 0, "targets": {}},
        {"at": 1, "targets": {"tip": [196, 28]}},
    ],
    "keys": [{"frame": 0, "value": -1}, {"frame": 20, "value": 1, "ease": "in-out"}],
}
PAD = {
    "name": "look",
    "poses": [
        {"at": [x, y], "targets": {"tip": [200 - 6 * x, 40 + 6 * y]}}
        for x in (0, 1)
        for y in (0, 1)
    ],
    "keys": [{"frame": 0, "value": [0, 0]}, {"frame": 20, "value": [1, 0.5], "passing": "stop"}],
    "delay": 2,
    "spring": {"preset": "hair"},
}


def script(*sliders, **changes):
    own = {"handles": HANDLES, "keys": [{"frame": 0}], "sliders": list(sliders)}
    return {"schema": 1, **own, **changes}


def posed(*sliders):
    document, notices = pose_document(
        bar_document(), parse_pose_script(script(*sliders)), lambda _: None
    )
    assert not notices
    return document


def test_script_makes_sliders_with_poses_and_keys(tmp_path):
    document = posed(TURN, PAD)
    layer = document.layers[0]
    turn, look = layer.sliders
    assert document.frames == FrameRange(0, 20)
    assert [(each.at, each.pose) for each in turn.poses] == [
        (-1, "turn -1"),
        (0, None),
        (1, "turn 1"),
    ]
    assert (look.is_pad, look.delay, look.spring) == (True, 2, (2.2, 0.35))
    assert turn.spring is None
    keys = layer.keys_of(SLIDER, "look")
    assert [key.value for key in keys] == [0, 1 + 0.5j]
    assert keys[1].tangent_mode is TangentMode.STOP
    points = np.array([handle.position for handle in layer.handles])
    found = Animation(clip_of(document, 0), points=points).positions(0)
    pose = layer.library_pose("turn -1").pose
    assert_allclose(found, layer.map_of(pose)(points), rtol=0, atol=1e-9)
    save_project(tmp_path / "bar.lissom", document)
    again = load_project(tmp_path / "bar.lissom")
    moved = Animation(clip_of(again, 0), points=points).positions(13)
    expected = Animation(clip_of(document, 0), points=points).positions(13)
    assert_allclose(moved, expected, rtol=0, atol=1e-9)


def test_script_drives_sliders_of_other_layers():
    bar = bar_document()
    other = replace(bar.layers[0], id=1, name="hair")
    document = replace(bar, layers=(*bar.layers, other))
    follower = {**TURN, "driver": bar.layers[0].name}
    del follower["keys"]
    own = {"handles": HANDLES, "keys": [{"frame": 0}]}
    layers = [
        {"layer": bar.layers[0].name, **own, "sliders": [TURN]},
        {"layer": "hair", **own, "sliders": [follower]},
    ]
    parsed = parse_pose_script({"schema": 1, "layers": layers})
    document, _ = pose_document(document, parsed, lambda _: None)
    ways = [Animation(clip_of(document, number)).positions(7) for number in (0, 1)]
    assert_allclose(*ways, rtol=0, atol=1e-6)


def with_poses(*poses, **changes):
    return script({**TURN, "poses": list(poses), **changes})


BAD = {
    "no poses": (with_poses(), "sliders[0]: The slider 'turn' needs at least two poses, not 0."),
    "twice": (with_poses({"at": 1}, {"at": 1}), "The slider 'turn' has two poses at 1"),
    "unknown handle": (
        with_poses({"at": 0}, {"at": 1, "targets": {"tail": [1, 2]}}),
        "sliders[0].poses[1] names the handle 'tail', which does not exist",
    ),
    "no number": (with_poses({"at": 0}, {"at": "x"}), "sliders[0].poses[1].at"),
    "nine poses": (with_poses(*({"at": n} for n in range(9))), "at most 8 poses in a row, not 9"),
    "a point": (
        script({**TURN, "keys": [{"frame": 0, "value": [0, 1]}]}),
        "the slider 'turn' is no pad, so its value is one number",
    ),
    "two of a name": (script(TURN, TURN), "there is another slider 'turn'; rename one of them"),
    "unknown field": (script({**TURN, "speed": 1}), "unknown field 'speed'"),
    "no keys": (script({**TURN, "keys": []}), "keys must be a list of at least one key"),
    "NaN": (with_poses({"at": 0}, {"at": float("nan")}), "sliders[0].poses[1].at"),
}


@pytest.mark.parametrize("case", BAD)
def test_script_refuses_bad_sliders_by_their_place(case):
    content, message = BAD[case]
    with pytest.raises(LissomError, match=says(message)):
        parse_pose_script(content)

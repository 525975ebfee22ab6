"""Footage in exported frames: exact to the frame, at any rate, speed and start."""

from dataclasses import replace
from fractions import Fraction
from math import floor

import numpy as np
import pytest
from footage_files import SIZE, numbered_colour, numbered_picture, write_numbered
from numpy.testing import assert_array_equal

from app.document import FOOTAGE_TIME, ExportSettings, FootageTime, FrameRange, rest_pose
from app.errors import LissomError
from app.export import ExportRequest, FrameRenderer, plan_export
from app.motion import Evaluator
from app.render.gpu.context import create_context
from app.storage import inspect_footage, open_footage_scene

COUNT = 20


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    first = write_numbered(tmp_path_factory.mktemp("footage"), range(COUNT))
    return open_footage_scene(inspect_footage(first, 24.0))


def exported(scene, document, out):
    """Return all frames of an export."""
    request = ExportRequest(out=out, settings=document.export, project="walk")
    evaluator = Evaluator.exact(document)
    plan = plan_export(document, request, evaluator)
    pictures = {identity: picture.rgba for identity, picture in scene.pictures.items()}
    context = create_context()
    renderer = FrameRenderer(context, document, pictures, evaluator, plan)
    try:
        return [renderer.draw(renderer.pose(time)) for time in plan.times]
    finally:
        renderer.release()
        context.release()


def timed(scene, *keys, **changes):
    layer = scene.document.layers[0]
    footage_keys = [FOOTAGE_TIME.key(frame, time) for frame, time in keys]
    changes = {"frames": FrameRange(0, 40)} | changes
    layer = layer.with_keys_of(FOOTAGE_TIME, footage_keys)
    settings = ExportSettings(format="png", framing="canvas")
    return replace(scene.document, layers=(layer,), export=settings, **changes)


@pytest.mark.parametrize("fps", [24.0, 30.0, 12.0])
def test_export_shows_the_exact_picture_at_each_rate(scene, tmp_path, fps):
    frames = exported(scene, timed(scene, (3, FootageTime()), fps=fps), tmp_path)
    for frame, pixels in enumerate(frames):
        # Footage of 24 frames a second, from frame 3 on, in rational numbers.
        number = floor(Fraction(24) / Fraction(fps) * max(frame - 3, 0))
        expected = np.full_like(pixels, numbered_colour(min(number, COUNT - 1)))
        assert pixels.shape[1::-1] == SIZE
        assert_array_equal(pixels, expected, err_msg=f"frame {frame}")


def test_export_loops_holds_and_reverses(scene, tmp_path):
    document = timed(
        scene,
        (0, FootageTime(start=2, speed=2, loops=True)),
        (15, FootageTime(start=7, speed=0)),
        (25, FootageTime(start=10, speed=-1)),
    )
    frames = exported(scene, document, tmp_path)
    expected = [(2 + 2 * frame) % COUNT for frame in range(15)] + 10 * [7]
    expected += [max(10 - since, 0) for since in range(16)]
    assert [tuple(pixels[0, 0]) for pixels in frames] == [*map(numbered_colour, expected)]


def test_export_names_the_missing_picture(tmp_path):
    first = write_numbered(tmp_path / "broken", range(4))
    opened = open_footage_scene(inspect_footage(first, 24.0))
    (tmp_path / "broken" / "walk_002.png").unlink()
    with pytest.raises(LissomError, match=r"frame 0 cannot be drawn.*walk_002\.png"):
        exported(opened, timed(opened, (0, FootageTime())), tmp_path)


def test_export_names_the_picture_of_another_size(tmp_path):
    first = write_numbered(tmp_path / "broken", range(4))
    opened = open_footage_scene(inspect_footage(first, 24.0))
    numbered_picture(2, (30, 24)).save(tmp_path / "broken" / "walk_002.png")
    with pytest.raises(LissomError, match=r"frame 2 cannot be drawn.*walk_002\.png has 30 × 24"):
        exported(opened, timed(opened, (0, FootageTime())), tmp_path)


def test_two_layers_show_the_same_footage_at_different_times(scene, tmp_path):
    document = timed(scene, (0, FootageTime()))
    (layer,) = document.layers
    late = layer.with_keys_of(FOOTAGE_TIME, [FOOTAGE_TIME.key(5, FootageTime())])
    beside = layer.domain.moved(16)
    keys = (replace(layer.keys[0], pose=rest_pose(beside, ())),)
    right = replace(late, id=1, name="late", corner=16 + 0j, domain=beside, keys=keys)
    document = replace(document, layers=(layer, right))
    scene = scene._replace(pictures=dict.fromkeys((0, 1), scene.pictures[0]))
    frames = exported(scene, document, tmp_path)
    assert tuple(frames[9][5, 3]) == numbered_colour(9)
    assert tuple(frames[9][5, 25]) == numbered_colour(4)

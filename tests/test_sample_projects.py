"""The sample projects that ship with Lissom are what their scripts say, and keep their bounds."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from app.document import Document, FrameRange
from app.document.queries.layers.visibility import is_visible
from app.document.queries.target_error import DistortionRange
from app.document.queries.timeline import clip_of, export_frame_range
from app.motion import Animation, ParentTransforms, TriangleOrder
from app.motion.caches.inbetween_cache import InbetweenCache
from app.motion.meshes.deform_mesh import DeformMesh
from app.reports.certification import Verdict, certify_clip
from app.solving.script.pose_script import load_pose_script
from app.storage.pictures.openraster import read_openraster
from app.storage.project_file import load_project
from app.ui.welcome import SAMPLE_FPS

SAMPLES = Path(__file__).parent.parent / "sample_images"
LAYERED = ("friend",)
NAMES = sorted({path.stem for path in SAMPLES.glob("*.json")} - set(LAYERED))


@cache
def sample(name: str) -> Document:
    return load_project(SAMPLES / f"{name}.lissom")


def test_four_creatures_move():
    assert {"character", "dragon", "giraffe", "octopus"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_sample_is_what_its_script_says(name):
    document = sample(name)
    (script,) = load_pose_script(SAMPLES / f"{name}.json").layers
    assert document.layers[0].picture.data == (SAMPLES / f"{name}.png").read_bytes()
    assert {handle.name: handle.position for handle in document.layers[0].handles} == {
        name: handle.at for name, handle in script.handles.items()
    }
    assert [key.frame for key in document.layers[0].keys] == [key.frame for key in script.keys]
    assert [key.easing for key in document.layers[0].keys] == [key.ease for key in script.keys]
    assert [key.tangent_mode for key in document.layers[0].keys] == [
        key.passing for key in script.keys
    ]
    names = {handle.name: handle.id for handle in document.layers[0].handles}
    assert document.layers[0].channels == {
        (kind, names.get(part)): keys for (kind, part), keys in script.channels.items()
    }
    assert {(handle.depth, handle.extent) for handle in document.layers[0].handles} == {
        (handle.front, handle.extent) for handle in script.handles.values()
    }
    assert document.layers[0].bounds == script.bounds
    lags = [
        lag
        for key in document.layers[0].keys
        for lag in document.layers[0].target_errors(key.pose).values()
    ]
    assert max(lags) < 2.0, "handles arrive, to two pixels"


@pytest.mark.parametrize("name", [*NAMES, *LAYERED])
def test_the_welcome_view_shows_all_of_a_samples_motion(name):
    document = sample(name)
    with Image.open(SAMPLES / "moving" / f"{name}.webp") as moving:
        assert document.loop
        seconds = document.frames.last / document.fps
        assert abs(moving.n_frames - seconds * SAMPLE_FPS) < 1
        moving.load()
        assert moving.info["duration"] == 1000 / SAMPLE_FPS


@pytest.mark.parametrize("name", LAYERED)
def test_a_sample_on_layers_is_what_its_script_says(name):
    document = sample(name)
    drawing = read_openraster((SAMPLES / f"{name}.ora").read_bytes())
    script = load_pose_script(SAMPLES / f"{name}.json")
    assert [layer.name for layer in document.layers] == [layer.name for layer in drawing.layers]
    parts = {part.layer: part for part in script.layers}
    names = {layer.id: layer.name for layer in document.layers}
    for layer in document.layers:
        part = parts.get(layer.name)
        assert layer.still == (part is None)
        if part is None:
            continue
        assert [key.frame for key in layer.keys] == [key.frame for key in part.keys]
        assert [names[each.parent] for each in layer.attachments] == [
            each.to for each in part.attach
        ]
        assert (
            max(
                [
                    0.0,
                    *(lag for key in layer.keys for lag in layer.target_errors(key.pose).values()),
                ]
            )
            < 2
        )
    # Mouths and lids take turns, and the joints of the whole chain stay closed.
    joints = ParentTransforms(document)
    laugh, head = (next(f for f in document.layers if f.name == n) for n in ("laugh", "head"))
    assert [is_visible(document, laugh, frame) for frame in (29, 30, 52)] == [True, False, True]
    at, frame = np.array([laugh.attachments[0].parent_point]), 9.5
    carrier = joints.placement(head.id, frame)
    moved = Animation(clip_of(document, head.id), points=at).positions(frame)
    own = Animation(clip_of(document, laugh.id), points=np.array([laugh.anchor]))
    held = joints.placement(laugh.id, frame).apply(own.positions(frame))
    assert_allclose(held, carrier.apply(moved), rtol=0, atol=1e-9 * 1500)


def test_the_octopus_crosses_its_arms_one_way_and_then_the_other():
    document = sample("octopus")
    clip, mesh = clip_of(document, 0), document.layers[0].domain.mesh
    places = {handle.name: handle.position for handle in document.layers[0].handles}
    higher = []
    for frame in (16, 48):
        order = TriangleOrder(mesh).triangles(clip, frame)
        middles = mesh.vertices[order].mean(axis=1)
        left, right = (
            np.flatnonzero(np.abs(middles - places[name]) < 20) for name in ("left 4", "right 4")
        )
        # All of one arm is painted over all of the other.
        assert left.min() > right.max() or right.min() > left.max()
        higher.append(left.min() > right.max())
    assert higher == [True, False]


@pytest.mark.parametrize("name", NAMES)
def test_a_sample_begins_and_ends_as_it_was_drawn(name):
    document = sample(name)
    vertices = document.layers[0].domain.mesh.vertices
    for key in (document.layers[0].keys[0], document.layers[0].keys[-1]):
        assert_allclose(document.layers[0].map_of(key.pose)(vertices), vertices, rtol=0, atol=1e-2)
    assert export_frame_range(document).last == document.frames.last - 1
    assert document.export.framing == "fit"


@pytest.mark.parametrize("name", [*NAMES, *LAYERED])
def test_no_pose_of_a_sample_sits_at_its_limits(name):
    for layer in sample(name).layers:
        uses = (use for pose in layer.poses for use in DistortionRange.of(pose).uses(layer.bounds))
        assert max(use.share for use in uses) < 0.9, layer.name


@pytest.mark.parametrize(
    "name",
    [
        "right arm",  # which has most keys
        *(pytest.param(name, marks=pytest.mark.long) for name in ("left arm", "body", "head")),
    ],
)
def test_limits_do_not_slow_down_a_motion_of_the_friend(name):
    document = sample("friend")
    moving = {layer.name: layer for layer in document.layers if len(layer.keys) > 2}
    assert set(moving) == {"left arm", "right arm", "body", "head"}
    layer = moving[name]
    store = InbetweenCache(mesh=DeformMesh.coarse(layer.domain))
    clip = clip_of(document, layer.id)
    store.add(store.segments_job(clip, store.missing_segments(clip, 0))())
    assert min(store.velocity_shares(clip).values(), default=1.0) > 0.6


def test_head_of_the_friend_keeps_its_bounds_between_two_keys():
    head = next(layer for layer in sample("friend").layers if layer.name == "head")
    keys = tuple(key for key in head.keys if 22 <= key.frame <= 50)
    assert len(keys) == 2
    alone = Document(layers=(replace(head, keys=keys, attachments=()),), frames=FrameRange(22, 50))
    report = certify_clip(clip_of(alone, head.id))
    (interval,) = report.segments
    assert interval.verdict is Verdict.PROVEN
    assert report.corrected is None


@pytest.mark.long
def test_character_keeps_its_bounds():
    report = certify_clip(clip_of(sample("character"), 0))
    assert report.verdict is Verdict.PROVEN
    assert all(np.isfinite(interval.reached.sigma_a) for interval in report.segments)

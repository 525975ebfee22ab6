import itertools
import json
import os
import shutil
import struct
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from animations import PARTED, Posed, evaluator_of, moving_document
from documents import altered
from models import PIXELS, animation_of, exported, read, settings, values
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image
from pygltflib import GLTF2
from slid_poses import slid
from still_poses import posed

from app.document import (
    HOLD,
    VISIBILITY,
    FrameRange,
    Group,
    clip_of,
    pinned_handles,
)
from app.errors import LissomError
from app.export import (
    ExportRequest,
    MeshExport,
    check_request,
    plan_export,
)
from app.storage import decode_picture, load_project, sample_images
from engine.arrays import Complexes
from engine.domain import find_closed_cuts

TOLERANCE = 0.5


def places(gltf: GLTF2, number: int) -> Complexes:
    """Positions of an accessor in pixels about the origin."""
    rows = values(gltf, number)
    assert_array_equal(rows[:, 2], 0)
    return PIXELS * (rows[:, 0] + 1j * rows[:, 1])


def played(gltf: GLTF2, node: int, seconds: float) -> Complexes:
    """Where a node's vertices are in the picture's plane, as any reader of glTF has them."""
    mesh = gltf.meshes[gltf.nodes[node].mesh]
    (primitive,) = mesh.primitives
    weights = np.array(mesh.weights or [])
    for channel in gltf.animations[0].channels if gltf.animations else []:
        if channel.target.node == node:
            sampler = gltf.animations[0].samplers[channel.sampler]
            assert (channel.target.path, sampler.interpolation) == ("weights", "LINEAR")
            times = values(gltf, sampler.input).ravel()
            table = values(gltf, sampler.output).reshape(len(times), -1)
            weights = np.array([np.interp(seconds, times, column) for column in table.T])
    targets = [places(gltf, target["POSITION"]) for target in primitive.targets or []]
    origin = complex(*gltf.asset.extras["origin"])
    moved = sum((w * t for w, t in zip(weights, targets, strict=True)), np.zeros(1))
    return places(gltf, primitive.attributes.POSITION) + moved + origin


def largest_distance(gltf, document, times, *, node=0):
    """The largest distance from the engine's own positions, at seconds."""
    layer = document.layers[node]
    animation = animation_of(clip_of(document, layer.id))
    first = document.frames.first
    return max(
        np.abs(played(gltf, node, t) - animation.positions(first + document.fps * t)).max()
        for t in times
    )


@pytest.fixture(scope="module")
def giraffe(tmp_path_factory):
    """The sample's document with a light mesh, and the model of its first second.

    Its handles are not held still, which is solved for each frame.
    """
    out = tmp_path_factory.mktemp("giraffe") / "giraffe.glb"
    second = replace(settings(), frames=FrameRange(0, 24), framing="canvas")
    project = load_project(sample_images() / "giraffe.lissom")
    document, _ = exported(altered(project, has_auto_pins=False, variant="nu"), out, second)
    return document, out


def test_a_reader_finds_every_vertex_where_the_engine_has_it_at_any_time(giraffe):
    document, out = giraffe
    times = np.random.default_rng(1).uniform(0, 24 / document.fps, 6)
    assert largest_distance(read(out), document, [0.0, *times]) <= TOLERANCE


def test_handles_that_stay_do_so_in_a_model(tmp_path):
    document, _ = exported(posed(2), tmp_path / "a.glb")
    assert pinned_handles(clip_of(document, 0)).any()
    times = np.random.default_rng(2).uniform(0, 10 / document.fps, 4)
    assert largest_distance(read(tmp_path / "a.glb"), document, times) <= TOLERANCE


def test_sliders_move_a_model(tmp_path):
    frames = FrameRange(0, 10)
    document, _ = exported(replace(slid(-1, 1.2), frames=frames), tmp_path / "a.glb")
    gltf = read(tmp_path / "a.glb")
    assert largest_distance(gltf, document, [0.0, 0.13, 0.35]) <= TOLERANCE
    assert np.abs(played(gltf, 0, 0.0) - played(gltf, 0, 0.4)).max() > 10


def test_the_giraffe_is_small(giraffe):
    _, out = giraffe
    gltf = read(out)
    texture = gltf.bufferViews[gltf.images[0].bufferView].byteLength
    assert out.stat().st_size - texture <= 400_000
    assert len(gltf.meshes[0].primitives[0].targets) <= 8
    assert 3_500 <= gltf.accessors[gltf.meshes[0].primitives[0].indices].count / 3 <= 4_500


def test_the_picture_is_where_the_mesh_shows_it(giraffe, tmp_path):
    """The base shape is the drawing at rest, and its texture the drawing's own pixels."""
    document, out = giraffe
    gltf, layer = read(out), document.layers[0]
    primitive = gltf.meshes[0].primitives[0]
    rest = places(gltf, primitive.attributes.POSITION) + complex(*gltf.asset.extras["origin"])
    assert_allclose(rest, layer.domain.mesh.vertices, rtol=0, atol=1e-3)
    assert gltf.asset.extras["origin"] == [layer.picture.size[0] / 2, 0]
    view = gltf.bufferViews[gltf.images[0].bufferView]
    data = gltf.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    (tmp_path / "texture.png").write_bytes(data)
    with Image.open(tmp_path / "texture.png") as image:
        texture = np.asarray(image)
    picture = decode_picture(layer.picture.data, "").rgba
    height, width, _ = texture.shape
    uv = values(gltf, primitive.attributes.TEXCOORD_0)
    # uv (0, 0) is the upper left corner; pixels of both lie on one grid.
    corner = rest[0] - complex(uv[0, 0] * width, -uv[0, 1] * height)
    left, top = round(corner.real), picture.shape[0] - round(corner.imag)
    assert_allclose(rest - uv[:, 0] * width + 1j * uv[:, 1] * height, corner, rtol=0, atol=1e-2)
    shown = picture[max(top, 0) : top + height, max(left, 0) : left + width]
    same = texture[max(-top, 0) :, max(-left, 0) :][: shown.shape[0], : shown.shape[1]]
    assert_array_equal(same[..., 3], shown[..., 3])
    seen = shown[..., 3] > 0
    assert_array_equal(same[seen], shown[seen])
    assert texture[..., 3].sum() == picture[..., 3].sum()
    # What is not seen has colours of what is near it: none is black here.
    beside = texture[(texture[..., 3] == 0) & np.roll(texture[..., 3] > 0, 1, axis=0)]
    assert beside[:, :3].max(axis=1).min() > 0


@pytest.mark.parametrize("covered", ["none", "left"])
def test_a_slit_is_closed_in_a_model(tmp_path, covered):
    out = tmp_path / "parted.glb"
    lines = tuple(replace(line, covered=covered) for line in PARTED.cut_lines)
    cut_out = replace(PARTED, cut_lines=lines)
    document, _ = exported(moving_document(cut_out=cut_out), out, settings(tolerance=0.01))
    gltf, layer = read(out), document.layers[0]
    seam = find_closed_cuts(layer.domain, cut_out.covered_lines(layer.corner))
    assert bool(seam.further_vertices) == (covered != "none")
    primitive = gltf.meshes[0].primitives[0]
    rest = places(gltf, primitive.attributes.POSITION) + complex(*gltf.asset.extras["origin"])
    wanted = seam.close_cuts(layer.domain.mesh.vertices)
    count = len(layer.domain.mesh.vertices)
    assert np.abs(wanted[:count] - layer.domain.mesh.vertices).max() > 0.05
    assert_allclose(rest, wanted, rtol=0, atol=1e-3)
    animation = animation_of(clip_of(document, layer.id))
    last = document.frames.last
    moved = seam.close_cuts(animation.positions(last))
    assert np.abs(played(gltf, 0, last / document.fps) - moved).max() < 0.02


def test_materials_and_order_are_those_of_a_drawing(giraffe):
    document, out = giraffe
    gltf = read(out)
    (material,) = gltf.materials
    assert (material.alphaMode, material.doubleSided) == ("BLEND", True)
    assert gltf.extensionsUsed == ["KHR_materials_unlit"]
    assert "KHR_materials_unlit" in material.extensions
    indices = values(gltf, gltf.meshes[0].primitives[0].indices).reshape(-1, 3)
    assert_array_equal(indices, document.layers[0].domain.mesh.triangles)
    assert [gltf.nodes[0].name, gltf.meshes[0].name, gltf.animations[0].name] == ["giraffe"] * 3


def test_weights_are_never_out_of_range(giraffe):
    _, out = giraffe
    gltf = read(out)
    weights = values(gltf, gltf.animations[0].samplers[0].output)
    assert weights.min() >= 0
    assert weights.max() <= 1
    assert gltf.meshes[0].weights == [0.0] * len(gltf.meshes[0].primitives[0].targets)
    times = values(gltf, gltf.animations[0].samplers[0].input).ravel()
    assert times[0] == 0
    assert np.diff(times).min() > 0


def structure_of(path: Path) -> dict:
    """The JSON of a glTF file, after its container and everything in it was looked at."""
    data = path.read_bytes()
    magic, version, length = struct.unpack("<4sII", data[:12])
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack("<I4s", data[12:20])
    assert (kind, size % 4) == (b"JSON", 0)
    content = json.loads(data[20 : 20 + size])
    binary, kind = struct.unpack("<I4s", data[20 + size : 28 + size])
    assert (kind, binary % 4, 28 + size + binary) == (b"BIN\0", 0, len(data))
    assert 0 <= binary - content["buffers"][0]["byteLength"] < 4
    for view in content["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] + view["byteLength"] <= content["buffers"][0]["byteLength"]
    gltf = read(path)
    for number, accessor in enumerate(content["accessors"]):
        found = values(gltf, number)
        assert np.isfinite(found).all()
        if "min" in accessor:
            assert_allclose(found.min(axis=0), accessor["min"], rtol=0, atol=1e-6)
            assert_allclose(found.max(axis=0), accessor["max"], rtol=0, atol=1e-6)
    for mesh in content["meshes"]:
        for primitive in mesh["primitives"]:
            count = content["accessors"][primitive["attributes"]["POSITION"]]["count"]
            assert values(gltf, primitive["indices"]).max() < count
            for target in primitive.get("targets", []):
                assert content["accessors"][target["POSITION"]]["count"] == count
            assert len(mesh.get("weights", [])) == len(primitive.get("targets", []))
            uv = values(gltf, primitive["attributes"]["TEXCOORD_0"])
            assert 0 <= uv.min() <= uv.max() <= 1
    return content


def test_the_structure_is_that_of_gltf(giraffe):
    structure_of(giraffe[1])


def two_layers():
    document = moving_document()
    (layer,) = document.layers
    still = replace(layer, id=1, name="other", keys=layer.keys[1:])
    return replace(document, layers=(layer, still))


def validator() -> Path | None:
    for folder in (Path(sys.prefix) / "node", Path(os.environ.get("NODE_PATH", "/nowhere"))):
        for path in (folder / "node_modules" / "gltf-validator", folder / "gltf-validator"):
            if path.is_dir():
                return path
    return None


@pytest.mark.skipif(
    shutil.which("node") is None or validator() is None,
    reason="no node or no gltf-validator here: bash .ci/setup test installs that where node is",
)
def test_the_validator_of_khronos_finds_nothing(giraffe, tmp_path):
    exported(two_layers(), tmp_path / "two.glb")
    exported(still(), tmp_path / "still.glb")
    script = (
        "const v = require(process.argv[1]), fs = require('fs');"
        "Promise.all(process.argv.slice(2).map(async f => (await v.validateBytes("
        "new Uint8Array(fs.readFileSync(f)))).issues)).then(r => console.log(JSON.stringify(r)))"
    )
    files = [giraffe[1], tmp_path / "two.glb", tmp_path / "still.glb"]
    said = subprocess.run(
        ["node", "-e", script, validator(), *files], capture_output=True, check=True, text=True
    )
    for issues in json.loads(said.stdout):
        assert issues["numErrors"] == issues["numWarnings"] == 0, issues


def test_every_layer_is_a_node_with_a_motion_of_its_own(tmp_path):
    out = tmp_path / "two.glb"
    document, _ = exported(two_layers(), out)
    structure_of(out)
    gltf = read(out)
    assert [node.name for node in gltf.nodes] == ["layer", "other"]
    assert gltf.scenes[0].nodes == [0, 1]
    assert gltf.nodes[1].translation[2] > 0  # in front
    for node in (0, 1):
        times = np.random.default_rng(node).uniform(0, 6 / document.fps, 12)
        assert largest_distance(gltf, document, times, node=node) <= TOLERANCE


def still():
    document = moving_document()
    return altered(document, keys=document.layers[0].keys[1:])


def test_what_a_model_does_not_composite_is_reported(tmp_path):
    document = two_layers()
    first, second = document.layers
    document = replace(
        document,
        layers=(
            replace(first, opacity=0.5, group="limbs"),
            replace(second, blend="multiply", clipped=True),
        ),
        groups=(Group(name="limbs", opacity=0.5, blend="screen"),),
    )
    _, maker = exported(document, tmp_path / "two.glb")
    assert maker.meshes[0].opacity == 0.25
    notices = [notice for notice in maker.notices if "glTF" in notice]
    assert notices == [
        f"the glTF model cannot blend {second.name}, limbs; they are painted over the rest",
        f"the glTF model cannot clip {second.name}; they are painted over the rest",
        ("in the glTF model the layers of limbs fade one by one, and shine through each other"),
    ]
    _, maker = exported(two_layers(), tmp_path / "plain.glb")
    assert not any("painted over" in notice for notice in maker.notices)


def test_layers_are_seen_when_and_as_much_as_they_should(tmp_path, monkeypatch):
    document, out = two_layers(), tmp_path / "two.glb"
    first, second = document.layers
    switched = second.with_keys_of(
        VISIBILITY, [VISIBILITY.key(0, value=False), VISIBILITY.key(4, value=True)]
    )
    monkeypatch.setattr(
        "app.export.morph_mesh.TriangleOrder.triangles",
        lambda _, clip, n: clip.layer.domain.mesh.triangles[:: 1 if n < 3 else -1],
    )
    faint = replace(first, opacity=0.5)
    _, maker = exported(replace(document, layers=(faint, switched)), out)
    structure_of(out)
    gltf = read(out)
    (channel,) = (c for c in gltf.animations[0].channels if c.target.path == "scale")
    sampler = gltf.animations[0].samplers[channel.sampler]
    assert (channel.target.node, sampler.interpolation) == (1, "STEP")
    assert_allclose(values(gltf, sampler.input).ravel(), [0, 4 / document.fps], atol=1e-6)
    assert_array_equal(values(gltf, sampler.output), [[0, 0, 0], [1, 1, 1]])
    factors = [material.pbrMetallicRoughness.baseColorFactor for material in gltf.materials]
    assert factors == [[1, 1, 1, 0.5], [1, 1, 1, 1]]
    assert maker.meshes[0].texture[..., 3].max() == 255
    assert ["glTF model keeps" in notice for notice in maker.notices] == [True, True]
    off = [VISIBILITY.key(0, value=False)]
    unseen = tuple(layer.with_keys_of(VISIBILITY, off) for layer in document.layers)
    exported(replace(document, layers=(first, unseen[1])), out)
    assert [node.name for node in read(out).nodes] == ["layer"]
    with pytest.raises(LissomError, match="no layer is visible"):
        exported(replace(document, layers=unseen), out)


def test_a_still_shows_its_pose_without_an_animation(tmp_path):
    out = tmp_path / "still.glb"
    document, _ = exported(still(), out, replace(settings(), frames=still().frames))
    assert largest_distance(read(out), document, [0.0, 0.1]) <= TOLERANCE
    exported(altered(still(), keys=moving_document().layers[0].keys[:1]), out)
    assert structure_of(out)["meshes"][0].keys() == {"name", "primitives"}


def test_a_hold_jumps_within_a_thousandth_of_a_second(tmp_path):
    document = moving_document()
    first, last = document.layers[0].keys
    document = altered(document, keys=(replace(first, easing=HOLD), last))
    out = tmp_path / "hold.glb"
    light, _ = exported(document, out)
    moment = 6 / document.fps
    assert largest_distance(read(out), light, [0.0, 0.5 * moment, moment - 1e-3, moment]) <= 0.5


def test_a_loop_comes_round(tmp_path):
    document = replace(moving_document(), loop=True, frames=FrameRange(0, 9))
    out = tmp_path / "loop.glb"
    light, _ = exported(document, out)
    gltf = read(out)
    period = gltf.accessors[gltf.animations[0].samplers[0].input].max[0]
    assert_allclose(period, 9 / document.fps, rtol=1e-6)
    assert_allclose(played(gltf, 0, 0.0), played(gltf, 0, period), rtol=0, atol=TOLERANCE)
    assert largest_distance(gltf, light, [0.3 * period, 0.9 * period]) <= TOLERANCE


def test_a_tolerance_of_ones_own_takes_as_many_shapes_as_it_needs(tmp_path, monkeypatch):
    monkeypatch.setattr("app.export.mesh_export.MOST_TARGETS", 2)
    out = tmp_path / "walk.glb"
    light, maker = exported(moving_document(), out, settings(tolerance=0.002))
    gltf = read(out)
    count = len(gltf.meshes[0].primitives[0].targets)
    assert count > 2
    assert largest_distance(gltf, light, [0.123, 0.21]) <= 0.002
    (notice,) = maker.notices
    assert f"walk has {count} shapes, but viewers of glTF need not show more than 2" in notice
    _, maker = exported(moving_document(), out, settings(tolerance=50.0))
    assert len(maker.meshes[0].motion.targets) <= 2
    assert maker.notices == ()


def test_where_eight_shapes_do_not_suffice_it_is_reported(tmp_path, monkeypatch):
    monkeypatch.setattr("app.export.morph_mesh.MOST_TARGETS", 1)
    _, maker = exported(moving_document(), tmp_path / "a.glb")
    (notice,) = maker.notices
    assert "has 1 shapes, within" in notice
    assert f"{maker.meshes[0].motion.error:.2g} pixels" in notice


def test_rates_are_refused_where_there_are_no_pictures(tmp_path):
    request = ExportRequest(out=tmp_path / "a.glb", settings=settings(), project="a", fps=12.0)
    with pytest.raises(LissomError, match="any rate"):
        check_request(moving_document(), request)


@pytest.mark.parametrize("ending", ["closed", "failed"])
def test_a_model_that_ends_early_is_not_there(tmp_path, ending):
    document = moving_document()

    def positions(frame):
        if frame > 3 and ending == "failed":
            raise LissomError("it cannot be posed")
        return animation_of(clip_of(document, 0)).positions(frame)

    request = ExportRequest(out=tmp_path / "a.glb", settings=settings(), project="a")
    canvas = replace(request, settings=replace(request.settings, framing="canvas"))
    evaluator = evaluator_of(Posed(document, positions))
    pictures = {0: decode_picture(document.layers[0].picture.data, "").rgba}
    steps = MeshExport(document, pictures, evaluator, plan_export(document, canvas, evaluator)).run(
        waits=False
    )
    if ending == "closed":
        next(itertools.islice(steps, 3, None))
        steps.close()
    else:
        with pytest.raises(LissomError, match="cannot be posed"):
            list(steps)
    assert list(tmp_path.iterdir()) == []


def test_two_exports_are_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        exported(moving_document(), tmp_path / name / "walk.glb")
    first, second = ((tmp_path / name / "walk.glb").read_bytes() for name in ("a", "b"))
    assert first == second

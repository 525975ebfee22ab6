"""`lissom interpolate` by methods that the paper compares with, and keyframes from elsewhere."""

import re

import numpy as np
import pytest
from interpolation_shapes import bar, bent
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from app.cli.main import main
from engine.domain.meshing.triangulation import triangulate
from engine.geometry.polygon import OUTSIDE_OUTLINE
from engine.interpolation.preparation import TWO_KEYFRAMES
from engine.maps.harmonic_map import HarmonicMap
from engine.paths.complex_log import TURN_COUNT
from engine.paths.path_network import MESH_POINTS

OUTLINE, CAGE = bar()
MESH = triangulate(OUTLINE, 200)
CONFORMAL = [HarmonicMap.identity(CAGE), bent(bar(), bend=0.8, turn=1.0)]
STRETCHED = [HarmonicMap.identity(CAGE), bent(bar(), bend=0.8, turn=1.0, stretch=0.7)]

RIGID = [HarmonicMap.identity(CAGE), bent(bar(), turn=1.0)]


def maps_of(keyframes):
    return {
        "outline": OUTLINE,
        "cage": CAGE,
        "phi": np.array([f.phi for f in keyframes]),
        "psi": np.array([f.psi for f in keyframes]),
        "points": MESH.vertices,
        "triangles": MESH.triangles,
        "handles": np.array([-1.8, 0.0, 1.8]),
    }


POSES = {
    "positions": np.array([f(MESH.vertices) for f in STRETCHED]),
    "triangles": MESH.triangles,
}


@pytest.fixture
def write(tmp_path):
    """Return a function that writes arrays, changed or left out (None)."""

    def written(arrays, name="keys.npz", **changes):
        path = tmp_path / name
        kept = {key: value for key, value in (arrays | changes).items() if value is not None}
        np.savez(path, **kept)
        return str(path)

    return written


def obj_text(vertices, triangles, corner="{0}/{0}/1"):
    lines = ["# a mesh", "o bar", "vn 0 0 1"]
    lines += [f"v {z.real!r} {z.imag!r} 0.25" for z in vertices.tolist()]
    lines += ["f " + " ".join(corner.format(k + 1) for k in row) for row in triangles.tolist()]
    return "\n".join(lines)


def interpolate(files, out, variant, *options, times="0,0.5,1"):
    words = ["interpolate", *map(str, files), "--variant", variant, f"--times={times}"]
    assert main([*words, "--out", str(out), *options]) == 0
    with np.load(out) as file:
        return dict(file)


def error_of(capsys, files, out, variant, *options):
    with pytest.raises(SystemExit) as leaving:
        interpolate(files, out, variant, *options)
    assert leaving.value.code == 2
    assert not out.exists()
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    return said[0]


@pytest.mark.parametrize(
    ("variant", "extra"),
    [
        ("arap", {"poisson_error"}),
        ("ffmp", {"poisson_error"}),
        ("sig13", {"angle_defect"}),
        ("mesh-eta", {"poisson_error", "rho"}),
        ("conformal", set()),
        ("handles", set()),
    ],
)
def test_the_file_is_as_documented(write, tmp_path, variant, extra):
    keyframes = {"conformal": CONFORMAL, "handles": RIGID}.get(variant, STRETCHED)
    frames = interpolate([write(maps_of(keyframes))], tmp_path / "out", variant)
    names = {"times", "anchor", "triangles", "positions", "fz", "fzbar"}
    assert set(frames) == names | extra
    assert_array_equal(frames["triangles"], MESH.triangles)
    assert frames["positions"].shape == (3, len(MESH.vertices))
    assert frames["fz"].shape == frames["fzbar"].shape == (3, len(MESH.triangles))
    # A pose of the deformer's is a minimum of its energy, to some 1e-4 of the size.
    tolerance = 1e-3 if variant == "handles" else 1e-8
    for row, f in zip(frames["positions"][::2], keyframes, strict=True):
        assert_allclose(row, f(MESH.vertices), rtol=0, atol=tolerance)


@pytest.mark.parametrize("variant", ["arap", "ffmp", "sig13", "mesh-eta"])
def test_poses_of_a_mesh_from_one_file_from_npz_and_from_obj_are_the_same(write, tmp_path, variant):
    together = interpolate([write(POSES)], tmp_path / "a", variant)
    names = ("first", "second")
    separate = [
        write({"vertices": pose, "triangles": MESH.triangles}, f"{name}.npz")
        for name, pose in zip(names, POSES["positions"], strict=True)
    ]
    objects = [tmp_path / f"{name}.OBJ" for name in names]
    corners = ("{0}", "{0}/{0}/1")
    for path, pose, corner in zip(objects, POSES["positions"], corners, strict=True):
        path.write_text(obj_text(pose, MESH.triangles, corner))
    for files in (separate, objects):
        frames = interpolate(files, tmp_path / "b", variant)
        assert set(frames) == set(together)
        assert_allclose(frames["positions"], together["positions"], rtol=0, atol=1e-12)


def test_an_obj_of_quads_and_relative_indices_that_run_clockwise(tmp_path):
    first, second = tmp_path / "a.obj", tmp_path / "b.obj"
    faces = "f -6 -3 -2 -5\nf -5// -2// \\\n -1// -4//\n"
    first.write_text("v 0 0\nv 1 0\nv 2 0\nv 0 1\nv 1 1\nv 2 1\n" + faces)
    second.write_text("v 0 0\nv 0 1\nv 0 2\nv -1 0\nv -1 1\nv -1 2\n" + faces)
    frames = interpolate([first, second], tmp_path / "out", "arap", times="0.5")
    z = np.array([0, 1, 2, 1j, 1 + 1j, 2 + 1j])
    away = frames["positions"][0] - frames["positions"][0, 0]
    assert_allclose(away, np.exp(0.25j * np.pi) * z, rtol=0, atol=1e-12)
    assert len(frames["triangles"]) == 4


def test_principal_angles_are_an_option(write, tmp_path):
    keyframes = [CONFORMAL[0], bent(bar(), bend=1.2, turn=2.0)]
    path = write(maps_of(keyframes), anchor=0.0)
    errors = [
        interpolate([path], tmp_path / "out", "arap", *option)["poisson_error"][1]
        for option in ([], ["--principal"])
    ]
    assert errors[1] > 10 * errors[0]


@pytest.mark.parametrize("variant", ["metric", "arap"])
def test_keyframes_by_where_the_boundary_goes(write, tmp_path, capsys, variant):
    bowed = OUTLINE + 0.15j * np.abs(OUTLINE.real)
    arrays = {
        "outline": OUTLINE,
        "cage": CAGE,
        "boundary": np.array([OUTLINE, bowed]),
        "points": MESH.vertices,
        "triangles": MESH.triangles,
    }
    frames = interpolate([write(arrays)], tmp_path / "out", variant)
    assert "of the diameter" in capsys.readouterr().err
    assert_allclose(frames["positions"][0], MESH.vertices, rtol=0, atol=1e-8)
    corner = np.abs(MESH.vertices - OUTLINE[0]).argmin()
    assert_allclose(frames["positions"][2, corner], bowed[0], rtol=0, atol=0.01)


def test_keyframes_by_the_boundary_are_refused_around_holes(write, tmp_path, capsys):
    square = np.array([1, 1j, -1, -1j]) * 0.2
    arrays = {
        "outline": OUTLINE,
        "cage": CAGE,
        "boundary": np.array([OUTLINE, OUTLINE]),
        "points": MESH.vertices,
        "hole_outlines": square[::-1],
        "hole_outline_sizes": np.array([4]),
        "hole_cages": 0.8 * square[::-1],
        "hole_cage_sizes": np.array([4]),
        "hole_centres": np.zeros(1, dtype=complex),
    }
    said = error_of(capsys, [write(arrays)], tmp_path / "out.npz", "metric")
    assert "works only without holes" in said


FLIPPED = MESH.triangles.copy()
FLIPPED[3] = FLIPPED[3, ::-1]
FOLDED = POSES["positions"].copy()
FOLDED[1, 60] = 3j
TWICE = np.concatenate([MESH.triangles, MESH.triangles[:1], MESH.triangles[:1]])


@pytest.mark.parametrize(
    ("variant", "arrays", "changes", "message"),
    [
        ("arap", maps_of(STRETCHED), {"triangles": None}, "arap needs the array 'triangles'"),
        ("handles", maps_of(STRETCHED), {"handles": None}, "needs the array 'handles'"),
        ("handles", maps_of(STRETCHED), {"handles": np.empty(0)}, "lead from key to key"),
        (
            "handles",
            maps_of(STRETCHED),
            {"handles": np.array([9.0])},
            says(OUTSIDE_OUTLINE, name="handle", number="", x=9, y=0),
        ),
        ("conformal", maps_of(STRETCHED), {}, "Keyframe 1 is not holomorphic: .* k is 0"),
        ("conformal", POSES, {}, "needs keyframes that are harmonic maps"),
        ("metric", POSES, {}, "not poses of a mesh; choose one of arap, ffmp, sig13, mesh"),
        ("arap", POSES, {"positions": FOLDED}, "Keyframe 1 folds: triangle .* is flipped"),
        ("arap", POSES, {"positions": POSES["positions"][:, :-1]}, says(MESH_POINTS, smallest=0)),
        ("arap", POSES, {"positions": POSES["positions"][0]}, "must have the shape"),
        ("arap", POSES, {"positions": POSES["positions"][:1]}, says(TWO_KEYFRAMES, count=1)),
        ("arap", POSES, {"points": MESH.vertices[:-1]}, says(MESH_POINTS, smallest=0)),
        ("arap", POSES, {"points": np.append(MESH.vertices, 5)}, "belongs to no triangle"),
        ("arap", POSES, {"triangles": FLIPPED}, "Triangle 3 of the domain is flipped"),
        ("arap", POSES, {"triangles": TWICE}, "belongs to . triangles; an edge of a plane mesh"),
        ("arap", POSES, {"triangles": MESH.triangles[:, :2]}, r"of shape \(t, 3\)"),
        ("arap", POSES, {"triangles": MESH.triangles + 0.5}, "integers"),
        ("arap", POSES, {"triangles": None}, "'triangles'"),
        ("arap", POSES, {"anchor": np.array([0.1, 0.2])}, "exactly one anchor, not 2"),
        ("arap", POSES, {"turns": np.array([1, 1])}, says(TURN_COUNT, keyframes=2, count=1)),
        ("arap", {"boundary": np.zeros((2, 4))}, {}, "'outline'"),
    ],
)
def test_bad_files_are_refused(write, tmp_path, capsys, variant, *, arrays, changes, message):
    said = error_of(capsys, [write(arrays, **changes)], tmp_path / "out.npz", variant)
    assert re.search(message, said)


def test_a_mesh_with_a_hole_is_refused_by_the_method_that_cannot_flatten_it(
    write, tmp_path, capsys
):
    inner = np.abs(MESH.vertices[MESH.triangles].mean(axis=1)) > 0.3
    used, triangles = np.unique(MESH.triangles[inner], return_inverse=True)
    arrays = {"positions": POSES["positions"][:, used], "triangles": triangles.reshape(-1, 3)}
    path = write(arrays)
    assert "has holes: 1" in error_of(capsys, [path], tmp_path / "out.npz", "sig13")
    frames = interpolate([path], tmp_path / "out", "arap")
    assert_allclose(frames["positions"][2], arrays["positions"][1], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("variant", "option", "message"),
    [
        ("arap", ["--through"], "cannot pass through keyframes"),
        ("arap", ["--bounds", "0.5,2,0.5"], "keeps no limits"),
        ("ffmp", ["--principal"], "--principal applies only to arap and mesh-eta"),
        ("metric", ["--principal"], "--principal applies only to arap and mesh-eta"),
    ],
)
def test_options_that_do_not_fit_are_refused(write, tmp_path, capsys, *, variant, option, message):
    path = write(maps_of(STRETCHED))
    assert message in error_of(capsys, [path], tmp_path / "out.npz", variant, *option)


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["v 0 0\nv 1 0\nv 0 1\nf 1 2 3"], "is only one keyframe"),
        (["v 0 0\nv 1 0\nv 0 1\nf 1 2 3", "v 0 0\nv 1 0\nv 0 1\nf 1 3 2"], "has other triangles"),
        (["v 0 0\nv 1 x\nf 1 2 3", ""], "line 2 is 'v 1 x'"),
        (["v 0 0\nv 1 0\nv 0 1\nf 1 2 0", ""], "line 4"),
        (["v 0 0\nv 1 0\nv 0 1\nf -4 2 3", ""], "line 4"),
        (["v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3", ""], "is not flat"),
        (["", ""], "has no vertices"),
        (["v 0 0\n", ""], "has no faces"),
    ],
)
def test_bad_meshes_are_refused(tmp_path, capsys, texts, message):
    files = [tmp_path / f"{i}.obj" for i in range(len(texts))]
    for path, text in zip(files, texts, strict=True):
        path.write_text(text)
    assert message in error_of(capsys, files, tmp_path / "out.npz", "arap")

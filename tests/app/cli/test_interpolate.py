import re

import numpy as np
import pytest
from interpolation_shapes import inner_points, letter_l, random_map
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from app.cli.arrays.keyframes import COEFFICIENT_SHAPE
from app.cli.main import main
from engine.domain.meshing.triangulation import triangulate
from engine.geometry import polygon
from engine.geometry.polygon import CAGE_ORDER, CAGE_TOUCHES, OUTSIDE_OUTLINE
from engine.interpolation.keyframe_blend.keyframe_samples import FOLDS
from engine.interpolation.preparation import TWO_KEYFRAMES
from engine.paths.complex_log import TURN_COUNT
from engine.paths.path_network import MESH_POINTS

OUTLINE, CAGE = letter_l()
KEYFRAMES = [random_map((OUTLINE, CAGE), seed) for seed in (1, 2, 5)]
POINTS = np.concatenate([inner_points(OUTLINE, 30, 0), OUTLINE[:5], OUTLINE[:5] * (1 + 1e-15)])
MAPS = {
    "outline": OUTLINE,
    "cage": CAGE,
    "phi": np.array([f.phi for f in KEYFRAMES]),
    "psi": np.array([f.psi for f in KEYFRAMES]),
    "points": POINTS,
}


@pytest.fixture
def write(tmp_path):
    """Return a function that writes the maps, changed or with arrays left out (None)."""

    def written(**changes):
        path = tmp_path / "maps.npz"
        arrays = {name: value for name, value in (MAPS | changes).items() if value is not None}
        np.savez(path, **arrays)
        return str(path)

    return written


def interpolate(maps, out, *options, variant="nu", times="0,0.5,1"):
    arguments = ["interpolate", maps, "--variant", variant, f"--times={times}", "--out", str(out)]
    return main([*arguments, *options])


def error_of(capsys, maps, out, *flags, **options):
    with pytest.raises(SystemExit) as leaving:
        interpolate(maps, out, *flags, **options)
    assert leaving.value.code == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    assert not out.exists()
    return said[0]


def test_a_terminal_tells_how_far_a_long_preparation_is(write, tmp_path, capsys, monkeypatch):
    assert interpolate(write(), tmp_path / "piped", variant="metric") == 0
    assert capsys.readouterr().err == ""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setattr("app.cli.console.PATIENCE", -1.0)
    assert interpolate(write(), tmp_path / "seen", variant="metric") == 0
    lines = capsys.readouterr().err.split("\r\x1b[K")
    shares = [int(each[:-1].split()[-1]) for each in lines if each]
    assert shares == sorted(shares)
    assert (shares[0], len(shares)) > (-1, 3)
    assert lines[-1] == ""


@pytest.mark.parametrize("variant", ["nu", "eta", "scaled-eta", "metric", "linear"])
def test_the_file_is_as_documented(write, tmp_path, variant):
    out = tmp_path / "frames"
    assert interpolate(write(anchor=0.5 + 0.5j), out, variant=variant, times="1.5,0,2,0.25") == 0
    with np.load(out) as file:
        frames = dict(file)
    names = {"times", "anchor", "positions", "fz", "fzbar"}
    assert set(frames) == names | ({"rho"} if variant == "scaled-eta" else set())
    assert_array_equal(frames["times"], [1.5, 0, 2, 0.25])
    assert frames["anchor"].shape == ()
    assert frames["anchor"] == 0.5 + 0.5j
    for name in ("positions", "fz", "fzbar"):
        assert frames[name].dtype == np.complex128
        assert frames[name].shape == (4, len(POINTS))
    size = polygon.diameter(OUTLINE)
    for row, f in ((1, KEYFRAMES[0]), (2, KEYFRAMES[2])):
        fz, fzbar = f.derivatives(POINTS)
        assert_allclose(frames["positions"][row], f(POINTS), rtol=0, atol=1e-10 * size)
        assert_allclose(frames["fz"][row], fz, rtol=0, atol=1e-10)
        assert_allclose(frames["fzbar"][row], fzbar, rtol=0, atol=1e-10)
    if variant == "scaled-eta":
        assert_array_equal(frames["rho"][1:3], 1.0)
        assert np.all((frames["rho"] > 0) & (frames["rho"] <= 1))


@pytest.mark.parametrize("variant", ["nu", "scaled-eta", "metric"])
def test_triangles_give_the_same_in_betweens(write, tmp_path, variant):
    mesh = triangulate(OUTLINE, 400)
    paths = tmp_path / "scattered", tmp_path / "meshed"
    changes = {"points": mesh.vertices, "anchor": 1.1 + 0.3j}
    for triangles, path in zip((None, mesh.triangles), paths, strict=True):
        interpolate(write(triangles=triangles, **changes), path, variant=variant, times="0.3,1.7")
    first, second = (np.load(path)["positions"] for path in paths)
    assert_allclose(first, second, rtol=0, atol=1e-6 * polygon.diameter(OUTLINE))


def test_the_anchor_moves_straight_and_turns_evenly(write, tmp_path):
    anchor = 0.4 + 0.6j
    out = tmp_path / "frames"
    maps = write(anchor=anchor, points=np.array([anchor]))
    interpolate(maps, out, variant="metric", times="0,0.25,1")
    with np.load(out) as file:
        positions, fz = file["positions"][:, 0], file["fz"][:, 0]
    assert_allclose(positions[1], 0.75 * positions[0] + 0.25 * positions[2], rtol=1e-12, atol=0)
    turn = np.angle(fz[1:] / fz[0])
    assert_allclose(turn[0], 0.25 * turn[1], rtol=1e-9, atol=0)


def test_a_turn_of_200_degrees_can_go_the_long_way(write, tmp_path):
    anchor = 0.5 + 0.5j
    turn = np.exp(1j * np.deg2rad(200.0))
    changes = {
        "phi": np.array([CAGE, anchor + turn * (CAGE - anchor)]),
        "psi": np.zeros((2, len(CAGE))),
        "anchor": anchor,
    }
    for turns, degrees in ((None, -160.0), ([0], -160.0), ([1], 200.0)):
        out = tmp_path / "frames"
        interpolate(write(turns=turns, **changes), out, times="0.25,0.5")
        with np.load(out) as file:
            positions = file["positions"]
        for row, part in zip(positions, (0.25, 0.5), strict=True):
            expected = anchor + np.exp(1j * np.deg2rad(part * degrees)) * (POINTS - anchor)
            assert_allclose(row, expected, rtol=0, atol=1e-9)


FOLDED = MAPS["psi"].copy()
FOLDED[1] = MAPS["phi"][1].conj() * 2


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"phi": MAPS["phi"][:1], "psi": MAPS["psi"][:1]}, says(TWO_KEYFRAMES)),
        ({"phi": MAPS["phi"][:, :-1]}, says(COEFFICIENT_SHAPE)),
        ({"phi": MAPS["phi"][0]}, says(COEFFICIENT_SHAPE)),
        ({"psi": FOLDED}, says(FOLDS, number=1)),
        (
            {"points": np.array([0.5 + 0.5j, 2 + 2j])},
            says(OUTSIDE_OUTLINE, name="point", number=" 1", x=2, y=2),
        ),
        ({"points": np.array([])}, "at least 1"),
        ({"points": np.array([np.nan])}, "finite"),
        ({"anchor": 9.0}, "anchor at .* is outside"),
        ({"anchor": np.array([0.5, 0.6])}, "exactly one anchor, not 2"),
        ({"anchor": np.array([])}, "exactly one anchor, not 0"),
        ({"outline": OUTLINE[::-1]}, "clockwise"),
        ({"outline": OUTLINE[[0, 12, 1, *range(2, 12)]]}, "crosses or touches itself"),
        ({"outline": 1.2 * OUTLINE}, says(CAGE_TOUCHES)),
        ({"cage": CAGE[::-1]}, says(CAGE_ORDER)),
        ({"triangles": np.array([[0, 1, 99]])}, says(MESH_POINTS)),
        ({"triangles": np.array([[0.0, 1, 2]])}, "integers"),
        ({"triangles": np.array([[0, 1, 2]])}, "No triangles connect|leaves the outline"),
        ({"psi": None}, "'psi'"),
        ({"turns": np.array([1])}, says(TURN_COUNT, keyframes=3, count=2)),
        ({"turns": np.array([0.5, 1])}, says(TURN_COUNT, count=2, dtype="float64")),
    ],
)
def test_bad_files_are_refused(write, tmp_path, capsys, changes, message):
    assert re.search(message, error_of(capsys, write(**changes), tmp_path / "out.npz"))


@pytest.mark.parametrize(
    ("times", "message"),
    [
        ("-0.5,0", "time -0.5 is out of range: 3 keyframes span the times from 0 to 2"),
        ("0,2.001", "out of range"),
        ("nan", "out of range"),
        ("inf", "out of range"),
        ("0;1", "not a list of numbers"),
        ("", "not a list of numbers"),
    ],
)
def test_bad_times_are_refused(write, tmp_path, capsys, times, message):
    assert message in error_of(capsys, write(), tmp_path / "out.npz", times=times)


def test_motion_through_keyframes_and_round_a_loop(write, tmp_path):
    maps = write(turns=np.array([0, 1, 0]))
    e = 1e-4
    times = ",".join(str(t) for t in (0, 1 - 2 * e, 1 - e, 1, 1 + e, 1 + 2 * e, 3))
    bounds = "0.9,30,0.03"
    assert (
        interpolate(maps, tmp_path / "a", "--through", "--loop", "--bounds", bounds, times=times)
        == 0
    )
    with np.load(tmp_path / "a") as file:
        frames = dict(file)
    p = frames["positions"]
    assert_allclose(p[6], p[0], atol=1e-12)
    before, after = 3 * p[3] - 4 * p[2] + p[1], -3 * p[3] + 4 * p[4] - p[5]
    assert_allclose(before, after, atol=1e-4 * np.abs(after).max())
    assert frames["tangents"].shape == (3,)
    assert frames["tangents"].max() > 0.1
    # Tighter bounds leave less.
    assert interpolate(maps, tmp_path / "b", "--through", "--loop", times=times) == 0
    with np.load(tmp_path / "b") as file:
        assert (file["tangents"] <= frames["tangents"]).all()


def test_what_cannot_be_said_about_passing_is_reported(write, capsys, tmp_path):
    maps, out = write(), tmp_path / "out"
    said = error_of(capsys, maps, out, "--bounds", "0.5,2,0.5")
    assert "--through as well" in said
    assert "must be between 0 and 1, not 2" in error_of(
        capsys, maps, out, "--through", "--bounds", "2,2,0.5"
    )
    assert "span the times from 0 to 3" in error_of(capsys, maps, out, "--loop", times="3.1")

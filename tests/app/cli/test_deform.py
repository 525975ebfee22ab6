import re

import numpy as np
import pytest
from deform_shapes import STAR_POINTS, star_boundary
from interpolation_shapes import subdivided
from messages import says
from numpy.testing import assert_allclose
from refusals import refusal

from app.cli.main import main
from engine.deform.deformer import UNCERTIFIED_START
from engine.deform.forces.pulls import FORCE_NOT_POSITIVE
from engine.deform.handles import MOST_CAGE, TARGET_COUNT
from engine.geometry.polygon import CAGE_ORDER, OUTSIDE_OUTLINE, is_simple
from engine.maps.bounds import IMPOSSIBLE_BOUND
from engine.maps.harmonic_map import COEFFICIENT_COUNT, HarmonicMap

OUTLINE, CAGE = star_boundary().outline, star_boundary().cage
CASE = {
    "outline": OUTLINE,
    "cage": CAGE,
    "handles": STAR_POINTS,
    "targets": STAR_POINTS + np.array([0, 0.2j, 0.1, 0, 0, -0.1]),
    "k_max": 0.8,
    "sigma_a_max": 5.0,
    "sigma_b_min": 0.2,
}


@pytest.fixture
def write(tmp_path):
    """Return a function that writes the case, changed or with arrays left out (None)."""

    def written(**changes):
        path = tmp_path / "case.npz"
        np.savez(path, **{k: v for k, v in (CASE | changes).items() if v is not None})
        return str(path)

    return written


def deform(case, out):
    assert main(["deform", case, "--out", str(out)]) == 0
    with np.load(out) as written:
        return dict(written)


def test_a_case_is_solved(write, tmp_path, capsys):
    got = deform(write(), tmp_path / "map.npz")
    assert "converged" in capsys.readouterr().out
    assert set(got) == {
        *("outline", "cage", "phi", "psi", "logs", "handles_mapped"),
        *("hole_outlines", "hole_outline_sizes", "hole_cages", "hole_cage_sizes", "hole_centres"),
        *("k", "sigma_a", "sigma_b", "certified", "status", "steps", "steps_tried"),
    }
    assert bool(got["certified"]) is True
    assert got["certified"].dtype == bool
    assert str(got["status"]) == "converged"
    assert 0 < int(got["steps"]) == int(got["steps_tried"]) <= 30
    f = HarmonicMap(cage=got["cage"], phi=got["phi"], psi=got["psi"])
    assert_allclose(f(STAR_POINTS), got["handles_mapped"], atol=1e-12)
    assert_allclose(got["handles_mapped"], CASE["targets"], atol=5e-3)
    fz, fzbar = f.derivatives(star_boundary().points)
    a, b = np.abs(fz), np.abs(fzbar)
    assert (b / a).max() <= got["k"] <= 0.8
    assert (a + b).max() <= got["sigma_a"] <= 5
    assert (a - b).min() >= got["sigma_b"] >= 0.2


def test_path_and_start_map_are_followed(write, tmp_path):
    way = STAR_POINTS + np.linspace(0, 1, 5)[:, None] * (CASE["targets"] - STAR_POINTS)
    first = deform(write(path=way), tmp_path / "first.npz")
    assert str(first["status"]) == "converged"
    again = deform(write(phi=first["phi"], psi=first["psi"]), tmp_path / "again.npz")
    assert_allclose(again["handles_mapped"], first["handles_mapped"], atol=1e-4)
    repeated = deform(write(path=way), tmp_path / "repeated.npz")
    assert all(np.array_equal(first[name], repeated[name]) for name in first)


def test_a_request_that_the_bounds_forbid_is_no_error(write, tmp_path):
    case = write(targets=3 * STAR_POINTS, sigma_a_max=1.3, k_max=0.2, sigma_b_min=0.8)
    got = deform(case, tmp_path / "map.npz")
    assert str(got["status"]) == "at the limits"
    assert got["certified"]
    assert got["sigma_a"] <= 1.3
    assert np.abs(got["handles_mapped"] - 3 * STAR_POINTS).max() > 0.5


@pytest.mark.parametrize("pull", [10.0, np.array([np.inf, 10, *4 * [np.inf]])])
def test_on_request_handles_pull_with_bounded_force(write, tmp_path, pull):
    far = STAR_POINTS.copy()
    far[1] *= 3
    limits = {"targets": far, "sigma_a_max": 2.0, "k_max": 0.5, "sigma_b_min": 0.5}
    others = [0, 2, 3, 4, 5]
    held = deform(write(**limits), tmp_path / "held.npz")
    assert np.abs(held["handles_mapped"] - far)[others].max() > 0.03
    got = deform(write(**limits, pull=pull), tmp_path / "map.npz")
    assert got["certified"]
    assert str(got["status"]) == "at the limits"
    assert np.abs(got["handles_mapped"][1] - far[1]) > 0.3
    assert np.abs(got["handles_mapped"] - far)[others].max() < 0.02


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in (1, 2, 3))]
)
def test_what_is_certified_can_be_started_from(write, tmp_path, seed):
    # At a bound to the last digits.
    rng = np.random.default_rng(seed)
    targets = STAR_POINTS * np.exp(1j * rng.normal(size=6)) * (1 + rng.random(6))
    limits = {"targets": targets, "sigma_a_max": 1.3 + seed / 4, "k_max": 0.3, "sigma_b_min": 0.7}
    first = deform(write(**limits), tmp_path / "first.npz")
    assert first["certified"]
    again = deform(write(**limits, phi=first["phi"], psi=first["psi"]), tmp_path / "again.npz")
    assert again["certified"]


def test_a_cage_that_crosses_itself_away_from_the_outline_is_taken(write, tmp_path):
    # One edge of the cage makes a small loop outwards, as in two published shapes.
    edge = CAGE[1] - CAGE[0]
    outwards = -0.1j * edge / abs(edge)
    loop = CAGE[0] + np.array([0.6, 0.4]) * edge + outwards
    crossed = np.concatenate([CAGE[:1], loop, CAGE[1:]])
    assert not is_simple(crossed)
    got = deform(write(cage=crossed), tmp_path / "map.npz")
    assert got["certified"]
    assert str(got["status"]) == "converged"


DOUBLE = np.array([0.0, 0.0])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"handles": None}, "has no array 'handles'"),
        ({"handles": STAR_POINTS + 5}, says(OUTSIDE_OUTLINE)),
        ({"handles": STAR_POINTS + 1e-3 + 5, "cage": CAGE[::-1]}, says(OUTSIDE_OUTLINE)),
        ({"cage": subdivided(CAGE, 0.01)}, says(MOST_CAGE, most=400)),
        ({"targets": np.full(6, np.nan)}, "finite"),
        ({"targets": STAR_POINTS[:3]}, says(TARGET_COUNT)),
        ({"handles": DOUBLE, "targets": np.array([0, 1.0])}, "same point"),
        ({"cage": CAGE + 9}, says(CAGE_ORDER)),
        ({"outline": CAGE, "cage": OUTLINE}, "strictly inside|cage"),
        ({"k_max": 1.0}, says(IMPOSSIBLE_BOUND, name="k")),
        ({"sigma_a_max": 0.9}, "limit of sigma_a"),
        ({"sigma_b_min": 1.0}, "limit of sigma_b"),
        ({"k_max": np.array([0.5, 0.6])}, "k_max must be one number"),
        ({"k_max": "high"}, "'k_max' contains text"),
        ({"phi": CAGE}, "both phi and psi"),
        ({"phi": CAGE, "psi": 0.95 * CAGE}, says(UNCERTIFIED_START)),
        ({"phi": CAGE[:4], "psi": CAGE[:4]}, says(COEFFICIENT_COUNT)),
        ({"path": np.zeros((3, 2))}, "path must have one column"),
        ({"path": np.full((3, 6), np.inf)}, "finite"),
        ({"pull": np.ones(5)}, "pull must be one number, or one for each of 6 handles"),
        ({"pull": 0.0}, says(FORCE_NOT_POSITIVE, pull=0)),
        ({"pull": np.array([1, 1, 1, 1, np.nan, 1])}, says(FORCE_NOT_POSITIVE, pull=float("nan"))),
    ],
)
def test_bad_input_is_one_line(write, tmp_path, capsys, changes, message):
    out = tmp_path / "map.npz"
    with pytest.raises(SystemExit) as leaving:
        main(["deform", write(**changes), "--out", str(out)])
    assert leaving.value.code == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    assert re.search(message, said[0])
    assert not out.exists()


STIFF = np.where(OUTLINE.imag > 0, 20.0, 1.0)


def test_a_stiff_part_is_distorted_less_and_has_limits_of_its_own(write, tmp_path):
    targets = STAR_POINTS + np.array([0, 0.4, -0.3j, 0, 0, 0.3])
    points = star_boundary().points[star_boundary().points.imag > 0.15]
    distortions = {}
    for name, changes in {
        "usual": {},
        "ones": {"stiffness": np.ones(len(OUTLINE)), "local_limits": 1},
        "stiff": {"stiffness": STIFF},
        "limited": {"stiffness": STIFF, "local_limits": 1, "k_max": 0.4},
    }.items():
        got = deform(write(targets=targets, **changes), tmp_path / f"{name}.npz")
        fz, fzbar = HarmonicMap(cage=CAGE, phi=got["phi"], psi=got["psi"]).derivatives(points)
        distortions[name] = np.abs(fzbar / fz), got["phi"]
        assert got["certified"]
    assert np.array_equal(distortions["usual"][1], distortions["ones"][1])
    assert distortions["stiff"][0].mean() < distortions["usual"][0].mean()
    assert distortions["limited"][0].max() <= 0.4 / np.sqrt(20) < distortions["stiff"][0].max()


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"stiffness": np.ones(3)}, "stiffness"),
        ({"stiffness": 2.0}, "stiffness"),
        ({"stiffness": np.full(len(OUTLINE), np.nan)}, "stiffness"),
        ({"stiffness": np.full(len(OUTLINE), 0.03)}, "stiffness"),
        ({"stiffness": np.full(len(OUTLINE), "soft")}, "stiffness"),
        ({"stiffness": OUTLINE}, "stiffness"),
        ({"stiffness": STIFF, "local_limits": 2}, "local_limits"),
        ({"stiffness": STIFF, "local_limits": np.nan}, "local_limits"),
        ({"stiffness": STIFF, "local_limits": np.ones(3)}, "local_limits"),
    ],
)
def test_other_materials_are_refused_by_name(write, tmp_path, capsys, changes, name):
    said = refusal(capsys, "deform", write(**changes), "--out", tmp_path / "map.npz")
    assert name in said

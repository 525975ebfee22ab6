"""Pose sliders: exact poses, limits for any weights, holes, pins, turns, and series."""

from functools import cache, partial

import holed_shapes
import interpolation_shapes
import numpy as np
import pytest
from interpolation_shapes import bar, bent, letter_l, narrow_u, scattered_on
from numpy.testing import assert_allclose

from engine.dirichlet import HilbertTransform
from engine.errors import EngineError
from engine.interpolation import finish, sample_domain
from engine.maps import Boundary, Bounds, HarmonicMap, distortion
from engine.sliders import PoseBlend, SliderMotion
from engine.streaming import build_series

POSES = 8
SIMPLE = {"bar": bar, "l": letter_l, "u": narrow_u}
HOLED = {
    "ring": partial(holed_shapes.ring, sides=20),
    "plate": partial(holed_shapes.plate, count=2, pieces=6),
}
SHAPES = (*SIMPLE, *HOLED)
OF_LIMITS = 3e-3  # allowed excess, relative to a limit
OF_PINS = 4e-5  # allowed drift of pins; the shapes are 2 to 4 long
PINS = {"bar": (-1.7 + 0.1j, 1.6 - 0.1j), "ring": (0.75j, -0.7 + 0j)}


@cache
def boundary_of(name):
    if name in SIMPLE:
        return interpolation_shapes.boundary_of(SIMPLE[name]())
    return Boundary.sample(HOLED[name]().domain)


@cache
def transform_of(name):
    return HilbertTransform.on(boundary_of(name).domain)


@cache
def maps_of(name):
    """The shape at rest, and poses without folds."""
    if name in SIMPLE:
        shape = SIMPLE[name]()
        makers = (interpolation_shapes.random_map(shape, seed, k=0.4) for seed in range(POSES - 1))
        return (HarmonicMap.identity(shape[1]), *makers)
    shape = HOLED[name]()
    rest = HarmonicMap.identity(shape.cage, shape.holes)
    return (rest, *(holed_shapes.random_map(shape, seed, 0.04) for seed in range(POSES - 1)))


@cache
def bounds_of(name):
    """The limits that the poses reach, as a certificate finds them."""
    z = boundary_of(name).points
    pairs = [f.derivatives(z) for f in maps_of(name)]
    k, sigma_a, sigma_b = (
        np.array([of(*pair) for pair in pairs])
        for of in (distortion.k, distortion.sigma_a, distortion.sigma_b)
    )
    return Bounds(k=1.005 * k.max(), sigma_a=1.005 * sigma_a.max(), sigma_b=0.995 * sigma_b.min())


@cache
def dense_points(name):
    """Samples of the boundary, irrational places between them, and some points inside."""
    boundary = boundary_of(name)
    edges = [scattered_on(loop, 9) for loop in boundary.loops]
    if name in SIMPLE:
        inside = interpolation_shapes.inner_points(boundary.outline, 40, 0)
    else:
        inside = holed_shapes.inner_points(HOLED[name]())[:40]
    return np.concatenate([*edges, inside])


@cache
def slider(name, *, count=POSES, pins=(), points=None, bounds=None, turns=None):
    boundary = boundary_of(name)
    points = dense_points(name) if points is None else np.array(points)
    anchor = HOLED[name]().anchor if name in HOLED else None
    sites = sample_domain(boundary, points, anchor=anchor)
    extension = transform_of(name).at(sites.paths.nodes)
    maps, bounds = maps_of(name)[:count], bounds or bounds_of(name)
    return PoseBlend.of(maps, sites, extension, bounds=bounds, pins=pins, turns=turns)


def settings(count, seed, poses=POSES):
    """Weights of random sliders from −30 to 130 %, of which a random number is moved."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        moved = rng.permutation(poses - 1)[: rng.integers(1, poses)]
        weights = np.zeros(poses)
        weights[1 + moved] = rng.uniform(-0.3, 1.3, len(moved))
        weights[0] = 1.0 - weights.sum()
        yield weights


def excess_of(frame, bounds):
    """Return how far a frame exceeds each limit, relative to it."""
    over = (frame.k.max() / bounds.k, frame.sigma_a.max() / bounds.sigma_a)
    return max(*over, 2.0 - frame.sigma_b.min() / bounds.sigma_b) - 1.0


def check_limits(name, count, seed, pins=()):
    poses, bounds, curbed = slider(name, pins=pins), bounds_of(name), 0
    places = np.array([f(np.array(pins)) for f in maps_of(name)])
    pinned = slider(name, pins=pins, points=pins) if pins else None
    for weights in settings(count, seed):
        frame = poses.frame(weights)
        assert excess_of(frame, bounds) < OF_LIMITS
        curbed += frame.curbed > 0
        if pinned is not None:
            reached = pinned.frame(weights)
            given = np.eye(POSES)[0] + reached.share * (weights - np.eye(POSES)[0])
            assert_allclose(reached.positions, given @ places, rtol=0, atol=OF_PINS)
    assert curbed > count / 4


@pytest.mark.parametrize("name", SHAPES)
def test_poses_within_the_limits_are_exact(name):
    poses = slider(name)
    for weights, f in zip(np.eye(POSES), maps_of(name), strict=True):
        frame = poses.frame(weights)
        atol = 1e-12 * boundary_of(name).size
        assert_allclose(frame.positions, f(dense_points(name)), rtol=0, atol=atol)
        assert (frame.curbed, frame.rho, frame.share) == (0.0, 1.0, 1.0)


@pytest.mark.parametrize("name", SHAPES)
def test_limits_hold_for_any_weights(name):
    check_limits(name, 8, seed=1)


@pytest.mark.parametrize("name", PINS)
def test_pins_and_limits_hold_for_any_weights(name):
    check_limits(name, 6, seed=2, pins=PINS[name])


@pytest.mark.long
@pytest.mark.parametrize("name", SHAPES)
def test_limits_hold_for_hundreds_of_settings(name):
    check_limits(name, 200, seed=3)


@pytest.mark.long
@pytest.mark.parametrize("name", PINS)
def test_pins_hold_for_tens_of_settings(name):
    check_limits(name, 60, seed=4, pins=PINS[name])


def wild(name, poses=POSES):
    """Weights far outside the poses that curb the shape."""
    return next(w for w in settings(100, 5, poses) if slider(name).frame(w).curbed > 0.1)


@pytest.mark.parametrize("name", ["l", "ring"])
def test_curbed_frames_are_harmonic_maps(name):
    shape = boundary_of(name)
    inside = dense_points(name)[-40:][::4]
    e = 2e-4 * shape.size
    around = np.concatenate([inside, inside + e, inside - e, inside + 1j * e, inside - 1j * e])
    frame = slider(name, points=tuple(around)).frame(wild(name))
    _, right, left, up, down = frame.positions.reshape(5, -1)
    by_x, by_y = (right - left) / (2 * e), (up - down) / (2 * e)
    count = len(inside)
    assert_allclose((by_x - 1j * by_y) / 2, frame.fz[:count], rtol=0, atol=1e-3)
    assert_allclose((by_x + 1j * by_y) / 2, frame.fzbar[:count], rtol=0, atol=1e-3)


def test_curbed_frames_close_around_a_hole():
    turns = np.exp(2j * np.pi * np.arange(256) / 256)
    frame = slider("ring", points=tuple(0.75 * turns)).frame(wild("ring"))
    dz = 0.75 * turns * 2j * np.pi / 256
    assert abs(np.sum(frame.fz * dz + frame.fzbar * dz.conj())) < 1e-6
    steps = np.abs(np.diff(frame.positions, append=frame.positions[0]))
    assert steps.max() < 3 * np.median(steps)


@pytest.mark.parametrize("name", ["u", "ring"])
def test_frames_are_continuous_where_the_curb_begins(name):
    poses, weights = slider(name), wild(name)
    rest = np.eye(POSES)[0]

    def at(share):
        return poses.frame(rest + share * (weights - rest))

    free, curbed = 0.0, 1.0
    for _ in range(30):
        middle = (free + curbed) / 2
        free, curbed = (
            (free, middle) if at(middle).curbed or at(middle).rho < 1 else (middle, curbed)
        )
    before, after = at(free), at(curbed)
    assert 0.0 < free < 1.0
    assert_allclose(after.positions, before.positions, rtol=0, atol=1e-6)
    assert_allclose(after.fz, before.fz, rtol=0, atol=1e-5)


def test_crossed_sliders_end_the_same_in_any_order():
    poses, first, second = slider("bar"), np.eye(POSES)[1], np.eye(POSES)[2]
    rest = np.eye(POSES)[0]
    ways = (0.4 * first + 0.6 * rest, 1.2 * second - 0.2 * rest)
    both = ways[0] + ways[1] - rest
    found = []
    for way in ways:
        poses.frame(way)
        found.append(poses.frame(both).positions)
    assert np.array_equal(*found)


def turned(shape, angle):
    f = HarmonicMap.identity(shape[1])
    spin = np.exp(1j * angle)
    return HarmonicMap(cage=f.cage, phi=spin * f.phi, psi=np.conj(spin) * f.psi)


@pytest.mark.parametrize("whole", [0, 1, -2])
def test_turns_of_poses_blend_apart_from_shapes(whole):
    shape = bar()
    z = dense_points("bar")
    sites = sample_domain(boundary_of("bar"), z)
    extension = transform_of("bar").at(sites.paths.nodes)
    maps = (HarmonicMap.identity(shape[1]), turned(shape, 2.5))
    poses = PoseBlend.of(maps, sites, extension, turns=[0, whole])
    anchor = sites.anchor
    for share in (-0.3, 0.4, 1.3):
        angle = share * (2.5 + 2 * np.pi * whole)
        place = anchor * (1 - share) + share * anchor * np.exp(2.5j)
        wanted = place + np.exp(1j * angle) * (z - anchor)
        assert_allclose(poses.frame([1 - share, share]).positions, wanted, rtol=0, atol=1e-7)


def test_pose_beyond_the_limits_is_curbed():
    bounds = Bounds(k=0.3, sigma_a=1.3, sigma_b=0.7)
    frame = slider("l", bounds=bounds).frame(np.eye(POSES)[3])
    assert frame.curbed > 0.0
    assert excess_of(frame, bounds) < OF_LIMITS


def test_slider_gives_way_where_pins_and_limits_disagree():
    bounds = Bounds(k=0.1, sigma_a=1.1, sigma_b=0.9)
    shape, pins = bar(), (-1.7 + 0j, 0j, 1.7 + 0j)
    sites = sample_domain(boundary_of("bar"), dense_points("bar"))
    extension = transform_of("bar").at(sites.paths.nodes)
    maps = (HarmonicMap.identity(shape[1]), bent(shape, stretch=1.0, bend=0.9))
    poses = PoseBlend.of(maps, sites, extension, bounds=bounds, pins=pins)
    frame = poses.frame([-0.5, 1.5])
    assert 0.0 <= frame.share < 1.0
    assert excess_of(frame, bounds) < OF_LIMITS


def test_one_pose_is_a_slider():
    frame = slider("bar", count=1).frame([1.0])
    assert_allclose(frame.positions, dense_points("bar"), rtol=0, atol=1e-11)


@pytest.mark.parametrize("reach", [0.4, 1.3])
def test_motion_of_keyed_weights_becomes_series(reach):
    points = tuple(dense_points("bar")[::5])
    poses, probed = slider("bar", points=points), slider("bar", points=points[::4])

    def weights(time):
        value = np.zeros(POSES)
        value[1:3] = reach * time, 0.5 * reach * time**2
        value[0] = 1.0 - value.sum()
        return value

    motion = SliderMotion(poses=poses, probed=probed, weights=weights, tolerance=4e-4)
    series = finish(build_series(motion))
    times = [time for time in np.linspace(0, 1, 23) if series.covers(time)]
    assert len(times) > 18
    for time in times:
        assert_allclose(series.values(time), motion.sample(time), rtol=0, atol=motion.tolerance)


def other_map():
    return HarmonicMap.identity(letter_l()[1])


BAD = {
    "no poses": ({"poses": ()}, "1 to 8 poses, not 0"),
    "many poses": ({"poses": 9}, "1 to 8 poses, not 9"),
    "no map": ({"poses": ["rest"]}, "pose 0"),
    "no list": ({"poses": 5.0}, "poses must be a list"),
    "another domain": ({"poses": [other_map]}, "Pose 0 has another cage"),
    "few turns": ({"turns": [1]}, "each of its 2 poses"),
    "part of a turn": ({"turns": [0, 0.5]}, "each of its 2 poses"),
    "pin outside": ({"pins": [9.0]}, "outside"),
    "pin nowhere": ({"pins": [np.nan]}, "pins must be finite"),
    "no bounds": ({"bounds": 0.8}, "bounds"),
}


@pytest.mark.parametrize("case", BAD)
def test_slider_refuses_bad_input(case):
    changes, message = BAD[case]
    sites = sample_domain(boundary_of("bar"), [0j])
    poses = changes.get("poses", maps_of("bar")[:2])
    if isinstance(poses, int):
        poses = maps_of("bar")[:1] * poses
    elif isinstance(poses, list) and callable(poses[0]):
        poses = [each() for each in poses]
    others = {name: value for name, value in changes.items() if name != "poses"}
    extension = transform_of("bar").at(sites.paths.nodes)
    with pytest.raises(EngineError, match=message):
        PoseBlend.of(poses, sites, extension, **others)


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        ([0.5, 0.4], "must sum to 1, not 0.9"),
        ([np.nan, 1.0], "Weight 0 of the slider must be a finite number, not nan"),
        ([1.0], "2 poses needs 2 weights"),
        ([[0.5, 0.5]], "2 poses needs 2 weights"),
        (["a", "b"], "real numbers"),
    ],
)
def test_slider_refuses_bad_weights(weights, message):
    with pytest.raises(EngineError, match=message):
        slider("bar", count=2).frame(weights)


def test_slider_refuses_the_transform_of_another_outline():
    sites = sample_domain(boundary_of("bar"), [0j])
    extension = transform_of("l").at(np.array([0.5 + 0.5j]))
    with pytest.raises(EngineError, match="Build the transform again"):
        PoseBlend.of(maps_of("bar")[:2], sites, extension)

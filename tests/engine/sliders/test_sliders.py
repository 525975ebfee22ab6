"""Pose sliders: exact poses, limits for any weights, on any in-betweens, holes, pins, turns."""

from functools import cache, partial

import holed_shapes
import interpolation_shapes
import numpy as np
import pytest
from interpolation_shapes import bar, bent, letter_l, narrow_u, scattered_on
from numpy.testing import assert_allclose

from engine.dirichlet import HilbertTransform
from engine.errors import EngineError
from engine.interpolation import (
    KeyframeBlend,
    KeyframeSegment,
    SpanBasis,
    Variant,
    prepare_inbetweens,
    sample_domain,
    sample_keyframes,
)
from engine.maps import Boundary, Bounds, HarmonicMap, LocalBounds, distortion
from engine.paths import root_sheets
from engine.sliders import FrameSolver, SliderPoses

POSES = 8
SIMPLE = {"bar": bar, "l": letter_l, "u": narrow_u}
HOLED = {
    "ring": partial(holed_shapes.ring, sides=20),
    "plate": partial(holed_shapes.plate, count=2, pieces=6),
}
SHAPES = (*SIMPLE, *HOLED)
OF_LIMITS = 3e-3  # allowed excess, relative to a limit
OF_PINS = 2e-4  # allowed drift of pins; the shapes are 2 to 4 long
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


class Slider:
    """Poses of a domain at points, added to an in-between of two maps by weights."""

    def __init__(self, name, points, maps, bounds, *, pins=(), turns=None, base=None):
        boundary, transform = boundary_of(name), transform_of(name)
        anchor = HOLED[name]().anchor if name in HOLED else None
        rest = maps_of(name)[0]
        base = base or (Variant.ETA, (rest, rest), 0.0)
        turns = np.zeros(len(maps), int) if turns is None else np.array(turns)
        sites = sample_domain(boundary, points, anchor=anchor)
        self.anchor = sites.anchor
        pins = np.array(pins, dtype=complex)
        self.solver = FrameSolver.of(maps, turns, sites, transform, bounds, pins)
        self.base, self.time = _inbetweens(sites, transform, *base)
        self.poses = SliderPoses.of(sample_keyframes(maps, sites), turns, sites)
        beside = sample_domain(boundary, [sites.anchor], anchor=anchor, values_at=self.solver.nodes)
        known, time = _inbetweens(beside, transform, *base)
        self.values = known.frame_with_values(time)[1]
        self.extension = transform.at(sites.paths.nodes)
        self.basis = SpanBasis.of(boundary.span, sites.paths.nodes)

    def solution(self, weights):
        return self.solver.solve(np.array(weights, float), self.values)

    def frame(self, weights):
        solution = self.solution(weights)
        basis = None if solution.forms is None else self.basis.combined(solution.forms)
        added = (self.base, self.time, solution, self.extension, basis)
        return self.poses.add_to(*added).frame(), solution


def _inbetweens(sites, transform, variant, maps, time):
    samples = sample_keyframes(maps, sites)
    sheets = root_sheets(np.array([each.anchor_fz for each in samples]), (0,))
    segment = KeyframeSegment(
        sampled_domain=sites,
        keyframe_blend=KeyframeBlend.of(samples, sheets),
        bounds=Bounds(),
        transform=transform.at(sites.paths.nodes) if variant.needs_transform else None,
    )
    return prepare_inbetweens(variant, segment), time


@cache
def slider(name, *, count=POSES, pins=(), points=None, bounds=None, base=None):
    """The poses but the one at rest."""
    points = dense_points(name) if points is None else np.array(points)
    maps, bounds = maps_of(name)[1:count], bounds or bounds_of(name)
    return Slider(name, points, maps, bounds, pins=pins, base=base)


def settings(count, seed, poses=POSES):
    """Random sliders from −30 to 130 %, of which a random number is moved."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        moved = rng.permutation(poses - 1)[: rng.integers(1, poses)]
        weights = np.zeros(poses - 1)
        weights[moved] = rng.uniform(-0.3, 1.3, len(moved))
        yield weights


def excess_of(frame, bounds):
    """Return how far a frame exceeds each limit, relative to it."""
    over = (frame.k.max() / bounds.k, frame.sigma_a.max() / bounds.sigma_a)
    return max(*over, 2.0 - frame.sigma_b.min() / bounds.sigma_b) - 1.0


def check_limits(name, count, seed, pins=()):
    poses, bounds, curbed = slider(name, pins=pins), bounds_of(name), 0
    rest, *places = (f(np.array(pins)) for f in maps_of(name))
    pinned = slider(name, pins=pins, points=pins) if pins else None
    for weights in settings(count, seed):
        frame, solution = poses.frame(weights)
        assert excess_of(frame, bounds) < OF_LIMITS
        curbed += solution.curbed > 0
        if pinned is not None:
            reached, solution = pinned.frame(weights)
            wanted = rest + solution.weights @ (np.array(places) - rest)
            stretch = abs(np.diff(wanted) / np.diff(rest))[0]
            if 0.6 < stretch < 1.6:  # far from what the limits forbid
                assert_allclose(reached.positions, wanted, rtol=0, atol=OF_PINS)
    assert curbed > count / 4


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("pins", [False, True])
def test_poses_within_the_limits_are_exact(name, pins):
    poses = slider(name, pins=PINS.get(name, ()) if pins else ())
    for weights, f in zip(np.eye(POSES - 1), maps_of(name)[1:], strict=True):
        frame, solution = poses.frame(weights)
        atol = 1e-12 * boundary_of(name).size
        assert_allclose(frame.positions, f(dense_points(name)), rtol=0, atol=atol)
        assert (solution.curbed, solution.rho, solution.share) == (0.0, 1.0, 1.0)


@pytest.mark.parametrize("name", SHAPES)
def test_limits_hold_for_any_weights(name):
    check_limits(name, 8, seed=1)


@pytest.mark.parametrize("name", PINS)
def test_pins_and_limits_hold_for_any_weights(name):
    check_limits(name, 6, seed=2, pins=PINS[name])


@pytest.mark.parametrize("variant", [*Variant])
def test_sliders_at_zero_leave_the_inbetween(variant):
    base = (variant, (maps_of("bar")[2], maps_of("bar")[3]), 0.4)
    poses = slider("bar", base=base, bounds=Bounds(k=0.9, sigma_a=9.0, sigma_b=0.1))
    frame, _ = poses.frame(np.zeros(POSES - 1))
    wanted = poses.base.frame(0.4)
    assert_allclose(frame.positions, wanted.positions, rtol=0, atol=1e-12)
    assert_allclose(frame.fzbar, wanted.fzbar, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", ["l", "ring"])
def test_limits_hold_on_top_of_inbetweens(name):
    base = (Variant.METRIC, (maps_of(name)[2], maps_of(name)[3]), 0.4)
    poses, curbed = slider(name, base=base), 0
    for weights in settings(6, seed=6):
        frame, solution = poses.frame(weights)
        assert excess_of(frame, bounds_of(name)) < OF_LIMITS
        curbed += solution.curbed > 0
    assert curbed > 2


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
    return next(w for w in settings(100, 5, poses) if slider(name).solution(w).curbed > 0.1)


@pytest.mark.parametrize("name", ["l", "ring"])
def test_curbed_frames_are_harmonic_maps(name):
    shape = boundary_of(name)
    inside = dense_points(name)[-40:][::4]
    e = 2e-4 * shape.size
    around = np.concatenate([inside, inside + e, inside - e, inside + 1j * e, inside - 1j * e])
    frame = slider(name, points=tuple(around)).frame(wild(name))[0]
    _, right, left, up, down = frame.positions.reshape(5, -1)
    by_x, by_y = (right - left) / (2 * e), (up - down) / (2 * e)
    count = len(inside)
    assert_allclose((by_x - 1j * by_y) / 2, frame.fz[:count], rtol=0, atol=1e-3)
    assert_allclose((by_x + 1j * by_y) / 2, frame.fzbar[:count], rtol=0, atol=1e-3)


def test_curbed_frames_close_around_a_hole():
    turns = np.exp(2j * np.pi * np.arange(256) / 256)
    frame = slider("ring", points=tuple(0.75 * turns)).frame(wild("ring"))[0]
    dz = 0.75 * turns * 2j * np.pi / 256
    assert abs(np.sum(frame.fz * dz + frame.fzbar * dz.conj())) < 1e-6
    steps = np.abs(np.diff(frame.positions, append=frame.positions[0]))
    assert steps.max() < 3 * np.median(steps)


@pytest.mark.parametrize("name", ["u", "ring"])
def test_frames_are_continuous_where_the_curb_begins(name):
    poses, weights = slider(name), wild(name)
    free, curbed = 0.0, 1.0
    for _ in range(30):
        middle = (free + curbed) / 2
        found = poses.solution(middle * weights)
        free, curbed = (free, middle) if found.curbed or found.rho < 1 else (middle, curbed)
    (before, _), (after, _) = poses.frame(free * weights), poses.frame(curbed * weights)
    assert 0.0 < free < 1.0
    assert_allclose(after.positions, before.positions, rtol=0, atol=1e-6)
    assert_allclose(after.fz, before.fz, rtol=0, atol=1e-5)


def test_crossed_sliders_end_the_same_in_any_order():
    poses, (first, second, *_) = slider("bar"), np.eye(POSES - 1)
    found = []
    for way in (0.4 * first, 1.2 * second):
        poses.frame(way)
        found.append(poses.frame(0.4 * first + 1.2 * second)[0].positions)
    assert np.array_equal(*found)


def turned(shape, angle):
    f = HarmonicMap.identity(shape[1])
    spin = np.exp(1j * angle)
    return HarmonicMap(cage=f.cage, phi=spin * f.phi, psi=np.conj(spin) * f.psi)


@pytest.mark.parametrize("whole", [0, 1, -2])
def test_turns_of_poses_blend_apart_from_shapes(whole):
    z = dense_points("bar")
    poses = Slider("bar", z, (turned(bar(), 2.5),), Bounds(), turns=[whole])
    anchor = poses.anchor
    for share in (-0.3, 0.4, 1.3):
        angle = share * (2.5 + 2 * np.pi * whole)
        place = anchor * (1 - share) + share * anchor * np.exp(2.5j)
        wanted = place + np.exp(1j * angle) * (z - anchor)
        assert_allclose(poses.frame([share])[0].positions, wanted, rtol=0, atol=1e-7)


def test_pose_beyond_the_limits_is_curbed():
    bounds = Bounds(k=0.3, sigma_a=1.3, sigma_b=0.7)
    frame, solution = slider("l", bounds=bounds).frame(np.eye(POSES - 1)[2])
    assert solution.curbed > 0.0
    assert excess_of(frame, bounds) < OF_LIMITS


def test_slider_gives_way_where_pins_and_limits_disagree():
    bounds = Bounds(k=0.1, sigma_a=1.1, sigma_b=0.9)
    maps = (bent(bar(), stretch=1.0, bend=0.9),)
    pins = (-1.7 + 0j, 0j, 1.7 + 0j)
    frame, solution = Slider("bar", dense_points("bar"), maps, bounds, pins=pins).frame([1.5])
    assert 0.0 <= solution.share < 1.0
    assert excess_of(frame, bounds) < OF_LIMITS


@pytest.mark.parametrize("weights", [[0.5, np.nan], [1.0], [[0.5, 0.5]]])
def test_slider_refuses_bad_weights(weights):
    with pytest.raises(EngineError, match="2 poses needs 2 finite weights"):
        slider("bar", count=3).solution(weights)


def test_slider_refuses_poses_of_another_domain():
    other = HarmonicMap.identity(letter_l()[1])
    with pytest.raises(EngineError, match="Pose 1 has another cage"):
        Slider("bar", [0j], (maps_of("bar")[1], other), Bounds())


def test_slider_refuses_the_transform_of_another_outline():
    sites = sample_domain(boundary_of("bar"), [0j])
    given = (maps_of("bar")[1:2], np.zeros(1, int), sites, transform_of("l"), Bounds())
    with pytest.raises(EngineError, match="Build the transform again"):
        FrameSolver.of(*given, np.empty(0, complex))


def test_local_limits_hold_where_they_are():
    boundary, plain = boundary_of("bar"), bounds_of("bar")
    own, _ = boundary.original_samples
    k = np.where(boundary.points[own].real < 0, 0.12, plain.k)
    local = LocalBounds(k=k, sigma_a=plain.sigma_a, sigma_b=plain.sigma_b)
    points = dense_points("bar")
    poses = Slider("bar", points, maps_of("bar")[1:], local)
    left, curbed = points.real < -0.2, 0
    for weights in settings(6, seed=8):
        frame, solution = poses.frame(weights)
        curbed += solution.curbed > 0
        assert frame.k[left].max() < 0.12 * (1 + OF_LIMITS)
        assert excess_of(frame, plain) < OF_LIMITS
    assert curbed > 2

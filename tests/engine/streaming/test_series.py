"""Series in time against the direct path, and what they cost."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from holed_shapes import inner_points as holed_points, ring
from hypothesis import given, settings, strategies as st
from interpolation_shapes import (
    bar,
    bent,
    inner_points,
    letter_l,
    narrow_u,
    random_map,
    stage_of,
)
from numpy.testing import assert_allclose, assert_array_equal

from engine.errors import EngineError
from engine.geometry import Domain
from engine.interpolation import Variant, chebyshev, prepare
from engine.maps import Boundary, HarmonicMap, distortion
from engine.streaming import Distortions, Positions, build_series, finish
from engine.streaming.functions import DEGREES, MOST_ATTEMPTS
from engine.streaming.splitting import MOST_ROWS, OF_PIECES

SHAPES = {"bar": bar(), "letter L": letter_l(), "narrow U": narrow_u(0.1)}
cases = st.tuples(st.sampled_from(sorted(SHAPES)), st.integers(0, 10_000))


def prepared(name, variant, maps):
    outline, _ = SHAPES[name]
    points = np.concatenate([inner_points(outline, 200, 1), outline])
    return stage_of(SHAPES[name], points).between(maps, variant)


def random_pair(name, seed):
    return [random_map(SHAPES[name], 2 * seed + i) for i in range(2)]


def direct(between, time):
    return between.frame(time)


def as_complex(values):
    return values.astype(float).view(complex)


@dataclass(frozen=True)
class Curves:
    """Values that have nothing to do with maps."""

    function: object
    tolerance: float = 1e-6
    probe: object = None

    def __post_init__(self):
        object.__setattr__(self, "probe", self.probe or self.every)

    def sample(self, time):
        return np.asarray(self.function(time), dtype=float)

    def every(self, times):
        return np.array([self.sample(time) for time in times.tolist()])


@pytest.mark.parametrize("variant", Variant)
@given(case=cases, seed=st.integers(0, 10_000))
@settings(max_examples=2)
def test_positions_are_those_of_the_direct_path(variant, case, seed):
    between = prepared(case[0], variant, random_pair(*case))
    channels = Positions.of(between, between.sampled_domain)
    diameter = between.sampled_domain.diameter
    largest = max(np.abs(key.positions).max() for key in between.keyframe_blend.ends)
    assert channels.tolerance <= max(1e-6 * diameter, 5e-7 * largest)
    series = finish(build_series(channels))
    for time in np.random.default_rng(seed).random(12):
        found, expected = as_complex(series.values(time)), direct(between, time).positions
        assert_allclose(found, expected, rtol=0, atol=channels.tolerance)
    assert series.error < channels.tolerance
    assert max(len(piece.rows) for piece in series.pieces) <= MOST_ROWS


@pytest.mark.parametrize("variant", Variant)
def test_keyframes_are_exact_to_float32(variant):
    between = prepared("letter L", variant, random_pair("letter L", 5))
    series = finish(build_series(Positions.of(between, between.sampled_domain)))
    for time, key in enumerate(between.keyframe_blend.ends):
        expected = key.positions.astype(np.complex64)
        assert_array_equal(series.values(float(time)).view(np.complex64), expected)
        beside = series.values(abs(time - 1e-9)).view(np.complex64)
        assert_allclose(beside, expected, rtol=0, atol=1e-6)


@pytest.mark.parametrize("variant", Variant)
def test_distortions_are_those_of_the_direct_path(variant):
    between = prepared("letter L", variant, random_pair("letter L", 8))
    series = finish(build_series(Distortions.of(between, between.sampled_domain)))
    for time in np.random.default_rng(0).random(12):
        fz, fzbar = as_complex(series.values(time)).reshape(2, -1)
        frame = direct(between, time)
        for measure in (distortion.sigma_a, distortion.sigma_b):
            largest = np.abs(measure(frame.fz, frame.fzbar)).max()
            difference = measure(fz, fzbar) - measure(frame.fz, frame.fzbar)
            assert_allclose(difference / largest, 0, rtol=0, atol=5e-5)
        k = distortion.k(frame.fz, frame.fzbar)
        assert_allclose(distortion.k(fz, fzbar), k, rtol=0, atol=3e-4)


def test_a_scaled_map_far_from_its_bounds_has_its_rho_in_the_series():
    # As in Figure 4: |f_z| grows by more than the root of e, and η must be scaled.
    _, cage = SHAPES["bar"]
    grown = 2 * np.exp(0.5 * cage + 1)
    maps = [bent(SHAPES["bar"]), bent(SHAPES["bar"])]
    maps[1] = type(maps[0])(cage=cage, phi=grown, psi=0.4 * grown)
    between = prepared("bar", "scaled-eta", maps)
    assert min(between.rho(time) for time in (0.25, 0.5, 0.75)) < 0.9
    series = finish(build_series(Positions.of(between, between.sampled_domain)))
    for time in np.random.default_rng(3).random(60):
        expected = direct(between, time).positions
        atol = 1e-6 * between.sampled_domain.diameter
        assert_allclose(as_complex(series.values(time)), expected, rtol=0, atol=atol)


def extreme_pair(kind):
    """Return keys at the edge of what is locally injective, or of very different sizes."""
    _, cage = SHAPES["bar"]
    curl = (np.exp(0.7j * cage) - 1) / 0.7j
    amounts = {
        "k .95": ((1, 0.95), (1, -0.95j)),
        "k .99": ((1, 0.99), (1, -0.99)),
        "from 20 to .05": ((20, 8), (0.05, 0.01)),
    }
    (phi0, psi0), (phi1, psi1) = amounts[kind]
    return [
        HarmonicMap(cage=cage, phi=phi0 * cage, psi=psi0 * cage),
        HarmonicMap(cage=cage, phi=phi1 * curl, psi=psi1 * curl),
    ]


@pytest.mark.parametrize("variant", ["nu", "scaled-eta", "metric"])
@pytest.mark.parametrize("kind", ["k .95", "k .99", "from 20 to .05"])
def test_extreme_keys_are_streamed_as_accurately_and_from_few_samples(variant, kind):
    between = prepared("bar", variant, extreme_pair(kind))
    channels = Positions.of(between, between.sampled_domain)
    times = []
    counted = Curves(lambda t: times.append(t) or channels.sample(t), channels.tolerance)
    counted = replace(counted, probe=channels.probe)
    series = finish(build_series(counted))
    assert len(times) < 40
    missing = 1.0 - sum(piece.end - piece.start for piece in series.pieces)
    assert missing < 1e-3
    rng = np.random.default_rng(7)
    beside = 10.0 ** -rng.uniform(1, 6, 8)
    for time in [*rng.random(8), *beside, *(1 - beside)]:
        if series.covers(time):
            found = as_complex(series.values(time))
            expected = direct(between, time).positions
            assert_allclose(found, expected, rtol=0, atol=channels.tolerance)


def test_points_that_move_alike_share_their_functions_of_time():
    # Below 1 in size: the rounding of float32 must stay well under the tolerance.
    directions = np.random.default_rng(0).uniform(-0.5, 0.5, size=5000)
    series = finish(build_series(Curves(lambda t: directions * np.sin(9 * t))))
    (piece,) = series.pieces
    assert len(piece.rows) == 3  # of both ends, and one more
    assert series.nbytes < 3 * 4 * 5000 + 10_000
    assert_array_equal(series.values(0.0), 0)


def test_pieces_are_short_where_the_motion_is_hard():
    places = np.linspace(0, 1, 400)
    peak = 0.015

    def function(t):
        return places / ((t - 0.3) ** 2 + peak**2) * peak**2

    series = finish(build_series(Curves(function)))
    lengths = {piece.start: piece.end - piece.start for piece in series.pieces}
    assert len(lengths) > 2
    assert min(lengths, key=lengths.get) == pytest.approx(0.3, abs=0.1)
    for t in np.random.default_rng(0).random(200):
        assert_allclose(series.values(t), function(t), rtol=0, atol=1e-6)
    assert [p.end for p in series.pieces[:-1]] == [p.start for p in series.pieces[1:]]
    for piece in series.pieces[1:]:
        left, right = (series.values(piece.start + side) for side in (-1e-9, 1e-9))
        assert_allclose(left, right, rtol=0, atol=1e-6)


def test_hardly_more_pieces_are_cut_than_two_functions_need():
    # Smooth motions that a sudden bend in time is a factor of: lengths change from piece to piece.
    places = np.linspace(0, 1, 40)

    def function(t):
        bends = sum(np.hypot(t - bend, 0.01) for bend in (0.2, 0.8))
        return np.cos(3 * places * t) + bends * np.exp(places * t)

    def error(start, end):
        blend = np.linspace(0, 1, 40)[:, None]
        values = np.array([function(start + (end - start) * x) for x in blend[:, 0]])
        added = values - (1 - blend) * values[0] - blend * values[-1]
        left, sizes, right = np.linalg.svd(added, full_matrices=False)
        return np.abs((left[:, 2:] * sizes[2:]) @ right[2:]).max()

    pieces = finish(build_series(Curves(function))).pieces
    place, fewest = 0.0, 0
    while place < 1.0:
        low, high = 0.0, 1.0 - place
        while error(place, place + high) > OF_PIECES * 1e-6 and high - low > 0.01 * high:
            middle = (low + high) / 2
            accurate = error(place, place + middle) <= OF_PIECES * 1e-6
            low, high = (middle, high) if accurate else (low, middle)
        place, fewest = place + high, fewest + 1
    assert len(pieces) <= 1.15 * fewest + 1, (len(pieces), fewest)


def test_what_float32_cannot_hold_is_left_to_the_direct_path():
    # Large values that matter to the last digit: no piece is short enough, and none is kept.
    places = np.linspace(0.9, 1, 40)
    calls = []

    def function(t):
        calls.append(t)
        return 1e4 * places * np.exp(t)

    series = finish(build_series(Curves(function)))
    assert series.pieces == ()
    assert not any(series.covers(t) for t in (0.0, 0.3, 1.0))
    assert len(calls) < MOST_ATTEMPTS * 40
    with pytest.raises(EngineError, match="this time directly"):
        series.values(0.3)


def test_series_without_pieces_guarantees_nothing():
    rng = np.random.default_rng(0)
    series = finish(build_series(Curves(lambda _: rng.normal(size=5))))
    assert series.pieces == ()
    assert series.error == np.inf
    assert series.size == series.nbytes == 0
    assert not series.covers(0.5)


def test_a_hard_moment_costs_no_more_than_itself():
    places = np.linspace(0, 1, 40)

    def function(t):
        return places * abs(t - 0.3) ** 0.2

    series = finish(build_series(Curves(function)))
    assert series.error <= 1e-6
    assert not series.covers(0.3)
    missing = 1.0 - sum(piece.end - piece.start for piece in series.pieces)
    assert 0 < missing < 0.01
    for t in np.random.default_rng(0).random(200):
        if series.covers(t):
            assert_allclose(series.values(t), function(t), rtol=0, atol=1e-6)


def test_many_functions_of_time_are_parted_in_pieces():
    turns = np.linspace(-30, 30, 3000)
    series = finish(build_series(Curves(lambda t: np.cos(turns * t))))
    assert len(series.pieces) > 1
    assert max(len(piece.rows) for piece in series.pieces) <= MOST_ROWS


def test_what_jumps_is_left_to_the_direct_path():
    series = finish(build_series(Curves(lambda t: np.array([float(t > 0.317), t]))))
    assert series.error <= 1e-6
    assert not series.covers(0.317)
    assert all(series.covers(t) for t in (0.0, 0.3169, 0.3171, 1.0))
    assert len(series.pieces) < 20


def test_far_from_the_origin_the_tolerance_is_what_float32_holds():
    maps = [bent(SHAPES["bar"], shift=9000j), bent(SHAPES["bar"], bend=0.7, shift=9000j)]
    between = prepared("bar", "nu", maps)
    series = finish(build_series(Positions.of(between, between.sampled_domain)))
    assert len(series.pieces) == 1
    found = as_complex(series.values(0.4))
    assert_allclose(found, direct(between, 0.4).positions, rtol=0, atol=9000 * 2**-21)


def test_building_goes_in_small_steps_that_may_take_turns():
    motions = [prepared("bar", variant, random_pair("bar", 2)) for variant in ("nu", "metric")]
    channels = [Positions.of(motion, motion.sampled_domain) for motion in motions]
    calls = []

    @dataclass(frozen=True)
    class Counted:
        source: Positions
        probe = property(lambda self: self.source.probe)
        tolerance = property(lambda self: self.source.tolerance)

        def sample(self, time):
            calls.append(time)
            return self.source.sample(time)

    waiting = [(build_series(Counted(source)), finish(build_series(source))) for source in channels]
    calls.clear()
    steps = 0
    while waiting:
        steps += 1
        before = len(calls)
        build, expected = waiting.pop(0)
        try:
            next(build)
            waiting.append((build, expected))
        except StopIteration as stop:
            assert_array_equal(stop.value.values(0.37), expected.values(0.37))
        assert len(calls) - before <= 1
    assert steps > 2 * DEGREES[0]


def test_values_are_written_where_they_are_wanted():
    series = finish(build_series(Curves(lambda t: np.linspace(0, 1, 50) * np.exp(t))))
    room = np.zeros(50, dtype=np.float32)
    assert series.values(0.3, out=room) is room
    assert_array_equal(room, series.values(0.3))
    assert series.size == 50
    for time in (-0.1, 1.1):
        with pytest.raises(EngineError, match="from time 0 to 1"):
            series.values(time)


@pytest.mark.parametrize("degree", DEGREES)
def test_chebyshev_coefficients_and_their_basis(degree):
    assert_allclose(
        chebyshev.chebyshev_nodes(2 * degree)[::2],
        chebyshev.chebyshev_nodes(degree),
        rtol=0,
        atol=1e-15,
    )
    rng = np.random.default_rng(degree)
    expected = rng.normal(size=degree + 1)
    values = np.polynomial.chebyshev.chebval(chebyshev.chebyshev_nodes(degree), expected)
    assert_allclose(chebyshev.to_coefficients(degree) @ values, expected, rtol=0, atol=1e-12)
    for x in (-1.0, -0.3, 0.77, 1.0):
        found = chebyshev.chebyshev_basis(x, degree + 1) @ expected
        assert_allclose(found, np.polynomial.chebyshev.chebval(x, expected), rtol=0, atol=1e-12)


@pytest.mark.parametrize("variant", ["nu", "scaled-eta", "metric"])
def test_a_hole_alone_adds_no_rows(variant):
    """A streamed frame costs what its rows say: with a hole the same as without."""
    shape = ring()
    whole = [
        HarmonicMap.identity(shape.cage),
        HarmonicMap(cage=shape.cage, phi=np.exp(0.4j * shape.cage), psi=0.1 * shape.cage),
    ]
    hole = np.zeros(len(shape.holes[0].cage))
    holed = [
        HarmonicMap(
            cage=shape.cage,
            phi=np.append(f.phi, hole),
            psi=np.append(f.psi, hole),
            holes=shape.holes,
            logs=np.zeros(1),
        )
        for f in whole
    ]
    rows = []
    for maps in (whole, holed):
        motion = prepare(
            maps,
            Boundary.sample(Domain(shape.outline, maps[0].cage, maps[0].holes)),
            holed_points(shape),
            variant=variant,
            anchor=shape.anchor,
        )
        series = finish(build_series(Positions.of(motion.segments[0], motion.sampled_domain)))
        rows.append([len(piece.rows) for piece in series.pieces])
    assert rows[0] == rows[1]

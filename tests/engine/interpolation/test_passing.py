"""Motion through keyframes: its velocity, bounds and symmetries, and what a keyframe changes."""

import numpy as np
import pytest
from interpolation_shapes import (
    bent,
    boundary_of,
    distortion_of,
    inner_points,
    letter_l,
    random_map,
    scattered_on,
    transform_of,
)
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from engine.errors import EngineError
from engine.interpolation import (
    BLENDS,
    InteriorKnot,
    KeyframeBlend,
    KeyframeSegment,
    Tangent,
    TimeWeights,
    Variant,
    frame_at,
    prepare,
    prepare_inbetweens,
    prove,
    sample_domain,
    sample_keyframes,
)
from engine.interpolation.keyframe_blend.derivatives import KEYFRAMES_OF_SEGMENT
from engine.maps import Bounds, HarmonicMap
from engine.paths import root_sheets

OUTLINE, CAGE = SHAPE = letter_l()
POINTS = np.concatenate([inner_points(OUTLINE, 30, 0), OUTLINE])
MAPS = [random_map(SHAPE, seed, k=0.3, bend=0.5) for seed in (1, 2, 5, 8)]
WIDE = Bounds(k=0.9, sigma_a=50, sigma_b=0.02)
STEP = 2e-4


def between(maps=MAPS, points=POINTS, shape=SHAPE, **options):
    options = {"variant": "metric", "through": True, "anchor": 0.7 + 0.6j} | options
    if options["variant"] == "metric":
        options["transform"] = transform_of(shape)
    return prepare(maps, boundary_of(shape), points, **options)


def velocity(place, step):
    """Return the one-sided derivative of place(s) at s = 0, to third order."""

    def second_order(e):
        return (-3 * place(0.0) + 4 * place(e) - place(2 * e)) / (2 * e)

    return (4 * second_order(step / 2) - second_order(step)) / 3


def velocities(prepared, key):
    """Return the velocities of the points just before a keyframe and just after it."""
    count = len(prepared.segments)
    before, after = prepared.segments[(key - 1) % count], prepared.segments[key % count]
    return (
        -velocity(lambda s: before.frame(1.0 - s).positions, STEP),
        velocity(lambda s: after.frame(s).positions, STEP),
    )


@pytest.mark.parametrize(
    ("variant", "loop"),
    [
        (Variant.LINEAR, True),
        (Variant.NU, False),
        (Variant.ETA, True),
        (Variant.SCALED_ETA, False),
        (Variant.METRIC, True),
        pytest.param(Variant.SCALED_ETA, True, marks=pytest.mark.long),
        pytest.param(Variant.METRIC, False, marks=pytest.mark.long),
    ],
)
def test_keyframes_are_met_exactly_and_passed_at_one_velocity(variant, loop):
    prepared = between(variant=variant, loop=loop, bounds=WIDE)
    size = prepared.sampled_domain.diameter
    for time, f in enumerate(MAPS):
        assert_allclose(prepared.frame(time).positions, f(POINTS), rtol=0, atol=1e-12 * size)
    if loop:
        assert_allclose(prepared.frame(4).positions, MAPS[0](POINTS), rtol=0, atol=1e-12 * size)
    passed = range(4) if loop else (1, 2)
    found = [velocities(prepared, key) for key in passed]
    largest = np.abs(found).max()
    assert max(np.abs(after - before).max() for before, after in found) < 1e-6 * largest
    # They go on past the keyframes, and do not stop there.
    assert min(prepared.tangents[key] for key in passed) > 0.01
    assert min(np.abs(after).max() for _, after in found) > 0.01 * largest
    plain = between(variant=variant, loop=loop, through=False)
    assert max(np.abs(np.subtract(*velocities(plain, key))).max() for key in passed) > 0.1 * largest


def test_the_velocity_at_a_keyframe_is_the_slope_of_the_parabola_through_three():
    joint = InteriorKnot(2.0, 5.0)
    times = np.array([-2.0, 0.0, 5.0])
    assert_allclose(
        joint.velocity @ np.array([np.ones(3), times, times**2]).T, [0, 1, 0], atol=1e-15
    )
    course = TimeWeights.between(
        Tangent(joint, 0.5, 1.0), Tangent(InteriorKnot(5.0, 1.0), 1.0, 1.0)
    )
    keys = np.array([1.0, -2.0, 3.0, 7.0])
    weights = course.at(np.linspace(0, 1, 7))
    assert_allclose(weights.sum(axis=0), 1, atol=1e-14)
    assert_array_equal(course(0.0), [0, 1, 0, 0])
    assert_array_equal(course(1.0), [0, 0, 1, 0])
    h = 1e-5
    slope = (course(h) - course(0.0)) @ keys / (5.0 * h)
    assert_allclose(slope, 0.5 * joint.velocity @ keys[:3], rtol=1e-4)


def test_corners_and_stops():
    assert TimeWeights.between(1.0, 1.0).is_straight
    times = np.linspace(0, 1, 9)
    assert_allclose(
        TimeWeights.between(0.0, 0.0).at(times)[1], times**2 * (3 - 2 * times), atol=1e-15
    )
    one_sided = TimeWeights.between(1.0, 0.0)
    assert_allclose((one_sided(1e-6)[1]) / 1e-6, 1.0, rtol=1e-5)
    assert_allclose((1 - one_sided(1 - 1e-6)[1]) / 1e-6, 0.0, atol=1e-5)


def test_an_easing_that_slows_time_at_a_key_is_made_up_for():
    joint = InteriorKnot(1.0, 1.0, end_pace=0.5, start_pace=2.0)
    before, after = (
        TimeWeights.between(1.0, Tangent(joint, 1.0, 1.0)),
        TimeWeights.between(Tangent(joint, 1.0, 1.0), 1.0),
    )
    e = 1e-6
    rates = (before(1.0) - before(1.0 - e)) / e * 0.5, (after(e) - after(0.0)) / e * 2.0
    assert_allclose(rates[0], rates[1], atol=1e-5)
    assert_allclose(rates[0], joint.velocity, atol=1e-5)


@pytest.mark.parametrize("variant", list(Variant))
def test_two_keyframes_have_the_in_betweens_of_the_paper(variant):
    plain, passed = (
        between(MAPS[:2], variant=variant, through=through) for through in (False, True)
    )
    assert_array_equal(plain.frame(0.3).positions, passed.frame(0.3).positions)
    # A stop at both ends is the same way at another pace.
    sites = plain.sampled_domain
    sheets = root_sheets(np.array([key.anchor_fz for key in plain.keyframes]))
    keyframe_blend = KeyframeBlend.of(plain.keyframes, sheets, TimeWeights.between(0.0, 0.0))
    extension = transform_of(SHAPE).at(sites.paths.nodes) if variant == "metric" else None
    stopped = prepare_inbetweens(
        variant, KeyframeSegment(sites, keyframe_blend, Bounds(), transform=extension)
    )
    if not variant.is_scaled:  # whose ρ is for other bounds
        eased = plain.frame(0.3**2 * (3 - 2 * 0.3))
        assert_allclose(stopped.frame(0.3).positions, eased.positions, atol=1e-9)


@pytest.mark.parametrize("seed", [0, 3])
def test_metric_keeps_the_bounds_everywhere(seed):
    maps = [random_map(SHAPE, 10 * seed + i, k=0.5, bend=0.8) for i in range(4)]
    along = scattered_on(OUTLINE, 40)
    points = np.concatenate([along, inner_points(OUTLINE, 200, seed)])
    worst = [distortion_of(f, along) for f in maps]
    bounds = Bounds(
        sigma_a=1.05 * max(float(a.max()) for a, _, _ in worst),
        sigma_b=min(0.95 * min(float(b.min()) for _, b, _ in worst), 0.9),
        k=0.5 + 0.5 * max(float(k.max()) for _, _, k in worst),
    )
    prepared = between(maps, points, bounds=bounds, loop=True)
    # The bounds shorten some of the tangents, and leave something of all.
    assert 0.0 < min(prepared.tangents) < 0.99
    for time in np.linspace(0, 4, 81):
        frame = prepared.frame(time)
        a, b = np.abs(frame.fz), np.abs(frame.fzbar)
        assert (a + b).max() <= bounds.sigma_a
        assert (a - b).min() >= bounds.sigma_b
        assert (b / a).max() <= bounds.k


@pytest.mark.parametrize("variant", [Variant.NU, Variant.SCALED_ETA])
def test_other_variants_keep_their_properties(variant):
    maps = [random_map(SHAPE, 30 + i, k=0.5, bend=0.8) for i in range(4)]
    along = scattered_on(OUTLINE, 25)
    bounds = Bounds(k=0.6, sigma_a=8.0, sigma_b=0.15)
    prepared = between(maps, along, variant=variant, bounds=bounds, loop=True)
    for time in np.linspace(0, 4, 61):
        frame = prepared.frame(time)
        a, b = np.abs(frame.fz), np.abs(frame.fzbar)
        assert (b / a).max() <= bounds.k * (1 + 1e-6)
        if variant.is_scaled:
            assert (a + b).max() <= bounds.sigma_a * (1 + 1e-6)
            assert (a - b).min() >= bounds.sigma_b * (1 - 1e-6)


def test_a_keyframe_beyond_the_bounds_is_met_at_a_stop():
    reach = max(float(distortion_of(MAPS[1], OUTLINE)[2].max()), 0.05)
    prepared = between(variant="nu", bounds=Bounds(k=0.5 * reach, sigma_a=50, sigma_b=0.02))
    assert prepared.tangents[1] < 1e-3
    assert np.abs(velocities(prepared, 1)).max() < 0.02 * np.abs(velocities(prepared, 0)[1]).max()


@pytest.mark.parametrize("variant", [Variant.METRIC, Variant.NU])
def test_the_motion_turns_moves_and_grows_with_its_keyframes(variant):
    prepared = between(variant=variant, bounds=WIDE)
    factor, shift = 0.9 * np.exp(2j), 3 - 1j
    moved = [
        HarmonicMap(cage=CAGE, phi=factor * f.phi + shift, psi=np.conj(factor) * f.psi)
        for f in MAPS
    ]
    expected = factor * prepared.frame(1.4).positions + shift
    assert_allclose(
        between(moved, variant=variant, bounds=WIDE).frame(1.4).positions, expected, atol=1e-9
    )
    # And with the drawing.
    larger = [HarmonicMap(cage=7 * CAGE, phi=7 * f.phi, psi=7 * f.psi) for f in MAPS]
    grown = between(
        larger,
        7 * POINTS,
        shape=(7 * OUTLINE, 7 * CAGE),
        anchor=7 * (0.7 + 0.6j),
        variant=variant,
        bounds=WIDE,
    )
    assert_allclose(grown.frame(1.4).positions, 7 * prepared.frame(1.4).positions, atol=1e-8)


@pytest.mark.parametrize(("variant", "loop"), [(Variant.METRIC, True), (Variant.SCALED_ETA, False)])
def test_time_reversed_gives_the_reversed_motion(variant, loop):
    turns = [1, 0, 0, *([-1] if loop else [])]
    back = [0, 0, -1, *([1] if loop else [])]
    forth = between(variant=variant, loop=loop, turns=turns)
    backwards = between(MAPS[::-1], variant=variant, loop=loop, turns=back)
    for time in (0.3, 1.5, 2.9, 3.0):
        one, other = forth.frame(time), backwards.frame(3 - time)
        assert_allclose(one.positions, other.positions, rtol=0, atol=1e-6)


def test_a_keyframe_that_moves_changes_the_four_intervals_around_it():
    maps = [*MAPS, *(random_map(SHAPE, seed, k=0.3, bend=0.5) for seed in (11, 12, 14))]
    changed = [*maps]
    changed[3] = random_map(SHAPE, 20, k=0.3, bend=0.5)
    sequences = [between(these, POINTS[:5], variant="nu") for these in (maps, changed)]
    frames = [[each.frame(i + 0.5).positions for i in range(6)] for each in sequences]
    same = [np.array_equal(one, other) for one, other in zip(*frames, strict=True)]
    assert same == [True, False, False, False, False, True]


def test_a_loop_may_turn_round_and_round():
    maps = [bent(SHAPE, turn=turn, stretch=1.1) for turn in (0.0, 2.0, 4.0)]
    prepared = between(maps, loop=True, bounds=WIDE)
    angles = np.unwrap([np.angle(prepared.frame(t).fz[0]) for t in np.linspace(0, 3, 61)])
    assert_allclose(angles[-1] - angles[0], 2 * np.pi, atol=1e-9)
    assert (np.diff(angles) > 0).all()
    before, after = velocities(prepared, 0)
    assert_allclose(before, after, atol=1e-6 * np.abs(after).max())


def test_a_pose_that_is_kept_is_not_overshot():
    prepared = between([MAPS[0], MAPS[1], MAPS[1], MAPS[2]], bounds=WIDE)
    assert prepared.tangents == (1.0, 0.0, 0.0, 1.0)
    for time in (1.2, 1.5, 1.9):
        assert_allclose(prepared.frame(time).positions, MAPS[1](POINTS), atol=1e-9)


def test_a_tangent_is_the_same_in_any_unit_of_time_and_shrinks_with_the_bounds():
    three = [random_map(SHAPE, seed, k=0.5, bend=0.8) for seed in (1, 2, 3)]

    def length(joint, bounds):
        return BLENDS[Variant.METRIC].tangent(three, joint, bounds, boundary_of(SHAPE)).length

    tight, tighter = (
        Bounds(k=0.8, sigma_a=3.2, sigma_b=0.2),
        Bounds(k=0.75, sigma_a=3.0, sigma_b=0.25),
    )
    lengths = [length(InteriorKnot(3.0, 5.0), b) for b in (WIDE, tight, tighter)]
    assert lengths == sorted(lengths, reverse=True)
    assert_allclose(length(InteriorKnot(0.3, 0.5), tight), lengths[1], rtol=1e-8)


@pytest.mark.parametrize(
    ("variant", "through"),
    [(Variant.METRIC, False), (Variant.METRIC, True), (Variant.SCALED_ETA, True)],
)
def test_a_frame_alone_is_the_same_as_among_the_others(variant, through):
    prepared = between(MAPS[:3], variant=variant, through=through)
    interval, sites = prepared.segments[0], prepared.sampled_domain
    keyframe_blend = interval.keyframe_blend
    own = KeyframeBlend.of(
        keyframe_blend.keyframes, keyframe_blend.sheets, keyframe_blend.eta_time_weights
    )
    alone = KeyframeSegment(
        sites, own, Bounds(), transform=transform_of(SHAPE).at(sites.paths.nodes)
    )
    for time in (0.0, 0.37, 1.0):
        frame = frame_at(time, variant, alone)
        expected = interval.frame(time)
        assert_allclose(frame.positions, expected.positions, rtol=0, atol=2e-7 * sites.diameter)
        assert_allclose(frame.fz, expected.fz, rtol=0, atol=1e-5)
        assert_allclose(frame.fzbar, expected.fzbar, rtol=0, atol=1e-5)
        if time in (0.0, 1.0):
            positions = keyframe_blend.ends[int(time)].positions
            assert_allclose(frame.positions, positions, rtol=0, atol=1e-12)
    with pytest.raises(EngineError, match="from time 0 to 1"):
        frame_at(1.5, variant, alone)


def test_a_course_asks_for_its_keyframes():
    sites = sample_domain(boundary_of(SHAPE), POINTS)
    keys = sample_keyframes(MAPS[:2], sites)
    sheets = root_sheets(np.array([key.anchor_fz for key in keys]))
    course = TimeWeights.between(Tangent(InteriorKnot(1.0, 1.0), 1.0, 1.0), 1.0)
    with pytest.raises(EngineError, match=says(KEYFRAMES_OF_SEGMENT, wanted=3, count=2)):
        KeyframeBlend.of(keys, sheets, course)


def test_tangents_apart_are_those_of_other_keyframes():
    """An interval leads from one motion to another: six keyframes, four of which it does not go to.

    In their order: before, first, last, after, and apart the one after the first in its own motion,
    and the one before the last in its own.
    """
    start, end = (
        Tangent(InteriorKnot(2.0, 3.0), 0.5, 1.0),
        Tangent(InteriorKnot(1.0, 4.0), 0.25, 1.0),
    )
    course = TimeWeights.between(start, end, apart=(True, True))
    assert (course.count, course.first) == (6, 1)
    assert course.support == ([0, 1, 4], [5, 2, 3])
    values = np.array([3.0, -1.0, 2.0, 7.0, 0.5, -4.0])
    controls = course.controls @ values
    velocities = [
        each.length * each.knot.velocity @ values[window]
        for each, window in zip((start, end), course.support, strict=True)
    ]
    assert_allclose(controls[[0, 3]], [-1.0, 2.0], atol=1e-15)
    assert_allclose(
        controls[1] - controls[0], start.knot.control_offsets[1] * velocities[0], atol=1e-14
    )
    assert_allclose(
        controls[2] - controls[3], end.knot.control_offsets[0] * velocities[1], atol=1e-14
    )
    assert_allclose(course.controls.sum(axis=1), 1.0, atol=1e-15)
    assert TimeWeights.between(1.0, end, apart=(False, True)).support[1] == [3, 1, 2]
    assert_allclose(
        course.unlimited.controls[:2],
        TimeWeights.between(Tangent(start.knot, 1.0, 1.0), end, apart=(True, True)).controls[:2],
        atol=1e-15,
    )


@pytest.mark.parametrize("variant", ["nu", "scaled-eta", "metric"])
@pytest.mark.parametrize("bounds", [WIDE, Bounds(k=0.3, sigma_a=2.2, sigma_b=0.5)])
def test_what_leads_to_another_motion_keeps_the_bounds_and_is_proven(variant, bounds):
    sites = sample_domain(boundary_of(SHAPE), POINTS, anchor=0.7 + 0.6j)
    # From the first to the second; in the motion that it leads to the third comes after that, and
    # the fourth before.
    keys = sample_keyframes(MAPS, sites)
    joint = InteriorKnot(1.0, 1.0, end_pace=0.5)
    tangent = BLENDS[Variant(variant)].tangent(
        [MAPS[3], MAPS[1], MAPS[2]], joint, bounds, sites.boundary
    )
    course = TimeWeights.between(1.0, tangent, apart=(False, True))
    sheets = root_sheets(np.array([key.anchor_fz for key in keys]))
    keyframe_blend = KeyframeBlend.of(keys, sheets, course)
    extension = transform_of(SHAPE).at(sites.paths.nodes) if variant == "metric" else None
    interval = prepare_inbetweens(
        Variant(variant), KeyframeSegment(sites, keyframe_blend, bounds, extension)
    )
    assert_allclose(interval.frame(1.0).positions, keys[1].positions, rtol=0, atol=1e-9)
    proof = prove(interval)
    assert proof.is_locally_injective
    for time in (0.3, 0.6, 0.9, 0.97):
        frame = interval.frame(time)
        k = np.abs(frame.fzbar / frame.fz)
        assert k.max() <= proof.k + 1e-6
        if variant == "metric":
            assert k.max() <= max(bounds.k, *(np.abs(key.nu).max() for key in keys)) + 1e-3


def test_a_long_segment_after_a_short_one_has_a_short_tangent():
    # At its full length, the logarithm of |f_z| would overflow.
    maps = [HarmonicMap(cage=CAGE, phi=CAGE * by, psi=0j * CAGE) for by in (1.0, 9.0, 9.1)]
    knot = InteriorKnot(1, 5000)
    tangent = BLENDS[Variant.NU].tangent(maps, knot, WIDE, boundary_of(SHAPE))
    assert 0 <= tangent.length < 0.01

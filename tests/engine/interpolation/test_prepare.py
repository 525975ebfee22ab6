"""What `prepare` accepts and refuses, and whole turns."""

import numpy as np
import pytest
from interpolation_shapes import (
    bar,
    bent,
    boundary_of,
    inner_points,
    letter_l,
    narrow_u,
    random_map,
    stage_of,
    transform_of,
)
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from engine.arrays import NOT_A_NUMBER, OTHER_KIND
from engine.dirichlet.hilbert import HilbertTransform
from engine.domain.meshing.triangulation import triangulate
from engine.errors import EngineError
from engine.geometry import Domain, polygon
from engine.interpolation import (
    KeyframeBlend,
    KeyframeSegment,
    TimeWeights,
    Variant,
    prepare,
    prepare_inbetweens,
    sample_domain,
)
from engine.interpolation.blends.metric import RESOLVED
from engine.interpolation.blends.outline import OutlineMetric
from engine.interpolation.keyframe_blend.derivatives import KEYFRAMES_OF_SEGMENT
from engine.interpolation.keyframe_blend.keyframe_samples import FOLDS, sample_keyframes
from engine.interpolation.preparation import (
    OTHER_BOUNDARY,
    OTHER_CAGE,
    TIME_RANGE,
    TWO_KEYFRAMES,
)
from engine.interpolation.sampled_domain import ONE_ANCHOR, OTHER_OUTLINE
from engine.maps import Bounds, distortion
from engine.maps.harmonic_map import HarmonicMap, derivatives_of
from engine.paths.complex_log import root_sheets

OUTLINE, CAGE = SHAPE = letter_l()
MAPS = [random_map(SHAPE, seed) for seed in (1, 2, 5)]
POINTS = inner_points(OUTLINE, 25, 0)


def between(maps=MAPS, points=POINTS, shape=SHAPE, **options):
    options = {"variant": "nu"} | options
    if options["variant"] == "metric":
        options.setdefault("transform", transform_of(shape))
    return prepare(maps, boundary_of(shape), points, **options)


def test_frames_are_pure_and_their_inputs_frozen():
    prepared = between(variant="metric", transform=None)
    first = prepared.frame(0.3)
    prepared.frame(1.9)
    again = prepared.frame(0.3)
    assert_array_equal(first.positions, again.positions)
    first.positions[:] = 0  # a frame is the caller's own
    assert_array_equal(prepared.frame(0.3).positions, again.positions)
    for array in (prepared.sampled_domain.paths.nodes, prepared.keyframes[0].log_fz):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


@pytest.mark.parametrize("variant", list(Variant))
def test_intervals_are_prepared_one_at_a_time_and_keyframes_shared(variant):
    whole = between(variant=variant)
    sites = sample_domain(boundary_of(SHAPE), POINTS)
    keys = sample_keyframes(MAPS[:2], sites)
    keys += sample_keyframes(MAPS[2:], sites)
    sheets = root_sheets(np.array([key.anchor_fz for key in keys]))
    transform = stage_of(SHAPE, POINTS).transform.at(sites.paths.nodes)
    for i, pair in enumerate((keys[:2], keys[1:])):
        keyframe_blend = KeyframeBlend.of(pair, sheets[i : i + 2])
        interval = prepare_inbetweens(
            variant, KeyframeSegment(sites, keyframe_blend, Bounds(), transform)
        )
        frame = interval.frame(0.4)
        expected = whole.frame(i + 0.4)
        assert_allclose(frame.positions, expected.positions, rtol=0, atol=1e-12)
        position = interval.anchor_position(0.4)
        assert_allclose(position + interval.offsets(0.4), frame.positions, rtol=0, atol=1e-13)
        held = interval.nbytes
        # The keyframes' own arrays are not counted again.
        assert (held < 100) == (variant == Variant.NU)
        assert whole.nbytes >= sites.nbytes + sum(key.nbytes for key in keys) + held


@pytest.mark.parametrize("variant", Variant)
def test_derivatives_at_some_points_are_those_of_the_frame(variant):
    piece = between(variant=variant).segments[0]
    which = np.array([7, 3, 0])
    times = np.array([0.0, 0.3, 0.75, 1.0])
    for time, fz, fzbar in zip(times, *piece.derivatives_at(which)(times), strict=True):
        frame = piece.frame(time)
        assert_allclose(fz, frame.fz[which], rtol=1e-12, atol=0)
        assert_allclose(fzbar, frame.fzbar[which], rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("variant", ["nu", "scaled-eta", "metric"])
def test_scattered_points_and_a_mesh_give_the_same(variant):
    mesh = triangulate(OUTLINE, 500)
    options = {"variant": variant, "anchor": 0.7 + 0.4j, "points": mesh.vertices}
    scattered, meshed = (
        between(triangles=triangles, **options).frame(0.6) for triangles in (None, mesh.triangles)
    )
    size = polygon.diameter(OUTLINE)
    assert_allclose(scattered.positions, meshed.positions, rtol=0, atol=2e-6 * size)
    assert_allclose(scattered.fz, meshed.fz, rtol=1e-7, atol=0)


def test_the_default_anchor_is_the_centre_of_the_largest_disc():
    outline, _ = bar()
    prepared = prepare([bent(bar()), bent(bar(), turn=1)], boundary_of(bar()), [0j], variant="nu")
    assert abs(prepared.sampled_domain.anchor.imag) < 1e-3
    assert (
        polygon.distance_to_boundary(outline, np.array([prepared.sampled_domain.anchor]))[0] > 0.499
    )


def test_a_full_turn_is_kept_and_flipped_by_its_integer():
    maps = [bent(bar()), bent(bar(), turn=3.0)]
    options = {"shape": bar(), "anchor": 0, "points": np.array([1 + 0j])}
    angles = [
        np.angle(between(maps, turns=turns, **options).frame(0.5).positions[0])
        for turns in (None, [0], [-1], [1])
    ]
    expected = np.array([1.5, 1.5, 1.5 - np.pi, 1.5 - np.pi])
    assert_allclose(np.exp(1j * np.array(angles)), np.exp(1j * expected), rtol=0, atol=1e-9)


def test_a_turn_only_rotates_eta_but_changes_the_shape_of_nu():
    maps = [random_map(SHAPE, seed, bend=0.2) for seed in (2, 3)]
    for variant, same in (("eta", True), ("metric", True), ("nu", False)):
        first, second = (
            between(maps, variant=variant, turns=turns).frame(0.3) for turns in ([0], [1])
        )
        modulus = np.abs(first.fz), np.abs(second.fz)
        assert_allclose(*modulus, rtol=1e-9, atol=0)
        stretch = [np.angle(frame.fzbar / frame.fz) for frame in (first, second)]
        assert np.allclose(*np.exp(1j * np.array(stretch)), atol=1e-9) is same


@pytest.mark.parametrize("time", [-1e-9, 2.0000001])
def test_times_out_of_range_are_refused(time):
    with pytest.raises(EngineError, match=says(TIME_RANGE, time=time)):
        between().frame(time)


@pytest.mark.parametrize("time", ["0.5", [0.5], 1j, None, float("nan"), float("inf")])
def test_times_that_are_no_numbers_are_refused(time):
    with pytest.raises(EngineError, match=says(NOT_A_NUMBER, name="time")):
        between().frame(time)


def test_prepare_refuses_anything_but_a_boundary():
    with pytest.raises(EngineError, match=says(OTHER_KIND, name="boundary", given="ndarray")):
        prepare(MAPS, POINTS, POINTS)


def test_a_frame_tells_its_distortion():
    frame = between().frame(0.5)
    for name in ("k", "tau", "sigma_a", "sigma_b"):
        expected = getattr(distortion, name)(frame.fz, frame.fzbar)
        assert_array_equal(getattr(frame, name), expected)


def test_folds_are_found_wherever_they_are():
    _, cage = bar()
    conformal = bent(bar())
    # ν = 1.5 z vanishes in the middle and folds both ends.
    ends = HarmonicMap(cage=cage, phi=cage, psi=0.375 * cage**2 * 2)
    with pytest.raises(EngineError, match=r"Keyframe 1 folds: at \(-?2, .*sigma_b is -"):
        prepare([conformal, ends], boundary_of(bar()), [0j])
    # f_z = z has a zero in the middle, where nothing on the outline folds.
    zero = HarmonicMap(cage=cage, phi=cage**2 / 2, psi=0 * cage)
    with pytest.raises(EngineError, match=r"Keyframe 0 folds inside: f_z winds 1 times"):
        prepare([zero, conformal], boundary_of(bar()), [1 + 0.1j], anchor=1.5)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"maps": MAPS[:1]}, says(TWO_KEYFRAMES, count=1)),
        ({"maps": []}, says(TWO_KEYFRAMES, count=0)),
        ({"maps": [MAPS[0], HarmonicMap.identity(1.01 * CAGE)]}, says(OTHER_CAGE)),
        ({"maps": [CAGE, CAGE]}, says(OTHER_KIND, name="keyframe 0", given="ndarray")),
        ({"shape": bar()}, says(OTHER_BOUNDARY)),
        ({"variant": "wobbly"}, "no variant 'wobbly'; choose one of metric, nu"),
        ({"anchor": [0.5, 0.6]}, says(ONE_ANCHOR, count=2)),
        ({"anchor": []}, says(ONE_ANCHOR, count=0)),
        ({"anchor": 2 + 2j}, "anchor at .* is outside"),
        ({"points": np.append(POINTS, 2 + 2j)}, "point 25 at .* is outside the outline"),
        ({"points": OUTLINE * (1 + 1e-7)}, "outside"),
        ({"points": []}, "at least 1"),
        ({"turns": [1]}, "2 integers"),
        ({"triangles": [[0, 1]]}, "shape"),
    ],
)
def test_bad_input_is_refused(changes, message):
    with pytest.raises(EngineError, match=message):
        between(**changes)


def test_points_on_the_outline_within_a_billionth_are_taken():
    middles = OUTLINE + 0.4 * polygon.edge_vectors(OUTLINE)
    outside = middles - 0.9e-9j * polygon.diameter(OUTLINE) * polygon.edge_vectors(
        OUTLINE
    ) / np.abs(polygon.edge_vectors(OUTLINE))
    for variant in Variant:
        on, off = (between(points=z, variant=variant).frame(0.5) for z in (middles, outside))
        assert_allclose(on.positions, off.positions, rtol=0, atol=1e-7)
        assert np.isfinite(off.fzbar).all()


def test_a_fold_between_the_samples_of_the_outline_is_found():
    boundary = boundary_of(SHAPE)
    following = np.roll(boundary.points, -1)
    dense = (
        boundary.points[:, None] + (following - boundary.points)[:, None] * np.linspace(0, 1, 32)
    ).ravel()
    f = random_map(SHAPE, 3)
    at_samples, between_them = (
        np.abs(b / a).max() for a, b in (f.derivatives(z) for z in (boundary.points, dense))
    )
    assert between_them > at_samples
    # k grows in proportion: below 1 at all samples, above 1 between two of them.
    strength = 2 / (at_samples + between_them)
    folded = HarmonicMap(cage=CAGE, phi=f.phi, psi=strength * f.psi)
    with pytest.raises(EngineError, match=says(FOLDS, number=1)):
        between([MAPS[0], folded])


def test_a_transform_of_another_outline_is_refused():
    other = HilbertTransform.on(Domain(*bar()))
    with pytest.raises(EngineError, match=says(OTHER_OUTLINE)):
        between(variant="metric", transform=other)
    # As many vertices, but elsewhere.
    moved = HilbertTransform.on(Domain(OUTLINE * 1.01, CAGE * 1.01))
    with pytest.raises(EngineError, match=says(OTHER_OUTLINE)):
        between(variant="metric", transform=moved)


def test_what_a_variant_needs_is_asked_for():
    sites = sample_domain(boundary_of(SHAPE), POINTS)
    keys = sample_keyframes(MAPS, sites)
    sheets = root_sheets(np.array([key.anchor_fz for key in keys]))
    with pytest.raises(EngineError, match=says(KEYFRAMES_OF_SEGMENT, wanted=2, count=3, sheets=3)):
        KeyframeBlend.of(keys, sheets)
    interval = KeyframeSegment(sites, KeyframeBlend.of(keys[:2], sheets[:2]), Bounds())
    for variant in Variant:
        if variant.needs_transform:
            with pytest.raises(EngineError, match="needs the Hilbert transform"):
                prepare_inbetweens(variant, interval)
        else:
            frame = prepare_inbetweens(variant, interval).frame(0.5)
            assert (frame.rho is not None) == variant.is_scaled


def test_the_metric_converges_with_the_nodes_that_the_keyframes_ask_for(monkeypatch):
    # A key near its bounds, of noise on the cage: the nodes that the shape asks for alone are off
    # by 7e-3 in ln |f_z| beside a vertex of the cage.
    outline, cage = narrow_u(0.1)
    points = polygon.sample_graded(
        outline, cage, ratio=0.3, longest=polygon.diameter(outline) / 100
    )
    points = points[np.abs(points[:, None] - outline).min(axis=1) > 1e-3]
    rng = np.random.default_rng(38)
    noise = rng.normal(size=(2, len(cage))) + 1j * rng.normal(size=(2, len(cage)))
    noise *= np.abs(polygon.edge_vectors(cage)).mean()
    of_noise = HarmonicMap(cage=cage, phi=noise[0], psi=noise[1])
    fz, fzbar = of_noise.derivatives(points)
    phi = cage + 0.8 / np.abs(fz).max() * noise[0]
    fz, _ = HarmonicMap(cage=cage, phi=phi, psi=noise[1]).derivatives(points)
    key = HarmonicMap(cage=cage, phi=phi, psi=0.93 / (np.abs(fzbar) / np.abs(fz)).max() * noise[1])
    maps = [HarmonicMap.identity(cage), key]
    metric = OutlineMetric.of(*derivatives_of(maps, points), TimeWeights.straight(), Bounds())
    halves = np.full((2, 1), 0.5)
    expected = metric.residuals(halves[0]) + metric.log_modulus.T @ halves
    shape = outline, cage
    errors = []
    for tolerance in (1.0, RESOLVED, RESOLVED / 10):
        monkeypatch.setattr("engine.interpolation.blends.metric.RESOLVED", tolerance)
        motion = prepare(
            maps, boundary_of(shape), points, variant="metric", transform=transform_of(shape)
        )
        errors.append(np.abs(np.log(np.abs(motion.frame(0.5).fz)) - expected[:, 0]).max())
    assert errors[0] > 20 * errors[1]
    assert errors[1] > 20 * errors[2]
    assert errors[1] < 3e-4

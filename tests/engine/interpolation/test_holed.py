"""In-betweens around holes: closed, exact at the keyframes, and as little changed as can be."""

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
from holed_shapes import DRAGS, PLATE_DRAGS, Holed, inner_points, plate, pulled, random_map, ring
from numpy.testing import assert_allclose

from engine.deform import Status
from engine.dirichlet import Extension, HilbertTransform
from engine.errors import EngineError
from engine.geometry import Domain
from engine.interpolation import (
    KeyframeBlend,
    KeyframeSegment,
    SampledDomain,
    Variant,
    prepare,
    prepare_inbetweens,
    sample_domain,
    sample_keyframes,
)
from engine.interpolation.proof import bisection
from engine.interpolation.proof.bisection import prove
from engine.maps import Boundary, Bounds, HarmonicMap, distortion
from engine.paths import root_sheets

CLOSED = [Variant.NU, Variant.ETA, Variant.SCALED_ETA, Variant.METRIC]
TIMES = (0.25, 0.5, 0.8)
KEPT = 5e-5  # of the keys' distortion: what is between points of an edge
SHAPES = {"one hole": ring(), "three holes": plate(3)}


def keys(shape: Holed, seed: int = 0, size: float = 0.12) -> list[HarmonicMap]:
    return [random_map(shape, seed, size), random_map(shape, seed + 100, size)]


def between(shape: Holed, maps, variant, points=None, **options):
    points = inner_points(shape, 120) if points is None else points
    domain = Domain(shape.outline, maps[0].cage, maps[0].holes)
    return prepare(
        maps, Boundary.sample(domain), points, variant=variant, anchor=shape.anchor, **options
    )


def circles(shape: Holed) -> list[np.ndarray]:
    """Return circles around each hole, with Gauss-Legendre nodes of both halves: z and dz."""
    x, weights = np.polynomial.legendre.leggauss(48)
    found = []
    for hole in shape.holes:
        radius = 1.12 * np.abs(hole.outline - hole.centre).max()
        halves = []
        for way in (1, -1):
            turn = way * np.pi * (1 + x) / 2
            z = radius * np.exp(1j * turn)
            halves.append((hole.centre + z, 1j * z * way * np.pi / 2 * weights))
        found.append(halves)
    return found


@pytest.mark.parametrize(
    ("name", "variant"), [("one hole", "nu"), *(("three holes", variant) for variant in CLOSED)]
)
def test_both_ways_around_a_hole_lead_to_the_same_place(name, variant):
    shape = SHAPES[name]
    halves = [half for each in circles(shape) for half in each]
    points = np.concatenate([z for z, _ in halves])
    motion = between(shape, keys(shape), variant, points)
    diameter = motion.sampled_domain.diameter
    for time in TIMES:
        frame = motion.frame(time)
        steps = [
            (fz * dz + fzbar * dz.conj()).sum()
            for fz, fzbar, (_, dz) in zip(
                np.split(frame.fz, len(halves)),
                np.split(frame.fzbar, len(halves)),
                halves,
                strict=True,
            )
        ]
        for one, two in zip(steps[::2], steps[1::2], strict=True):
            assert abs(one) > 0.1
            assert abs(one - two) < 1e-9 * diameter
        assert motion.segments[0].correction > 1e-4


@pytest.mark.parametrize(
    ("name", "variant"),
    [
        *(("one hole", variant) for variant in Variant),
        ("three holes", "nu"),
        ("three holes", "eta"),
    ],
)
def test_keyframes_are_met_exactly(name, variant):
    shape = SHAPES[name]
    maps = keys(shape, 1)
    motion = between(shape, maps, variant)
    for time, f in enumerate(maps):
        frame = motion.frame(float(time))
        assert_allclose(frame.positions, f(motion.sampled_domain.points), rtol=0, atol=1e-11)
        fz, fzbar = f.derivatives(motion.sampled_domain.points)
        assert_allclose(frame.fz, fz, rtol=0, atol=1e-9)
        assert_allclose(frame.fzbar, fzbar, rtol=0, atol=1e-9)


@pytest.mark.parametrize("variant", list(Variant))
def test_the_other_way_in_time_is_the_same_way(variant):
    maps = keys(ring(), 2, 0.1)
    there, back = (between(ring(), each, variant) for each in (maps, maps[::-1]))
    for time in TIMES:
        one, two = there.frame(time), back.frame(1 - time)
        assert_allclose(one.positions, two.positions, rtol=0, atol=1e-9)
        assert_allclose(one.fz, two.fz, rtol=0, atol=1e-9)


@pytest.mark.parametrize("variant", list(Variant))
def test_in_betweens_turn_and_grow_with_the_domain(variant):
    shape, factor, shift = ring(), 300 * np.exp(0.7j), 500 - 200j
    maps = keys(shape, 3, 0.06)
    elsewhere = shape.moved(factor, shift)
    # g(w) = factor · f((w − shift) / factor) + shift
    moved = [
        HarmonicMap(
            cage=elsewhere.cage,
            phi=factor * f.phi + shift * (np.arange(len(f.phi)) < len(shape.cage)),
            psi=np.conj(factor) * f.psi,
            holes=elsewhere.holes,
            logs=factor * f.logs,
        )
        for f in maps
    ]
    # Logarithms differ by a constant: the same shape in another place.
    points = inner_points(shape, 120)
    one = between(shape, maps, variant, points)
    two = between(elsewhere, moved, variant, factor * points + shift)
    for time in TIMES:
        here, there = one.frame(time).positions, two.frame(time).positions
        here, there = factor * (here - here[0]), there - there[0]
        assert_allclose(there, here, rtol=0, atol=2e-6 * abs(factor))


@pytest.mark.parametrize("variant", list(Variant))
def test_a_tiny_hole_tends_to_none(variant):
    tiny = ring(0.002)
    cage = tiny.cage
    whole = [
        HarmonicMap(cage=cage, phi=cage + 0.1 * cage**2, psi=0.05 * cage),
        HarmonicMap(cage=cage, phi=cage - 0.05 * cage**3, psi=-0.1j * cage + 0.02 * cage**2),
    ]
    extra = np.zeros(36)
    holed = [
        HarmonicMap(
            cage=cage,
            phi=np.append(f.phi, extra),
            psi=np.append(f.psi, extra),
            holes=tiny.holes,
            logs=np.zeros(1),
        )
        for f in whole
    ]
    points = inner_points(ring(), 120)
    one, two = between(tiny, holed, variant, points), between(tiny, whole, variant, points)
    for time in TIMES:
        difference = one.frame(time).positions - two.frame(time).positions
        assert np.abs(difference).max() < 2e-4


def along(loops, count):
    """Return points along loops, so many on each edge."""
    sides = [np.roll(loop, -1) - loop for loop in loops]
    parts = np.arange(count) / count
    edges = zip(loops, sides, strict=True)
    return np.concatenate([(loop[:, None] + side[:, None] * parts).ravel() for loop, side in edges])


class Pulled(NamedTuple):
    """A shape, its circles midway between what is singular, where sums are right to rounding."""

    shape: Holed
    circles: list[np.ndarray]
    edge: np.ndarray
    sites: SampledDomain
    transform: Extension


@cache
def pulled_on(name, count=5):
    """Return the ring or the plate, ready for the in-betweens of any keyframes.

    There are so many points on each of its edges.
    """
    shape, radii = (ring(), [0.74]) if name == "ring" else (plate(3), [0.38, 0.48, 0.33])
    turn = np.exp(2j * np.pi * np.arange(128) / 128)
    circles = [h.centre + r * turn for h, r in zip(shape.holes, radii, strict=True)]
    edge = along(shape.loops, count)
    points = np.concatenate([*circles, edge])
    sites = sample_domain(Boundary.sample(shape.domain), points, anchor=shape.anchor)
    transform = HilbertTransform.on(shape.domain)
    return Pulled(shape, circles, edge, sites, transform.at(sites.paths.nodes))


BY_DEFAULT = {("egg", "nu"), ("egg", "scaled-eta"), ("egg", "metric")}
BY_DEFAULT |= {("twisted", "nu"), ("twisted", "metric")}


@pytest.mark.parametrize(
    ("name", "variant"),
    [
        pytest.param(name, variant, marks=() if (name, variant) in BY_DEFAULT else pytest.mark.long)
        for name in (*DRAGS, *PLATE_DRAGS)
        for variant in (Variant.NU, Variant.SCALED_ETA, Variant.METRIC)
    ],
)
def test_handles_pulled_hard_keep_bounds_and_are_closed(name, variant):
    state = pulled(name)
    assert state.certificate.is_certified
    assert state.status in (Status.CONVERGED, Status.AT_LIMITS)
    assert state.statistics.target_error < 0.02
    shape, circles, edge, sites, transform = pulled_on("ring" if name in DRAGS else "plate")
    maps = [HarmonicMap.identity(shape.cage, shape.holes), state.map]
    pointwise = np.maximum(*(distortion.k(*f.derivatives(edge)) for f in maps))
    ends = [f.derivatives(along(shape.loops, 40)) for f in maps]
    most_k = max(distortion.k(*end).max() for end in ends)
    most_a = max(distortion.sigma_a(*end).max() for end in ends)
    least_b = min(distortion.sigma_b(*end).min() for end in ends)
    keyframes = sample_keyframes(maps, sites)
    sheets = root_sheets(np.array([key.anchor_fz for key in keyframes]))
    keyframe_blend = KeyframeBlend.of(keyframes, sheets)
    motion = prepare_inbetweens(
        variant, KeyframeSegment(sites, keyframe_blend, Bounds(), transform)
    )
    assert 1e-4 < motion.correction < 0.3
    for time in (0.2, 0.5, 0.8):
        frame = motion.frame(time)
        fz, fzbar = np.split(frame.fz, [-len(edge)]), np.split(frame.fzbar, [-len(edge)])
        around = zip(circles, *(np.split(x[0], len(circles)) for x in (fz, fzbar)), strict=True)
        for circle, along_fz, along_fzbar in around:
            dz = 2j * np.pi / len(circle) * (circle - circle.mean())
            gap = (along_fz * dz + along_fzbar * dz.conj()).sum()
            assert abs(gap) < 1e-10 * sites.diameter
        here = fz[1], fzbar[1]
        if variant is Variant.NU:
            assert (distortion.k(*here) <= pointwise + 1e-9).all()
        slack = 2e-3 if variant is Variant.METRIC else 1e-4
        assert distortion.k(*here).max() <= (1 + slack) * most_k
        assert distortion.sigma_a(*here).max() <= (1 + slack) * most_a
        assert distortion.sigma_b(*here).min() >= (1 - slack) * least_b
        # Beside a key at rest h takes more than all that is a point's own; what is allowed to
        # the whole drawing is left.
        assert frame.rho is None or frame.rho > 0.45


def metric_between(maps, edge):
    """Return the metric in-betweens of two maps of the ring, with points on its boundary."""
    shape, _, _, sites, transform = pulled_on("ring", edge)
    keyframes = sample_keyframes(maps, sites)
    sheets = root_sheets(np.array([key.anchor_fz for key in keyframes]))
    interval = KeyframeSegment(
        sites, KeyframeBlend.of(keyframes, sheets), Bounds(), transform=transform
    )
    return prepare_inbetweens(Variant.METRIC, interval), along(shape.loops, edge)


def require_limits(motion, edge, maps, times):
    """Require that frames exceed no limit that their keys keep."""
    k, sigma_a, sigma_b = (
        np.array([quantity(*f.derivatives(edge)) for f in maps])
        for quantity in (distortion.k, distortion.sigma_a, distortion.sigma_b)
    )
    for time in times:
        frame = motion.frame(time)
        here = frame.fz[-len(edge) :], frame.fzbar[-len(edge) :]
        assert distortion.k(*here).max() <= (1 + KEPT) * k.max()
        assert distortion.sigma_a(*here).max() <= (1 + KEPT) * sigma_a.max()
        assert distortion.sigma_b(*here).min() >= (1 - KEPT) * sigma_b.min()


def test_metric_in_betweens_around_a_hole_keep_their_keys_limits():
    """Closed alone, they exceed k."""
    maps = [HarmonicMap.identity(ring().cage, ring().holes), pulled("kidney").map]
    motion, edge = metric_between(maps, 20)
    require_limits(motion, edge, maps, [0.003, 0.02, *np.linspace(0.1, 0.96, 11), 0.999])
    for key in (0.0, 1.0):
        beside, at = (motion.frame(time) for time in (abs(key - 1e-6), key))
        assert_allclose(beside.positions, at.positions, rtol=0, atol=1e-5)


@pytest.mark.long
def test_the_metric_variant_folds_nowhere_between_hard_keys(monkeypatch):
    """Closed alone, it leaves its keys' bounds by a third, and folds."""
    maps = [pulled("crescent").map, pulled("swirl").map]
    motion, edge = metric_between(maps, 20)
    require_limits(motion, edge, maps, np.linspace(0.02, 0.98, 33))
    monkeypatch.setattr(bisection, "MOST_CELLS", 100_000)
    proof = prove(motion)
    assert not proof.unproven_times
    (circle,) = pulled_on("ring", 20).circles
    dz = 2j * np.pi / len(circle) * (circle - circle.mean())
    for time in np.linspace(0.05, 0.95, 10):
        frame = motion.frame(time)
        fz, fzbar = frame.fz[-len(edge) :], frame.fzbar[-len(edge) :]
        assert distortion.k(fz, fzbar).max() <= proof.k
        assert distortion.sigma_b(fz, fzbar).min() >= proof.sigma_b
        around = frame.fz[: len(dz)] @ dz + frame.fzbar[: len(dz)] @ dz.conj()
        assert abs(around) < 1e-10 * motion.sampled_domain.diameter
    for key in (0.0, 1.0):
        beside, at = (motion.frame(time) for time in (abs(key - 1e-6), key))
        assert_allclose(beside.positions, at.positions, rtol=0, atol=1e-4)
        assert_allclose(beside.fzbar, at.fzbar, rtol=0, atol=1e-4)


def test_the_correction_is_the_smallest():
    """Any other holomorphic function that closes the period is larger on the boundary."""
    shape = ring()
    motion = between(shape, keys(shape), "nu")
    loops, boundary, inbetweens = (
        motion.sampled_domain.loops,
        motion.sampled_domain.boundary,
        motion.segments[0],
    )
    plain = replace(inbetweens.keyframe_blend, residuals=())
    blend = replace(inbetweens.blend, keyframe_blend=plain.at(motion.sampled_domain.paths.around))
    here, closing = blend.derivatives(0.5), inbetweens.closing
    (modes,) = boundary.span.evaluate(closing.functions.coefficients, boundary.points, orders=(0,))

    def size(h):
        return np.sqrt(boundary.weights @ np.abs(h) ** 2)

    smallest = size(modes @ closing.series(0.5))
    assert smallest > 1e-4
    for power in (1, 2, -1, -2):
        form = loops.nodes**power - shape.anchor**power
        factor = 0j
        for _ in range(30):
            grown = np.exp(factor * form)
            period = loops.integrals(here.fz * grown) + loops.integrals(here.g * grown).conj()
            along = loops.integrals(here.fz * grown * form)
            across = loops.integrals(here.g * grown * form).conj()
            # period + along d + across conj(d) = 0
            determinant = abs(along) ** 2 - abs(across) ** 2
            factor -= complex(((along.conj() * period - across * period.conj()) / determinant)[0])
        other = factor * (boundary.points**power - shape.anchor**power)
        assert size(other) > 1.001 * smallest


def test_key_turned_inside_out_around_a_hole_is_named():
    shape = ring()
    boundary = Boundary.sample(shape.domain)
    inside = shape.holes[0].cage
    span = HarmonicMap.identity(shape.cage, shape.holes).span
    # 1/z folds nowhere, but f_z winds around the hole.
    samples = span.coordinates(boundary.points)[:, :-1]
    phi, *_ = np.linalg.lstsq(samples, 1 / boundary.points, rcond=1e-12)
    turned = HarmonicMap(
        cage=shape.cage,
        phi=phi,
        psi=0 * phi,
        holes=shape.holes,
        logs=np.zeros(1, np.complex128),
    )
    assert len(phi) == len(shape.cage) + len(inside)
    at_rest = HarmonicMap.identity(shape.cage, shape.holes)
    with pytest.raises(EngineError, match="Keyframe 1 turns the drawing inside out around hole 1"):
        between(shape, [at_rest, turned], "nu")


def test_a_motion_through_keys_is_closed_too():
    shape = ring()
    (halves,) = circles(shape)
    points = np.concatenate([z for z, _ in halves])
    maps = [random_map(shape, seed, 0.1) for seed in range(4)]
    for variant in (Variant.NU, Variant.METRIC):
        motion = between(shape, maps, variant, points, through=True)
        for time in (0.4, 1.5, 2.3):
            frame = motion.frame(time)
            one, two = (
                (fz * dz + fzbar * dz.conj()).sum()
                for fz, fzbar, (_, dz) in zip(
                    np.split(frame.fz, 2), np.split(frame.fzbar, 2), halves, strict=True
                )
            )
            assert abs(one - two) < 1e-9


def test_closing_functions_turn_with_a_regular_ring():
    """They depend on each other there, and rounding errors must not stand for what is missing."""
    turn = np.exp(0.3j)
    spans = []
    for shape in (ring(), ring().moved(turn, 0.0)):
        boundary = Boundary.sample(shape.domain)
        sites = sample_domain(boundary, shape.outline, anchor=shape.anchor)
        (values,) = boundary.span.evaluate(sites.closer.few, boundary.points, orders=(0,))
        spans.append(np.linalg.qr(np.vstack([values.real, values.imag]))[0])
    first, second = spans
    assert first.shape == second.shape
    assert_allclose(np.linalg.svd(first.T @ second, compute_uv=False), 1.0, rtol=0, atol=1e-9)

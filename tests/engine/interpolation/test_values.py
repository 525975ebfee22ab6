"""Points at which only values are wanted: what in-betweens are there, at few nodes."""

from functools import cache

import numpy as np
import pytest
from holed_shapes import Holed, plate, random_map as holed_map, ring
from interpolation_shapes import bar, bent, letter_l, narrow_u, random_map
from messages import says
from numpy.testing import assert_allclose

from engine.deform.correction.corrector import build_corrector
from engine.dirichlet import HilbertTransform
from engine.errors import EngineError
from engine.geometry import Domain
from engine.interpolation import (
    KeyframeBlend,
    KeyframeSegment,
    Variant,
    prepare_inbetweens,
    sample_domain,
    sample_keyframes,
    value_points_for_corrections,
)
from engine.interpolation.sampled_domain import VALUES_OR_TRIANGLES
from engine.maps import Boundary, Bounds
from engine.paths import root_sheets

TIMES = (0.0, 0.3, 0.75, 1.0)


# f_z of the bent bar turns twice around on the way along it.
CASES = {
    "wound": (Holed(*bar(), (), 0.1 + 0.1j), [bent(bar()), bent(bar(), bend=3.0, turn=0.4)]),
    "letter": (Holed(*letter_l(), (), 0.5 + 0.5j), [random_map(letter_l(), s) for s in (1, 2)]),
    "narrow": (Holed(*narrow_u(), (), 0.5 + 0.3j), [random_map(narrow_u(), s) for s in (1, 2)]),
    "one hole": (ring(), [holed_map(ring(), s, 0.1) for s in (0, 100)]),
    "three holes": (plate(3), [holed_map(plate(3), s, 0.1) for s in (0, 100)]),
}
SHORT = {("wound", Variant.NU), ("wound", Variant.METRIC), ("letter", Variant.LINEAR)}
SHORT |= {("one hole", Variant.NU), ("narrow", Variant.ETA)}


@cache
def points_of(name):
    """Handles, and what pins need to know beside them."""
    shape, _ = CASES[name]
    boundary = Boundary.sample(shape.domain)
    handles = shape.anchor + 0.1 * np.array([0, 1, 1j, -1])
    corrector = build_corrector(boundary, shape.anchor, handles)
    return handles, value_points_for_corrections(corrector)


@cache
def transform_of(name):
    shape, _ = CASES[name]
    return HilbertTransform.on(shape.domain)


def between(name, variant, points, beside=()):
    shape, maps = CASES[name]
    sites = sample_domain(
        Boundary.sample(shape.domain), points, anchor=shape.anchor, values_at=beside
    )
    keys = sample_keyframes(maps, sites)
    keyframe_blend = KeyframeBlend.of(keys, root_sheets(np.array([key.anchor_fz for key in keys])))
    extension = transform_of(name).at(sites.paths.nodes) if variant.needs_transform else None
    return prepare_inbetweens(variant, KeyframeSegment(sites, keyframe_blend, Bounds(), extension))


@pytest.mark.parametrize(
    ("name", "variant"),
    [
        pytest.param(name, variant, marks=() if (name, variant) in SHORT else pytest.mark.long)
        for name in CASES
        for variant in Variant
    ],
)
def test_values_are_those_of_full_paths_at_few_nodes(name, variant):
    handles, beside = points_of(name)
    few = between(name, variant, handles, beside)
    full = between(name, variant, np.concatenate([handles, beside]))
    assert len(few.sampled_domain.paths.nodes) < len(full.sampled_domain.paths.nodes) / 2
    count, places = len(handles), full.sampled_domain.paths.places
    # The Cauchy integral's own error depends on which points are looked at together.
    tolerance = 5e-9 if variant.needs_transform else 1e-10
    at_times = few.values_at(np.array(TIMES))
    for number, time in enumerate(TIMES):
        frame, values = few.frame_with_values(time)
        expected = full.frame(time)
        plain = full.keyframe_blend.log_fz_without_residuals(time)[0][places]
        assert_allclose(frame.positions, expected.positions[:count], rtol=0, atol=tolerance)
        assert_allclose(values.fz, expected.fz[count:], rtol=tolerance, atol=0)
        assert_allclose(values.g, expected.fzbar[count:].conj(), rtol=0, atol=tolerance)
        known = np.exp(plain[count:])
        # K = L² / F.
        k = known**2 / expected.fz[count:] if full.blend.sign else known
        assert_allclose(values.k, k, rtol=tolerance, atol=0)
        for one, several in zip(values, at_times, strict=True):
            assert_allclose(several[number], one, rtol=1e-12, atol=1e-14)


def test_values_beside_triangles_are_refused():
    outline, cage = bar()
    with pytest.raises(EngineError, match=says(VALUES_OR_TRIANGLES)):
        sample_domain(
            Boundary.sample(Domain(outline, cage)), outline, triangles=[[0, 1, 2]], values_at=[0j]
        )

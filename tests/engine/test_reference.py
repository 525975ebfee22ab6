"""The fast variants against the paper's formulas as they are printed."""

import pytest
from interpolation_shapes import bar, inner_points, letter_l, random_map, stage_of
from numpy.testing import assert_allclose

from engine.interpolation import Variant
from engine.reference import Reference

PRINTED = (Variant.NU, Variant.ETA, Variant.SCALED_ETA, Variant.METRIC)
SHAPES = {"bar": (bar(), 0.2 + 0.1j), "letter L": (letter_l(), 0.5 + 0.5j)}


@pytest.mark.parametrize("variant", PRINTED)
@pytest.mark.parametrize("name", SHAPES)
def test_variants_are_those_of_the_paper(name, variant):
    shape, anchor = SHAPES[name]
    first, second = (random_map(shape, seed) for seed in (14, 15))
    points = inner_points(shape[0], 8, 1, margin=0.1)
    reference = Reference(first=first, second=second, outline=shape[0], anchor=anchor)
    frame = stage_of(shape, points, anchor).between((first, second), variant).frame(0.4)
    printed = reference.frame(variant, points, 0.4)
    # Of the scaled variant ρ is smoothed: at most the paper's, and nearly as large.
    slack = 0.0 if frame.rho is None else reference.rho(0.4) - frame.rho
    assert -1e-6 <= slack < 2e-3
    assert_allclose(frame.positions, printed.positions, rtol=0, atol=3e-5 + slack)
    assert_allclose(frame.fz, printed.fz, rtol=0, atol=1e-6)
    assert_allclose(frame.fzbar, printed.fzbar, rtol=0, atol=1e-6 + 2 * slack)


@pytest.mark.parametrize("variant", PRINTED)
def test_reference_returns_the_keyframes(variant):
    shape, anchor = SHAPES["bar"]
    maps = [random_map(shape, seed) for seed in (14, 15)]
    points = inner_points(shape[0], 8, 1, margin=0.1)
    reference = Reference(first=maps[0], second=maps[1], outline=shape[0], anchor=anchor)
    for t, f in enumerate(maps):
        frame = reference.frame(variant, points, t)
        assert_allclose(frame.positions, f(points), rtol=0, atol=3e-5)
        assert_allclose(frame.fz, f.derivatives(points)[0], rtol=0, atol=1e-6)

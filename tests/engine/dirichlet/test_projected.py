import numpy as np
import pytest
from interpolation_shapes import bar, inner_points, letter_l, narrow_u, random_map
from numpy.testing import assert_allclose

from engine.dirichlet.hilbert import HilbertTransform
from engine.dirichlet.projected import ProjectedTransform
from engine.geometry.polygon import diameter
from engine.interpolation import Variant, prepare_inbetweens, prepare_sites
from engine.interpolation.keyframe_samples import sample_keyframes
from engine.maps.harmonic_map import HarmonicMap
from engine.paths.complex_log import root_sheets

SHAPES = {"bar": bar(), "letter L": letter_l(), "narrow U": narrow_u(0.1)}


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_functions_of_the_cage_are_found_from_their_real_parts(name):
    outline, cage = SHAPES[name]
    f = random_map(SHAPES[name], 3)
    points = np.concatenate([outline, inner_points(outline, 40, 1)])
    transform = ProjectedTransform.on(outline, cage, points)
    holomorphic = HarmonicMap(cage=cage, phi=f.phi, psi=np.zeros_like(f.psi))
    at_nodes, expected = holomorphic(transform.nodes), holomorphic(points)
    values, slopes = transform.extend(at_nodes.real[:, None])
    values -= 1j * (values[0] - expected[0]).imag
    assert_allclose(values[:, 0], expected, rtol=0, atol=1e-6)
    assert_allclose(slopes[:, 0], f.derivatives(points)[0], rtol=0, atol=1e-4)


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_rough_metric_inbetweens_are_near_the_exact_ones_and_meet_the_keyframes(name):
    outline, cage = SHAPES[name]
    points = inner_points(outline, 60, 5)
    sites = prepare_sites(outline, cage, points)
    worst = 0.0
    for seed in range(6):
        maps = [random_map(SHAPES[name], 2 * seed + i) for i in range(2)]
        keyframes = sample_keyframes(maps, sites)
        sheets = root_sheets(np.array([key.anchor_fz for key in keyframes]))
        rough, exact = (
            prepare_inbetweens(Variant.METRIC, sites, keyframes, sheets, transform=transform)
            for transform in (
                ProjectedTransform.on(outline, cage, sites.paths.nodes),
                HilbertTransform.on(outline, cage).at(sites.paths.nodes),
            )
        )
        for end, f in enumerate(maps):
            at_end = rough.frame(end).positions
            assert_allclose(at_end, f(points), rtol=0, atol=1e-12 * diameter(outline))
        for time in (0.25, 0.5, 0.75):
            difference = rough.frame(time).positions - exact.frame(time).positions
            worst = max(worst, np.abs(difference).max() / diameter(outline))
    assert worst < 0.02

"""What the paper's figures say, in the numbers that stand beside our own."""

import numpy as np
import pytest

from app.paper_figures.measure import MeasuredMotion
from app.paper_figures.methods import ARAP, FFMP, LINEAR, METRIC, NU, SCALED_ETA, SIG13
from app.paper_figures.plots import figure_3, figure_4, figure_8, figure_9, figure_11
from app.paper_figures.shapes import bar_to_ring, letter_s, make_sample_pair
from engine.maps import Boundary, Bounds, certify

TRIANGLES = 1_000
ROUNDING = 1e-6


@pytest.fixture(scope="module")
def s_to_u():
    return letter_s(2 * TRIANGLES)  # with fewer, the others exceed the bounds by less


def measured(pair, method, times=11):
    return MeasuredMotion(pair, method, times).summarize()


def test_figure_1_linear_interpolation_shrinks_the_giraffe_and_folds_it():
    pair = make_sample_pair("giraffe", 0, 1, TRIANGLES)
    linear, metric = measured(pair, LINEAR, 5), measured(pair, METRIC, 5)
    assert linear.area < 0.85
    assert linear.tau == np.inf
    assert metric.area > 0.999
    assert metric.k <= 1 + ROUNDING


def test_figure_3_nu_loses_the_direction_of_the_stretch_and_the_others_keep_it():
    nu, eta, metric = figure_3.measure_stretch()
    # μ turns by twice the angle of the map: at t = 0.8 by 144° instead of 180°.
    assert nu.direction == pytest.approx(18.0, abs=1e-4)
    assert nu.k == pytest.approx(0.2, abs=1e-6)
    for one in (eta, metric):
        assert one.direction < 1e-3
        assert one.k == pytest.approx(1 / 3, abs=1e-5)


def test_figure_4_scaling_brings_eta_back_within_the_bounds():
    unscaled, scaled = (each.summarize() for each in figure_4.make_wound_bar(TRIANGLES).values())
    assert unscaled.k > 2
    assert unscaled.tau == np.inf
    assert scaled.k <= 1 + ROUNDING
    assert scaled.tau <= 1 + ROUNDING


@pytest.mark.parametrize("method", [NU, SCALED_ETA, METRIC])
def test_figure_5_our_variants_stay_below_their_keyframes(s_to_u, method):
    one = measured(s_to_u, method)
    assert one.k <= 1 + ROUNDING
    assert one.tau <= 1 + ROUNDING


@pytest.mark.parametrize("method", [ARAP, FFMP])
def test_figure_5_the_others_exceed_them(s_to_u, method):
    assert measured(s_to_u, method).k > 1.01


def test_figure_5_its_keyframe_is_certified(s_to_u):
    domain = s_to_u.shape.domain
    boundary = Boundary.sample(domain)
    assert certify(s_to_u.second, boundary, s_to_u.bounds).is_certified
    assert s_to_u.bounds == Bounds(k=0.08, sigma_a=5.0, sigma_b=0.2)


def test_figure_5_nu_is_linear_in_time(s_to_u):
    track = MeasuredMotion(s_to_u, NU, 5)
    np.testing.assert_allclose(
        track.k_shares, np.repeat(track.times[:, None], 100, axis=1), rtol=0, atol=1e-6
    )


def test_figure_6_arap_exceeds_the_ring_and_ours_do_not():
    ring = bar_to_ring(TRIANGLES)
    assert measured(ring, ARAP).k_of_all > 1.02
    assert measured(ring, SCALED_ETA).k_of_all <= 1 + ROUNDING
    assert measured(ring, METRIC).k_of_all <= 1 + ROUNDING


def test_figure_8_the_tail_turns_evenly_by_scaled_eta_only_and_chen_is_near_metric():
    pair = figure_8.make_tail_pair(TRIANGLES)
    tracks = tuple(MeasuredMotion(pair, method) for method in (METRIC, SCALED_ETA, SIG13))
    metric, eta, chen = figure_8.measure_tail(tracks)
    assert eta.turned == pytest.approx(0.5, abs=0.02)
    assert abs(metric.turned - 0.5) > 0.05
    assert chen.from_metric < 0.03
    assert eta.from_metric > chen.from_metric


def test_figure_9_methods_are_timed_at_sizes_up_to_the_largest(monkeypatch):
    monkeypatch.setattr(figure_9, "SIZES", (300, 500))
    (timing,) = figure_9.measure_frame_times(400, (METRIC, SIG13))
    assert 240 < timing.vertices < 400
    assert len(timing.seconds) == 3
    assert all(seconds > 0 for seconds in timing.seconds.values())
    assert timing.ratio(figure_9.SERIES) > timing.ratio(METRIC.name) > 1


def test_figure_11_the_poisson_error_goes_to_zero_under_refinement():
    *bars, octopus = figure_11.measure_errors(TRIANGLES)
    errors = [loss.error for loss in bars]
    sizes = [loss.triangles**-0.5 for loss in bars]
    order = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert order > 0.8
    assert 0 < octopus.error < 0.05

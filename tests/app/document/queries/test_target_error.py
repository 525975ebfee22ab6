"""When a handle falls short, and what is said to hold it back."""

from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, RADIUS, altered, disc_document
from numpy.testing import assert_allclose

from app.document.channels.springs import Spring
from app.document.commands.handle_commands import add_handle
from app.document.keyframe import Target
from app.document.queries.target_error import (
    LEAST_TARGET_ERROR,
    DistortionRange,
    measure_target_errors,
)
from engine.maps import Bounds


def layer_and_pose(*, lag, share):
    """A handle so many pixels from its target, in a pose that uses this share of the shear."""
    document = altered(disc_document(), bounds=Bounds(k=0.5))
    layer = add_handle(0, CENTRE)(document).layers[0]
    rest = layer.keys[0].pose
    certificate = replace(rest.certificate, k=share * layer.bounds.k)
    target = Target(position=CENTRE + lag)
    return layer, replace(rest, targets={0: target}, certificate=certificate)


def least(layer):
    low, high = layer.domain.outline.real.min(), layer.domain.outline.real.max()
    assert high - low == pytest.approx(2 * RADIUS, rel=0.05)
    return LEAST_TARGET_ERROR * (high - low)


@pytest.mark.parametrize("share", [0.02, 0.9, 0.99])
def test_a_handle_falls_short_where_it_lags_by_enough_to_be_seen(share):
    layer, _ = layer_and_pose(lag=0, share=share)
    for lag, is_short in ((0.9 * least(layer), False), (1.1 * least(layer), True)):
        short = measure_target_errors(*layer_and_pose(lag=lag, share=share))
        assert set(short.errors) == ({0} if is_short else set())
    assert_allclose(short.errors[0], lag, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("share", "at_limits"), [(0.02, False), (0.9, False), (0.99, True)])
def test_only_limits_that_are_reached_hold_a_handle_back(share, at_limits):
    short = measure_target_errors(*layer_and_pose(lag=30, share=share))
    assert short.at_limits == at_limits
    assert ("limits" in short.reason) == at_limits


def test_what_follows_by_a_spring_never_falls_short():
    layer, pose = layer_and_pose(lag=30, share=0.5)
    spring = Spring(handle=0, frequency=2.0, damping=0.3)
    assert measure_target_errors(replace(layer, springs=(spring,)), pose).errors == {}
    still = replace(spring, enabled=False)
    assert measure_target_errors(replace(layer, springs=(still,)), pose).errors.keys() == {0}


@pytest.mark.parametrize(
    ("extremes", "words"),
    [
        (DistortionRange(k=0.1, sigma_a=3.9, sigma_b=0.9), ("stretch",)),
        (DistortionRange(k=0.495, sigma_a=1.1, sigma_b=0.9), ("shear",)),
        (DistortionRange(k=0.497, sigma_a=2.0, sigma_b=0.2505), ("squeeze", "shear")),
        # Walls stand a little inside: what is nearest to its limit holds.
        (DistortionRange(k=0.2, sigma_a=1.1, sigma_b=0.29), ("squeeze",)),
    ],
)
def test_what_a_limit_holds_back_has_a_word(extremes, words):
    assert extremes.reached(Bounds(k=0.5, sigma_a=4.0, sigma_b=0.25)) == words


def test_shares_count_from_no_distortion_to_the_limit():
    bounds = Bounds(k=0.5, sigma_a=4.0, sigma_b=0.25)
    none, half, full, folded = (
        [use.share for use in extremes.uses(bounds)]
        for extremes in (
            DistortionRange(0.0, 1.0, 1.0),
            DistortionRange(0.25, 2.0, 0.5),
            DistortionRange(0.5, 4.0, 0.25),
            DistortionRange(np.inf, np.inf, -1.0),
        )
    )
    assert_allclose([none, half, full], [[0] * 3, [0.5] * 3, [1] * 3], rtol=0, atol=1e-12)
    assert min(folded) > 100


def test_a_pose_older_than_a_handle_says_nothing_of_it():
    layer, pose = layer_and_pose(lag=30, share=0.5)
    assert measure_target_errors(layer, replace(pose, targets={})).errors == {}

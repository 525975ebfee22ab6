"""A few of the shapes of `python -m tests.campaigns --only shapes`, from picture to in-betweens."""

import numpy as np
import pytest

from tests.campaigns.shapes import degenerate_shape, drawn_shape, stress


@pytest.mark.parametrize(("make", "number"), [(drawn_shape, 1), (degenerate_shape, 0)])
def test_what_is_shown_of_any_shape_is_certified_and_does_not_fold(make, number):
    rng = np.random.default_rng(number)
    figures = stress(make(rng, number), rng, keys=2)
    assert figures["maps shown"] == 20
    assert figures["frames"] == 20

"""Motion between poses as a person makes them is always a series, and its error is true."""

import pytest
from settled_poses import SHAPES, series_of

from engine.interpolation import Variant


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.long if name == "spiral" else ()) for name in SHAPES],
)
def test_a_series_covers_all_of_the_time_between_settled_poses(name):
    # The metric variant asks for most functions; the others take turns.
    others = [variant for variant in Variant if variant is not Variant.METRIC]
    turn = list(SHAPES).index(name)
    for variant in (Variant.METRIC, others[turn]):
        covered, missed, stated = series_of(name, 0, variant, count=300)
        assert covered == 1.0, variant
        assert missed <= stated <= 1.0, variant

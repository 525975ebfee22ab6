"""Motion between poses as a person makes them is always a series, and its error is told truly."""

import pytest
from settled_poses import SHAPES, series_of

from engine.interpolation import Variant

POSES = 2  # of each shape; the campaign has more


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("seed", range(POSES))
def test_a_series_covers_all_of_the_time_between_settled_poses(name, seed):
    # The metric variant asks for most functions; the others take turns.
    others = [variant for variant in Variant if variant is not Variant.METRIC]
    turn = POSES * list(SHAPES).index(name) + seed
    for variant in (Variant.METRIC, others[turn % len(others)]):
        covered, missed, stated = series_of(name, seed, variant)
        assert covered == 1.0, variant
        assert missed <= stated <= 1.0, variant

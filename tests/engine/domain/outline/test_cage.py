import re

import numpy as np
import pytest
from hypothesis import given
from messages import says
from numpy.testing import assert_allclose
from outlines import check_cage
from shapes import regular_polygon, star_polygons

from engine.arrays import Complexes
from engine.domain.outline.cage import CLOSE_OUTLINE, offset_cage
from engine.errors import EngineError
from engine.geometry.polygon import distance_to_boundary, edge_vectors


def comb(gap: float) -> Complexes:
    """Two blocks of width 1 and a gap between them, open at the top."""
    return np.array([0, 2 + gap, 2 + gap + 1j, 1 + gap + 1j, 1 + gap + 0.2j, 1 + 0.2j, 1 + 1j, 1j])


def test_the_edges_of_a_regular_polygon_move_by_the_offset() -> None:
    outline = regular_polygon(12)
    cage = offset_cage(outline, 0.05)
    check_cage(outline, cage)
    assert_allclose(np.abs(cage), 1 + 0.05 / np.cos(np.pi / 12), rtol=1e-12, atol=0)


def test_edges_stay_parallel_where_there_is_room() -> None:
    outline = np.array([0, 2, 2 + 1j, 1 + 0.6j, 1j])
    cage = offset_cage(outline, 0.1)
    check_cage(outline, cage)
    turn = np.angle(edge_vectors(cage) / edge_vectors(outline))
    assert_allclose(turn, 0, rtol=0, atol=1e-12)


def test_sharp_corners_are_cut_at_twice_the_offset() -> None:
    outline = np.array([0, 4 - 0.2j, 4 + 0.2j])
    cage = offset_cage(outline, 0.05)
    check_cage(outline, cage)
    assert_allclose(abs(cage[0]), 0.1, rtol=1e-12, atol=0)


@pytest.mark.parametrize("gap", [0.02, 0.05, 0.2])
def test_the_cage_shrinks_into_a_gap(gap: float) -> None:
    outline = comb(gap)
    check_cage(outline, offset_cage(outline, 0.06))


def test_the_offset_is_reduced_only_near_the_gap() -> None:
    outline = comb(0.05)
    distance = distance_to_boundary(outline, offset_cage(outline, 0.03))
    assert_allclose(distance[0], 0.03 * np.sqrt(2), rtol=1e-9, atol=0)
    assert distance[4] < 0.025 * np.sqrt(2) * 0.71


@given(outline=star_polygons())
def test_random_polygons_get_a_cage_or_a_refusal(outline: Complexes) -> None:
    try:
        cage = offset_cage(outline, 0.02)
    except EngineError as error:
        assert re.search(says(CLOSE_OUTLINE), str(error))  # noqa: PT017
    else:
        check_cage(outline, cage)


@pytest.mark.parametrize("offset", [0.02, 0.05, 0.1])
def test_rugged_polygons_get_a_cage(offset: float) -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):
        outline = rng.uniform(0.8, 1.2, 60) * regular_polygon(60)
        check_cage(outline, offset_cage(outline, offset))


def test_an_outline_that_nearly_touches_itself_is_refused() -> None:
    with pytest.raises(EngineError, match=says(CLOSE_OUTLINE)):
        offset_cage(comb(0.001), 0.05)


@pytest.mark.parametrize("offset", [0.0, -1.0, np.nan])
def test_the_offset_must_be_positive(offset: float) -> None:
    with pytest.raises(EngineError, match="positive"):
        offset_cage(regular_polygon(8), offset)


def test_the_outline_must_be_simple_and_counter_clockwise() -> None:
    with pytest.raises(EngineError, match="clockwise"):
        offset_cage(regular_polygon(8)[::-1], 0.1)
    with pytest.raises(EngineError, match="crosses"):
        offset_cage(np.array([0, 1, 1j, 1 + 1.5j]), 0.1)

import numpy as np
from hypothesis import given, strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from shapes import regular_polygon

from engine.geometry import Pieces, bisect_segments, distance_to_segments

STARTS = np.array([0, 1 + 1j, 0.3j])
ENDS = np.array([1 + 0j, -2 + 5j, 7])


def assert_covers(pieces: Pieces) -> None:
    """The pieces of each segment follow each other from its start to its end."""
    assert_array_equal(pieces.segment, np.sort(pieces.segment))
    for segment in range(len(pieces.origin)):
        place, width = (x[pieces.segment == segment] for x in (pieces.place, pieces.width))
        assert_array_equal(place, np.concatenate([[0], np.cumsum(width)[:-1]]))
        assert place[-1] + width[-1] == 1


def test_whole_pieces_are_the_segments() -> None:
    pieces = Pieces.whole(STARTS, ENDS)
    assert_array_equal(pieces.starts, STARTS)
    assert_array_equal(pieces.ends, ENDS)
    assert_array_equal(pieces.lengths, np.abs(ENDS - STARTS))


def test_the_middle_of_a_halved_piece_is_exact() -> None:
    pieces = Pieces.whole(STARTS, ENDS).halved(np.array([False, True, False]))
    assert_array_equal(pieces.segment, [0, 1, 1, 2])
    assert_array_equal(pieces.starts, [0, 1 + 1j, -0.5 + 3j, 0.3j])
    assert_array_equal(pieces.ends[:3], [1, -0.5 + 3j, -2 + 5j])


@given(choices=st.lists(st.integers(0, 2**30 - 1), min_size=1, max_size=6))
def test_pieces_cover_their_segments_however_they_are_halved(choices: list[int]) -> None:
    pieces = Pieces.whole(STARTS, ENDS)
    for bits in choices:
        pieces = pieces.halved((bits >> np.arange(len(pieces)) % 30) & 1 == 1)
    assert_covers(pieces)
    inner = np.flatnonzero(np.diff(pieces.segment) == 0)
    assert_array_equal(pieces.ends[inner], pieces.starts[inner + 1])


def test_bisection_halves_what_is_not_fine_and_asks_once() -> None:
    asked: dict[tuple[int, float, float], bool] = {}

    def is_fine(pieces: Pieces) -> np.ndarray:
        fine = pieces.lengths <= 0.4 * np.abs(pieces.ends - 1)
        keys = list(zip(pieces.segment, pieces.place, pieces.width, strict=True))
        assert not asked.keys() & set(keys)
        asked.update(zip(keys, fine, strict=True))
        return np.asarray(fine)

    pieces = bisect_segments(Pieces.whole(STARTS, np.array([0.9, -2 + 5j, 7])), is_fine)
    assert_covers(pieces)
    fine = [key for key, is_fine in asked.items() if is_fine]
    assert sorted(fine) == list(zip(pieces.segment, pieces.place, pieces.width, strict=True))
    # Each of the others was halved, which makes one piece more.
    assert len(asked) - len(fine) == len(pieces) - len(STARTS) > 0


def test_distances_to_segments_are_those_to_a_dense_sampling() -> None:
    polygon = regular_polygon(5)
    starts, ends = polygon, np.roll(polygon, -1)
    points = np.array([0, 2, -0.4 + 0.9j, 1.0])
    along = np.linspace(0, 1, 20_001)[:, None]
    samples = starts + along * (ends - starts)
    sampled = np.abs(points[:, None, None] - samples).min(axis=1)
    assert_allclose(distance_to_segments(points, starts, ends), sampled, rtol=0, atol=1e-6)
    # A segment without length is a point.
    assert_allclose(distance_to_segments(points, starts[:1], starts[:1])[:, 0], abs(points - 1))

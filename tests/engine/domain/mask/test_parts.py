import numpy as np
import pytest
from messages import says
from numpy.testing import assert_array_equal
from outlines import notices_of
from scipy import ndimage

from engine.arrays import Booleans
from engine.domain.mask.parts import FRAGMENTED, join_parts
from engine.errors import EngineError


def canvas(size: int = 300) -> Booleans:
    return np.zeros((size, size), dtype=np.bool_)


def diagonal(mask: Booleans) -> float:
    rows, columns = np.nonzero(mask)
    return float(np.hypot(np.ptp(rows) + 1, np.ptp(columns) + 1))


def count_parts(mask: Booleans) -> int:
    return int(ndimage.label(mask, np.ones((3, 3)))[1])


def test_one_piece_without_holes_is_left_as_it_is() -> None:
    mask = canvas()
    mask[50:200, 60:250] = True
    piece = join_parts(mask, diagonal(mask))
    assert_array_equal(piece.mask, mask)
    assert notices_of(piece) == ()


def test_parts_that_touch_at_a_corner_are_one() -> None:
    mask = canvas()
    mask[50:100, 50:100] = mask[100:150, 100:150] = True
    piece = join_parts(mask, diagonal(mask))
    assert_array_equal(piece.mask, mask)
    assert notices_of(piece) == ()


def test_bridges_join_all_parts_and_take_nothing_away() -> None:
    mask = canvas()
    mask[20:60, 20:60] = mask[20:60, 150:200] = mask[200:280, 30:90] = mask[220:260, 200:280] = True
    piece = join_parts(mask, diagonal(mask))
    assert count_parts(piece.mask) == 1
    assert not (mask & ~piece.mask).any()
    assert notices_of(piece) == ("4 parts joined by invisible bridges",)
    # The longest of the four ways round is left open.
    assert count_parts(piece.mask & ~mask) == 3
    assert not piece.mask[100:180, 180:].any()


def test_a_bridge_is_the_shortest_way() -> None:
    mask = canvas()
    mask[100:200, 20:100] = mask[140:160, 160:280] = True
    bridge = join_parts(mask, diagonal(mask)).mask & ~mask
    rows, columns = np.nonzero(bridge)
    assert (columns.min(), columns.max()) == (100, 159)
    assert abs(rows.mean() - 149.5) < 1


def test_a_cloud_of_parts_is_closed_as_well() -> None:
    rng = np.random.default_rng(1)
    y, x = np.mgrid[:300, :300]
    mask = canvas()
    for cx, cy in rng.uniform(120, 180, (12, 2)):
        mask |= np.hypot(x - cx, y - cy) < 5
    parts = count_parts(mask)
    assert parts >= 6
    piece = join_parts(mask, diagonal(mask))
    assert count_parts(piece.mask) == 1
    few = mask & (ndimage.label(mask)[0] <= 2)
    assert (piece.mask & ~mask).sum() > 3 * (join_parts(few, diagonal(few)).mask & ~few).sum()


def test_specks_are_dropped_and_reported() -> None:
    mask = canvas()
    mask[50:250, 50:250] = True
    mask[10, 10] = mask[10, 12] = mask[280:282, 280] = True
    piece = join_parts(mask, diagonal(mask))
    assert not piece.mask[:40].any()
    assert notices_of(piece) == ("3 specks dropped (0.01% of the subject)",)


@pytest.mark.parametrize("size", [60, 4])
def test_hole_is_filled_and_has_its_share_of_the_subject(size: int) -> None:
    mask = canvas()
    mask[50:220, 50:217] = True
    mask[100 : 100 + size, 100 : 100 + size] = False
    piece = join_parts(mask, diagonal(mask))
    assert piece.mask[50:220, 50:217].all()
    assert notices_of(piece) == ()
    assert piece.largest_share([1]) == size**2 / (170 * 167)
    assert piece.largest_share([]) == 0


def test_pits_as_small_as_specks_are_filled_and_not_reported() -> None:
    mask = canvas()
    mask[50:220, 50:217] = True
    mask[100:102, 100:102] = mask[150, 150] = False
    piece = join_parts(mask, diagonal(mask))
    assert piece.mask[50:220, 50:217].all()
    assert len(piece.hole_areas) == 0
    assert not piece.holes.any()


def test_holes_are_numbered_by_their_size() -> None:
    mask = canvas()
    mask[50:220, 50:217] = True
    for number, (row, size) in enumerate(((60, 10), (100, 40), (160, 20))):
        mask[row : row + size, 100 + number : 100 + number + size] = False
    piece = join_parts(mask, diagonal(mask))
    assert piece.hole_areas.tolist() == [1600, 400, 100]
    assert [piece.holes[row, 105] for row in (65, 110, 165)] == [3, 1, 2]
    assert_array_equal(piece.mask, mask | (piece.holes > 0))
    assert piece.largest_share([2, 3]) == 400 / (170 * 167)


def test_holes_that_bridges_enclose_are_filled() -> None:
    mask = canvas()
    mask[50:60, 50:250] = mask[50:240, 50:60] = mask[50:240, 240:250] = True
    mask[245:255, 50:250] = True
    piece = join_parts(mask, diagonal(mask))
    assert count_parts(~piece.mask) == 1


def test_a_mask_of_crumbs_is_refused() -> None:
    with pytest.raises(EngineError, match=says(FRAGMENTED)):
        join_parts(np.pad(np.random.default_rng(0).random((200, 200)) < 0.1, 1), 283.0)

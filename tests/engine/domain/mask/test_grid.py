import numpy as np
import pictures
import pytest
from hypothesis import given, strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from engine.arrays import Booleans
from engine.domain.mask.grid import block_factor, reduce_blocks, repeat_blocks, working_grid


def pixel_centres(mask: Booleans) -> np.ndarray:
    """Where the subject's pixels are, y up from the picture's lower edge."""
    rows, columns = np.nonzero(mask)
    return np.asarray(columns + 0.5 + 1j * (mask.shape[0] - rows - 0.5))


@pytest.mark.parametrize(
    ("shape", "place", "cell"),
    [
        ((90, 60), (slice(20, 70), slice(5, 30)), 1 / 12),  # 50 pixels, enlarged to 600 cells
        ((700, 900), (slice(10, 650), slice(40, 880)), 1.0),
        ((2500, 3000), (slice(100, 2400), slice(300, 2700)), 3.0),  # 2,400 pixels, 800 blocks
    ],
)
def test_every_pixel_of_the_subject_is_in_a_cell_of_it(shape, place, cell) -> None:
    mask = np.zeros(shape, dtype=np.bool_)
    mask[place] = np.random.default_rng(0).random(mask[place].shape) < 0.3
    mask[place][0, 0] = mask[place][-1, -1] = True
    grid = working_grid(mask)
    assert grid.cell == cell
    cells = (pixel_centres(mask) - grid.origin) / grid.cell
    columns, rows = np.floor(cells.real).astype(int), np.floor(cells.imag).astype(int)
    assert grid.mask[rows, columns].all()
    if cell <= 1:
        # Nothing else is in it: as many cells as the enlarged pixels have.
        assert grid.mask.sum() == mask.sum() / cell**2
    height, width = (s.stop - s.start for s in place)
    assert_allclose(grid.diagonal * cell, np.hypot(height, width), rtol=2 * cell / width, atol=0)


def test_the_grid_has_free_space_all_round_and_maps_back_to_the_picture() -> None:
    mask = pictures.blob(120)[..., 3] > 0
    grid = working_grid(mask)
    for side in (grid.mask[0], grid.mask[-1], grid.mask[:, 0], grid.mask[:, -1]):
        assert not side.any()
    rows, columns = np.nonzero(grid.mask)
    corners = grid.to_picture(np.array([columns.min(), columns.max() + 1]) + 0j)
    pixels = pixel_centres(mask).real
    assert_allclose(corners.real, [pixels.min() - 0.5, pixels.max() + 0.5], rtol=0, atol=1e-9)
    assert rows.min() * grid.cell >= 0.05 * grid.diagonal * grid.cell


@given(
    height=st.integers(1, 40),
    width=st.integers(1, 40),
    factor=st.integers(1, 9),
    seed=st.integers(0),
)
def test_blocks_hold_any_or_all_of_their_pixels(height, width, factor, seed) -> None:
    mask = np.random.default_rng(seed % 2**32).random((height, width)) < 0.5
    for combine, of_block in ((np.logical_or, np.any), (np.logical_and, np.all)):
        blocks = reduce_blocks(mask, factor, combine)
        expected = [
            [
                of_block(mask[row : row + factor, column : column + factor])
                for column in range(0, width, factor)
            ]
            for row in range(0, height, factor)
        ]
        assert_array_equal(blocks, expected)
    spread = repeat_blocks(blocks, factor, mask.shape)
    assert spread.shape == mask.shape
    assert not (spread & ~mask).any()  # a block of which all pixels are set


def test_no_side_has_more_blocks_than_wanted() -> None:
    for longest, side in ((1024, 1024), (1024, 1025), (1400, 7000), (1, 9)):
        factor = block_factor((3, side), longest)
        assert -(-side // factor) <= longest
        assert factor == 1 or -(-side // (factor - 1)) > longest

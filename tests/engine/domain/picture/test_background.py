import numpy as np
import pictures
import pytest
from numpy.testing import assert_array_equal

from engine.arrays import Booleans, Bytes
from engine.domain.picture.background import flood_background

PAPER = (240, 235, 220)


def on_paper(mask: Booleans) -> Bytes:
    return pictures.on_plain(pictures.painted(mask), PAPER)[..., :3]


def square(size: int = 200) -> Booleans:
    mask = np.zeros((size, size), dtype=np.bool_)
    mask[size // 4 : -size // 4, size // 4 : -size // 4] = True
    return mask


def test_the_flood_takes_what_has_the_colour_of_the_border_and_is_joined_to_it() -> None:
    mask = square()
    ring = mask.copy()
    ring[90:110, 90:110] = False
    background = flood_background(on_paper(ring), 18)
    assert_array_equal(background.mask, ~mask)  # the hole has the colour, but no way to it
    assert_array_equal(background.enclosed, mask & ~ring)
    assert background.agreement == 1


@pytest.mark.parametrize(("channel", "levels", "flooded"), [(0, 18, 1), (1, 19, 0), (2, -18, 1)])
def test_the_tolerance_is_that_of_each_channel(channel: int, levels: int, flooded: int) -> None:
    rgb = on_paper(square())
    patch = rgb[5:40, 5:40, channel].astype(int) + levels
    rgb[5:40, 5:40, channel] = np.minimum(patch, 255)
    if flooded or rgb[5, 5, channel] - PAPER[channel] == levels:
        background = flood_background(rgb, 18)
        assert background.mask[5:40, 5:40].all() == bool(flooded)


def test_the_border_votes_and_the_minority_counts_against_it() -> None:
    rgb = on_paper(square())
    rgb[:, :60] = (10, 20, 30)  # the left side and 60 pixels of two others, of 800
    background = flood_background(rgb, 18)
    assert background.agreement == pytest.approx(1 - 320 / 800, abs=0.01)
    assert not background.mask[:, :60].any()
    assert background.mask[:, 151:].all()


def test_no_flood_passes_a_thin_channel_but_a_thin_gap_at_the_side_is_flooded() -> None:
    mask = np.zeros((600, 600), dtype=np.bool_)
    mask[100:500, 100:500] = True
    mask[250:350, 250:350] = False  # teeth in a mouth
    mask[299:301, 100:251] = False  # joined to the outside by a channel of 2 pixels
    background = flood_background(on_paper(mask), 18).mask
    assert not background[255:345, 260:345].any()
    assert background[299:301, 100:240].all()
    mask[250:350, 250:350] = True
    mask[285:315, 100:300] = False  # a gap of 30 pixels
    assert flood_background(on_paper(mask), 18).mask[285:315, 100:300].all()


def test_large_pictures_are_flooded_in_blocks_and_refined_to_pixels() -> None:
    rows, columns = np.mgrid[:700, :1501]
    disc = np.hypot(rows - 350, columns - 751) < 250.3  # an odd side, in blocks of two
    assert_array_equal(flood_background(on_paper(disc), 18).mask, ~disc)


def test_a_picture_of_one_colour_is_all_background() -> None:
    background = flood_background(np.full((50, 70, 3), 99, dtype=np.uint8), 0)
    assert background.mask.all()
    assert background.agreement == 1

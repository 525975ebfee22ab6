import io

import numpy as np
import pictures
import pytest
from numpy.testing import assert_array_equal
from PIL import Image
from scipy import ndimage

from app.cut_out import background
from app.cut_out.background import flood_background
from engine.arrays import Booleans, Bytes

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


def jpeg(rgb: Bytes, quality: int) -> Bytes:
    file = io.BytesIO()
    Image.fromarray(rgb).save(file, "JPEG", quality=quality)
    return np.asarray(Image.open(file).convert("RGB"))


@pytest.mark.parametrize("quality", [50, 60, 75, 85, 95])
@pytest.mark.parametrize("paper", [(255, 255, 255), (60, 200, 80)])
def test_what_an_encoder_leaves_around_a_drawing_is_background(paper, quality: int) -> None:
    for drawing, parts in ((pictures.star(7, 300), 1), (pictures.stick_figure(300, 4), 1)):
        rgb = pictures.on_plain(drawing, paper)[..., :3].copy()
        rgb[20:25, 20:25] = (200, 160, 20)  # an earring
        rgb[270:273, 20:23] = 0  # a dot
        subject = ~flood_background(jpeg(rgb, quality), 18).mask
        assert ndimage.label(subject, np.ones((3, 3)))[1] == parts + 2


def test_small_parts_stay_that_differ_clearly_and_pale_ones_that_are_not_so_small() -> None:
    rgb = np.full((100, 100, 3), 255, dtype=np.uint8)
    rgb[40:60, 40:60] = 0
    places = {"clear": ((10, 10), 1, 200), "pale": ((10, 50), 5, 230), "noise": ((10, 80), 4, 220)}
    for (row, column), size, level in places.values():
        rgb[row : row + size, column : column + size] = level
    subject = ~flood_background(rgb, 18).mask
    assert [name for name, (place, _, _) in places.items() if subject[place]] == ["clear", "pale"]


def test_islands_are_the_same_in_whatever_bands_they_are_looked_for(monkeypatch) -> None:
    rng = np.random.default_rng(0)
    grey = 255 - 40 * ndimage.binary_dilation(rng.random((200, 60)) > 0.93).astype(np.uint8)
    rgb = np.repeat(grey[..., None], 3, axis=2)
    found = []
    for band in (1, 7, 64, 1000):
        monkeypatch.setattr(background, "BAND", band)
        found.append(flood_background(rgb, 18).mask)
        assert_array_equal(found[-1], found[0])
    assert np.count_nonzero(found[0]) > np.count_nonzero(grey == 255)
    assert not found[0].all()


def test_a_picture_of_one_colour_is_all_background() -> None:
    background = flood_background(np.full((50, 70, 3), 99, dtype=np.uint8), 0)
    assert background.mask.all()
    assert background.agreement == 1


def test_every_pocket_that_is_seen_is_found_whatever_its_size_and_shade() -> None:
    """A sheet that darkens by 30 levels towards one side, as photographed, beyond the tolerance."""
    x, y = pictures.plane(600, 450)
    widths = (4, 6, 12, 40)
    mask = (np.abs(x - 300) < 240) & (np.abs(y - 225) < 150)
    places = [complex(100 + 130 * i, 225) for i in range(4)]
    pockets = np.zeros_like(mask)
    for place, width in zip(places, widths, strict=True):
        pockets |= (np.abs(x - place.real) < width / 2) & (np.abs(y - place.imag) < 60)
    for shade, quality in ((0, 0), (0, 60), (30, 0), (30, 85)):
        drawing = mask & ~pockets
        darker = np.where(drawing, 0, shade * x / 600)[..., None]
        rgb = (on_paper(drawing) - darker).astype(np.uint8)
        background = flood_background(jpeg(rgb, quality) if quality else rgb, 18)
        core = ndimage.binary_erosion(pockets) if quality else pockets
        reached = x < (600 if not shade else 500)  # as far as the paper around was flooded
        assert background.enclosed[core & reached].mean() > 0.97, (shade, quality)
        assert not background.enclosed[mask & ~ndimage.binary_dilation(pockets, iterations=2)].any()

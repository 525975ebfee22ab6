"""Pictures cut out of a plain background, against what they were drawn from."""

import io

import numpy as np
import pictures
import pytest
from numpy.testing import assert_array_equal
from PIL import Image
from scipy import ndimage

from app.cut_out import subject_mask, texture as painted_texture
from app.cut_out.matte import matte_picture
from engine.arrays import Bytes, Floats

INK = (40, 90, 160)
# Subject and background: dark on white, light on black, and two that differ in hue above all.
COLOURS = [
    (INK, (255, 255, 255)),
    ((230, 230, 210), (20, 20, 20)),
    ((200, 40, 40), (60, 200, 80)),
    ((250, 220, 80), (120, 160, 220)),
]


def texture(rgba: Bytes) -> Bytes:
    return painted_texture(rgba, subject_mask(rgba))


def disc(softness: float, size: int = 200) -> Floats:
    x, y = pictures.plane(size, size)
    return np.clip(0.5 + (0.35 * size - np.hypot(x - size / 2, y - size / 2)) / softness, 0, 1)


def star(softness: float, size: int = 200) -> Floats:
    hard = pictures.star(5, size)[..., 3] > 127
    inside, outside = (ndimage.distance_transform_edt(part) for part in (hard, ~hard))
    return np.clip(0.5 + (inside - outside - np.where(hard, 0.5, -0.5)) / softness, 0, 1)


def over(alpha: Floats, colour: tuple, background: tuple) -> Floats:
    return alpha[..., None] * np.array(colour) + (1 - alpha[..., None]) * np.array(background)


def painted(alpha: Floats, colour: tuple, background: tuple, *, jpeg: bool = False) -> Bytes:
    """An opaque picture of a shape in one colour on another."""
    rgb = np.round(over(alpha, colour, background)).astype(np.uint8)
    if jpeg:
        file = io.BytesIO()
        Image.fromarray(rgb).save(file, "JPEG", quality=85)
        rgb = np.asarray(Image.open(file).convert("RGB"))
    return np.dstack([rgb, np.full(alpha.shape, 255, dtype=np.uint8)])


@pytest.mark.parametrize("jpeg", [False, True])
@pytest.mark.parametrize(("colour", "background"), COLOURS)
@pytest.mark.parametrize("softness", [2.0, 5.0])
@pytest.mark.parametrize("shape", [disc, star])
def test_the_matte_is_that_of_the_drawing(shape, softness, colour, background, jpeg) -> None:
    truth = shape(softness)
    rgba = painted(truth, colour, background, jpeg=jpeg)
    result = texture(rgba)
    alpha = result[..., 3] / 255
    edge = (truth > 0) & (truth < 1)
    assert np.abs(alpha - truth)[edge].mean() < (0.06 if jpeg else 0.02)
    near = np.abs(rgba[..., :3].astype(int) - background).max(axis=2) <= 18
    assert alpha[near & (truth == 0)].max() <= 0.05
    well_inside = ndimage.binary_erosion(truth == 1, iterations=7)
    assert (alpha[well_inside] == 1).all()
    assert_array_equal(result[well_inside], rgba[well_inside])
    # Painted over any other colour it looks as if it had been drawn there.
    for paper in ((255, 255, 255), (0, 0, 0), (0, 0, 255)):
        error = np.abs(over(alpha, 0, paper) + alpha[..., None] * result[..., :3])
        error = np.abs(error - over(truth, colour, paper)).max(axis=2)
        assert error[~well_inside].mean() < (4 if jpeg else 0.5)


def test_the_colour_of_the_background_is_taken_out_of_the_edge() -> None:
    result = texture(painted(disc(3.0), INK, (255, 255, 255)))
    visible = result[..., 3] > 0
    assert np.abs(result[visible][:, :3].astype(int) - INK).max() <= 5
    # And transparent pixels beside it have the subject's colour, for whoever interpolates.
    beside = ndimage.binary_dilation(visible) & ~visible
    assert np.abs(result[beside][:, :3].astype(int) - INK).max() <= 5


@pytest.mark.parametrize(("colour", "background"), [(INK, (60, 200, 80)), *COLOURS[2:]])
def test_hues_that_a_jpeg_blurs_leave_no_rim(colour, background) -> None:
    truth = star(2.0)
    result = texture(painted(truth, colour, background, jpeg=True))
    weight = result[..., 3] * ((truth > 0) & (truth < 1))
    error = np.abs(result[..., :3].astype(int) - colour).max(axis=2)
    assert (weight * error).sum() / weight.sum() < 12


def test_a_dark_line_around_the_drawing_keeps_its_colour() -> None:
    white, black = (255, 255, 255), (0, 0, 0)
    x, y = pictures.plane(200, 200)
    depth = 70 - np.hypot(x - 100, y - 100)
    line, fill = np.clip(0.5 + depth, 0, 1), np.clip(0.5 + depth - 4, 0, 1)
    rgb = np.round(
        over(line, black, white) * (1 - fill[..., None]) + fill[..., None] * [250, 240, 60]
    )
    rgba = np.dstack([rgb.astype(np.uint8), np.full(line.shape, 255, dtype=np.uint8)])
    result = texture(rgba)
    edge = (line > 0) & (line < 1)
    assert np.abs(result[..., 3] / 255 - line)[edge].mean() < 0.02
    assert result[edge & (line > 0.1), :3].max() <= 12
    assert_array_equal(result[(depth > 0.5) & (depth < 3)][:, 3], 255)


def test_thin_lines_are_not_eaten() -> None:
    strokes = pictures.stick_figure(300, 4)
    strokes[..., 3][:100] = 0  # without the head: the paper in it is not background
    truth = strokes[..., 3] / 255
    result = texture(painted(truth, (0, 0, 0), (255, 255, 255)))
    assert np.abs(result[..., 3] / 255 - truth).max() < 0.01


def test_a_background_that_fades_is_taken_where_it_is() -> None:
    x, _ = pictures.plane(200, 200)
    truth = disc(2.0)
    paper = np.stack([200 + 0.05 * x, 210 - 0.05 * x, 190 + 0 * x], axis=-1)
    rgb = np.round(truth[..., None] * INK + (1 - truth[..., None]) * paper).astype(np.uint8)
    result = texture(np.dstack([rgb, np.full(truth.shape, 255, dtype=np.uint8)]))
    assert np.abs(result[..., 3] / 255 - truth).max() < 0.09


def test_a_pale_subject_is_not_eaten() -> None:
    truth = disc(1.0)
    result = texture(painted(truth, (255, 255, 220), (255, 255, 255)))
    assert (result[..., 3][truth == 1] == 255).all()
    assert (result[..., 3][ndimage.binary_erosion(truth == 0, iterations=2)] == 0).all()


def test_the_picture_s_own_transparency_stays_as_it_is() -> None:
    for rgba in (pictures.glow(), pictures.star(5), pictures.ring()):
        assert texture(rgba) is rgba
        assert not subject_mask(rgba).cut


def test_a_whole_picture_stays_opaque() -> None:
    rgba = np.random.default_rng(0).integers(0, 256, (60, 80, 4), dtype=np.uint8)
    rgba[..., 3] = 255
    assert texture(rgba) is rgba


def test_the_subject_may_touch_the_picture_s_sides() -> None:
    truth = disc(2.0)[36:, 10:]
    rgba = painted(truth, INK, (255, 255, 255))
    result = matte_picture(rgba, subject_mask(rgba).mask)
    edge = (truth > 0) & (truth < 1)
    assert np.abs(result[..., 3] / 255 - truth)[edge].mean() < 0.02


def test_masks_without_an_edge_change_nothing() -> None:
    rgba = painted(disc(1.0), INK, (255, 255, 255))
    for subject in (np.zeros(rgba.shape[:2], np.bool_), np.ones(rgba.shape[:2], np.bool_)):
        assert_array_equal(matte_picture(rgba, subject), rgba)


def test_noise_hides_no_edge_and_is_none_of_the_subject() -> None:
    rng = np.random.default_rng(0)
    for colour, background in COLOURS:
        truth = star(2.5)
        noisy = over(truth, colour, background) + rng.normal(0, 3, (*truth.shape, 3))
        rgb = np.clip(np.round(noisy), 0, 255).astype(np.uint8)
        rgba = np.dstack([rgb, np.full(truth.shape, 255, dtype=np.uint8)])
        alpha = texture(rgba)[..., 3] / 255
        assert np.abs(alpha - truth)[(truth > 0) & (truth < 1)].mean() < 0.03
        assert alpha[truth == 0].max() <= 0.05


def test_a_mask_on_a_busy_photograph_has_a_soft_edge_and_no_holes() -> None:
    rng = np.random.default_rng(1)
    grain = sum(
        width * ndimage.gaussian_filter(rng.normal(0, 60, (240, 240, 3)), (width, width, 0))
        for width in (1, 4)
    )
    x, _ = pictures.plane(240, 240)
    truth = disc(1.0, 240)
    rgb = 120 + 0.3 * x[..., None] + grain
    rgba = np.dstack([np.clip(rgb, 0, 255), np.full(truth.shape, 255)]).astype(np.uint8)
    kept = truth > 0.5
    alpha = matte_picture(rgba, kept)[..., 3] / 255
    assert alpha[ndimage.binary_erosion(kept, iterations=3)].min() > 0.8
    assert alpha[ndimage.binary_dilation(kept, iterations=2) == 0].max() < 0.1
    # Whatever the colours happen to be: nowhere far from what the mask alone would tell.
    assert np.abs(alpha - truth).mean() < 0.02


def test_what_is_cut_by_hand_from_one_colour_is_not_eaten() -> None:
    rgba = np.full((120, 120, 4), 255, dtype=np.uint8)
    kept = disc(1.0, 120) > 0.5
    alpha = matte_picture(rgba, kept)[..., 3]
    assert (alpha[ndimage.binary_erosion(kept, iterations=2)] == 255).all()
    assert (alpha[~ndimage.binary_dilation(kept)] == 0).all()


def test_large_pictures_are_worked_on_in_tiles_that_leave_no_seams() -> None:
    truth = disc(2.0, 700)
    result = texture(painted(truth, INK, (255, 255, 255)))
    assert np.abs(result[..., 3] / 255 - truth).max() < 0.05

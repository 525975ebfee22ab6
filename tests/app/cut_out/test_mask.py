import io

import numpy as np
import pictures
import pytest
from messages import says
from numpy.testing import assert_array_equal
from PIL import Image
from scipy import ndimage

from app.cut_out import CutOut, Mask, Stroke, subject_mask
from app.cut_out.cut_out import BackgroundColour, Enclosed
from app.cut_out.mask import PICTURE_TYPE, SMALL_SUBJECT, TRANSPARENT
from engine.arrays import Booleans, Bytes
from engine.errors import EngineError

WHITE = (255, 255, 255)
GREEN = (120, 170, 110)


def visible(rgba: Bytes) -> Booleans:
    return rgba[..., 3] > 0


def test_the_subject_is_what_is_not_transparent() -> None:
    rgba = pictures.star(5, 120)
    subject = subject_mask(rgba)
    assert_array_equal(subject.mask, rgba[..., 3] > 0)
    assert subject.notices == ()
    assert not subject.mask.flags.writeable


def test_nearly_invisible_islands_are_left_out_and_edges_are_not() -> None:
    rgba = pictures.star(5)
    rgba[..., 3][:2, :2] = 3  # an island
    rows, columns = np.nonzero(rgba[..., 3] == 255)
    at = columns[0]
    rgba[: rows[0], at, 3] = 0
    rgba[rows[0] - 1, at, 3] = 5  # beside the star
    subject = subject_mask(rgba)
    assert subject.notices == ()
    assert not subject.mask[:2, :2].any()
    assert subject.mask[rows[0] - 1, at]


def test_a_wide_nearly_invisible_haze_is_left_out() -> None:
    rgba = pictures.blob(100)
    rgba[10:90, 10:90, 3] = np.maximum(rgba[10:90, 10:90, 3], 3)
    subject = subject_mask(rgba)
    assert_array_equal(subject.mask, rgba[..., 3] >= 8)
    assert "faint pixel" in subject.notices[0]


def test_a_narrow_nearly_invisible_rim_is_kept() -> None:
    rgba = pictures.blob(200)
    rim = ndimage.binary_dilation(visible(rgba)) & ~visible(rgba)
    rgba[rim, 3] = 3
    assert_array_equal(subject_mask(rgba).mask, visible(rgba))


@pytest.mark.parametrize("noise", [0.0, 3.0])
def test_a_plain_background_is_removed(noise: float) -> None:
    drawing = pictures.blob(200)
    subject = subject_mask(pictures.on_plain(drawing, (230, 240, 250), noise=noise))
    assert "plain background removed" in subject.notices[0]
    assert np.mean(subject.mask != visible(drawing)) < 0.002


def test_a_background_with_jpeg_artefacts_is_removed() -> None:
    drawing = pictures.star(5, 240)
    file = io.BytesIO()
    Image.fromarray(pictures.on_plain(drawing, WHITE)).convert("RGB").save(file, "JPEG", quality=75)
    subject = subject_mask(np.asarray(Image.open(file).convert("RGBA")))
    assert "plain background removed" in subject.notices[0]
    assert not np.any((drawing[..., 3] > 200) & ~subject.mask)
    assert subject.mask.sum() < 1.3 * (drawing[..., 3] > 0).sum()


def test_large_pictures_lose_their_background_to_the_pixel() -> None:
    drawing = np.kron(pictures.blob(250), np.ones((7, 7, 1), dtype=np.uint8))
    subject = subject_mask(pictures.on_plain(drawing, WHITE))
    assert_array_equal(subject.mask, visible(drawing))


def test_teeth_behind_a_thin_opening_are_not_eaten() -> None:
    teeth = np.zeros((400, 400), dtype=np.bool_)
    teeth[150:250, 120:280] = True
    teeth[199:201, 280:360] = True  # a line of the background's colour leads out
    drawing = pictures.ring(400)
    drawing[..., 3] = 255 * (pictures.blob(400, depth=0.0)[..., 3] > 0)
    drawing[teeth, 3] = 0
    mask = subject_mask(pictures.on_plain(drawing, WHITE)).mask
    assert mask[160:240, 130:270].all()


def test_a_thin_gap_before_a_background_stays_open() -> None:
    drawing = pictures.limbs(3)
    mask = subject_mask(pictures.on_plain(drawing, WHITE)).mask
    assert_array_equal(mask, visible(drawing))


def test_a_picture_without_plain_background_is_kept_whole() -> None:
    rgba = np.full((60, 90, 4), 255, dtype=np.uint8)
    rgba[..., :3] = np.random.default_rng(0).integers(0, 256, (60, 90, 3))
    subject = subject_mask(rgba)
    assert subject.mask.all()
    assert "whole rectangle" in subject.notices[0]


def test_a_picture_of_nothing_but_background_is_kept_whole() -> None:
    subject = subject_mask(np.full((60, 90, 4), 255, dtype=np.uint8))
    assert subject.mask.all()
    assert "only 0.0% of the picture would be left" in subject.notices[0]


def test_the_tolerance_decides_what_belongs_to_the_background() -> None:
    rgba = pictures.on_plain(pictures.blob(200), WHITE)
    rgba[:60, :60, :3] = 235
    assert not subject_mask(rgba, CutOut(tolerance=25)).mask[:50, :50].any()
    assert subject_mask(rgba, CutOut(tolerance=10)).mask[5:50, 5:50].all()


@pytest.mark.parametrize(
    ("rgba", "message"),
    [
        (np.zeros((20, 20, 4), dtype=np.uint8), says(TRANSPARENT)),
        (np.full((20, 20, 4), 7, dtype=np.uint8), says(TRANSPARENT)),
        (np.zeros((0, 20, 4), dtype=np.uint8), "no pixels"),
        (pictures.painted(np.eye(20) * np.eye(20)[0] > 0), says(SMALL_SUBJECT, width=1, height=1)),
        (np.full((7, 7, 4), 255, dtype=np.uint8), says(SMALL_SUBJECT, width=7, height=7)),
        (np.zeros((20, 20, 3), dtype=np.uint8), says(PICTURE_TYPE)),
        (np.zeros((20, 20, 4)), says(PICTURE_TYPE)),
    ],
)
def test_unusable_pictures_are_refused(rgba: Bytes, message: str) -> None:
    with pytest.raises(EngineError, match=message):
        subject_mask(rgba)


@pytest.mark.parametrize("tolerance", [-1, 256])
def test_a_tolerance_beyond_the_levels_is_refused(tolerance: int) -> None:
    with pytest.raises(EngineError, match=str(tolerance)):
        subject_mask(pictures.blob(50), CutOut(tolerance=tolerance))


def test_a_background_s_colour_can_be_chosen() -> None:
    drawing = pictures.blob(200, depth=0.0)
    paper = (120, 200, 90)
    rgba = pictures.on_plain(drawing, paper)
    rgba[:, :15, :3] = rgba[:15, :, :3] = 10  # most of the border is a frame of another colour
    assert not np.array_equal(
        subject_mask(rgba).mask, subject_mask(rgba, CutOut(background=paper)).mask
    )
    chosen = subject_mask(rgba, CutOut(background=paper))
    assert np.mean(chosen.mask[15:, 15:] != visible(drawing)[15:, 15:]) < 0.003
    assert chosen.mask[:15].all()
    assert "background removed" in chosen.notices[0]


def test_no_background_is_removed_where_none_is_wanted() -> None:
    rgba = pictures.on_plain(pictures.blob(100), WHITE)
    subject = subject_mask(rgba, CutOut(background="none"))
    assert subject.mask.all()
    assert subject.notices == ()


def test_a_colour_is_removed_through_what_is_transparent() -> None:
    rgba = pictures.blob(100, depth=0.0)
    rgba[40:60, 40:60] = (*WHITE, 255)
    rgba[45:55, :45, 3] = 0  # the white inside is reached from outside
    rgba[45:55, 45, :] = (*WHITE, 255)
    subject = subject_mask(rgba, CutOut(background=WHITE))
    assert not subject.mask[48:52, 42:58].any()
    assert subject.mask[50, 80]


def test_a_mask_is_taken_at_its_word() -> None:
    rgba = pictures.blob(100)
    mask = np.zeros((100, 100), dtype=np.bool_)
    mask[20:60, 30:90] = True
    assert_array_equal(subject_mask(rgba, CutOut(mask=Mask.of(mask))).mask, mask & visible(rgba))


def test_masks_and_colours_that_are_none_are_refused() -> None:
    rgba = pictures.blob(100)
    with pytest.raises(EngineError, match="removes the whole picture"):
        subject_mask(rgba, CutOut(mask=Mask.of(~visible(rgba))))
    with pytest.raises(EngineError, match="90 × 100 pixels, but the picture has 100 × 100"):
        subject_mask(rgba, CutOut(mask=Mask.of(visible(rgba)[:, 10:])))
    with pytest.raises(EngineError, match="three levels from 0 to 255"):
        subject_mask(rgba, CutOut(background=(0, 300, 0)))
    with pytest.raises(EngineError, match="Nothing is left"):
        subject_mask(pictures.on_plain(rgba, WHITE), CutOut(background=WHITE, tolerance=255))


@pytest.mark.parametrize(
    ("colour", "enclosed", "what"),
    [
        (GREEN, "auto", "removed too"),
        (WHITE, "auto", "kept"),
        (GREEN, "keep", "kept"),
        (WHITE, "remove", "removed too"),
    ],
)
def test_enclosed_parts_go_with_vivid_background_or_on_request(
    colour: BackgroundColour, enclosed: Enclosed, what: str
) -> None:
    ring = pictures.ring(300)
    filled: Booleans = ndimage.binary_fill_holes(visible(ring))
    for cut_out in (CutOut(enclosed=enclosed), CutOut(background=colour, enclosed=enclosed)):
        subject = subject_mask(pictures.on_plain(ring, colour, noise=2.0), cut_out)
        assert_array_equal(subject.mask, filled if what == "kept" else visible(ring))
        assert subject.enclosed is not None
        assert_array_equal(subject.enclosed, filled & ~visible(ring))
        assert f"1 enclosed part of the background's colour {what}" in subject.notices


def test_a_point_treats_what_is_enclosed_the_other_way() -> None:
    ring = visible(pictures.ring(300))
    filled: Booleans = ndimage.binary_fill_holes(ring)
    elsewhere = 20 + 20j
    for colour, holes, wanted, left in (
        (GREEN, "keep", filled, (elsewhere,)),
        (WHITE, "keep", ring, (elsewhere,)),
        # Where holes are filled, the one that is not has to be named to what fills them.
        (GREEN, "fill", ring, (150 + 140j, elsewhere)),
    ):
        cut_out = CutOut(holes=holes, toggled_holes=(150 + 140j, elsewhere))
        subject = subject_mask(pictures.on_plain(pictures.painted(ring), colour), cut_out)
        assert_array_equal(subject.mask, wanted)
        assert subject.toggled_holes == left


def test_lines_on_coloured_paper_enclose_their_drawing() -> None:
    x, y = pictures.plane(300, 300)
    radius = np.hypot(x - 150, y - 150)
    line = (radius < 120) & (radius > 115)
    subject = subject_mask(pictures.on_plain(pictures.painted(line), GREEN))
    assert_array_equal(subject.mask, radius < 120)
    hoop = (radius < 120) & (radius > 95)
    subject = subject_mask(pictures.on_plain(pictures.painted(hoop), GREEN))
    assert_array_equal(subject.mask, hoop)


def test_a_brush_decides_over_what_is_enclosed() -> None:
    ring = visible(pictures.ring(300))
    keep = Stroke(points=np.array([150 + 150j]), radius=120.0, keeps=True)
    subject = subject_mask(
        pictures.on_plain(pictures.painted(ring), GREEN), CutOut(strokes=(keep,))
    )
    assert subject.mask[150, 150]
    assert subject.enclosed is not None
    assert not subject.enclosed[150, 150]


def test_eyes_on_green_and_gaps_between_hairs() -> None:
    """Thin gaps are no holes of their own, but show nothing of a vivid background."""
    rgba = pictures.painted(np.pad(np.ones((200, 200), dtype=np.bool_), 50))
    rgba[100:140, 100:108, 3] = 0
    rgba[100:140, 120:122, 3] = 0
    opaque = pictures.on_plain(rgba, GREEN)
    opaque[100:140, 150:190, :3] = WHITE
    subject = subject_mask(opaque)
    assert not subject.mask[100:140, 100:108].any()
    assert not subject.mask[100:140, 120:122].any()
    assert subject.mask[100:140, 150:190].all()

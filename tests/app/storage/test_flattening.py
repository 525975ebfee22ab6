"""Blends of pictures in memory, against the formulas of the W3C."""

import numpy as np
import pytest
from blend_formulas import BLEND_FORMULAS
from numpy.testing import assert_allclose
from PIL import Image

from app.document.layers.groups import BLENDS
from app.storage.flattening import blend_pictures

SIDE = 70  # more rows than are blended at a time


@pytest.mark.parametrize("mode", BLENDS[1:])
def test_pictures_are_blended_by_the_formula_of_the_mode(mode):
    rng = np.random.default_rng(7)
    backdrop, source = rng.integers(0, 256, (2, SIDE, SIDE, 3), dtype=np.uint8)
    # Greys, black and white, at which some formulas are steep.
    backdrop[:8], source[4:12], source[:, :4], backdrop[:, 2:6] = 128, 100, 0, 255
    found = blend_pictures(Image.fromarray(backdrop), Image.fromarray(source), mode)
    wanted = BLEND_FORMULAS[mode](backdrop / 255, source / 255)
    assert_allclose(np.asarray(found) / 255, wanted, rtol=0, atol=1 / 255)

"""Blends of pictures in memory, against the formulas of the W3C."""

from dataclasses import replace

import numpy as np
import pytest
from animations import moving_document
from blend_formulas import BLEND_FORMULAS
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from app.document import LAYER_KINDS
from app.document.layers.groups import BLENDS
from app.storage.scenes.flattening import blend_pictures, flatten_layers

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


def test_flat_picture_shows_the_tint_of_a_layer():
    document, tint = moving_document(), LAYER_KINDS["tint"]
    (layer,) = document.layers
    tinted = layer.with_keys_of(tint, [tint.key(0, (0.2, 1.0, 0.6))])
    width, height = document.canvas
    pixels = {layer.id: np.full((height, width, 4), 100, np.uint8)}
    assert_array_equal(flatten_layers(document, pixels), pixels[layer.id])
    flat = flatten_layers(replace(document, layers=(tinted,)), pixels)
    assert_array_equal(flat, np.broadcast_to((20, 100, 60, 100), flat.shape))

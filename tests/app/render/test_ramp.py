import numpy as np
from numpy.testing import assert_allclose

from app.render.colormap import heat_colormap, oklab_to_srgb


def luminance(colours):
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    return linear @ [0.2126, 0.7152, 0.0722]


def test_oklab_has_white_black_and_red_where_they_belong():
    lab = np.array([[1.0, 0, 0], [0, 0, 0], [0.6279554, 0.2248631, 0.1258463]])
    assert_allclose(oklab_to_srgb(lab), [[1, 1, 1], [0, 0, 0], [1, 0, 0]], rtol=0, atol=2e-3)


def test_lightness_rises_evenly_so_that_the_order_needs_no_colour_vision():
    ramp = heat_colormap() / 255
    lightness = 116 * np.cbrt(luminance(ramp)) - 16
    steps = np.diff(lightness[::16])
    assert (np.diff(lightness) > -0.3).all()
    assert steps.min() > 0.6 * steps.mean()
    assert lightness[0] < 25
    assert lightness[-1] > 93


def test_the_ends_are_far_apart_for_dichromats_too():
    # Viénot, Brettel and Mollon (1999), on linear colours: protanopia and deuteranopia.
    ramp = heat_colormap() / 255
    for matrix in (
        [[0.11238, 0.88762, 0], [0.11238, 0.88762, 0], [0.00401, -0.00401, 1]],
        [[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]],
    ):
        seen = np.clip(ramp**2.2 @ np.transpose(matrix), 0, 1)
        assert (np.diff((seen @ [0.2126, 0.7152, 0.0722])[::8]) > 0).all()

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.testing import assert_allclose

from app.errors import LissomError
from app.render.view import View, canvas_view, fit_view

sides = st.integers(1, 4000)
coordinates = st.floats(-5000, 5000)
lengths = st.just(0.0) | st.floats(1, 5000)
points = st.builds(complex, coordinates, coordinates)
views = st.builds(
    lambda centre, scale, width, height: View(centre=centre, scale=scale, size=(width, height)),
    points,
    st.floats(0.01, 100),
    sides,
    sides,
)


turned = st.builds(
    lambda view, turn: replace(view, turn=complex(np.exp(1j * turn))), views, st.floats(-4, 4)
)


@given(turned, points)
def test_pixels_and_points_are_inverses(view, point):
    pixel = view.to_pixels(np.array([point]))[0]
    assert_allclose(view.to_plane(pixel), point, rtol=0, atol=1e-8)


@given(views)
def test_the_corners_of_a_frame(view):
    width, height = view.size
    upper_left = view.to_plane(0j)
    assert_allclose(upper_left.real, view.centre.real - width / 2 / view.scale, rtol=1e-12)
    assert_allclose(upper_left.imag, view.centre.imag + height / 2 / view.scale, rtol=1e-12)


@given(turned, points)
def test_the_shaders_transform_agrees_with_the_pixels(view, point):
    x, y, offset_x, offset_y = view.transform
    place = view.turn * point
    clip = complex(x * place.real + offset_x, y * place.imag + offset_y)
    pixel = view.to_pixels(np.array([point]))[0]
    wanted = complex(2 * pixel.real / view.size[0] - 1, 1 - 2 * pixel.imag / view.size[1])
    assert_allclose(clip, wanted, rtol=1e-9, atol=1e-9)


@given(views, points, st.floats(0.1, 10))
def test_zooming_keeps_the_point_under_the_pointer(view, pixel, factor):
    zoomed = view.zoomed(factor, pixel)
    assert_allclose(zoomed.to_plane(pixel), view.to_plane(pixel), rtol=1e-9, atol=1e-6)
    assert_allclose(zoomed.scale, view.scale * factor, rtol=1e-12)


@given(views, points, points)
def test_panning_moves_what_is_under_the_pointer_along(view, pixel, pixels):
    assert_allclose(
        view.panned(pixels).to_plane(pixel + pixels), view.to_plane(pixel), rtol=1e-9, atol=1e-6
    )


def test_the_canvas_is_the_picture_pixel_by_pixel():
    view = canvas_view((320, 200))
    assert view == View(centre=160 + 100j, scale=1.0, size=(320, 200))
    assert_allclose(view.to_pixels(np.array([0.5 + 199.5j])), [0.5 + 0.5j], rtol=0, atol=0)


def test_a_canvas_of_another_shape_is_centred():
    view = canvas_view((320, 200), (640, 640))
    assert view == View(centre=160 + 100j, scale=2.0, size=(640, 640))


@given(points, st.tuples(lengths, lengths), st.tuples(sides, sides), st.floats(0, 40))
def test_a_fitted_box_lies_within_its_margin_and_touches_it(lower, extent, size, margin):
    (width, height), (columns, rows) = extent, size
    view = fit_view(lower, lower + complex(width, height), size, margin=margin)
    shown = view.scale * np.array(extent)
    free = np.maximum(np.array(size) - 2 * margin, 1)
    assert np.all(shown <= free * (1 + 1e-9))
    if max(extent) > 0:
        assert_allclose((shown / free).max(), 1, rtol=1e-9)
    corners = view.to_pixels(np.array([lower, lower + complex(width, height)]))
    assert_allclose(corners.mean(), complex(columns, rows) / 2, rtol=0, atol=1e-6)


def test_frames_without_an_extent_are_refused():
    with pytest.raises(LissomError, match="at least 1 × 1 pixels, not 0 × 20"):
        View(centre=0j, scale=1.0, size=(0, 20))
    with pytest.raises(LissomError, match="positive, not 0"):
        View(centre=0j, scale=0.0, size=(1, 1))

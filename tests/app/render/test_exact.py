"""The drawing at rest comes back as the source picture, level by level."""

import numpy as np
import pytest
from drawings import Easel, all_levels, grid_mesh, soft_blob
from numpy.testing import assert_array_equal

from app.render.scene import Backdrop, Scene
from app.render.view import canvas_view
from engine.arrays import Bytes


def at_rest(easel: Easel, picture: Bytes, cells: int) -> Bytes:
    height, width, _ = picture.shape
    rest, triangles = grid_mesh(width, height, cells)
    pose = easel.pose(easel.mesh(picture, rest, triangles), rest)
    return easel.frame(canvas_view((width, height)), Scene(meshes=(pose,)))


def without_hidden_colours(picture: Bytes) -> Bytes:
    return np.where(picture[..., 3:] == 0, np.uint8(0), picture)


@pytest.mark.parametrize("cells", [1, 7, 150])
def test_every_alpha_and_colour_comes_back(easel, cells):
    picture = all_levels()
    assert_array_equal(at_rest(easel, picture, cells), without_hidden_colours(picture))


def test_soft_edges_come_back_and_hidden_colours_do_not(easel):
    picture = soft_blob()
    assert picture[0, 0].tolist() == [255, 0, 255, 0]
    assert_array_equal(at_rest(easel, picture, 9), without_hidden_colours(picture))


@pytest.mark.parametrize("size", [(2999, 13), (17, 2500), (1, 1)])
def test_odd_and_large_sizes_come_back(easel, size):
    rng = np.random.default_rng(3)
    picture = rng.integers(0, 256, (size[1], size[0], 4), dtype=np.uint8)
    assert_array_equal(at_rest(easel, picture, 5), without_hidden_colours(picture))


def test_the_same_frame_comes_out_twice(easel):
    picture = soft_blob()
    rest, triangles = grid_mesh(120, 90, 12)
    turned = (rest - 60 - 45j) * np.exp(0.4j) * 1.3 + 60 + 45j
    mesh = easel.mesh(picture, rest, triangles)
    frames = [
        easel.frame(canvas_view((120, 90)), Scene(meshes=(easel.pose(mesh, turned),)))
        for _ in range(2)
    ]
    assert_array_equal(*frames)


def test_a_coloured_background_is_exact_where_it_is_seen(easel):
    picture = soft_blob()
    rest, triangles = grid_mesh(120, 90, 6)
    pose = easel.pose(easel.mesh(picture, rest, triangles), rest)
    colour = (12 / 255, 200 / 255, 77 / 255, 1.0)
    frame = easel.frame(
        canvas_view((120, 90)), Scene(background=Backdrop(colour=colour), meshes=(pose,))
    )
    alpha = picture[..., 3:] / 255
    wanted = picture[..., :3] * alpha + np.array([12, 200, 77]) * (1 - alpha)
    assert_array_equal(frame[..., 3], 255)
    # Half floats keep 11 bits: half a level at most, and the rounding to bytes.
    assert np.abs(frame[..., :3] - wanted).max() <= 0.75
    assert (frame[picture[..., 3] == 0, :3] == [12, 200, 77]).all()

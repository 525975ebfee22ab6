"""What is drawn over and under the drawing: golden images, and what must hold of any picture."""

from itertools import pairwise

import numpy as np
import pytest
from drawings import Easel, grid_mesh, soft_blob
from numpy.testing import assert_allclose, assert_array_equal

from app.errors import LissomError
from app.render.gpu.mesh import GpuMesh, PosedMesh, PositionBuffer, to_float32_points
from app.render.gpu.picture import GpuPicture
from app.render.gpu.target import RenderTarget
from app.render.handles import HandleMark, mark_handles
from app.render.scene import Backdrop, Disc, Ghost, Heat, Line, Scene, Wireframe
from app.render.view import View, canvas_view, fit_view
from engine.arrays import Complexes
from engine.domain.meshing.mesh import border_edges

WIDTH, HEIGHT = 120, 90
VIEW = View(centre=60 + 45j, scale=1.25, size=(180, 140))
PAPER = Backdrop(colour=(0.97, 0.97, 0.95, 1.0), checks=(0.88, 0.88, 0.87, 1.0))
NIGHT = Backdrop(colour=(0.16, 0.17, 0.19, 1.0), checks=(0.20, 0.21, 0.23, 1.0), square=8.0)


def bent(rest: Complexes, amount: float = 1.0) -> Complexes:
    """A quarter of a turn from left to right, about a point below."""
    angle = -amount * (rest.real - WIDTH / 2) / WIDTH
    return WIDTH / 2 - 50j + (rest.imag + 50) * 1j * np.exp(1j * angle)


def blob_mesh(easel: Easel, cells: int = 10) -> tuple[GpuMesh, Complexes]:
    rest, triangles = grid_mesh(WIDTH, HEIGHT, cells)
    return easel.mesh(soft_blob(WIDTH, HEIGHT), rest, triangles), rest


def test_the_drawing_on_a_checkerboard(easel, check_golden):
    mesh, rest = blob_mesh(easel)
    scene = Scene(background=PAPER, meshes=(easel.pose(mesh, bent(rest)),))
    check_golden("checkerboard", easel.frame(VIEW, scene))


def test_a_heat_map(easel, check_golden):
    mesh, rest = blob_mesh(easel)
    pose = easel.pose(mesh, bent(rest))
    pose.write_heat((rest.real / WIDTH + 0.1 * np.sin(rest.imag / 9)).astype(np.float32))
    scene = Scene(background=NIGHT, meshes=(pose,), heat=Heat(low=0.0, high=1.0))
    check_golden("heat", easel.frame(VIEW, scene))


def test_a_wireframe(easel, check_golden):
    mesh, rest = blob_mesh(easel)
    wireframe = Wireframe(colour=(0.05, 0.12, 0.3, 0.8))
    scene = Scene(background=PAPER, meshes=(easel.pose(mesh, bent(rest)),), wireframe=wireframe)
    check_golden("wireframe", easel.frame(VIEW, scene))


def test_onion_skins(easel, check_golden):
    mesh, rest = blob_mesh(easel)
    ghosts = tuple(
        Ghost(meshes=(easel.pose(mesh, bent(rest, amount) + shift),), tint=tint, opacity=opacity)
        for amount, shift, tint, opacity in (
            (2.0, -30.0, (0.95, 0.45, 0.1), 0.3),
            (1.5, -15.0, (0.95, 0.45, 0.1), 0.5),
            (0.0, 30.0, (0.1, 0.5, 0.95), 0.4),
        )
    )
    scene = Scene(background=PAPER, meshes=(easel.pose(mesh, bent(rest)),), ghosts=ghosts)
    check_golden("onion_skins", easel.frame(VIEW, scene))


def test_outline_cage_and_handles(easel, check_golden):
    mesh, rest = blob_mesh(easel)
    angles = np.linspace(0, 2 * np.pi, 14, endpoint=False)
    outline = 60 + 45j + 56 * np.cos(angles) + 41j * np.sin(angles)
    cage = 60 + 45j + 62 * np.cos(angles) + 47j * np.sin(angles)
    lines, discs = mark_handles(
        [
            HandleMark(place=20 + 45j),
            HandleMark(place=45 + 60j, hovered=True),
            HandleMark(place=60 + 30j, selected=True),
            HandleMark(place=85 + 70j, anchor=True),
            HandleMark(place=90 + 25j, target=118 + 12j, selected=True),
        ]
    )
    scene = Scene(
        background=PAPER,
        meshes=(easel.pose(mesh, rest),),
        lines=(
            Line(points=outline, colour=(0.0, 0.47, 0.84, 1.0), closed=True),
            Line(points=cage, colour=(0.92, 0.37, 0.16, 0.6), width=3.0, closed=True),
            *lines,
        ),
        discs=discs,
    )
    check_golden("overlay", easel.frame(VIEW, scene))


def test_an_edge_of_the_wireframe_has_its_width_within_and_on_the_border(easel):
    corners = np.array([0, 40, 40 + 40j, 40j])
    turned = (corners - 20 - 20j) * np.exp(0.3j)
    wireframe = Wireframe(colour=(1.0, 1.0, 1.0, 0.5), width=3.0)
    transparent = easel.mesh(
        np.zeros((40, 40, 4), np.uint8), corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    )
    scene = Scene(meshes=(easel.pose(transparent, turned),), wireframe=wireframe)
    alpha = easel.frame(View(centre=0j, scale=2.0, size=(160, 160)), scene)[..., 3]
    assert alpha.max() == 128
    lengths = 4 * 80 + np.sqrt(2) * 80
    assert_allclose(alpha.sum() / 128, 3 * lengths, rtol=0.04)  # lines meet without their corners
    # Along the lower border, from just past one corner to the next.
    ends = to_float32_points(turned[[0, 1]] * 2).astype(float)
    places = ends[0] + np.linspace(0.1, 0.9, 200)[:, None] * (ends[1] - ends[0])
    outside = places + 0.7 * np.array([np.sin(0.3), -np.cos(0.3)])
    columns, rows = (80 + outside[:, 0]).astype(int), (80 - outside[:, 1]).astype(int)
    assert alpha[rows, columns].min() > 60


def test_an_overlay_at_twice_the_scale_has_twice_the_pixels(easel):
    marks = [HandleMark(place=0j, target=20 + 5j, anchor=True, selected=True)]
    frames = []
    for scale in (1, 2):
        view = View(centre=5j, scale=2.0 * scale, size=(160 * scale, 80 * scale))
        lines, discs = mark_handles(marks, scale=scale)
        scene = Scene(background=Backdrop(colour=(1, 1, 1, 1)), lines=lines, discs=discs)
        frames.append(easel.frame(view, scene).astype(float))
    halved = frames[1].reshape(80, 2, 160, 2, 4).mean(axis=(1, 3))
    assert np.abs(halved - frames[0]).mean() < 2
    assert (frames[0] < 250).any()


def test_the_border_has_the_mesh_on_its_left():
    triangles = np.array([[0, 1, 2], [0, 2, 3], [3, 2, 4]], np.int32)
    wanted = {(0, 1), (1, 2), (2, 4), (4, 3), (3, 0)}
    assert {tuple(edge) for edge in border_edges(triangles).tolist()} == wanted


def test_later_triangles_lie_on_top(easel):
    picture = np.zeros((20, 20, 4), np.uint8)
    picture[:, :10] = 255, 0, 0, 255
    picture[:, 10:] = 0, 0, 255, 128
    halves = np.array([0, 10, 10 + 20j, 20j, 10, 20, 20 + 20j, 10 + 20j]).astype(complex)
    quads = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]], np.int32)
    folded = halves.copy()
    folded[4:] -= 10  # the right half over the left one
    view = canvas_view((20, 20))
    pose = easel.pose(easel.mesh(picture, halves, quads), folded)
    later = easel.frame(view, Scene(meshes=(pose,)))
    assert_allclose(later[10, 5], [127, 0, 128, 255], rtol=0, atol=1)
    # What is drawn carries its own order, whatever that of the mesh.
    pose.paint_in_order(quads[::-1].copy())
    earlier = easel.frame(view, Scene(meshes=(pose,)))
    assert_array_equal(earlier[10, 5], [255, 0, 0, 255])
    pose.paint_in_order(quads)
    assert_array_equal(easel.frame(view, Scene(meshes=(pose,))), later)
    pose.paint_in_order(quads[:2])
    assert_array_equal(easel.frame(view, Scene(meshes=(pose,)))[10, 5], [255, 0, 0, 255])
    with pytest.raises(LissomError, match="at most 4 visible triangles, not 5"):
        pose.paint_in_order(quads[[0, 1, 2, 3, 0]])


def test_later_meshes_lie_on_top_of_a_scene_and_of_a_ghost(easel):
    corners = np.array([0, 20, 20 + 20j, 20j])
    quad = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    red, blue = (
        easel.pose(easel.mesh(np.full((20, 20, 4), colour, np.uint8), corners, quad), corners)
        for colour in ((255, 0, 0, 255), (0, 0, 255, 128))
    )
    view = canvas_view((20, 20))
    for meshes, wanted in (((red, blue), [127, 0, 128, 255]), ((blue, red), [255, 0, 0, 255])):
        frame = easel.frame(view, Scene(meshes=meshes))
        assert_allclose(frame[10, 5], wanted, rtol=0, atol=1)
    ghost = Ghost(meshes=(red, blue), tint=(1.0, 1.0, 1.0), opacity=0.5)
    frame = easel.frame(view, Scene(ghosts=(ghost,)))
    assert_array_equal(np.unique(frame[..., 3]), [128])


@pytest.mark.parametrize("over", [0, 1, 2])
def test_ghosts_cover_the_given_number_of_meshes(easel, over):
    """A red ghost that half covers is behind both, between a wall and the drawing, or in front."""
    corners = np.array([0, 20, 20 + 20j, 20j])
    quad = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    blue = np.full((20, 20, 4), (0, 0, 255, 255), np.uint8)
    wall, drawing, other = (easel.pose(easel.mesh(blue, corners, quad), corners) for _ in range(3))
    drawing.place(1, 10)
    ghost = Ghost(meshes=(other,), tint=(1.0, 0.0, 0.0), opacity=0.5)
    scene = Scene(meshes=(wall, drawing), ghosts=(ghost,), ghosts_over=over)
    frame = easel.frame(canvas_view((20, 20)), scene)
    # Left of the drawing there is the wall alone, right of that the drawing.
    is_over = {"wall": over > 0, "drawing": over > 1}
    for column, name in ((4, "wall"), (15, "drawing")):
        red, _, blue = frame[10, column, :3]
        assert (red > 60) == (blue < 200) == is_over[name], name
        assert blue > 60, name


def test_limbs_of_a_ghost_do_not_shine_through_each_other(easel):
    picture = np.full((20, 20, 4), 255, np.uint8)
    rest, triangles = grid_mesh(20, 20, 2, margin=0.0)
    mesh = easel.mesh(picture, rest, triangles)
    folded = 2 * np.abs(rest.real - 10) + 1j * rest.imag
    ghost = Ghost(meshes=(easel.pose(mesh, folded),), tint=(1.0, 0.0, 0.0), opacity=0.5)
    frame = easel.frame(canvas_view((20, 20)), Scene(ghosts=(ghost,)))
    assert_array_equal(np.unique(frame[5:-5, 5:-5, 3]), [128])


@pytest.mark.parametrize("closed", [False, True])
def test_a_translucent_line_is_inked_once(easel, closed):
    rng = np.random.default_rng(8)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 9))
    points = rng.uniform(35, 60, 9) * np.exp(1j * angles)
    line = Line(points=points, colour=(0.0, 0.0, 0.0, 0.5), width=6.0, closed=closed)
    frame = easel.frame(View(centre=0j, scale=1.0, size=(160, 160)), Scene(lines=(line,)))
    assert frame[..., 3].max() == 128
    ends = np.append(points, points[0]) if closed else points
    along = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(ends)])
    pixels = (along.conj() + 80 + 80j).view(float).reshape(-1, 2).astype(int)
    assert frame[pixels[:, 1], pixels[:, 0], 3].min() >= 127


def test_dashes_are_as_long_as_their_gaps(easel):
    line = Line(points=np.array([10.0, 90.0]) + 0j, colour=(0, 0, 0, 1), width=4.0, dash=8.0)
    frame = easel.frame(View(centre=50 + 0j, scale=1.0, size=(100, 20)), Scene(lines=(line,)))
    inked = frame[10, 12:88, 3] > 127
    lengths = np.diff(np.flatnonzero(np.diff(inked.astype(int))))
    assert_array_equal(lengths, 8)


def test_dashes_run_on_over_the_points_of_a_line(easel):
    view = View(centre=50 + 0j, scale=1.0, size=(100, 20))
    frames = [
        easel.frame(view, Scene(lines=(Line(points=points + 0j, colour=(0, 0, 0, 1), dash=6.0),)))
        for points in (np.array([5.0, 95.0]), np.array([5.0, 9.0, 31.0, 60.0, 62.0, 95.0]))
    ]
    assert_allclose(frames[1].astype(int), frames[0].astype(int), rtol=0, atol=1)


def test_a_disc_has_its_radius_whatever_the_zoom(easel):
    for scale in (0.1, 1.0, 40.0):
        view = View(centre=3 + 4j, scale=scale, size=(60, 60))
        disc = Disc(centre=3 + 4j, radius=20.0, fill=(1, 1, 1, 1), rim=(1, 0, 0, 1), rim_width=5.0)
        frame = easel.frame(view, Scene(discs=(disc,)))
        assert_allclose(frame[..., 3].sum() / 255, np.pi * 20**2, rtol=5e-3)
        assert_array_equal(frame[30, 30], [255, 255, 255, 255])
        assert_array_equal(frame[30, 12], [255, 0, 0, 255])


def test_the_drawings_border_has_no_steps(easel):
    picture = np.full((80, 80, 4), 255, np.uint8)
    rest, triangles = grid_mesh(80, 80, 4)
    turned = (rest - 40 - 40j) * np.exp(0.1j) + 40 + 40j
    pose = easel.pose(easel.mesh(picture, rest, triangles), turned)
    alpha = easel.frame(View(centre=40 + 40j, scale=1.0, size=(120, 120)), Scene(meshes=(pose,)))[
        ..., 3
    ]
    # Along a slanted border the columns' sums change evenly, not by whole pixels.
    heights = alpha[:, 30:90].sum(axis=0) / 255
    assert np.abs(np.diff(heights, n=2)).max() < 0.25
    assert_allclose(alpha.sum() / 255, 80 * 80, rtol=1e-3)


def test_oversampling_comes_nearer_to_the_mean_of_what_a_pixel_shows(easel):
    rng = np.random.default_rng(4)
    picture = np.full((240, 240, 4), 255, np.uint8)
    picture[..., :3] = np.kron(rng.integers(0, 256, (60, 60, 3)), np.ones((4, 4, 1)))
    rest, triangles = grid_mesh(240, 240, 5)
    scene = Scene(meshes=(easel.pose(easel.mesh(picture, rest, triangles), rest),))
    view = fit_view(0j, 240 + 240j, (48, 48))
    wanted = picture[..., :3].reshape(48, 5, 48, 5, 3).mean(axis=(1, 3))
    errors = [
        np.abs(easel.frame(view, scene, oversampling=n)[..., :3] - wanted).mean() for n in (1, 2)
    ]
    assert errors[1] < 0.7 * errors[0]
    paper = Scene(background=PAPER)
    assert_allclose(
        easel.frame(VIEW, paper, oversampling=2).astype(int),
        easel.frame(VIEW, paper).astype(int),
        rtol=0,
        atol=12,  # a square's side lies within a pixel
    )


def test_what_cannot_be_drawn_is_refused(easel):
    gl, programs = easel.gl, easel.renderer.programs
    with pytest.raises(LissomError, match=r"frame of 100000 × 10 pixels is too large"):
        RenderTarget(programs, (100_000, 10))
    with pytest.raises(LissomError, match=r"picture has 100000 × 1 pixels"):
        GpuPicture(gl, np.zeros((1, 100_000, 4), np.uint8))
    mesh, rest = blob_mesh(easel, 2)
    source = PositionBuffer(gl, len(rest))
    pose = PosedMesh(mesh, source)
    with pytest.raises(LissomError, match="not finite"):
        source.write(np.full((len(rest), 2), np.nan, np.float32))
    with pytest.raises(LissomError, match=r"\(9, 2\) positions, not \(8, 2\)"):
        source.write(np.zeros((8, 2), np.float32))
    with pytest.raises(LissomError, match="9 values, not"):
        pose.write_heat(np.zeros(8, np.float32))
    with pytest.raises(ValueError, match="given no values"):
        easel.frame(VIEW, Scene(meshes=(pose,), heat=Heat(low=0.0, high=1.0)))
    pose.release()
    target = RenderTarget(programs, (10, 10))
    with pytest.raises(ValueError, match="cannot fill a frame"):
        easel.renderer.draw(target, VIEW, Scene())
    target.release()


def test_pictures_for_the_screen_have_colours_times_alpha(gl):
    straight = np.random.default_rng(0).integers(0, 256, (40, 60, 4)).astype(np.uint8)
    straight[:10, :, 3], straight[10:20, :, 3] = 0, 255
    picture = GpuPicture(gl, straight, is_for_screen=True)
    shown = np.frombuffer(picture._texture.read(), np.uint8).reshape(straight.shape)[::-1]
    alpha = straight[..., 3:] / 255
    expected = np.dstack([np.rint(straight[..., :3] * alpha), straight[..., 3]])
    assert_array_equal(shown, expected)
    picture.release()

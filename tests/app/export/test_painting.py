"""Frames of documents, drawn in both kinds of contexts."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import moderngl
import numpy as np
import pytest
from animations import BLOB, PARTED, Posed, Sliding, evaluator_of, still_document
from documents import altered
from numpy.testing import assert_array_equal

from app.document import CAMERA, OPACITY, Camera, FrameRange, Key
from app.document.model import Document
from app.errors import LissomError
from app.export.frame_renderer import FrameRenderer
from app.export.plan import ExportPlan, plan_export
from app.export.request import ExportRequest
from engine.arrays import Bytes, Complexes

SEEN = BLOB[..., 3] >= 8


@pytest.fixture(scope="module")
def document() -> Document:
    return still_document()


def plan_of(document: Document, poses: Posed, **settings: object) -> ExportPlan:
    settings_ = replace(document.export, **({"framing": "canvas"} | settings))
    return plan_export(
        document,
        ExportRequest(out=Path("out"), settings=settings_, project="walk"),
        evaluator_of(poses),
    )


@contextmanager
def drawing(
    gl: moderngl.Context, document: Document, poses: Posed, **settings: object
) -> Iterator[Callable[[float], Bytes]]:
    painter = FrameRenderer(
        gl, document, {0: BLOB}, evaluator_of(poses), plan_of(document, poses, **settings)
    )
    yield lambda frame: painter.draw(painter.pose(frame))
    painter.release()


def notices(gl: moderngl.Context, document: Document, poses: Posed, **settings: object):
    painter = FrameRenderer(
        gl, document, {0: BLOB}, evaluator_of(poses), plan_of(document, poses, **settings)
    )
    for frame in range(11):
        painter.pose(frame)
    painter.release()
    return painter.notices


def test_a_motion_that_leaves_the_frame_is_reported_once_it_is_posed(gl, document):
    assert notices(gl, document, Sliding(document, 0), framing="canvas") == ()
    assert notices(gl, document, Sliding(document, 12), framing="fit") == ()
    (notice,) = notices(gl, document, Sliding(document, 12), framing="canvas")
    assert "leaves the frame" in notice


def test_a_drawing_that_fills_its_canvas_does_not_leave_it(gl):
    full = still_document(np.full((600, 800, 4), 255, dtype=np.uint8))
    assert full.layers[0].domain.mesh.vertices.real.min() < -2
    assert notices(gl, full, Sliding(full, 0), framing="canvas") == ()


def still(gl: moderngl.Context, document: Document, **settings: object) -> Bytes:
    with drawing(gl, document, Sliding(document, 0), **settings) as draw:
        return draw(0.0)


def test_the_drawing_at_rest_is_the_picture_and_nothing_hidden(gl, document):
    frame = still(gl, document)
    assert frame.shape == BLOB.shape
    assert_array_equal(frame[SEEN], BLOB[SEEN])
    assert not frame[BLOB[..., 3] == 0].any()


@pytest.mark.parametrize("triangles", [1_000, 40_000])
def test_a_slit_is_not_seen_as_long_as_its_sides_lie_together(gl, triangles):
    document = still_document(triangles=triangles, cut_out=PARTED)
    domain = document.layers[0].domain
    assert not domain.contains(np.array([60.5 + 25j])).any()
    assert_array_equal(still(gl, document)[SEEN], BLOB[SEEN])
    with drawing(gl, document, Sliding(document, 3)) as draw:
        moved = draw(1.0)
    assert_array_equal(moved[:, 3:][SEEN[:, :-3]], BLOB[:, :-3][SEEN[:, :-3]])
    # Without its seam it is.
    naked = altered(document, domain=replace(domain, closed=None))
    assert (still(gl, naked)[SEEN] != BLOB[SEEN]).any()


@pytest.mark.parametrize("covered", ["left", "right"])
def test_an_underlay_is_hidden_as_long_as_a_slit_is_closed(gl, covered):
    lines = tuple(replace(line, covered=covered) for line in PARTED.cut_lines)
    document = still_document(cut_out=replace(PARTED, cut_lines=lines))
    assert document.layers[0].cut_out.covered_lines(0j)
    opaque = SEEN & (BLOB[..., 3] == 255)
    assert_array_equal(still(gl, document)[opaque], BLOB[opaque])


def test_whole_pixels_of_motion_move_whole_pixels(gl, document):
    with drawing(gl, document, Sliding(document, 3 - 2j)) as draw:
        frames = [draw(float(time)) for time in (0, 1, 2, 0)]
    moved = np.roll(BLOB, (4, 6), axis=(0, 1))
    seen = np.roll(SEEN, (4, 6), axis=(0, 1))
    assert_array_equal(frames[2][seen], moved[seen])
    assert_array_equal(frames[0], frames[3])


def test_a_fitted_frame_holds_the_same_pixels(gl, document):
    poses = Sliding(document, 0)
    view = plan_of(document, poses, framing="fit").view
    frame = still(gl, document, framing="fit")
    assert frame.shape[:2] == view.size[::-1]
    (corner,) = view.to_pixels(np.array([complex(0, BLOB.shape[0])])).round()
    whole = np.zeros((400, 400, 4), dtype=np.uint8)
    top, left = 100 - int(corner.imag), 100 - int(corner.real)
    whole[top : top + frame.shape[0], left : left + frame.shape[1]] = frame
    again = whole[100 : 100 + BLOB.shape[0], 100 : 100 + BLOB.shape[1]]
    assert_array_equal(again[SEEN], BLOB[SEEN])


def test_a_background_is_opaque_and_shines_through_soft_edges(gl, document):
    frame = still(gl, document, background="#20c040")
    assert frame[..., 3].min() == 255
    assert (frame[BLOB[..., 3] == 0, :3] == (0x20, 0xC0, 0x40)).all()
    alpha = BLOB[..., 3:] / 255
    blend = BLOB[..., :3] * alpha + np.array((0x20, 0xC0, 0x40)) * (1 - alpha)
    assert np.abs(frame[..., :3] - blend)[SEEN].max() <= 1


def test_where_the_drawing_is_not_the_frame_has_its_background(gl, document):
    with drawing(gl, document, Sliding(document, 5000), background="#0a14fa") as draw:
        assert_array_equal(np.unique(draw(10).reshape(-1, 4), axis=0), [[10, 20, 250, 255]])
    with drawing(gl, document, Sliding(document, 5000)) as draw:
        assert not draw(10).any()


def test_a_smaller_frame_is_the_picture_made_smaller(gl, document):
    frame = still(gl, document, size=(40, 30))
    blocks = BLOB.reshape(30, 3, 40, 3, 4) / 255
    alpha = blocks[..., 3].mean(axis=(1, 3))
    assert np.abs(frame[..., 3] / 255 - alpha).max() < 0.06
    premultiplied = (blocks[..., :3] * blocks[..., 3:]).mean(axis=(1, 3))
    shown = frame[..., :3] / 255 * frame[..., 3:] / 255
    assert np.abs(shown - premultiplied).max() < 0.06


def test_a_larger_canvas_centres_the_picture(gl, document):
    frame = still(gl, document, size=(140, 90))
    assert_array_equal(frame[:, 10:130][SEEN], BLOB[SEEN])
    assert not frame[:, :10].any()


class Folding(Posed):
    """The left side of a drawing bends, the more in later frames, until it lies over the right."""

    def __init__(self, document: Document) -> None:
        rest = document.layers[0].domain.mesh.vertices
        left = np.minimum(rest.real - 60, 0)
        super().__init__(document, lambda frame: rest + frame / 48 * left**2 / 60)


def test_fewer_triangles_draw_the_same(gl, monkeypatch):
    """Where one part lies over another, too."""
    document = still_document(triangles=8_000)
    poses = Folding(document)
    painters = []
    for many in (24, 1_000_000):
        monkeypatch.setattr("app.export.frame_renderer._MANY", many)
        painters.append(
            FrameRenderer(gl, document, {0: BLOB}, evaluator_of(poses), plan_of(document, poses))
        )
    for frame in (0.0, 13.0, 48.0):
        posed = [painter.pose(frame) for painter in painters]
        fewer, whole = (len(each.vertices[0].triangles) for each in posed)
        assert fewer < 0.7 * whole
        pixels = [p.draw(each) for p, each in zip(painters, posed, strict=True)]
        colours, others = (each[..., :3] * (each[..., 3:] / 255) for each in pixels)
        assert np.abs(colours - others).max() <= 5
        assert np.abs(pixels[0][..., 3].astype(int) - pixels[1][..., 3]).max() <= 5
    for painter in painters:
        painter.release()


def test_a_frame_that_fails_is_an_error_that_names_it(gl, document):
    def failing(frame: float) -> Complexes:
        places = document.layers[0].domain.mesh.vertices.copy()
        if frame == 2:
            places[0] = complex("inf")
        if frame == 3:
            gl.enable_direct(0xFFFF)  # no such switch: OpenGL notes an error
        return places

    with drawing(gl, document, Posed(document, failing)) as draw:
        draw(1.0)
        with pytest.raises(LissomError, match=r"frame 2 cannot be drawn.*not finite"):
            draw(2.0)
        with pytest.raises(LissomError, match="frame 3 cannot be drawn: OpenGL"):
            draw(3.0)
        assert_array_equal(draw(4.0), draw(1.0))


def test_errors_of_others_are_not_the_exports(gl, document):
    gl.enable_direct(0xFFFF)
    assert_array_equal(still(gl, document)[SEEN], BLOB[SEEN])


def test_frames_too_large_for_the_machine_are_refused(gl, document):
    with pytest.raises(LissomError, match="too large"):
        still(gl, document, size=(65_535, 9_999))


def test_a_frame_is_drawn_in_parts_that_the_machine_holds(gl, document, monkeypatch):
    whole = still(gl, document, size=(150, 111))
    monkeypatch.setattr("app.export.frame_renderer._TILE", 64)
    parts = still(gl, document, size=(150, 111))
    assert np.abs(parts.astype(int) - whole).max() <= 2
    monkeypatch.setattr("app.export.frame_renderer.largest_size", lambda _: 32)
    assert np.abs(still(gl, document, size=(150, 111)).astype(int) - whole).max() <= 2


def with_camera(document: Document, *keys: Key[Camera]) -> Document:
    return replace(document, camera=keys, frames=FrameRange(0, 12))


def test_the_camera_at_twice_the_size_shows_a_part_of_a_frame_twice_as_large(gl, document):
    height, width = BLOB.shape[:2]
    centre = complex(width / 2 - 10, height / 2 + 5)
    frame = still(gl, with_camera(document, CAMERA.key(0, Camera(centre, zoom=2.0))))
    assert frame.shape == BLOB.shape
    large = still(gl, document, size=(2 * width, 2 * height)).astype(int)
    left, top = round(2 * centre.real - width / 2), round(1.5 * height - 2 * centre.imag)
    assert np.abs(frame - large[top : top + height, left : left + width]).max() <= 1


def test_the_camera_turns_what_is_seen_counter_clockwise(gl, document):
    height, width = BLOB.shape[:2]
    key = CAMERA.key(0, Camera(complex(width, height) / 2, turn=np.pi / 2))
    frame = still(gl, with_camera(document, key), background="#20c040")
    upright = still(gl, document, background="#20c040").astype(int)
    left = (width - height) // 2
    turned = np.rot90(upright)[left : left + height]
    assert np.abs(frame[:, left : left + height] - turned).max() <= 1
    assert (frame[:, : left - 1] == (0x20, 0xC0, 0x40, 255)).all()


def test_a_view_that_is_turned_shows_what_a_turned_camera_does(gl, document):
    height, width = BLOB.shape[:2]
    key = CAMERA.key(0, Camera(complex(width, height) / 2, turn=0.3))
    poses = Sliding(document, 0)
    plan = plan_of(document, poses)
    view = replace(plan.view, turn=complex(np.exp(0.3j)))
    painter = FrameRenderer(gl, document, {0: BLOB}, evaluator_of(poses), replace(plan, view=view))
    frame = painter.draw(painter.pose(0.0)).astype(int)
    painter.release()
    assert np.abs(frame - still(gl, with_camera(document, key))).max() <= 2


def test_each_frame_is_what_the_camera_shows_then(gl, document):
    first, last = CAMERA.key(0, Camera(60 + 45j)), CAMERA.key(12, Camera(48 + 51j))
    panned = with_camera(document, first, last)
    with drawing(gl, panned, Sliding(document, 0)) as draw:
        halfway, end = draw(6.0), draw(12.0)
    assert_array_equal(halfway[3:, 6:][SEEN[:-3, :-6]], BLOB[:-3, :-6][SEEN[:-3, :-6]])
    assert_array_equal(end[6:, 12:][SEEN[:-6, :-12]], BLOB[:-6, :-12][SEEN[:-6, :-12]])


def test_with_a_camera_every_framing_is_its_frame(gl, document):
    away = with_camera(document, CAMERA.key(0, Camera(500 + 45j, zoom=0.5)))
    away = replace(away, size=(64, 48))
    for framing in ("fit", "canvas"):
        assert plan_of(away, Sliding(away, 12), framing=framing).view.size == (64, 48)
        assert notices(gl, away, Sliding(away, 12), framing=framing) == ()
    assert not still(gl, away, framing="fit").any()


def test_a_fade_is_drawn(gl, document):
    keys = (OPACITY.key(0, 1.0), OPACITY.key(10, 0.0))
    faded = altered(document, channels={(OPACITY.name, None): keys}, frames=FrameRange(0, 12))
    with drawing(gl, faded, Sliding(document, 0)) as draw:
        alpha = draw(5.0)[..., 3]
        assert not draw(10.0).any()
    assert np.abs(alpha - BLOB[..., 3] / 2)[SEEN].max() <= 1

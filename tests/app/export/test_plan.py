from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from animations import BLOB, Posed, Sliding, evaluator_of, still_document
from messages import says
from numpy.testing import assert_allclose

from app.document.model import Document
from app.document.settings import ExportSettings, FrameRange, Marker
from app.errors import LissomError
from app.export.destination import FRAMES_TO_FILE, NAMED_LIKE_FILE
from app.export.plan import ExportPlan, FrameTag, plan_export
from app.export.request import ExportRequest, check_request
from app.storage import NO_FOLDER

SIZE = (BLOB.shape[1], BLOB.shape[0])


@pytest.fixture(scope="module")
def document() -> Document:
    return replace(still_document(), frames=FrameRange(0, 10))


def plan_of(
    document: Document,
    out: Path,
    poses: Sliding | None = None,
    *,
    fps: float | None = None,
    **settings: object,
) -> ExportPlan:
    request = ExportRequest(
        out=out, settings=replace(document.export, **settings), project="walk", fps=fps
    )
    check_request(document, request)
    return plan_export(document, request, evaluator_of(poses or Sliding(document, 0)))


def test_by_default_the_frames_show_all_of_the_motion(document, tmp_path):
    poses = Sliding(document, 12)
    plan = plan_of(document, tmp_path / "frames", poses)
    assert plan.view == plan_of(document, tmp_path / "frames", poses, framing="fit").view
    pixels = plan.view.to_pixels(np.concatenate([poses.positions(time) for time in plan.times]))
    assert 0 < pixels.real.min() < pixels.real.max() < plan.view.size[0]


def test_frames_of_a_part_are_framed_as_those_of_the_whole(document, tmp_path):
    poses = Sliding(document, 12)
    whole = plan_of(document, tmp_path / "frames", poses).view
    assert plan_of(document, tmp_path / "frames", poses, frames=FrameRange(3, 3)).view == whole
    assert plan_of(document, tmp_path / "frames", poses, fps=10.0).view == whole
    beyond = replace(document, preview=FrameRange(2, 4))
    assert plan_of(beyond, tmp_path / "frames", poses, frames=FrameRange(0, 10)).view == whole


def test_frames_may_show_the_pictures_own_canvas(document, tmp_path):
    plan = plan_of(document, tmp_path / "frames", framing="canvas")
    assert plan.view.size == SIZE
    assert plan.view.scale == 1
    assert plan.view.centre == complex(*SIZE) / 2
    assert plan.times == tuple(range(11))
    assert (plan.first, plan.fps, plan.background, plan.notices) == (0, 24.0, None, ())
    assert plan.names[7] == "frame_0007.png"


def test_a_loop_leaves_out_its_last_frame_unless_it_is_asked_for(document, tmp_path):
    loop = replace(document, loop=True)
    assert plan_of(loop, tmp_path / "frames").times[-1] == 9
    assert plan_of(loop, tmp_path / "frames").loop
    asked = plan_of(loop, tmp_path / "frames", frames=FrameRange(8, 10))
    assert asked.times == (8, 9, 10)


def test_frames_repeat_and_play_slower_or_faster(document, tmp_path):
    document = replace(document, markers=(Marker(frame=2, name="hop"),))
    frames = FrameRange(0, 4)
    plan = plan_of(document, tmp_path / "a.gif", format="gif", frames=frames, repeat=3)
    assert plan.times == (*range(5),) * 3
    assert plan.tags == (FrameTag("hop", 2, 4),)
    slow = plan_of(document, tmp_path / "a.gif", format="gif", frames=frames, speed=0.5, repeat=2)
    assert slow.times == (0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4) * 2
    assert (slow.fps, slow.timeline_fps, slow.passes) == (24, 12, 2)
    fast = plan_of(document, tmp_path / "a.gif", format="gif", frames=frames, speed=2.0)
    assert fast.times == (0, 2, 4)
    # A still picture and a model have no repeats; a model has a speed.
    still = plan_of(document, tmp_path / "a.png", format="picture", repeat=3, speed=0.5)
    assert still.times == (0,)
    model = plan_of(document, tmp_path / "a.glb", format="glb", repeat=3, speed=0.5)
    assert (model.passes, model.timeline_fps, model.span) == (1, 12, (0, 10))
    for changes in ({"repeat": 0}, {"repeat": 101}, {"speed": 0.01}, {"speed": float("nan")}):
        with pytest.raises(LissomError):
            plan_of(document, tmp_path / "a.gif", format="gif", **changes)


def test_the_size_of_a_plan_has_the_pixels_that_a_format_adds(document, tmp_path):
    odd = replace(document, size=(37, 21))
    plan = plan_of(odd, tmp_path / "a.mp4", format="mp4", framing="canvas", background="#ffffff")
    assert (plan.view.size, plan.size) == ((37, 21), (38, 22))


def test_another_rate_numbers_its_pictures_on_from_the_first_frame(document, tmp_path):
    plan = plan_of(document, tmp_path / "frames", fps=16.0, frames=FrameRange(4, 10))
    assert plan.times == (4, 5.5, 7, 8.5, 10)
    assert plan.fps == 16
    assert [plan.names[index] for index in (0, 4)] == ["frame_0004.png", "frame_0008.png"]


@pytest.mark.parametrize(("last", "name"), [(9999, "frame_0001.png"), (10_000, "frame_00001.png")])
def test_all_names_have_as_many_digits_as_the_longest_needs(document, tmp_path, last, name):
    plan = replace(plan_of(document, tmp_path / "frames"), first=1, times=(0.0,) * last)
    assert plan.names[0] == name
    assert plan.names[last - 1] == f"frame_{last}.png"


def test_fitted_frames_show_all_of_the_motion_on_the_pictures_own_pixels(document, tmp_path):
    poses = Sliding(document, 12.3 - 4.1j)
    plan = plan_of(document, tmp_path / "frames", poses, framing="fit")
    view = plan.view
    assert view.scale == 1
    assert all(side % 2 == 0 for side in view.size)
    corner = view.to_pixels(np.array([0j]))
    assert_allclose(corner, np.rint(corner), rtol=0, atol=1e-9)
    pixels = view.to_pixels(np.concatenate([poses.positions(time) for time in plan.times]))
    for extent, side in ((pixels.real, view.size[0]), (pixels.imag, view.size[1])):
        assert extent.min() > 1
        assert extent.max() < side - 1
        assert extent.min() + side - extent.max() < 0.06 * max(view.size) + 3
    assert plan.notices == ()


def test_fitted_frames_of_a_given_size_show_all_of_the_motion_as_large_as_possible(
    document, tmp_path
):
    poses = Sliding(document, 12.3 - 4.1j)
    plan = plan_of(document, tmp_path / "frames", poses, framing="fit", size=(50, 301))
    pixels = plan.view.to_pixels(np.concatenate([poses.positions(time) for time in plan.times]))
    assert plan.view.size == (50, 301)
    assert 0.9 * 50 < np.ptp(pixels.real) < 50
    assert 0 < pixels.real.min() < pixels.real.max() < 50


def test_the_framing_of_the_canvas_looks_at_no_frame(document, tmp_path):
    class Unseen(Sliding):
        def positions(self, frame: float):
            raise AssertionError(f"looked at frame {frame}")

    plan_of(document, tmp_path / "frames", Unseen(document, 0), framing="canvas")


def test_frames_of_another_export_are_reported_and_kept(document, tmp_path):
    for name in ("frame_0009.png", "frame_0011.png", "frame_00003.png", "frame_12.png", "other"):
        (tmp_path / name).write_bytes(b"kept")
    (notice,) = plan_of(document, tmp_path).notices
    assert "2 frames of another export (frame_00003.png … frame_0011.png)" in notice
    assert len(list(tmp_path.iterdir())) == 5


def test_backgrounds_are_colours_or_none(document, tmp_path):
    assert plan_of(document, tmp_path / "f", background="#0aF080").background == (10, 240, 128)


def test_a_pose_that_is_not_finite_is_refused_before_anything_is_written(document, tmp_path):
    def broken(frame: float):
        places = document.layers[0].domain.mesh.vertices.copy()
        if frame == 3:
            places[5] = complex("nan")
        return places

    with pytest.raises(LissomError, match="frame 3 cannot be drawn"):
        plan_of(document, tmp_path / "frames", Posed(document, broken), framing="fit")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("out", "settings", "reason"),
    [
        ("file", {}, says(FRAMES_TO_FILE)),
        ("missing/frames", {}, NO_FOLDER.format(folder=".*missing")),
        ("frames.gif", {}, says(NAMED_LIKE_FILE)),
        ("still.png", {}, says(NAMED_LIKE_FILE)),
        ("folder", {"format": "gif"}, "is a folder; name a file"),
        ("missing/a.gif", {"format": "gif"}, NO_FOLDER.format(folder=".*missing")),
        ("a.png", {"format": "gif"}, "use the ending .gif"),
        ("a.gif", {"format": "apng"}, "use the ending .apng, .png"),
        ("a.mp4", {"format": "mp4"}, "background colour"),
        ("frames", {"frames": FrameRange(0, 11)}, "0 to 10"),
        ("frames", {"frames": FrameRange(12, 13)}, "0 to 10"),
    ],
)
def test_what_cannot_work_is_refused(document, tmp_path, out, settings, reason):
    (tmp_path / "file").write_bytes(b"")
    (tmp_path / "folder").mkdir()
    with pytest.raises(LissomError, match=reason):
        plan_of(document, tmp_path / out, **settings)


@pytest.mark.parametrize("fps", [0.0, -1.0, float("nan"), float("inf"), 1e9])
def test_impossible_rates_are_refused(document, tmp_path, fps):
    with pytest.raises(LissomError, match="frames per second"):
        plan_of(document, tmp_path / "frames", fps=fps)


def test_rates_and_sizes_that_a_format_cannot_hold_are_refused(document, tmp_path):
    with pytest.raises(LissomError, match="50 frames a second"):
        plan_of(document, tmp_path / "a.gif", format="gif", fps=60.0)
    with pytest.raises(LissomError, match=r"16,383 pixels each way.*smaller size"):
        plan_of(document, tmp_path / "a.webp", format="webp", size=(16_384, 4))
    wide = Sliding(document, 1700)
    with pytest.raises(LissomError, match="16,383 pixels"):
        plan_of(document, tmp_path / "a.webp", wide, format="webp")


def test_tags_go_from_marker_to_marker(document, tmp_path):
    sheet = {"format": "spritesheet"}
    assert plan_of(document, tmp_path / "a.png", **sheet).tags == (("walk", 0, 10),)
    marked = replace(
        document, markers=tuple(Marker(frame=n, name=name) for n, name in ((2, "a"), (6, "b")))
    )
    assert plan_of(marked, tmp_path / "a.png", **sheet).tags == (("a", 2, 5), ("b", 6, 10))
    some = plan_of(marked, tmp_path / "a.png", frames=FrameRange(7, 9), **sheet)
    assert some.tags == (("b", 0, 2),)
    assert plan_of(marked, tmp_path / "a.png", fps=12.0, **sheet).tags[1] == ("b", 3, 5)


def test_odd_sides_are_refused_where_they_are_asked_for_and_reported_where_they_came(
    document, tmp_path
):
    white = {"format": "mp4", "background": "#ffffff"}
    with pytest.raises(LissomError, match="choose 102 × 80"):
        plan_of(document, tmp_path / "a.mp4", size=(101, 80), **white)
    assert plan_of(document, tmp_path / "a.mp4", size=(102, 80), **white).notices == ()
    wide = replace(document, size=(121, 90))
    (notice,) = plan_of(wide, tmp_path / "a.mp4", framing="canvas", **white).notices
    assert "122 × 90" in notice
    assert plan_of(wide, tmp_path / "a.webm", framing="canvas", format="webm").notices == ()


def test_any_name_without_the_end_of_another_format_will_do(document, tmp_path):
    for name in ("name", "v1.2", "a.GIF"):
        assert plan_of(document, tmp_path / name, format="gif").out == tmp_path / name
    (tmp_path / "frames.gif").mkdir()
    assert plan_of(document, tmp_path / "frames.gif").format == "png"


def test_mp4_says_how_to_install_what_it_needs(document, tmp_path, monkeypatch):
    settings = {"format": "mp4", "background": "#ffffff"}
    assert plan_of(document, tmp_path / "a.mp4", **settings).background == (255, 255, 255)
    monkeypatch.setattr("app.errors.find_spec", lambda _: None)
    with pytest.raises(LissomError, match=r"library av, which is not installed: .*install"):
        plan_of(document, tmp_path / "a.mp4", **settings)


def test_the_documents_own_settings_are_what_is_not_given(document, tmp_path):
    own = ExportSettings(format="webp", size=(64, 48), background="#010203", framing="fit")
    plan = plan_of(replace(document, export=own), tmp_path / "a.webp")
    assert (plan.format, plan.view.size, plan.background) == ("webp", (64, 48), (1, 2, 3))


def test_a_frame_of_very_many_is_framed_with_few_of_them(document, tmp_path):
    seen = set()

    class Counted(Sliding):
        def positions(self, frame: float):
            seen.add(frame)
            return super().positions(frame)

    long, poses = replace(document, frames=FrameRange(0, 999_999)), Counted(document, 1e-3)
    view = plan_of(long, tmp_path / "frames", poses, framing="fit", frames=FrameRange(3, 3)).view
    assert len(seen) < 100
    for frame in (0, 3, 999_999):
        across = view.to_pixels(poses.positions(frame)).real
        assert 0 < across.min() < across.max() < view.size[0]

import io
import itertools
import struct
import subprocess
import sys
import threading
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from exports import FRAMES, at_once, draw, plan_for, run
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image, ImageSequence

from app.errors import LissomError
from app.export.run import MOST_QUEUED, export_frames
from app.export.writers import png, table
from app.export.writers.png import PngSequence
from app.export.writers.spritesheet import SpritesheetWriter, sheet_grid
from app.export.writers.table import DATA_WRITERS, FILE_WRITERS, FOLDER_WRITERS, SHAPE_WRITERS
from app.export_formats import EXPORT_FORMATS, FormatSettings, MeshOptions, SpriteSheetOptions
from app.render.view import canvas_view
from engine.arrays import Bytes
from engine.domain import MOST_TRIANGLES

DRAWN = [name for name, format_ in EXPORT_FORMATS.items() if format_.is_drawn]


def rgba_frames(path: Path) -> list[Bytes]:
    with Image.open(path) as image:
        return [np.asarray(frame.convert("RGBA")) for frame in ImageSequence.Iterator(image)]


def test_every_format_of_the_table_has_a_writer():
    files = {name for name, format_ in EXPORT_FORMATS.items() if format_.suffixes}
    assert SHAPE_WRITERS.keys() == EXPORT_FORMATS.keys() - DRAWN
    assert FILE_WRITERS.keys() | DATA_WRITERS.keys() == files - SHAPE_WRITERS.keys()
    assert FOLDER_WRITERS.keys() == EXPORT_FORMATS.keys() - files


def test_what_formats_ask_is_reported_once_and_has_room_for_what_is_usual():
    groups = FormatSettings().options()
    assert {format_.options for format_ in EXPORT_FORMATS.values()} == {"", *groups}
    options = [
        (name, each) for group in groups.values() for name, each in group.option_fields().items()
    ]
    assert len(dict(options)) == len({each.flag for _, each in options}) == len(options)
    # It stands there once more, so that nothing heavy is loaded for it.
    assert MeshOptions.option_fields()["triangles"].maximum == MOST_TRIANGLES
    for wrong in ({"padding": -1}, {"padding": 257}):
        with pytest.raises(LissomError, match="Padding must be 0 to 256, not"):
            SpriteSheetOptions(**wrong)
    with pytest.raises(LissomError, match="Triangles must be 100 to 2,000,000, not 99"):
        MeshOptions(triangles=99)
    with pytest.raises(LissomError, match="to 100, not nan"):
        MeshOptions(tolerance=float("nan"))


def test_video_is_loaded_only_when_it_is_asked_for():
    code = "import sys, app.export; sys.exit('av' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


def chunk_before_the_data(png: bytes, kind: bytes) -> bytes:
    head = png[: png.index(b"IDAT")]
    start = head.index(kind)
    (length,) = struct.unpack(">I", head[start - 4 : start])
    return head[start + 4 : start + 4 + length]


@pytest.mark.parametrize("format_", ["png", "apng", "spritesheet"])
def test_pngs_say_that_their_colours_are_those_of_srgb(tmp_path, format_):
    plan = plan_for(tmp_path / "out", format_)
    run(plan)
    path = plan.out / plan.names[0] if format_ == "png" else plan.out
    assert chunk_before_the_data(path.read_bytes(), b"sRGB") == b"\0"
    with Image.open(path) as image:
        assert image.info["srgb"] == 0


def test_the_thread_that_draws_never_waits_for_others_unless_it_may(tmp_path, monkeypatch):
    """Poses, encoding, the format's own work and its end go on while steps return at once."""
    may_go_on, threads = threading.Event(), set()

    def held(time: float) -> float:
        threads.add(threading.current_thread())
        may_go_on.wait()
        return time

    class Held(SpritesheetWriter):
        def encode(self, _frame: Bytes) -> float:
            return held(0)

        def add(self, encoded: float) -> None:
            held(encoded)

        def finish(self) -> None:
            held(0)

    monkeypatch.setattr(table, "DATA_WRITERS", {"spritesheet": Held})
    plan = plan_for(tmp_path / "out", "spritesheet")
    steps = export_frames(plan, held, draw, waits=False)
    stops = []
    for done in steps:
        # Where nothing more can be drawn, the others are let go on until something is.
        if stops and stops[-1] == done:
            may_go_on.set()
        else:
            may_go_on.clear()
            stops.append(done)
    assert stops == list(range(FRAMES + 1))
    assert threading.current_thread() not in threads


def test_png_frames_are_exact_and_numbered_from_the_first_ones_own_number(tmp_path):
    plan = plan_for(tmp_path / "frames", "png", first=9998, times=(9998.0, 9999.0, 10000.0))
    run(plan, lambda time: draw(time - 9998))
    names = ["frame_09998.png", "frame_09999.png", "frame_10000.png"]
    assert sorted(path.name for path in plan.out.iterdir()) == names
    for index, name in enumerate(names):
        assert_array_equal(rgba_frames(plan.out / name)[0], draw(index))
    run(plan_for(tmp_path / "frames", "png", first=12, times=(12.0,)))
    assert (plan.out / "frame_0012.png").is_file()


@pytest.mark.parametrize("rows", [1, 3, 8, 100])
def test_a_png_is_the_same_in_pieces_of_any_size(monkeypatch, rows):
    pixels = np.random.default_rng(4).integers(0, 256, (8, 5, 4), dtype=np.uint8)
    monkeypatch.setattr(png, "_PIECE", rows * 4 * 5)
    with Image.open(io.BytesIO(png.encode_png(pixels))) as image:
        assert_array_equal(np.asarray(image), pixels)


@pytest.mark.parametrize("format_", ["apng", "webp"])
@pytest.mark.parametrize("loop", [True, False])
def test_animations_hold_every_frame_exactly(tmp_path, format_, loop):
    plan = plan_for(tmp_path / f"animation.{format_}", format_, loop=loop)
    run(plan)
    frames = rgba_frames(plan.out)
    assert len(frames) == FRAMES
    for index, frame in enumerate(frames):
        assert_array_equal(frame[..., 3], draw(index)[..., 3])
        seen = frame[..., 3] > 0
        assert_array_equal(frame[seen], draw(index)[seen])
    with Image.open(plan.out) as image:
        assert image.info["loop"] == (0 if loop else 1)


def test_durations_add_up_without_drift(tmp_path):
    for format_, tolerance in (("apng", 1e-9), ("webp", 0.5), ("gif", 5.0)):
        plan = plan_for(tmp_path / f"animation.{format_}", format_, fps=23.976)
        run(plan)
        lasts = []
        with Image.open(plan.out) as image:
            for frame in ImageSequence.Iterator(image):
                frame.load()
                lasts.append(frame.info["duration"])
        assert_allclose(sum(lasts), 1000 * FRAMES / 23.976, rtol=0, atol=tolerance)
        assert_allclose(lasts, 1000 / 23.976, rtol=0, atol=2 * tolerance)


def test_a_still_apng_is_a_png_that_every_reader_shows(tmp_path):
    plan = plan_for(tmp_path / "still.png", "apng", times=(3.0,))
    run(plan)
    assert_array_equal(rgba_frames(plan.out)[0], draw(3))


def test_extreme_rates_fit_into_the_formats(tmp_path):
    for fps in (1e-6, 50.0):
        for format_ in ("apng", "webp", "gif"):
            plan = plan_for(tmp_path / f"animation.{format_}", format_, fps=fps, times=(0.0, 1.0))
            run(plan)
            assert len(rgba_frames(plan.out)) == 2


def test_gif_has_hard_edges_in_the_drawings_own_colours(tmp_path):
    plan = plan_for(tmp_path / "animation.gif", "gif")
    run(plan)
    frames = rgba_frames(plan.out)
    assert len(frames) == FRAMES
    for index, frame in enumerate(frames):
        drawn = draw(index)
        assert_array_equal(frame[..., 3], np.where(drawn[..., 3] >= 128, 255, 0))
        seen = frame[..., 3] > 0
        assert np.abs(frame[seen].astype(int) - drawn[seen])[:, :3].max() <= 6
    with Image.open(plan.out) as image:
        assert image.info["loop"] == 0


def test_gif_frames_may_be_empty_or_have_few_colours(tmp_path):
    empty, plain = np.zeros((22, 37, 4), dtype=np.uint8), np.full((22, 37, 4), 255, dtype=np.uint8)
    plan = plan_for(tmp_path / "animation.gif", "gif", times=(0.0, 1.0, 2.0), loop=False)
    run(plan, lambda time: plain if time == 1 else empty)
    frames = rgba_frames(plan.out)
    assert_array_equal([frame[..., 3].max() for frame in frames], [0, 255, 0])
    assert frames[1].min() == 255
    with Image.open(plan.out) as image:
        assert "loop" not in image.info


def test_a_spritesheet_is_a_grid_of_the_frames(tmp_path):
    plan = plan_for(tmp_path / "sheet.png", "spritesheet")
    columns, rows = sheet_grid(plan)
    assert columns * rows >= FRAMES > max(columns * (rows - 1), (columns - 1) * rows)
    run(plan)
    (sheet,) = rgba_frames(plan.out)
    assert sheet.shape == (rows * 22, columns * 37, 4)
    for index in range(FRAMES):
        top, left = 22 * (index // columns), 37 * (index % columns)
        assert_array_equal(sheet[top : top + 22, left : left + 37], draw(index))
    assert not sheet[-22:, 37 * (FRAMES % columns or columns) :].any()


@pytest.mark.parametrize(
    ("format_", "size", "count"),
    [("spritesheet", (4000, 4000), 17), ("spritesheet", (16_385, 10), 1)],
)
def test_frames_too_large_for_a_format_are_refused(tmp_path, format_, size, count):
    times = tuple(float(number) for number in range(count))
    plan = plan_for(tmp_path / "out", format_, view=canvas_view(size), times=times)
    with pytest.raises(LissomError, match="smaller size"):
        run(plan)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("count", [1, 2, 10, 16])
def test_sheets_use_what_fits(tmp_path, count):
    times = tuple(float(number) for number in range(count))
    plan = plan_for(tmp_path / "out", "spritesheet", view=canvas_view((4096, 4096)), times=times)
    assert sheet_grid(plan) == {1: (1, 1), 2: (2, 1), 10: (4, 3), 16: (4, 4)}[count]


def test_video_has_the_colours_the_rate_and_even_sides(tmp_path):
    size = (65, 37)

    def on_blue(time: float) -> Bytes:
        frame = np.empty((37, 65, 4), dtype=np.uint8)
        frame[:] = (20, 60, 200, 255)
        frame[8:24, 8 + 2 * int(time) : 24 + 2 * int(time)] = (220, 180, 40, 255)
        return frame

    plan = plan_for(
        tmp_path / "video.mp4", "mp4", view=canvas_view(size), background=(20, 60, 200), fps=23.976
    )
    run(plan, on_blue)
    with av.open(plan.out) as video:
        stream = video.streams.video[0]
        assert stream.average_rate == Fraction(2997, 125)
        assert (stream.codec_context.colorspace, stream.codec_context.color_range) == (1, 1)
        frames = [frame.to_ndarray(format="rgb24") for frame in video.decode(video=0)]
    assert len(frames) == FRAMES
    for index, frame in enumerate(frames):
        assert frame.shape == (38, 66, 3)
        inner = frame[10:22, 10 + 2 * index : 22 + 2 * index].reshape(-1, 3)
        assert_allclose(inner.mean(axis=0), (220, 180, 40), rtol=0, atol=4)
        assert_allclose(frame[30:, :].reshape(-1, 3).mean(axis=0), (20, 60, 200), rtol=0, atol=4)


@pytest.mark.parametrize("format_", DRAWN)
def test_the_same_export_twice_is_the_same_bytes(tmp_path, format_):
    outputs = [tmp_path / "first", tmp_path / "second"]
    for out in outputs:
        run(plan_for(out, format_, background=(1, 2, 3)))
    first, second = (
        {path.name: path.read_bytes() for path in out.iterdir()}
        if out.is_dir()
        else out.read_bytes()
        for out in outputs
    )
    assert first == second


@pytest.mark.parametrize("format_", DRAWN)
@pytest.mark.parametrize("ending", ["failed", "closed", "interrupted"])
def test_an_export_that_ends_early_leaves_whole_frames_only(tmp_path, format_, ending):
    def failing(time: float) -> Bytes:
        if time == 5 and ending == "failed":
            raise LissomError("frame 5 cannot be drawn")
        if time == 5 and ending == "interrupted":
            raise KeyboardInterrupt
        return draw(time)

    plan = plan_for(tmp_path / "out", format_, background=(1, 2, 3))
    steps = export_frames(plan, at_once, failing)
    if ending == "closed":
        next(itertools.islice(steps, 4, None))
        steps.close()
    else:
        with pytest.raises(LissomError if ending == "failed" else KeyboardInterrupt):
            list(steps)
    if format_ == "png":
        names = {path.name for path in plan.out.iterdir()}
        assert names <= set(plan.names[:5])
        assert plan.names[0] in names
        for name in names:
            assert_array_equal(rgba_frames(plan.out / name)[0], draw(int(name[6:10])))
    else:
        assert list(tmp_path.iterdir()) == []


def test_a_sheet_that_is_being_written_stops_at_once(tmp_path, monkeypatch):
    begun, pieces = threading.Event(), []

    def endless(_frame: Bytes, file) -> None:
        begun.set()
        while len(pieces) < 10**6:
            pieces.append(file.write(b"piece"))

    monkeypatch.setattr("app.export.writers.spritesheet.save_png", endless)
    steps = export_frames(
        plan_for(tmp_path / "sheet.png", "spritesheet"), at_once, draw, waits=False
    )
    for _ in steps:
        if begun.is_set():
            break
    steps.close()
    assert len(pieces) < 10**6
    assert list(tmp_path.iterdir()) == []


def test_a_file_of_before_survives_an_export_that_fails(tmp_path):
    plan = plan_for(tmp_path / "animation.gif", "gif")
    plan.out.write_bytes(b"before")

    def failing(time: float) -> Bytes:
        raise LissomError(f"frame {time} cannot be drawn")

    with pytest.raises(LissomError):
        list(export_frames(plan, at_once, failing))
    assert plan.out.read_bytes() == b"before"


def test_a_frame_that_cannot_be_written_is_an_error(tmp_path):
    plan = plan_for(tmp_path / "frames", "png")
    (plan.out / plan.names[2]).mkdir(parents=True)
    with pytest.raises(LissomError, match="frame_0002"):
        run(plan)


@pytest.mark.parametrize(
    ("frames_in_the_bytes", "queued"), [(0.5, 1), (3.2, 3), (1000, MOST_QUEUED)]
)
def test_drawing_waits_for_the_encoders(tmp_path, monkeypatch, frames_in_the_bytes, queued):
    plan = plan_for(tmp_path / "frames", "png", times=tuple(map(float, range(200))))
    size = 4 * plan.view.size[0] * plan.view.size[1]
    monkeypatch.setattr("app.export.run.QUEUED_BYTES", int(frames_in_the_bytes * size))
    drawn: list[float] = []
    others_are_done = threading.Event()
    drawn_meanwhile = []

    indices = itertools.count()

    def encode(_self: PngSequence, _frame: Bytes) -> bytes:
        index = next(indices)
        if index == queued - 1:
            others_are_done.set()
        if index == 0:
            others_are_done.wait()
            drawn_meanwhile.append(len(drawn))
        return b""

    def counted(time: float) -> Bytes:
        drawn.append(time)
        return draw(time)

    monkeypatch.setattr(PngSequence, "encode", encode)
    run(plan, counted)
    assert drawn_meanwhile == [queued]

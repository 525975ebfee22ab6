"""Videos as other programs read them: colours, alpha, frames and time."""

from fractions import Fraction

import av
import numpy as np
import pytest
from exports import plan_for, run
from full_disk import FullDisk
from numpy.testing import assert_allclose

from app.errors import LissomError
from app.render.view import canvas_view
from engine.arrays import Bytes, Floats

# Corners of the cube of colours, greys, and colours between them.
COLOURS = np.array(
    [
        *([255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255], [0, 0, 0], [128, 128, 128]),
        *(
            [20, 60, 200],
            [220, 180, 40],
            [250, 128, 114],
            [1, 2, 3],
            [254, 253, 252],
            [90, 200, 17],
        ),
    ],
    dtype=np.uint8,
)
PATCH, HEIGHT, FRAMES = 16, 64, 7
SIZE = (PATCH * len(COLOURS), HEIGHT)
VIDEOS = [("mp4", False), ("webm", False), ("webm", True), ("mov", False), ("mov", True)]


def picture(time: float) -> Bytes:
    """Patches of colours; below them a soft disc, which is all that is seen there, moves along."""
    frame = np.full((HEIGHT, SIZE[0], 4), 255, dtype=np.uint8)
    frame[..., :3] = np.repeat(COLOURS, PATCH, axis=0)
    y, x = np.mgrid[:HEIGHT, : SIZE[0]]
    soft = np.clip(300 - 14 * np.hypot(x - 40 - 6 * time, y - 44), 0, 255)
    frame[24:, :, 3] = soft[24:]
    frame[frame[..., 3] == 0] = 0
    return frame


def opaque(time: float) -> Bytes:
    frame = picture(time)
    frame[..., 3] = 255
    return frame


def exported(folder, format_, *, transparent, fps=23.976):
    plan = plan_for(
        folder / f"video.{format_}",
        format_,
        view=canvas_view(SIZE),
        background=None if transparent else (9, 9, 9),
        fps=fps,
    )
    run(plan, picture if transparent else opaque)
    return plan.out


def decoded(path) -> list[av.VideoFrame]:
    """All frames; of VP9 by the decoder that knows its alpha."""
    with av.open(path) as video:
        stream = video.streams.video[0]
        is_vp9 = path.suffix == ".webm"
        decoder = av.CodecContext.create("libvpx-vp9", "r") if is_vp9 else stream.codec_context
        packets = list(video.demux(stream))
        return [f for p in packets for f in decoder.decode(p if p.size else None)]


def planes(frame: av.VideoFrame) -> list[Floats]:
    """The planes, from 0 to 1; those of colours as large as the first one."""
    deep = frame.format.name.endswith("le")
    full = 2 ** frame.format.components[0].bits - 1
    found = []
    for plane in frame.planes:
        rows = np.frombuffer(plane, np.uint16 if deep else np.uint8).reshape(plane.height, -1)
        values = rows[:, : plane.width] / full
        while values.shape[0] < frame.height:
            values = values.repeat(2, axis=0).repeat(2, axis=1)
        found.append(values[: frame.height, : frame.width])
    return found


def colours(frame: av.VideoFrame) -> Floats:
    """Red, green and blue from 0 to 255, by BT.709 with a limited range."""
    bits = frame.format.components[0].bits
    unit = 2 ** (bits - 8) / (2**bits - 1)
    y, u, v = planes(frame)[:3]
    luma = (y / unit - 16) / 219
    blue_less, red_less = (u / unit - 128) / 224, (v / unit - 128) / 224
    red, blue = luma + 1.5748 * red_less, luma + 1.8556 * blue_less
    green = (luma - 0.2126 * red - 0.0722 * blue) / 0.7152
    return 255 * np.stack([red, green, blue], axis=-1)


@pytest.mark.parametrize(("format_", "transparent"), VIDEOS)
def test_known_colours_come_back_within_two_levels(tmp_path, format_, transparent):
    for frame in decoded(exported(tmp_path, format_, transparent=transparent)):
        # As FFmpeg numbers BT.709 and the limited range: readers need not guess.
        assert (frame.colorspace, frame.color_range) == (1, 1)
        found = colours(frame)[8:16, PATCH // 2 :: PATCH]
        assert np.abs(found - COLOURS).max() <= 2


@pytest.mark.parametrize(("format_", "most"), [("webm", 6.0), ("mov", 0.6)])
def test_alpha_comes_back_and_colours_are_right_where_it_is_soft(tmp_path, format_, most):
    frames = decoded(exported(tmp_path, format_, transparent=True))
    for time, frame in enumerate(frames):
        wanted = picture(time)
        assert_allclose(255 * planes(frame)[3], wanted[..., 3], rtol=0, atol=most)
        # What is seen of an edge: the darkness behind it must not have leaked into it.
        soft = (wanted[..., 3] > 30) & (wanted[..., 3] < 220)
        inner = soft & (np.arange(SIZE[0]) % PATCH > 3) & (np.arange(SIZE[0]) % PATCH < 12)
        apart = (colours(frame) - wanted[..., :3])[inner]
        assert np.abs(apart * wanted[..., 3:][inner] / 255).mean() <= 3


@pytest.mark.parametrize(("format_", "transparent"), VIDEOS)
@pytest.mark.parametrize("fps", [24.0, 23.976])
def test_frames_and_time_are_exact(tmp_path, format_, transparent, fps):
    path = exported(tmp_path, format_, transparent=transparent, fps=fps)
    assert len(decoded(path)) == FRAMES
    rate = Fraction(fps).limit_denominator(1001)
    with av.open(path) as video:
        stream = video.streams.video[0]
        assert stream.average_rate == rate
        starts = [p.pts * p.time_base for p in video.demux(stream) if p.size]
        # WebM counts milliseconds.
        slack = Fraction(1, 1000) if format_ == "webm" else 0
        assert all(abs(t - n / rate) <= slack for n, t in enumerate(sorted(starts)))
        assert abs(Fraction(video.duration, 10**6) - FRAMES / rate) <= Fraction(1, 10**6) + slack


@pytest.mark.parametrize("format_", ["webm", "mov"])
def test_odd_sides_are_kept_where_they_can_be(tmp_path, format_):
    plan = plan_for(tmp_path / f"video.{format_}", format_)
    run(plan)
    assert [(f.width, f.height) for f in decoded(plan.out)] == [(37, 22)] * FRAMES


def test_what_is_opaque_needs_no_alpha(tmp_path):
    for format_ in ("mp4", "webm", "mov"):
        frame = decoded(exported(tmp_path, format_, transparent=False))[0]
        assert not frame.format.name.startswith("yuva")


@pytest.mark.parametrize("format_", ["mp4", "webm", "mov"])
@pytest.mark.parametrize("room", [0, 3000])
def test_a_full_disk_is_reported_in_words_whatever_pyav_makes_of_it(
    tmp_path, monkeypatch, capfd, format_, room
):
    monkeypatch.setattr("app.storage.files.atomic.os.fdopen", FullDisk)
    FullDisk.room = room
    with pytest.raises(LissomError, match=r"No space left on device\. The file needs"):
        exported(tmp_path, format_, transparent=False)
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr().err == ""

"""Video, encoded by PyAV. PyAV is an extra: this module is loaded only for a video."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import IO, Final, cast

import av
import numpy as np

from app.errors import LissomError
from app.export.alpha_bleed import bleed_edges
from app.export.plan import ExportPlan
from app.export.writers.audio import AudioStream
from app.export.writers.frame_writer import FrameWriter
from app.export_formats import EXPORT_FORMATS
from app.texts import _
from engine.arrays import Bytes

_BT709: Final = 1  # FFmpeg's number of the colour space, primaries and transfer curve


@dataclass(frozen=True, slots=True, kw_only=True)
class _Codec:
    """FFmpeg's settings of a format; `transparent` is empty if the format has no alpha."""

    container: str
    name: str
    opaque: str
    transparent: str
    options: Mapping[str, str]


_CODECS: Final[Mapping[str, _Codec]] = MappingProxyType(
    {
        "mp4": _Codec(
            container="mp4",
            name="libx264",
            opaque="yuv420p",
            transparent="",
            # Nearly lossless to the eye; a short look-ahead bounds the memory. Without the last
            # option one file in three hundred was a byte longer or shorter, with the same pictures.
            options={"crf": "15", "rc-lookahead": "10", "x264-params": "cpu-independent=1"},
        ),
        "webm": _Codec(
            container="webm",
            name="libvpx-vp9",
            opaque="yuv420p",
            transparent="yuva420p",
            # The same quality; without `cpu-used` the codec is ten times slower.
            options={"crf": "12", "b": "0", "cpu-used": "4", "lag-in-frames": "10"},
        ),
        "mov": _Codec(
            container="mov",
            name="prores_ks",
            opaque="yuv444p10le",
            transparent="yuva444p10le",
            options={"profile": "4444", "vendor": "apl0", "alpha_bits": "16", "qscale": "4"},
        ),
    }
)


class _Sink:
    """A file for PyAV that keeps its errors: PyAV drops or replaces errors of its callbacks."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self._error: OSError | None = None
        self.tell = file.tell

    def write(self, data: bytes) -> int:
        """Write data; `check` raises the error of a failure."""
        try:
            return self._file.write(data)
        except OSError as error:
            self._error = error
            return len(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Move to a position, after all buffered data is written."""
        try:
            return self._file.seek(offset, whence)
        except OSError as error:
            self._error = error
            return offset

    def check(self) -> None:
        """Raise the error of an earlier write, if any."""
        if self._error is not None:
            raise self._error


class VideoWriter(FrameWriter):
    """Writes a video frame by frame.

    In MP4 an odd side gets one more row or column of the background: H.264 stores colours in blocks
    of 2 × 2 pixels.

    Raises `LissomError` if the codec is missing, or does not take frames of this size.
    """

    def __init__(self, file: IO[bytes], plan: ExportPlan) -> None:
        super().__init__(file, plan)
        codec = _CODECS[plan.format]
        self._size = EXPORT_FORMATS[plan.format].whole_blocks(plan.view.size)
        self._pixels = codec.transparent if plan.background is None else codec.opaque
        self._count = 0
        self._sink = _Sink(file)
        rate = Fraction(plan.fps).limit_denominator(1001)
        try:
            self._container = av.open(
                self._sink, "w", format=codec.container, options={"fflags": "+bitexact"}
            )
            stream = self._container.add_stream(codec.name, rate, dict(codec.options))
            self._stream = cast(av.VideoStream, stream)
            self._stream.width, self._stream.height = self._size
            self._stream.pix_fmt = self._pixels
            context = self._stream.codec_context
            # Players assume this for an unmarked video; the file states it. (The frames state their
            # range themselves.)
            context.colorspace = context.color_primaries = context.color_trc = _BT709
            self._audio: AudioStream | None = None
            if plan.soundtrack is not None:
                self._audio = AudioStream(self._container, plan.format, plan.soundtrack)
            self._container.start_encoding()
        except (av.FFmpegError, ValueError) as error:
            raise LissomError(
                _("cannot write {width} × {height} pixels as {format}: {error}").format(
                    width=self._size[0], height=self._size[1], format=plan.format, error=error
                )
            ) from error

    def encode(self, frame: Bytes) -> Bytes:
        """Return the frame's pixels: four bytes with transparency, otherwise three."""
        if self._plan.background is None:
            return bleed_edges(frame)
        height, width, _ = frame.shape
        even = np.full((self._size[1], self._size[0], 3), self._plan.background, dtype=np.uint8)
        even[:height, :width] = frame[..., :3]
        return even

    def add(self, encoded: Bytes) -> None:
        kind = "rgba" if self._plan.background is None else "rgb24"
        # With one thread: with two, the upper one overwrites the beginning of the lower one's first
        # row if the width is odd, and sometimes does so last.
        frame = av.VideoFrame.from_ndarray(encoded, format=kind).reformat(
            format=self._pixels, dst_colorspace="ITU709", dst_color_range="MPEG", threads=1
        )
        frame.pts = self._count
        self._count += 1
        self._container.mux(self._stream.encode(frame))
        if self._audio is not None:
            self._audio.write_until(self._count / self._plan.fps)
        self._sink.check()

    def finish(self) -> None:
        """Write the last frames, the rest of the sound and the index."""
        self._container.mux(self._stream.encode(None))
        if self._audio is not None:
            self._audio.finish()
        self._container.close()
        self._sink.check()

    def close(self) -> None:
        """Close the encoder, which must not outlive its file."""
        self._container.close()

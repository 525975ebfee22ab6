"""MP4 video in H.264, by way of PyAV, which is an extra: this module is loaded only for it."""

from fractions import Fraction
from typing import IO, Final

import av
import numpy as np

from app.errors import LissomError
from app.export.plan import ExportPlan
from app.export.writers.frame_writer import FrameWriter
from engine.arrays import Bytes

_CODEC: Final = "libx264"
# Nearly lossless to the eye; a short look-ahead bounds the memory. Without the last option one file
# in three hundred came out with a byte more or less, though with the same pictures.
_OPTIONS: Final = {"crf": "15", "rc-lookahead": "10", "x264-params": "cpu-independent=1"}
_BT709: Final = 1  # as FFmpeg numbers colour spaces, primaries and transfer curves


class VideoWriter(FrameWriter):
    """Writes an MP4 file frame by frame.

    A side that is odd gets one more row or column of the background, since H.264 keeps colours in
    blocks of 2 × 2 pixels.

    Parameters
    ----------
    file : binary file
        It can be written to anywhere.
    plan : ExportPlan
        With a background colour.

    Raises
    ------
    LissomError
        If H.264 cannot be written, or not in frames of this size.
    """

    def __init__(self, file: IO[bytes], plan: ExportPlan) -> None:
        width, height = plan.view.size
        self._size = width + width % 2, height + height % 2
        self._background = plan.background
        self._count = 0
        rate = Fraction(plan.fps).limit_denominator(1001)
        try:
            self._container = av.open(file, "w", format="mp4")
            self._stream = self._container.add_stream(_CODEC, rate, dict(_OPTIONS))
            self._stream.width, self._stream.height = self._size
            self._stream.pix_fmt = "yuv420p"
            context = self._stream.codec_context
            # What players take a video for that says nothing; this one says so, too. (Its frames
            # tell their range themselves.)
            context.colorspace = context.color_primaries = context.color_trc = _BT709
            self._container.start_encoding()
        except (av.FFmpegError, ValueError) as error:
            raise LissomError(
                f"cannot write {self._size[0]} × {self._size[1]} H.264 video: {error}"
            ) from error

    def encode(self, index: int, frame: Bytes) -> bytes:  # noqa: ARG002 - all frames are alike
        """Return the frame's colours, three bytes a pixel, with even sides."""
        height, width, _ = frame.shape
        even = np.full((self._size[1], self._size[0], 3), self._background, dtype=np.uint8)
        even[:height, :width] = frame[..., :3]
        return even.tobytes()

    def add(self, encoded: bytes) -> None:
        """Compress a frame."""
        width, height = self._size
        pixels = np.frombuffer(encoded, dtype=np.uint8).reshape(height, width, 3)
        frame = av.VideoFrame.from_ndarray(pixels, format="rgb24").reformat(
            format="yuv420p", dst_colorspace="ITU709", dst_color_range="MPEG"
        )
        frame.pts = self._count
        self._count += 1
        self._container.mux(self._stream.encode(frame))

    def finish(self) -> None:
        """Write the last frames and the index."""
        self._container.mux(self._stream.encode(None))
        self._container.close()

    def close(self) -> None:
        """Let the encoder go; it must not outlive its file."""
        self._container.close()

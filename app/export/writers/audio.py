"""The sound of a video, encoded by PyAV beside the pictures."""

from collections.abc import Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import Final, NamedTuple, cast

import av
import numpy as np

from app.sound import Samples, Soundtrack

BLOCK: Final = 4_096  # samples


class _Codec(NamedTuple):
    """FFmpeg's encoder of a format, and the rates that it takes; none if it takes any."""

    name: str
    rates: tuple[int, ...] = ()
    bits: int | None = None  # a second


_CODECS: Final[Mapping[str, _Codec]] = MappingProxyType(
    {
        "mp4": _Codec("aac", (48_000, 44_100, 96_000, 88_200, 32_000, 24_000, 22_050), 256_000),
        "webm": _Codec("libopus", (48_000,), 192_000),
        "mov": _Codec("pcm_s24le"),  # exact
    }
)


class AudioStream:
    """Adds the sound of a plan to a container, up to any moment."""

    def __init__(
        self, container: av.container.OutputContainer, format_: str, soundtrack: Soundtrack
    ) -> None:
        codec, rate = _CODECS[format_], soundtrack.rate
        self._rate = rate if not codec.rates or rate in codec.rates else codec.rates[0]
        self._container = container
        self._blocks = soundtrack.blocks(self._rate, BLOCK)
        self._count = 0
        stream = container.add_stream(codec.name, self._rate, layout="stereo")
        self._stream = cast(av.AudioStream, stream)
        if codec.bits is not None:
            self._stream.bit_rate = codec.bits

    def write_until(self, seconds: float) -> None:
        """Write whole blocks, as far as a moment of the video."""
        while self._count < seconds * self._rate:
            block = next(self._blocks, None)
            if block is None:
                return
            self._container.mux(self._stream.encode(self._frame(block)))

    def finish(self) -> None:
        """Write the rest, which ends with the last frame."""
        self.write_until(float("inf"))
        self._container.mux(self._stream.encode(None))

    def _frame(self, block: Samples) -> av.AudioFrame:
        planes = np.ascontiguousarray(block.T)
        frame = av.AudioFrame.from_ndarray(planes, format="fltp", layout="stereo")
        frame.sample_rate, frame.pts = self._rate, self._count
        frame.time_base = Fraction(1, self._rate)
        self._count += len(block)
        return frame

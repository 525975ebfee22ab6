"""Videos, decoded by PyAV. PyAV is an extra: this module is loaded only for a video."""

from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Final, cast

import av
import numpy as np

from app.document import MOST_PICTURES
from app.errors import LissomError
from app.storage.files.reading import open_file
from app.storage.footage.footage_reader import DecodedPicture, FootageReader
from app.texts import N_, _
from engine.arrays import Bytes, freeze

NO_VIDEO = N_("{name} is not a video that can be read: {error}")
NO_PICTURES = N_("{name} has no pictures")
TOO_LONG = N_("{name} has more than {most:,} pictures; cut it first")
# Heights from which on unmarked videos have the colours of HDTV.
_HIGH_DEFINITION: Final = 720
_UNMARKED: Final = 2  # FFmpeg's number of an unknown colour space
_ITU601, _ITU709 = "ITU601", "ITU709"
_ALPHA_DECODERS: Final = {"vp8": "libvpx", "vp9": "libvpx-vp9"}
_ERRORS = (av.FFmpegError, OSError, ValueError)


class VideoReader(FootageReader):
    """Reads a video; its pictures are known by their times in the file.

    Attributes
    ----------
    size : tuple of int
        Width and height in pixels, upright.
    fps : float
        Frames per second, of which each picture lasts one or more, as `holds` says.
    """

    def __init__(self, path: Path) -> None:
        with ExitStack() as owned:
            file = owned.enter_context(open_file(path)).stream
            try:
                # Lists of other files, or of addresses, are not followed.
                container = av.open(file, "r", options={"protocol_whitelist": "none"})
                owned.callback(container.close)
                if not container.streams.video:
                    raise LissomError(_(NO_PICTURES).format(name=path.name))
                stream = container.streams.video[0]
                stream.thread_type = "AUTO"
                packets = [
                    (packet.dts if packet.pts is None else packet.pts, packet.is_keyframe)
                    for packet in container.demux(stream)
                    if not packet.is_discard and (packet.pts, packet.dts) != (None, None)
                ]
            except _ERRORS as error:
                raise LissomError(_(NO_VIDEO).format(name=path.name, error=error)) from error
            self._times = sorted({time for time, _is_key in packets if time is not None})
            if not self._times:
                raise LissomError(_(NO_PICTURES).format(name=path.name))
            if len(self._times) > MOST_PICTURES:
                raise LissomError(_(TOO_LONG).format(name=path.name, most=MOST_PICTURES))
            self._numbers = {time: number for number, time in enumerate(self._times)}
            keys = {self._numbers[time] for time, is_key in packets if is_key and time is not None}
            super().__init__(path.name, sorted({0, *keys}))
            self._container, self._stream = container, stream
            # FFmpeg's own decoders leave the alpha of WebM out.
            has_alpha = stream.metadata.get("alpha_mode") == "1"
            name = _ALPHA_DECODERS.get(stream.codec_context.name) if has_alpha else None
            self._alpha_decoder = name
            try:
                first = next(self._decode_from(0)).pixels()
            except StopIteration:
                raise LissomError(_(NO_PICTURES).format(name=path.name)) from None
            self.size: Final = first.shape[1], first.shape[0]
            self.fps, self.holds = self._find_rate()
            self._owned = owned.pop_all()

    @property
    def picture_count(self) -> int:
        return len(self._times)

    def _find_rate(self) -> tuple[float, tuple[int, ...]]:
        """Return frames per second, and the frames that each picture lasts, () if one each."""
        rates = (self._stream.guessed_rate, self._stream.average_rate)
        base = self._stream.time_base
        for rate in rates:
            if not rate or base is None:
                continue
            ticks = [round((time - self._times[0]) * base * rate) for time in self._times]
            holds = [after - before for before, after in pairwise(ticks)]
            if min(holds, default=1) >= 1:
                return float(rate), (*holds, 1) if max(holds, default=1) > 1 else ()
        # Its pictures are irregular: they are shown at their mean rate.
        return float(rates[1] or rates[0] or 24), ()

    def _decode_from(self, start: int) -> Iterator[DecodedPicture]:
        container, stream = self._container, self._stream
        try:
            container.seek(self._times[start], stream=stream, backward=True)
            decoder = self._new_decoder()
            number = start
            for packet in container.demux(stream):
                for frame in decoder.decode(packet):
                    time = number if frame.pts is None else self._numbers.get(frame.pts)
                    # Before a key, pictures that refer to earlier ones are incomplete.
                    if time is not None and time >= start:
                        number = time + 1
                        yield DecodedPicture(time, partial(self._pixels, frame))
        except _ERRORS as error:
            raise LissomError(_(NO_VIDEO).format(name=self.name, error=error)) from error

    def _new_decoder(self) -> av.VideoCodecContext:
        own = self._stream.codec_context
        own.flush_buffers()
        if self._alpha_decoder is None:
            return own
        decoder = cast(av.VideoCodecContext, av.CodecContext.create(self._alpha_decoder, "r"))
        decoder.extradata = own.extradata
        return decoder

    def _pixels(self, frame: av.VideoFrame) -> Bytes:
        space = None
        if frame.colorspace == _UNMARKED:
            space = _ITU709 if frame.height >= _HIGH_DEFINITION else _ITU601
        pixels = frame.reformat(format="rgba", src_colorspace=space).to_ndarray()
        turns = round(frame.rotation / 90) % 4
        return freeze(np.ascontiguousarray(np.rot90(pixels, turns)))

    def close(self) -> None:
        """Close the file and its decoder."""
        self._pictures = iter(())
        self._owned.close()

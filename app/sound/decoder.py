"""Sound files as samples, decoded a few at a time, so that memory does not grow with the length.

Samples are float32 of shape (n, 1) or (n, 2), at the file's own rate; more than two channels are
mixed to two.
"""

from typing import Any, Final

import numpy as np

from app.errors import LissomError
from app.sound.samples import Samples
from app.texts import N_, _

# First bytes of each format, with its name.
MAGIC: Final = (
    (b"RIFF", "WAV"),
    (b"RF64", "WAV"),
    (b"riff", "WAV"),
    (b"fLaC", "FLAC"),
    (b"OggS", "OGG"),
    (b"ID3", "MP3"),
)
SLOWEST_RATE, FASTEST_RATE = 8_000, 192_000
MOST_CHANNELS: Final = 6
BLOCK: Final = 16_384  # samples decoded at once
NO_SOUND = N_("{name} is not a sound. Lissom reads WAV, FLAC, MP3 and OGG (Vorbis) files")
OPUS = N_("{name} holds Opus, which Lissom does not read. Save it as WAV, FLAC, MP3 or OGG Vorbis")
NO_SAMPLES = N_("{name} holds no sound that can be read; it is cut short or damaged")
OTHER_RATE = N_("{name} has {rate:,} samples a second; Lissom reads {least:,} to {most:,}")
OTHER_CHANNELS = N_("{name} has {count} channels; Lissom reads at most {most}")


def find_format(data: bytes) -> str | None:
    """Return the name of a sound file's format; None if the bytes are no sound."""
    for magic, name in MAGIC:
        if data.startswith(magic):
            return name
    # The frame mark of MPEG audio, layer 3.
    is_mp3 = len(data) > 2 and data[0] == 0xFF and data[1] & 0xE6 == 0xE2
    return "MP3" if is_mp3 else None


class SoundDecoder:
    """Reads samples of a sound file; `position` is the next one.

    Raises `LissomError` if the bytes are no sound of a supported kind.
    """

    _decoder: Any = None

    def __init__(self, data: bytes, name: str) -> None:
        import miniaudio  # noqa: PLC0415 - only sounds need it

        self._ffi, self._lib = miniaudio.ffi, miniaudio.lib
        self._float = miniaudio.SampleFormat.FLOAT32.value
        self.name, self._data = name, data
        format_ = find_format(data)
        if format_ is None:
            raise LissomError(_(NO_SOUND).format(name=name))
        if format_ == "OGG" and b"OpusHead" in data[:64]:
            raise LissomError(_(OPUS).format(name=name))
        # The library's jumps in MP3 files are not exact to the sample.
        self._jumps = format_ != "MP3"
        self._open(channels=0)
        self.rate = int(self._decoder.outputSampleRate)
        self.file_channels = int(self._decoder.outputChannels)
        self._check()
        self.channels = min(self.file_channels, 2)
        if self.file_channels > self.channels:
            self._open(channels=self.channels)

    def _open(self, *, channels: int) -> None:
        """Begin at the first sample; 0 channels are those of the file."""
        self.close()
        decoder = self._ffi.new("ma_decoder *")
        config = self._lib.ma_decoder_config_init(self._float, channels, 0)
        if self._lib.ma_decoder_init_memory(
            self._data, len(self._data), self._ffi.addressof(config), decoder
        ):
            raise LissomError(_(NO_SAMPLES).format(name=self.name))
        self._decoder, self.position = decoder, 0

    def _check(self) -> None:
        if not SLOWEST_RATE <= self.rate <= FASTEST_RATE:
            raise LissomError(
                _(OTHER_RATE).format(
                    name=self.name, rate=self.rate, least=SLOWEST_RATE, most=FASTEST_RATE
                )
            )
        if self.file_channels > MOST_CHANNELS:
            raise LissomError(
                _(OTHER_CHANNELS).format(
                    name=self.name, count=self.file_channels, most=MOST_CHANNELS
                )
            )

    def read(self, count: int) -> Samples:
        """Return the next samples; fewer at the end of the file."""
        found = np.empty((count, self.channels), dtype=np.float32)
        read = self._ffi.new("ma_uint64 *")
        done = 0
        while done < count:
            target = self._ffi.cast("void *", found[done:].ctypes.data)
            status = self._lib.ma_decoder_read_pcm_frames(self._decoder, target, count - done, read)
            done += int(read[0])
            if status or not read[0]:
                break
        self.position += done
        # Damaged files of numbers may hold infinite ones.
        return np.nan_to_num(found[:done], copy=False, posinf=0.0, neginf=0.0)

    def seek(self, position: int) -> None:
        """Go to a sample; beyond the end, to the end."""
        if position == self.position:
            return
        if self._jumps and not self._lib.ma_decoder_seek_to_pcm_frame(self._decoder, position):
            self.position = position
            return
        if position < self.position or self._jumps:
            self._open(channels=self.channels)
        while self.position < position:
            if not len(self.read(min(BLOCK, position - self.position))):
                return

    def close(self) -> None:
        """Free the decoder's memory."""
        if self._decoder is not None:
            self._lib.ma_decoder_uninit(self._decoder)
            self._decoder = None

    def __del__(self) -> None:
        self.close()

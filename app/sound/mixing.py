"""The mix of a document's sounds: samples of any range, of equal times whatever the range.

A frame lasts 1 / fps seconds. Sample n of the mix is at n / rate seconds from frame 0.
"""

from collections import Counter, OrderedDict
from collections.abc import Iterable
from typing import Final

import numpy as np

from app.document import Document, Sound, SoundFile, volume_at
from app.sound.decoder import SoundDecoder
from app.sound.samples import Samples, resample

USUAL_RATE: Final = 48_000
CHUNK: Final = 8_192  # samples of a file that are decoded at once
KEPT: Final = 64  # chunks: some ten seconds


def common_rate(sounds: Iterable[Sound]) -> int:
    """Return the rate of most sounds, so that they are not converted."""
    counts = Counter(sound.file.rate for sound in sounds)
    return counts.most_common(1)[0][0] if counts else USUAL_RATE


class _SoundReader:
    """Reads any part of a sound file; zeros are outside of it.

    Whole chunks are decoded and kept for a while: parts overlap where rates are converted, and
    short loops come again. A jump back in an MP3 file is slow.
    """

    def __init__(self, file: SoundFile, data: bytes) -> None:
        self._file = file
        self._decoder = SoundDecoder(data, file.name)
        self._chunks: OrderedDict[int, Samples] = OrderedDict()

    def read(self, first: int, count: int) -> Samples:
        found = np.zeros((count, 2), dtype=np.float32)
        begin, end = max(first, 0), min(first + count, self._file.samples)
        for index in range(begin // CHUNK, -(-end // CHUNK) if begin < end else 0):
            chunk, start = self._chunk(index), index * CHUNK
            low, high = max(begin, start), min(end, start + len(chunk))
            if low < high:
                found[low - first : high - first] = chunk[low - start : high - start]
        return found

    def _chunk(self, index: int) -> Samples:
        """Return the samples of a chunk, decoded now or lately."""
        if index not in self._chunks:
            self._decoder.seek(index * CHUNK)
            self._chunks[index] = self._decoder.read(CHUNK)
            if len(self._chunks) > KEPT:
                self._chunks.popitem(last=False)
        self._chunks.move_to_end(index)
        return self._chunks[index]


class SoundMix:
    """The sounds of a document that are heard, at a rate.

    Reading goes on quickly where it stopped; a jump in an MP3 file decodes it from its beginning.
    """

    def __init__(self, document: Document, rate: int) -> None:
        self._document, self.rate = document, rate
        self._sounds = [each for each in document.sounds if not each.muted and each.file.data]
        self._readers = {
            each.name: _SoundReader(each.file, each.file.data)
            for each in self._sounds
            if each.file.data
        }

    def place_of(self, frame: float) -> float:
        """Return the place of a frame's beginning, between two samples or on one."""
        return frame / self._document.fps * self.rate

    def sample_at(self, frame: float) -> int:
        """Return the sample at the beginning of a frame."""
        return round(self.place_of(frame))

    def read(self, first: int, count: int) -> Samples:
        """Return samples (count, 2); beyond −1 to 1 where loud sounds meet."""
        mixed = np.zeros((count, 2), dtype=np.float32)
        for sound in self._sounds:
            start = self.sample_at(sound.start)
            begin = max(first, start)
            end = min(first + count, start + round(sound.length * self.rate))
            if begin < end:
                part = self._part(sound, begin - start, end - begin)
                mixed[begin - first : end - first] += self._volume(sound, begin, end) * part
        return mixed

    def _part(self, sound: Sound, first: int, count: int) -> Samples:
        """Return samples of a sound, counted from its start."""
        reader, rate = self._readers[sound.name], sound.file.rate
        if rate == self.rate:
            return reader.read(first + round(sound.skip * rate), count)
        # A cut is rounded to samples of the mix.
        cut = round(sound.skip * self.rate)
        return resample(reader.read, first + cut, count, rate, self.rate)

    def _volume(self, sound: Sound, begin: int, end: int) -> Samples | float:
        """Return the volume of samples (n, 1), straight between frames."""
        if not sound.keys:
            return sound.volume
        per_frame = self.rate / self._document.fps
        frames = np.arange(int(begin // per_frame), int(end // per_frame) + 2)
        known = [volume_at(self._document, sound, float(frame)) for frame in frames]
        volume = np.interp(np.arange(begin, end) / per_frame, frames, known)
        return volume.astype(np.float32)[:, None]

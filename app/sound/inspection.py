"""One pass over a sound file: what is in it, and its peaks for a waveform."""

import hashlib
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from app.document import Sound, SoundFile
from app.errors import LissomError, report_progress
from app.sound.decoder import NO_SAMPLES, SoundDecoder
from app.sound.samples import Samples
from app.texts import _

PEAKS_PER_SECOND: Final = 200
SUFFIXES: Final = (".wav", ".flac", ".mp3", ".ogg")
Peaks = npt.NDArray[np.uint8]
Levels = npt.NDArray[np.float64]


class InspectedSound(NamedTuple):
    """A sound file, its peaks and its loudness.

    Both are uint8 (n,), `PEAKS_PER_SECOND` each second, of 255: the largest level of a sample, and
    the root of the mean square.
    """

    file: SoundFile
    peaks: Peaks
    loudness: Peaks


def inspect_sound(data: bytes, name: str) -> InspectedSound:
    """Decode a sound file once; its own word about its length is not believed.

    Raises `LissomError` if it is no sound that Lissom reads.
    """
    decoder = SoundDecoder(data, name)
    starts = np.arange(PEAKS_PER_SECOND) * decoder.rate // PEAKS_PER_SECOND
    peaks, loudness = [], []
    try:
        # A second at a time, which has a whole number of peaks at any rate.
        while len(second := decoder.read(decoder.rate)):
            begun = starts[starts < len(second)]
            counts = np.diff([*begun, len(second)])
            power = np.add.reduceat(np.square(second).mean(axis=1), begun) / counts
            peaks.append(_levels(np.maximum.reduceat(np.abs(second).max(axis=1), begun)))
            loudness.append(_levels(np.sqrt(power)))
            report_progress(0.0)
        samples = decoder.position
    finally:
        decoder.close()
    if not samples:
        raise LissomError(_(NO_SAMPLES).format(name=name))
    file = SoundFile(
        name=name,
        sha256=hashlib.sha256(data).hexdigest(),
        size=len(data),
        rate=decoder.rate,
        channels=decoder.file_channels,
        samples=samples,
        data=data,
    )
    return InspectedSound(file, np.concatenate(peaks), np.concatenate(loudness))


def _levels(values: Samples) -> Peaks:
    return np.rint(255 * np.clip(values, 0, 1)).astype(np.uint8)


def new_sound(inspected: InspectedSound, start: float) -> Sound:
    """Return a sound that is the whole file, named after it."""
    file = inspected.file
    name = file.name.rpartition(".")[0].strip() or file.name
    return Sound(name=name, file=file, start=start, length=file.seconds)

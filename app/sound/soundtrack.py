"""The sound of exported frames: exactly as long as they are, and at the same times."""

import io
import wave
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.document import Document, ExportSettings
from app.errors import join_names
from app.export_formats import EXPORT_FORMATS
from app.sound.decoder import BLOCK
from app.sound.mixing import SoundMix, common_rate
from app.sound.samples import Samples
from app.texts import _


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Soundtrack:
    """The mix of a document from a frame on."""

    document: Document
    first: float  # frame
    seconds: float
    passes: int = 1  # how often the sound comes within these seconds

    @property
    def rate(self) -> int:
        """The rate at which most sounds are not converted."""
        return common_rate(each for each in self.document.sounds if not each.muted)

    @property
    def channels(self) -> int:
        """1 if both sides sound alike, otherwise 2."""
        heard = [each for each in self.document.sounds if not each.muted]
        return 1 if all(each.file.channels == 1 for each in heard) else 2

    def wav(self) -> bytes:
        """Return the whole sound as a WAV file of 16 bits."""
        file = io.BytesIO()
        with wave.open(file, "wb") as written:
            written.setnchannels(self.channels)
            written.setsampwidth(2)
            written.setframerate(self.rate)
            for block in self.blocks(self.rate, BLOCK):
                # As a decoder reads them: 1 is one level above the largest.
                levels = np.rint(block[:, : self.channels] * 32_768).clip(-32_768, 32_767)
                written.writeframesraw(levels.astype("<i2").tobytes())
        return file.getvalue()

    def count(self, rate: int) -> int:
        """Return the number of samples at a rate."""
        return round(self.seconds * rate)

    def blocks(self, rate: int, size: int) -> Iterator[Samples]:
        """Yield the samples at a rate, from −1 to 1, in blocks of a size; the last is shorter."""
        mix = SoundMix(self.document, rate)
        begin, count = mix.sample_at(self.first), self.count(rate)
        # Each pass begins at the sample nearest to its first picture.
        starts = [round(each * self.seconds * rate / self.passes) for each in range(self.passes)]
        for first in range(0, count, size):
            parts, at, end = [], first, min(first + size, count)
            while at < end:
                number = bisect_right(starts, at)
                until = min([end, *starts[number : number + 1]])
                parts.append(mix.read(begin + at - starts[number - 1], until - at))
                at = until
            yield np.concatenate(parts).clip(-1, 1)


def find_soundtrack(
    document: Document, settings: ExportSettings, first: float, seconds: float, *, passes: int = 1
) -> Soundtrack | None:
    """Return the soundtrack of an export from a frame on; None if the file carries none.

    At another speed it carries none, because sounds have their own speed.
    """
    is_carried = EXPORT_FORMATS[settings.format].has_sound and settings.sound
    is_carried = is_carried and settings.speed == 1
    if not is_carried or all(sound.muted for sound in document.sounds):
        return None
    return Soundtrack(document=document, first=first, seconds=seconds, passes=passes)


def list_sound_notices(
    document: Document, settings: ExportSettings, track: Soundtrack | None
) -> list[str]:
    """Return notices of sounds that an export lacks, and of their size if they are not packed."""
    format_ = EXPORT_FORMATS[settings.format]
    heard = [sound for sound in document.sounds if not sound.muted]
    if not heard or not settings.sound or format_.is_still:
        return []
    if settings.speed != 1 and format_.has_sound:
        return [_("sounds have their own speed, so an export at another speed has none")]
    if track is None:
        text = _("the format {name} has no sound; {formats} carry the sounds")
        others = join_names([name for name, each in EXPORT_FORMATS.items() if each.has_sound])
        return [text.format(name=settings.format, formats=others)]
    text = _("the file {file} of the sound {name!r} is missing, so the sound is silent")
    notices = [
        text.format(file=each.file.name, name=each.name) for each in heard if each.file.data is None
    ]
    if not format_.is_drawn:
        size = 4 / 3 * 2 * track.channels * track.count(track.rate)  # as text
        text = _("{seconds:.1f} s of sound take {size:,.0f} KB of the file")
        notices.append(text.format(seconds=track.seconds, size=size / 1000))
    return notices

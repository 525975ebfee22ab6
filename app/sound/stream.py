"""Streams of samples that the player plays, made a block at a time."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count, pairwise
from math import ceil, floor
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from app.sound.mixing import SoundMix
from app.sound.samples import Samples

BLOCK: Final = 1_024  # samples
FADE: Final = 0.004  # seconds over which sounds begin, end and meet
SamplePlaces = npt.NDArray[Any]  # samples of a mix, whole or between two


@dataclass(frozen=True, slots=True, kw_only=True)
class PlayedRange:
    """What is played: from a frame on, at a speed; as a loop, `length` frames from `first` on."""

    start: float
    speed: float = 1.0  # negative plays backwards
    first: float = 0.0
    length: float | None = None  # None plays on


def stream_range(mix: SoundMix, played: PlayedRange) -> Iterator[Samples]:
    """Yield the samples of a range without end.

    A loop begins anew at the exact time, however often. There its end fades into its beginning.
    """
    start, speed = mix.place_of(played.start), played.speed
    for number in count():
        places = start + speed * np.arange(number * BLOCK, (number + 1) * BLOCK)
        if played.length is None:
            yield _read(mix, places, speed)
        else:
            first, period = mix.place_of(played.first), mix.place_of(played.length)
            turns = np.floor((places - first) / period)
            edges = [0, *(np.flatnonzero(np.diff(turns)) + 1), BLOCK]
            for low, high in pairwise(edges):
                at = places[low:high] - turns[low] * period
                yield _turn(mix, at, speed, first, period, is_first=not turns[low])


def stream_part(mix: SoundMix, frame: float, seconds: float) -> Iterator[Samples]:
    """Yield a short part of a mix, which fades out."""
    part = mix.read(round(mix.place_of(frame)), round(seconds * mix.rate))
    fade = min(round(FADE * mix.rate), len(part))
    part[len(part) - fade :] *= np.linspace(1, 0, fade, dtype=np.float32)[:, None]
    yield part


def _turn(
    mix: SoundMix, at: SamplePlaces, speed: float, first: float, period: float, *, is_first: bool
) -> Samples:
    """Return samples within a turn of a loop."""
    since = at - first if speed > 0 else first + period - at
    fading = int(np.count_nonzero(since < FADE * mix.rate * abs(speed)))
    if not fading or is_first:
        return _read(mix, at, speed)
    # Before the jump back, which may take long.
    before = _read(mix, at[:fading] + (period if speed > 0 else -period), speed)
    found = _read(mix, at, speed)
    share = (since[:fading] / (FADE * mix.rate * abs(speed))).astype(np.float32)[:, None]
    found[:fading] = share * found[:fading] + (1 - share) * before
    return found


def _read(mix: SoundMix, places: SamplePlaces, speed: float) -> Samples:
    """Return the samples at evenly spaced places, exact at the speed 1."""
    if speed == 1:
        return mix.read(round(places[0]), len(places))
    low, high = floor(places.min()), ceil(places.max())
    known = mix.read(low, high - low + 1)
    sides = [np.interp(places - low, np.arange(len(known)), side) for side in known.T]
    return np.stack(sides, axis=1).astype(np.float32)

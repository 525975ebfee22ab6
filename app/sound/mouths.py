"""Keys of a switch of mouths, made from the cues or the loudness of a sound."""

from collections.abc import Mapping, Sequence
from math import ceil
from typing import Final, NamedTuple

import numpy as np

from app.document import SWITCH, Cue, Key, Mouths, Sound, SwitchMember
from app.sound.inspection import PEAKS_PER_SECOND, InspectedSound, Levels

MOST_KEYS: Final = 8  # a second
TOLERANCE: Final = 0.04  # of how far a mouth is open
# Names of drawings that may show a cue: Rhubarb's shapes, then phonemes of Papagayo and Moho.
_LIKELY: Final[Mapping[str, tuple[str, ...]]] = {
    "a": ("closed", "shut", "mbp", "m", "rest", "x"),
    "b": ("etc", "ee", "teeth", "s"),
    "c": ("e", "eh", "open"),
    "d": ("ai", "ah", "aa", "wide"),
    "e": ("o", "oh", "round"),
    "f": ("u", "oo", "wq", "w"),
    "g": ("fv", "f", "v"),
    "h": ("l", "th"),
    "x": ("rest", "closed", "shut", "neutral", "idle", "a"),
    "ai": ("ah", "aa", "a", "open", "wide", "d"),
    "o": ("oh", "round"),
    "u": ("oo", "wq", "f"),
    "etc": ("ee", "teeth", "b"),
    "l": ("th", "h"),
    "wq": ("oo", "u", "w", "f"),
    "mbp": ("closed", "shut", "m", "a"),
    "fv": ("f", "v", "g"),
    "rest": ("closed", "shut", "neutral", "idle", "x", "mbp"),
}


class _Shown(NamedTuple):
    """A drawing, from a frame on for a number of frames."""

    frame: int
    layer: SwitchMember
    lasts: float


def guess_drawings(
    cues: Sequence[Cue], layers: Sequence[tuple[SwitchMember, str]]
) -> tuple[tuple[str, SwitchMember], ...]:
    """Return a drawing for the name of each cue, by the names of the layers (id, name).

    A cue without a likely name takes the first layer.
    """
    by_name: dict[str, SwitchMember] = {}
    for identity, name in layers:
        whole = name.casefold().rpartition("/")[2].strip()
        for word in (whole, whole.split()[-1] if whole else ""):
            by_name.setdefault(word, identity)
    first = layers[0][0]

    names = dict.fromkeys(cue.name for cue in cues)
    # In Rhubarb's alphabet, E is a shape; elsewhere it is a sound.
    likely = _LIKELY if all(len(name) == 1 for name in names) else {**_LIKELY, "e": ("eh", "c")}

    def guess(cue: str) -> SwitchMember:
        words = (cue.casefold(), *likely.get(cue.casefold(), ()))
        return next((by_name[word] for word in words if word in by_name), first)

    return tuple((name, guess(name)) for name in names)


def make_mouth_keys(sound: Sound, mouths: Mouths, fps: float) -> tuple[Key[SwitchMember], ...]:
    """Return the keys of the cues that are heard, at most `MOST_KEYS` a second.

    Where cues are closer, the longest is seen.
    """
    drawings = dict(mouths.drawings)
    first, last = max(sound.start, 0.0), sound.end(fps)
    times = [sound.frame_of(cue.seconds, fps) for cue in mouths.cues]
    shown: list[_Shown] = []
    for cue, begin, end in zip(mouths.cues, times, [*times[1:], last], strict=True):
        seen, gone = max(begin, first), min(end, last)
        if cue.name not in drawings or seen >= gone:
            continue
        each = _Shown(round(seen), drawings[cue.name], gone - seen)
        if shown and shown[-1].layer == each.layer:
            shown[-1] = shown[-1]._replace(lasts=shown[-1].lasts + each.lasts)
        else:
            shown.append(each)
    return tuple(SWITCH.key(each.frame, each.layer) for each in _apart(shown, fps))


def _apart(shown: Sequence[_Shown], fps: float) -> list[_Shown]:
    """Return the drawings that are far enough apart, without repetitions."""
    gap, kept = ceil(fps / MOST_KEYS), list[_Shown]()
    for each in shown:
        if not kept or each.frame - kept[-1].frame >= gap:
            kept.append(each)
        elif each.lasts > kept[-1].lasts:
            kept[-1] = each._replace(frame=kept[-1].frame)
    return [
        each for index, each in enumerate(kept) if not index or each.layer != kept[index - 1].layer
    ]


class Response(NamedTuple):
    """How a mouth follows the volume: seconds until it is open, and until it is closed again."""

    attack: float = 0.02
    release: float = 0.12
    sensitivity: float = 1.0


def follow_volume(inspected: InspectedSound, rate: float, response: Response) -> Levels:
    """Return how far a mouth is open, 0 to 1, `rate` times a second of the file.

    A level is relative to the loud parts of the sound.
    """
    count = ceil(len(inspected.loudness) * rate / PEAKS_PER_SECOND)
    begins = (np.arange(count) * PEAKS_PER_SECOND / rate).astype(int)
    levels = np.maximum.reduceat(inspected.loudness, begins) / 255
    loud = float(np.quantile(levels[levels > 0], 0.9)) if levels.any() else 1.0
    wanted = np.clip(levels / loud * response.sensitivity, 0, 1)
    rise, fall = (
        1 - np.exp(-1 / max(seconds * rate, 1e-9))
        for seconds in (response.attack, response.release)
    )
    opened, now = np.empty(count), 0.0
    for index, each in enumerate(wanted):
        now += (each - now) * (rise if each > now else fall)
        opened[index] = now
    return opened


def make_volume_values(sound: Sound, opened: Levels, fps: float) -> tuple[tuple[int, float], ...]:
    """Return frames and values, 0 to 1, that follow how far a mouth is open while it is heard.

    `opened` has a value for each 1 / fps seconds of the file. There are at most `MOST_KEYS` values
    a second. The mouth is closed at both ends.
    """
    first, last = max(ceil(sound.start), 0), int(sound.end(fps))
    frames = np.arange(first, max(last, first) + 1)
    indices = ((frames - sound.start) / fps + sound.skip) * fps
    heard = opened[np.clip(indices.astype(int), 0, len(opened) - 1)]
    gap = ceil(fps / MOST_KEYS)
    # The widest of each stretch of time, so that no short word is lost.
    at = np.arange(0, len(frames), gap)
    values = np.maximum.reduceat(heard, at)
    values[[0, -1]] = 0
    kept = _corners(values, TOLERANCE)
    return tuple((int(frames[at[index]]), round(float(values[index]), 3)) for index in kept)


def _corners(values: Levels, tolerance: float) -> list[int]:
    """Return the indices between which straight lines stay within a tolerance of all values."""
    kept, open_ends = {0, len(values) - 1}, [(0, len(values) - 1)]
    while open_ends:
        low, high = open_ends.pop()
        if high - low < 2:
            continue
        line = np.linspace(values[low], values[high], high - low + 1)
        far = np.abs(values[low : high + 1] - line)
        middle = low + int(far.argmax())
        if far.max() > tolerance:
            kept.add(middle)
            open_ends += [(low, middle), (middle, high)]
    return sorted(kept)


def cues_of_volume(opened: Levels, rate: float, count: int) -> tuple[Cue, ...]:
    """Return cues named 1 to `count`, from closed to wide open, at their changes."""
    steps = np.minimum((opened * count).astype(int), count - 1)
    changes = [0, *(np.flatnonzero(np.diff(steps)) + 1)] if len(steps) else []
    return tuple(Cue(seconds=index / rate, name=f"{steps[index] + 1}") for index in changes)

"""Recorded drags: few keys whose motion stays near what a hand did."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import solveh_banded

from engine.arrays import Complexes, Floats, Indices, as_number, as_points, as_reals
from engine.errors import EngineError
from engine.geometry.kinematics.springs import FARTHEST

# Frames between two places beyond which the way from one to the other counts as recorded.
GAP = 1.0
EARLY = 0.1  # frames that the first key may be before the recording, and the last one after it
# Of a sample's weight: how strongly a key that nothing else decides is held on the recording.
TIE = 1e-6
# Keys that are so many apart hardly know of each other.
APART = 8
SLACK = 1.05  # by what factor more may be missed where the tolerance cannot be kept
REACH = 3  # intervals on either side of a key that is dropped in which much changes
# Frames that a recording may span, whose memory grows with them, and the last one that it may have.
MOST_FRAMES, LATEST = 1_000_000, 1e9
TOO_LONG = (
    "A recording spans at most {most:,} frames, not those from {first:g} to {last:g}; give it in "
    "parts."
)
TOLERANCE = "The tolerance of a recording, in pixels,"


class FittedKeys(NamedTuple):
    """Keys (k,), k ≥ 1, that a motion passes at velocities of their own."""

    frames: Indices
    places: Complexes
    velocities: Complexes  # pixels a frame


def fit_keys(
    times: npt.ArrayLike,
    places: npt.ArrayLike,
    tolerance: float,
    *,
    required: Collection[int] = (),
) -> FittedKeys:
    """Return few keys on whole frames whose motion stays near recorded places; none could go.

    Parameters
    ----------
    times : array_like of float, shape (n,)
        When each place was recorded, in frames, n ≥ 1; in no even steps, and never going back. Of
        places at one time the last one counts.
    places : array_like of complex, shape (n,)
        Pixels. Between two that are more than a frame apart the way counts as straight.
    tolerance : float
        Pixels, 0 or more, that a recorded place may be beside the motion; 0 for a key in each
        frame, unless fewer miss nothing.
    required : collection of int
        Frames that have a key in any case, if they are between the first and the last.

    Returns
    -------
    FittedKeys
        From the first whole frame of the recording to its last one; one key, at rest, where there
        are not two. The tolerance is kept where keys in all frames around can keep it.

    Raises
    ------
    EngineError
        If something is not finite, if times go back or are too far apart, or if the tolerance is
        below 0.

    Notes
    -----
    The motion is a cubic Hermite polynomial between two keys. It is linear in the places and the
    velocities of the keys, which are found all at once by least squares. Keys are put where the
    motion misses most, until it is within the tolerance; then the one that is least needed goes,
    again and again, far from each other many at once.
    """
    when = as_reals(times, "The times of a recording")
    where = as_points(places, "Recorded places", most=FARTHEST)
    if when.shape != where.shape or not len(where):
        raise EngineError(
            f"A recording has a time for each place and at least one, not {when.shape} times and "
            f"{len(where)} places."
        )
    if not np.isfinite(when).all():
        raise EngineError("The times of a recording must be finite.")
    if (np.diff(when) < 0).any():
        raise EngineError("The times of a recording must not go back.")
    if np.abs(when).max() > LATEST or when[-1] - when[0] > MOST_FRAMES:
        raise EngineError(TOO_LONG.format(most=MOST_FRAMES, first=when[0], last=when[-1]))
    as_number(tolerance, TOLERANCE, least=0)
    is_last = np.append(np.diff(when) > 0, True)
    when, where = _filled(when[is_last], where[is_last])
    first, last = int(np.ceil(when[0] - EARLY)), int(np.floor(when[-1] + EARLY))
    if first >= last:
        middle = round((when[0] + when[-1]) / 2)
        nearest = np.array([first if first == last else middle], dtype=np.intp)
        return FittedKeys(nearest, _along(nearest, when, where), np.zeros(1, dtype=np.complex128))
    wanted = [int(as_number(frame, "A frame with a key", is_whole=True)) for frame in required]
    recording = _Recording(when, where, first, last, tolerance)
    fixed = sorted({first, last, *(each for each in wanted if first < each < last)})
    frames = recording.refine(np.array(fixed, dtype=np.intp))
    if tolerance:
        frames = recording.simplify(frames, fixed)
    return recording.fitted(frames)[0]


def evaluate_keys(keys: FittedKeys, times: Floats) -> Complexes:
    """Return where the motion through two keys or more is at times (t,) from first to last."""
    interval, rows = _rows(keys.frames, times)
    return _motion(rows, keys.places, keys.velocities, interval)


class _Recording:
    """Places (n,) by their times, from the first frame to the last, and how near keys stay."""

    def __init__(
        self, times: Floats, places: Complexes, first: int, last: int, tolerance: float
    ) -> None:
        self.at_frames = _along(np.arange(first, last + 1), times, places)
        self.ways = np.gradient(self.at_frames)
        inside = (times >= first) & (times <= last)
        self.times, self.places = times[inside], places[inside]
        self.tolerance = tolerance

    def fitted(self, frames: Indices) -> tuple[FittedKeys, Floats]:
        """Return the best keys at some frames, and by how much each recorded place is missed.

        The normal equations are solved in bands: a key knows of its neighbours only.
        """
        interval, rows = _rows(frames, self.times)
        # The unknowns are how far keys are beside the recording, where nothing else holds them.
        at = frames - frames[0]
        near, ways = self.at_frames[at], self.ways[at]
        rest = self.places - _motion(rows, near, ways, interval)
        starts = np.searchsorted(self.times, frames[:-1])
        end = 2 * len(frames) - 2

        def of_intervals(products: Floats) -> Floats:
            # None of them is empty.
            sums: Floats = np.add.reduceat(products, starts)
            return sums

        # Of each key its place, and then its velocity.
        bands, right = np.zeros((4, end + 2)), np.zeros((end + 2, 2))
        for i in range(4):
            right[i : i + end : 2, 0] += of_intervals(rows[i] * rest.real)
            right[i : i + end : 2, 1] += of_intervals(rows[i] * rest.imag)
            for j in range(i + 1):
                bands[3 - i + j, i : i + end : 2] += of_intervals(rows[i] * rows[j])
        bands[3] += TIE
        beside = solveh_banded(bands, right, check_finite=False) @ [1, 1j]
        keys = FittedKeys(frames, near + beside[::2], ways + beside[1::2])
        motion = _motion(rows, keys.places, keys.velocities, interval)
        return keys, np.abs(motion - self.places)

    def refine(self, keys: Indices) -> Indices:
        """Put keys where the motion misses most, half way between two, until it is near."""
        while True:
            missed = self.fitted(keys)[1]
            most = np.zeros(len(keys) - 1)
            np.maximum.at(most, _intervals(keys, self.times), missed)
            # Where there is no frame between two keys, those beside may tell how they are passed.
            is_short = np.diff(keys) == 1
            most = np.where(is_short, 0.0, np.maximum(most, _around(np.where(is_short, most, 0.0))))
            worst = np.flatnonzero((most > self.tolerance) & (most == _around(most)))
            if not worst.size:
                return keys
            keys = np.sort(np.append(keys, (keys[worst] + keys[worst + 1]) // 2))

    def simplify(self, keys: Indices, fixed: Sequence[int]) -> Indices:
        """Drop keys that need not be there, the one first without which it misses least."""
        needed = [*fixed]  # and those without which too much is missed far from them
        missed = self.fitted(keys)[1]
        allowed = np.where(missed > self.tolerance, SLACK * missed, self.tolerance)
        while True:
            excesses = self._excesses(keys, allowed)
            excesses[np.isin(keys, needed)] = np.inf
            dropped = self._far_apart(excesses)
            if not len(dropped):
                return keys
            while len(dropped):
                rest = np.delete(keys, dropped)
                beyond = self.times[self.fitted(rest)[1] > allowed]
                if not len(beyond):
                    keys = rest
                    break
                if len(dropped) == 1:
                    needed.append(int(keys[dropped[0]]))
                # Those that are nearest to where too much is missed stay, or one of them.
                near = np.unique(np.abs(keys[dropped][:, None] - beyond).argmin(axis=0))
                dropped = np.delete(dropped, near if len(near) < len(dropped) else near[:1])

    @staticmethod
    def _far_apart(excesses: Floats) -> Indices:
        """Return keys that may go, the least needed ones first, and none near another."""
        dropped, is_near = [], excesses > 0
        for key in np.argsort(excesses, kind="stable").tolist():
            if not is_near[key]:
                dropped.append(key)
                is_near[max(key - APART + 1, 0) : key + APART] = True
        return np.array(dropped, dtype=np.intp)

    def _excesses(self, keys: Indices, allowed: Floats) -> Floats:
        """Return by how much too much is missed around each key without it, the ends aside."""
        excesses = np.full(len(keys), np.inf)
        for start in range(1, min(APART, len(keys) - 2) + 1):
            without = np.arange(start, len(keys) - 1, APART)
            excess = self.fitted(np.delete(keys, without))[1] - allowed
            for key in without.tolist():
                ends = keys[max(key - REACH - 1, 0)], keys[min(key + REACH + 1, len(keys) - 1)]
                since, until = np.searchsorted(self.times, ends)
                excesses[key] = excess[since : until + 1].max(initial=-np.inf)
        return excesses


def _filled(times: Floats, places: Complexes) -> tuple[Floats, Complexes]:
    """Return a recording with places at the frames in its gaps, straight across."""
    frames = np.arange(np.ceil(times[0]), times[-1])
    following = np.searchsorted(times, frames, side="right")
    frames = frames[times[following] - times[following - 1] > GAP]
    where = np.searchsorted(times, frames)
    return np.insert(times, where, frames), np.insert(places, where, _along(frames, times, places))


def _along(frames: Indices | Floats, times: Floats, places: Complexes) -> Complexes:
    """Return where a recording is at frames, straight between its places."""
    return np.asarray(
        np.interp(frames, times, places.real) + 1j * np.interp(frames, times, places.imag)
    )


def _intervals(keys: Indices, times: Floats) -> Indices:
    """Return the interval (t,) between keys in which each time is."""
    return np.clip(np.searchsorted(keys, times, side="right") - 1, 0, len(keys) - 2)


def _around(values: Floats) -> Floats:
    """Return the largest of each value and two on either side."""
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(values, 2), 5)
    largest: Floats = windows.max(axis=1)
    return largest


def _rows(keys: Indices, times: Floats) -> tuple[Indices, Floats]:
    """Return in which intervals times are, and the weights (4, t) there of the keys around them.

    They are those of the place and of the velocity of the key before, and of the key after.
    """
    interval = _intervals(keys, times)
    length = np.diff(keys)[interval].astype(float)
    share = (times - keys[interval]) / length
    rest = 1 - share
    rows = np.array(
        [
            (1 + 2 * share) * rest**2,
            length * share * rest**2,
            (3 - 2 * share) * share**2,
            -length * share**2 * rest,
        ]
    )
    return interval, rows


def _motion(rows: Floats, places: Complexes, velocities: Complexes, interval: Indices) -> Complexes:
    """Return the motion (t,) of keys by the weights of those around intervals."""
    after = interval + 1
    numbers = places[interval], velocities[interval], places[after], velocities[after]
    motion: Complexes = sum(row * number for row, number in zip(rows, numbers, strict=True))
    return motion

"""Recorded drags: few keys whose motion stays near the recording."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import solveh_banded

from app.rigging.kinematics.springs import FARTHEST
from engine.arrays import Complexes, Floats, Indices, as_number, as_points, as_reals
from engine.errors import EngineError

# Longest gap in frames between two recorded places; in longer gaps the straight way counts as
# recorded.
GAP = 1.0
EARLY = 0.1  # frames between the recording and a first key before it, or a last key after it
# Of a sample's weight: how strongly an otherwise undetermined key is held on the recording.
TIE = 1e-6
# Keys this far apart hardly influence each other.
APART = 8
SLACK = 1.05  # factor of the largest error where the tolerance cannot be kept
REACH = 3  # intervals on either side of a dropped key that change much
# Most frames of a recording, as memory grows with them, and its last possible frame.
MOST_FRAMES, LATEST = 1_000_000, 1e9
TOO_LONG = (
    "A recording can span at most {most:,} frames, but this recording runs from frame {first:g} "
    "to {last:g}. Record it in parts."
)
TOLERANCE = "The tolerance of a recording, in pixels,"


class FittedKeys(NamedTuple):
    """Keys (k,), k ≥ 1, with the velocities of the motion there."""

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
    """Return few keys on whole frames whose motion stays near recorded places; none is superfluous.

    Parameters
    ----------
    times : array_like of float, shape (n,)
        Time of each recorded place, in frames, n ≥ 1; unevenly spaced, never decreasing. Of places
        at one time the last one counts.
    places : array_like of complex, shape (n,)
        Pixels. Between two that are more than a frame apart the way counts as straight.
    tolerance : float
        Largest distance in pixels of a recorded place from the motion, 0 or more; 0 for a key in
        each frame, unless fewer keys are exact.
    required : collection of int
        Frames that get a key, if they are between the first and the last.

    Returns
    -------
    FittedKeys
        From the first whole frame of the recording to its last one; one key, at rest, if there is
        only one whole frame. The tolerance is kept where keys in all frames around can keep it.

    Raises
    ------
    EngineError
        If a value is not finite, if times decrease or are too far apart, or if the tolerance is
        below 0.

    Notes
    -----
    The motion is a cubic Hermite polynomial between two keys. It is linear in the places and the
    velocities of the keys, which are found all at once by least squares. Keys are added where the
    error is largest, until it is within the tolerance. Then the least needed key is dropped, again
    and again; keys far from each other are dropped together.
    """
    when = as_reals(times, "The times of a recording")
    where = as_points(places, "Recorded places", most=FARTHEST)
    if when.shape != where.shape or not len(where):
        raise EngineError(
            "A recording needs one time for each position, and at least one position; it has "
            "{times} times and {count} positions.",
            times=when.shape,
            count=len(where),
        )
    if not np.isfinite(when).all():
        raise EngineError("The times of a recording must be finite.")
    if (np.diff(when) < 0).any():
        raise EngineError("The times of a recording must not decrease.")
    if np.abs(when).max() > LATEST or when[-1] - when[0] > MOST_FRAMES:
        raise EngineError(TOO_LONG, most=MOST_FRAMES, first=when[0], last=when[-1])
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
    """Return the motion through two or more keys at times (t,) from first to last."""
    interval, rows = _rows(keys.frames, times)
    return _motion(rows, keys.places, keys.velocities, interval)


class _Recording:
    """Places (n,) by their times, from first to last frame, and the errors that keys may have."""

    def __init__(
        self, times: Floats, places: Complexes, first: int, last: int, tolerance: float
    ) -> None:
        self.at_frames = _along(np.arange(first, last + 1), times, places)
        self.ways = np.gradient(self.at_frames)
        inside = (times >= first) & (times <= last)
        self.times, self.places = times[inside], places[inside]
        self.tolerance = tolerance

    def fitted(self, frames: Indices) -> tuple[FittedKeys, Floats]:
        """Return the best keys at these frames, and the error at each recorded place.

        The normal equations are banded: a key depends on its neighbours only.
        """
        interval, rows = _rows(frames, self.times)
        # The unknowns are offsets of the keys from the recording, which hold undetermined keys
        # there.
        at = frames - frames[0]
        near, ways = self.at_frames[at], self.ways[at]
        rest = self.places - _motion(rows, near, ways, interval)
        starts = np.searchsorted(self.times, frames[:-1])
        end = 2 * len(frames) - 2

        def of_intervals(products: Floats) -> Floats:
            # No group is empty.
            sums: Floats = np.add.reduceat(products, starts)
            return sums

        # For each key its place, and then its velocity.
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
        """Add keys half way between two where the error is largest, until it is small."""
        while True:
            missed = self.fitted(keys)[1]
            most = np.zeros(len(keys) - 1)
            np.maximum.at(most, _intervals(keys, self.times), missed)
            # Where no frame lies between two keys, neighbouring intervals may help their
            # velocities.
            is_short = np.diff(keys) == 1
            most = np.where(is_short, 0.0, np.maximum(most, _around(np.where(is_short, most, 0.0))))
            worst = np.flatnonzero((most > self.tolerance) & (most == _around(most)))
            if not worst.size:
                return keys
            keys = np.sort(np.append(keys, (keys[worst] + keys[worst + 1]) // 2))

    def simplify(self, keys: Indices, fixed: Sequence[int]) -> Indices:
        """Drop superfluous keys, first the key without which the error is smallest."""
        needed = [*fixed]  # and keys without which errors far from them are too large
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
                # Of the dropped keys, those nearest to too large errors stay.
                near = np.unique(np.abs(keys[dropped][:, None] - beyond).argmin(axis=0))
                dropped = np.delete(dropped, near if len(near) < len(dropped) else near[:1])

    @staticmethod
    def _far_apart(excesses: Floats) -> Indices:
        """Return keys that may go, the least needed ones first, and no two near each other."""
        dropped, is_near = [], excesses > 0
        for key in np.argsort(excesses, kind="stable").tolist():
            if not is_near[key]:
                dropped.append(key)
                is_near[max(key - APART + 1, 0) : key + APART] = True
        return np.array(dropped, dtype=np.intp)

    def _excesses(self, keys: Indices, allowed: Floats) -> Floats:
        """Return the excess error around each key without it, except at the ends."""
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
    """Return a recording with places at its end frames and in its gaps, on straight lines.

    Without a place at an end frame, its key would be extrapolated from the places before.
    """
    frames = np.arange(np.ceil(times[0]), times[-1])
    following = np.searchsorted(times, frames, side="right")
    is_added = times[following] - times[following - 1] > GAP
    is_added[:1] = is_added[-1:] = True
    frames = frames[is_added & ~np.isin(frames, times)]
    where = np.searchsorted(times, frames)
    return np.insert(times, where, frames), np.insert(places, where, _along(frames, times, places))


def _along(frames: Indices | Floats, times: Floats, places: Complexes) -> Complexes:
    """Return the places of a recording at frames, linear in between."""
    return np.asarray(
        np.interp(frames, times, places.real) + 1j * np.interp(frames, times, places.imag)
    )


def _intervals(keys: Indices, times: Floats) -> Indices:
    """Return the interval (t,) between keys of each time."""
    return np.clip(np.searchsorted(keys, times, side="right") - 1, 0, len(keys) - 2)


def _around(values: Floats) -> Floats:
    """Return the largest of each value and its two neighbours on either side."""
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(values, 2), 5)
    largest: Floats = windows.max(axis=1)
    return largest


def _rows(keys: Indices, times: Floats) -> tuple[Indices, Floats]:
    """Return the intervals of times, and the weights (4, t) of the keys at their ends.

    The weights are of place and velocity of the key before, and of the key after.
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
    """Return the motion (t,) from the weights of the keys at the ends of intervals."""
    after = interval + 1
    numbers = places[interval], velocities[interval], places[after], velocities[after]
    motion: Complexes = sum(row * number for row, number in zip(rows, numbers, strict=True))
    return motion

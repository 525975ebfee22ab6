"""Where springs and tracks want their handles at a frame, over the motion of the figure."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from app.document import Clip, Track, TrackPlace, track_at
from engine.arrays import Complexes, Floats
from engine.geometry import HERE, RigidMotion

TURNED = 50.0  # pixels that count as much as a turn by one radian
# Where a figure is that hangs on others, at a frame.
Carried = Callable[[float], RigidMotion]


class Wanted(NamedTuple):
    """Where the handles (h,) are wanted, as `engine.deform.relative.Pins` has it.

    `tracked` are the ids of those that a track wants somewhere.
    """

    places: Complexes
    firmness: Floats
    turns: Floats
    reach: float
    tracked: frozenset[int]


class OwnClocks:
    """The springs and tracks of a clip.

    Parameters
    ----------
    clip : Clip
    places : callable
        Returns where the handles (h,) are at a frame without them.
    carried : callable, optional
        Where the figure hangs, at a frame; by itself without.
    """

    def __init__(
        self, clip: Clip, places: Callable[[float], Complexes], carried: Carried | None = None
    ) -> None:
        figure = clip.figure
        self._clip, self._carried = clip, carried
        self._index = {handle.id: number for number, handle in enumerate(figure.handles)}
        self._tracks = [track for track in figure.tracks if track.enabled]
        # These are held as firmly wherever others go their own ways: nothing gives when they begin.
        own = [identity for track in self._tracks for identity in track.handles]
        own += [spring.handle for spring in figure.springs if spring.enabled]
        self._firmness = np.zeros(len(figure.handles))
        self._firmness[[self._index[identity] for identity in own]] = 1.0

    def acts(self, frame: float) -> bool:
        """Tell whether anything may be wanted at a frame."""
        return any(track_at(track, self._clip, frame) for track in self._tracks)

    def wanted(self, frame: float, places: Complexes, fz: Complexes) -> Wanted | None:
        """Return where handles are wanted at a frame; None where they are there.

        Parameters
        ----------
        frame : float
        places, fz : complex128, shape (h,)
            Where they are, and f_z there.
        """
        wanted, turns = places.copy(), np.full(len(places), np.nan)
        reaches, sizes, tracked = [], [], set()
        for track in self._tracks:
            at = track_at(track, self._clip, frame)
            if at is None:
                continue
            numbers = [self._index[identity] for identity in track.handles]
            offset = self._offset(track, at, frame, complex(places[numbers[0]]), fz[numbers[0]])
            wanted[numbers] = places[numbers] + offset
            if track.turns:
                turns[numbers] = np.angle(fz[numbers]) + at.turn
            reaches.append(track.reach)
            sizes.append(abs(offset) + TURNED * abs(at.turn))
            tracked |= set(track.handles)
        if np.array_equal(wanted, places) and np.isnan(turns).all():
            return None
        # By how far each leads, so that none jumps in as it begins.
        reach = float(np.average(reaches, weights=sizes)) if np.any(sizes) else 1.0
        return Wanted(wanted, self._firmness, turns, reach, frozenset(tracked))

    def _offset(
        self, track: Track, at: TrackPlace, frame: float, place: complex, fz: complex
    ) -> complex:
        """Return by how much a track moves its handles."""
        if not track.planted:
            return at.place * fz / abs(fz)
        return (self._carried(frame) if self._carried else HERE).back(at.place) - place

"""Targets of handles at a frame by springs and tracks."""

from typing import NamedTuple

import numpy as np

from app.document import Clip, Track, TrackSample, track_at
from app.motion.inbetweens.spring_offsets import ParentMotion, PositionsAt, SpringOffsets
from engine.arrays import Booleans, Complexes, Floats
from engine.geometry import IDENTITY_MOTION, Similarity

TURNED = 50.0  # pixels that weigh as much as a rotation by one radian


class SecondaryTargets(NamedTuple):
    """Targets of the handles (h,)."""

    positions: Complexes  # complex128 (h,)
    has_target: Booleans  # (h,): handles with tracks and springs
    rotations: Floats  # float64 (h,): of the shape, from −π to π; NaN where free
    reach: float  # how far the displacement spreads around the handles, from 0 to 1 (freely)
    tracked: frozenset[int]  # ids of handles with a target by a track


class SecondaryMotion:
    """The springs and tracks of a clip; `carried` is the layer's rigid motion at a frame."""

    def __init__(self, clip: Clip, carried: ParentMotion | None = None) -> None:
        layer = clip.layer
        self._clip, self._carried = clip, carried
        self._swings = SpringOffsets(clip, carried)
        self._index = {handle.id: number for number, handle in enumerate(layer.handles)}
        self._tracks = [track for track in layer.tracks if track.enabled]
        # Tracks and springs hold their handles also before they move them, so that nothing jumps at
        # their start.
        own = [identity for track in self._tracks for identity in track.handles]
        own += [spring.handle for spring in self._swings.springs]
        self._is_own = np.zeros(len(layer.handles), np.bool_)
        self._is_own[[self._index[identity] for identity in own]] = True

    def with_tracks(self, clip: Clip) -> "SecondaryMotion":
        """Return the motion of a clip that differs only in its tracks, with the same springs."""
        changed = SecondaryMotion(clip, self._carried)
        changed._swings = self._swings
        return changed

    @property
    def run_up(self) -> int:
        """Number of earlier frames that affect the targets of a frame."""
        return self._swings.run_up

    def is_active(self, frame: float) -> bool:
        """Return whether a handle may have a target at a frame."""
        return bool(self._swings.springs) or any(
            track_at(track, self._clip, frame) is not None for track in self._tracks
        )

    def targets_at(
        self, frame: float, places: Complexes, fz: Complexes, at: PositionsAt
    ) -> SecondaryTargets | None:
        """Return the targets at a frame; None if all handles are there.

        `places` and `fz`, complex128 (h,), are the positions of the handles, and f_z there. `at`
        returns the positions at any frame before springs and tracks.
        """
        wanted, turns = places.copy(), np.full(len(places), np.nan)
        reaches, sizes, tracked = [], [], set()
        for spring in self._swings.springs:
            offset = self._swings.offset(spring, frame, places, at)
            wanted[self._index[spring.handle]] += offset
            reaches.append(1.0)
            sizes.append(abs(offset))
        for track in self._tracks:
            own = track_at(track, self._clip, frame)
            if own is None:
                continue
            numbers = [self._index[identity] for identity in track.handles]
            offset = self._offset(track, own, frame, complex(places[numbers[0]]), fz[numbers[0]])
            wanted[numbers] = places[numbers] + offset
            if track.keys_rotation:
                turns[numbers] = np.angle(np.exp(1j * own.turn))
            reaches.append(track.reach)
            sizes.append(abs(offset) + TURNED * abs(own.turn))
            tracked |= set(track.handles)
        for spring in self._swings.springs:
            root, tip = self._swings.roots.get(spring.handle), self._index[spring.handle]
            if root is None or spring.handle in tracked:
                continue
            # A track may move and rotate the root; the arm moves with the root.
            turn = 0.0 if np.isnan(turns[root]) else turns[root]
            along = wanted[root] - places[root]
            along += (wanted[tip] - places[root]) * np.expm1(1j * turn)
            wanted[tip] += (1 - spring.stretch) * along
        if np.array_equal(wanted, places) and not np.nan_to_num(turns).any():
            return None
        # Weighted by the displacements, so that the reach does not jump at the start of a track.
        reach = float(np.average(reaches, weights=sizes)) if np.any(sizes) else 1.0
        return SecondaryTargets(wanted, self._is_own, turns, reach, frozenset(tracked))

    def _parent_transform(self, frame: float) -> Similarity:
        return self._carried(frame) if self._carried else IDENTITY_MOTION

    def _offset(
        self, track: Track, at: TrackSample, frame: float, place: complex, fz: complex
    ) -> complex:
        """Return the displacement of a track's handles."""
        if not track.is_scene_space:
            return at.place * fz / abs(fz)
        return self._parent_transform(frame).apply_inverse(at.place) - place

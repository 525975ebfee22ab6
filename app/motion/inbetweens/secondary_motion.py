"""Where springs and tracks want their handles at a frame, over the motion of the layer."""

from typing import NamedTuple

import numpy as np

from app.document import Clip, Track, TrackSample, track_at
from app.motion.inbetweens.spring_offsets import ParentMotion, PositionsAt, SpringOffsets
from engine.arrays import Booleans, Complexes, Floats
from engine.geometry import IDENTITY_MOTION, RigidMotion

TURNED = 50.0  # pixels that count as much as a turn by one radian


class SecondaryTargets(NamedTuple):
    """Where the handles (h,) are wanted.

    Parameters
    ----------
    places : complex128, shape (h,)
    is_own : bool, shape (h,)
        The handles with tracks and springs.
    turns : float64, shape (h,)
        By how much the shape is turned there, in radians from −π to π; NaN where it is free.
    reach : float
        How far around the handles the shape gives, from 0 to 1, as it likes.
    tracked : frozenset of int
        The ids of handles with a target by a track.
    """

    positions: Complexes
    has_target: Booleans
    rotations: Floats
    reach: float
    tracked: frozenset[int]


class SecondaryMotion:
    """The springs and tracks of a clip.

    Parameters
    ----------
    clip : Clip
    carried : callable, optional
        Where the layer hangs, at a frame; by itself without.
    """

    def __init__(self, clip: Clip, carried: ParentMotion | None = None) -> None:
        layer = clip.layer
        self._clip, self._carried = clip, carried
        self._swings = SpringOffsets(clip, carried)
        self._index = {handle.id: number for number, handle in enumerate(layer.handles)}
        self._tracks = [track for track in layer.tracks if track.enabled]
        # Tracks and springs hold their handles also before they move them: no jump as they begin.
        own = [identity for track in self._tracks for identity in track.handles]
        own += [spring.handle for spring in self._swings.springs]
        self._is_own = np.zeros(len(layer.handles), np.bool_)
        self._is_own[[self._index[identity] for identity in own]] = True

    def with_tracks(self, clip: Clip) -> "SecondaryMotion":
        """Return those of a clip that differs in its tracks alone: the springs swing alike."""
        changed = SecondaryMotion(clip, self._carried)
        changed._swings = self._swings
        return changed

    @property
    def run_up(self) -> int:
        """Frames before a frame from which what is wanted there follows."""
        return self._swings.run_up

    def is_active(self, frame: float) -> bool:
        """Tell whether anything may be wanted at a frame."""
        return bool(self._swings.springs) or any(
            track_at(track, self._clip, frame) is not None for track in self._tracks
        )

    def targets_at(
        self, frame: float, places: Complexes, fz: Complexes, at: PositionsAt
    ) -> SecondaryTargets | None:
        """Return where handles are wanted at a frame; None where they are there.

        Parameters
        ----------
        frame : float
        places, fz : complex128, shape (h,)
            Where they are, and f_z there.
        at : callable
            Returns where they are at any frame before springs and tracks, (h,).
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
            # The root may go its own way, too, and turn: the arm goes along.
            turn = 0.0 if np.isnan(turns[root]) else turns[root]
            along = wanted[root] - places[root]
            along += (wanted[tip] - places[root]) * np.expm1(1j * turn)
            wanted[tip] += (1 - spring.stretch) * along
        if np.array_equal(wanted, places) and not np.nan_to_num(turns).any():
            return None
        # By how far each leads, so that none jumps in as it begins.
        reach = float(np.average(reaches, weights=sizes)) if np.any(sizes) else 1.0
        return SecondaryTargets(wanted, self._is_own, turns, reach, frozenset(tracked))

    def _parent_transform(self, frame: float) -> RigidMotion:
        return self._carried(frame) if self._carried else IDENTITY_MOTION

    def _offset(
        self, track: Track, at: TrackSample, frame: float, place: complex, fz: complex
    ) -> complex:
        """Return by how much a track moves its handles."""
        if not track.is_scene_space:
            return at.place * fz / abs(fz)
        return self._parent_transform(frame).apply_inverse(at.place) - place

"""Displacements by the springs of a clip, computed in pieces around the requested frames."""

from collections.abc import Callable
from functools import partial
from typing import Final, NamedTuple, TypeVar

import numpy as np

from app.document import Clip, Spring, segment_time_at, spring_root
from app.rigging import FADE_FRAMES, SpringResponse, frames_to_settle, simulate_spring, turn_arm
from engine.arrays import Complexes
from engine.geometry import IDENTITY_MOTION, Similarity, diameter

MAX_SPRING_OFFSET: Final = 0.3  # fraction of the layer's diameter
PIECE: Final = 64  # smallest number of frames of a piece
KEPT_PIECES: Final = 1_024
KEPT_PLACES: Final = 2**14
Key = TypeVar("Key")
Value = TypeVar("Value")
# Rigid motion of an attached layer at a frame.
ParentMotion = Callable[[float], Similarity]
# Positions (h,) of a layer's handles at a frame.
PositionsAt = Callable[[float], Complexes]


class _Piece(NamedTuple):
    """A range of a spring's frames, simulated freely and about its root.

    It is valid from its first frame to before its last.
    """

    first: int
    last: int
    free: SpringResponse
    about: SpringResponse | None  # as arc lengths


class SpringOffsets:
    """The displacements by a clip's springs, driven by the motion in the scene.

    A damped spring forgets. The simulation of a piece starts at rest, as many frames earlier as the
    spring takes to settle. A shorter loop is simulated whole, so that it closes.

    `springs` are the enabled springs. `roots` maps handle ids to indices of root handles. The
    `run_up` earlier frames affect a displacement.
    """

    def __init__(self, clip: Clip, carried: ParentMotion | None) -> None:
        self._clip, self._carried = clip, carried
        self.springs = tuple(spring for spring in clip.layer.springs if spring.enabled)
        self._index = {handle.id: number for number, handle in enumerate(clip.layer.handles)}
        roots = {spring.handle: spring_root(clip.layer, spring) for spring in self.springs}
        self.roots = {i: self._index[root] for i, root in roots.items() if root is not None}
        self._count = clip.frames.last - clip.frames.first + 1
        self._settling = {
            each.handle: int(
                min(frames_to_settle(clip.fps, each.frequency, each.damping), self._count)
            )
            for each in self.springs
        }
        self.run_up = max(self._settling.values(), default=0)
        self._pieces: dict[tuple[int, int], _Piece] = {}
        self._places: dict[object, Complexes] = {}

    def offset(self, spring: Spring, frame: float, places: Complexes, at: PositionsAt) -> complex:
        """Return the displacement of a spring's handle at a frame, in the layer's space.

        `places`, complex128 (h,), are the positions of the handles at the frame before springs and
        tracks. `at` returns these positions at any frame.
        """
        piece, time = self._piece(spring, frame, at)
        parent_motion = self._carried(frame) if self._carried else IDENTITY_MOTION
        free = complex(piece.free.at(time)) / parent_motion.factor
        if piece.about is None:
            return free
        arm = places[self._index[spring.handle]] - places[self.roots[spring.handle]]
        turned = turn_arm(complex(arm), float(piece.about.at(time).real))
        return (1 - spring.stretch) * turned + spring.stretch * free

    def _piece(self, spring: Spring, frame: float, at: PositionsAt) -> tuple[_Piece, float]:
        """Return the piece of a spring that contains a frame, and the time in it."""
        last, settling = self._count - 1, self._settling[spring.handle]
        time = frame - self._clip.frames.first - spring.lag
        is_loop = self._clip.loop and last > 0
        time = time % last if is_loop else min(max(time, 0.0), last)
        is_whole = is_loop and settling >= last
        size = self._count if is_whole else max(PIECE, settling // 4)
        number = int(time // size)
        known = self._pieces.get((spring.handle, number))
        if known is None or time >= known.last:
            # Twice as long as before, so that playing on simulates each frame at most twice.
            length = PIECE
            while number * size + length <= time:
                length *= 2
            start, end = number * size - settling, number * size + min(length, size)
            # A fade depends on the frames after it.
            frames = range(start, end + FADE_FRAMES + 1)
            if is_whole:
                start, end, frames = 0, self._count, range(self._count)
            elif not is_loop:
                start = max(start, 0)
                frames = range(start, min(end + FADE_FRAMES + 1, self._count))
            own = [i % last if is_loop and not is_whole else i for i in frames]
            free, about = self._swung(spring, own, at, loop=is_whole)
            known = _Piece(start, end, free, about)
            _keep(self._pieces, (spring.handle, number), known, KEPT_PIECES)
        return known, time - known.first

    def _swung(
        self, spring: Spring, frames: list[int], at: PositionsAt, *, loop: bool
    ) -> tuple[SpringResponse, SpringResponse | None]:
        clip, root = self._clip, self.roots.get(spring.handle)
        places = np.array([self._driving(clip.frames.first + frame, at) for frame in frames]).T
        swung = partial(
            simulate_spring,
            places[self._index[spring.handle]],
            clip.fps,
            frequency=spring.frequency,
            damping=spring.damping,
            strength=spring.strength,
            limit=MAX_SPRING_OFFSET * diameter(clip.layer.domain.outline),
            loop=loop,
        )
        return swung(), None if root is None else swung(roots=places[root])

    def _driving(self, frame: int, at: PositionsAt) -> Complexes:
        """Return the positions (h,) of the handles in the scene, cached by content."""
        key = frame if self._carried else segment_time_at(self._clip, frame)
        found = self._places.get(key)
        if found is None:
            found = (self._carried(frame) if self._carried else IDENTITY_MOTION).apply(at(frame))
            _keep(self._places, key, found, KEPT_PLACES)
        return found


def _keep(kept: dict[Key, Value], key: Key, value: Value, most: int) -> None:
    """Keep a value, and drop the oldest beyond `most`."""
    kept.pop(key, None)
    kept[key] = value
    while len(kept) > most:
        del kept[next(iter(kept))]

"""The corrections of a clip's frames: springs and tracks over the motion from key to key.

Each frame is worked out by itself, and known by all that it follows from, so that undo, a copied
key and another window onto the same figure find what was made before.
"""

import threading
from collections.abc import Callable, Iterable
from copy import copy
from typing import NamedTuple

import numpy as np

from app.document import (
    Clip,
    Extremes,
    Variant,
    pinned_segments,
    resting_pose,
    stiffened,
    time_of,
)
from app.motion.inbetweens.base_motion import BaseMotion
from app.motion.inbetweens.correction import FrameCorrection
from app.motion.inbetweens.own_clocks import OwnClocks, Wanted
from app.motion.inbetweens.pairs import pair_of, poses_of
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.swings import Carried
from engine.arrays import Complexes, Floats, Indices
from engine.deform.model import Jet
from engine.deform.relative import Corrected, Corrector, Pins

BESIDE = 0.03  # of the diagonal: handles nearer to an anchor, or to one that goes, give way
KEPT = 2**26  # bytes of corrections of one outline that are kept


class Ground(NamedTuple):
    """What tracks are relative to at a frame.

    Parameters
    ----------
    places, turns : complex128, shape (h,)
        Where the handles are without them, and by what factor the shape is turned there.
    """

    places: Complexes
    turns: Complexes


def have_one_ground(clip: Clip, other: Clip) -> bool:
    """Tell whether two clips of a figure differ in its tracks alone, if at all."""

    def source(of: Clip) -> tuple[object, ...]:
        figure = of.figure
        return (
            *(figure.id, figure.domain, figure.handles, figure.keys, figure.cycles, figure.anchor),
            *(figure.joints, figure.stillness, figure.springs, figure.variant, figure.bounds),
            *(id(figure.stiffness), figure.bones),
            *(of.frames, of.loop, of.fps, of.baseline, of.carriers),
        )

    return source(clip) == source(other)


def is_corrected(clip: Clip) -> bool:
    """Tell whether tracks or springs may change frames of a clip."""
    figure = clip.figure
    own = [each.enabled for each in figure.tracks] + [each.enabled for each in figure.springs]
    return clip.baseline is None and any(own)


class Corrections:
    """The corrections of a clip.

    Parameters
    ----------
    clip : Clip
    variant : Variant
    sampler : PoseSampler
        Of the figure's domain, at any points; what it knows of the outline is used, and kept there.
    carried : callable, optional
        Where the figure hangs, at a frame; by itself without.

    Attributes
    ----------
    clip : Clip
    """

    def __init__(
        self, clip: Clip, variant: Variant, sampler: PoseSampler, carried: Carried | None = None
    ) -> None:
        figure = clip.figure
        self.clip, self._variant = clip, variant
        self._known, self._guard = sampler.known.corrections, sampler.known.guard
        self._lock = threading.RLock()
        self._handles = slice(0, len(figure.handles))
        points = [handle.position for handle in figure.handles]
        # What hangs is held by its anchor.
        self._is_hung = figure.hangs and figure.anchor is not None
        if figure.anchor is not None and self._is_hung:
            points.append(figure.anchor)
        self._points = np.array(points, dtype=np.complex128)
        boundary = stiffened(figure, sampler.sites.boundary)
        self._of_what = (self._points.tobytes(), boundary.stiffness.tobytes(), figure.bounds)
        self._corrector = Corrector(boundary=boundary, points=self._points)
        own = PoseSampler(
            figure.domain,
            anchor=figure.anchor,
            points=np.concatenate([self._points, boundary.points]),
            sibling=sampler,
        )
        self._motion = BaseMotion(clip, variant, own)
        self._own = OwnClocks(clip, carried)

    def at(self, frame: float) -> FrameCorrection | None:
        """Return what is added to the motion at a frame; None where that is nothing."""
        with self._lock:
            if not self._own.acts(frame):
                return None
            base = self._base(frame)
            places, fz = base.positions[self._handles], base.fz[self._handles]
            # Told only now: if it were kept, nothing of this would go away with the last one who
            # has it.
            wanted = self._own.wanted(frame, places, fz, self._places)
            return None if wanted is None else self._gone(frame, base, wanted)

    @property
    def run_up(self) -> int:
        """Frames before a frame from which its correction follows."""
        return self._own.run_up

    @property
    def nbytes(self) -> int:
        """Bytes of what frames are found with."""
        return self._motion.nbytes + self._motion.sampler.extension_bytes

    def with_tracks(self, clip: Clip) -> "Corrections":
        """Return the corrections of a clip that differs in its tracks alone."""
        changed = copy(self)
        changed.clip = clip
        changed._own = self._own.with_tracks(clip)  # noqa: SLF001 - its own
        return changed

    def ground_at(self, frame: float) -> Ground:
        """Return what tracks are relative to at a frame."""
        with self._lock:
            base = self._base(frame)
            fz = base.fz[self._handles]
            return Ground(base.positions[self._handles], fz / np.abs(fz))

    def _places(self, frame: float) -> Complexes:
        """Return where the handles are at a frame before springs and tracks, (h,)."""
        return self._base(frame).positions[self._handles]

    def _base(self, frame: float) -> Jet:
        found, count = self._motion.frame(frame), len(self._points)
        return Jet(
            f=found.fz[count:],
            g=found.fzbar[count:].conj(),
            positions=found.positions[:count],
            fz=found.fz[:count],
        )

    def _gone(self, frame: float, base: Jet, wanted: Wanted) -> FrameCorrection:
        """Return the correction by which handles go their own ways."""
        # Those beside one that goes its own way give way: held as firmly, they tear at it.
        away, held = self._away_from(np.flatnonzero(wanted.firmness)), self._held(frame)
        firmness = np.where(wanted.firmness > 0, wanted.firmness, away * (1.0 + held) - 1.0)
        places = base.positions.copy()
        places[self._handles] = wanted.places
        pins = self._pins(places, firmness, wanted.turns, wanted.reach)

        def solve() -> FrameCorrection:
            found = self._corrector.correct(base, pins, self.clip.figure.bounds)
            phi, psi = self._anchored(found)
            handles = self.clip.figure.handles
            tracked = [i for i, handle in enumerate(handles) if handle.id in wanted.tracked]
            return FrameCorrection(
                phi=phi,
                psi=psi,
                misses={handles[i].id: float(found.misses[i]) for i in tracked},
                wishes={handles[i].id: complex(wanted.places[i]) for i in tracked},
                limits=self._limits(base, found),
                steps=found.steps,
            )

        return self._remembered((*self._whose(frame), *_content(wanted)), solve)

    def _held(self, frame: float) -> Floats:
        """Return how much auto-pins hold the handles at a frame, from 0 to 1, (h,)."""
        moment = time_of(self.clip, frame)
        segments = pinned_segments(self.clip)
        segment = segments[moment.interval] if segments else None
        count = len(self.clip.figure.handles)
        return np.zeros(count) if segment is None else segment.weights(moment.weight)

    def _limits(self, base: Jet, found: Corrected) -> tuple[str, ...]:
        """Return what the bounds hold back of a correction that is found of a base."""
        if not found.is_held_back:
            return ()
        at = base.advanced(1.0, found.change)
        return Extremes.measured(at.f, at.g).reached(self.clip.figure.bounds)

    def _pins(self, places: Complexes, firmness: Floats, turns: Floats, reach: float) -> Pins:
        """Return what is wanted of the points; what hangs is held by its anchor.

        A handle next to the anchor hardly goes anywhere: held as firmly, it would tear at it.
        """
        more = len(places) - len(firmness)
        if more:
            firmness = firmness * self._away_from(np.array([len(places) - 1]))
        return Pins(
            places,
            np.concatenate([firmness, np.ones(more)]),
            np.concatenate([turns, np.full(more, np.nan)]),
            reach,
        )

    def _away_from(self, others: Indices) -> Floats:
        """Return how far the handles are from some points, (h,): 0 at the nearest, 1 if far."""
        away = np.abs(self._points[self._handles, None] - self._points[others]).min(axis=1)
        size = self._corrector.boundary.size
        far: Floats = -np.expm1(-((away / (BESIDE * size)) ** 2))
        return far

    def _remembered(
        self, key: tuple[object, ...], solve: Callable[[], FrameCorrection]
    ) -> FrameCorrection:
        """Return the correction that is known by a key, solved where it is not."""
        with self._guard:
            known = self._known.pop(key, None)
        if known is None:
            known = solve()
        with self._guard:
            while len(self._known) > KEPT // max(known.nbytes, 1):
                del self._known[next(iter(self._known))]
            self._known[key] = known
        return known

    def _anchored(self, corrected: Corrected) -> tuple[Complexes, Complexes]:
        """Return the coefficients of a correction that leaves the anchor of what hangs in place."""
        phi = corrected.phi
        if self._is_hung:
            phi = phi.copy()
            phi[: len(self.clip.figure.domain.cage)] -= corrected.change.positions[-1]
        return phi, corrected.psi

    def _whose(self, frame: float) -> tuple[object, ...]:
        """Return what the motion of a frame follows from; the poses stay alive with it."""
        clip, moment = self.clip, time_of(self.clip, frame)
        resting = resting_pose(clip, moment)
        if resting is not None:
            return resting, *self._of_what
        pair = pair_of(clip, moment.interval, self._variant)
        return poses_of(clip, moment.interval), pair, moment.weight, *self._of_what


def _content(parts: Iterable[object]) -> tuple[object, ...]:
    """Return values by which what follows from them is known."""
    return tuple(each.tobytes() if isinstance(each, np.ndarray) else each for each in parts)

"""Changes of a clip's frames by sliders, springs and tracks.

Each frame is computed alone and cached by its content. Undo, copied keys and other windows of the
same layer thus find earlier results.
"""

import threading
from collections.abc import Callable, Iterable
from copy import copy
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from app.document import (
    SLIDER,
    Clip,
    DistortionRange,
    Layer,
    Variant,
    motion_anchor,
    motion_source,
    slider_poses,
    spring_root,
    stiffness_source,
)
from app.motion.inbetweens.keyframe_motion import KeyframeMotion
from app.motion.inbetweens.pins.auto_pins import AutoPins, firmness_at, prepare_corrector
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.secondary_correction import SecondaryCorrection, SolvedSliders
from app.motion.inbetweens.secondary_motion import SecondaryMotion, SecondaryTargets
from app.motion.inbetweens.segment_keys import frame_content
from app.motion.inbetweens.spring_offsets import ParentMotion
from engine.arrays import Complexes, Floats
from engine.deform.correction.point_targets import PointTargets
from engine.interpolation import CorrectionBase, Inbetweens, correct_frame, evaluate_base

KEPT = 2**26  # bytes of cached corrections per outline
# Per L: the pull of a track at which its target error is L. At a tenth of it, which within reach
# hardly any track needs, the target error is a thousandth. Less is calmer, and less exact.
FORCE = 64.0
# Number of outline points that hold the shape if a track's reach is small, and their largest and
# smallest firmness. The smallest has no effect.
HELD, HELD_BY, LEAST_HELD = 64, 75.0, 1e-9
STILL = 32  # number of outline points, of which some stay where springs swing


class BaseMotionFrame(NamedTuple):
    """The frame that tracks are relative to.

    `positions` (h,) are the places of the handles without tracks. `rotations` (h,) are the factors,
    of modulus 1, by which the shape turns there.
    """

    positions: Complexes
    rotations: Complexes


def have_same_base_frames(clip: Clip, other: Clip, *, values: bool = True) -> bool:
    """Return whether two clips of a layer differ at most in tracks.

    Without `values`, they may also differ in values of sliders.
    """

    def source(of: Clip) -> tuple[object, ...]:
        layer, own = (
            of.layer,
            of.sliders if values else tuple(each.slider.name for each in of.sliders),
        )
        # The layer's own transform and its parents drive springs.
        others = {each: keys for each, keys in layer.channels.items() if each[0] != SLIDER.name}
        alone = motion_source(replace(layer, tracks=(), sliders=(), channels=others))
        return (
            *(alone, stiffness_source(layer), slider_poses(of), own),
            *(of.frames, of.loop, of.fps, of.baseline, of.parents),
        )

    return source(clip) == source(other)


def needs_correction(clip: Clip) -> bool:
    """Return whether sliders, tracks or springs may change frames of a clip."""
    layer = clip.layer
    own = [each.enabled for each in layer.tracks] + [each.enabled for each in layer.springs]
    return clip.baseline is None and (any(own) or bool(clip.sliders))


class FrameCorrector:
    """The corrections of a clip.

    The sampler belongs to the layer's domain, at any points. Its cached data of the outline is used
    and extended. `carried` returns the rigid motion of the layer at a frame, by default the
    identity.
    """

    def __init__(
        self,
        clip: Clip,
        variant: Variant,
        sampler: PoseSampler,
        carried: ParentMotion | None = None,
    ) -> None:
        layer = clip.layer
        self.clip, self._variant, self._carried = clip, variant, carried
        self._known, self._guard = sampler.known.corrections, sampler.known.guard
        self._lock = threading.RLock()
        self._is_anchored = layer.has_parent and layer.anchor is not None
        self._points = np.array([each.position for each in layer.handles], dtype=np.complex128)
        pins = AutoPins(clip, variant, sampler)
        gives = any(track.enabled and track.reach < 1.0 for track in layer.tracks)
        count, outline = HELD if gives else 0, layer.domain.outline
        self._outline = outline[np.linspace(0, len(outline), count, endpoint=False).astype(np.intp)]
        self._still = _find_still_points(layer)
        if not gives and not layer.bone_joints:
            self._corrector, own = pins.prepare()
        else:
            held = np.append(self._outline, self._still)
            self._corrector, own = prepare_corrector(layer, sampler, held if len(held) else None)
        stiffness = self._corrector.boundary.stiffness
        self._of_what = (
            *(self._corrector.points.tobytes(), stiffness.tobytes(), layer.widest_bounds),
            *(motion_anchor(layer), self._is_anchored, variant),
        )
        self._motion = KeyframeMotion(clip, variant, own, pins)
        self._own = SecondaryMotion(clip, carried)

    def correction_at(self, frame: float) -> SecondaryCorrection | None:
        """Return the correction at a frame; None without one."""
        with self._lock:
            stage = self._motion.sliders
            sliders = None if stage is None else stage.solved_at(frame)
            alone = None if sliders is None else SecondaryCorrection(sliders=sliders)
            if not self._own.is_active(frame):
                return alone
            base, count = self._base(frame), len(self._points)
            # Passed here and not stored: a stored bound method would be a reference cycle, and the
            # object would outlive its last user.
            wanted = self._own.targets_at(frame, base.places[:count], base.fz[:count], self._places)
            if wanted is None:
                return alone
            return self._solve_correction(frame, base, wanted, sliders)

    @property
    def run_up(self) -> int:
        """Number of earlier frames that affect the correction of a frame."""
        return self._own.run_up

    @property
    def nbytes(self) -> int:
        """Bytes of the data from which frames are computed."""
        return self._motion.nbytes + self._motion.sampler.extension_bytes

    def with_values(self, clip: Clip) -> "FrameCorrector":
        """Return the corrections of a clip that differs only in tracks and values of sliders."""
        changed = copy(self)
        changed.clip = clip
        changed._own = self._own.with_tracks(clip)  # noqa: SLF001 - its own
        if clip.sliders != self.clip.sliders:
            changed._motion = self._motion.with_sliders(clip)  # noqa: SLF001
            changed._own = SecondaryMotion(clip, self._carried)  # noqa: SLF001
        return changed

    def base_frame_at(self, frame: float) -> BaseMotionFrame:
        """Return the frame that tracks are relative to."""
        with self._lock:
            found, count = self._motion.frame(frame), len(self._points)
            fz = found.fz[:count]
            return BaseMotionFrame(found.positions[:count], fz / np.abs(fz))

    def _places(self, frame: float) -> Complexes:
        """Return the positions of the handles at a frame before springs and tracks, (h,)."""
        return self._motion.frame(frame).positions[: len(self._points)]

    def _base(self, frame: float) -> CorrectionBase:
        inbetweens, time = self._motion.segment_at(frame)
        return evaluate_base(inbetweens, self._corrector, time)

    def _solve_correction(
        self,
        frame: float,
        base: CorrectionBase,
        wanted: SecondaryTargets,
        sliders: SolvedSliders | None,
    ) -> SecondaryCorrection:
        """Return the correction that brings the handles of a base with sliders to their targets."""
        targets, bounds = self._targets(base, wanted), self.clip.layer.widest_bounds

        def solve() -> SecondaryCorrection:
            inbetweens, time = self._motion.segment_at(frame)
            proven = inbetweens if isinstance(inbetweens, Inbetweens) else None
            found = correct_frame(proven, self._corrector, base, time, targets, bounds)
            handles = self.clip.layer.handles
            tracked = [i for i, handle in enumerate(handles) if handle.id in wanted.tracked]
            reached = DistortionRange(*found.reached)
            return SecondaryCorrection(
                sliders=sliders,
                series=found.known,
                target_errors={handles[i].id: float(found.target_errors[i]) for i in tracked},
                targets={handles[i].id: complex(wanted.positions[i]) for i in tracked},
                limits=reached.reached(bounds) if found.is_limited else (),
                steps=found.steps,
            )

        base_content = frame_content(self.clip, frame, self._variant)
        return self._remembered((base_content, self._of_what, *_content(wanted)), solve)

    def _targets(self, base: CorrectionBase, wanted: SecondaryTargets) -> PointTargets:
        """Return targets of handles with tracks and springs; others keep their places.

        With bones, so does the drawing beyond a spring's arm: soles stay on the ground while a tail
        swings. What is close to a target, or to a fixed anchor, has less firmness, since it would
        tear the drawing.
        """
        count, more = len(self._points), len(self._outline) + len(self._still)
        size, moved = self._corrector.boundary.size, self._points[wanted.has_target]
        weights = np.where(wanted.has_target, 1.0, self._away_from(self._points, moved))
        # A track may lead any part.
        at_still = self._away_from(self._still, moved) * (not wanted.tracked)
        if self._is_anchored:
            anchor = np.array([self.clip.layer.anchor])
            weights = weights * self._away_from(self._points, anchor)
            at_still = at_still * self._away_from(self._still, anchor)
        # The rest of the outline is held more firmly for a smaller reach.
        held = HELD_BY * (1.0 - wanted.reach) ** 2
        give = len(self._outline) * size**2 / max(held, LEAST_HELD)
        return PointTargets(
            offsets=np.append(wanted.positions - base.places[:count], np.zeros(more)),
            weights=np.concatenate([weights, np.ones(len(self._outline)), at_still]),
            is_anchored=self._is_anchored,
            yield_forces=np.append(
                np.where(wanted.has_target, FORCE / size, np.inf), np.full(more, np.inf)
            ),
            rotations=np.append(wanted.rotations, np.full(more, np.nan)),
            compliances=np.concatenate(
                [np.zeros(count), np.full(len(self._outline), give), np.zeros(len(self._still))]
            ),
        )

    def _away_from(self, places: Complexes, others: Complexes) -> Floats:
        """Return the firmness at places near some points: 0 at a point, 1 far away."""
        away = np.abs(places[:, None] - others).min(axis=1, initial=np.inf)
        return firmness_at(away / self._corrector.boundary.size)

    def _remembered(
        self, key: tuple[object, ...], solve: Callable[[], SecondaryCorrection]
    ) -> SecondaryCorrection:
        """Return the cached correction of a key, solved if missing."""
        with self._guard:
            known = self._known.pop(key, None)
        if known is None:
            known = solve()
        with self._guard:
            while len(self._known) > KEPT // max(known.nbytes, 1):
                del self._known[next(iter(self._known))]
            self._known[key] = known
        return known


def _find_still_points(layer: Layer) -> Complexes:
    """Return points of the outline that stay where they are as springs swing; none without bones.

    They are nearer to other handles than to handles with springs and those about which they swing.
    """
    springs = [spring for spring in layer.springs if spring.enabled]
    if not (springs and layer.bone_joints):
        return np.zeros(0, dtype=np.complex128)
    arms = {spring.handle for spring in springs}
    arms |= {root for spring in springs if (root := spring_root(layer, spring)) is not None}
    outline = np.concatenate(layer.domain.loops)
    outline = outline[np.linspace(0, len(outline), STILL, endpoint=False).astype(np.intp)]
    handles = np.array([handle.position for handle in layer.handles])
    nearest = np.abs(outline[:, None] - handles).argmin(axis=1)
    is_arm = np.array([handle.id in arms for handle in layer.handles])
    return np.asarray(outline[~is_arm[nearest]])


def _content(parts: Iterable[object]) -> tuple[object, ...]:
    """Return hashable values; arrays become their bytes."""
    return tuple(each.tobytes() if isinstance(each, np.ndarray) else each for each in parts)

"""Samples of poses at points of a layer, and in-betweens there."""

import threading
from collections.abc import Callable, Sequence, Set as AbstractSet
from functools import partial
from typing import TypeVar

import numpy as np

from app.document import Layer, Pose, PoseSegment, Variant, motion_anchor
from app.motion.inbetweens.content_cache import digest
from app.motion.inbetweens.outline_cache import (
    SAMPLED,
    OutlineCache,
    Sized,
    have_same_outline,
    nbytes_or_0,
)
from engine.arrays import Complexes, Integers, freeze, nbytes_of
from engine.dirichlet import Extension
from engine.domain import MeshedDomain
from engine.interpolation import (
    BLENDS,
    CorrectionSeries,
    EndCondition,
    Frame,
    Inbetweens,
    InteriorKnot,
    KeyframeBlend,
    KeyframeSamples,
    KeyframeSegment,
    SampledDomain,
    SpanBasis,
    Tangent,
    TimeWeights,
    frame_at,
    prepare_inbetweens,
    sample_domain,
    sample_keyframes,
)
from engine.maps import Boundary, Bounds, HarmonicMap
from engine.paths import root_sheets

Cached = TypeVar("Cached", bound=Sized)


class PoseSampler:
    """Points of a layer for its in-betweens, with the samples of poses there.

    The samples of each pose are cached; poses are frozen, so samples stay valid. The class is
    thread-safe. `forget_extension` frees `extension_bytes` bytes. Raises an `EngineError` if a
    point or the anchor is outside the domain.

    Parameters
    ----------
    domain : MeshedDomain, optional
        The layer's domain on another mesh.
    points : complex128, shape (m,), optional
        By default the vertices of the domain's mesh.
    values_at : complex128, shape (v,), optional
        Additional points that need values without derivatives; only with `points`.
    sibling : PoseSampler, optional
        Shares the data that depends on outline and cages alone, if these are the same.
    """

    def __init__(
        self,
        layer: Layer,
        *,
        domain: MeshedDomain | None = None,
        points: Complexes | None = None,
        values_at: Complexes | None = None,
        sibling: "PoseSampler | None" = None,
    ) -> None:
        domain, anchor = domain or layer.domain, motion_anchor(layer)
        if sibling is not None and not have_same_outline(domain, sibling.domain):
            sibling = None
        self.domain: MeshedDomain = domain
        self._anchor = anchor
        triangles = domain.mesh.triangles if points is None else None
        points = domain.mesh.vertices if points is None else points
        # Content that determines the samples.
        content = digest(*domain.loops, *domain.cages, points, triangles, values_at)
        self._content = content, anchor
        known = None if sibling is None else sibling.sites.boundary

        def prepare() -> SampledDomain:
            return sample_domain(
                known or Boundary.sample(domain),
                points,
                triangles=triangles,
                anchor=anchor,
                values_at=() if values_at is None else values_at,
            )

        self.sites: SampledDomain = SAMPLED.find(
            ("sites", *self._content), prepare, partial(nbytes_of, but=(known,))
        )
        self._lock = threading.RLock()
        self._samples: dict[Pose, KeyframeSamples] = {}
        self._basis: SpanBasis | None = None
        self._basis_lock = threading.Lock()
        self._extension: Extension | None = None
        self.extension_bytes = 0
        # A lock of its own, so that no other method waits for the extension.
        self._extension_lock = threading.RLock()
        self.known: OutlineCache = OutlineCache(domain) if sibling is None else sibling.known

    def is_for(self, layer: Layer) -> bool:
        """Return whether in-betweens of a layer, on any of its meshes, are computed here."""
        return have_same_outline(self.domain, layer.domain) and self._anchor == motion_anchor(layer)

    @property
    def extension(self) -> Extension:
        """The transform at the nodes of the paths, computed on first use."""
        with self._extension_lock:
            if self._extension is None:
                transform = self.known.transform
                make = partial(transform.at, self.sites.paths.nodes, single=True)
                self._extension = SAMPLED.find(("extension", *self._content), make, nbytes_or_0)
                self.extension_bytes = self._extension.nbytes
            return self._extension

    def forget_extension(self) -> None:
        """Drop the transform at the nodes, most of the memory of a layer that is not edited."""
        with self._extension_lock:
            self._extension, self.extension_bytes = None, 0
        SAMPLED.forget(("extension", *self._content))

    def keep_only(self, poses: AbstractSet[Pose]) -> None:
        """Drop the samples of other poses."""
        with self._lock:
            self._samples = {p: s for p, s in self._samples.items() if p in poses}
        self.known.keep_tangents(poses)

    def samples(self, pose: Pose) -> KeyframeSamples:
        with self._lock:
            if pose not in self._samples:
                f = HarmonicMap(
                    cage=self.domain.cage,
                    phi=pose.phi,
                    psi=pose.psi,
                    holes=self.domain.holes,
                    logs=pose.logs,
                )
                self._samples[pose] = self.find(
                    "samples",
                    digest(pose.phi, pose.psi, pose.logs),
                    lambda: sample_keyframes([f], self.sites)[0],
                )
            return self._samples[pose]

    def inbetweens(
        self, first: Pose, second: Pose, variant: Variant, *, turns: int = 0
    ) -> Inbetweens:
        """Return the in-betweens of two poses alone, with additional full turns."""
        samples = [self.samples(first), self.samples(second)]
        sheets = self._sheets(samples, (turns,))
        interval = self._interval(KeyframeBlend.of(samples, sheets), variant, Bounds())
        return self._prepared(interval, variant)

    def still_inbetweens(self, pose: Pose, variant: Variant) -> Inbetweens:
        """Return the in-betweens of a pose with itself, which are corrected like their neighbours.

        A variant with a transform or a scale has the same in-betweens as η here.
        """
        kind = Variant.ETA if variant.needs_transform or variant.is_scaled else variant
        return self.inbetweens(pose, pose, kind)

    @property
    def basis(self) -> SpanBasis:
        """The functions of the domain's span at the nodes, computed on first use."""
        with self._basis_lock:
            if self._basis is None:
                sites = self.sites
                self._basis = SpanBasis.of(sites.boundary.span, sites.paths.nodes)
            return self._basis

    def find(self, kind: str, content: bytes, compute: Callable[[], Cached]) -> Cached:
        """Return cached data of a kind at these points by its content, computed if missing."""
        return SAMPLED.find((kind, *self._content, content), compute, nbytes_or_0)

    def inbetweens_of(self, segment: PoseSegment, bounds: Bounds, variant: Variant) -> Inbetweens:
        """Return the in-betweens of a segment; motion through smooth keys keeps the limits."""
        return self._prepared(self.segment_of(segment, bounds, variant), variant)

    def makes_single_frames(self, variant: Variant) -> bool:
        """Return whether a single in-between takes less time than the whole segment."""
        return variant.needs_transform and self.sites.closer is None

    def frame_of(
        self,
        segment: PoseSegment,
        bounds: Bounds,
        variant: Variant,
        weight: float,
        pins: CorrectionSeries | None = None,
    ) -> Frame:
        """Return the in-between at the time `weight`, with pins; needs `makes_single_frames`."""
        return frame_at(weight, variant, self.segment_of(segment, bounds, variant), pins)

    def velocity_shares(
        self, segment: PoseSegment, bounds: Bounds, variant: Variant
    ) -> tuple[float, float]:
        """Return the share of its velocity that the limits allow at both keys.

        From 0, a stop, to 1. A key without a smooth tangent has 1.
        """
        start, end = (
            end.velocity_share if isinstance(end, Tangent) else 1.0
            for end in self._ends(segment, bounds, variant)
        )
        return start, end

    def _ends(self, segment: PoseSegment, bounds: Bounds, variant: Variant) -> list[EndCondition]:
        return [
            self._tangent([segment.keys[index].pose for index in window], end, bounds, variant)
            if isinstance(end, InteriorKnot)
            else end
            for end, window in zip((segment.start, segment.end), segment.windows, strict=True)
        ]

    def _tangent(
        self, poses: Sequence[Pose], joint: InteriorKnot, bounds: Bounds, variant: Variant
    ) -> Tangent:

        def make() -> Tangent:
            maps = [self.samples(pose).map for pose in poses]
            return BLENDS[variant].tangent(maps, joint, bounds, self.sites.boundary)

        return self.known.tangent((tuple(poses), joint, bounds, variant), make)

    def weights_of(self, segment: PoseSegment, bounds: Bounds, variant: Variant) -> TimeWeights:
        """Return the time weights of a segment's keys."""
        ends = self._ends(segment, bounds, variant) if segment.has_smooth_tangent else (1.0, 1.0)
        return TimeWeights.between(*ends, apart=segment.apart)

    def segment_of(self, segment: PoseSegment, bounds: Bounds, variant: Variant) -> KeyframeSegment:
        """Return a segment as the engine needs it, sampled here."""
        samples = [self.samples(key.pose) for key in segment.keys]
        if not segment.has_smooth_tangent:
            keyframe_blend = KeyframeBlend.of(samples, self._sheets(samples, segment.revolutions))
            return self._interval(keyframe_blend, variant, Bounds())
        count = len(samples) - sum(segment.apart)
        sheets = [*self._sheets(samples[:count], segment.revolutions[: count - 1])]
        # The outer keys of other cycles are reached from the middle keys of their windows.
        others = zip(range(count, len(samples)), segment.revolutions[count - 1 :], strict=True)
        for side, (_, middle, _) in enumerate(segment.windows):
            if segment.apart[side]:
                other, turns = next(others)
                pair = [middle, other] if side == 0 else [other, middle]
                change = int(self._sheets([samples[each] for each in pair], (turns,))[1])
                sheets.append(sheets[middle] + (change if side == 0 else -change))
        weights = self.weights_of(segment, bounds, variant)
        keyframe_blend = KeyframeBlend.of(samples, freeze(np.array(sheets, np.int32)), weights)
        return self._interval(keyframe_blend, variant, bounds)

    def _sheets(self, samples: Sequence[KeyframeSamples], turns: Sequence[int]) -> Integers:
        """Return the branches of the logarithms, with full turns between neighbours."""
        if self._anchor is None:
            return self.known.sheets(samples, turns, self.sites.boundary)
        return root_sheets(np.array([each.anchor_fz for each in samples]), turns)

    def _prepared(self, interval: KeyframeSegment, variant: Variant) -> Inbetweens:
        """Prepare in-betweens; all samplers of the domain share the solution on the boundary."""
        if not variant.needs_transform:
            return prepare_inbetweens(variant, interval)
        weights, keys = interval.keyframe_blend.time_weights, interval.keyframe_blend.keyframes
        maps = (each for key in keys for each in (key.map.phi, key.map.psi, key.map.logs))
        content = digest(*self.domain.loops, *self.domain.cages, *maps)
        key = "residual", content, weights.ends, weights.one_sided, interval.bounds
        solve = partial(BLENDS[variant].on_boundary, interval)
        residual = SAMPLED.find(key, solve, nbytes_or_0)
        return prepare_inbetweens(variant, interval._replace(residual=residual))

    def _interval(self, blend: KeyframeBlend, variant: Variant, bounds: Bounds) -> KeyframeSegment:
        transform = self.extension if variant.needs_transform else None
        return KeyframeSegment(self.sites, blend, bounds, transform=transform)

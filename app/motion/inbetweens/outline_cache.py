"""Data shared by all samplers of one outline, computed on first use."""

import threading
from collections.abc import Callable, Sequence, Set as AbstractSet
from functools import partial
from typing import Protocol

import numpy as np

from app.document import Pose, Variant
from app.errors import report_progress
from app.motion.inbetweens.content_cache import ContentCache, digest
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.motion.inbetweens.segment_keys import SegmentKey
from engine.arrays import Integers
from engine.dirichlet import HilbertTransform
from engine.domain import MeshedDomain
from engine.interpolation import (
    CorrectionSeries,
    InteriorKnot,
    KeyframeSamples,
    Tangent,
    sample_domain,
    sample_keyframes,
)
from engine.maps import Boundary, Bounds, HarmonicMap
from engine.paths import root_sheets, shorter_turns
from engine.sliders import FrameSolution

# Caches of sampled outlines and keyframes, in bytes. Values that layers hold take no additional
# memory here. Transforms are the slowest to compute, so they have a cache of their own.
SAMPLED = ContentCache(96 * 2**20)
TRANSFORMS = ContentCache(32 * 2**20)


MAX_PINNED = 512  # segments with cached pins per outline
MAX_SLID = 1024  # frames with sliders per outline


# A tangent's poses, and the other values that determine it.
TangentKey = tuple[tuple[Pose, ...], InteriorKnot, Bounds, Variant]


class Sized(Protocol):
    @property
    def nbytes(self) -> int: ...


def nbytes_or_0(value: Sized | None) -> int:
    return 0 if value is None else value.nbytes


class OutlineCache:
    """Data shared by the samplers of one outline and cage, computed on first use.

    `corrections` of frames are cached by content, in the order of last use. Access to them needs
    `guard`, since several threads use them. `forget_transform` frees `nbytes` bytes.
    """

    def __init__(self, domain: MeshedDomain) -> None:
        self._domain = domain
        self._key = "transform", digest(*domain.loops, *domain.cages)
        # A lock of its own, so that other threads wait for the transform only.
        self._lock = threading.RLock()
        self._transform: HilbertTransform | None = None
        self.nbytes = 0
        self.corrections: dict[object, SecondaryCorrection] = {}
        self._tangents: dict[TangentKey, Tangent] = {}
        self.guard = threading.Lock()
        # With the poses whose ids are in the keys.
        self._pins: dict[SegmentKey, tuple[CorrectionSeries, tuple[Pose, ...]]] = {}
        self._slider_solutions: dict[object, FrameSolution] = {}

    def find_pins(self, pair: SegmentKey) -> CorrectionSeries | None:
        """Return the pins of a segment; None if they are not known."""
        with self.guard:
            known = self._pins.get(pair)
        return None if known is None else known[0]

    def pins_of(
        self, pair: SegmentKey, poses: tuple[Pose, ...], solve: Callable[[], CorrectionSeries]
    ) -> CorrectionSeries:
        """Return the pins of a segment, solved if missing."""
        with self.guard:
            known = self._pins.pop(pair, None)
        if known is None:
            known = solve(), poses
        with self.guard:
            self._pins[pair] = known
            while len(self._pins) > MAX_PINNED:
                del self._pins[next(iter(self._pins))]
        return known[0]

    def slider_solution(self, key: object, solve: Callable[[], FrameSolution]) -> FrameSolution:
        """Return the solution of a frame with sliders by its content, solved if missing."""
        with self.guard:
            known = self._slider_solutions.pop(key, None)
        if known is None:
            known = solve()
        with self.guard:
            self._slider_solutions[key] = known
            while len(self._slider_solutions) > MAX_SLID:
                del self._slider_solutions[next(iter(self._slider_solutions))]
        return known

    def tangent(self, key: TangentKey, find: Callable[[], Tangent]) -> Tangent:
        """Return the tangent at a smooth key, found if missing."""
        with self.guard:
            found = self._tangents.get(key)
        if found is None:
            found = find()
            with self.guard:
                self._tangents[key] = found
        return found

    def keep_tangents(self, poses: AbstractSet[Pose]) -> None:
        """Drop the tangents of other poses."""
        with self.guard:
            self._tangents = {k: t for k, t in self._tangents.items() if poses >= set(k[0])}

    def sheets(
        self, samples: Sequence[KeyframeSamples], turns: Sequence[int], boundary: Boundary
    ) -> Integers:
        """Return the branches of logarithms, with full turns between neighbours, as `root_sheets`.

        Without turns the shape turns the shorter way in the mean. The anchor is the engine's.
        """
        anchors = np.array([each.anchor_fz for each in samples])
        leads = np.array([self._lead(each.map, boundary) for each in samples])
        return root_sheets(anchors, shorter_turns(anchors, leads) + turns)

    def _lead(self, f: HarmonicMap, boundary: Boundary) -> float:
        """Return by how much a map turns the outline further than the anchor, in the mean."""
        outline = self._domain.outline

        def find() -> float:
            make = partial(sample_domain, boundary, outline)
            sites = SAMPLED.find(("outline", self._key), make, nbytes_or_0)
            arguments = sample_keyframes([f], sites)[0].log_fz.imag
            edges = np.abs(np.roll(outline, -1) - outline)
            weights = edges + np.roll(edges, 1)
            mean = np.average(arguments[sites.paths.places], weights=weights)
            return float(mean - arguments[0])

        key = "lead", self._key, digest(f.phi, f.psi, f.logs)
        return SAMPLED.find(key, find, lambda _: 8)

    @property
    def transform(self) -> HilbertTransform:
        with self._lock:
            if self._transform is None:
                domain = self._domain
                make = partial(HilbertTransform.on, domain, progress=report_progress)
                self._transform = TRANSFORMS.find(self._key, make, nbytes_or_0)
                self.nbytes = self._transform.nbytes
            return self._transform

    def forget_transform(self) -> None:
        """Drop the transform, which can be computed again soon."""
        with self._lock:
            self._transform, self.nbytes = None, 0
        TRANSFORMS.forget(self._key)


def have_same_outline(one: MeshedDomain, other: MeshedDomain) -> bool:
    """Return whether two domains have the same loops and cages."""
    if one.cage is other.cage:
        return True
    first, second = ((*each.loops, *each.cages) for each in (one, other))
    return len(first) == len(second) and all(map(np.array_equal, first, second))

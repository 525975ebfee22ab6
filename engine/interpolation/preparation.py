"""From keyframes and points to in-betweens at any time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Integers
from engine.dirichlet import Extension, HilbertTransform, ProjectedTransform
from engine.errors import EngineError
from engine.interpolation.eta import EtaBlend
from engine.interpolation.inbetweens import (
    Blend,
    Frame,
    Inbetweens,
    IntegratedInbetweens,
    LinearInbetweens,
)
from engine.interpolation.keyframe_samples import KeyframeSamples, sample_keyframes
from engine.interpolation.metric import MetricBlend
from engine.interpolation.nu import NuBlend
from engine.interpolation.scaling import SharpScaling
from engine.interpolation.sites import Sites, prepare_sites
from engine.interpolation.smooth_scaling import Scaling
from engine.maps import HarmonicMap
from engine.paths import root_sheets
from engine.variant import Variant


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prepared:
    """In-betweens of all keyframes at any time; keyframe i is at time i.

    Frames are pure functions of frozen arrays: they may be asked for in any order, and on several
    threads at once.

    Parameters
    ----------
    variant : Variant
    sites : Sites
    keyframes : tuple of KeyframeSamples, length q
    intervals : tuple of Inbetweens, length q − 1
        One for each pair of neighbouring keyframes.
    """

    variant: Variant
    sites: Sites
    keyframes: tuple[KeyframeSamples, ...]
    intervals: tuple[Inbetweens, ...]

    @property
    def nbytes(self) -> int:
        """Memory that all of it takes, in bytes."""
        parts = (self.sites, *self.keyframes, *self.intervals)
        return sum(part.nbytes for part in parts)

    def frame(self, time: float) -> Frame:
        """Return the in-between at a time in [0, q − 1].

        Raises
        ------
        EngineError
            If the time is out of range.
        """
        last = len(self.intervals)
        if not 0.0 <= time <= last:
            raise EngineError(
                f"Time {time:g} is out of range: {last + 1} keyframes span the times from 0 to "
                f"{last}."
            )
        interval = min(int(time), last - 1)
        part = float(time) - interval
        return self.intervals[interval].frame(np.array([1.0 - part, part]))


def prepare(
    keyframes: Sequence[HarmonicMap],
    points: npt.ArrayLike,
    *,
    outline: npt.ArrayLike,
    variant: Variant | str = Variant.METRIC,
    triangles: npt.ArrayLike | None = None,
    anchor: npt.ArrayLike | None = None,
    turns: npt.ArrayLike | None = None,
    transform: HilbertTransform | None = None,
) -> Prepared:
    """Prepare the in-betweens of keyframes at points.

    Parameters
    ----------
    keyframes : sequence of HarmonicMap, length q ≥ 2
        Locally injective maps over one cage; the first need not be the identity.
    points : complex, shape (m,)
        In the closed domain, to 1e-9 of its diameter.
    outline : complex, shape (p,)
        The domain's boundary: simple, counter-clockwise, inside the cage.
    variant : Variant or str
    triangles, anchor
        As in `prepare_sites`.
    turns : int, shape (q − 1,), optional
        Full turns between neighbouring keyframes beyond the shorter way.
    transform : HilbertTransform, optional
        For the metric variant: of this outline, where the caller has it already.

    Raises
    ------
    EngineError
        If anything of that does not hold, or a keyframe folds.
    """
    maps = tuple(keyframes)
    variant = _known(variant)
    _require_keyframes(maps)
    sites = prepare_sites(outline, maps[0].cage, points, triangles=triangles, anchor=anchor)
    samples = sample_keyframes(maps, sites)
    sheets = root_sheets(np.array([key.anchor_fz for key in samples]), turns)
    extension: Extension | None = None
    if variant.needs_transform:
        transform = transform or HilbertTransform.on(sites.outline, sites.cage)
        _require_outline(transform.outline, sites)
        extension = transform.at(sites.paths.nodes)
    intervals = tuple(
        prepare_inbetweens(
            variant, sites, samples[i : i + 2], sheets[i : i + 2], transform=extension
        )
        for i in range(len(maps) - 1)
    )
    return Prepared(variant=variant, sites=sites, keyframes=samples, intervals=intervals)


def prepare_inbetweens(
    variant: Variant,
    sites: Sites,
    keyframes: Sequence[KeyframeSamples],
    sheets: Integers,
    *,
    transform: Extension | ProjectedTransform | None = None,
) -> Inbetweens:
    """Prepare the in-betweens of two neighbouring keyframes.

    What it is given is shared, not copied: sites by all keyframes, keyframes by the intervals on
    both sides.

    Parameters
    ----------
    variant : Variant
    sites : Sites
    keyframes : sequence of KeyframeSamples, length 2
    sheets : int32, shape (2,)
        From `root_sheets`.
    transform : Extension or ProjectedTransform, optional
        Of the sites' outline, at the nodes of their paths; variants that `needs_transform` says so
        of need it. The second kind makes rough in-betweens.

    Raises
    ------
    EngineError
        If there are not two keyframes, or the transform is missing or of another outline.
    """
    first, second = _two(keyframes)
    keys = (first, second)
    scale: Scaling | None = None
    blend: Blend
    match variant:
        case Variant.LINEAR:
            return LinearInbetweens.of(keys, sites)
        case Variant.NU:
            blend = NuBlend(keyframes=keys, sheets=sheets)
        case Variant.ETA:
            blend = EtaBlend.of(keys, sheets)
        case Variant.SCALED_ETA:
            blend = EtaBlend.of(keys, sheets)
            scale = Scaling.of(SharpScaling.of([key.map for key in keys], sites.outline))
        case Variant.METRIC:
            blend = MetricBlend.of(keys, sheets, sites.paths, _matching(transform, sites))
    return IntegratedInbetweens(sites=sites, keyframes=keys, blend=blend, scale=scale)


def _known(variant: Variant | str) -> Variant:
    try:
        return Variant(variant)
    except ValueError:
        names = ", ".join(Variant)
        raise EngineError(f"There is no variant {variant!r}; there are {names}.") from None


def _require_keyframes(maps: Sequence[HarmonicMap]) -> None:
    if len(maps) < 2:
        raise EngineError(f"In-betweens need at least two keyframes, not {len(maps)}.")
    for i, f in enumerate(maps):
        if not np.array_equal(f.cage, maps[0].cage):
            raise EngineError(f"Keyframe {i} has another cage than keyframe 0; they must share it.")


def _two(keyframes: Sequence[KeyframeSamples]) -> tuple[KeyframeSamples, KeyframeSamples]:
    if len(keyframes) != 2:
        raise EngineError(f"An interval has two keyframes, not {len(keyframes)}.")
    first, second = keyframes
    return first, second


def _matching(
    transform: Extension | ProjectedTransform | None, sites: Sites
) -> Extension | ProjectedTransform:
    """Refuse a transform of another domain, whose in-betweens would be wrong without a word."""
    if transform is None:
        raise EngineError("The metric variant needs a Hilbert transform of the outline.")
    _require_outline(transform.outline, sites)
    if not np.array_equal(transform.points, sites.paths.nodes):
        raise EngineError(
            "The Hilbert transform is prepared for other points; prepare it for the nodes of the "
            "sites' paths."
        )
    return transform


def _require_outline(outline: Complexes, sites: Sites) -> None:
    if not np.array_equal(outline, sites.outline):
        raise EngineError(
            f"The Hilbert transform is of another outline, of {len(outline)} vertices, than the "
            f"points', of {len(sites.outline)}; build it anew for this one."
        )

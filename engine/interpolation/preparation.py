"""From keyframes and points to in-betweens at any time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from engine.arrays import as_number, as_tuple, nbytes_of, require_kind
from engine.dirichlet import Extension, HilbertTransform
from engine.errors import EngineError
from engine.interpolation.blends.table import BLENDS
from engine.interpolation.inbetweens import Frame, Inbetweens
from engine.interpolation.keyframe_blend.derivatives import KeyframeBlend
from engine.interpolation.keyframe_blend.keyframe_samples import KeyframeSamples, sample_keyframes
from engine.interpolation.keyframe_blend.segment import KeyframeSegment
from engine.interpolation.one_segment import prepare_inbetweens
from engine.interpolation.sampled_domain import SampledDomain, sample_domain
from engine.interpolation.time_weights.weights import InteriorKnot, Tangent, TimeWeights
from engine.maps import Boundary, Bounds, HarmonicMap
from engine.paths import root_sheets
from engine.variant import Variant

TWO_KEYFRAMES = "In-betweens need at least two keyframes, not {count}."
OTHER_CAGE = (
    "Keyframe {number} has another cage than keyframe 0; all keyframes must have the same cage."
)
OTHER_BOUNDARY = (
    "The keyframes have another cage than the boundary samples; sample the boundary of the "
    "keyframes' own domain."
)
TIME_RANGE = "Time {time} is out of range: the keyframes span the times from 0 to {last}."


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prepared:
    """In-betweens of all keyframes at any time; keyframe i is at time i.

    Frames are pure functions of frozen arrays: any order and several threads are allowed.

    Attributes
    ----------
    segments : tuple of Inbetweens, length q − 1 or q
        One for each pair of neighbouring keyframes. A loop has one more, from the last keyframe to
        the first.
    tangents : tuple of float, length q
        Share of the full velocity at each keyframe: 0 is a stop, 1 the full velocity. Keyframes
        with a corner have 1, too.
    """

    variant: Variant
    sampled_domain: SampledDomain
    keyframes: tuple[KeyframeSamples, ...]
    segments: tuple[Inbetweens, ...]
    tangents: tuple[float, ...]

    @property
    def nbytes(self) -> int:
        return nbytes_of(self)

    def frame(self, time: float) -> Frame:
        """Return the in-between at a time from 0 to the number of segments.

        Raises
        ------
        EngineError
            If the time is out of range.
        """
        interval, moment = segment_at(time, len(self.segments))
        return self.segments[interval].frame(moment)


def segment_at(time: float, count: int) -> tuple[int, float]:
    """Return the index of the segment at a time, and the time within the segment, from 0 to 1.

    Raises
    ------
    EngineError
        If the time is not from 0 to `count`.
    """
    time = as_number(time, "time")
    if not 0.0 <= time <= count:
        raise EngineError(TIME_RANGE, time=time, last=count)
    interval = min(int(time), count - 1)
    return interval, time - interval


def prepare(
    keyframes: Sequence[HarmonicMap],
    boundary: Boundary,
    points: npt.ArrayLike,
    *,
    variant: Variant | str = Variant.METRIC,
    triangles: npt.ArrayLike | None = None,
    anchor: npt.ArrayLike | None = None,
    turns: npt.ArrayLike | None = None,
    transform: HilbertTransform | None = None,
    through: bool = False,
    loop: bool = False,
    bounds: Bounds = Bounds(),
    progress: Callable[[float], None] | None = None,
) -> Prepared:
    """Prepare the in-betweens of keyframes at points.

    Parameters
    ----------
    keyframes : sequence of HarmonicMap, length q ≥ 2
        Locally injective maps over one cage; the first need not be the identity.
    boundary : Boundary
        Boundary of the keyframes' domain, from `Boundary.sample`.
    points : complex, shape (m,)
        In the closed domain, to 1e-9 of its diameter.
    triangles, anchor
        As in `sample_domain`.
    turns : int, shape (q − 1,), or (q,) in a loop, optional
        Full turns between neighbouring keyframes beyond the shorter way.
    transform : HilbertTransform, optional
        Transform of this outline for the metric variant, if the caller already has one.
    through : bool
        Whether the velocity is continuous at keyframes between two others. The in-betweens of the
        paper have a corner there.
    loop : bool
        Whether the last keyframe leads on to the first one, which is at time q again.
    bounds : Bounds
        Bounds of the motion through keyframes, kept as far as the variant can. Keyframes beyond the
        bounds widen them for the neighbouring segments.
    progress : callable
        As in `HilbertTransform.on`. The transform may be the slowest part of the preparation.

    Raises
    ------
    EngineError
        If an argument breaks one of these conditions, or a keyframe folds.
    """
    maps = as_tuple(keyframes, "keyframes")
    variant = _known(variant)
    require_keyframes(maps)
    require_kind(boundary, Boundary, "boundary")
    if not boundary.span.equals(maps[0].span):
        raise EngineError(OTHER_BOUNDARY)
    sites = sample_domain(boundary, points, triangles=triangles, anchor=anchor)
    samples = sample_keyframes(maps, sites)
    around = (*samples, samples[0]) if loop else samples
    sheets = root_sheets(np.array([key.anchor_fz for key in around]), turns)
    extension: Extension | None = None
    if variant.needs_transform:
        transform = transform or HilbertTransform.on(boundary.domain, progress=progress)
        sites.require_boundary(transform.loops)
        extension = transform.at(sites.paths.nodes)
    joint = InteriorKnot(1.0, 1.0)  # keyframes are at whole times
    tangents: list[Tangent | None] = [
        BLENDS[variant].tangent(three, joint, bounds, sites.boundary) if through and three else None
        for three in _neighbourhoods(maps, loop=loop)
    ]
    intervals = []
    for i in range(len(around) - 1):
        ends = tangents[i], tangents[(i + 1) % len(maps)]
        time_weights = TimeWeights.between(*(1.0 if end is None else end for end in ends))
        window = np.arange(time_weights.count) + i - time_weights.first
        rounds, places = np.divmod(window, len(maps))
        keyframe_blend = KeyframeBlend.of(
            [samples[place] for place in places],
            sheets[places] + rounds.astype(np.int32) * (sheets[-1] - sheets[0]),
            time_weights,
        )
        interval = KeyframeSegment(sites, keyframe_blend, bounds, extension)
        intervals.append(prepare_inbetweens(variant, interval))
    return Prepared(
        variant=variant,
        sampled_domain=sites,
        keyframes=samples,
        segments=tuple(intervals),
        tangents=tuple(1.0 if tangent is None else tangent.velocity_share for tangent in tangents),
    )


def _known(variant: Variant | str) -> Variant:
    try:
        return Variant(variant)
    except ValueError:
        names = ", ".join(Variant)
        raise EngineError(
            "There is no variant {variant!r}; choose one of {names}.", variant=variant, names=names
        ) from None


def require_keyframes(maps: Sequence[HarmonicMap]) -> None:
    """Raise if there are fewer than two keyframes, or if their cages differ.

    Raises
    ------
    EngineError
        For the first violation.
    """
    if len(maps) < 2:
        raise EngineError(TWO_KEYFRAMES, count=len(maps))
    for i, f in enumerate(maps):
        require_kind(f, HarmonicMap, f"keyframe {i}")
        if not f.span.equals(maps[0].span):
            raise EngineError(OTHER_CAGE, number=i)


def _neighbourhoods(
    maps: Sequence[HarmonicMap], *, loop: bool
) -> list[tuple[HarmonicMap, HarmonicMap, HarmonicMap] | None]:
    """Return each map with both neighbours; None for an end without two neighbours."""
    last = len(maps) - 1
    return [
        (maps[i - 1], f, maps[(i + 1) % len(maps)]) if loop or 0 < i < last else None
        for i, f in enumerate(maps)
    ]

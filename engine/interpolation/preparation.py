"""From keyframes and points to in-betweens at any time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from engine.arrays import as_number, as_tuple, nbytes_of, require_kind
from engine.dirichlet import Extension, HilbertTransform
from engine.errors import EngineError
from engine.interpolation.blends import BLENDS
from engine.interpolation.inbetweens import Frame, Inbetweens
from engine.interpolation.keyframe_blend import (
    KeyframeBlend,
    KeyframeSamples,
    KeyframeSegment,
    sample_keyframes,
)
from engine.interpolation.one_segment import prepare_inbetweens
from engine.interpolation.sampled_domain import SampledDomain, sample_domain
from engine.interpolation.time_weights import InteriorKnot, Tangent, TimeWeights
from engine.maps import Boundary, Bounds, HarmonicMap
from engine.paths import root_sheets
from engine.variant import Variant

TWO_KEYFRAMES = "In-betweens need at least two keyframes, not {count}."
NO_MAP = "Keyframe {number} is a {kind}, not a harmonic map."
OTHER_CAGE = "Keyframe {number} has another cage than keyframe 0; they must share it."
OTHER_BOUNDARY = (
    "The keyframes have another cage than the boundary; sample the boundary of their own domain."
)
TIME_RANGE = "Time {time} is out of range: the keyframes span the times from 0 to {last}."


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prepared:
    """In-betweens of all keyframes at any time; keyframe i is at time i.

    Frames are pure functions of frozen arrays: they may be asked for in any order, and on several
    threads at once.

    Parameters
    ----------
    variant : Variant
    sites : SampledDomain
    keyframes : tuple of KeyframeSamples, length q
    intervals : tuple of Inbetweens, length q − 1 or q
        One for each pair of neighbouring keyframes; in a loop one more, from the last to the first.
    tangents : tuple of float, length q
        How much of its full velocity the motion has where it passes each keyframe, from 0, a stop,
        to 1; 1 too where it does not pass.
    """

    variant: Variant
    sampled_domain: SampledDomain
    keyframes: tuple[KeyframeSamples, ...]
    segments: tuple[Inbetweens, ...]
    tangents: tuple[float, ...]

    @property
    def nbytes(self) -> int:
        """Memory that all of it takes, in bytes."""
        return nbytes_of(self)

    def frame(self, time: float) -> Frame:
        """Return the in-between at a time from 0 to the number of intervals.

        Raises
        ------
        EngineError
            If the time is out of range.
        """
        interval, moment = segment_at(time, len(self.segments))
        return self.segments[interval].frame(moment)


def segment_at(time: float, count: int) -> tuple[int, float]:
    """Return in which of `count` intervals a time is, and when in it, from 0 to 1.

    Raises
    ------
    EngineError
        If the time is not from 0 to `count`.
    """
    time = as_number(time, "time")
    if not 0.0 <= time <= count:
        raise EngineError(TIME_RANGE.format(time=time, last=count))
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
        Of the keyframes' domain, from `Boundary.sample`.
    points : complex, shape (m,)
        In the closed domain, to 1e-9 of its diameter.
    variant : Variant or str
    triangles, anchor
        As in `prepare_sites`.
    turns : int, shape (q − 1,), or (q,) in a loop, optional
        Full turns between neighbouring keyframes beyond the shorter way.
    transform : HilbertTransform, optional
        For the metric variant: of this outline, where the caller has it already.
    through : bool
        Whether the velocity is continuous at keyframes between two others. The in-betweens of the
        paper have a corner there.
    loop : bool
        Whether the last keyframe leads on to the first one, which is at time q again.
    bounds : Bounds
        What motion through keyframes obeys, as far as the variant can; keyframes beyond them widen
        them for the intervals around.
    progress : callable
        As in `HilbertTransform.on`; of all that is prepared, its transform may take longest.

    Raises
    ------
    EngineError
        If anything of that does not hold, or a keyframe folds.
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
        course = TimeWeights.between(*(1.0 if end is None else end for end in ends))
        window = np.arange(course.count) + i - course.first
        rounds, places = np.divmod(window, len(maps))
        passage = KeyframeBlend.of(
            [samples[place] for place in places],
            sheets[places] + rounds.astype(np.int32) * (sheets[-1] - sheets[0]),
            course,
        )
        interval = KeyframeSegment(sites, passage, bounds, extension)
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
        raise EngineError(f"There is no variant {variant!r}; there are {names}.") from None


def require_keyframes(maps: Sequence[HarmonicMap]) -> None:
    """Refuse less than two keyframes, and such as have not one cage.

    Raises
    ------
    EngineError
        If they do not do.
    """
    if len(maps) < 2:
        raise EngineError(TWO_KEYFRAMES.format(count=len(maps)))
    for i, f in enumerate(maps):
        require_kind(f, HarmonicMap, f"keyframe {i}")
        if not f.span.equals(maps[0].span):
            raise EngineError(OTHER_CAGE.format(number=i))


def _neighbourhoods(
    maps: Sequence[HarmonicMap], *, loop: bool
) -> list[tuple[HarmonicMap, HarmonicMap, HarmonicMap] | None]:
    """Return each map with its neighbours; None for an end, which has not both."""
    last = len(maps) - 1
    return [
        (maps[i - 1], f, maps[(i + 1) % len(maps)]) if loop or 0 < i < last else None
        for i, f in enumerate(maps)
    ]

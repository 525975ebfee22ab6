"""From keyframes and points to in-betweens at any time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Integers
from engine.dirichlet import Extension, HilbertTransform
from engine.errors import EngineError
from engine.interpolation.blends import EtaBlend, MetricResidual, NuBlend, OutlineMetric
from engine.interpolation.derivatives import Passage
from engine.interpolation.inbetweens import (
    Blend,
    Frame,
    Inbetweens,
    IntegratedInbetweens,
    LinearInbetweens,
)
from engine.interpolation.keyframe_samples import KeyframeSamples, sample_keyframes
from engine.interpolation.passing import Course, Joint, Tangent, shortened
from engine.interpolation.periods import Closing, Open
from engine.interpolation.scaling import MetricRatios, Scaling, SharpScaling, Worst
from engine.interpolation.sites import Sites, prepare_sites
from engine.maps import Bounds, HarmonicMap, derivatives_of
from engine.paths import root_sheets
from engine.variant import Variant

# Number of times at which the metric variant is looked at around holes: whether it must be scaled.
LOOKED_AT = 24


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
    intervals : tuple of Inbetweens, length q − 1 or q
        One for each pair of neighbouring keyframes; in a loop one more, from the last to the first.
    tangents : tuple of float, length q
        How much of its full velocity the motion has where it passes each keyframe, from 0, a stop,
        to 1; 1 too where it does not pass.
    """

    variant: Variant
    sites: Sites
    keyframes: tuple[KeyframeSamples, ...]
    intervals: tuple[Inbetweens, ...]
    tangents: tuple[float, ...]

    @property
    def nbytes(self) -> int:
        """Memory that all of it takes, in bytes."""
        parts = (self.sites, *self.keyframes, *self.intervals)
        return sum(part.nbytes for part in parts)

    def frame(self, time: float) -> Frame:
        """Return the in-between at a time from 0 to the number of intervals.

        Raises
        ------
        EngineError
            If the time is out of range.
        """
        interval, moment = interval_at(time, len(self.intervals))
        return self.intervals[interval].frame(moment)


def interval_at(time: float, count: int) -> tuple[int, float]:
    """Return in which of `count` intervals a time is, and when in it, from 0 to 1.

    Raises
    ------
    EngineError
        If the time is not from 0 to `count`.
    """
    if not 0.0 <= time <= count:
        raise EngineError(
            f"Time {time:g} is out of range: the keyframes span the times from 0 to {count}."
        )
    interval = min(int(time), count - 1)
    return interval, float(time) - interval


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
    points : complex, shape (m,)
        In the closed domain, to 1e-9 of its diameter.
    outline : complex, shape (p,)
        The domain's boundary: simple, counter-clockwise, inside the cage.
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
    maps = tuple(keyframes)
    variant = _known(variant)
    require_keyframes(maps)
    sites = prepare_sites(
        outline,
        maps[0].cage,
        points,
        holes=maps[0].holes,
        triangles=triangles,
        anchor=anchor,
    )
    samples = sample_keyframes(maps, sites)
    around = (*samples, samples[0]) if loop else samples
    sheets = root_sheets(np.array([key.anchor_fz for key in around]), turns)
    extension: Extension | None = None
    if variant.needs_transform:
        transform = transform or HilbertTransform.on(
            sites.outline, sites.cage, sites.boundary.holes, progress=progress
        )
        _require_boundary(transform.loops, sites)
        extension = transform.at(sites.paths.nodes)
    joint = Joint(1.0, 1.0)  # keyframes are at whole times
    tangents: list[Tangent | None] = [
        shortened(variant, three, joint, bounds, sites.boundary) if through and three else None
        for three in _neighbourhoods(maps, loop=loop)
    ]
    intervals = []
    for i in range(len(around) - 1):
        ends = tangents[i], tangents[(i + 1) % len(maps)]
        course = Course.between(*(1.0 if end is None else end for end in ends))
        window = np.arange(course.count) + i - course.first
        rounds, places = np.divmod(window, len(maps))
        interval = prepare_inbetweens(
            variant,
            sites,
            [samples[place] for place in places],
            sheets[places] + rounds.astype(np.int32) * (sheets[-1] - sheets[0]),
            transform=extension,
            course=course,
            bounds=bounds,
        )
        intervals.append(interval)
    return Prepared(
        variant=variant,
        sites=sites,
        keyframes=samples,
        intervals=tuple(intervals),
        tangents=tuple(1.0 if tangent is None else tangent.kept for tangent in tangents),
    )


def prepare_inbetweens(
    variant: Variant,
    sites: Sites,
    keyframes: Sequence[KeyframeSamples],
    sheets: Integers,
    *,
    transform: Extension | None = None,
    course: Course | None = None,
    bounds: Bounds = Bounds(),
) -> Inbetweens:
    """Prepare the in-betweens of two neighbouring keyframes.

    What it is given is shared, not copied: sites by all keyframes, keyframes by the intervals on
    both sides.

    Parameters
    ----------
    variant : Variant
    sites : Sites
    keyframes : sequence of KeyframeSamples
        The two; with the one before them, the one after them, or both, where the course has
        tangents.
    sheets : int32, one for each
        From `root_sheets`.
    transform : Extension, optional
        Of the sites' outline, at the nodes of their paths; variants that `needs_transform` says so
        of need it.
    course : Course, optional
        By default the linear blend of the paper.
    bounds : Bounds
        That metric and a scaled variant obey along other courses; with the straight one they obey
        their keyframes' own.

    Raises
    ------
    EngineError
        If there are not as many keyframes as the course asks for, or the transform is missing or of
        another outline.
    """
    passage = Passage.of(keyframes, sheets, course)
    if variant is Variant.LINEAR:
        return LinearInbetweens.of(passage, sites)
    metric: MetricResidual | None = None
    if variant is Variant.METRIC:
        metric = MetricResidual.of(passage, bounds, sites.paths, _matching(transform, sites))
        passage = _with_residual(passage, metric)
    opened = passage
    closings = _closings(variant, sites, opened, metric)
    if closings:
        passage = replace(passage, residuals=(*passage.residuals, closings[0].residual))
    scale: Scaling | None = None
    if metric is not None and closings:
        ratios = _metric_ratios(sites, opened, metric, closings, bounds)
        if ratios(np.linspace(0.0, 1.0, LOOKED_AT + 2)[1:-1]).min() < 1.0:
            closings = _closings(variant, sites, opened, metric, is_scaled=True)
            scale = Scaling.of(_metric_ratios(sites, opened, metric, closings, bounds))
    if variant is Variant.SCALED_ETA:
        scaled = [key.map for key in passage.keyframes]
        scale = Scaling.of(SharpScaling.of(scaled, sites.outline, passage.course, bounds, closings))
    return IntegratedInbetweens(
        sites=sites,
        passage=passage,
        blend=_blend(variant, passage),
        scale=scale,
        metric=metric,
        closings=closings,
    )


def frame_at(
    time: float,
    variant: Variant,
    sites: Sites,
    keyframes: Sequence[KeyframeSamples],
    sheets: Integers,
    *,
    transform: Extension | None = None,
    course: Course | None = None,
    bounds: Bounds = Bounds(),
) -> Frame:
    """Return one in-between of two neighbouring keyframes, where no other is wanted yet.

    It is what `prepare_inbetweens` gives at that time. Of the metric variant it costs less, since
    one Dirichlet problem is solved and not one for each of the forms that the residual takes in the
    whole interval; around holes, and of other variants, as much.

    Parameters
    ----------
    time : float
        In [0, 1].
    variant, sites, keyframes, sheets, transform, course, bounds
        As in `prepare_inbetweens`.

    Raises
    ------
    EngineError
        As `prepare_inbetweens`, and if the time is out of range.
    """
    if not 0.0 <= time <= 1.0:
        raise EngineError(f"An interval runs from time 0 to 1; {time:g} is outside.")
    if variant is Variant.METRIC and sites.closing is None:
        passage = Passage.of(keyframes, sheets, course)
        extension = _matching(transform, sites)
        metric = MetricResidual.at(time, passage, bounds, sites.paths, extension)
        passage = _with_residual(passage, metric)
        moment = IntegratedInbetweens(
            sites=sites, passage=passage, blend=_blend(variant, passage), scale=None, metric=metric
        )
        return moment.frame(time)
    inbetweens = prepare_inbetweens(
        variant, sites, keyframes, sheets, transform=transform, course=course, bounds=bounds
    )
    return inbetweens.frame(time)


def _with_residual(passage: Passage, metric: MetricResidual) -> Passage:
    """Return the metric variant's passage: all but η keeps its velocities at keyframes."""
    return replace(
        passage,
        course=passage.course.full,
        eta_course=passage.course,
        residuals=(metric.residual,),
    )


def _blend(variant: Variant, passage: Passage) -> Blend:
    return NuBlend(passage=passage) if variant is Variant.NU else EtaBlend.of(passage)


def _closings(
    variant: Variant,
    sites: Sites,
    passage: Passage,
    metric: MetricResidual | None,
    *,
    is_scaled: bool = False,
) -> tuple[Closing, ...]:
    """Close the periods of in-betweens around holes: h, and d where Ψ is scaled."""
    if sites.closing is None:
        return ()
    at_loops = _blend(variant, passage.at(sites.paths.around))

    def opened(times: Floats) -> Open:
        lacking = None if metric is None else metric.lacking_at(times)
        return Open(*at_loops.values(times), lacking)

    sign = 1 if variant is Variant.NU else -1
    breaks = (0.0, 1.0) if metric is None else tuple(metric.residual.series.breaks)
    closing = sites.closing.close(opened, sign=sign, breaks=breaks)
    if not (is_scaled or variant is Variant.SCALED_ETA):
        return (closing,)
    return closing, sites.closing.to_conformal(opened, sign=sign, breaks=breaks)


def _metric_ratios(
    sites: Sites,
    passage: Passage,
    metric: MetricResidual,
    closings: tuple[Closing, ...],
    bounds: Bounds,
) -> MetricRatios:
    """Return the ρ that the metric variant around holes would have."""
    boundary = sites.boundary
    course = passage.eta_course or passage.course
    fz, fzbar = derivatives_of([key.map for key in passage.keyframes], boundary.points)
    a, b = np.abs(fz), np.abs(fzbar)
    worst = Worst(k=(b / a).max(), sigma_a=(a + b).max(), sigma_b=(a - b).min())
    counts = np.diff([*boundary.starts, len(boundary.points)])

    def lacking(times: Floats) -> Floats:
        missing = metric.lacking_at(times)
        around = np.column_stack([np.zeros(len(times)), missing])
        return np.repeat(around, counts, axis=1)

    functions = [closing.functions for closing in closings]
    (modes,) = boundary.span.evaluate(np.hstack(functions), boundary.points, orders=(0,))
    parts = np.split(modes, np.cumsum([f.shape[1] for f in functions])[:-1], axis=1)
    return MetricRatios(
        metric=OutlineMetric.of(fz, fzbar, course, bounds),
        lacking=lacking,
        worst=worst if course.is_straight else worst.widened(bounds),
        closings=tuple(zip(parts, (each.series for each in closings), strict=True)),
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
        raise EngineError(f"In-betweens need at least two keyframes, not {len(maps)}.")
    for i, f in enumerate(maps):
        if not f.span.equals(maps[0].span):
            raise EngineError(f"Keyframe {i} has another cage than keyframe 0; they must share it.")


def _neighbourhoods(
    maps: Sequence[HarmonicMap], *, loop: bool
) -> list[tuple[HarmonicMap, HarmonicMap, HarmonicMap] | None]:
    """Return each map with its neighbours; None for an end, which has not both."""
    last = len(maps) - 1
    return [
        (maps[i - 1], f, maps[(i + 1) % len(maps)]) if loop or 0 < i < last else None
        for i, f in enumerate(maps)
    ]


def _matching(transform: Extension | None, sites: Sites) -> Extension:
    """Refuse a transform of another domain, whose in-betweens would be wrong without a word."""
    if transform is None:
        raise EngineError("The metric variant needs a Hilbert transform of the outline.")
    _require_boundary(transform.loops, sites)
    if not np.array_equal(transform.points, sites.paths.nodes):
        raise EngineError(
            "The Hilbert transform is prepared for other points; prepare it for the nodes of the "
            "sites' paths."
        )
    return transform


def _require_boundary(loops: Sequence[Complexes], sites: Sites) -> None:
    own = sites.boundary.loops
    if len(loops) != len(own) or not all(map(np.array_equal, loops, own)):
        raise EngineError(
            f"The Hilbert transform is of another outline, of {sum(map(len, loops))} vertices, "
            f"than the points', of {sum(map(len, own))}; build it anew for this one."
        )

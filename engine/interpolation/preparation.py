"""From keyframes and points to in-betweens at any time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from engine.arrays import Integers, readonly
from engine.dirichlet import HilbertTransform, ProjectedTransform
from engine.errors import EngineError
from engine.interpolation.eta import EtaBlend
from engine.interpolation.inbetweens import (
    Blend,
    Frame,
    Inbetweens,
    IntegratedInbetweens,
    LinearInbetweens,
    Scale,
)
from engine.interpolation.keyframe_samples import KeyframeSamples, sample_keyframes
from engine.interpolation.metric import MetricBlend
from engine.interpolation.nu import NuBlend
from engine.interpolation.scaling import Scaling
from engine.interpolation.sites import Sites, prepare_sites
from engine.interpolation.smooth_scaling import SmoothScaling
from engine.interpolation.timing import Easing, Moment, eased_moment, linear, spline_moment
from engine.maps import HarmonicMap
from engine.paths import root_sheets

AnchorCurve = Callable[[float], complex]


class Variant(StrEnum):
    """How the derivatives of the keyframes are blended."""

    NU = "nu"
    ETA = "eta"
    SCALED_ETA = "scaled-eta"
    METRIC = "metric"
    LINEAR = "linear"


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
    pieces : tuple of Inbetweens
        One for each pair of neighbouring keyframes, or one for all of them with spline weights.
    easing : callable or None
        From the fraction of an interval's time to the fraction of its way; None for spline weights.
    anchor_curve : callable or None
        The anchor's position at each time; None where it is blended like the rest.
    """

    variant: Variant
    sites: Sites
    keyframes: tuple[KeyframeSamples, ...]
    pieces: tuple[Inbetweens, ...]
    easing: Easing | None
    anchor_curve: AnchorCurve | None

    @property
    def nbytes(self) -> int:
        """Memory that all of it takes, in bytes."""
        parts = (self.sites, *self.keyframes, *self.pieces)
        return sum(part.nbytes for part in parts)

    def frame(self, time: float) -> Frame:
        """Return the in-between at a time in [0, q − 1].

        Raises
        ------
        EngineError
            If the time is out of range.
        """
        moment = self._moment(float(time))
        piece = self.pieces[moment.first]
        position = None if self.anchor_curve is None else complex(self.anchor_curve(float(time)))
        return piece.frame(moment.weights, anchor_position=position)

    def _moment(self, time: float) -> Moment:
        if self.easing is None:
            return spline_moment(time, len(self.keyframes))
        return eased_moment(time, len(self.keyframes), self.easing)


def prepare(
    keyframes: Sequence[HarmonicMap],
    points: npt.ArrayLike,
    *,
    outline: npt.ArrayLike,
    variant: Variant | str = Variant.METRIC,
    triangles: npt.ArrayLike | None = None,
    anchor: npt.ArrayLike | None = None,
    turns: npt.ArrayLike | None = None,
    easing: Easing | None = linear,
    anchor_curve: AnchorCurve | None = None,
    pointwise: bool = False,
    smooth_rho: bool = False,
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
    easing : callable or None
        Pace within each interval, from [0, 1] onto [0, 1]; `linear` by default. None stands for the
        weights of the natural cubic spline across all keyframes, which are C² in time but can leave
        the bounds.
    anchor_curve : callable, optional
        Position of the anchor at each time; by default it is blended linearly. It has to pass the
        anchor's position in each keyframe.
    pointwise : bool
        For scaled η: hold the bounds at every point of the paths by its own keyframes' distortion,
        not only the worst of the whole domain.
    smooth_rho : bool
        For scaled η: a ρ that is C^∞ in time between keyframes, nowhere above the sharp one.
    transform : HilbertTransform, optional
        For the metric variant: of this outline and cage, where the caller has it already.

    Raises
    ------
    EngineError
        If anything of that does not hold, or a keyframe folds.
    """
    maps = tuple(keyframes)
    variant = _known(variant)
    if easing is None and variant is Variant.METRIC:
        raise EngineError(
            "Spline weights across keyframes are sometimes negative, and the metric blended with "
            "them need not be positive; use the metric variant with an easing, or nu or scaled-eta."
        )
    if easing is None and smooth_rho:
        raise EngineError("A smooth rho is made for each interval; it needs an easing, no spline.")
    _require_keyframes(maps)
    sites = prepare_sites(outline, maps[0].cage, points, triangles=triangles, anchor=anchor)
    samples = sample_keyframes(maps, sites.paths, sites.outline_samples)
    sheets = root_sheets(np.array([key.anchor_fz for key in samples]), turns)
    if transform is None and variant is Variant.METRIC:
        transform = HilbertTransform.on(sites.outline, sites.cage)
    groups = [slice(0, len(maps))] if easing is None else _pairs(len(maps))
    pieces = tuple(
        prepare_inbetweens(
            variant,
            sites,
            samples[group],
            sheets[group],
            transform=transform,
            pointwise=pointwise,
            smooth_rho=smooth_rho,
        )
        for group in groups
    )
    if anchor_curve is not None:
        _require_through(anchor_curve, samples, sites.diameter)
    return Prepared(
        variant=variant,
        sites=sites,
        keyframes=samples,
        pieces=pieces,
        easing=easing,
        anchor_curve=anchor_curve,
    )


def prepare_inbetweens(
    variant: Variant,
    sites: Sites,
    keyframes: Sequence[KeyframeSamples],
    sheets: Integers,
    *,
    transform: HilbertTransform | ProjectedTransform | None = None,
    pointwise: bool = False,
    smooth_rho: bool = False,
) -> Inbetweens:
    """Prepare the in-betweens of a few keyframes, usually of two neighbours.

    What it is given is shared, not copied: sites by all keyframes, keyframes by the intervals on
    both sides.

    Parameters
    ----------
    variant : Variant
    sites : Sites
    keyframes : sequence of KeyframeSamples, length q
    sheets : int32, shape (q,)
        From `root_sheets`.
    transform : HilbertTransform or ProjectedTransform, optional
        Of the sites' outline; the metric variant needs it, and exactly two keyframes. The second
        kind is for in-betweens in a hurry.
    pointwise, smooth_rho : bool
        As in `prepare`.
    """
    keys = tuple(keyframes)
    scale: Scale | None = None
    blend: Blend
    match variant:
        case Variant.LINEAR:
            return LinearInbetweens.of(keys, sites)
        case Variant.NU:
            blend = NuBlend(keyframes=keys, sheets=readonly(sheets))
        case Variant.ETA:
            blend = EtaBlend.of(keys, sheets)
        case Variant.SCALED_ETA:
            blend = EtaBlend.of(keys, sheets)
            sharp = Scaling.of(keys, sites.outline_samples, pointwise=pointwise)
            scale = SmoothScaling.of(sharp) if smooth_rho else sharp
        case Variant.METRIC:
            if transform is None or len(keys) != 2:
                raise EngineError("The metric variant needs a Hilbert transform and two keyframes.")
            blend = MetricBlend.of(keys, sheets, sites.paths, transform)
    return IntegratedInbetweens(sites=sites, keyframes=keys, blend=blend, scale=scale)


def _known(variant: Variant | str) -> Variant:
    try:
        return Variant(variant)
    except ValueError:
        names = ", ".join(Variant)
        raise EngineError(f"There is no variant {variant!r}; there are {names}.") from None


def _pairs(count: int) -> list[slice]:
    return [slice(i, i + 2) for i in range(count - 1)]


def _require_keyframes(maps: Sequence[HarmonicMap]) -> None:
    if len(maps) < 2:
        raise EngineError(f"In-betweens need at least two keyframes, not {len(maps)}.")
    for i, f in enumerate(maps):
        if not np.array_equal(f.cage, maps[0].cage):
            raise EngineError(f"Keyframe {i} has another cage than keyframe 0; they must share it.")


def _require_through(
    curve: AnchorCurve, keyframes: Sequence[KeyframeSamples], diameter: float
) -> None:
    for i, key in enumerate(keyframes):
        position = complex(curve(float(i)))
        if not abs(position - key.anchor_position) <= 1e-9 * diameter:
            raise EngineError(
                f"The anchor's curve is at {position:.6g} at time {i}, but keyframe {i} has the "
                f"anchor at {key.anchor_position:.6g}; the curve must pass there."
            )

"""How far an animation distorts its drawing: the keyframes' certificates, and the in-betweens'."""

from dataclasses import dataclass

import numpy as np

from app.document import Clip, Extremes, Variant, intervals, transits
from app.motion import Animation
from engine.maps import Boundary, Certificate, certify

# Times in each interval. In-betweens are analytic in time: their extremes cannot hide between.
TIMES = 65
# Of the larger k, σ_a or σ_b: what the quadrature and the integral equation may add.
ACCURACY = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class IntervalReport:
    """One interval: what its in-betweens reach, beside what its two keys do.

    `limits` is what they are to keep: the keys' own distortion, but where the motion passes through
    a key, the figure's bounds, or what the keys around have beyond them.
    """

    first: int
    last: int
    reached: Extremes
    keys: Extremes
    correction: float
    limits: Extremes

    @property
    def is_within(self) -> bool:
        """Whether the in-betweens keep the limits, but for rounding."""
        reached, limits = self.reached, self.limits
        return (
            reached.k <= limits.k + ACCURACY
            and reached.sigma_a <= limits.sigma_a * (1 + ACCURACY)
            and reached.sigma_b >= limits.sigma_b * (1 - ACCURACY)
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """Keys and intervals of a document.

    Parameters
    ----------
    keys : tuple of (frame, Certificate)
        Proven anew for each keyframe, against the document's bounds.
    intervals : tuple of IntervalReport
    """

    keys: tuple[tuple[int, Certificate], ...]
    intervals: tuple[IntervalReport, ...]

    @property
    def certified(self) -> bool:
        """Whether all keyframes are certified and all in-betweens within their bounds."""
        return all(certificate.certified for _, certificate in self.keys) and all(
            interval.is_within for interval in self.intervals
        )


def certify_clip(clip: Clip, variant: Variant | None = None) -> Report:
    """Measure the distortion of a figure over time and space.

    Parameters
    ----------
    clip : Clip
    variant : str, optional
        The figure's own by default.

    Notes
    -----
    |ν| and log σ_a are subharmonic, so that the worst distortion of every in-between is on the
    outline; there it is taken at graded samples, some hundred an edge, the same for keys and
    in-betweens.
    """
    domain = clip.figure.domain
    boundary = Boundary.sample(domain.outline, domain.cage, domain.holes)
    keys = tuple(
        (key.frame, certify(clip.figure.map_of(key.pose), boundary, clip.figure.bounds))
        for key in clip.keys
    )
    animation = Animation(clip, variant, points=boundary.points)
    reports = []
    for (first, last), transit in zip(intervals(clip), transits(clip), strict=True):
        ends = [
            Extremes.measured(*clip.figure.map_of(key.pose).derivatives(boundary.points))
            for key in (clip.keys[first], clip.keys[last], *transit.keys)
        ]
        bound = ends[0].joined(ends[1])
        limits = bound
        if transit.is_joined:
            bounds = clip.figure.bounds
            limits = Extremes(bounds.k, bounds.sigma_a, bounds.sigma_b)
            for end in ends:
                limits = limits.joined(end)
        inbetweens = animation.sampler.inbetweens_of(transit, clip.figure.bounds, animation.variant)
        reached = bound
        for t in np.linspace(0.0, 1.0, TIMES)[1:-1]:
            frame = inbetweens.frame(float(t))
            reached = reached.joined(Extremes.measured(frame.fz, frame.fzbar))
        reports.append(
            IntervalReport(
                first=clip.keys[first].frame,
                last=clip.keys[last].frame,
                reached=reached,
                keys=bound,
                correction=inbetweens.correction,
                limits=limits,
            )
        )
    return Report(keys=keys, intervals=tuple(reports))

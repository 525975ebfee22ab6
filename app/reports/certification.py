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
    """One interval: what its in-betweens reach, beside what its two keys do."""

    first: int
    last: int
    reached: Extremes
    keys: Extremes
    correction: float

    @property
    def is_within(self) -> bool:
        """Whether the in-betweens keep to the keyframes' own distortion, but for rounding."""
        reached, keys = self.reached, self.keys
        return (
            reached.k <= keys.k + ACCURACY
            and reached.sigma_a <= keys.sigma_a * (1 + ACCURACY)
            and reached.sigma_b >= keys.sigma_b * (1 - ACCURACY)
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
        poses = clip.keys[first].pose, clip.keys[last].pose
        ends = [
            Extremes.measured(*clip.figure.map_of(pose).derivatives(boundary.points))
            for pose in poses
        ]
        bound = ends[0].joined(ends[1])
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
            )
        )
    return Report(keys=keys, intervals=tuple(reports))

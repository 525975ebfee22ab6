"""The streamed components of the in-betweens of two keyframes: real numbers at every point."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.interpolation import Inbetweens, SampledDomain
from engine.maps import distortion

ROUNDING = 2.0**-21  # rounding error of a sum of some float32 numbers, relative to the largest
OF_DIAMETER, OF_STRETCH = 1e-6, 1e-5  # allowed errors of positions and of derivatives
# Probed points: some spread over all points, and the most distorted ones.
SPREAD, EXTREME = 400, 100


class MotionComponents(Protocol):
    """Numbers (c,) that depend on time in [0, 1]."""

    @property
    def tolerance(self) -> float:
        """The largest error that a series may have, in units of the numbers."""

    def sample(self, time: float) -> Floats:
        """Compute the numbers directly."""

    def probe(self, times: Floats) -> Floats:
        """Return at times (t,) fewer numbers (t, p), which cost less than all.

        Functions of time that represent these numbers to the tolerance represent all numbers.
        """


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Positions:
    """x and y of each point in turn, c = 2m.

    Positions are integrals of f_z and f_z̄ along the paths, and share their functions of time.
    """

    inbetweens: Inbetweens
    tolerance: float
    derivatives: Callable[[Floats], tuple[Complexes, Complexes]]
    length: float

    @classmethod
    def of(cls, inbetweens: Inbetweens, sites: SampledDomain) -> Self:
        """Allow an error relative to the diameter, or the rounding of float32 if it is larger."""
        largest = max(float(np.abs(key.positions).max()) for key in inbetweens.keyframe_blend.ends)
        return cls(
            inbetweens=inbetweens,
            tolerance=max(OF_DIAMETER * sites.diameter, ROUNDING * largest),
            derivatives=inbetweens.derivatives_at(_interpolation_points(inbetweens, sites)),
            length=sites.diameter,
        )

    def sample(self, time: float) -> Floats:
        """Integrate along the paths; at times 0 and 1 return the keyframes exactly."""
        if time in (0.0, 1.0):
            return _reals(self.inbetweens.keyframe_blend.ends[int(time)].positions)
        return _reals(self.inbetweens.anchor_position(time) + self.inbetweens.offsets(time))

    def probe(self, times: Floats) -> Floats:
        """Return f_z and f_z̄ of some points, in units of length, and the anchor."""
        fz, fzbar = self.derivatives(times)
        anchor = self.inbetweens.anchor_positions(times)[:, None]
        return _reals(np.hstack([self.length * fz, self.length * fzbar, anchor]))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Distortions:
    """f_z of each point in turn and then f_z̄, c = 4m; real before imaginary part."""

    tolerance: float
    all_points: Callable[[Floats], tuple[Complexes, Complexes]]
    some_points: Callable[[Floats], tuple[Complexes, Complexes]]

    @classmethod
    def of(cls, inbetweens: Inbetweens, sites: SampledDomain) -> Self:
        """Allow an error relative to the largest stretch of the two keyframes."""
        everywhere = inbetweens.derivatives_at(np.arange(len(sites.points)))
        stretches = distortion.sigma_a(*everywhere(np.array([0.0, 1.0])))
        return cls(
            tolerance=OF_STRETCH * float(stretches.max()),
            all_points=everywhere,
            some_points=inbetweens.derivatives_at(_interpolation_points(inbetweens, sites)),
        )

    def sample(self, time: float) -> Floats:
        """Blend the derivatives."""
        return _reals(np.hstack(self.all_points(np.array([time])))[0])

    def probe(self, times: Floats) -> Floats:
        """Blend the derivatives of some points."""
        return _reals(np.hstack(self.some_points(times)))


def _interpolation_points(inbetweens: Inbetweens, sites: SampledDomain) -> Indices:
    """Return some of the points: spread over all, and those that the keyframes distort most.

    The motion bends most at the most distorted points, and evenly spread points may miss them.
    """
    nodes = sites.paths.places
    k = np.max([np.abs(key.nu[nodes]) for key in inbetweens.keyframe_blend.ends], axis=0)
    spread = np.linspace(0, len(k) - 1, min(SPREAD, len(k))).round().astype(np.intp)
    return np.union1d(spread, np.argsort(k)[-EXTREME:])


def _reals(values: Complexes) -> Floats:
    return values.view(np.float64)

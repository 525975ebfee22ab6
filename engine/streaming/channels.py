"""What is streamed of the in-betweens of two keyframes: real numbers at every point."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol, TypeGuard

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation import Inbetweens, IntegratedInbetweens, Sites

ROUNDING = 2.0**-21  # what sums of some float32 numbers lose, relative to the largest


class Sample(NamedTuple):
    """The values (c,) at a time as they are without ρ, and the part (c,) that ρ scales.

    The latter is None where there is no ρ.
    """

    values: Floats
    scaled: Floats | None


class Channels(Protocol):
    """Numbers that depend on time in [0, 1]: `values + (rho − 1) * scaled`, both parts analytic."""

    @property
    def inbetweens(self) -> Inbetweens:
        """Where they come from; of two keyframes."""

    @property
    def tolerance(self) -> float:
        """The largest error that a series may have, in units of the numbers."""

    def sample(self, time: float) -> Sample:
        """Work the numbers out on the direct path."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Positions:
    """Where the points are: x and y of each of them in turn, c = 2m."""

    inbetweens: Inbetweens
    tolerance: float

    @classmethod
    def of(cls, inbetweens: Inbetweens, sites: Sites, *, relative: float = 1e-6) -> "Positions":
        """Allow an error of a part of the diameter, or what float32 can hold if that is more."""
        largest = max(float(np.abs(key.positions).max()) for key in inbetweens.passage.ends)
        tolerance = max(relative * sites.diameter, ROUNDING * largest)
        return cls(inbetweens=inbetweens, tolerance=tolerance)

    def sample(self, time: float) -> Sample:
        """Integrate along the paths; the keyframes are returned as they are."""
        inbetweens = self.inbetweens
        psi: Complexes | None = None
        if scales(inbetweens):
            phi, psi = inbetweens.parts(time)
            offsets = phi + psi
        else:
            offsets = inbetweens.offsets(time)
        places = inbetweens.passage.anchor_position(time) + offsets
        if time in (0.0, 1.0):
            places = inbetweens.passage.ends[int(time)].positions
        return Sample(_reals(places), None if psi is None else _reals(psi))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Distortions:
    """f_z of each point in turn and then f_z̄, c = 4m; real before imaginary part."""

    inbetweens: Inbetweens
    tolerance: float

    @classmethod
    def of(cls, inbetweens: Inbetweens, *, relative: float = 1e-5) -> "Distortions":
        """Allow an error of a part of the largest stretch of the two keyframes."""
        frames = [inbetweens.frame(time) for time in (0.0, 1.0)]
        largest = max(float((np.abs(f.fz) + np.abs(f.fzbar)).max()) for f in frames)
        return cls(inbetweens=inbetweens, tolerance=relative * largest)

    def sample(self, time: float) -> Sample:
        """Blend the derivatives."""
        inbetweens = self.inbetweens
        if not scales(inbetweens):
            frame = inbetweens.frame(time)
            return Sample(_reals(np.concatenate([frame.fz, frame.fzbar])), None)
        alone, added, fzbar = inbetweens.derivative_parts(time)
        values = np.concatenate([alone + added, fzbar])
        scaled = np.concatenate([added, fzbar])
        return Sample(_reals(values), _reals(scaled))


def scales(inbetweens: Inbetweens) -> TypeGuard[IntegratedInbetweens]:
    """Tell whether Ψ is scaled by a ρ."""
    return isinstance(inbetweens, IntegratedInbetweens) and inbetweens.scale is not None


def _reals(values: Complexes) -> Floats:
    return values.view(np.float64)

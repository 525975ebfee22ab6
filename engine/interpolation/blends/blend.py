"""Base class of the variants: two blended quantities, and everything that follows from them."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.interpolation.added.closing import Closing, Moduli
from engine.interpolation.enclosures.cells import BernsteinPatch, BlendChanges
from engine.interpolation.enclosures.pieces import BoundaryBezier, EndpointValues
from engine.interpolation.keyframe_blend.derivatives import Derivatives, KeyframeBlend
from engine.interpolation.keyframe_blend.segment import BoundaryResidual, KeyframeSegment
from engine.interpolation.sampled_domain import SampledDomain
from engine.interpolation.series.residual import HoleConstants, Residual
from engine.interpolation.time_weights.tangents import (
    are_same_maps,
    derivatives_along,
    shorten_tangent,
)
from engine.interpolation.time_weights.weights import InteriorKnot, Tangent, TimeWeights
from engine.maps import Boundary, Bounds, Enclosures, HarmonicMap

PairCurves = tuple[BoundaryBezier[Any], BoundaryBezier[Any]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Blend(ABC):
    """Derivatives of an in-between as a function of the keyframes and the time.

    A variant is a subclass, and a row of the table `BLENDS`. `bounds` apply to in-betweens through
    keyframes, as far as the variant can keep them.
    """

    # The quantity that the correction around holes keeps: 1 for ν, −1 for η; 0 without correction.
    sign: ClassVar[int] = -1
    # Whether Ψ is scaled by ρ.
    is_scaled: ClassVar[bool] = False

    # Whether the blend at a point depends on the keyframes at this point only.
    is_closed_form: ClassVar[bool] = True

    keyframe_blend: KeyframeBlend
    bounds: Bounds

    @classmethod
    @abstractmethod
    def of(cls, interval: KeyframeSegment) -> Self:
        """Prepare the blend of a segment."""

    @classmethod
    def on_boundary(cls, _interval: KeyframeSegment, /) -> BoundaryResidual | None:
        """Return the part that is solved on the boundary and does not depend on the points."""
        return None

    @classmethod
    def at_single_time(cls, _time: float, interval: KeyframeSegment, /) -> Self:
        """Prepare the blend for one time in [0, 1], without holes; invalid at other times."""
        return cls.of(interval)

    @abstractmethod
    def values(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return f_z and conj(f_z̄) at times (t,) and the nodes of the paths, each (t, s)."""

    @abstractmethod
    def derivatives(self, time: float) -> Derivatives:
        """Return the in-between's derivatives at the nodes of the paths."""

    def at(self, which: Indices) -> Self:
        """Return a copy restricted to some of the nodes."""
        return replace(self, keyframe_blend=self.keyframe_blend.at(which))

    def with_residual(self, residual: Residual) -> Self:
        """Return a copy with one more term added to log f_z."""
        return replace(self, keyframe_blend=self.keyframe_blend.with_residual(residual))

    @property
    def constants(self) -> HoleConstants | None:
        """Constants that the correction around holes makes up for."""
        return None

    def moduli(self, _boundary: Boundary, /) -> Moduli | None:
        """Return the moduli and limits for the correction around holes, at the boundary."""
        return None

    def exact_rho(
        self, sites: SampledDomain, closing: Closing | None, conformal: Closing | None
    ) -> Callable[[Floats], Floats]:
        """Return the largest ρ at times (t,) in ascending order, for variants with a scaled Ψ.

        Around holes `closing` is the correction for ρ = 1, and `conformal` the difference from it
        to the correction for ρ = 0.
        """
        raise NotImplementedError

    @staticmethod
    @abstractmethod
    def blended_pair(fz: Complexes, g: Complexes) -> tuple[Complexes, Complexes]:
        """Return the two blended quantities, given f_z and conj(f_z̄) of any shape."""

    @staticmethod
    @abstractmethod
    def singular_values(first: Complexes, second: Complexes) -> tuple[Floats, Floats]:
        """Return σ_a and σ_b, given the two quantities."""

    @classmethod
    def tangent(
        cls, maps: Sequence[HarmonicMap], joint: InteriorKnot, bounds: Bounds, boundary: Boundary
    ) -> Tangent:
        """Return the tangent at an interior knot, short enough to keep the bounds.

        The control values obey `bounds`, widened by the keyframe's own extremes. `maps` are the
        previous neighbour, the keyframe and the next neighbour. If the keyframe equals a neighbour
        the tangent has length 0, a stop; else the motion would overshoot the held pose.
        """
        if any(are_same_maps(maps[1], f, boundary) for f in (maps[0], maps[2])):
            return Tangent(joint, 0.0, 0.0)
        quantities = np.array([cls.blended_pair(*derivatives_along(f, boundary)) for f in maps])
        return cls._shorten_tangent(quantities, joint, bounds, boundary)

    @classmethod
    def _shorten_tangent(
        cls, quantities: Complexes, joint: InteriorKnot, bounds: Bounds, _boundary: Boundary, /
    ) -> Tangent:
        return shorten_tangent(quantities, cls.singular_values, joint, bounds)

    @property
    def curve_weights(self) -> tuple[TimeWeights, TimeWeights]:
        """The time weights of the `curves` of both quantities."""
        return self.keyframe_blend.time_weights, self.keyframe_blend.eta_time_weights

    @abstractmethod
    def curves(self, values: EndpointValues) -> PairCurves:
        """Return the two quantities with error bounds along pieces of the boundary."""

    @staticmethod
    @abstractmethod
    def enclose(
        first: BernsteinPatch[Any], second: BernsteinPatch[Any], changes: BlendChanges | None, /
    ) -> Enclosures:
        """Enclose the distortion on cells, given the two quantities and their later changes."""

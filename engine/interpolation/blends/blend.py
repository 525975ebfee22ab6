"""What a variant is: two quantities that are blended, and all that follows from them."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.interpolation.added import Closing, Moduli
from engine.interpolation.enclosures import (
    BernsteinPatch,
    BlendChanges,
    BoundaryBezier,
    EndpointValues,
)
from engine.interpolation.keyframe_blend import (
    BoundaryResidual,
    Derivatives,
    KeyframeBlend,
    KeyframeSegment,
)
from engine.interpolation.sampled_domain import SampledDomain
from engine.interpolation.series import HoleConstants, Residual
from engine.interpolation.time_weights import (
    InteriorKnot,
    Tangent,
    TimeWeights,
    are_same_maps,
    derivatives_along,
    shorten_tangent,
)
from engine.maps import Boundary, Bounds, Enclosures, HarmonicMap

PairCurves = tuple[BoundaryBezier[Any], BoundaryBezier[Any]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Blend(ABC):
    """How the derivatives of an in-between follow from the keyframes and the time.

    A variant is a subclass, and a row of `engine.interpolation.blends.BLENDS`.

    Parameters
    ----------
    passage : KeyframeBlend
    bounds : Bounds
        That in-betweens through keyframes obey, as far as the variant can.
    """

    # What the correction around holes keeps: 1 for ν, −1 for η; 0 where none is needed.
    sign: ClassVar[int] = -1
    # Whether Ψ is scaled by a ρ.
    is_scaled: ClassVar[bool] = False

    # Whether what is blended at a place follows from the keyframes there, and not from elsewhere.
    is_closed_form: ClassVar[bool] = True

    keyframe_blend: KeyframeBlend
    bounds: Bounds

    @classmethod
    @abstractmethod
    def of(cls, interval: KeyframeSegment) -> Self:
        """Prepare the blend of an interval."""

    @classmethod
    def on_boundary(cls, _interval: KeyframeSegment, /) -> BoundaryResidual | None:
        """Return what is solved for on the boundary, whatever the points are."""
        return None

    @classmethod
    def at_single_time(cls, _time: float, interval: KeyframeSegment, /) -> Self:
        """Prepare it for one time in [0, 1], without holes; at others it may be wrong."""
        return cls.of(interval)

    @abstractmethod
    def values(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return f_z and conj(f_z̄) at times (t,) and the nodes of the paths, each (t, s)."""

    @abstractmethod
    def derivatives(self, time: float) -> Derivatives:
        """Return the in-between's derivatives at the nodes of the paths."""

    def at(self, which: Indices) -> Self:
        """Return the same at some of the nodes only."""
        return replace(self, keyframe_blend=self.keyframe_blend.at(which))

    def with_residual(self, residual: Residual) -> Self:
        """Return the same with something more added to log f_z."""
        return replace(self, keyframe_blend=self.keyframe_blend.with_residual(residual))

    @property
    def constants(self) -> HoleConstants | None:
        """What the correction around holes has to make good beside the periods."""
        return None

    def moduli(self, _boundary: Boundary, /) -> Moduli | None:
        """Return what that correction is to keep at the boundary beside them."""
        return None

    def exact_rho(
        self, sites: SampledDomain, closing: Closing | None, conformal: Closing | None
    ) -> Callable[[Floats], Floats]:
        """Return the largest ρ at times (t,) in ascending order, where Ψ is scaled.

        Parameters
        ----------
        sites : SampledDomain
        closing, conformal : Closing or None
            Around holes the corrections for ρ = 1, and what leads on from there to that for ρ = 0.
        """
        raise NotImplementedError

    @staticmethod
    @abstractmethod
    def blended_pair(fz: Complexes, g: Complexes) -> tuple[Complexes, Complexes]:
        """Return the two quantities that are blended, of f_z and conj(f_z̄) of any shape."""

    @staticmethod
    @abstractmethod
    def singular_values(first: Complexes, second: Complexes) -> tuple[Floats, Floats]:
        """Return σ_a and σ_b of the two quantities."""

    @classmethod
    def tangent(
        cls, maps: Sequence[HarmonicMap], joint: InteriorKnot, bounds: Bounds, boundary: Boundary
    ) -> Tangent:
        """Return a joint's tangent, short enough for the control values to obey the bounds.

        Parameters
        ----------
        maps : sequence of HarmonicMap, length 3
            The keyframe and its neighbours, in order of time.
        joint : InteriorKnot
        bounds : Bounds
            Widened where the keyframe itself exceeds them.
        boundary : Boundary

        Returns
        -------
        Tangent
            Of length 0, a stop, where the keyframe is equal to a neighbour: past it the motion
            would swing beyond the pose that is to be kept.
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
        """The weights in time of the `curves` of both quantities."""
        return self.keyframe_blend.time_weights, self.keyframe_blend.eta_time_weights

    @abstractmethod
    def curves(self, values: EndpointValues) -> PairCurves:
        """Return what is known of the two quantities along pieces of the boundary."""

    @staticmethod
    @abstractmethod
    def enclose(
        first: BernsteinPatch[Any], second: BernsteinPatch[Any], changes: BlendChanges | None, /
    ) -> Enclosures:
        """Enclose the distortion on cells, of the two quantities and what becomes of them."""

"""The metric variant (Sections 6 and 7.4).

The pullback metric of a map h has the matrix M_h = 𝒜 I + 2 [[Re η, Im η], [Im η, −Re η]], of
Equation (9), with 𝒜 = |h_z|² + |h_z̄|². Blending M_h linearly therefore means blending 𝒜 and η. On
the outline this gives |f_z^t|. It differs from the logarithmic blend by a residual. The residual
vanishes at both keyframes and is analytic in time. It is a sum Σ_j c_j(t) U_j(ζ) of few terms, so
a handful of Dirichlet problems serve every time.

Around holes ln |f_z| differs from Equation (13) in two ways. The first is a constant on the
boundary of each hole, which every single-valued f_z has (`engine.dirichlet`). The second is the h
that closes the periods, makes up for the constants as far as it can, and keeps the limits of the
keyframes (`engine.interpolation.added.hole_closer`).
"""

from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.correction.barrier import log_distortions
from engine.deform.correction.limits import frame_limits
from engine.dirichlet import Extension, Refinement
from engine.errors import EngineError
from engine.interpolation.added.closing import Moduli
from engine.interpolation.blends.blend import PairCurves
from engine.interpolation.blends.eta import EtaBlend
from engine.interpolation.blends.outline import (
    OutlineMetric,
    control_curves,
    trace_time_weights,
)
from engine.interpolation.enclosures.cells import (
    BernsteinPatch,
    BlendChanges,
    enclose_changed_metric,
    enclose_metric,
)
from engine.interpolation.enclosures.pieces import EndpointValues
from engine.interpolation.keyframe_blend.segment import BoundaryResidual, KeyframeSegment
from engine.interpolation.series.chebyshev import constant_one, separate_variables
from engine.interpolation.series.residual import HoleConstants, Residual
from engine.interpolation.time_weights.tangents import shorten_metric_tangent
from engine.interpolation.time_weights.weights import InteriorKnot, Tangent, TimeWeights
from engine.maps import Boundary, Bounds, Enclosures, derivatives_of

TOLERANCE = 1e-9  # of the series' last terms, in ln |f_z|
# Largest sum of the omitted modes, in ln |f_z|; it changes the eighth digit of positions. At
# tangents the second value holds, since the velocity must be the same on both sides.
LEFT_OUT, LEFT_OUT_PASSING = 2e-6, 1e-7
# Limit of the last Legendre coefficients of the residual on a panel, in ln |f_z|; the sampled
# times; and how often a panel may be halved.
RESOLVED, LOOKED_AT, MOST_HALVINGS = 5e-4, (0.03, 0.25, 0.5, 0.75, 0.97), 8


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MetricBlend(EtaBlend):
    """The metric tensor linear on the outline, and η: Properties 1 to 4, 5' to 7' and 8.

    log f_z is the logarithmic blend and a holomorphic residual,

        log f_z^t = Σ w_i(t) log f_z^i + Σ c_j(t) H_j,

    with the segment's time weights: 1 − t and t between two keyframes. The real part of H_j on the
    outline is the mode U_j of the residual. The residual vanishes at both keyframes, so these are
    exact for any resolution of the integral equation. It is the first residual of the keyframe
    blend.

    Departs from the paper: Section 7.4 transforms ln |f_z^t| as a whole, with an integration
    constant for the whole shape. Here the constant is tied to the anchor: arg f_z is linear there.

    `lost` is the constant by which each H_j stays below U_j on the boundary of a hole.
    """

    is_closed_form = False

    lost: HoleConstants

    @classmethod
    def of(cls, interval: KeyframeSegment) -> Self:
        """Solve the Dirichlet problems of the residual.

        Raises
        ------
        EngineError
            If the transform is missing, or belongs to another domain.
        """
        return cls._extended(interval, interval.residual or cls.on_boundary(interval))

    @classmethod
    def on_boundary(cls, interval: KeyframeSegment, /) -> BoundaryResidual:
        """Solve the Dirichlet problems, and return the solution on the boundary."""
        metric, panels = _resolved(interval, np.array(LOOKED_AT))
        forms, series = separate_variables(
            metric.residuals,
            tolerance=TOLERANCE,
            left_out=LEFT_OUT
            if interval.keyframe_blend.time_weights.is_straight
            else LEFT_OUT_PASSING,
        )
        return BoundaryResidual(panels.solve(forms), series)

    @classmethod
    def at_single_time(cls, time: float, interval: KeyframeSegment, /) -> Self:
        """Solve the single Dirichlet problem of a time in [0, 1]."""
        times = np.array([time])
        metric, panels = _resolved(interval, times)
        residual = BoundaryResidual(panels.solve(metric.residuals(times)), constant_one())
        return cls._extended(interval, residual)

    @classmethod
    def _extended(cls, interval: KeyframeSegment, residual: BoundaryResidual) -> Self:
        densities, series = residual
        modes, modes_z, lost = densities.at(_matching(interval))
        modes.imag -= modes[0].imag
        # H_j' is unbounded there. The steps beside these nodes are so short that 0 changes nothing.
        modes_z[interval.sampled_domain.paths.cornered] = 0.0
        known, keyframe_blend = EtaBlend.of(interval), interval.keyframe_blend
        # Everything but η keeps its velocities at keyframes.
        keyframe_blend = replace(keyframe_blend, time_weights=keyframe_blend.time_weights.unlimited)
        return cls(
            keyframe_blend=keyframe_blend.with_residual(Residual.of(series, modes, modes_z)),
            bounds=interval.bounds,
            conj_eta=known.conj_eta,
            conj_eta_z=known.conj_eta_z,
            lost=HoleConstants(series, lost),
        )

    @property
    def constants(self) -> HoleConstants:
        """Constants that the correction around holes makes up for."""
        return self.lost

    def moduli(self, boundary: Boundary) -> Moduli:
        """Return moduli and limits at the boundary samples, before the periods are closed."""
        time_weights = self.keyframe_blend.eta_time_weights
        fz, fzbar = derivatives_of(
            [key.map for key in self.keyframe_blend.keyframes], boundary.points
        )
        metric = OutlineMetric.of(fz, fzbar, time_weights, self.bounds)
        counts = np.diff([*boundary.starts, len(boundary.points)])
        loops = np.repeat(np.arange(len(counts)), counts)

        def at(times: Floats) -> tuple[Floats, Floats]:
            logarithm = (
                metric.residuals(times).T + time_weights.unlimited.at(times).T @ metric.log_modulus
            )
            lost = np.pad(self.lost.at(times), ((0, 0), (1, 0)))[:, loops]
            a = np.exp(logarithm - lost)
            return a, np.abs(time_weights.at(times).T @ metric.eta) / a

        keyframes = zip(*at(np.array([0.0, 1.0])), strict=True)
        ends = [log_distortions(*each).max(axis=1) for each in keyframes]
        bounds = [] if time_weights.is_straight else [frame_limits(self.bounds, inside=0.0)]
        return Moduli(at, np.max([*ends, *bounds], axis=0), self.lost)

    @staticmethod
    def blended_pair(fz: Complexes, g: Complexes) -> tuple[Complexes, Complexes]:
        """Return 𝒜 and conj(η)."""
        return np.abs(fz) ** 2 + np.abs(g) ** 2 + 0j, fz * g

    @staticmethod
    def singular_values(first: Complexes, second: Complexes) -> tuple[Floats, Floats]:
        """Return the roots of 𝒜 ± 2 |η| = σ², Equations (10) and (11)."""
        trace, twice = first.real, 2 * np.abs(second)
        return np.sqrt(np.maximum(trace + twice, 0.0)), np.sqrt(np.maximum(trace - twice, 0.0))

    @classmethod
    def _shorten_tangent(
        cls, quantities: Complexes, joint: InteriorKnot, bounds: Bounds, boundary: Boundary, /
    ) -> Tangent:
        return shorten_metric_tangent(quantities, joint, bounds, boundary)

    @property
    def curve_weights(self) -> tuple[TimeWeights, TimeWeights]:
        """The time weights of the `curves` of both quantities."""
        return trace_time_weights(
            self.keyframe_blend.eta_time_weights
        ), self.keyframe_blend.eta_time_weights

    def curves(self, values: EndpointValues) -> PairCurves:
        """Return 𝒜, or its control values in time, and conj(η) along pieces of the boundary."""
        eta = values.conj_eta()
        return control_curves(
            values.trace(), eta, self.keyframe_blend.eta_time_weights, self.bounds
        ), eta

    @staticmethod
    def enclose(
        first: BernsteinPatch[Any], second: BernsteinPatch[Any], changes: BlendChanges | None, /
    ) -> Enclosures:
        if changes is None:
            return enclose_metric(first, second)
        return enclose_changed_metric(first, second, changes)


def _resolved(interval: KeyframeSegment, times: Floats) -> tuple[OutlineMetric, Refinement]:
    """Return the metrics at nodes that resolve the residual at some times, and the nodes' panels.

    The nodes follow the shape. Keyframes at extreme bounds vary faster near a vertex of the cage;
    there panels are halved.
    """
    keyframe_blend, bounds = interval.keyframe_blend, interval.bounds
    maps = [key.map for key in keyframe_blend.keyframes]
    panels = Refinement.of(_matching(interval).transform)
    metric = OutlineMetric.of(
        *derivatives_of(maps, panels.nodes), keyframe_blend.time_weights, bounds
    )
    for _ in range(MOST_HALVINGS):
        coarse = panels.panels.unresolved(metric.residuals(times), RESOLVED)
        if not coarse.any():
            break
        panels = panels.halved(coarse)
        metric = OutlineMetric.of(
            *derivatives_of(maps, panels.nodes), keyframe_blend.time_weights, bounds
        )
    return metric, panels


def _matching(interval: KeyframeSegment) -> Extension:
    """Raise for a transform of another domain, which would give wrong in-betweens silently."""
    transform, sites = interval.transform, interval.sampled_domain
    if transform is None:
        raise EngineError(
            "The metric variant needs the Hilbert transform of the outline; give the transform."
        )
    sites.require_extension(transform)
    return transform

"""The constraints of every frame of a slider: the periods around holes are closed, and pins held.

A pin is where its places in the poses have their weighted sum; a point that no pose moves stays.
Constraints are met by a correction h of log f_z that keeps η (`engine.deform.correction`, with
q = 0), so that the curb can follow it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.deform.correction.corrector import PointCorrector, build_corrector
from engine.deform.correction.frame import BaseFrame, CorrectedFrame
from engine.deform.correction.point_targets import PointTargets
from engine.deform.correction.solver import PointSolution, solve_correction
from engine.dirichlet import Densities, Extension, HilbertTransform
from engine.interpolation import (
    KeyframeSamples,
    SampledDomain,
    SpanBasis,
    sample_domain,
    sample_keyframes,
)
from engine.interpolation.added.period_search import PeriodSearch
from engine.interpolation.series.residual import combine_arrays
from engine.maps import HarmonicMap, Span

MET = 1e-6  # of the diameter: error of pins and periods that are met


class PoseValues(NamedTuple):
    """log f_z and conj(η) of poses at nodes, and their derivatives, complex128 (q, s) each."""

    log_fz: Complexes
    log_fz_z: Complexes
    conj_eta: Complexes
    conj_eta_z: Complexes

    @classmethod
    def of(cls, poses: Sequence[KeyframeSamples], sheets: Floats) -> "PoseValues":
        """Derive the values of poses whose logarithms have these branches (q,)."""
        log_fz, log_fz_z, nu, nu_z = (
            np.array([getattr(pose, name) for pose in poses])
            for name in ("log_fz", "log_fz_z", "nu", "nu_z")
        )
        squared = np.exp(2 * log_fz)
        log_fz += 2j * np.pi * sheets[:, None]
        return cls(log_fz, log_fz_z, nu * squared, (nu_z + 2 * nu * log_fz_z) * squared).at(
            np.arange(log_fz.shape[1])
        )

    def at(self, which: Indices) -> "PoseValues":
        """Return the values at some of the nodes."""
        return PoseValues(*(freeze(np.ascontiguousarray(each[:, which])) for each in self))

    def blended(self, weights: Floats) -> tuple[Complexes, Complexes, Complexes, Complexes]:
        """Return the sums with weights (q,), (s,) each."""
        log_fz, log_fz_z, conj_eta, conj_eta_z = (combine_arrays(weights, each) for each in self)
        return log_fz, log_fz_z, conj_eta, conj_eta_z


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Constraints:
    """Periods and pins of the poses (q,) of a slider.

    h is the smallest correction that meets them; without pins it is a sum of the few functions that
    close periods (`engine.interpolation.added.hole_closer`).

    Attributes
    ----------
    search : PointCorrector or PeriodSearch
        Of the pins, with unknowns of h only; without pins, of the periods.
    values : PoseValues
        At the nodes (s,) of the corrector's paths, or of the loops around holes.
    extension : Extension
        At the anchor, then at these nodes.
    quadrature : complex128, shape (q, m)
        Places of the pins relative to the anchor, integrated along the corrector's paths.
    functions : complex128, shape (n, j)
        Functions in the span whose sums are h.
    from_unknowns : complex128, shape (j, N)
        Their coefficients, from the unknowns of h.
    on_boundary : complex64, shape (b, j)
        The functions at the nodes of the transform.
    is_anchored : bool
        Whether the anchor stays where the poses have it.
    """

    span: Span
    search: PointCorrector | PeriodSearch
    values: PoseValues
    extension: Extension
    quadrature: Complexes
    functions: Complexes
    from_unknowns: Complexes
    on_boundary: npt.NDArray[np.complex64]
    is_anchored: bool

    @classmethod
    def of(
        cls,
        maps: Sequence[HarmonicMap],
        sheets: Floats,
        values: PoseValues,
        sites: SampledDomain,
        transform: HilbertTransform,
        pins: Complexes,
        *,
        is_anchored: bool,
    ) -> Self | None:
        """Prepare pins (m,), in the domain at rest; return None without holes and pins.

        `values` are those of the poses at the nodes of the sites' paths.
        """
        boundary, anchor, span = sites.boundary, np.array([sites.anchor]), sites.boundary.span
        search: PointCorrector | PeriodSearch
        if len(pins):
            corrector = build_corrector(boundary, sites.anchor, pins)
            known = corrector.variables
            search = replace(corrector, variables=known.of_h(np.eye(known.count)))
            functions, from_unknowns = np.eye(len(span), dtype=np.complex128), known.h
            nodes = corrector.paths.nodes
            rows = sample_domain(boundary, anchor, anchor=anchor, values_at=nodes)
            own = PoseValues.of(sample_keyframes(maps, rows), sheets).at(rows.paths.beside)
            fz = np.exp(own.log_fz)
            quadrature = _places(corrector, fz, own.conj_eta / fz)
        elif sites.closer is not None:
            search, functions = sites.closer.least, sites.closer.few
            from_unknowns = np.eye(functions.shape[1], dtype=np.complex128)
            nodes, own = sites.loops.nodes, values.at(sites.paths.around)
            quadrature = np.empty((len(maps), 0), dtype=np.complex128)
        else:
            return None
        (on_boundary,) = span.evaluate(functions, transform.nodes, orders=(0,))
        return cls(
            span=span,
            search=search,
            values=own,
            extension=transform.at(np.concatenate([anchor, nodes])),
            quadrature=freeze(quadrature),
            functions=freeze(functions),
            from_unknowns=freeze(from_unknowns),
            on_boundary=freeze(on_boundary.astype(np.complex64)),
            is_anchored=is_anchored,
        )

    def basis(self, nodes: Complexes) -> SpanBasis:
        """Return the functions at nodes (s,)."""
        evaluated = self.span.evaluate(self.functions, nodes, orders=(0, 1))
        return SpanBasis(*(freeze(each.astype(np.complex64)) for each in evaluated))

    def real_parts(self, x: Floats) -> Floats:
        """Return Re h at the nodes of the transform, for unknowns x (N,)."""
        values = self.on_boundary @ (self.from_unknowns @ x).astype(np.complex64)
        return values.real.astype(np.float64)

    def solve(
        self,
        weights: Floats,
        rho: float,
        densities: Densities | None,
        start: PointSolution | None,
    ) -> PointSolution:
        """Find h for a frame, given the curb's ρ and the densities of r.

        `start` is a solution of a similar frame. The result is unfinished if h does not meet the
        constraints.
        """
        log_fz, _, conj_eta, _ = self.values.blended(weights)
        if densities is not None:
            added = densities.at(self.extension).values[:, 0]
            log_fz += added[1:] - 1j * added[0].imag
        fz = np.exp(log_fz)
        g = rho * conj_eta / fz
        if isinstance(self.search, PeriodSearch):
            few = self.search.closest((fz[None], g[None]), -1)[:, 0]
            return PointSolution(x=few, shift=0j, target_errors=np.empty(0), steps=1)
        offsets = weights @ self.quadrature - _places(self.search, fz, g)
        targets = PointTargets(offsets, np.ones(len(offsets)), self.is_anchored)
        base = BaseFrame(fz, g, np.zeros_like(fz), -1)
        found = solve_correction(self.search, base, targets, start, throw=False)
        periods = CorrectedFrame.of(self.search, base, found.x).places()[len(offsets) :]
        missed = np.abs(np.append(found.target_errors, periods)).max()
        is_met = bool(missed <= MET * self.search.boundary.size)
        return replace(found, is_finished=is_met)


def _places(corrector: PointCorrector, fz: Complexes, g: Complexes) -> Complexes:
    """Return f − f(anchor) at the points, (..., m)."""
    paths, count = corrector.paths, len(corrector.points)
    total: Complexes = paths.integrals(fz) + paths.integrals(g).conj()
    return total[..., :count]

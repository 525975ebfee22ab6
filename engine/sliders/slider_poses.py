"""Poses of sliders, added to an in-between by weights of any sign within the limits.

As in the η variant (Sections 5.1 and 5.4), log f_z and η are linear in the weights w_i of the poses
i. A base, such as an in-between of keyframes, has F and η_0. h, H[r] and ρ are added:

    log f_z = log F + Σ w_i log f_z^i + h + H[r],
    η = ρ (η_0 + Σ w_i η^i),    f_z̄ = η / conj(f_z).

The undeformed drawing has log f_z = η = 0. Poses thus need no weights that sum to 1, and on an
undeformed base a pose of weight 1 is exact. h closes periods and holds pins
(`engine.sliders.constraints`). H[r] is the holomorphic function whose real part on the boundary is
r. ρ and r are the curb (`engine.sliders.curb`). Not in the paper.

Proof of the limits: on the boundary the curb keeps k, σ_a and σ_b, for any weights. conj(η) and f_z
are holomorphic, and f_z has no zeros, so the limits hold in the whole domain (Chen and Weber 2015,
Theorem 4). This is exact but for numerical errors, which `FrameSolution.beyond` measures: r is
found at nodes and checked between them, and constraints and curb alternate until neither changes
the other.

Turning a pose adds a constant to its log f_z and leaves its η, so turns blend apart from shapes.
One integer for each pose chooses the branch of its logarithm.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Indices, freeze, nbytes_of
from engine.dirichlet import Extension
from engine.interpolation import (
    CorrectionSeries,
    Frame,
    Inbetweens,
    KeyframeSamples,
    SampledDomain,
    SpanBasis,
)
from engine.interpolation.added.pins.evaluated import EvaluatedCorrection, Mixing
from engine.interpolation.inbetweens import PointValues
from engine.interpolation.keyframe_blend.derivatives import Derivatives
from engine.interpolation.series.residual import combine_arrays
from engine.sliders.constraints import PoseValues
from engine.sliders.frame_solver import FrameSolution


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SliderFrame:
    """A frame with sliders, which tracks and springs may correct like an in-between.

    It is the same at any time: methods take a time because those of `Inbetweens` do. `errors` (m,)
    are quadrature errors. K, the factor of q in corrections, is f_z of the frame.
    """

    sites: SampledDomain
    derivatives: Derivatives
    mixing: Mixing
    anchor: complex
    errors: Complexes
    solution: FrameSolution

    sign = -1  # corrections without q keep η

    def anchor_position(self, _time: float, /) -> complex:
        return self.anchor

    def frame(self, _time: float = 0.0, /) -> Frame:
        """Return positions and derivatives at the points."""
        paths, (fz, fzz, g, gz) = self.sites.paths, self.derivatives
        steps = paths.step_integrals(fz, fzz)
        steps += paths.step_integrals(g, gz).conj()
        return Frame(
            positions=self.anchor + paths.integrals(steps) + self.errors,
            fz=fz[paths.places],
            fzbar=g[paths.places].conj(),
            rho=self.solution.rho,
        )

    def frame_with_values(self, _time: float = 0.0, /) -> tuple[Frame, PointValues]:
        """Return the frame, and the values at the value points."""
        beside = self.sites.paths.beside
        fz, _, g, _ = self.derivatives
        return self.frame(), PointValues(fz[beside], g[beside], self.mixing.k[beside])

    def with_correction(self, known: CorrectionSeries, basis: SpanBasis | None = None) -> Self:
        """Return the frame after a correction; a basis at the nodes saves time."""
        span, nodes = self.sites.boundary.span, self.sites.paths.nodes
        correction = EvaluatedCorrection.of(known, span, nodes, basis)
        changed, mixing = correction.changed(self.derivatives, self.mixing, self.sign, 0.0)
        return type(self)(
            sites=self.sites,
            derivatives=changed,
            mixing=mixing,
            anchor=self.anchor + complex(known.shift(np.zeros(1))[0]),
            errors=self.errors,
            solution=self.solution,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SliderPoses:
    """Poses (q,) of sliders at the nodes of a sampled domain.

    `moves` (q,) are the movements of the anchor, `errors` (q, m) the quadrature errors of Φ and Ψ.
    """

    sites: SampledDomain
    values: PoseValues
    moves: Complexes
    errors: tuple[Complexes, Complexes]

    @classmethod
    def of(cls, poses: Sequence[KeyframeSamples], turns: Indices, sites: SampledDomain) -> Self:
        """Prepare poses with full turns (q,), as in `FrameSolver.of`."""
        return cls(
            sites=sites,
            values=PoseValues.of(poses, turns),
            moves=freeze(np.array([pose.anchor_position for pose in poses]) - sites.anchor),
            errors=(
                freeze(np.array([pose.phi_error for pose in poses])),
                freeze(np.array([pose.psi_error for pose in poses])),
            ),
        )

    @property
    def nbytes(self) -> int:
        """Memory in bytes, without the sampled domain."""
        return nbytes_of(self, but=(self.sites,))

    def add_to(
        self,
        base: Inbetweens,
        time: float,
        solution: FrameSolution,
        extension: Extension | None = None,
        basis: SpanBasis | None = None,
    ) -> SliderFrame:
        """Add a solution to an in-between of the same sampled domain at a time in [0, 1].

        `extension`, the transform at the nodes, is needed if the solution has densities; `basis`,
        the solution's forms at the nodes, if it has forms.
        """
        before = base.derivatives(time)
        log_fz, log_fz_z, g, gz = self.values.blended(solution.weights)
        if solution.densities is not None and extension is not None:
            self.sites.require_extension(extension)
            values, slopes, _ = solution.densities.at(extension)
            # H' is unbounded at corners. The steps beside them are so short that 0 changes
            # nothing.
            slopes[self.sites.paths.cornered] = 0.0
            # H does not turn the anchor.
            log_fz += values[:, 0] - 1j * values[0, 0].imag
            log_fz_z += slopes[:, 0]
        if solution.forms is not None and basis is not None:
            h, h_z = basis.evaluate(solution.x[:, None])
            log_fz += h[:, 0]
            log_fz_z += h_z[:, 0]
        log_fz_z += before.fzz / before.fz
        fz = np.exp(log_fz, out=log_fz)
        fz *= before.fz
        inverse = solution.rho / fz
        g += before.fz * before.g
        g *= inverse
        gz += before.fzz * before.g + before.fz * before.gz
        gz *= inverse
        gz -= g * log_fz_z
        phi_error, psi_error = (combine_arrays(solution.weights, each) for each in self.errors)
        moved = complex(solution.weights @ self.moves) + solution.shift
        return SliderFrame(
            sites=self.sites,
            derivatives=Derivatives(fz=fz, fzz=log_fz_z * fz, g=g, gz=gz),
            mixing=Mixing(fz, log_fz_z),
            anchor=base.anchor_position(time) + moved,
            errors=base.quadrature_errors(time) + phi_error + solution.rho * psi_error.conj(),
            solution=solution,
        )

"""Poses of a slider, blended by weights of any sign within the limits of the distortion.

As in the η variant (Sections 5.1 and 5.4), log f_z and η are linear in the weights w_i of the
poses, which sum to 1. h, H[r] and ρ are added:

    log f_z = Σ w_i log f_z^i + h + H[r],    η = ρ Σ w_i η^i,    f_z̄ = η / conj(f_z).

h closes periods and holds pins (`engine.sliders.constraints`). H[r] is the
holomorphic function whose real part on the boundary is r. ρ and r are the curb
(`engine.sliders.curb`). Not in the paper.

Proof of the limits: on the boundary the curb keeps k, σ_a and σ_b, for any weights. conj(η) and f_z
are holomorphic, and f_z has no zeros, so the limits hold in the whole domain (Chen and Weber 2015,
Theorem 4). This is exact but for numerical errors, which `PoseFrame.beyond` measures: r is found at
nodes and checked between them, and constraints and curb alternate until neither changes the other.

A pose within the limits is exact, since h = r = 0 and ρ = 1 there. Turning a pose adds a constant
to its log f_z and leaves its η, so turns blend apart from shapes. One integer for each pose chooses
the branch of its logarithm.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from engine.arrays import (
    Complexes,
    Floats,
    as_points,
    as_reals,
    as_tuple,
    freeze,
    require_kind,
)
from engine.dirichlet import Extension
from engine.errors import EngineError
from engine.interpolation import Frame, SampledDomain, SpanBasis, sample_keyframes
from engine.interpolation.keyframe_blend.derivatives import Derivatives
from engine.interpolation.series.residual import combine_arrays
from engine.maps import Bounds, HarmonicMap
from engine.paths import root_sheets
from engine.sliders.constraints import Constraints, PoseValues
from engine.sliders.curb import OutlinePoses
from engine.sliders.frame_solver import FrameSolution, FrameSolver

MOST_POSES = 8
OF_SUM = 1e-9  # allowed error of the sum of weights

COUNT_OF_POSES = "A slider has 1 to {most} poses, not {count}."
OTHER_DOMAIN = "Pose {number} has another cage than the sampled domain; pose the same domain."
COUNT_OF_TURNS = "A slider needs one whole number of turns for each of its {count} poses."
COUNT_OF_WEIGHTS = "A slider with {count} poses needs {count} weights, not shape {shape}."
WEIGHT = "Weight {number} of the slider must be a finite number, not {value}."
SUM_OF_WEIGHTS = "The weights of a slider must sum to 1, not {total:.6g}."


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PoseFrame(Frame):
    """A frame of a slider.

    Attributes
    ----------
    curbed : float
        Largest |r|, the change of ln |f_z| on the boundary by the curb; 0 where the blend is within
        the limits by itself and ρ is 1.
    beyond : float
        How far ln |f_z| on the boundary may be outside the interval that the limits allow.
    share : float
        Part of the way from the first pose to the weights: below 1 where the limits, the pins and
        the periods cannot be had together.
    """

    curbed: float
    beyond: float
    share: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PoseBlend:
    """Poses (q,) of a slider at a sampled domain; build it with `PoseBlend.of`.

    Frames are pure functions of the weights: any order and several threads are allowed.

    Attributes
    ----------
    values, extension, basis
        At the nodes of the paths.
    anchors : complex128, shape (q,)
        Places of the anchor.
    errors : tuple of complex128, shape (q, m)
        Quadrature errors of Φ and Ψ.
    """

    sites: SampledDomain
    solver: FrameSolver
    values: PoseValues
    extension: Extension
    anchors: Complexes
    errors: tuple[Complexes, Complexes]
    basis: SpanBasis | None

    @classmethod
    def of(
        cls,
        poses: Sequence[HarmonicMap],
        sites: SampledDomain,
        extension: Extension,
        *,
        bounds: Bounds = Bounds(),
        turns: npt.ArrayLike | None = None,
        pins: npt.ArrayLike = (),
        is_anchored: bool = False,
    ) -> Self:
        """Prepare the poses of a slider.

        Parameters
        ----------
        poses : sequence of HarmonicMap, length q, 1 to 8
            Locally injective maps. The curb changes poses beyond the bounds.
        extension : Extension
            Hilbert transform of the outline at the nodes of the sites' paths.
        bounds : Bounds
            Limits of every frame.
        turns : int, shape (q,), optional
            Full turns of each pose beyond the shorter way from the first pose.
        pins : complex, shape (m,)
            Points of the domain at rest whose places are the weighted sums of their places in the
            poses. A handle that no pose moves stays.
        is_anchored : bool
            Whether the anchor is such a point, too, as the joint of an attached drawing is.

        Raises
        ------
        EngineError
            If an argument breaks one of these conditions, or a pose folds.
        """
        maps = as_tuple(poses, "poses")
        if not 1 <= len(maps) <= MOST_POSES:
            raise EngineError(COUNT_OF_POSES, most=MOST_POSES, count=len(maps))
        for number, pose in enumerate(maps):
            require_kind(pose, HarmonicMap, f"pose {number}")
            if not pose.span.equals(sites.boundary.span):
                raise EngineError(OTHER_DOMAIN, number=number)
        require_kind(bounds, Bounds, "bounds")
        sites.require_extension(extension)
        samples = sample_keyframes(maps, sites)
        sheets = _sheets(np.array([pose.anchor_fz for pose in samples]), turns)
        pinned = as_points(pins, "pins")
        values, transform = PoseValues.of(samples, sheets), extension.transform
        constraints = Constraints.of(
            maps, sheets, values, sites, transform, pinned, is_anchored=is_anchored
        )
        return cls(
            sites=sites,
            solver=FrameSolver(
                outline=OutlinePoses.of(maps, transform, bounds), constraints=constraints
            ),
            values=values,
            extension=extension,
            anchors=freeze(np.array([pose.anchor_position for pose in samples])),
            errors=(
                freeze(np.array([pose.phi_error for pose in samples])),
                freeze(np.array([pose.psi_error for pose in samples])),
            ),
            basis=None if constraints is None else constraints.basis(sites.paths.nodes),
        )

    def frame(self, weights: npt.ArrayLike) -> PoseFrame:
        """Return the frame of weights (q,), which sum to 1.

        Raises
        ------
        EngineError
            If the weights are not such numbers.
        """
        solution = self.solver.solve(self._weights(weights))
        blended = self._derivatives(solution)
        paths = self.sites.paths
        steps = paths.step_integrals(blended.fz, blended.fzz)
        steps += paths.step_integrals(blended.g, blended.gz).conj()
        phi_error, psi_error = (combine_arrays(solution.weights, each) for each in self.errors)
        positions = paths.integrals(steps) + phi_error + solution.rho * psi_error.conj()
        return PoseFrame(
            positions=self._anchor(solution) + positions,
            fz=blended.fz[paths.places],
            fzbar=blended.g[paths.places].conj(),
            rho=solution.rho,
            curbed=solution.curbed,
            beyond=solution.beyond,
            share=solution.share,
        )

    def _weights(self, weights: npt.ArrayLike) -> Floats:
        values, count = as_reals(weights, "The weights of a slider"), len(self.anchors)
        if values.shape != (count,):
            raise EngineError(COUNT_OF_WEIGHTS, count=count, shape=values.shape)
        for number in np.flatnonzero(~np.isfinite(values)):
            raise EngineError(WEIGHT, number=number, value=values[number])
        total = float(values.sum())
        if abs(total - 1.0) > OF_SUM * max(1.0, float(np.abs(values).max())):
            raise EngineError(SUM_OF_WEIGHTS, total=total)
        return values

    def _anchor(self, solution: FrameSolution) -> complex:
        return complex(solution.weights @ self.anchors) + solution.shift

    def _derivatives(self, solution: FrameSolution) -> Derivatives:
        """Return the derivatives at the nodes."""
        log_fz, log_fz_z, g, gz = self.values.blended(solution.weights)
        if solution.densities is not None:
            values, slopes, _ = solution.densities.at(self.extension)
            # H_j' is unbounded at corners. The steps beside them are so short that 0 changes
            # nothing.
            slopes[self.sites.paths.cornered] = 0.0
            # H does not turn the anchor.
            log_fz += values[:, 0] - 1j * values[0, 0].imag
            log_fz_z += slopes[:, 0]
        if self.basis is not None and solution.h is not None:
            h, h_z = self.basis.evaluate(solution.h[:, None])
            log_fz += h[:, 0]
            log_fz_z += h_z[:, 0]
        fz = np.exp(log_fz)
        inverse = solution.rho / fz
        g *= inverse
        gz *= inverse
        gz -= g * log_fz_z
        return Derivatives(fz=fz, fzz=log_fz_z * fz, g=g, gz=gz)


def _sheets(anchor_fz: Complexes, turns: npt.ArrayLike | None) -> Floats:
    """Return the branch of each pose (q,), the nearest to that of the first pose plus its turns."""
    count = len(anchor_fz)
    extra = np.zeros(count, np.int32) if turns is None else np.asarray(turns)
    if extra.shape != (count,) or extra.dtype.kind not in "iu":
        raise EngineError(COUNT_OF_TURNS, count=count)
    pairs = zip(anchor_fz, extra, strict=True)
    return np.array(
        [root_sheets(np.array([anchor_fz[0], fz]), [own])[1] for fz, own in pairs], float
    )

"""The constraints of frames with sliders: the periods around holes are closed, and pins held.

A pin stays where the base has it, but for the weighted sum of its movements in the poses: they are
the target errors of a handle that no pose moves. Constraints are met by a correction h of log f_z
that keeps η (`engine.deform.correction`, with q = 0), so that the curb can follow it.
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
from engine.deform.correction.solver import (
    PointSolution,
    solve_correction,
    take_newton_step,
)
from engine.dirichlet import Densities, Extension, HilbertTransform
from engine.interpolation import KeyframeSamples, SampledDomain, sample_domain, sample_keyframes
from engine.interpolation.inbetweens import PointValues
from engine.interpolation.series.residual import combine_arrays
from engine.maps import HarmonicMap

DISTINCT = 1e-6  # of the largest: combinations of unknowns that matter less are left out
MET = 1e-6  # of the diameter: error of periods that are closed


class PoseValues(NamedTuple):
    """log f_z and conj(η) of poses at nodes, and their derivatives, complex128 (q, s) each."""

    log_fz: Complexes
    log_fz_z: Complexes
    conj_eta: Complexes
    conj_eta_z: Complexes

    @classmethod
    def of(cls, poses: Sequence[KeyframeSamples], turns: Indices) -> "PoseValues":
        """Derive the values of poses whose logarithms have these full turns (q,)."""
        log_fz, log_fz_z, nu, nu_z = (
            np.array([getattr(pose, name) for pose in poses])
            for name in ("log_fz", "log_fz_z", "nu", "nu_z")
        )
        squared = np.exp(2 * log_fz)
        log_fz += 2j * np.pi * turns[:, None]
        eta_z = (nu_z + 2 * nu * log_fz_z) * squared
        return cls(freeze(log_fz), freeze(log_fz_z), freeze(nu * squared), freeze(eta_z))

    def at(self, which: Indices) -> "PoseValues":
        """Return the values at some of the nodes."""
        return PoseValues(*(freeze(np.ascontiguousarray(each[:, which])) for each in self))

    def blended(self, weights: Floats) -> tuple[Complexes, Complexes, Complexes, Complexes]:
        """Return the sums with weights (q,), (s,) each."""
        used = np.flatnonzero(weights)
        log_fz, log_fz_z, conj_eta, conj_eta_z = (
            combine_arrays(weights[used], each[used]) for each in self
        )
        return log_fz, log_fz_z, conj_eta, conj_eta_z


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Constraints:
    """Periods and pins; h is the smallest correction that meets them.

    Attributes
    ----------
    corrector : PointCorrector
        Of the pins, with unknowns x (N,) of h only.
    values : PoseValues
        Of the poses (q,) at the nodes (s,) of the corrector's paths.
    extension : Extension
        At the anchor, then at these nodes.
    real_parts : float32, shape (b, N)
        From x to Re h at the nodes of the transform.
    moves : complex128, shape (q, m)
        Movements of the pins in the poses, relative to the anchor.
    is_anchored : bool
        Whether the anchor moves with the poses, and not to suit the pins.
    """

    corrector: PointCorrector
    values: PoseValues
    extension: Extension
    real_parts: npt.NDArray[np.float32]
    moves: Complexes
    is_anchored: bool

    @classmethod
    def of(
        cls,
        maps: Sequence[HarmonicMap],
        turns: Indices,
        sites: SampledDomain,
        transform: HilbertTransform,
        pins: Complexes,
        *,
        is_anchored: bool,
    ) -> Self | None:
        """Prepare pins (m,), in the domain at rest; return None without holes and pins."""
        boundary = sites.boundary
        if not len(pins) and not boundary.holes:
            return None
        corrector = build_corrector(boundary, sites.anchor, pins)
        known, nodes = corrector.variables, corrector.paths.nodes
        anchor = np.array([sites.anchor])
        rows = sample_domain(boundary, anchor, anchor=anchor, values_at=nodes)
        poses = PoseValues.of(sample_keyframes(maps, rows), turns).at(rows.paths.beside)
        fz = np.exp(poses.log_fz)
        g = poses.conj_eta / fz
        h_only = replace(corrector, variables=known.of_h(np.eye(known.count)))
        known = known.of_h(_useful_forms(h_only, fz, g))
        (at_transform,) = boundary.span.evaluate(known.h, transform.nodes, orders=(0,))
        return cls(
            corrector=replace(corrector, variables=known),
            values=poses,
            extension=transform.at(np.concatenate([anchor, nodes])),
            real_parts=freeze(at_transform.real.astype(np.float32)),
            moves=freeze(_places(corrector, fz, g) - (pins - sites.anchor)),
            is_anchored=is_anchored,
        )

    def step(
        self,
        base: PointValues,
        weights: Floats,
        rho: float,
        densities: Densities | None,
        start: PointSolution | None,
        force: float,
    ) -> PointSolution:
        """Return h a step nearer to the constraints, given the curb's ρ and the densities of r.

        Without a start, h meets them. `base` is at the nodes. `force` is the pull on a pin, per
        diameter, that lets it move by the diameter; the movement grows with the cube of the pull.
        The result is unfinished if h does not close the periods.
        """
        log_fz, _, conj_eta, _ = self.values.blended(weights)
        if densities is not None:
            added = densities.at(self.extension).values[:, 0]
            log_fz += added[1:] - 1j * added[0].imag
        fz = base.fz * np.exp(log_fz)
        g = rho * (base.fz * base.g + conj_eta) / fz
        offsets = _places(self.corrector, base.fz, base.g) + weights @ self.moves
        offsets -= _places(self.corrector, fz, g)
        ones = np.ones(len(offsets))
        forces = force / self.corrector.boundary.size * ones
        targets = PointTargets(offsets, ones, self.is_anchored, forces)
        frame = BaseFrame(fz, g, np.zeros_like(fz), -1)
        if start is None:
            found = solve_correction(self.corrector, frame, targets, throw=False)
        else:
            found = take_newton_step(self.corrector, frame, targets, start)
        periods = CorrectedFrame.of(self.corrector, frame, found.x).places()[len(offsets) :]
        missed = np.abs(periods).max(initial=0.0)
        is_met = bool(missed <= MET * self.corrector.boundary.size)
        return replace(found, is_finished=is_met)


def _useful_forms(corrector: PointCorrector, fz: Complexes, g: Complexes) -> Floats:
    """Return the combinations (N, M) of the unknowns that act on the constraints of frames (q, s).

    The smallest h that meets the constraints of one of these frames is among them, and so is
    nearly the smallest of a frame between them.
    """
    still = np.zeros_like(fz[0])
    frames = [(np.ones_like(still), still), *zip(fz, g, strict=True)]
    rows = [
        CorrectedFrame.of(
            corrector, BaseFrame(*frame, still, -1), corrector.variables.nothing
        ).constraint_rows()
        for frame in frames
    ]
    _, sizes, forms = np.linalg.svd(np.concatenate(rows), full_matrices=False)
    return np.asarray(forms[sizes > DISTINCT * sizes[0]].T)


def _places(corrector: PointCorrector, fz: Complexes, g: Complexes) -> Complexes:
    """Return f − f(anchor) at the pins, (..., m)."""
    paths, count = corrector.paths, len(corrector.points)
    total: Complexes = paths.integrals(fz) + paths.integrals(g).conj()
    return total[..., :count]

"""The solution of a slider's frame, before any points: ρ, r and h at given weights.

Constraints and curb alternate: a step of Newton's method changes h for the curbed frame, and the
curb is found for the frame with h, until neither changes the other. Steps are accelerated by the
steps before (Anderson 1965).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, nbytes_of
from engine.dirichlet import Densities, HilbertTransform, Refinement
from engine.errors import EngineError
from engine.interpolation import SampledDomain
from engine.interpolation.inbetweens import PointValues
from engine.maps import HarmonicMap, LocalBounds
from engine.sliders.constraints import Constraints
from engine.sliders.curb import Curb, OutlineBlend, OutlinePoses

# The alternation ends when a round changes ln f_z by at most CLOSE on the boundary. After
# MOST_ROUNDS, or before a step above FAR, a change below ACCEPTED will do. Else pins give way to
# the next of FORCES, and at last all weights are lowered.
CLOSE, ACCEPTED, FAR, MOST_ROUNDS = 5e-5, 1e-3, 2.0, 20
REMEMBERED, DISTINCT = 6, 1e-6  # rounds; smaller relative differences of rounds are ignored
BACK, MOST_RETURNS, FORCES = 0.85, 12, (100.0, 20.0, 5.0)
WEIGHTS = "A slider with {count} poses needs {count} finite weights, not {weights}."
OTHER_DOMAIN = "Pose {number} has another cage than the sampled domain; pose the same domain."


class FrameSolution(NamedTuple):
    """A frame before any points.

    Attributes
    ----------
    weights : float64, shape (q,)
        Of the poses: the given ones times `share`.
    forms, x : complex128, shape (n, M), and float64, shape (M,), or None
        h is forms @ x, coefficients in the span. Solutions of one solver have the same forms.
    shift : complex
        Translation.
    densities : Densities or None
        Of H[r]; None for r = 0.
    rho : float
        Factor of η.
    curbed : float
        Largest |r|, the change of ln |f_z| on the boundary by the curb; 0 where the blend is within
        the limits by itself and ρ is 1.
    beyond : float
        How far ln |f_z| on the boundary may be outside the interval that the limits allow.
    share : float
        Below 1 where the limits and the periods cannot be had together.
    """

    weights: Floats
    forms: Complexes | None
    x: Floats
    shift: complex
    densities: Densities | None
    rho: float
    curbed: float
    beyond: float
    share: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrameSolver:
    """Solves frames from the poses on the boundary.

    `constraints` is None without holes and pins.
    """

    outline: OutlinePoses
    constraints: Constraints | None

    @classmethod
    def of(
        cls,
        poses: Sequence[HarmonicMap],
        turns: Indices,
        sites: SampledDomain,
        transform: HilbertTransform,
        bounds: LocalBounds,
        pins: Complexes,
        *,
        is_anchored: bool = False,
    ) -> Self:
        """Prepare poses of a domain.

        Parameters
        ----------
        poses : sequence of HarmonicMap, length q
            Locally injective maps. The curb changes poses beyond the bounds.
        turns : int, shape (q,)
            Full turns of each pose beyond the shorter way.
        sites : SampledDomain
            Gives the boundary and the anchor.
        bounds : LocalBounds
            Numbers, or arrays with one limit for each of the boundary's own samples.
        pins : complex, shape (m,)
            Points of the domain at rest that keep their places.
        is_anchored : bool
            Whether the anchor moves with the poses alone, and not to suit the pins.

        Raises
        ------
        EngineError
            If an argument breaks one of these conditions, or a pose folds.
        """
        for number, pose in enumerate(poses):
            if not pose.span.equals(sites.boundary.span):
                raise EngineError(OTHER_DOMAIN, number=number)
        sites.require_boundary(transform.loops)
        return cls(
            outline=OutlinePoses.of(poses, transform, sites.boundary, bounds),
            constraints=Constraints.of(
                poses, turns, sites, transform, pins, is_anchored=is_anchored
            ),
        )

    @property
    def nodes(self) -> Complexes:
        """Points at which the base is given, those of the constraints first."""
        known, nodes = self.constraints, self.outline.transform.nodes
        return nodes if known is None else np.append(known.corrector.paths.nodes, nodes)

    @property
    def nbytes(self) -> int:
        """Memory in bytes, without the transform."""
        return nbytes_of(self, but=(self.outline.transform,))

    def solve(self, weights: Floats, base: PointValues) -> FrameSolution:
        """Solve a frame on a base at `nodes`, with lower weights if there is no solution.

        Raises
        ------
        EngineError
            If the weights are not one finite number for each pose.
        """
        count = len(self.outline.log_modulus)
        if weights.shape != (count,) or not np.isfinite(weights).all():
            raise EngineError(WEIGHTS, count=count, weights=weights)
        own = len(base.fz) - len(self.outline.transform.nodes)
        at_constraints, at_transform = (
            PointValues(*(each[part] for each in base)) for part in (slice(own), slice(own, None))
        )
        shares = [BACK**number for number in range(1, MOST_RETURNS)]
        tried = [(1.0, force) for force in FORCES]
        tried += [(share, FORCES[-1]) for share in (*shares, 0.0)]
        for share, force in tried:
            blend = self.outline.blend(at_transform, share * weights)
            found = self._alternate(share * weights, blend, at_constraints, force)
            if found.beyond <= ACCEPTED:
                break
        return found._replace(share=share)

    def _alternate(
        self, weights: Floats, blend: OutlineBlend, base: PointValues, force: float
    ) -> FrameSolution:
        """Alternate between curb and constraints until neither changes the other."""
        constraints, holes = self.constraints, len(self.outline.transform.loops) - 1
        if constraints is None:
            curb = blend.curb(None, np.zeros(1))
            return _packed(weights, blend, curb, self._densities(curb), curb.excess)

        def real_parts(x: Floats) -> Floats:
            return (constraints.real_parts @ x.astype(np.float32)).astype(np.float64)

        # The state is what the curb is for: a constant on each hole, and the unknowns of h. On a
        # hole ln |f_z| stays below u + r by a constant (`engine.dirichlet`), which must vanish.
        found = constraints.step(base, weights, 1.0, None, None, force)
        state, step = np.append(np.zeros(holes), found.x), np.zeros(holes + len(found.x))
        states: list[Floats] = []
        misses: list[Floats] = []
        solutions: list[FrameSolution] = []
        change = 0.0
        while len(solutions) < MOST_ROUNDS and change <= FAR:
            state = state + step
            constants, x = np.append(0.0, state[:holes]), state[holes:]
            curb = blend.curb(real_parts(x), constants)
            densities, lacking = self._densities(curb), np.zeros(holes)
            if densities is not None:
                lacking = densities.lacking[:, 0]
            if solutions or densities is not None or blend.rho < 1.0:
                start = replace(found, x=x)
                found = constraints.step(base, weights, blend.rho, densities, start, force)
            miss = np.append(-lacking, found.x - x)
            off = float(np.abs(np.append(lacking, real_parts(found.x - x))).max())
            beyond = off + curb.excess if found.is_finished else np.inf
            solution = _packed(weights, blend, curb, densities, beyond)
            forms = constraints.corrector.variables.h
            solutions.append(solution._replace(forms=forms, x=found.x, shift=found.shift))
            if off <= CLOSE:
                break
            states, misses = [*states, state][-REMEMBERED:], [*misses, miss][-REMEMBERED:]
            step = _accelerated(np.array(states), np.array(misses))
            change = float(np.abs(np.append(step[:holes], real_parts(step[holes:]))).max())
        return min(solutions, key=lambda solution: solution.beyond)

    def _densities(self, curb: Curb) -> Densities | None:
        """Solve the Dirichlet problem of r."""
        if not curb.residual.any():
            return None
        return Refinement.of(self.outline.transform).solve(curb.residual[:, None])


def _packed(
    weights: Floats, blend: OutlineBlend, curb: Curb, densities: Densities | None, beyond: float
) -> FrameSolution:
    """Return a solution without constraints."""
    curbed = float(np.abs(curb.residual).max())
    return FrameSolution(
        weights, None, np.zeros(0), 0j, densities, blend.rho, curbed, beyond, share=1.0
    )


def _accelerated(states: Floats, misses: Floats) -> Floats:
    """Return a step (n,), from the last states (t, n) and what each of them misses."""
    by_state, by_miss = np.diff(states, axis=0), np.diff(misses, axis=0)
    shares = np.linalg.lstsq(by_miss.T, misses[-1], rcond=DISTINCT)[0]
    return np.asarray(misses[-1] - shares @ (by_state + by_miss))

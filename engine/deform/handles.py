"""Handles: points of the shape with targets, and the energy of their target errors."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, as_points, as_reals, readonly, require_kind
from engine.deform.forces.armature import Armature
from engine.deform.forces.bones import Aim, Aims
from engine.deform.forces.pulls import BoundedPull, BoundedPulls
from engine.deform.model.position_hessian import STIFFNESS, position_hessian
from engine.errors import EngineError
from engine.geometry import Domain, diameter, require_inside
from engine.maps import Boundary

# A prescribed rotation is as stiff as two handles this far (of L) on either side of the point.
LEVER = 0.02
# Handles nearer than this (of L) count as one place: their targets may differ no more.
COINCIDENT = 1e-6
APART = 1e-4
FARTHEST = 1e12  # of L: squares of targets beyond it overflow sooner or later
# Vertices of all cages: the time of a step grows with their cube.
MOST_VERTICES = 400
# A point may be this far (of L) outside the outline, by rounding.
OUTSIDE = 1e-9
MOST_HANDLES = 1_000
TARGET_COUNT = "Give as many targets as there are handles: {count}, not {given}."
OTHER_TARGETS = (
    "Handles {first} and {second} are at the same point of the shape but have different targets; "
    "remove one of the handles."
)
OTHER_ROTATIONS = (
    "Handles {first} and {second} are at the same point of the shape but have different rotations; "
    "remove one of the handles."
)
TARGET_FAR = (
    "The target of handle {handle}, ({x:.3g}, {y:.3g}), is farther from the shape than "
    "{farthest:.0e} times the shape's size. Move the target near the shape."
)
WEIGHT_NOT_POSITIVE = "The weight of handle {handle} must be positive, not {weight:g}."
MOST_CAGE = (
    "The cages have {count} vertices. A drag with more than {most} would take minutes; choose a "
    "coarser cage."
)


class HandleTargets(NamedTuple):
    """Targets of the handles.

    Parameters
    ----------
    positions : complex128, shape (h,)
    rotations : float64, shape (h,)
        Angle in radians of the closest rotation, arg f_z, at each handle; NaN where it is free.
        Angles that differ by whole turns are the same target.
    pulls : BoundedPulls or None
        Handles without a pull are held without a limit of force.
    aims : Aims or None
        Targets of places that shafts carry.
    """

    positions: Complexes
    rotations: Floats
    pulls: BoundedPulls | None = None
    aims: Aims | None = None

    def is_same(self, other: "HandleTargets | None") -> bool:
        if other is None or other is self:
            return other is self
        ours, theirs = (
            [*targets[:2], *(targets.pulls or ()), *(targets.aims or ())]
            for targets in (self, other)
        )
        return len(ours) == len(theirs) and all(
            one is two or np.array_equal(one, two, equal_nan=one is self.rotations)
            for one, two in zip(ours, theirs, strict=True)
        )

    def target_errors(self, positions: Complexes) -> Complexes:
        """Return the target errors (h,) of handles at these positions, less the slack of pulls."""
        errors: Complexes = positions - self.positions
        if self.pulls is not None:
            errors = errors - self.pulls.spread_to_handles(self.pulls.slack(errors))
        return errors

    def released(self, positions: Complexes) -> "HandleTargets":
        """Return the targets after release.

        Each target (h,) lies a little beyond the handle's position, in the direction of its pull.
        At rest the same pose is then the one of least energy.
        """
        if self.pulls is None:
            return self
        left = self.positions + self.pulls.spread_to_handles(
            self.pulls.slack(positions - self.positions)
        )
        return HandleTargets(left, self.rotations, None, self.aims)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Handles:
    """The handles of a shape, with the coordinates of their points.

    Build it with `Handles.place`.

    Parameters
    ----------
    points : complex128, shape (h,)
        In the shape at rest.
    stiffness : float64, shape (h,)
        λ of each: the energy is Σ λ |f(point) − target|². The quadratic mean of the shape's
        stiffness around the handle is a factor, so that handles near stiff parts err no more.
    around : float64, shape (h,)
        This mean stiffness. It is also a factor of the forces of bounded pulls.
    lever : float
        Length that turns a rotation into a distance: an angle δ costs 2 λ (lever · δ)².
    coordinates, derivatives : complex128, shape (h, n)
        C_j and C_j' of the span's functions at the points.
    basis_coordinates, basis_derivatives : complex128, shape (h, r)
        The same for the boundary's basis.
    hessian : float64, shape (u, u)
        Constant Hessian of the energy of the positions and the armature, in the order of
        `Objective`.
    coincident : tuple of (int, int)
        Pairs of handles at one point.
    armature : Armature or None
        Bones of the shape.
    """

    points: Complexes
    stiffness: Floats
    around: Floats
    lever: float
    coordinates: Complexes
    derivatives: Complexes
    basis_coordinates: Complexes
    basis_derivatives: Complexes
    hessian: Floats
    coincident: tuple[tuple[int, int], ...]
    armature: Armature | None = None

    @classmethod
    def place(
        cls,
        boundary: Boundary,
        points: npt.ArrayLike,
        weights: npt.ArrayLike | None = None,
        armature: Armature | None = None,
    ) -> "Handles":
        """Place handles on a shape.

        Parameters
        ----------
        points : complex128, shape (h,)
            In the closed domain; none at all is allowed.
        weights : array_like of float, shape (h,), optional
            Relative stiffnesses, 1 by default.

        Raises
        ------
        EngineError
            If a point is outside the outline or not finite, a weight is not positive, or the cages
            have too many vertices.
        """
        require_kind(boundary, Boundary, "boundary")
        points = require_held(points, boundary.domain)
        around, firmer = boundary.stiffness_around(points)
        factors = _weights(weights, len(points)) * firmer
        stiffness = factors * STIFFNESS / boundary.size**2
        coordinates = boundary.span.coordinates(points)
        derivatives = boundary.span.derivatives(points)
        of_basis = coordinates @ boundary.basis
        distances = np.abs(points[:, None] - points)
        first, second = np.nonzero(np.triu(distances <= COINCIDENT * boundary.size, 1))
        hessian = position_hessian(boundary, of_basis, stiffness)
        if armature is not None:
            hessian += armature.hessian(boundary)
        return cls(
            points=points,
            stiffness=readonly(stiffness),
            around=readonly(around),
            lever=LEVER * boundary.size,
            coordinates=readonly(coordinates),
            derivatives=readonly(derivatives),
            basis_coordinates=readonly(of_basis),
            basis_derivatives=readonly(derivatives @ boundary.basis),
            hessian=readonly(hessian),
            coincident=tuple(zip(first.tolist(), second.tolist(), strict=True)),
            armature=armature,
        )

    def softened(self, factor: float) -> "Handles":
        """Return the same handles with `factor` times the stiffness."""
        return replace(
            self,
            stiffness=readonly(factor * self.stiffness),
            hessian=readonly(factor * self.hessian),
            armature=self.armature and self.armature.softened(factor),
        )

    def targets(
        self,
        positions: npt.ArrayLike,
        rotations: npt.ArrayLike | None = None,
        hands: Sequence[BoundedPull] = (),
        aims: Sequence[Aim] = (),
    ) -> HandleTargets:
        """Check the targets and bounded pulls of the handles, and the aims of their armature.

        Raises
        ------
        EngineError
            If the number of targets is not the number of handles; if a target is not finite or
            absurdly far away; if two handles at one point get different targets; or if a pull or
            an aim names a handle or a shaft that does not exist.
        """
        targets = as_points(positions, "targets")
        if len(targets) != len(self.points):
            raise EngineError(TARGET_COUNT, count=len(self.points), given=len(targets))
        size = self.lever / LEVER
        far = np.flatnonzero(np.abs(targets - self.points) > FARTHEST * size)
        if len(far):
            x, y = targets[far[0]].real, targets[far[0]].imag
            raise EngineError(TARGET_FAR, handle=far[0], x=x, y=y, farthest=FARTHEST)
        for i, j in self.coincident:
            if abs(targets[i] - targets[j]) > APART * size:
                raise EngineError(OTHER_TARGETS, first=i, second=j)
        pulling = BoundedPulls.of(hands, self.stiffness, self.around, size)
        aimed = Aims.of(aims, 0 if self.armature is None else len(self.armature.shafts.stiffness))
        if rotations is None:
            return HandleTargets(targets, np.full(len(targets), np.nan), pulling, aimed)
        angles = as_reals(rotations, "rotations")
        if angles.shape != targets.shape or np.isinf(angles).any():
            raise EngineError(
                "Rotations must be {count} finite angles, or NaN for a handle that may rotate "
                "freely, not {shape} {angles}.",
                count=len(targets),
                shape=angles.shape,
                angles=angles,
            )
        for i, j in self.coincident:
            if abs(np.exp(1j * angles[i]) - np.exp(1j * angles[j])) > APART:
                raise EngineError(OTHER_ROTATIONS, first=i, second=j)
        return HandleTargets(targets, angles, pulling, aimed)


def require_held(points: npt.ArrayLike, domain: Domain) -> Complexes:
    """Return the points of handles, or raise `EngineError` unless they can hold a shape.

    Nothing needs to be sampled before.
    """
    points = as_points(points, "handles")
    if len(points) > MOST_HANDLES:
        raise EngineError(
            "{count:,} handles need too much memory; give at most {most:,}.",
            count=len(points),
            most=MOST_HANDLES,
        )
    count = sum(map(len, domain.cages))
    if count > MOST_VERTICES:
        raise EngineError(MOST_CAGE, count=count, most=MOST_VERTICES)
    outline, *inner = domain.loops
    near = OUTSIDE * diameter(outline)
    require_inside(outline, points, "handle", holes=inner, tolerance=near)
    return points


def _weights(weights: npt.ArrayLike | None, count: int) -> Floats:
    factors = np.ones(count) if weights is None else as_reals(weights, "weights")
    if factors.shape != (count,):
        raise EngineError(
            "{count} handles need {count} weights, not an array of shape {shape}.",
            count=count,
            shape=factors.shape,
        )
    if not (np.isfinite(factors) & (factors > 0)).all():
        bad = int(np.flatnonzero(~(np.isfinite(factors) & (factors > 0)))[0])
        raise EngineError(WEIGHT_NOT_POSITIVE, handle=bad, weight=factors[bad])
    return factors

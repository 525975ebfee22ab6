"""Bounded pulls on handles, and distance constraints between handles.

A handle is held by λ |e|², e its distance from its target. This force has no limit: a target far
beyond reach would move all other handles. A bounded pull has at most the force F. With ē the mean
error of its handles, Λ the sum of their λ and e₀ = F / (2 Λ), the part Λ |ē|² of their energy
becomes 2 Λ e₀ |ē| − Λ e₀² beyond e₀ (Huber 1964). This is the minimum of Λ |ē − s|² + 2 Λ e₀ |s|
over all s: the pull has the slack s, and its handles keep their formation.

A distance constraint costs κ (r − c)² where the distance r of two handles leaves its range, whose
nearer end is c. A pull beyond reach straightens the chain and stops.
"""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.errors import EngineError

# Largest force of a pull, per L. An arm needs 1 to 2 to straighten to its limits. Measured on 18
# pulls within reach: none is lost with 10, three are with 5.
MAX_PULL_FORCE = 10.0
FORCE_NOT_POSITIVE = "The force of a pull must be positive, not {pull:g}."
CONSTRAINT_ENDS = (
    "A distance cannot be kept between handles {first} and {second}; name two different handles "
    "that exist."
)
CONSTRAINT_LENGTHS = (
    "The distance between two handles cannot be limited to {shortest:g} to {longest:g}."
)
PULL_HANDLES = "A pull names handles {handles}, but there are only {count} handles."


class BoundedPull(NamedTuple):
    """A pull on the mean of some handles.

    `max_force` is its largest force, per L.
    """

    handles: Collection[int]
    max_force: float = MAX_PULL_FORCE


class BoundedPulls(NamedTuple):
    """Several bounded pulls.

    Parameters
    ----------
    weights : float64, shape (q, h)
        Weight of each handle in the mean that a pull acts on; rows sum to 1.
    stiffness : float64, shape (q,)
        Λ of each.
    huber_thresholds : float64, shape (q,)
        e₀ of each.
    """

    weights: Floats
    stiffness: Floats
    huber_thresholds: Floats

    @classmethod
    def of(
        cls, hands: Sequence[BoundedPull], stiffness: Floats, around: Floats, size: float
    ) -> "BoundedPulls | None":
        """Prepare pulls on handles of this stiffness (h,), on a shape of this size.

        A pull with infinite force is dropped: its handles are ordinary handles. None if no pull is
        left. The stiffness of the shape `around` handles (h,) is a factor of the force.

        Raises
        ------
        EngineError
            If a force is not positive, a pull has no handles, names a handle that does not exist,
            or shares a handle with another pull.
        """
        hands = [hand for hand in hands if hand.max_force != np.inf]
        if not hands:
            return None
        weights = np.zeros((len(hands), len(stiffness)))
        for number, (handles, pull) in enumerate(hands):
            if not pull > 0:
                raise EngineError(FORCE_NOT_POSITIVE, pull=pull)
            if len(handles) == 0:
                raise EngineError("A pull names no handle; leave the pull out.")
            if not all(handle in range(len(stiffness)) for handle in handles):
                raise EngineError(PULL_HANDLES, handles=list(handles), count=len(stiffness))
            weights[number, list(handles)] = stiffness[list(handles)]
        twice = np.flatnonzero(np.count_nonzero(weights, axis=0) > 1)
        if len(twice):
            raise EngineError(
                "Two pulls name handle {handle}; name it in one pull only.", handle=twice[0]
            )
        totals = weights.sum(axis=1)
        forces = np.array([hand.max_force for hand in hands]) / size
        forces *= (weights * around).sum(axis=1) / totals
        return cls(
            weights=readonly(weights / totals[:, None]),
            stiffness=readonly(totals),
            huber_thresholds=readonly(forces / (2.0 * totals)),
        )

    @property
    def has_all_handles(self) -> bool:
        """Whether every handle belongs to a pull: only the shape then resists."""
        return bool((self.weights > 0).any(axis=0).all())

    def slack(self, errors: Complexes) -> Complexes:
        """Slack of each bounded pull (q,), from the errors of the handles (h,).

        The target moves back by the slack, so that the force stays below the limit.
        """
        means = self.weights @ errors
        distances = np.maximum(np.abs(means), self.huber_thresholds)
        given: Complexes = (1.0 - self.huber_thresholds / distances) * means
        return given

    def slack_directions(self, errors: Complexes) -> tuple[Complexes, Floats]:
        """Return the direction of each pull's slack, and its share across the direction, (q,) each.

        Along the direction, slack grows by the whole change of the error; across it, by this share.
        The direction is 0 where the slack is 0.
        """
        given = self.slack(errors)
        sizes = np.abs(given)
        directions = given / np.maximum(sizes, np.finfo(np.float64).tiny)
        return directions, sizes / (sizes + self.huber_thresholds)

    def spread_to_handles(self, of_hands: Complexes) -> Complexes:
        """Return the value of its pull for each handle (h,); 0 for handles without a pull."""
        spread: Complexes = of_hands @ (self.weights > 0)
        return spread

    def slack_energy(self, given: Complexes) -> float:
        return float((2.0 * self.stiffness * self.huber_thresholds) @ np.abs(given))


class DistanceConstraint(NamedTuple):
    """Two handles, by their numbers, and the allowed range of their distance."""

    first: int
    second: int
    shortest: float
    longest: float


class DistanceConstraints(NamedTuple):
    """Several distance constraints.

    Parameters
    ----------
    ends : intp, shape (2, l)
        The two handles of each constraint.
    stiffness : float64, shape (l,)
        κ of each.
    """

    ends: Indices
    shortest: Floats
    longest: Floats
    stiffness: Floats

    @classmethod
    def of(
        cls, links: Sequence[DistanceConstraint], stiffness: Floats
    ) -> "DistanceConstraints | None":
        """Prepare constraints between handles of this stiffness (h,).

        Raises
        ------
        EngineError
            If a constraint names a handle that does not exist, or has no range of distances.
        """
        if not links:
            return None
        for first, second, shortest, longest in links:
            if first == second or not all(end in range(len(stiffness)) for end in (first, second)):
                raise EngineError(CONSTRAINT_ENDS, first=first, second=second)
            if not 0 <= shortest <= longest:
                raise EngineError(CONSTRAINT_LENGTHS, shortest=shortest, longest=longest)
        ends = np.array([(link.first, link.second) for link in links], np.intp).T
        return cls(
            ends=readonly(ends),
            shortest=readonly(np.array([link.shortest for link in links])),
            longest=readonly(np.array([link.longest for link in links])),
            stiffness=readonly(stiffness[ends].max(axis=0)),
        )

    def _measure(self, positions: Complexes) -> tuple[Complexes, Floats, Floats]:
        """Return direction, length, and length beyond the range of each constraint (l,)."""
        between = positions[self.ends[0]] - positions[self.ends[1]]
        lengths = np.maximum(np.abs(between), np.finfo(np.float64).tiny)
        beyond = lengths - np.clip(lengths, self.shortest, self.longest)
        return between / lengths, lengths, beyond

    def energy(self, positions: Complexes) -> float:
        """Return the energy of the constraints with the handles (h,) at these positions."""
        return float(self.stiffness @ self._measure(positions)[2] ** 2)

    def gradient(self, positions: Complexes) -> Complexes:
        """Return the gradient of the energy (h,)."""
        directions, _, beyond = self._measure(positions)
        return self._at_handles(2.0 * self.stiffness * beyond * directions, len(positions))

    def hessian_product(self, positions: Complexes, changes: Complexes) -> Complexes:
        """Return the product (h,) of the energy's projected Hessian with changes of positions."""
        directions, along, across = self.stiffness_by_direction(positions)
        between = directions.conj() * (changes[self.ends[0]] - changes[self.ends[1]])
        given = directions * (along * between.real + 1j * across * between.imag)
        return self._at_handles(given, len(positions))

    def stiffness_by_direction(self, positions: Complexes) -> tuple[Complexes, Floats, Floats]:
        """Return each constraint's direction, and its stiffness along and across it, (l,)."""
        directions, lengths, beyond = self._measure(positions)
        twice = 2.0 * self.stiffness
        return directions, twice * (beyond != 0), twice * np.maximum(beyond / lengths, 0.0)

    def _at_handles(self, of_links: Complexes, count: int) -> Complexes:
        at = np.zeros(count, np.complex128)
        np.add.at(at, self.ends[0], of_links)
        np.subtract.at(at, self.ends[1], of_links)
        return at

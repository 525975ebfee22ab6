"""Bounded pulls on handles.

A handle is held by λ |e|², e its distance from its target. This force has no limit: a target far
beyond reach would move all other handles. A bounded pull has at most the force F. With ē the mean
error of its handles, Λ the sum of their λ and e₀ = F / (2 Λ), the part Λ |ē|² of their energy
becomes 2 Λ e₀ |ē| − Λ e₀² beyond e₀ (Huber 1964). This is the minimum of Λ |ē − s|² + 2 Λ e₀ |s|
over all s: the pull has the slack s, and its handles keep their formation.
"""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, readonly
from engine.errors import EngineError

# Largest force of a pull, per L. An arm needs 1 to 2 to straighten to its limits. Measured on 18
# pulls within reach: none is lost with 10, three are with 5.
MAX_PULL_FORCE = 10.0
FORCE_NOT_POSITIVE = "The force of a pull must be positive, not {pull:g}."
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

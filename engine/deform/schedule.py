"""How strongly the walls push and how far the leash reaches, from step to step of a drag."""

from dataclasses import dataclass, replace
from math import inf
from typing import Self

# Barrier weight: at the start, at most, and at least while handles move and when they have arrived.
FIRST, MOST, LEAST_MOVING, LEAST_RESTING = 1e-2, 100.0, 1e-3, 1e-6
RAISE, LOWER = 4.0, 0.5
SHORTEST_REACH = 0.1
# Lengths of steps that the bounds have cut short, and that they have not.
SHORT, FULL = 0.3, 0.7
# A drag gets on when its shortfall (handles from their targets, over L) is this much less than
# ever. After so many steps without that its barrier is begun afresh: where steps have been cut
# often, dual variables and added samples can hold a map fast that would have a way out. In the end
# it is at rest.
PROGRESS, RENEWALS, IDLE_AT_REST = 1e-3, (5, 10, 20, 30), 50


@dataclass(frozen=True, slots=True, kw_only=True)
class Schedule:
    """Barrier weight and reach of the leash, raised and lowered by what became of the steps.

    Parameters
    ----------
    weight : float
        Of the barrier: raised when a step was cut short, lowered when it was not.
    reach : float
        Part of the leash that is paid out, the other way round: the trust region.
    best : float
        Smallest shortfall since the wish changed.
    idle : int
        Steps without progress.
    """

    weight: float = FIRST
    reach: float = 1.0
    best: float = inf
    idle: int = 0

    def for_new_wish(self) -> Self:
        """Return the schedule with nothing reached yet."""
        return replace(self, best=inf, idle=0)

    def after(self, *, length: float, shortfall: float, moving: bool, overshot: bool) -> Self:
        """Return the schedule of the next step.

        Parameters
        ----------
        length : float
            Part of the step that was taken.
        shortfall : float
            How far the drag is from its wish.
        moving : bool
            Whether the handles are still far from their targets.
        overshot : bool
            Whether the length says nothing of the walls.
        """
        progress = shortfall < self.best - PROGRESS
        weight, reach = self.weight, self.reach
        if length < SHORT and not overshot:
            weight, reach = min(RAISE * weight, MOST), max(reach / 2, SHORTEST_REACH)
        elif length > FULL:
            least = LEAST_MOVING if moving else LEAST_RESTING
            weight, reach = max(LOWER * weight, least), min(2 * reach, 1.0)
        return replace(
            self,
            weight=weight,
            reach=reach,
            best=shortfall if progress else self.best,
            idle=0 if progress else self.idle + 1,
        )

    def renewed(self) -> Self:
        """Return the schedule with a barrier and a leash as at the start."""
        return replace(self, weight=FIRST, reach=1.0)

    @property
    def asks_for_renewal(self) -> bool:
        """Whether the barrier should be begun afresh now."""
        return self.idle in RENEWALS

    @property
    def at_rest(self) -> bool:
        """Whether more steps would most likely lead nowhere."""
        return self.idle >= IDLE_AT_REST

"""Stiffness of a layer: painted values and bones."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from app.document.checks import NOTHING, Unknown, require
from app.texts import N_
from engine.arrays import Floats, freeze
from engine.domain import MeshedDomain
from engine.domain.material.transfer import copy_nearest_stiffness
from engine.maps import SOFTEST, STIFFEST

DEFAULT_BONE_STIFFNESS = 10.0  # default of a bone
STIFFNESS_TOLERANCE = 1e-9  # a stiffness this close to 1 counts as 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Bone:
    """A stiff or soft strip between two handles, without the joints at its ends."""

    ends: tuple[int, int]  # handle ids
    stiffness: float = DEFAULT_BONE_STIFFNESS  # from 1/30 to 100
    is_shown: bool = True  # in the window; a hidden bone acts too
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(self.ends[0] != self.ends[1], N_("A bone must connect two different handles."))
        require_stiffness_amount(self.stiffness)

    def is_between(self, ends: Sequence[int]) -> bool:
        """Return whether the bone joins these two handles, in either order."""
        return set(ends) == set(self.ends)


def require_stiffness_amount(amount: float) -> None:
    """Raise a `LissomError` unless the stiffness is in the allowed range."""
    require(
        SOFTEST * (1 - STIFFNESS_TOLERANCE) <= amount <= STIFFEST,
        N_("Stiffness must be from 1/30 to {largest:g}, not {amount:g}; 1 is the default."),
        largest=STIFFEST,
        amount=amount,
    )


def combined_stiffness(stiffnesses: Sequence[Floats]) -> Floats:
    """Return the largest stiffness at each point; the smallest where all are at most 1."""
    largest: Floats = np.maximum.reduce(stiffnesses)
    return np.where(largest > 1.0, largest, np.minimum.reduce(stiffnesses))


def default_as_none(stiffness: Floats) -> Floats | None:
    """Return the clipped stiffness as a read-only array; None if it is 1 everywhere."""
    if (np.abs(stiffness - 1.0) < STIFFNESS_TOLERANCE).all():
        return None
    return freeze(np.clip(stiffness, SOFTEST, STIFFEST))


def transfer_painted_stiffness(
    stiffness: Floats | None, domain: MeshedDomain, into: MeshedDomain
) -> Floats | None:
    """Return the painted stiffness of a domain at the same points of another domain."""
    if stiffness is None or into is domain:
        return stiffness
    corners = np.concatenate(into.loops)
    return default_as_none(copy_nearest_stiffness(domain.loops, stiffness, corners))

"""What a layer is made of: where it is stiffer or softer than usual."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from app.document.checks import NOTHING, Unknown, require
from engine.arrays import Floats, freeze
from engine.domain import MeshedDomain
from engine.domain.material import copy_nearest_stiffness
from engine.maps import SOFTEST, STIFFEST

DEFAULT_BONE_STIFFNESS = 10.0  # of a bone
STIFFNESS_TOLERANCE = 1e-9  # so near to 1 a stiffness is the usual one


@dataclass(frozen=True, slots=True, kw_only=True)
class Bone:
    """A limb between two handles that is stiff, or soft, but for the joints at its ends."""

    ends: tuple[int, int]  # the ids of its handles
    stiffness: float = DEFAULT_BONE_STIFFNESS  # its stiffness, from 1/30 to 100
    is_shown: bool = True  # whether it is seen; it acts either way
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(self.ends[0] != self.ends[1], "A bone leads from one handle to another one.")
        require_stiffness_amount(self.stiffness)

    def is_between(self, ends: Sequence[int]) -> bool:
        """Tell whether it leads from one of two handles to the other, either way."""
        return set(ends) == set(self.ends)


def require_stiffness_amount(amount: float) -> None:
    """Raise a `LissomError` unless this is a stiffness that a part may have."""
    require(
        SOFTEST * (1 - STIFFNESS_TOLERANCE) <= amount <= STIFFEST,
        f"A stiffness is from 1/30 to {STIFFEST:g}, not {amount:g}; 1 is the usual one.",
    )


def combined_stiffness(stiffnesses: Sequence[Floats]) -> Floats:
    """Return the largest of some stiffnesses at each place; of soft ones alone the smallest."""
    largest: Floats = np.maximum.reduce(stiffnesses)
    return np.where(largest > 1.0, largest, np.minimum.reduce(stiffnesses))


def default_as_none(stiffness: Floats) -> Floats | None:
    """Return a stiffness that nobody can write to; None where it is 1 everywhere."""
    if (np.abs(stiffness - 1.0) < STIFFNESS_TOLERANCE).all():
        return None
    return freeze(np.clip(stiffness, SOFTEST, STIFFEST))


def transfer_painted_stiffness(
    stiffness: Floats | None, domain: MeshedDomain, into: MeshedDomain
) -> Floats | None:
    """Return what is painted on a domain at the same places of another one."""
    if stiffness is None or into is domain:
        return stiffness
    corners = np.concatenate(into.loops)
    return default_as_none(copy_nearest_stiffness(domain.loops, stiffness, corners))

"""Stiffness of a layer along its outline."""

from collections.abc import Sequence

import numpy as np

from app.document.checks import require
from app.texts import N_
from engine.arrays import Floats, freeze
from engine.domain import MeshedDomain
from engine.domain.material.transfer import copy_nearest_stiffness
from engine.maps import SOFTEST, STIFFEST

STIFFNESS_TOLERANCE = 1e-9  # a stiffness this close to 1 counts as 1


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

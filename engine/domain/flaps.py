"""Flaps: parts that a slit goes around, such as an arm over a trunk.

The slit begins and ends inside the domain, between the flap and the trunk. The trunk continues
under it from both sides. The sides meet at the flap's medial axis, or nearer to the side where less
of the trunk is seen: there a narrow strip shows too little to paint the trunk with.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from engine.arrays import Complexes, Floats, Indices
from engine.geometry import barycentric_weights

OVERLAP = 1.3  # of the width of a flap: how far both sides together continue
NEAR = 8.0  # samples along the line that are no opposite side
STEADY = 2.0  # samples over which widths are rounded
ALIKE = 1.01  # factor over the least diameter of discs that touch the line at several places
NEARER = 0.1  # weight of the distance beside how far a place is ahead
AHEAD = 0.8  # cosine of the angle between the normal and the direction to the opposite side
FLAT = 0.1  # least height of a triangle over its base, in which a place is located
LEAST_SHARE = 0.35  # of a flap's width: how far each side continues, also around bends
LEAST = 0.05  # of a flap's width: least width of what is seen, so that shares are defined


class FlapSides(NamedTuple):
    """How far the trunk continues under a flap from n samples of its line.

    Parameters
    ----------
    depths : float64, shape (n,)
    towards : complex128, shape (n,)
        Unit vectors into the flap: to the opposite side, if that is about ahead.
    opposite : intp, shape (n,)
        The sample on the other side.
    """

    depths: Floats
    towards: Complexes
    opposite: Indices


def measure_flap(way: Complexes, inwards: Complexes, seen: Floats) -> FlapSides:
    """Measure a flap along its line.

    Parameters
    ----------
    way, inwards : complex128, shape (n,)
        Evenly spaced points, and unit vectors into the flap.
    seen : float64, shape (n,)
        Width of the trunk that is seen beside each point.

    Notes
    -----
    A disc in the flap touches its line at a point b with inward normal n, and at a point c. Its
    radius is the least of |c − b|² / (2 Re (c − b) n̄) over all c. Each point of the flap lies
    between its nearest point of the line and the disc's centre there, so that both sides leave no
    gap if each continues to the medial axis.
    """
    apart = way - way[:, None]
    ahead = (apart * inwards.conj()[:, None]).real
    numbers = np.arange(len(way))
    is_other = (np.abs(numbers - numbers[:, None]) > NEAR) & (ahead > 0)
    diameters = np.full(ahead.shape, np.inf)
    diameters[is_other] = np.abs(apart[is_other]) ** 2 / ahead[is_other]
    widths = diameters.min(axis=1)
    # A disc in a round end touches it along an arc: of these, the place that is most ahead.
    is_touched = diameters <= ALIKE * widths[:, None]
    opposite = np.where(is_touched, ahead - NEARER * np.abs(apart), -np.inf).argmax(axis=1)
    towards = way[opposite] - way
    towards /= np.maximum(np.abs(towards), 1e-9)
    is_ahead = (towards * inwards.conj()).real > AHEAD
    towards = np.where(is_ahead, towards, inwards)
    widths[~np.isfinite(widths)] = 0.0
    widths = ndimage.gaussian_filter1d(widths, STEADY, mode="nearest")
    least = LEAST * widths + 1e-9
    shares = (seen + least) / (seen + seen[opposite] + 2 * least)
    return FlapSides(np.clip(OVERLAP * shares, LEAST_SHARE, 1.0) * widths, towards, opposite)


def locate_between(places: Complexes, across: Indices, wanted: Complexes) -> tuple[Indices, Floats]:
    """Return wanted places (n,) as sums of three places: each, that across, and one more.

    Return the third place's index (n,), and the weights (n, 3), as small as they can be.
    """
    count = len(places)
    numbers = np.arange(count)
    one, third = np.repeat(numbers, count), np.tile(numbers, count)
    corners = np.column_stack([places[one], places[across[one]], places[third]])
    edges = corners[:, 1:] - corners[:, :1]
    is_flat = np.abs((edges[:, 0].conj() * edges[:, 1]).imag) < FLAT * np.abs(edges[:, 0]) ** 2
    corners[is_flat, 2] = places[one[is_flat]] + 1j * edges[is_flat, 0]
    weights = barycentric_weights(corners, wanted[one]).reshape(count, count, 3)
    size = np.abs(weights).max(axis=2)
    size[is_flat.reshape(count, count)] = np.inf
    best = size.argmin(axis=1)
    return best, weights[numbers, best]

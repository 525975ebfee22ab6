"""The covered sides of slits: edges in a mesh along the lines of the slits, and the room there."""

from typing import NamedTuple

import numpy as np
import shapely
from scipy import ndimage

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.geometry import arc_lengths, as_xy, diameter

BESIDE = 3.0  # slit widths: a vertex on a side of a slit is this near to its line
SPACING, ROUNDING = 2.0, 3.0  # slit widths between samples of a line, samples of its rounding


class LineSamples(NamedTuple):
    """Evenly spaced samples (n,) of a line: where along it, their places, and unit tangents."""

    at: Floats
    way: Complexes
    tangents: Complexes


def sample_line(line: Complexes, width: float) -> LineSamples:
    lengths = arc_lengths(line)
    count = max(8, int(lengths[-1] / (SPACING * width)))
    at = np.linspace(0.0, lengths[-1], count)
    way = np.asarray(np.interp(at, lengths, line), np.complex128)
    tangents = ndimage.gaussian_filter1d(np.gradient(way), ROUNDING, mode="nearest")
    return LineSamples(at, way, np.asarray(tangents / np.abs(tangents), np.complex128))


def find_covered_side(
    vertices: Complexes, border: Indices, line: LineSamples, width: float
) -> tuple[Indices, Indices]:
    """Return the edges of a border (e, 2), the inside on their left, on a line's covered side.

    Also of both ends of each in turn (2 e,) the nearest sample of the line.
    """
    away = np.abs(vertices[border][..., None] - line.way)
    nearest = away.argmin(axis=2)
    # The slit may lie a little beside its line, but the inside is to the left of both.
    along = np.diff(vertices[border], axis=1)[:, 0]
    is_covered = (along.conj() * line.tangents[nearest[:, 0]]).real > 0
    is_covered &= (away.min(axis=2) < BESIDE * width).all(axis=1)
    return border[is_covered], nearest[is_covered].ravel()


def are_tips(region: shapely.Polygon, line: Complexes, ahead: float) -> Booleans:
    """Return for both ends of a slit's line whether the slit ends there inside a region.

    It does if places ahead of the end are inside, and no slit goes on to them.
    """
    lengths = arc_lengths(line)
    back = np.interp([ahead, lengths[-1] - ahead], lengths, line)
    ways = line[[0, -1]] - back
    ends = shapely.points(as_xy(line[[0, -1]] + ahead * ways / np.abs(ways)))
    is_free = shapely.distance(region.boundary, ends) > ahead / 2
    return np.asarray(is_free & shapely.contains(region, ends), np.bool_)


def find_room(region: shapely.Polygon, places: Complexes, directions: Complexes) -> Floats:
    """Return how far rays run inside a region from places (n,)."""
    most = diameter(np.asarray(shapely.get_coordinates(region) @ [1, 1j]))
    ends = places + most * directions
    rays = shapely.linestrings(np.stack([as_xy(places), as_xy(ends)], axis=1))
    room = np.full(len(places), most)
    hits, numbers = shapely.get_coordinates(
        shapely.intersection(region.boundary, rays), return_index=True
    )
    np.minimum.at(room, numbers, np.abs(hits @ [1, 1j] - places[numbers]))
    room[~shapely.contains_xy(region, places.real, places.imag)] = 0.0
    return room

"""What must hold of every outline and its cage."""

import numpy as np
import shapely
from scipy import ndimage

from engine.arrays import Booleans, Complexes, Floats
from engine.domain.mask.parts import WholePiece
from engine.domain.outline.enclosure import Enclosure
from engine.geometry import Hole
from engine.geometry.polygon import (
    as_xy,
    contains,
    diameter,
    distance_to_boundary,
    edge_vectors,
    is_simple,
    signed_area,
)

SPECK = 2e-4


def notices_of(enclosure: Enclosure | WholePiece) -> tuple[str, ...]:
    """The notices of an outline or a piece, in words."""
    return tuple(map(str, enclosure.notices))


def check_cage(outline: Complexes, cage: Complexes) -> None:
    assert len(cage) == len(outline)
    assert signed_area(cage) > 0
    around = shapely.Polygon(as_xy(cage))
    assert around.is_valid
    assert around.contains_properly(shapely.Polygon(as_xy(outline)))
    nearest = min(
        distance_to_boundary(outline, cage).min(), distance_to_boundary(cage, outline).min()
    )
    assert nearest >= 0.0003 * diameter(outline)


def check_hole(hole: Hole, size: float) -> None:
    """Hold a hole's outline and cage against what is promised of them."""
    outline, cage = hole.outline, hole.cage
    assert len(cage) == len(outline)
    for loop in (outline, cage):
        assert is_simple(loop)
        assert signed_area(loop) < 0
    assert shapely.Polygon(as_xy(outline)).contains_properly(shapely.Polygon(as_xy(cage)))
    nearest = min(
        distance_to_boundary(outline, cage).min(), distance_to_boundary(cage, outline).min()
    )
    assert nearest >= 0.0003 * diameter(outline)
    assert np.abs(edge_vectors(outline)).min() >= 0.001 * size
    # As of every outline, seen from the domain; there are no angles for the mesh to fail at.
    angles = interior_angles(outline) % 360
    assert angles.min() >= 20
    assert angles.max() <= 345
    assert contains(cage, np.array([hole.centre])).all()
    assert distance_to_boundary(cage, np.array([hole.centre]))[0] > 0


def diagonal(mask: Booleans) -> float:
    rows, columns = np.nonzero(mask)
    return float(np.hypot(np.ptp(rows) + 1, np.ptp(columns) + 1))


def without_specks(mask: Booleans) -> Booleans:
    labels, _ = ndimage.label(mask, np.ones((3, 3)))
    areas = np.bincount(labels.ravel())
    areas[0] = 0
    return np.asarray((areas >= SPECK * areas.sum())[labels])


def corners_of(mask: Booleans) -> Complexes:
    """The four corners of every pixel, in the outline's coordinates."""
    padded = np.pad(mask, 1)
    nodes = padded[:-1, :-1] | padded[:-1, 1:] | padded[1:, :-1] | padded[1:, 1:]
    rows, columns = np.nonzero(nodes)
    return columns + 1j * (mask.shape[0] - rows)


def interior_angles(polygon: Complexes) -> Floats:
    along = edge_vectors(polygon)
    return np.degrees(np.pi - np.angle(along / np.roll(along, 1)))


def check_outline(mask: Booleans, enclosure: Enclosure, *, most: int = 200) -> None:
    points, size = enclosure.outline, diagonal(mask)
    assert is_simple(points)
    assert signed_area(points) > 0
    check_cage(points, enclosure.cage)
    lengths = np.abs(edge_vectors(points))
    assert lengths.min() >= 0.001 * size
    assert lengths.max() <= 0.0701 * size
    assert interior_angles(points).min() >= 20
    assert interior_angles(points).max() <= 345
    assert len(points) <= most
    # Whole pixels, not only their centres.
    assert contains(points, corners_of(without_specks(mask)), tolerance=1e-9).all()
    for array in (points, enclosure.cage):
        assert not array.flags.writeable

"""Data of corrections that depends only on the domain, its anchor and the points."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Complexes, as_points, nbytes_of
from engine.deform.correction.paths import PointPaths
from engine.deform.correction.variables import Variables
from engine.geometry import ON_OUTLINE, require_inside
from engine.maps import Boundary


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointCorrector:
    """Corrections of frames of one domain with targets for some of its points.

    `points` are in the domain at rest, (m,).
    """

    boundary: Boundary
    points: Complexes
    paths: PointPaths
    variables: Variables

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return nbytes_of(self, but=(self.boundary,))


def build_corrector(boundary: Boundary, anchor: complex, points: Complexes) -> PointCorrector:
    """Prepare corrections with targets for points (m,); integrals begin at the anchor.

    Raises
    ------
    EngineError
        If a point or the anchor is outside the domain.
    """
    points = as_points(points, "points")
    require_inside(
        boundary.outline,
        np.append(points, as_points([anchor], "anchor")),
        "point of a correction",
        holes=[hole.outline for hole in boundary.holes],
        tolerance=ON_OUTLINE * boundary.size,
    )
    paths = PointPaths.of(boundary, anchor, points)
    return PointCorrector(
        boundary=boundary,
        points=points,
        paths=paths,
        variables=Variables.of(boundary, paths.nodes, points),
    )

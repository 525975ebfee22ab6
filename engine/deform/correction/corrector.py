"""All that corrections share that depends on the domain, its anchor and the points alone."""

from dataclasses import dataclass

from engine.arrays import Complexes, held_bytes
from engine.deform.correction.paths import PointPaths
from engine.deform.correction.variables import Variables
from engine.maps import Boundary


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointCorrector:
    """Corrections of frames of one domain with targets for some of its points.

    Parameters
    ----------
    boundary : Boundary
    points : complex128, shape (m,)
        In the domain at rest.
    paths : PointPaths
    variables : Variables
    """

    boundary: Boundary
    points: Complexes
    paths: PointPaths
    variables: Variables

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return held_bytes(self, but=(self.boundary,))


def corrector_of(boundary: Boundary, anchor: complex, points: Complexes) -> PointCorrector:
    """Prepare corrections with targets for points (m,); the anchor is where integrals begin."""
    paths = PointPaths.of(boundary, anchor, points)
    return PointCorrector(
        boundary=boundary,
        points=points,
        paths=paths,
        variables=Variables.of(boundary, paths.nodes, points),
    )

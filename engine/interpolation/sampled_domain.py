"""The domain with the points of the in-betweens: everything that does not depend on a keyframe."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, as_points, freeze, nbytes_of
from engine.dirichlet import Extension
from engine.errors import EngineError
from engine.geometry import ON_OUTLINE, deepest_point, diameter, require_inside
from engine.interpolation.added.hole_closer import HoleCloser
from engine.maps import Boundary
from engine.paths import (
    IntegrationPaths,
    Loops,
    chain_starts,
    continue_logarithm,
    lay_paths,
    mesh_network,
    scattered_network,
    with_chains,
    with_loops,
)

ONE_ANCHOR = (
    "The in-betweens need exactly one anchor, not {count}. Leave the anchor out, and the engine "
    "chooses one."
)
OTHER_OUTLINE = (
    "The Hilbert transform is for an outline of {others} vertices, but the points have an "
    "outline of {own}. Build the transform again for this outline."
)
OTHER_POINTS = (
    "The Hilbert transform is prepared for other points. Prepare it for the nodes of the sites' "
    "paths."
)
NO_SAMPLES = (
    "A proof needs the boundary samples, either as the first points or as the last value points."
)
VALUES_OR_TRIANGLES = (
    "The domain has triangles, so it cannot also have points for values alone; prepare separate "
    "sites for those points."
)


def _none() -> Complexes:
    return np.empty(0, dtype=np.complex128)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SampledDomain:
    """A domain with the points of its in-betweens, shared by all keyframes.

    Build it with `sample_domain`.

    Attributes
    ----------
    diameter : float
        Largest distance between two vertices of the outline.
    points : complex128, shape (m,)
    paths : IntegrationPaths
        From the anchor to the points, and around holes.
    loops : Loops
        Around the holes, at the nodes `paths.around`.
    arguments : float64, shape (1 + m, holes)
        Arguments of z − c_j at the anchor and the points, continued along the paths.
    closer : HoleCloser or None
        Closes the periods around holes; None without holes.
    value_points : complex128, shape (v,)
        Points at which in-betweens have derivatives but no positions.
    """

    diameter: float
    points: Complexes
    paths: IntegrationPaths
    boundary: Boundary
    loops: Loops
    arguments: Floats
    closer: HoleCloser | None
    value_points: Complexes = field(default_factory=_none)

    @property
    def outline(self) -> Complexes:
        """Outer loop of the boundary, complex128 (p,)."""
        return self.boundary.outline

    @property
    def cage(self) -> Complexes:
        """Polygon of the Cauchy coordinates, complex128 (n,)."""
        return self.boundary.cage

    @property
    def anchor(self) -> complex:
        """The point whose pose is given."""
        return complex(self.paths.nodes[0])

    def require_boundary(self, loops: Sequence[Complexes]) -> None:
        """Raise if the loops of a Hilbert transform are not those of this domain.

        Raises
        ------
        EngineError
            If the loops differ.
        """
        own = self.boundary.loops
        if len(loops) != len(own) or not all(map(np.array_equal, loops, own)):
            raise EngineError(OTHER_OUTLINE, others=sum(map(len, loops)), own=sum(map(len, own)))

    def require_extension(self, extension: Extension) -> None:
        """Raise if a transform is not at the nodes of this domain's paths.

        Raises
        ------
        EngineError
            If the outlines or the points differ.
        """
        self.require_boundary(extension.loops)
        if not np.array_equal(extension.points, self.paths.nodes):
            raise EngineError(OTHER_POINTS)

    def sample_nodes(self) -> Indices:
        """Return the nodes at the samples of the boundary, (p,).

        Raises
        ------
        EngineError
            If the samples are neither the first points nor the last value points.
        """
        samples = self.boundary.points
        count = len(samples)
        if np.array_equal(self.points[:count], samples):
            return self.paths.places[:count]
        if np.array_equal(self.value_points[-count:], samples):
            return self.paths.beside[-count:]
        raise EngineError(NO_SAMPLES)

    @property
    def nbytes(self) -> int:
        return nbytes_of(self)


def sample_domain(
    boundary: Boundary,
    points: npt.ArrayLike,
    *,
    triangles: npt.ArrayLike | None = None,
    anchor: npt.ArrayLike | None = None,
    values_at: npt.ArrayLike = (),
) -> SampledDomain:
    """Find paths inside the domain from the anchor to every point.

    Parameters
    ----------
    boundary : Boundary
        From `Boundary.sample`; several sampled domains may share it.
    points : complex, shape (m,)
        In the closed domain, to 1e-9 of its diameter.
    triangles : int, shape (t, 3), optional
        Triangles of the points; the paths follow their edges. Without triangles the engine finds
        its own paths.
    anchor : complex, optional
        Default: centre of the largest disc in the domain. It is farthest from the cage, where the
        maps are smoothest and their arguments least extreme.
    values_at : complex, shape (v,), optional
        Further points for derivatives only, not allowed with triangles. A point costs one node if a
        straight path from the previous point stays in the domain.

    Raises
    ------
    EngineError
        If a point, a triangle or the anchor breaks one of these conditions.
    """
    points = as_points(points, "points", at_least=1)
    outline, *inner = boundary.loops
    tolerance = ON_OUTLINE * diameter(outline)
    root = np.array([deepest_point(outline, inner)]) if anchor is None else _single(anchor)
    require_inside(outline, root, "anchor", holes=inner, tolerance=tolerance)
    require_inside(outline, points, "point", holes=inner, tolerance=tolerance)
    beside = as_points(values_at, "values_at")
    require_inside(outline, beside, "point for values", holes=inner, tolerance=tolerance)
    corners, cages = np.concatenate(boundary.loops), boundary.span.vertices
    loops = Loops.around(outline, inner, np.concatenate([corners, cages]))
    if triangles is None:
        # Without a mesh no path but the loops may come near a hole.
        starts = chain_starts(boundary.loops, beside)
        everything = np.concatenate([points, loops.nodes[loops.starts], beside[starts]])
        network = with_chains(
            scattered_network(outline, everything, root, holes=inner), beside, starts
        )
        network = replace(network, places=network.places[: len(points)])
    elif len(beside):
        raise EngineError(VALUES_OR_TRIANGLES)
    else:
        network = mesh_network(outline, points, _as_triangles(triangles), root, holes=inner)
    if inner:
        network = with_loops(network, outline, inner, loops)
    paths = lay_paths(network, corners, cages)
    return SampledDomain(
        diameter=diameter(outline),
        points=points,
        paths=paths,
        boundary=boundary,
        loops=loops,
        arguments=freeze(_arguments(paths, boundary.span.centres)),
        closer=HoleCloser.of(boundary, loops, paths.nodes) if inner else None,
        value_points=beside,
    )


def _arguments(paths: IntegrationPaths, centres: Complexes) -> Floats:
    """Return the arguments (1 + m, holes) of z − c_j, continued from the anchor to the points."""
    ends = np.concatenate([[0], paths.places])
    continued = np.empty((len(ends), len(centres)))
    for column, centre in enumerate(centres):
        away = paths.nodes - centre
        logarithms = continue_logarithm(away, 1 / away, paths, partial(np.add, -centre))
        continued[:, column] = logarithms.imag[ends]
    return continued


def _single(anchor: npt.ArrayLike) -> Complexes:
    if np.size(anchor) != 1:
        raise EngineError(ONE_ANCHOR, count=np.size(anchor))
    return as_points(np.reshape(anchor, (1,)), "anchor")


def _as_triangles(values: npt.ArrayLike) -> npt.NDArray[np.int32]:
    triangles = np.asarray(values)
    if triangles.ndim != 2 or triangles.shape[1] != 3 or triangles.dtype.kind not in "iu":
        raise EngineError(
            "triangles must be integers of shape (t, 3), not {dtype} of shape {shape}.",
            dtype=triangles.dtype,
            shape=triangles.shape,
        )
    return triangles.astype(np.int32)

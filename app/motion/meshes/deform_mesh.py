"""A mesh that a pose deforms, and points located on the mesh."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial

import numpy as np
import numpy.typing as npt

from app.cut_out import CutOut
from app.document import Clip, Layer, Limbs, Pose, find_limbs
from app.motion.meshes.triangle_order import TriangleOrder
from engine.arrays import Booleans, Complexes, Floats, Integers
from engine.domain import ClosedCuts, MeshedDomain, find_closed_cuts
from engine.domain.meshing.draw_order import copy_draw_order
from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.triangulation import triangulate
from engine.geometry import barycentric_weights
from engine.maps import Span

# Triangles of the coarse meshes of all layers together, used while the full meshes are too slow,
# and the smallest number per layer.
COARSE_TRIANGLES = 12_000
FEWEST_TRIANGLES = 4_000
# A layer has a coarse mesh only if its own is finer by this factor: everything prepared for a layer
# is then prepared for both meshes.
FINER = 2
_KEPT = 8  # sets of located points per mesh: handles, limbs, joints, anchors and pivots
EDGE = 1e-6  # tolerance of barycentric weights for rounding


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MeshPoints:
    """Points located on a mesh, by triangle and barycentric weights."""

    vertices: Integers  # int32 (p, 3)
    # float64 (p, 3): Barycentric; outside the mesh one weight is clearly negative.
    weights: Floats

    @property
    def is_inside(self) -> Booleans:
        """Whether each point is in the mesh, (p,)."""
        inside: Booleans = self.weights.min(axis=1) >= -EDGE
        return inside

    def positions_on(self, positions: Complexes) -> Complexes:
        """Return the positions of the points for these positions of the mesh's vertices."""
        places: Complexes = (self.weights * positions[self.vertices]).sum(axis=1)
        return places

    def rotations(self, rest: Complexes, positions: Complexes) -> Floats:
        """Return the rotation angles of the mesh at the points, arg f_z."""
        before, after = rest[self.vertices], positions[self.vertices]
        u, v = before[:, 1] - before[:, 0], before[:, 2] - before[:, 0]
        p, q = after[:, 1] - after[:, 0], after[:, 2] - after[:, 0]
        # The affine map p = F u + conj(G) conj(u), q likewise; F up to a positive factor.
        angles: Floats = np.angle((p * v.conj() - q * u.conj()) / (u * v.conj() - v * u.conj()))
        return angles


@dataclass(kw_only=True, eq=False)
class DeformMesh:
    """A mesh of a domain, which any pose deforms."""

    domain: MeshedDomain  # with the displayed mesh, which may be coarser than the layer's own
    source: MeshedDomain  # the layer's own domain
    is_released: bool = field(init=False, default=False)  # whether its coordinates were freed
    _cuts: tuple[CutOut, ClosedCuts | None] | None = field(init=False, default=None)

    @cached_property
    def order(self) -> TriangleOrder:
        """Drawing order of the mesh's triangles."""
        return TriangleOrder(self.domain.mesh)

    @cached_property
    def coordinates(self) -> npt.NDArray[np.complex64]:
        """Values of the basis functions of maps at the vertices, complex64 (v, n).

        Single precision is enough for a screen.
        """
        return _span(self.domain).coordinates(self.domain.mesh.vertices).astype(np.complex64)

    @cached_property
    def _located(self) -> Callable[[tuple[complex, ...]], MeshPoints]:
        return lru_cache(maxsize=_KEPT)(partial(_locate_at_rest, self.domain.mesh))

    @classmethod
    def fine(cls, source: MeshedDomain) -> "DeformMesh":
        return cls(domain=source, source=source)

    @classmethod
    def coarse(cls, source: MeshedDomain, *, among: int = 1) -> "DeformMesh":
        """Return a coarse mesh of the domain, or the layer's own if that is not much finer.

        The triangle budget is divided by `among`, the number of drawn layers.
        """
        wanted = max(FEWEST_TRIANGLES, COARSE_TRIANGLES // among)
        if len(source.mesh.triangles) <= FINER * wanted:
            return cls.fine(source)
        mesh = triangulate(source.outline, wanted, holes=source.loops[1:])
        coarse = replace(source, mesh=copy_draw_order(mesh, source.mesh))
        return cls(domain=coarse, source=source)

    def prepared(self, clip: Clip, frame: float) -> "DeformMesh":
        """Return the mesh, ready to show a frame without delay; on a worker thread."""
        _ = self.coordinates
        self.is_released = False
        self.order.triangles(clip, frame)
        self.closed_cuts(clip.layer)
        self.locate_handles(clip.layer)
        limbs = find_limbs(clip.layer)
        if limbs is not None:
            self.locate_limbs(limbs)
        return self

    def closed_cuts(self, layer: Layer) -> ClosedCuts | None:
        """Return the closed slits of the mesh, for a layer of its domain; None without slits."""
        if self._cuts is None or self._cuts[0] is not layer.cut_out:
            covered = layer.cut_out.covered_lines(layer.corner)
            self._cuts = layer.cut_out, find_closed_cuts(self.domain, covered)
        return self._cuts[1]

    @property
    def coordinates_bytes(self) -> int:
        """Bytes of the coordinates; 0 unless they are prepared."""
        return self.coordinates.nbytes if "coordinates" in self.__dict__ else 0

    def forget_coordinates(self) -> None:
        """Free the coordinates, which can be computed again soon."""
        self.is_released = True
        self.__dict__.pop("coordinates", None)

    def locate(self, points: Complexes, positions: Complexes) -> MeshPoints:
        """Locate points (p,) in the mesh with vertices at `positions` (v,).

        The positions may be undeformed, or of a pose.
        """
        return _locate(self.domain.mesh.triangles, points, positions)

    def locate_at_rest(self, places: Iterable[complex]) -> MeshPoints:
        """Locate places in the undeformed mesh; the last results are cached."""
        return self._located(tuple(places))

    def locate_handles(self, layer: Layer) -> MeshPoints:
        """Locate a layer's handles in the undeformed mesh."""
        return self.locate_at_rest(handle.position for handle in layer.handles)

    def locate_limbs(self, limbs: Limbs) -> MeshPoints:
        """Locate the points of a layer's limbs in the undeformed mesh."""
        return self.locate_at_rest(limbs.points.tolist())

    def derivatives(self, positions: Complexes) -> tuple[Complexes, Complexes]:
        """Return f_z and f_z̄ of the drawn triangles at the vertices, each (v,)."""
        return _mean_derivatives(self.domain.mesh, positions)

    def pose_vertices(self, pose: Pose) -> Complexes:
        """Return the positions (v,) of the vertices in a pose."""
        # Relative to the identity, to lose fewer digits far from the origin.
        span = _span(self.domain)
        phi = np.concatenate([pose.phi, pose.logs]) - span.identity()
        psi = np.concatenate([pose.psi, pose.logs.conj()])
        moved = np.column_stack([phi, psi]).astype(np.complex64)
        shift = self.coordinates @ moved
        places: Complexes = self.domain.mesh.vertices + shift[:, 0] + shift[:, 1].conj()
        return places


def _locate_at_rest(mesh: Mesh, places: tuple[complex, ...]) -> MeshPoints:
    return _locate(mesh.triangles, np.array(places, dtype=np.complex128), mesh.vertices)


def _locate(triangles: Integers, points: Complexes, positions: Complexes) -> MeshPoints:
    corners = positions[triangles]
    low, high = corners.real.min(axis=1), corners.real.max(axis=1)
    bottom, top = corners.imag.min(axis=1), corners.imag.max(axis=1)
    found, weights = [], []
    for point in points:
        x, y = point.real, point.imag
        near = np.flatnonzero((low <= x) & (x <= high) & (bottom <= y) & (y <= top))
        near_weights = barycentric_weights(corners[near], point)
        inside = np.flatnonzero(near_weights.min(axis=1) >= -EDGE)
        if not len(inside):
            near, near_weights = np.arange(len(triangles)), barycentric_weights(corners, point)
            inside = near_weights.min(axis=1).argmax()[None]
        # Of overlapping triangles, the last is drawn on top.
        found.append(near[inside[-1]])
        weights.append(near_weights[inside[-1]])
    return MeshPoints(
        vertices=triangles[np.array(found, dtype=np.intp)],
        weights=np.array(weights, dtype=np.float64).reshape(len(found), 3),
    )


def _mean_derivatives(mesh: Mesh, positions: Complexes) -> tuple[Complexes, Complexes]:
    """Return area-weighted means of the affine maps of the triangles at each vertex."""
    rest, after = mesh.vertices[mesh.triangles], positions[mesh.triangles]
    u, v = rest[:, 1] - rest[:, 0], rest[:, 2] - rest[:, 0]
    p, q = after[:, 1] - after[:, 0], after[:, 2] - after[:, 0]
    # p = a u + b conj(u) and q = a v + b conj(v). The determinant is −2i times twice the area, so
    # sums of a and b times the determinant are area-weighted.
    determinant = u * v.conj() - v * u.conj()
    parts = (p * v.conj() - q * u.conj(), u * q - v * p, determinant)
    sums = [_gather(part, mesh) for part in parts]
    return sums[0] / sums[2], sums[1] / sums[2]


def _gather(values: Complexes, mesh: Mesh) -> Complexes:
    """Sum the values of its triangles at each vertex."""
    corners = mesh.triangles.ravel()
    count = len(mesh.vertices)
    real = np.bincount(corners, np.repeat(values.real, 3), minlength=count)
    imaginary = np.bincount(corners, np.repeat(values.imag, 3), minlength=count)
    return real + 1j * imaginary


def _span(domain: MeshedDomain) -> Span:
    return Span(cage=domain.cage, holes=domain.holes)

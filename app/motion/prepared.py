"""What is ready to be shown of a document: its poses and in-betweens on one of its meshes.

Preparing in-betweens takes a while and happens on the worker thread; showing them must never wait.
A `Motion` is frozen: it knows the in-betweens of the poses that it was prepared for, and says so
where it is asked about others.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.document import Document, Moment, Pose, Variant, intervals, resting_pose, time_of
from app.motion.inbetweens import Stage, has_rough
from app.motion.vertices import Placed, Streamed, Vertices
from engine.arrays import Booleans, Complexes, Floats, Integers
from engine.domain import Domain, mesh_inside
from engine.domain.meshing import Mesh
from engine.interpolation import Inbetweens
from engine.maps import cauchy_coordinates
from engine.streaming import Series

# Triangles of the mesh that is shown while the full one would be too slow.
SKETCH_TRIANGLES = 12_000
EDGE = 1e-6  # barycentric weights that rounding may lack of 0
# By what two poses' in-betweens are known: the maps alone, since handles may come and go.
Pair = tuple[int, int, int, int, int, Variant]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Places:
    """Points that stick to a figure, by the triangles they are in.

    Parameters
    ----------
    vertices : int32, shape (p, 3)
    weights : float64, shape (p, 3)
        Barycentric; one is clearly negative where a point is outside the figure.
    """

    vertices: Integers
    weights: Floats

    @property
    def inside(self) -> Booleans:
        """Which of the points are in the figure, (p,)."""
        inside: Booleans = self.weights.min(axis=1) >= -EDGE
        return inside

    def on(self, positions: Complexes) -> Complexes:
        """Return where the points are when the figure's vertices are at these positions."""
        places: Complexes = (self.weights * positions[self.vertices]).sum(axis=1)
        return places

    def turns(self, rest: Complexes, positions: Complexes) -> Floats:
        """Return by which angles the figure turns around the points, arg f_z."""
        before, after = rest[self.vertices], positions[self.vertices]
        u, v = before[:, 1] - before[:, 0], before[:, 2] - before[:, 0]
        p, q = after[:, 1] - after[:, 0], after[:, 2] - after[:, 0]
        # The affine map p = F u + conj(G) conj(u), q likewise; F up to a positive factor.
        angles: Floats = np.angle((p * v.conj() - q * u.conj()) / (u * v.conj() - v * u.conj()))
        return angles


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Figure:
    """A mesh of a domain, with what takes any pose to the places of its vertices.

    Parameters
    ----------
    domain : Domain
        With the mesh that is shown, which may be coarser than the document's own.
    source : Domain
        The document's.
    coordinates : complex64, shape (v, n)
        Cauchy coordinates of the vertices: single precision is plenty for a screen.
    """

    domain: Domain
    source: Domain
    coordinates: npt.NDArray[np.complex64]

    @classmethod
    def full(cls, source: Domain) -> "Figure":
        """Return the document's own mesh."""
        return cls(domain=source, source=source, coordinates=_coordinates(source))

    @classmethod
    def sketch(cls, source: Domain) -> "Figure":
        """Return a coarse mesh of the same domain, or the document's own if that is as coarse."""
        if len(source.mesh.triangles) <= SKETCH_TRIANGLES:
            return cls.full(source)
        coarse = replace(source, mesh=mesh_inside(source.outline, SKETCH_TRIANGLES))
        return cls(domain=coarse, source=source, coordinates=_coordinates(coarse))

    def locate(self, points: Complexes, positions: Complexes) -> "Places":
        """Find points in the figure whose vertices are at `positions`.

        Parameters
        ----------
        points : complex128, shape (p,)
        positions : complex128, shape (v,)
            The domain's own vertices, or a pose of them.
        """
        corners = positions[self.domain.mesh.triangles]
        origin, side, other = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2]
        other = other - origin
        area = _cross(side, other)
        found, weights = [], []
        for point in points:
            offset = point - origin
            v, w = _cross(offset, other) / area, _cross(side, offset) / area
            depth = np.minimum(np.minimum(v, w), 1.0 - v - w)
            inside = np.flatnonzero(depth >= -EDGE)
            # Of triangles on top of each other the last one is painted over the others.
            index = int(inside[-1]) if len(inside) else int(np.argmax(depth))
            found.append(index)
            weights.append((1.0 - v[index] - w[index], v[index], w[index]))
        return Places(
            vertices=self.domain.mesh.triangles[np.array(found, dtype=np.intp)],
            weights=np.array(weights, dtype=np.float64).reshape(len(found), 3),
        )

    def derivatives(self, positions: Complexes) -> tuple[Complexes, Complexes]:
        """Return f_z and f_z̄ at the vertices as the drawn triangles have them, each (v,)."""
        return _mean_derivatives(self.domain.mesh, positions)

    def posed(self, pose: Pose) -> Complexes:
        """Return where a pose takes the vertices, (v,)."""
        # Relative to the identity, so that few digits are lost far from the origin.
        cage = self.domain.cage
        moved = np.column_stack([pose.phi - cage, pose.psi]).astype(np.complex64)
        shift = self.coordinates @ moved
        places: Complexes = self.domain.mesh.vertices + shift[:, 0] + shift[:, 1].conj()
        return places


class Piece(NamedTuple):
    """The in-betweens of two poses, which it keeps alive so that their identities stay theirs.

    The series of the positions and of f_z and f_z̄ are None until they are built.
    """

    first: Pose
    second: Pose
    inbetweens: Inbetweens
    is_rough: bool = False
    series: Series | None = None
    distortions: Series | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """The motion of a document on a figure, as far as it is prepared.

    Parameters
    ----------
    figure : Figure
    document : Document
        What it was prepared for.
    stage : Stage, optional
        Of the worker alone; None as long as nothing moves.
    pieces : mapping of Pair to Piece
        Of the poses that follow each other.
    """

    figure: Figure
    document: Document
    stage: Stage | None
    pieces: Mapping[Pair, Piece]

    @classmethod
    def at_rest(cls, document: Document, figure: Figure) -> "Motion":
        """Return the motion that knows the keys only."""
        return cls(figure=figure, document=document, stage=None, pieces={})

    def vertices(self, document: Document, frame: float) -> Vertices | None:
        """Return where the vertices are at a frame; None where that is not prepared."""
        moment = time_of(document, frame)
        resting = resting_pose(document, moment)
        if resting is not None:
            return Placed(positions=self.figure.posed(resting))
        piece = self._piece(document, moment.interval)
        if piece is None:
            return None
        if piece.series is not None:
            return Streamed(piece.series, piece.distortions, moment.weight)
        return Placed(positions=piece.inbetweens.frame(_weights(moment)).positions)

    def positions(self, document: Document, frame: float) -> Complexes | None:
        """Return where the vertices are at a frame, worked out; None where that is not prepared."""
        vertices = self.vertices(document, frame)
        return None if vertices is None else vertices.positions

    def knows(self, document: Document, *, roughly: bool = False) -> bool:
        """Tell whether all in-betweens of a document are prepared, if only roughly."""
        if document.domain is not self.figure.source:
            return False
        pieces = [self._piece(document, interval) for interval in range(len(intervals(document)))]
        return all(piece is not None and (roughly or not piece.is_rough) for piece in pieces)

    def is_rough(self, document: Document, frame: float) -> bool:
        """Tell whether what is prepared of a frame is rough."""
        moment = time_of(document, frame)
        if resting_pose(document, moment) is not None:
            return False
        piece = self._piece(document, moment.interval)
        return piece is not None and piece.is_rough

    def inbetweens(self, document: Document, interval: int) -> Inbetweens:
        """Return the in-betweens of one of a document's intervals, which must be prepared."""
        piece = self._piece(document, interval)
        if piece is None:
            raise ValueError(f"the in-betweens of interval {interval} are not prepared")
        return piece.inbetweens

    def _piece(self, document: Document, interval: int) -> Piece | None:
        if document.anchor != self.document.anchor:
            return None
        return self.pieces.get(pair_of(document, interval))


def prepare_motion(
    document: Document,
    earlier: Motion,
    kin: Stage | None = None,
    *,
    roughly: bool = False,
    at_most: int | None = None,
) -> Motion:
    """Return the motion of a document with its in-betweens; on the worker thread.

    Parameters
    ----------
    document : Document
    earlier : Motion
        On the same figure; what it prepared is used again.
    kin : Stage, optional
        What it knows of the same outline and cage is used again.
    roughly : bool
        Whether rough in-betweens are enough.
    at_most : int, optional
        How many intervals to prepare; the others stay as they are. By default all.
    """
    stage, known = earlier.stage, earlier.pieces
    if document.anchor != earlier.document.anchor:
        stage, kin, known = None, earlier.stage or kin, {}
    pieces: dict[Pair, Piece] = {}
    made = 0
    rough = roughly and has_rough(document.variant)
    for interval, (first, last) in enumerate(intervals(document)):
        pair = pair_of(document, interval)
        if pair in pieces:
            # The same two poses again: copied keys, or a loop that goes to and fro.
            continue
        if pair in known:
            pieces[pair] = known[pair]
        is_enough = pair in known and (roughly or not known[pair].is_rough)
        if is_enough or made == at_most:
            continue
        made += 1
        stage = stage or Stage(earlier.figure.domain, anchor=document.anchor, kin=kin)
        key, following = document.keys[first], document.keys[last]
        inbetweens = stage.inbetweens(
            key.pose, following.pose, document.variant, turns=key.turns, rough=rough
        )
        pieces[pair] = Piece(key.pose, following.pose, inbetweens, is_rough=rough)
    if stage is not None:
        stage.keep_only([pose for piece in pieces.values() for pose in piece[:2]])
    return Motion(
        figure=earlier.figure, document=document, stage=stage, pieces=MappingProxyType(pieces)
    )


def pair_of(document: Document, interval: int) -> Pair:
    """Return by what the in-betweens of one of a document's intervals are known."""
    first, last = intervals(document)[interval]
    key, pose = document.keys[first], document.keys[last].pose
    maps = id(key.pose.phi), id(key.pose.psi), id(pose.phi), id(pose.psi)
    return *maps, key.turns, document.variant


def _weights(moment: Moment) -> npt.NDArray[np.float64]:
    return np.array([1.0 - moment.weight, moment.weight])


def _mean_derivatives(mesh: Mesh, positions: Complexes) -> tuple[Complexes, Complexes]:
    """Return the means, by area, of the affine maps of the triangles around each vertex."""
    rest, after = mesh.vertices[mesh.triangles], positions[mesh.triangles]
    u, v = rest[:, 1] - rest[:, 0], rest[:, 2] - rest[:, 0]
    p, q = after[:, 1] - after[:, 0], after[:, 2] - after[:, 0]
    # p = a u + b conj(u) and q = a v + b conj(v); the determinant is −2i times twice the area, so
    # that sums of a and b times it are sums by area.
    determinant = u * v.conj() - v * u.conj()
    parts = (p * v.conj() - q * u.conj(), u * q - v * p, determinant)
    sums = [_gather(part, mesh) for part in parts]
    return sums[0] / sums[2], sums[1] / sums[2]


def _gather(values: Complexes, mesh: Mesh) -> Complexes:
    """Add up at each vertex what its triangles have."""
    corners = mesh.triangles.ravel()
    count = len(mesh.vertices)
    real = np.bincount(corners, np.repeat(values.real, 3), minlength=count)
    imaginary = np.bincount(corners, np.repeat(values.imag, 3), minlength=count)
    return real + 1j * imaginary


def _cross(first: Complexes, second: Complexes) -> Floats:
    product: Floats = (first.conj() * second).imag
    return product


def _coordinates(domain: Domain) -> npt.NDArray[np.complex64]:
    return cauchy_coordinates(domain.cage, domain.mesh.vertices).astype(np.complex64)

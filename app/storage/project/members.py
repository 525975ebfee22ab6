"""The members of a project file with a layer's picture and arrays.

Each layer has a folder. The picture is stored byte for byte as `source.*`, beside the arrays of the
domain and of the cut-out drawn by hand. The maps phi and psi of each key are under `keys/`, those
of library poses under `poses/`.

If the domain has holes, `holes/` stores their outlines and cages. Hole centres are beside it, and
the coefficients of a map's logarithms are beside its phi and psi.

If cut lines part the domain, `closed.npy` stores the painted places of its loops. `stiffness.npy`
is the stiffness painted on the vertices of its loops.
"""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from app.cut_out import MOST_STROKE_POINTS, Mask
from app.document import Layer, PictureFile
from app.errors import LissomError
from app.storage.pictures.picture import stored_size
from app.storage.project.archive import Archive, array_member
from app.texts import N_, _
from engine.arrays import Complexes, Floats, as_points
from engine.domain import MOST_MESH_TRIANGLES, MeshedDomain, require_domain
from engine.domain.meshing.mesh import Mesh
from engine.domain.outline.enclosure import LARGEST_OUTLINE
from engine.geometry import Hole
from engine.maps import HarmonicMap

CENTRES, CLOSED = "hole_centres.npy", "closed.npy"
STIFFNESS = "stiffness.npy"
OTHER_CHECKSUM = N_("its picture is not the one that was saved: the checksums differ")


def layer_members(layer: Layer) -> dict[str, bytes]:
    """Return the members of a layer by their names, with those of its mesh before it was bent."""
    earlier = layer.before_bending
    kept = {} if earlier is None else _members_in(earlier_folder(layer.id), earlier)
    return _members_in(layer_folder(layer.id), layer) | kept


def _members_in(folder: str, layer: Layer) -> dict[str, bytes]:
    mesh, cut_out, holes = layer.domain.mesh, layer.cut_out, layer.domain.holes
    arrays: dict[str, npt.NDArray[Any]] = {
        "outline.npy": layer.domain.outline,
        "cage.npy": layer.domain.cage,
        "vertices.npy": mesh.vertices,
        "triangles.npy": mesh.triangles,
    }
    if cut_out.mask is not None:
        arrays["mask.npy"] = cut_out.mask.bits
    if cut_out.strokes:
        arrays["strokes.npy"] = np.concatenate([stroke.points for stroke in cut_out.strokes])
    if cut_out.cut_lines:
        arrays["slits.npy"] = np.concatenate([slit.points for slit in cut_out.cut_lines])
    if layer.domain.closed is not None:
        arrays[CLOSED] = layer.domain.closed
    if layer.stiffness is not None:
        arrays[STIFFNESS] = layer.stiffness
    if holes:
        arrays[CENTRES] = np.array([hole.centre for hole in holes], dtype=np.complex128)
    for index, hole in enumerate(holes):
        outline, cage = _of_hole(index)
        arrays |= {outline: hole.outline, cage: hole.cage}
    keys = [key.pose for key in layer.keys]
    for kind, poses in (("keys", keys), ("poses", [kept.pose for kept in layer.library])):
        for index, pose in enumerate(poses):
            phi, psi, logs = _of_map(kind, index)
            arrays |= {phi: pose.phi, psi: pose.psi}
            if holes:
                arrays[logs] = pose.logs
    picture = {f"{folder}/source{layer.picture.suffix}": layer.picture.data}
    return picture | {f"{folder}/{name}": array_member(array) for name, array in arrays.items()}


class LayerMembers:
    """The members of a layer in a folder of an archive."""

    def __init__(self, archive: Archive, folder: str) -> None:
        self.archive = archive
        self._folder = folder

    def picture(self, *, suffix: str, sha256: str, size: tuple[int, int]) -> PictureFile:
        """Return the picture, which must have the saved checksum and size."""
        data = self.archive.read(f"{self._folder}/source{suffix}")
        picture = PictureFile(data=data, suffix=suffix, size=size)
        if picture.sha256 != sha256:
            raise LissomError(_(OTHER_CHECKSUM))
        # The camera's orientation note may have turned the picture by a quarter.
        width, height = stored_size(picture.data, _("its picture"))
        if size not in {(width, height), (height, width)}:
            raise LissomError(
                _(
                    "its picture has {width} × {height} pixels, but the project says "
                    "{saved_width} × {saved_height}"
                ).format(width=width, height=height, saved_width=size[0], saved_height=size[1])
            )
        return picture

    def domain(self, *, parted: bool) -> MeshedDomain:
        """Return the domain, parted by cut lines or not."""
        outline, cage, vertices = (
            as_points(self._points(f"{name}.npy", most), name, at_least=3)
            for name, most in (
                ("outline", LARGEST_OUTLINE),
                ("cage", LARGEST_OUTLINE),
                ("vertices", MOST_MESH_TRIANGLES),
            )
        )
        triangles = self.archive.triangles(
            f"{self._folder}/triangles.npy", most=MOST_MESH_TRIANGLES
        )
        domain = MeshedDomain(
            outline=outline,
            cage=cage,
            mesh=Mesh(vertices=vertices, triangles=triangles),
            holes=self._holes(),
            closed=self._points(CLOSED) if parted else None,
        )
        if not self.archive.is_written:
            require_domain(domain)
        return domain

    def stiffness(self, domain: MeshedDomain) -> Floats:
        """Return the stiffness painted on the vertices of the domain's loops."""
        most = sum(map(len, domain.loops))
        return self.archive.numbers(f"{self._folder}/{STIFFNESS}", most=most)

    def mask(self, size: tuple[int, int]) -> Mask:
        most = -(-size[0] * size[1] // 8)
        return Mask(bits=self.archive.bytes(f"{self._folder}/mask.npy", most=most), size=size)

    def lines(self, kind: Literal["strokes", "slits"], counts: Sequence[int]) -> list[Complexes]:
        """Return the points of the lines drawn by hand, with these numbers of points."""
        if not counts:
            return []
        points = self._points(f"{kind}.npy", MOST_STROKE_POINTS)
        if min(counts) < 1 or sum(counts) != len(points):
            raise LissomError(
                _("the number of points in the {kind} of a cut-out is wrong").format(kind=kind)
            )
        return np.split(points, np.cumsum(counts)[:-1])

    def map(self, domain: MeshedDomain, kind: Literal["keys", "poses"], index: int) -> HarmonicMap:
        """Return the map of a key or of a library pose."""
        phi, psi, logs = _of_map(kind, index)
        return HarmonicMap(
            cage=domain.cage,
            phi=self._points(phi),
            psi=self._points(psi),
            holes=domain.holes,
            logs=self._points(logs) if domain.holes else np.empty(0, dtype=np.complex128),
        )

    def _holes(self) -> tuple[Hole, ...]:
        if not self.archive.has(f"{self._folder}/{CENTRES}"):
            return ()
        # A hole has at least three corners.
        centres = as_points(self._points(CENTRES, LARGEST_OUTLINE // 3), "hole_centres")
        holes = []
        for index, centre in enumerate(centres):
            outline, cage = map(self._points, _of_hole(index))
            holes.append(Hole(outline=outline, cage=cage, centre=complex(centre)))
        return tuple(holes)

    def _points(self, name: str, most: int = LARGEST_OUTLINE) -> Complexes:
        return self.archive.points(f"{self._folder}/{name}", most=most)


def layer_folder(layer: int) -> str:
    return f"layers/{layer}"


def earlier_folder(layer: int) -> str:
    """Return the folder of a member of a deform group as it was before."""
    return f"layers/{layer}/before"


def _of_hole(index: int) -> tuple[str, str]:
    """Return the member names of a hole's outline and cage."""
    return f"holes/{index:05}.outline.npy", f"holes/{index:05}.cage.npy"


def _of_map(kind: str, index: int) -> tuple[str, str, str]:
    """Return the member names of a map's coefficients: phi, psi, and its logarithms."""
    first = f"{kind}/{index:05}"
    return f"{first}.phi.npy", f"{first}.psi.npy", f"{first}.logs.npy"

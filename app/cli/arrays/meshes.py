"""Plane meshes from files: Wavefront OBJ, and NPZ as `lissom domain` writes it."""

from array import array
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.errors import LissomError
from app.storage import read_arrays, read_file
from app.texts import N_, _
from engine.arrays import Complexes, Integers

LARGEST = 64 * 1024 * 1024  # bytes; the size of a mesh of a million triangles
FLAT = 1e-9  # spread of z, over that of x and y, up to which a mesh is plane
NO_VERTEX = N_("a face of {path} names vertex {number}, but there are only {count}")


class PlaneMesh(NamedTuple):
    """The vertices, complex128 (n,), and triangles, int32 (m, 3), of a file."""

    vertices: Complexes
    triangles: Integers


def read_mesh(path: Path) -> PlaneMesh:
    """Read a mesh in the format of the file's suffix.

    Raises `LissomError` if the file cannot be read, or is not a plane mesh.
    """
    if path.suffix.lower() != ".obj":
        arrays = read_arrays(path, required=("vertices", "triangles"))
        return PlaneMesh(arrays["vertices"], arrays["triangles"])
    return _parsed(read_file(path, largest=LARGEST).decode("utf-8", "replace"), path)


def read_mesh_keyframes(
    paths: list[Path],
) -> tuple[Integers, tuple[npt.NDArray[np.complex128], ...]]:
    """Read meshes with the same triangles, one for each keyframe.

    Raises `LissomError` as `read_mesh`, or if the triangles differ.
    """
    meshes = [read_mesh(path) for path in paths]
    first = meshes[0].triangles
    for path, mesh in zip(paths, meshes, strict=True):
        if not np.array_equal(mesh.triangles, first):
            raise LissomError(
                _(
                    "{path} has other triangles ({count}) than {first} ({first_count}). "
                    "Keyframes must be poses of one mesh, with the same vertices in the same "
                    "order"
                ).format(
                    path=path,
                    count=len(mesh.triangles),
                    first=paths[0],
                    first_count=len(first),
                )
            )
    return first, tuple(mesh.vertices for mesh in meshes)


def _parsed(text: str, path: Path) -> PlaneMesh:
    """Parse the vertices and faces of an OBJ file; faces of more corners become fans."""
    # Packed: lists of Python numbers take ten times the memory of the file.
    places, corners = array("d"), array("q")
    # A backslash at the end continues a line.
    for number, line in enumerate(text.replace("\\\n", " ").splitlines(), 1):
        words = line.split("#", 1)[0].split()
        try:
            if words[:1] == ["v"]:
                x, y, *rest = map(float, words[1:4])
                places.extend([x, y, *(rest or [0.0])])
            elif words[:1] == ["f"]:
                first, *others = [_index(word, len(places) // 3) for word in words[1:]]
                for second, third in pairwise(others):
                    corners.extend((first, second, third))
        except (ValueError, OverflowError) as error:
            raise LissomError(
                _(
                    "{path} is not an OBJ file that Lissom can read; line {number} is {line!r}"
                ).format(path=path, number=number, line=line[:60])
            ) from error
    if not places or not corners:
        message = _("{path} has no faces") if places else _("{path} has no vertices")
        raise LissomError(message.format(path=path))
    across, up, deep = np.frombuffer(places, dtype=np.float64).reshape(-1, 3).T
    triangles = np.frombuffer(corners, dtype=np.int64).reshape(-1, 3)
    if triangles.max() >= len(up):
        raise LissomError(_(NO_VERTEX).format(path=path, number=triangles.max() + 1, count=len(up)))
    if not np.isfinite(across + up + deep).all():
        raise LissomError(_("{path} has a vertex that is not finite").format(path=path))
    if np.ptp(deep) > FLAT * max(np.ptp(across), np.ptp(up)):
        raise LissomError(
            _(
                "{path} is not flat: z goes from {least:g} to {most:g}. Rotate the mesh into "
                "the plane of x and y"
            ).format(path=path, least=deep.min(), most=deep.max())
        )
    return PlaneMesh(across + 1j * up, triangles.astype(np.int32))


def _index(word: str, count: int) -> int:
    """Return the index, from 0, of a face's vertex; negative numbers count from the end."""
    index = int(word.split("/", 1)[0])
    place = index - 1 if index > 0 else count + index
    if index == 0 or place < 0:
        raise ValueError
    return place

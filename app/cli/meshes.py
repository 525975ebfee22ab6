"""Plane meshes from files: Wavefront OBJ, and NPZ as `lissom domain` writes it."""

from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.errors import LissomError
from app.storage import read_arrays
from engine.arrays import Complexes, Integers

FLAT = 1e-9  # spread of z, over that of x and y, up to which a mesh is plane


class PlaneMesh(NamedTuple):
    """The vertices, complex128 (n,), and triangles, int32 (m, 3), of a file."""

    vertices: Complexes
    triangles: Integers


def read_mesh(path: Path) -> PlaneMesh:
    """Read a mesh by the ending of its file.

    Raises
    ------
    LissomError
        If the file cannot be read, or is not a plane mesh.
    """
    if path.suffix.lower() != ".obj":
        arrays = read_arrays(path, required=("vertices", "triangles"))
        return PlaneMesh(arrays["vertices"], arrays["triangles"])
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise LissomError(f"cannot read {path}: {error.strerror}") from error
    return _parsed(text, path)


def read_mesh_keyframes(
    paths: list[Path],
) -> tuple[Integers, tuple[npt.NDArray[np.complex128], ...]]:
    """Read meshes with the same triangles, one for each keyframe.

    Raises
    ------
    LissomError
        As `read_mesh`, or if the triangles are not the same.
    """
    meshes = [read_mesh(path) for path in paths]
    first = meshes[0].triangles
    for path, mesh in zip(paths, meshes, strict=True):
        if not np.array_equal(mesh.triangles, first):
            raise LissomError(
                f"the triangles of {path} are not those of {paths[0]} "
                f"({len(mesh.triangles)} and {len(first)}); keyframes must be poses of one mesh, "
                "with the same vertices in the same order"
            )
    return first, tuple(mesh.vertices for mesh in meshes)


def _parsed(text: str, path: Path) -> PlaneMesh:
    """Read the vertices and faces of an OBJ file; faces of more corners become fans."""
    vertices: list[list[float]] = []
    triangles: list[tuple[int, int, int]] = []
    # A line that ends in a backslash goes on in the next.
    for number, line in enumerate(text.replace("\\\n", " ").splitlines(), 1):
        words = line.split("#", 1)[0].split()
        try:
            if words[:1] == ["v"]:
                x, y, *rest = map(float, words[1:4])
                vertices.append([x, y, *(rest or [0.0])])
            elif words[:1] == ["f"]:
                corners = [_index(word, len(vertices)) for word in words[1:]]
                fan = pairwise(corners[1:])
                triangles += [(corners[0], second, third) for second, third in fan]
        except ValueError as error:
            raise LissomError(
                f"{path} is not an OBJ file that Lissom can read: line {number} is {line[:60]!r}"
            ) from error
    if not vertices or not triangles:
        raise LissomError(f"{path} has no {'faces' if vertices else 'vertices'}")
    x, y, z = np.array(vertices).T
    if np.ptp(z) > FLAT * max(np.ptp(x), np.ptp(y)):
        raise LissomError(
            f"{path} is not plane: z goes from {z.min():g} to {z.max():g}; lay the mesh into x and "
            "y"
        )
    return PlaneMesh(x + 1j * y, np.array(triangles, dtype=np.int32))


def _index(word: str, count: int) -> int:
    """Return the vertex that a corner of a face names, from 0; negative ones count from the end."""
    index = int(word.split("/", 1)[0])
    place = index - 1 if index > 0 else count + index
    if index == 0 or place < 0:
        raise ValueError
    return place

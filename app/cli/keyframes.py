"""Keyframes from files: harmonic maps, boundary positions, or poses of a mesh."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from app.cli.console import print_notice
from app.cli.hole_arrays import HOLE_ARRAYS, read_holes
from app.cli.meshes import read_mesh_keyframes
from app.errors import LissomError
from app.motion import harmonic_coordinate_maps
from app.storage import read_arrays
from engine.arrays import Complexes
from engine.maps import HarmonicMap

OPTIONAL = ("anchor", "triangles", "turns", "handles")
NEAR = 1e-4  # error of harmonic coordinates, over the size, up to which no notice is printed
COEFFICIENT_SHAPE = (
    "phi and psi must both be of shape (keyframes, cage vertices); they are of shape {phi} and "
    "{psi}, with {count} vertices of the cage and those in holes"
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Keyframes:
    """The contents of keyframe files.

    Parameters
    ----------
    maps : tuple of HarmonicMap
        The keyframes; empty if they are poses of a mesh.
    poses : tuple of complex, shape (n,)
        Positions of the points.
    points : complex, shape (n,)
        The points of requested in-betweens.
    anchor, triangles, turns, handles : array or None
        As in the file.
    """

    maps: tuple[HarmonicMap, ...] = ()
    poses: tuple[Complexes, ...] = ()
    points: npt.NDArray[Any]
    outline: npt.NDArray[Any] | None = None
    anchor: npt.NDArray[Any] | None = None
    triangles: npt.NDArray[Any] | None = None
    turns: npt.NDArray[Any] | None = None
    handles: npt.NDArray[Any] | None = None

    @property
    def count(self) -> int:
        return len(self.maps or self.poses)


def read_keyframes(paths: list[Path]) -> Keyframes:
    """Read one file with all keyframes, or one mesh per keyframe.

    Raises `LissomError` if a file cannot be read, lacks an array, or does not fit the others.
    """
    if len(paths) > 1:
        triangles, poses = read_mesh_keyframes(paths)
        return Keyframes(poses=poses, points=poses[0], triangles=triangles)
    (path,) = paths
    if path.suffix.lower() == ".obj":
        raise LissomError(f"{path} is one pose; name the meshes of all keyframes, in order")
    told = read_arrays(path, required=(), optional=("phi", "boundary", "positions"))
    if "phi" not in told and "boundary" in told:
        return _from_boundary(path)
    if "phi" not in told and "positions" in told:
        return _from_poses(path)
    return _from_coefficients(path)


def _from_coefficients(path: Path) -> Keyframes:
    data = read_arrays(
        path,
        required=("outline", "cage", "phi", "psi", "points"),
        optional=("logs", *OPTIONAL, *HOLE_ARRAYS),
    )
    phi, psi, holes = data["phi"], data["psi"], read_holes(data)
    count = data["cage"].size + sum(len(hole.cage) for hole in holes)
    if phi.ndim != 2 or phi.shape != psi.shape or phi.shape[1] != count:
        raise LissomError(COEFFICIENT_SHAPE.format(phi=phi.shape, psi=psi.shape, count=count))
    logs = data.get("logs", np.zeros((len(phi), len(holes))))
    if logs.shape != (len(phi), len(holes)):
        raise LissomError(
            f"logs must be of shape (keyframes, holes), ({len(phi)}, {len(holes)}), not "
            f"{logs.shape}"
        )
    maps = tuple(
        HarmonicMap(cage=data["cage"], phi=a, psi=b, holes=holes, logs=c)
        for a, b, c in zip(phi, psi, logs, strict=True)
    )
    return Keyframes(maps=maps, points=data["points"], outline=data["outline"], **_options(data))


def _from_boundary(path: Path) -> Keyframes:
    data = read_arrays(
        path,
        required=("outline", "cage", "boundary", "points"),
        optional=(*OPTIONAL, *HOLE_ARRAYS),
    )
    if read_holes(data):
        raise LissomError(
            "keyframes by where the boundary goes are for domains without holes; give phi and psi"
        )
    boundary = data["boundary"]
    if boundary.ndim != 2 or not len(boundary):
        raise LissomError(
            f"boundary must be of shape (keyframes, vertices of the outline), not {boundary.shape}"
        )
    maps, error = harmonic_coordinate_maps(data["outline"], data["cage"], list(boundary))
    if error > NEAR:
        print_notice(
            "the keyframes take the outline where it was wanted within "
            f"{100 * error:.2g} % of the diameter"
        )
    return Keyframes(maps=maps, points=data["points"], outline=data["outline"], **_options(data))


def _from_poses(path: Path) -> Keyframes:
    data = read_arrays(path, required=("positions", "triangles"), optional=("points", *OPTIONAL))
    poses = data["positions"]
    if poses.ndim != 2 or not len(poses):
        raise LissomError(f"positions must be of shape (keyframes, points), not {poses.shape}")
    return Keyframes(poses=tuple(poses), points=data.get("points", poses[0]), **_options(data))


def _options(data: Mapping[str, npt.NDArray[Any]]) -> dict[str, Any]:
    return {name: data[name] for name in OPTIONAL if name in data}

"""Keyframes from files: harmonic maps, boundary positions, or poses of a mesh."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from app.cli.arrays.hole_arrays import HOLE_ARRAYS, read_holes
from app.cli.arrays.meshes import read_mesh_keyframes
from app.cli.console import print_notice
from app.errors import LissomError
from app.motion import harmonic_coordinate_maps
from app.storage import read_arrays
from app.texts import N_, _
from engine.arrays import Complexes
from engine.maps import HarmonicMap

OPTIONAL = ("anchor", "triangles", "turns", "handles")
NEAR = 1e-4  # error of harmonic coordinates, over the size, up to which no notice is printed
COEFFICIENT_SHAPE = N_(
    "phi and psi must both have the shape (keyframes, cage vertices). Their shapes are {phi} "
    "and {psi}, but the cages have {count} vertices"
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
        raise LissomError(
            _("{path} is only one keyframe; name the meshes of all keyframes, in order").format(
                path=path
            )
        )
    names = read_arrays(path, required=(), optional=("phi", "boundary", "positions"))
    if "phi" not in names and "boundary" in names:
        return _from_boundary(path)
    if "phi" not in names and "positions" in names:
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
        raise LissomError(_(COEFFICIENT_SHAPE).format(phi=phi.shape, psi=psi.shape, count=count))
    logs = data.get("logs", np.zeros((len(phi), len(holes))))
    if logs.shape != (len(phi), len(holes)):
        raise LissomError(
            _("logs must have the shape (keyframes, holes), {wanted}, not {shape}").format(
                wanted=(len(phi), len(holes)), shape=logs.shape
            )
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
            _("the array 'boundary' works only without holes; give phi and psi instead")
        )
    boundary = data["boundary"]
    if boundary.ndim != 2 or not len(boundary):
        raise LissomError(
            _(
                "boundary must have the shape (keyframes, vertices of the outline), not {shape}"
            ).format(shape=boundary.shape)
        )
    maps, error = harmonic_coordinate_maps(data["outline"], data["cage"], list(boundary))
    if error > NEAR:
        print_notice(
            _("the keyframes miss their boundary by up to {error:.2g} % of the diameter").format(
                error=100 * error
            )
        )
    return Keyframes(maps=maps, points=data["points"], outline=data["outline"], **_options(data))


def _from_poses(path: Path) -> Keyframes:
    data = read_arrays(path, required=("positions", "triangles"), optional=("points", *OPTIONAL))
    poses = data["positions"]
    if poses.ndim != 2 or not len(poses):
        raise LissomError(
            _("positions must have the shape (keyframes, points), not {shape}").format(
                shape=poses.shape
            )
        )
    return Keyframes(poses=tuple(poses), points=data.get("points", poses[0]), **_options(data))


def _options(data: Mapping[str, npt.NDArray[Any]]) -> dict[str, Any]:
    return {name: data[name] for name in OPTIONAL if name in data}

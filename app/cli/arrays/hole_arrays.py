"""Holes of a domain as arrays, for the exchange between commands."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from app.errors import LissomError
from app.texts import N_, _
from engine.arrays import Complexes
from engine.geometry import Hole

HOLE_ARRAYS = (
    "hole_outlines",
    "hole_outline_sizes",
    "hole_cages",
    "hole_cage_sizes",
    "hole_centres",
)
HOLES_LACK = N_("the array {name} of the holes is missing; write the domain again")
HOLE_SIZES = N_("{sizes} must be whole numbers that add up to the {count} vertices of {name}")


def hole_arrays(holes: Sequence[Hole]) -> dict[str, npt.NDArray[Any]]:
    """Return the arrays of holes, all empty if there are none."""
    outlines, cages = [hole.outline for hole in holes], [hole.cage for hole in holes]
    return {
        "hole_outlines": _joined(outlines),
        "hole_outline_sizes": np.array(list(map(len, outlines)), dtype=np.int64),
        "hole_cages": _joined(cages),
        "hole_cage_sizes": np.array(list(map(len, cages)), dtype=np.int64),
        "hole_centres": np.array([hole.centre for hole in holes], dtype=np.complex128),
    }


def read_holes(data: Mapping[str, npt.NDArray[Any]]) -> tuple[Hole, ...]:
    """Return the holes from arrays; none if the arrays are absent.

    Raises `LissomError` if some of the arrays are missing, or do not fit each other.
    """
    missing = [name for name in HOLE_ARRAYS if name not in data]
    if len(missing) == len(HOLE_ARRAYS):
        return ()
    if missing:
        raise LissomError(_(HOLES_LACK).format(name=missing[0]))
    centres = np.asarray(data["hole_centres"]).ravel()
    outlines = _cut(data, "hole_outlines", "hole_outline_sizes", len(centres))
    cages = _cut(data, "hole_cages", "hole_cage_sizes", len(centres))
    return tuple(
        Hole(outline=outline, cage=cage, centre=complex(centre))
        for outline, cage, centre in zip(outlines, cages, centres, strict=True)
    )


def _joined(polygons: list[Complexes]) -> Complexes:
    """Return the vertices of all polygons in one array."""
    return np.concatenate([np.empty(0, dtype=np.complex128), *polygons])


def _cut(
    data: Mapping[str, npt.NDArray[Any]], name: str, sizes_name: str, count: int
) -> list[npt.NDArray[Any]]:
    vertices, sizes = np.asarray(data[name]), np.asarray(data[sizes_name])
    if vertices.ndim != 1 or sizes.shape != (count,):
        raise LissomError(
            _(
                "{name} must be one list of vertices, and {sizes} must have one entry for each of "
                "{count} hole_centres; their shapes are {vertices} and {entries}"
            ).format(
                name=name,
                sizes=sizes_name,
                count=count,
                vertices=vertices.shape,
                entries=sizes.shape,
            )
        )
    whole = sizes.dtype.kind in "iu" or not count
    if not whole or (sizes < 0).any() or sum(sizes.tolist()) != len(vertices):
        raise LissomError(_(HOLE_SIZES).format(sizes=sizes_name, count=len(vertices), name=name))
    return np.split(vertices, np.cumsum(sizes.astype(np.int64))[:-1]) if count else []

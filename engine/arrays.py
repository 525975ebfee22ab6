"""Array types shared by the whole engine, and the checks at its borders."""

from typing import TypeVar

import numpy as np
import numpy.typing as npt

from engine.errors import EngineError

type_ = TypeVar("type_", bound=np.generic)
Complexes = npt.NDArray[np.complex128]
Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int32]
Indices = npt.NDArray[np.intp]
Booleans = npt.NDArray[np.bool_]
Bytes = npt.NDArray[np.uint8]


def readonly(array: npt.NDArray[type_]) -> npt.NDArray[type_]:
    """Return a C-contiguous array with the values of `array` that nobody can write to.

    An array that is already read-only and contiguous is returned as it is; any other is copied, so
    that the caller's own array stays writable and changes to it do not reach the frozen value.
    """
    if not array.flags.writeable and array.flags.c_contiguous and array.base is None:
        return array
    frozen = np.array(array, order="C")
    frozen.setflags(write=False)
    return frozen


def as_points(values: npt.ArrayLike, name: str, *, at_least: int = 0) -> Complexes:
    """Return `values` as read-only complex128 points of shape (n,).

    Parameters
    ----------
    values : array_like, shape (n,)
        Points x + iy, real or complex.
    name : str
        What the points are called in the error.
    at_least : int
        Smallest number of points that is accepted.

    Raises
    ------
    EngineError
        If the values are not numbers, not one-dimensional, too few or not finite.
    """
    array = np.asarray(values)
    if array.dtype.kind not in "biufc":
        raise EngineError(f"{name} must be complex numbers, not {array.dtype}.")
    if array.ndim != 1:
        raise EngineError(f"{name} must be one-dimensional, not of shape {array.shape}.")
    if len(array) < at_least:
        raise EngineError(f"{name} must have at least {at_least} entries, not {len(array)}.")
    points = readonly(array.astype(np.complex128, copy=False))
    if not np.isfinite(points).all():
        bad = int(np.flatnonzero(~np.isfinite(points))[0])
        raise EngineError(f"{name} must be finite, but entry {bad} is {points[bad]}.")
    return points

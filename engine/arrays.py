"""Array types shared by the whole engine, the checks at its borders, and ragged arrays.

Every module with arrays imports this one first: BLAS then keeps to one thread. The matrices are
small, and a second thread on a busy core can make a solver's step a hundred times slower. With one
thread results repeat bit for bit.
"""

import operator
from collections.abc import Iterable
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
import scipy.linalg  # noqa: F401  brings a BLAS of its own
from scipy.sparse import bsr_array, csc_array, csr_array
from threadpoolctl import threadpool_limits

from engine.errors import EngineError

NOT_COMPLEX = "{name} must be complex numbers, not {dtype}."
NOT_FINITE = "{name} must be finite, but entry {index} is {value}."
NOT_A_NUMBER = "{name} must be a finite number, not {value!r}."
BELOW_LEAST = "{name} must be at least {least:,g}, not {value}."
ABOVE_MOST = "{name} must be at most {most:,g}, not {value}."
NOT_ABOVE = "{name} must be above {above:,g}, not {value}."
NO_WORD = "{name} must be one of {words}, not {value!r}."
TOO_LARGE = "{name} must be within {most:g} of the origin, but entry {index} is {value}."
FEW_ENTRIES = "{name} must have at least {at_least} entries, not {count}."
NOT_REAL = "{name} must be real numbers, not {dtype}."
NOT_LISTED = "{name} must be a list, not {value!r}."
OTHER_KIND = "{name} must be of the class {kind}, not {given}."
NOT_WHOLE = "{name} must be a whole number, not {value!r}."

threadpool_limits(limits=1, user_api="blas")

type_ = TypeVar("type_", bound=np.generic)
item_ = TypeVar("item_")
Complexes = npt.NDArray[np.complex128]
Floats = npt.NDArray[np.float64]
Singles = npt.NDArray[np.float32]
Integers = npt.NDArray[np.int32]
Indices = npt.NDArray[np.intp]
Booleans = npt.NDArray[np.bool_]
Bytes = npt.NDArray[np.uint8]


def freeze(array: npt.NDArray[type_]) -> npt.NDArray[type_]:
    """Forbid writing to an array, in place, and return it.

    For arrays without another owner: neither the memory nor its order changes. A view protects its
    base array only if nobody else refers to that base.
    """
    array.setflags(write=False)
    return array


def readonly(array: npt.NDArray[type_]) -> npt.NDArray[type_]:
    """Return a C-contiguous copy of an array that nobody can write to.

    For arrays of a caller: the caller's array stays writable, and later changes to it do not reach
    the frozen value. An array that is read-only, contiguous and no view is returned itself.
    """
    if not array.flags.writeable and array.flags.c_contiguous and array.base is None:
        return array
    return freeze(np.array(array, order="C"))


def ragged_indices(counts: Indices) -> tuple[Indices, Indices]:
    """Return the group of each entry, and its place in the group, for groups of these sizes."""
    group = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(group)) - np.repeat(np.cumsum(counts) - counts, counts)
    return group, place


def nbytes_of(*things: object, but: Iterable[object] = ()) -> int:
    """Return the memory of all arrays in the things, each counted once, in bytes.

    Things are arrays, also sparse ones, dataclasses, and tuples of them; arrays in `but` are not
    counted.
    """
    others = _arrays_in(but)
    return sum(size for array, size in _arrays_in(things).items() if array not in others)


def _arrays_in(things: Iterable[object]) -> dict[int, int]:
    """Return the sizes of arrays in memory, by their ids; views have none of their own."""
    sizes, waiting = {}, list(things)
    while waiting:
        thing = waiting.pop()
        while isinstance(thing, np.ndarray) and isinstance(thing.base, np.ndarray):
            thing = thing.base
        if isinstance(thing, np.ndarray):
            sizes[id(thing)] = thing.nbytes
        elif isinstance(thing, bsr_array | csc_array | csr_array):
            waiting += [thing.data, thing.indices, thing.indptr]
        elif isinstance(thing, tuple | list):
            waiting += thing
        elif is_dataclass(thing):
            waiting += [getattr(thing, field.name) for field in fields(thing)]
    return sizes


def ratio(numerator: Floats, denominator: Floats) -> Floats:
    """Return the quotient, infinite where the denominator is not positive."""
    positive = denominator > 0
    quotient: Floats = np.full(np.broadcast_shapes(numerator.shape, denominator.shape), np.inf)
    np.divide(numerator, denominator, out=quotient, where=positive)
    return quotient


def as_number(
    value: object,
    name: str,
    *,
    least: float = -np.inf,
    most: float = np.inf,
    above: float = -np.inf,
    is_whole: bool = False,
) -> float:
    """Return a finite number in a range, or raise an `EngineError` that names it."""
    array = _as_array(value)  # type: ignore[arg-type]
    if is_whole and (array.ndim or array.dtype.kind not in "biu"):
        raise EngineError(NOT_WHOLE, name=name, value=value)
    if array.ndim or array.dtype.kind not in "biuf" or not np.isfinite(array):
        raise EngineError(NOT_A_NUMBER, name=name, value=value)
    number = float(array)
    if number < least:
        raise EngineError(BELOW_LEAST, name=name, least=least, value=value)
    if number > most:
        raise EngineError(ABOVE_MOST, name=name, most=most, value=value)
    if number <= above:
        raise EngineError(NOT_ABOVE, name=name, above=above, value=value)
    return number


def require_word(value: object, words: Iterable[str], name: str) -> None:
    """Raise an `EngineError` unless a value is one of these words."""
    known = list(words)
    if value not in known:
        raise EngineError(NO_WORD, name=name, words=", ".join(map(repr, known)), value=value)


def as_points(
    values: npt.ArrayLike, name: str, *, at_least: int = 0, most: float = np.inf
) -> Complexes:
    """Return `values` as read-only complex128 points of shape (n,).

    Parameters
    ----------
    values : array_like, shape (n,)
        Points x + iy, real or complex.
    name : str
        Name of the points in the error.
    at_least : int
        Smallest number of points.
    most : float
        Largest distance from the origin.

    Raises
    ------
    EngineError
        If the values are not numbers, not one-dimensional, too few, not finite or too far away.
    """
    array = _as_array(values)
    if array.dtype.kind not in "biufc":
        raise EngineError(NOT_COMPLEX, name=name, dtype=array.dtype)
    if array.ndim != 1:
        raise EngineError(
            "{name} must be one-dimensional, not of shape {shape}.", name=name, shape=array.shape
        )
    if len(array) < at_least:
        raise EngineError(FEW_ENTRIES, name=name, at_least=at_least, count=len(array))
    points = readonly(array.astype(np.complex128, copy=False))
    if not np.isfinite(points).all():
        bad = int(np.flatnonzero(~np.isfinite(points))[0])
        raise EngineError(NOT_FINITE, name=name, index=bad, value=points[bad])
    if most < np.inf and (np.abs(points) > most).any():
        bad = int(np.argmax(np.abs(points)))
        raise EngineError(TOO_LARGE, name=name, most=most, index=bad, value=points[bad])
    return points


def as_count(value: object, name: str) -> int:
    """Return a whole number, or raise `EngineError`."""
    try:
        return operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise EngineError(NOT_WHOLE, name=name, value=value) from None


def as_reals(values: npt.ArrayLike, name: str) -> Floats:
    """Return real numbers of any shape, NaN and infinity included, as float64."""
    array = _as_array(values)
    if array.dtype.kind not in "biuf":
        raise EngineError(NOT_REAL, name=name, dtype=array.dtype)
    return array.astype(np.float64)


def as_tuple(values: Iterable[item_], name: str) -> tuple[item_, ...]:
    """Return the entries of a list, or raise `EngineError` for other values."""
    try:
        return tuple(values)
    except TypeError:
        raise EngineError(NOT_LISTED, name=name, value=values) from None


def require_kind(value: object, kind: type, name: str) -> None:
    """Raise `EngineError` unless a value is of a class."""
    if not isinstance(value, kind):
        given = type(value).__name__
        raise EngineError(OTHER_KIND, name=name, kind=kind.__name__, given=given)


def _as_array(values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return values as an array, of objects if the lists have different lengths."""
    try:
        return np.asarray(values)
    except ValueError:
        return np.asarray(values, dtype=object)

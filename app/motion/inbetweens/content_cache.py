"""A cache of computed values by the contents of arrays."""

import threading
from collections.abc import Callable, Hashable
from hashlib import blake2b
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

Value = TypeVar("Value")


class ContentCache:
    """A thread-safe cache of frozen values within a budget; the least recently used go first.

    Domains with equal outlines share their values, for example after a layer is duplicated or a
    file is opened again. `budget` limits the bytes of all values together.
    """

    def __init__(self, budget: int) -> None:
        self._budget = budget
        self._guard = threading.Lock()
        self._values: dict[
            Hashable, tuple[Any, int]
        ] = {}  # with sizes in bytes, in the order of last use
        self._used = 0

    def find(
        self, key: Hashable, make: Callable[[], Value], size_of: Callable[[Value], int]
    ) -> Value:
        """Return the value of a key, computed if missing.

        Two threads may compute the same value at once; one of the equal values is kept.
        """
        with self._guard:
            known = self._values.pop(key, None)
            if known is not None:
                self._values[key] = known
                value: Value = known[0]
                return value
        value = make()
        with self._guard:
            self._drop(key)
            size = size_of(value)
            if size <= self._budget:
                self._values[key] = value, size
                self._used += size
            while self._used > self._budget:
                self._drop(next(iter(self._values)))
        return value

    def forget(self, key: Hashable) -> None:
        """Drop the value of a key."""
        with self._guard:
            self._drop(key)

    def _drop(self, key: Hashable) -> None:
        _, size = self._values.pop(key, (None, 0))
        self._used -= size


def digest(*arrays: npt.NDArray[Any] | None) -> bytes:
    """Return a digest of contents, types and shapes of arrays."""
    found = blake2b(digest_size=16)
    for array in arrays:
        if array is None:
            found.update(b"none")
        else:
            found.update(f"{array.dtype.str}{array.shape}".encode())
            found.update(np.ascontiguousarray(array).data)
    return found.digest()

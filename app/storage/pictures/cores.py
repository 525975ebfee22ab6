"""Work on several pictures at once, on the cores of the machine."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

In = TypeVar("In")
Out = TypeVar("Out")

# Each picture under work takes some memory of its own.
MOST_WORKERS = 4


def side_by_side(work: Callable[[In], Out], items: Iterable[In]) -> list[Out]:
    """Return what a function makes of items, in their order; of its errors the first is raised.

    Decoders and most of NumPy let other threads go on, so that these are as many as there are
    cores.
    """
    with ThreadPoolExecutor(min(MOST_WORKERS, os.cpu_count() or 1)) as pool:
        return list(pool.map(work, items))

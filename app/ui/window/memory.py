"""Memory that is free, given back to the system."""

import ctypes
import sys


def give_back() -> None:
    """Give all memory that is free back to the system.

    The GNU C library keeps what worker threads have freed, each thread's apart: without this, each
    large drawing that is opened after another takes more memory.
    """
    if sys.platform == "linux":
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # not every C library has it
        if trim is not None:
            trim(0)

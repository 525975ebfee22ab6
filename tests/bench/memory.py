"""The most memory that processes have held, where the system tells it.

`python -m tests.bench.memory WORD ...` runs a command, and prints the seconds that it took and the
most memory that it held.
"""

import subprocess
import sys
import time
from typing import NamedTuple

UNIT = 1 if sys.platform == "darwin" else 1024  # bytes, of the system's layer


class Run(NamedTuple):
    """What a command took: seconds by the clock, and in words its memory."""

    seconds: float
    memory: str


def most_held(*, by_commands: bool = False) -> str:
    """Tell the most memory that this process has held, or any command that it has run."""
    if sys.platform == "win32":
        return "memory is not measured here"
    import resource  # noqa: PLC0415 - Windows has none

    whose = resource.RUSAGE_CHILDREN if by_commands else resource.RUSAGE_SELF
    return f"{UNIT * resource.getrusage(whose).ru_maxrss / 2**30:.2f} GiB of memory at most"


def run_measured(*command: str) -> Run:
    """Run a command, and measure it.

    A process that is started takes over the largest memory of the one that starts it, so that
    another, small one starts it.
    """
    told = subprocess.run(
        [sys.executable, "-m", "tests.bench.memory", *command],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    seconds, memory = told.stdout.split(maxsplit=1)
    return Run(float(seconds), memory.strip())


if __name__ == "__main__":
    begun = time.perf_counter()
    subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
    print(time.perf_counter() - begun, most_held(by_commands=True))

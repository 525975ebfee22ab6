"""Files that were tampered with, for everything that Lissom reads.

Each is read as a valid file or refused in words, in little time and memory; nothing but the file is
opened, and nothing in it is run.
"""

import resource
import tempfile
from collections.abc import Iterator
from pathlib import Path

import hypothesis
from hostile_files import READERS, STEPS, Watch, read_changed
from hypothesis import HealthCheck, Phase, given, settings, strategies as st

from tests.campaigns.slowest import note

MEMORY = 6 * 1024**3  # bytes of addresses, libraries and their threads among them
MOST_SECONDS = 20.0  # of the processor, for one file


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Let each reader read so many files, and yield the figures of each."""
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, hard))
    watch = Watch()
    try:
        for reader in READERS:
            yield reader, read_many(reader, seed, amount // len(READERS), watch)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def read_many(name: str, seed: int, amount: int, watch: Watch) -> dict[str, float]:
    """Let a reader read so many files."""
    reader = READERS[name]
    count = 0

    @hypothesis.seed(seed)
    @settings(
        max_examples=amount,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        phases=[Phase.generate, Phase.shrink],
    )
    @given(st.sampled_from(sorted(reader.samples())), STEPS)
    def read(sample, steps):
        nonlocal count
        count += 1
        seconds = read_changed(reader, sample, steps, Path(folder), watch)
        note(f"{sample} {count}", seconds)
        assert seconds < MOST_SECONDS

    with tempfile.TemporaryDirectory() as folder:
        read()
    return {"inputs": count}

"""Motion between settled poses: every interval of every variant is a series, and says how true.

Handles of some shapes are dragged far at random, and left until the pose has settled.
"""

import sys
from collections.abc import Iterator

from settled_poses import SHAPES, series_of

from engine.variant import Variant
from tests.campaigns.slowest import timed

FIRST = 1000  # seeds below are those of the tests
TOLD_EVERY = 20  # pairs of poses


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Build the series of so many pairs of poses in all variants, and yield the worst of them."""
    names = sorted(SHAPES)
    least, most, over, failures = 1.0, 0.0, 0.0, 0
    for number in timed(range(amount)):
        name, pose = names[number % len(names)], FIRST * seed + number
        for variant in Variant:
            covered, missed, stated = series_of(name, pose, variant)
            least, most = min(least, covered), max(most, missed)
            over = max(over, missed / stated)
            if covered < 1.0 or missed > stated or stated > 1.0:
                failures += 1
                told = f"covered {covered:.3f}, missed {missed:.2f}, stated {stated:.2f}"
                print(f"  {name} {pose} {variant}: {told}", file=sys.stderr, flush=True)
        if (number + 1) % TOLD_EVERY == 0 or number + 1 == amount:
            yield (
                f"{number + 1} pairs of poses in all variants",
                {
                    "least share of time covered": least,
                    "largest error over the tolerance": most,
                    "largest error over the stated": over,
                    "failures": failures,
                },
            )
    assert not failures

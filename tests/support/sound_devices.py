"""A sound device that tests turn by hand, with a clock of its own."""

from collections.abc import Callable

import numpy as np

from app.sound.samples import Samples

PERIOD = 1_920  # samples of a request: 40 ms


class HandDevice:
    """A device that asks for samples when it is told to; `pace` is the speed of its clock."""

    rate = 48_000
    latency = 2 * PERIOD / rate

    def __init__(self, *, pace: float = 1.0) -> None:
        self.pace = pace
        self.heard: list[Samples] = []
        self.is_running = False
        self._pull: Callable[[int], Samples] | None = None
        self._due = 0.0  # samples

    def start(self, pull: Callable[[int], Samples]) -> None:
        assert not self.is_running
        self._pull, self.is_running = pull, True

    def stop(self) -> None:
        self.is_running = False

    def turn(self, seconds: float) -> None:
        """Let time pass, in which the device asks for whole periods."""
        self._due += seconds * self.rate * self.pace
        while self._due >= PERIOD:
            self._due -= PERIOD
            if self.is_running and self._pull is not None:
                self.heard.append(self._pull(PERIOD))

    @property
    def samples(self) -> Samples:
        """All samples that it was given."""
        return np.concatenate(self.heard) if self.heard else np.zeros((0, 2), dtype=np.float32)

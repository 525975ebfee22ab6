"""The machine's sound device.

The library miniaudio decodes and plays, and brings all that it needs: PortAudio, the usual other
choice, is no part of its Python package on Linux.
"""

import os
import sys
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from typing import Any, Final, Protocol

from app.errors import LissomError
from app.sound.samples import Samples
from app.texts import N_, _

RATE: Final = 48_000
PERIOD: Final = 40  # milliseconds that the device asks for at once
PERIODS: Final = 2  # that lie between a sample and the ear
NO_DEVICE = N_("this machine has no sound device that works ({reason})")


class SoundDevice(Protocol):
    """A device that asks for samples, on a thread of its own."""

    rate: int
    latency: float  # seconds from a request until its first sample is heard

    def start(self, pull: Callable[[int], Samples]) -> None:
        """Ask `pull` for any number of samples (n, 2), again and again."""

    def stop(self) -> None:
        """Ask for no more samples; the device may start again."""


def open_device() -> SoundDevice:
    """Return the usual device of the machine. Raises `LissomError` if there is none."""
    import miniaudio  # noqa: PLC0415 - only sounds need it

    try:
        with _without_library_messages():
            device = miniaudio.PlaybackDevice(
                output_format=miniaudio.SampleFormat.FLOAT32,
                nchannels=2,
                sample_rate=RATE,
                buffersize_msec=PERIOD,
                callback_periods=PERIODS,
                app_name="Lissom",
            )
    except miniaudio.MiniaudioError as error:
        reason = " ".join(map(str, error.args))
        raise LissomError(_(NO_DEVICE).format(reason=reason)) from error
    if device.backend == "Null":
        device.close()
        raise LissomError(_(NO_DEVICE).format(reason=device.backend))
    return _MiniaudioDevice(device)


@contextmanager
def _without_library_messages() -> Iterator[None]:
    """Keep quiet what the system's libraries write to the terminal about missing devices."""
    if not sys.platform.startswith("linux"):
        yield
        return
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


class _MiniaudioDevice:
    """A device of the library miniaudio."""

    rate = RATE
    latency = PERIODS * PERIOD / 1000

    def __init__(self, device: Any) -> None:
        self._device = device

    def start(self, pull: Callable[[int], Samples]) -> None:
        def blocks() -> Generator[bytes | Samples, int, None]:
            count = yield b""
            while True:
                count = yield pull(count)

        source = blocks()
        next(source)
        self._device.start(source)

    def stop(self) -> None:
        self._device.stop()

"""Playing: the device asks for samples, and the picture follows what is heard.

A thread mixes ahead, so that a slow jump in a file is not heard. All methods but `pull` are called
on one thread.
"""

import threading
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.errors import LissomError
from app.sound.device import SoundDevice, open_device
from app.sound.samples import Samples
from app.sound.stream import FADE

AHEAD: Final = 0.5  # seconds that are mixed ahead
LOST: Final = 2.0  # seconds without a request after which the device counts as lost
LINGER: Final = 0.5  # seconds after which a device with nothing to play stops


@dataclass(frozen=True, slots=True)
class _Request:
    """The last request of the device."""

    at: float  # seconds of the clock
    before: int  # samples of the stream that were delivered before it
    after: int


class SoundPlayer:
    """Plays streams of samples on a device, which is opened when it is first needed."""

    def __init__(
        self, clock: Callable[[], float], opened: Callable[[], SoundDevice] = open_device
    ) -> None:
        self._clock, self._open = clock, opened
        self._device: SoundDevice | None = None
        self.is_running = False  # whether the device asks for samples
        self._feeder: threading.Thread | None = None
        self.failure: str | None = None  # why there is no device
        self._since = 0.0  # seconds of the clock at the last start or stop
        self._mixing = threading.Lock()  # held while a stream is asked for samples
        self._filling = threading.Condition()  # for all below
        self._stream: Iterator[Samples] | None = None
        self._ready: deque[Samples] = deque()
        self._delivered = 0  # samples of the stream
        self._request: _Request | None = None
        self._fading: Samples | None = None  # from the stream before
        self._is_waiting = False  # whether the device waits for samples

    @property
    def rate(self) -> int:
        """The device's rate. Opens the device; raises `LissomError` if there is none."""
        if self._device is None:
            if self.failure is not None:
                raise LissomError(self.failure)
            try:
                self._device = self._open()
            except LissomError as error:
                self.failure = str(error)
                raise
        return self._device.rate

    @property
    def latency(self) -> float:
        """Seconds from a request of the device until its samples are heard."""
        return 0.0 if self._device is None else self._device.latency

    def play(self, stream: Iterator[Samples]) -> None:
        """Play samples of the device's rate in place of those before, which fade out."""
        self._put(stream)
        if self._feeder is None:
            self._feeder = threading.Thread(target=self._feed, name="sound", daemon=True)
            self._feeder.start()
        if self._device is not None and not self.is_running:
            self.is_running = True
            self._device.start(self.pull)

    def stop(self) -> None:
        """Fade out."""
        if self._device is not None:
            self._put(None)

    def rest(self) -> None:
        """Stop a device that has had nothing to play for a while."""
        is_idle = self._stream is None and not self._ready
        if self._device and self.is_running and is_idle and self._clock() > self._since + LINGER:
            self.is_running = False
            self._device.stop()

    def elapsed(self) -> float | None:
        """Return the seconds of the stream that were heard; None if the device is lost."""
        now, request, rate = self._clock(), self._request, self.rate
        since = self._since if request is None else request.at
        if now - since > LOST and not self._is_waiting:
            return None
        if request is None:
            return 0.0
        heard = min(request.before / rate + now - request.at, request.after / rate)
        return max(heard - self.latency, 0.0)

    def lose_device(self, reason: str) -> None:
        """Do without a device from now on."""
        self.stop()
        device, self._device, self.failure = self._device, None, reason
        self.is_running = False
        if device is not None:
            # A device that does not answer must not stop the window.
            threading.Thread(target=device.stop, daemon=True).start()

    def pull(self, wanted: int) -> Samples:
        """Return the next samples, on the device's thread; zeros after the end of the stream."""
        while True:
            with self._filling:
                if self._stream is None or sum(map(len, self._ready)) >= wanted:
                    before, self._delivered = self._delivered, self._delivered + wanted
                    self._request = _Request(self._clock(), before, self._delivered)
                    found, fading = self._take(wanted), self._fading
                    self._fading, self._is_waiting = None, False
                    break
                self._is_waiting = True
            self._mix()
        if fading is not None:
            known = min(len(fading), wanted)
            share = np.linspace(1, 0, len(fading), dtype=np.float32)[:known, None]
            found[:known] = share * fading[:known] + (1 - share) * found[:known]
        return found

    def _put(self, stream: Iterator[Samples] | None) -> None:
        with self._filling:
            self._fading = self._take(round(FADE * self.rate))
            self._ready.clear()
            self._stream, self._delivered, self._request = stream, 0, None
            self._since = self._clock()
            self._filling.notify()

    def _take(self, wanted: int) -> Samples:
        """Return the next samples that are ready, and zeros after them."""
        found, done = np.zeros((wanted, 2), dtype=np.float32), 0
        while self._ready and done < wanted:
            block = self._ready.popleft()
            part = block[: wanted - done]
            found[done : done + len(part)] = part
            done += len(part)
            if len(part) < len(block):
                self._ready.appendleft(block[len(part) :])
        self._filling.notify()
        return found

    def _mix(self) -> None:
        """Mix a block of the stream."""
        with self._mixing:
            stream = self._stream
            block = None if stream is None else next(stream, None)
            with self._filling:
                # Meanwhile another stream may have begun.
                if self._stream is stream and block is not None:
                    self._ready.append(block)
                elif self._stream is stream:
                    self._stream = None

    def _feed(self) -> None:
        while True:
            with self._filling:
                while self._stream is None or sum(map(len, self._ready)) > AHEAD * self.rate:
                    self._filling.wait()
            self._mix()

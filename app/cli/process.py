"""The process of a command: its threads of linear algebra, and the signals that end it.

Python runs signal handlers only between two of its own steps. A second thread receives signals at
once. It can wake a window that waits for events, and end a process that is stuck.
"""

import ctypes
import faulthandler
import io
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType, TracebackType
from typing import Final, Self

from app.texts import N_, _

if sys.platform != "win32":
    import resource

SIGNALS: Final = ("SIGINT", "SIGTERM", "SIGHUP")
# Seconds after which a worker releases Python's lock. A frame takes the lock some twenty times.
# With the usual 5 ms, a job that seldom releases the lock would leave two frames a second.
SWITCH_INTERVAL: Final = 0.0005
PATIENCE: Final = 10.0  # seconds for a process to end by itself
# Bytes of address space. With 300 MB OpenBLAS asks for more again and again, and never ends.
LEAST_MEMORY: Final = 400_000_000
STILL_AT_WORK: Final = N_("interrupted by {signal}; unfinished work was stopped")
_INTERRUPTED: Final = 128  # plus the signal's number: the usual exit status in shells


def use_one_thread() -> None:
    """Keep BLAS to one thread; call it before NumPy is imported.

    The matrices are small, and a second thread on a busy core can make a solver step fifty times
    slower. With one thread, results repeat bit for bit.
    """
    for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")


def require_memory() -> None:
    """Refuse to start if libraries cannot be loaded, or would wait for memory forever.

    Raises `MemoryError` if the system limits this process to too little memory, as by `ulimit -v`.
    """
    # −1 means no limit.
    if sys.platform != "win32" and 0 <= resource.getrlimit(resource.RLIMIT_AS)[0] < LEAST_MEMORY:
        raise MemoryError


def reopen_std_streams() -> None:
    """Redirect closed standard streams to nowhere, and make all streams accept any letter.

    Otherwise a file opened later takes the place of the closed stream, and messages of libraries go
    into it.
    """
    for descriptor, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest free number
        if getattr(sys, name) is None:
            setattr(sys, name, open(descriptor, "w" if descriptor else "r", closefd=False))  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def discard_output() -> None:
    """Prevent Python from writing the rest of standard output at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def set_switch_interval() -> None:
    """Make workers and the window alternate often."""
    sys.setswitchinterval(SWITCH_INTERVAL)


class SignalHandler:
    """Receives the signals that end the program during a `with` block; the first one counts.

    Signals that the starting program ignores, as `nohup` does, stay ignored.

    At the first signal, `wake` is called on a thread of its own; the block then polls
    `is_signalled`. Without `wake`, the block ends with a `KeyboardInterrupt`.
    """

    def __init__(self, wake: Callable[[], None] | None = None) -> None:
        self._wake = wake
        self._number: int | None = None
        self._before: dict[int, Callable[[int, FrameType | None], object] | int | None] = {}
        self._pipe: tuple[int, int] | None = None
        self._wakeup = -1

    @property
    def is_signalled(self) -> bool:
        return self._number is not None

    @property
    def signal_name(self) -> str:
        """Name of the signal; empty before there is one."""
        return "" if self._number is None else signal.Signals(self._number).name

    @property
    def exit_status(self) -> int:
        """The shells' exit status for the signal."""
        return _INTERRUPTED + (self._number or signal.SIGINT)

    def __enter__(self) -> Self:
        """Listen for signals; on other threads than the main thread this does nothing."""
        if threading.current_thread() is not threading.main_thread():
            return self
        self._pipe = os.pipe()
        if os.name != "nt":
            os.set_blocking(self._pipe[1], False)
        self._wakeup = signal.set_wakeup_fd(self._pipe[1], warn_on_full_buffer=False)
        for name in SIGNALS:
            number = getattr(signal, name, signal.SIGINT)  # Windows has no SIGHUP
            if signal.getsignal(number) is not signal.SIG_IGN:
                self._before[number] = signal.signal(number, self._note)
        arguments = self._pipe[0], threading.get_ident()
        try:
            threading.Thread(target=self._listen, args=arguments, daemon=True).start()
        except RuntimeError as error:  # Python's exception for no memory for a thread
            raise MemoryError from error
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Restore the previous signal handlers."""
        if self._pipe is None:
            return
        for number, before in self._before.items():
            signal.signal(number, signal.SIG_DFL if before is None else before)
        signal.set_wakeup_fd(self._wakeup)
        # This also ends the thread, unless the process is about to end.
        os.close(self._pipe[1])

    def _note(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        is_first, self._number = self._number is None, self._number or number
        if is_first and self._wake is None:
            raise KeyboardInterrupt

    def _listen(self, pipe: int, main_thread: int) -> None:
        while (heard := os.read(pipe, 1)) and heard[0] not in self._before:
            pass
        if heard:
            if self._wake is not None:
                self._wake()
            try:
                name = signal.Signals(heard[0]).name
                words = f"lissom: {_(STILL_AT_WORK).format(signal=name)}\n"
                exit_within(PATIENCE, _INTERRUPTED + heard[0], "" if self._wake else words)
            except RuntimeError:  # no memory for another thread
                os._exit(_INTERRUPTED + heard[0])
            # A signal just before the main thread begins to wait does not end this wait.
            while not self.is_signalled and os.name != "nt":
                signal.pthread_kill(main_thread, heard[0])
                time.sleep(SWITCH_INTERVAL)
        while os.read(pipe, 1):  # further signals from Python change nothing
            pass
        os.close(pipe)


def on_display_lost(keep: Callable[[], None], status: int) -> object:
    """Call `keep` when the X server goes away, before the process ends with this status.

    Otherwise Xlib ends the process at once. The result must live as long as the window.
    """
    if sys.platform != "linux":
        return None

    def lost(display: int | None) -> int:  # noqa: ARG001
        try:
            keep()
        finally:
            os._exit(status)

    heard = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)(lost)
    with suppress(OSError):  # without the library there are no X windows
        ctypes.CDLL("libX11.so.6").XSetIOErrorHandler(heard)
    return heard


@contextmanager
def redirect_faulthandler(descriptor: int) -> Iterator[None]:
    """Write Python's traceback to a file if the process crashes during a `with` block.

    An already enabled fault handler stays.
    """
    enables = not faulthandler.is_enabled()
    if enables:
        faulthandler.enable(descriptor)
    try:
        yield
    finally:
        if enables:
            faulthandler.disable()
        os.close(descriptor)


def has_running_threads() -> bool:
    """Return whether Python would wait for other threads, such as those of a cancelled export."""
    others = set(threading.enumerate()) - {threading.main_thread()}
    return any(not thread.daemon for thread in others)


def exit_within(seconds: float, status: int, words: str = "") -> None:
    """End the process after at most this many seconds, even if it is stuck, with a last message."""

    def end() -> None:
        time.sleep(seconds)
        with suppress(OSError):
            os.write(2, words.encode())
        os._exit(status)

    threading.Thread(target=end, daemon=True).start()

"""Worker threads for long computations.

There are four: one for what the person waits for, such as the pose under the hand, one for
exports, one for what is shown and may take a second, such as in-betweens, and one for what is to be
kept. None keeps another waiting, and one that never comes to an end can be left behind.
"""

import atexit
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal, get_args

from app.errors import CANCELLED, LissomError, listen_to_progress

LaneName = Literal["hand", "export", "display", "keep"]
PATIENCE = 10.0  # seconds that the end of the program waits for what runs
MOMENT = 0.5  # seconds that it waits for what was given up


@dataclass(frozen=True, slots=True)
class JobKind:
    """What a job is for."""

    label: str  # in words that the status bar can show
    complaint: str = ""  # what is said where it fails
    # On which thread it runs: that for what is under the "hand", for an "export", for what is to be
    # on "display", or for what the disk is to "keep".
    lane: LaneName = "display"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Job:
    """A pure computation on frozen input, and what is done with its result."""

    kind: JobKind
    work: Callable[[], Any]  # runs on a worker thread; touches nothing mutable and no GL
    done: Callable[[Any], None]  # takes the result, on the main thread
    failed: Callable[[Exception], None]  # takes the exception that ended `work`, on the main thread


@dataclass(slots=True, eq=False)
class _Lane:
    """A worker thread, and what it works on."""

    thread: threading.Thread | None = None
    running: Job | None = None
    since: float = 0.0
    is_stale: bool = False
    share: float | None = None  # that is done, where the job tells it


@dataclass(slots=True, eq=False)
class _Hold:
    """Kinds of which no job begins, all of them where none is named, but for the first few."""

    kinds: frozenset[JobKind]
    first: int

    def holds(self, kind: JobKind) -> bool:
        return not self.kinds or kind in self.kinds


class Jobs:
    """The queue and its worker threads.

    A job is unfinished until its result is delivered. One whose kind was put in again or dropped
    before that is stale: if it waits it never starts, and its result is thrown away. Those that
    were added are all done.

    Parameters
    ----------
    clock : callable
        Seconds, for telling how long a job runs.
    """

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        # Called on the worker's thread whenever something is there to deliver.
        self.wake: Callable[[], None] = lambda: None
        self.delivered = 0  # how many results were handed over so far
        self._clock = clock
        self._condition = threading.Condition()
        self._waiting: list[Job] = []
        self._finished: list[tuple[JobKind, Callable[[], None]]] = []
        self._is_closed = False
        # The end of the program takes BLAS away, and a thread that is in it crashes.
        atexit.register(self.close)
        self._lanes: dict[LaneName, _Lane] = {name: _Lane() for name in get_args(LaneName)}
        self._left: list[_Lane] = []
        self._holds: list[_Hold] = []

    def put(self, job: Job) -> None:
        """Queue a job in place of an unfinished one of its kind."""
        self.drop(job.kind)
        self.add(job)

    def add(self, job: Job) -> None:
        """Queue a job, be there others of its kind or not."""
        with self._condition:
            self._staff(job.kind.lane)
            self._waiting.append(job)
            self._condition.notify_all()

    @contextmanager
    def held(self, *kinds: JobKind, first: int = 0) -> Iterator[None]:
        """Let no job of these kinds begin within the block, or of any kind where none is given.

        A job that is held waits, and others of its lane begin before it. The first few begin all
        the same.
        """
        hold = _Hold(frozenset(kinds), first)
        with self._condition:
            self._holds.append(hold)
            self._condition.notify_all()
        try:
            yield
        finally:
            with self._condition:
                self._holds.remove(hold)
                self._condition.notify_all()

    def drop(self, kind: JobKind) -> None:
        """Make an unfinished job of this kind stale."""
        with self._condition:
            self._forget(kind)

    def abandon(self, kind: JobKind) -> None:
        """Give up a job of this kind that may never end; what waits behind it goes on elsewhere.

        Its result is thrown away, and it has failed as far as anybody is told. One that tells how
        far it is ends when it tells so next. Where a newer one of its kind waits for it to end,
        nobody is told anything: that one begins.
        """
        with self._condition:
            left = {
                name: lane
                for name, lane in self._lanes.items()
                if lane.running is not None and lane.running.kind == kind
            }
            if not any(lane.is_stale for lane in left.values()):
                self._fail([job for job in self._waiting if job.kind == kind])
                self._waiting = [job for job in self._waiting if job.kind != kind]
                self._fail([lane.running for lane in left.values() if lane.running is not None])
            for name, lane in left.items():
                lane.is_stale = True
                self._left.append(lane)
                self._lanes[name] = _Lane()
                if self._is_waiting(name):
                    self._staff(name)

    @property
    def kinds(self) -> tuple[JobKind, ...]:
        """The kinds that are unfinished: first what is finished already, last what still waits."""
        with self._condition:
            running = [
                lane.running.kind
                for lane in self._lanes.values()
                if lane.running is not None and not lane.is_stale
            ]
            finished = [kind for kind, _ in self._finished]
            return (*finished, *running, *(job.kind for job in self._waiting))

    @property
    def is_closed(self) -> bool:
        """Whether no job begins any more."""
        return self._is_closed

    @property
    def abandoned_count(self) -> int:
        """How many jobs that were given up still run."""
        with self._condition:
            return sum(lane.thread is not None and lane.thread.is_alive() for lane in self._left)

    def running_for(self, seconds: float) -> tuple[JobKind, ...]:
        """Return the kinds of jobs that run since so many seconds or more.

        Stale ones are among them where others wait for them to end.
        """
        start = self._clock() - seconds
        with self._condition:
            return tuple(
                lane.running.kind
                for name, lane in self._lanes.items()
                if lane.running is not None
                and lane.since <= start
                and (not lane.is_stale or self._is_waiting(name))
            )

    def share_of(self, kind: JobKind) -> float | None:
        """Return how much of a job that runs is done, from 0 to 1; None where it does not tell."""
        with self._condition:
            for lane in self._lanes.values():
                if lane.running is not None and lane.running.kind == kind:
                    return lane.share
            return None

    def deliver(self) -> None:
        """Hand over what is finished; on the main thread, once a frame."""
        with self._condition:
            due = len(self._finished)
        for _ in range(due):
            with self._condition:
                # One at a time: what is handed over may make the next one stale.
                if not self._finished:
                    return
                _, hand_over = self._finished.pop(0)
            self.delivered += 1
            hand_over()

    def wait_until_idle(self, timeout: float = 60.0) -> bool:
        """Wait until all that is not held is to be delivered; return whether that came in time."""
        with self._condition:
            return self._condition.wait_for(
                lambda: all(
                    lane.running is None and self._next(name) is None
                    for name, lane in self._lanes.items()
                ),
                timeout,
            )

    def close(self, patience: float = PATIENCE) -> bool:
        """Drop what waits, and end the threads when what runs is done.

        Parameters
        ----------
        patience : float
            Seconds to wait for that; for what was left behind, at most `MOMENT`.

        Returns
        -------
        bool
            Whether all have ended. If not, the program must end without taking anything down that
            they may use.
        """
        with self._condition:
            self._is_closed = True
            self._waiting.clear()
            self._condition.notify_all()
        begun, is_over = time.monotonic(), True
        for lanes, most in ((self._lanes.values(), patience), (self._left, MOMENT)):
            for lane in lanes:
                if lane.thread is not None:
                    lane.thread.join(max(0.0, begun + min(patience, most) - time.monotonic()))
                    is_over &= not lane.thread.is_alive()
        return is_over

    def _staff(self, name: LaneName) -> None:
        """Give a lane its thread."""
        lane = self._lanes[name]
        if lane.thread is None:
            work = partial(self._work, lane, name)
            thread = threading.Thread(target=work, name=name, daemon=True)
            thread.start()
            # Only now: where the system has refused it, the next job asks for it again.
            lane.thread = thread

    def _fail(self, jobs: list[Job]) -> None:
        """Tell those who asked for some jobs that nothing comes of them."""
        failed = [(job.kind, partial(job.failed, LissomError(CANCELLED))) for job in jobs]
        self._finished.extend(failed)

    def _is_waiting(self, name: LaneName) -> bool:
        """Tell whether a job waits for a lane."""
        return any(job.kind.lane == name for job in self._waiting)

    def _forget(self, kind: JobKind) -> None:
        self._waiting = [job for job in self._waiting if job.kind != kind]
        self._finished = [done for done in self._finished if done[0] != kind]
        for lane in self._lanes.values():
            if lane.running is not None and lane.running.kind == kind:
                lane.is_stale = True

    def _work(self, lane: _Lane, name: LaneName) -> None:
        while True:
            with self._condition:
                while (job := self._next(name)) is None or lane in self._left:
                    if self._is_closed or lane in self._left:
                        return
                    self._condition.wait()
                self._waiting.remove(job)
                for hold in self._holds:
                    hold.first -= hold.holds(job.kind)
                lane.running, lane.since, lane.is_stale = job, self._clock(), False
                lane.share = None
            with listen_to_progress(partial(self._hear, lane)):
                hand_over = _attempt(job)
            with self._condition:
                if not lane.is_stale:
                    self._finished.append((job.kind, hand_over))
                lane.running = None
                self._condition.notify_all()
            self.wake()
            # While the thread waits they would keep alive what they hold, such as a whole drawing.
            del job, hand_over

    def _hear(self, lane: _Lane, share: float) -> None:
        """Note how far a job is, on its own thread; end it where it was given up."""
        if self._is_closed or lane in self._left:
            raise LissomError(CANCELLED)
        lane.share = share

    def _next(self, lane: LaneName) -> Job | None:
        held = [hold for hold in self._holds if hold.first <= 0]
        for job in self._waiting:
            if job.kind.lane == lane and not any(hold.holds(job.kind) for hold in held):
                return job
        return None


def _attempt(job: Job) -> Callable[[], None]:
    try:
        result = job.work()
    except Exception as error:  # noqa: BLE001 - the job boundary: every failure is reported
        return partial(job.failed, error)
    except BaseException as error:  # noqa: BLE001 - such as a library's SystemExit
        return partial(job.failed, RuntimeError(repr(error)))
    return partial(job.done, result)

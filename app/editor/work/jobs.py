"""Worker threads for long computations, in five lanes of one thread each.

"hand" is for awaited results such as a dragged pose, "export" for exports, "display" for slower
results such as in-betweens, "footage" for reading footage, "keep" for writing to disk. A job that
never ends can be abandoned.
"""

import atexit
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from operator import attrgetter, itemgetter
from typing import Any, Literal, get_args

from app.errors import CANCELLED, LissomError, listen_to_progress

LaneName = Literal["hand", "export", "display", "footage", "keep"]
PATIENCE = 10.0  # seconds that the end of the program waits for running jobs
MOMENT = 0.5  # seconds that it waits for abandoned jobs


@dataclass(frozen=True, slots=True)
class JobKind:
    """Label, complaint and lane of a job."""

    label: str  # shown in the status bar
    complaint: str = ""  # shown if the job fails
    lane: LaneName = "display"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Job:
    """A pure computation on frozen input, and the callbacks for its result."""

    kind: JobKind
    work: Callable[[], Any]  # runs on a worker thread; touches nothing mutable and no GL
    done: Callable[[Any], None]  # takes the result, on the main thread
    failed: Callable[[Exception], None]  # takes the exception that ended `work`, on the main thread


@dataclass(slots=True, eq=False)
class _Lane:
    """A worker thread and its running job."""

    thread: threading.Thread | None = None
    running: Job | None = None
    since: float = 0.0
    is_stale: bool = False
    share: float | None = None  # part of the job that is done, if the job reports it


@dataclass(slots=True, eq=False)
class _Hold:
    """Kinds whose jobs do not begin, or all kinds if none is named; the first few still begin."""

    kinds: frozenset[JobKind]
    first: int

    def holds(self, kind: JobKind) -> bool:
        return not self.kinds or kind in self.kinds


class Jobs:
    """The queue and its worker threads.

    A job is unfinished until its result is delivered. If its kind is put again or dropped, it never
    starts, or its result is dropped. Jobs queued by `add` are all done.
    """

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        # Called on the worker's thread when a result is ready to deliver.
        self.wake: Callable[[], None] = lambda: None
        self.delivered = self.revision = 0  # counts of delivered results, and of all changes
        self._clock = clock
        self._condition = threading.Condition()
        self._waiting: list[Job] = []
        self._finished: list[tuple[JobKind, Callable[[], None]]] = []
        self._is_closed = False
        # The end of the program unloads BLAS, and a thread inside BLAS then crashes.
        atexit.register(self.close)
        self._lanes: dict[LaneName, _Lane] = {name: _Lane() for name in get_args(LaneName)}
        self._left: list[_Lane] = []
        self._holds: list[_Hold] = []

    def put(self, job: Job) -> None:
        """Queue a job in place of an unfinished job of its kind."""
        self.drop(job.kind)
        self.add(job)

    def add(self, job: Job) -> None:
        """Queue a job; unfinished jobs of its kind stay."""
        self.revision += 1
        with self._condition:
            self._staff(job.kind.lane)
            self._waiting.append(job)
            self._condition.notify_all()

    @contextmanager
    def held(self, *kinds: JobKind, first: int = 0) -> Iterator[None]:
        """Hold back jobs of these kinds, or all jobs, within the block; the first few still begin.

        Other jobs of the lane overtake a held job.
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
        self.revision += 1
        with self._condition:
            self._forget(kind)

    def abandon(self, kind: JobKind) -> None:
        """Abandon a job of this kind that may never end; jobs behind it move to a new thread.

        It is reported as failed, unless a newer job of its kind waits. A job that reports progress
        ends at its next report.
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
        """Kinds of unfinished jobs: finished but undelivered first, waiting last."""
        with self._condition:
            running = [
                lane.running.kind
                for lane in self._lanes.values()
                if lane.running is not None and not lane.is_stale
            ]
            finished = map(itemgetter(0), self._finished)
            return (*finished, *running, *map(attrgetter("kind"), self._waiting))

    @property
    def is_closed(self) -> bool:
        """Whether the queue is closed and no job begins any more."""
        return self._is_closed

    @property
    def abandoned_count(self) -> int:
        """Number of abandoned jobs that still run."""
        with self._condition:
            return sum(lane.thread is not None and lane.thread.is_alive() for lane in self._left)

    def running_for(self, seconds: float) -> tuple[JobKind, ...]:
        """Return the kinds of jobs that run so long; stale ones only if others wait for them."""
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
        """Return the finished part of a running job, 0 to 1; None if the job does not report it."""
        with self._condition:
            for lane in self._lanes.values():
                if lane.running is not None and lane.running.kind == kind:
                    return lane.share
            return None

    def deliver(self) -> None:
        """Deliver the finished results; on the main thread, once a frame."""
        with self._condition:
            due = len(self._finished)
        for _ in range(due):
            with self._condition:
                # One at a time: a delivered result may make the next one stale.
                if not self._finished:
                    return
                _, hand_over = self._finished.pop(0)
            self.delivered += 1
            self.revision += 1
            hand_over()

    def wait_until_idle(self, timeout: float = 60.0) -> bool:
        """Wait until all jobs that are not held have finished; return False on a timeout."""
        with self._condition:
            return self._condition.wait_for(
                lambda: all(
                    lane.running is None and self._next(name) is None
                    for name, lane in self._lanes.items()
                ),
                timeout,
            )

    def close(self, patience: float = PATIENCE) -> bool:
        """Drop waiting jobs, end the threads, and return whether all have ended after `patience`.

        If not, the program must end without freeing values that the threads may use.
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
        """Start the thread of a lane."""
        lane = self._lanes[name]
        if lane.thread is None:
            thread = threading.Thread(target=self._work, args=(lane, name), name=name, daemon=True)
            thread.start()
            # Set after the start: if the system refuses the thread, the next job asks for it again.
            lane.thread = thread

    def _fail(self, jobs: list[Job]) -> None:
        """Report jobs as failed."""
        self._finished += [(job.kind, partial(job.failed, LissomError(CANCELLED))) for job in jobs]

    def _is_waiting(self, name: LaneName) -> bool:
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
            # A waiting thread would keep large values alive through these variables.
            del job, hand_over

    def _hear(self, lane: _Lane, share: float) -> None:
        """Note a job's progress on its own thread; end the job if it was abandoned."""
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

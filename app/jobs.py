"""One worker thread for long computations; of each kind only the newest job counts."""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Job:
    """A pure computation on frozen input, and what is done with its result.

    Parameters
    ----------
    kind : str
        What it is for, in words that the status bar can show. One job of a kind waits at a time.
    work : callable
        Runs on the worker thread; touches nothing mutable and no GL.
    done : callable
        Takes the result, on the main thread.
    failed : callable
        Takes the exception that ended `work`, on the main thread.
    urgent : bool
        Goes before all that is not.
    """

    kind: str
    work: Callable[[], Any]
    done: Callable[[Any], None]
    failed: Callable[[Exception], None]
    urgent: bool = False


class Jobs:
    """The queue and its worker thread.

    A job is unfinished until its result is delivered. One whose kind was put in again or dropped
    before that is stale: if it waits it never starts, and its result is thrown away.
    """

    def __init__(self) -> None:
        self._condition = threading.Condition()
        self._waiting: list[Job] = []
        self._running: Job | None = None
        self._running_is_stale = False
        self._finished: list[tuple[str, Callable[[], None]]] = []
        self._thread: threading.Thread | None = None

    def put(self, job: Job) -> None:
        """Queue a job in place of an unfinished one of its kind."""
        with self._condition:
            self._forget(job.kind)
            self._waiting.append(job)
            self._waiting.sort(key=lambda waiting: not waiting.urgent)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="jobs", daemon=True)
                self._thread.start()
            self._condition.notify_all()

    def drop(self, kind: str) -> None:
        """Make an unfinished job of this kind stale."""
        with self._condition:
            self._forget(kind)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds that are unfinished, in the order in which they come."""
        with self._condition:
            kinds = [kind for kind, _ in self._finished]
            if self._running is not None and not self._running_is_stale:
                kinds.append(self._running.kind)
            return (*kinds, *(job.kind for job in self._waiting))

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
            hand_over()

    def settle(self, timeout: float = 60.0) -> bool:
        """Wait until all that is left is to deliver; return whether that came in time."""
        with self._condition:
            return self._condition.wait_for(
                lambda: self._running is None and not self._waiting, timeout
            )

    def _forget(self, kind: str) -> None:
        self._waiting = [job for job in self._waiting if job.kind != kind]
        self._finished = [done for done in self._finished if done[0] != kind]
        if self._running is not None and self._running.kind == kind:
            self._running_is_stale = True

    def _work(self) -> None:
        while True:
            with self._condition:
                self._condition.wait_for(lambda: self._waiting)
                job = self._running = self._waiting.pop(0)
                self._running_is_stale = False
            hand_over = _attempt(job)
            with self._condition:
                if not self._running_is_stale:
                    self._finished.append((job.kind, hand_over))
                self._running = None
                self._condition.notify_all()


def _attempt(job: Job) -> Callable[[], None]:
    try:
        result = job.work()
    except Exception as error:  # noqa: BLE001 - the job boundary: every failure is reported
        return partial(job.failed, error)
    return partial(job.done, result)

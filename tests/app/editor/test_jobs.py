import pkgutil
import re
import subprocess
import sys
import threading
from importlib import import_module

import pytest

import app.editor
from app.editor.work.jobs import Job, JobKind, Jobs
from app.errors import CANCELLED, report_progress


def job(kind, work, results, *, lane="display"):
    return Job(
        kind=JobKind(kind, lane=lane),
        work=work,
        done=lambda result: results.append((kind, result)),
        failed=lambda error: results.append((kind, error)),
    )


STUCK = 300.0  # seconds after which a worker counts as stuck; no result depends on it
HAND = {name: JobKind(name, lane="hand") for name in ("stuck", "pose")}


def labels(kinds):
    return tuple(kind.label for kind in kinds)


@pytest.fixture
def busy():
    """Jobs whose worker waits at a gate, so that everything put in afterwards queues up."""
    jobs, gate, begun = Jobs(), threading.Event(), threading.Event()

    def wait():
        begun.set()
        gate.wait(STUCK)

    jobs.put(job("gate", wait, []))
    assert begun.wait(STUCK)
    yield jobs, gate
    gate.set()
    assert jobs.wait_until_idle()


def test_results_come_on_delivery():
    jobs, results = Jobs(), []
    jobs.put(job("sum", lambda: 1 + 1, results))
    assert jobs.wait_until_idle()
    assert results == []
    jobs.deliver()
    assert results == [("sum", 2)]


def test_failure_is_handed_over():
    jobs, results = Jobs(), []
    jobs.put(job("division", lambda: 1 / 0, results))
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert isinstance(results[0][1], ZeroDivisionError)


def test_what_would_end_a_thread_fails_as_a_job_and_the_next_one_runs():
    jobs, results = Jobs(), []
    jobs.put(job("exit", lambda: sys.exit(3), results))
    jobs.put(job("sum", lambda: 1 + 1, results))
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert "SystemExit(3)" in str(results[0][1])
    assert results[1] == ("sum", 2)


def test_a_thread_that_the_system_refuses_is_asked_for_again(monkeypatch):
    def refuse(_):
        raise RuntimeError("can't start new thread")

    jobs, results = Jobs(), []
    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", refuse)
        with pytest.raises(RuntimeError, match="new thread"):
            jobs.put(job("sum", lambda: 1 + 1, results))
    assert labels(jobs.kinds) == ()
    jobs.put(job("sum", lambda: 1 + 1, results))
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("sum", 2)]


def test_newest_of_a_kind_wins(busy):
    jobs, gate = busy
    results = []
    for number in range(5):
        jobs.put(job("frame", lambda number=number: number, results))
    assert labels(jobs.kinds) == ("gate", "frame")
    gate.set()
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("frame", 4)]


def test_running_job_that_was_replaced_is_stale():
    jobs, results = Jobs(), []
    gate, begun = threading.Event(), threading.Event()

    def slow():
        begun.set()
        gate.wait(STUCK)
        return "old"

    jobs.put(job("pose", slow, results))
    assert begun.wait(STUCK)
    jobs.put(job("pose", lambda: "new", results))
    gate.set()
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("pose", "new")]


def test_dropped_job_never_delivers(busy):
    jobs, gate = busy
    results = []
    jobs.put(job("pose", lambda: 1, results))
    jobs.drop(JobKind("pose"))
    gate.set()
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == []


def test_job_is_unfinished_until_it_is_delivered():
    jobs, results = Jobs(), []
    jobs.put(job("pose", lambda: 1, results))
    assert jobs.wait_until_idle()
    assert labels(jobs.kinds) == ("pose",)
    jobs.drop(JobKind("pose"))
    jobs.deliver()
    assert results == []


def test_result_may_make_the_next_one_stale():
    jobs, results = Jobs(), []
    jobs.put(
        Job(
            kind=JobKind("undo"),
            work=int,
            done=lambda _: jobs.drop(JobKind("pose")),
            failed=results.append,
        )
    )
    jobs.put(job("pose", lambda: 1, results))
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == []


def test_jobs_wait_while_their_kind_is_held_and_others_begin():
    jobs, results = Jobs(), []
    with jobs.held(JobKind("pose")):
        jobs.put(job("pose", lambda: 1, results))
        jobs.put(job("in-betweens", lambda: 2, results))
        while not results:
            jobs.deliver()
        assert results == [("in-betweens", 2)]
        assert labels(jobs.kinds) == ("pose",)
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("in-betweens", 2), ("pose", 1)]


def test_jobs_wait_but_the_first_few_while_their_kind_is_held():
    jobs, results = Jobs(), []
    with jobs.held(JobKind("pose"), first=2):
        for number in range(3):
            jobs.add(job("pose", lambda number=number: number, results))
        jobs.add(job("in-betweens", lambda: 3, results))
        while len(results) < 3:
            jobs.deliver()
        assert results == [("pose", 0), ("pose", 1), ("in-betweens", 3)]
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results[3:] == [("pose", 2)]


def test_jobs_of_any_kind_wait_while_all_are_held():
    jobs, results = Jobs(), []
    with jobs.held():
        jobs.put(job("pose", lambda: 1, results))
        jobs.put(job("in-betweens", lambda: 2, results))
        assert jobs.wait_until_idle()
        assert labels(jobs.kinds) == ("pose", "in-betweens")
        jobs.drop(JobKind("pose"))
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("in-betweens", 2)]


@pytest.mark.parametrize("lane", ["hand", "export"])
def test_urgent_jobs_do_not_wait_for_others(busy, lane):
    jobs, _ = busy
    results, ready = [], threading.Event()
    jobs.put(job("in-betweens", lambda: 1, results))
    jobs.put(job("pose", ready.set, results, lane=lane))
    assert ready.wait(STUCK)
    while "pose" in labels(jobs.kinds):
        jobs.deliver()
    assert results == [("pose", None)]
    assert labels(jobs.kinds) == ("gate", "in-betweens")


def test_urgent_jobs_come_one_after_the_other():
    jobs, results = Jobs(), []
    gate, begun = threading.Event(), threading.Event()

    def wait():
        begun.set()
        gate.wait(STUCK)

    jobs.put(job("pose", wait, results, lane="hand"))
    assert begun.wait(STUCK)
    jobs.put(job("save", lambda: 1, results, lane="hand"))
    assert labels(jobs.kinds) == ("pose", "save")
    gate.set()
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("pose", None), ("save", 1)]


def test_jobs_tell_how_long_they_run():
    now = [10.0]
    jobs, gate, begun = Jobs(lambda: now[0]), threading.Event(), threading.Event()

    def wait():
        begun.set()
        gate.wait(STUCK)

    jobs.put(job("factors", wait, []))
    assert begun.wait(STUCK)
    jobs.put(job("in-betweens", int, []))
    assert labels(jobs.running_for(0.3)) == ()
    now[0] = 10.4
    assert labels(jobs.running_for(0.3)) == ("factors",)
    jobs.drop(JobKind("factors"))
    assert labels(jobs.running_for(0.3)) == ("factors",), "in-betweens wait for it"
    jobs.drop(JobKind("in-betweens"))
    assert labels(jobs.running_for(0.3)) == ()
    gate.set()
    assert jobs.wait_until_idle()


@pytest.fixture
def stuck():
    """Work that does not end before the test does, and a wait until it has begun."""
    begun, end = threading.Event(), threading.Event()

    def work():
        begun.set()
        end.wait()

    yield work, begun.wait
    end.set()


def test_a_job_that_never_ends_can_be_left_and_the_others_go_on(stuck):
    work, has_begun = stuck
    jobs, results = Jobs(), []
    failures = []
    jobs.put(Job(kind=HAND["stuck"], work=work, done=results.append, failed=failures.append))
    has_begun()
    jobs.put(job("next", lambda: 2, results, lane="hand"))
    jobs.abandon(JobKind("nothing of that kind"))
    assert results == failures == []
    jobs.abandon(HAND["stuck"])
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("next", 2)]
    (failure,) = failures
    assert str(failure) == CANCELLED
    jobs.put(job("later", lambda: 3, results, lane="hand"))
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("next", 2), ("later", 3)]


def test_what_is_stale_and_never_ends_can_be_left_by_what_waits_for_it(stuck):
    work, has_begun = stuck
    now = [10.0]
    jobs, results, failures = Jobs(lambda: now[0]), [], []
    jobs.put(Job(kind=HAND["pose"], work=work, done=results.append, failed=failures.append))
    has_begun()
    now[0] = 20.0
    jobs.put(job("pose", lambda: 2, results, lane="hand"))
    assert labels(jobs.running_for(5.0)) == ("pose",)
    jobs.abandon(HAND["pose"])
    assert jobs.wait_until_idle()
    jobs.deliver()
    assert results == [("pose", 2)]
    assert failures == []
    assert labels(jobs.running_for(0.0)) == ()


def test_what_was_left_delivers_nothing_when_it_ends_after_all():
    jobs, results = Jobs(), []
    begun, end, over = threading.Event(), threading.Event(), threading.Event()

    def work():
        begun.set()
        end.wait()
        over.set()

    jobs.put(Job(kind=JobKind("slow"), work=work, done=results.append, failed=results.append))
    begun.wait()
    jobs.abandon(JobKind("slow"))
    jobs.deliver()
    results.clear()
    end.set()
    over.wait()
    assert jobs.close()
    jobs.deliver()
    assert results == []


def test_closing_does_not_wait_for_ever(stuck):
    work, has_begun = stuck
    jobs = Jobs()
    jobs.put(job("stuck", work, []))
    has_begun()
    assert jobs.abandoned_count == 0
    jobs.abandon(JobKind("stuck"))
    assert jobs.abandoned_count == 1
    assert not jobs.close(patience=0.05)


def test_closing_does_not_wait_for_what_was_left(stuck):
    work, has_begun = stuck
    jobs = Jobs()
    jobs.put(job("stuck", work, []))
    has_begun()
    jobs.abandon(JobKind("stuck"))
    closing = threading.Thread(target=jobs.close, args=(2 * STUCK,), daemon=True)
    closing.start()
    closing.join(STUCK)
    assert not closing.is_alive()


def test_closing_waits_for_what_runs_and_drops_what_waits():
    jobs, begun, results = Jobs(), threading.Event(), []
    gate = threading.Event()

    def finish():
        begun.set()
        gate.wait(STUCK)
        results.append("ran")

    jobs.put(job("factors", finish, []))
    jobs.put(job("in-betweens", lambda: results.append("waited"), []))
    jobs.put(job("pose", int, [], lane="hand"))
    assert begun.wait(STUCK)
    closing = threading.Thread(target=jobs.close)
    closing.start()
    while not jobs.is_closed:
        pass
    assert closing.is_alive()
    gate.set()
    closing.join(STUCK)
    assert results == ["ran"]
    assert labels(jobs.kinds) in {("factors",), ("pose", "factors"), ("factors", "pose")}


PROGRAM = """
from app.cli.process import use_one_thread
use_one_thread()
import threading
import numpy as np
import scipy.linalg
import app.editor
from app.editor.work.jobs import Job, Jobs, JobKind
from app.errors import CANCELLED, report_progress

begun = threading.Event()
matrix = np.random.default_rng(0).random((2000, 2000))

def factorise():
    begun.set()
    scipy.linalg.lu_factor(matrix)
    scipy.linalg.lu_factor(matrix)

jobs = Jobs()
jobs.put(Job(kind=JobKind("factors"), work=factorise, done=print, failed=print))
begun.wait()
# So that the end comes when the other thread is deep in its work.
for _ in range(4):
    np.linalg.inv(matrix[:500, :500])
"""


def test_a_program_may_end_while_a_job_runs():
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, check=False)
    assert done.returncode == 0


def test_a_job_that_tells_how_far_it_is_ends_when_it_is_given_up():
    jobs, results, over = Jobs(), [], []
    reported, left = threading.Event(), threading.Event()

    def work():
        try:
            report_progress(0.25)
            reported.set()
            left.wait(STUCK)
            report_progress(0.5)
            over.append("went on")
        finally:
            over.append("ended")

    jobs.put(job("slow", work, results))
    assert reported.wait(STUCK)
    assert jobs.share_of(JobKind("slow")) == 0.25
    assert jobs.share_of(JobKind("other")) is None
    jobs.abandon(JobKind("slow"))
    left.set()
    jobs.put(job("next", lambda: 2, results))
    assert jobs.wait_until_idle()
    assert jobs.share_of(JobKind("next")) is None
    assert jobs.close()
    assert over == ["ended"]
    jobs.deliver()
    assert [kind for kind, _ in results] == ["slow", "next"]
    assert str(results[0][1]) == CANCELLED


def test_what_tells_how_far_it_is_does_not_hold_up_the_end_of_the_program():
    jobs, reported = Jobs(), threading.Event()

    def work():
        while True:
            report_progress(0.5)
            reported.set()

    jobs.put(job("endless", work, []))
    assert reported.wait(STUCK)
    assert jobs.close()


def test_labels_of_work_are_plain_words():
    names = [each.name for each in pkgutil.walk_packages(app.editor.__path__, "app.editor.")]
    values = [value for name in names for value in vars(import_module(name)).values()]
    words = [value.label for value in values if isinstance(value, JobKind)]
    assert len(words) > 20
    assert [label for label in words if not re.fullmatch("[A-Z][a-z -]+", label)] == []

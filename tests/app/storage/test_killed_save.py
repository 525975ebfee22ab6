"""Real kills at system calls of a save, of the last ones at each: the old or new file is whole."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SAVE = """
import io, os, signal, sys
from pathlib import Path
sys.path[:0] = [{tests!r}, {root!r}]
from dataclasses import replace
from documents import differences, disc_document, full_document
from app.storage.project_file import load_project, save_project

FOLDER = Path({folder!r})
LATE = 16
STEPS = {steps!r}
CALLS = ("open", "fdopen", "fsync", "chmod", "replace", "unlink")
OLD, NEW = disc_document(), full_document()


class File(io.FileIO):
    # Unbuffered, so that each write is a system call; half of it is done when the kill comes.
    def write(self, data):
        if countdown():
            super().write(bytes(data)[: len(data) // 2])
            kill()
        return super().write(data)


def countdown():
    global left
    left -= 1
    return left == 0


def kill():
    os.kill(os.getpid(), signal.SIGKILL)


def killable(call):
    def wrapped(*args, **options):
        if countdown():
            kill()
        result = call(*args, **options)
        if countdown():
            kill()
        return result
    return wrapped


def save_and_die(path, calls):
    global left
    left = calls
    for name in CALLS:
        setattr(os, name, killable(getattr(os, name)))
    os.fdopen = killable(lambda handle, mode: File(handle, mode))
    save_project(path, NEW)
    (FOLDER / "calls").write_text(str(calls - left))
    os._exit(0)


def save_killed(path, calls):
    child = os.fork()
    if not child:
        try:
            save_and_die(path, calls)
        finally:
            os._exit(3)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    assert status in (0, -signal.SIGKILL), status
    return status


for first, step in STEPS.items():
    survivors = replaced = 0
    path = FOLDER / first / "a.lissom"
    path.parent.mkdir()
    if first == "old":
        save_project(path, OLD)
    save_killed(path, 1_000_000)
    last = int((FOLDER / "calls").read_text())
    # Most of them write members of the file, one like the other.
    early = range(1, last - LATE, step)
    for calls in (*early, *range(last - LATE, last + 2)):
        folder = FOLDER / first / str(calls)
        folder.mkdir(parents=True)
        path = folder / "a.lissom"
        if first == "old":
            save_project(path, OLD)
        status = save_killed(path, calls)
        if first == "none" and not path.exists():
            assert status
            survivors += 1
            continue
        document = load_project(path)
        is_new = not differences(document, NEW)
        assert is_new or not differences(document, OLD)
        survivors += not is_new
        replaced += is_new
        # Whatever the kill left behind is hidden and does not stop the next save.
        assert all(p == path or p.name.startswith(".") for p in folder.iterdir())
        save_project(path, OLD)
        assert not differences(load_project(path), OLD)
    assert status == 0
    print(first, last, survivors, replaced)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs processes that can be forked")
@pytest.mark.parametrize(
    "steps",
    [
        pytest.param({"old": 200}, id="few"),
        pytest.param({"old": 12, "none": 40}, id="many", marks=pytest.mark.long),
    ],
)
def test_killed_save_leaves_the_old_or_the_new_file(tmp_path, steps):
    tests = Path(__file__).parents[2]
    script = SAVE.format(
        tests=str(tests / "support"), root=str(tests.parent), folder=str(tmp_path), steps=steps
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    for line in done.stdout.splitlines():
        first, calls, survivors, replaced = line.split()
        # Before the replacement and after it, which the last kill and the end without one are.
        assert int(calls) > 100
        assert int(survivors) > 10 + int(calls) // (2 * steps[first])
        assert int(replaced) >= 3
    assert len(done.stdout.splitlines()) == len(steps)

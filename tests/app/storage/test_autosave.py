"""What a window kept is offered once it is gone, whatever else runs, and never while it lives."""

import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from documents import differences, disc_document, full_document

from app.storage.autosave import (
    UNKNOWN_SOURCE,
    Autosave,
    SourceInfo,
    find_recoverable_files,
    load_recoverable_file,
    remove_recoverable_file,
)
from app.storage.project_file import save_project

TESTS = Path(__file__).parents[2]
# Keeps a document in the folder that it is given, and waits.
KEEP = f"""
import sys
sys.path[:0] = [{str(TESTS / "support")!r}, {str(TESTS.parent)!r}]
from pathlib import Path
from documents import disc_document
from app.storage.autosave import UNKNOWN_SOURCE, Autosave
Autosave(Path(sys.argv[1])).write(disc_document(), UNKNOWN_SOURCE)
print("kept", flush=True)
sys.stdin.read()
"""


def test_unsaved_work_is_nobody_elses(tmp_path):
    folder = tmp_path / "settings"
    folder.mkdir(mode=0o755)
    own = Autosave(folder)
    for _ in range(2):
        own.write(disc_document(), UNKNOWN_SOURCE)
        assert folder.stat().st_mode & 0o777 == 0o700
        assert {path.stat().st_mode & 0o777 for path in folder.iterdir()} == {0o600}
        for path in folder.glob("*.lissom"):
            path.chmod(0o644)  # as earlier versions left it
    own.remove()
    Autosave(tmp_path / "new").write(disc_document(), UNKNOWN_SOURCE)
    assert (tmp_path / "new").stat().st_mode & 0o777 == 0o700
    save_project(tmp_path / "mine.lissom", disc_document())
    assert (tmp_path / "mine.lissom").stat().st_mode & 0o044


@pytest.fixture
def autosave(tmp_path):
    own = Autosave(tmp_path)
    yield own
    own.remove()


def test_the_work_of_a_killed_process_is_offered_and_of_a_living_one_not(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", KEEP, str(tmp_path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout.readline() == "kept\n"
        assert find_recoverable_files(tmp_path) == []
        process.send_signal(signal.SIGKILL)
    (leftover,) = find_recoverable_files(tmp_path)
    document, origin = load_recoverable_file(leftover)
    assert not differences(document, disc_document())
    assert origin == UNKNOWN_SOURCE
    remove_recoverable_file(leftover)
    assert list(tmp_path.iterdir()) == []


def test_the_number_of_a_living_process_hides_nothing(tmp_path):
    path = tmp_path / f"unsaved-{os.getppid()}-0badcafe.lissom"
    save_project(path, disc_document())
    assert find_recoverable_files(tmp_path) == [path]


def test_the_work_of_another_living_window_is_not_offered(tmp_path, autosave):
    other = Autosave(tmp_path)
    other.write(disc_document(), UNKNOWN_SOURCE)
    autosave.write(full_document(), UNKNOWN_SOURCE)
    assert find_recoverable_files(tmp_path) == []
    other.remove()
    (kept,) = tmp_path.glob("unsaved-*.lissom")
    assert not differences(load_recoverable_file(kept)[0], full_document())


@pytest.mark.parametrize(
    "origin", [SourceInfo("dragon", None), SourceInfo("dräch", TESTS / "dräch.lissom")]
)
def test_work_remembers_where_it_came_from(tmp_path, autosave, origin):
    autosave.write(full_document(), origin)
    (kept,) = tmp_path.glob("unsaved-*.lissom")
    document, source = load_recoverable_file(kept)
    assert source == origin
    # A saved project does not say so.
    assert not differences(document, full_document())
    assert document.unknown_members == full_document().unknown_members


@pytest.mark.parametrize(
    "content", [None, b"\xff", b"[" * 99_999, b"[]", b'{"name": 1}', b'{"path": "/a.lissom"}']
)
def test_work_that_says_nothing_of_where_it_came_from_is_there_all_the_same(tmp_path, content):
    document = disc_document()
    if content is not None:
        document = replace(document, unknown_members={"origin.json": content})
    save_project(tmp_path / "unsaved-1.lissom", document)
    read, origin = load_recoverable_file(tmp_path / "unsaved-1.lissom")
    assert origin == UNKNOWN_SOURCE
    assert not differences(read, disc_document())
    assert not read.unknown_members


def test_a_place_that_depends_on_the_folder_is_no_place(tmp_path):
    document = replace(
        disc_document(), unknown_members={"origin.json": b'{"name": "a", "path": "a.lissom"}'}
    )
    save_project(tmp_path / "unsaved-1.lissom", document)
    assert load_recoverable_file(tmp_path / "unsaved-1.lissom")[1] == SourceInfo("a", None)


def test_leftovers_come_newest_first(tmp_path, autosave):
    for age, name in enumerate(["b", "c", "a"]):
        path = tmp_path / f"unsaved-{name}.lissom"
        path.write_bytes(b"")
        os.utime(path, (1000 - age, 1000 - age))
    autosave.write(disc_document(), UNKNOWN_SOURCE)
    assert [path.stem[-1] for path in find_recoverable_files(tmp_path)] == ["b", "c", "a"]


def test_nothing_stays_of_what_is_forgotten(tmp_path, autosave):
    for _ in range(2):
        autosave.write(disc_document(), UNKNOWN_SOURCE)
        autosave.remove()
        autosave.remove()
        assert list(tmp_path.iterdir()) == []


def test_where_the_system_knows_no_locks_work_is_offered_rather_than_hidden(
    tmp_path, monkeypatch, autosave
):
    def no_locks(_):
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr("app.storage.autosave.lock", no_locks)
    autosave.write(disc_document(), UNKNOWN_SOURCE)
    assert len(find_recoverable_files(tmp_path)) == 1

import errno
import io
import os
import stat
import struct
import subprocess
import sys
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from documents import disc_document, full_document
from full_disk import FullDisk
from messages import says
from numpy.testing import assert_array_equal

from app.errors import CANCELLED, LissomError
from app.storage import NO_ARRAYS, NO_FOLDER
from app.storage.files.arrays import read_arrays, write_arrays
from app.storage.files.atomic import (
    atomic_file,
    remove_abandoned_files,
    temporary_picture,
    write_atomically,
)
from app.storage.files.cancellation import Cancellation
from app.storage.files.file_lock import LARGEST_LOCK_TEXT, FileLock, FileLockedError
from app.storage.files.locks import at_lock_byte, lock
from app.storage.files.reading import LARGEST_FILE, NOT_ORDINARY, read_file
from app.storage.project_file import load_project, save_project
from app.storage.thumbnail import read_thumbnail


def test_arrays_come_back_under_exactly_the_given_name(tmp_path):
    path = tmp_path / "no suffix"
    write_arrays(path, {"a": np.arange(3), "b": np.array(2.5)})
    assert list(tmp_path.iterdir()) == [path]
    arrays = read_arrays(path, required=("a",), optional=("b", "absent"))
    assert_array_equal(arrays["a"], [0, 1, 2])
    assert set(arrays) == {"a", "b"}


def test_an_existing_file_is_replaced_and_keeps_its_mode(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"old")
    path.chmod(0o640)
    write_atomically(path, lambda file: file.write(b"new"))
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_new_file_is_readable_as_the_umask_says(tmp_path):
    before = os.umask(0o022)
    try:
        write_atomically(tmp_path / "file", lambda file: file.write(b""))
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "file").stat().st_mode) == 0o644


def test_the_umask_of_the_process_is_left_alone(tmp_path, monkeypatch):
    """It belongs to all threads: whoever changes it for a moment changes what others write."""

    def never(_):
        raise AssertionError("the umask was touched")

    monkeypatch.setattr(os, "umask", never)
    with ThreadPoolExecutor(4) as pool:
        paths = [tmp_path / f"{number}" for number in range(64)]
        list(pool.map(lambda path: write_atomically(path, lambda file: file.write(b"")), paths))
    (tmp_path / "other").touch()
    modes = {stat.S_IMODE(path.stat().st_mode) for path in tmp_path.iterdir()}
    assert len(modes) == 1


def test_what_replaces_a_private_file_is_never_readable_by_others(tmp_path):
    path = tmp_path / "file"
    path.touch(0o600)

    def look(_):
        (other,) = set(tmp_path.iterdir()) - {path}
        assert stat.S_IMODE(other.stat().st_mode) == 0o600

    write_atomically(path, look)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_a_link_stays_and_what_it_points_to_is_written(tmp_path):
    target, elsewhere = tmp_path / "here" / "file", tmp_path / "elsewhere"
    target.parent.mkdir()
    elsewhere.mkdir()
    target.write_bytes(b"old")
    target.chmod(0o640)
    (elsewhere / "first").symlink_to("../here/file")
    link = elsewhere / "second"
    link.symlink_to("first")
    with pytest.raises(LissomError, match="No space"):
        write_atomically(link, _fail_half_way)
    assert target.read_bytes() == b"old"
    write_atomically(link, lambda file: file.write(b"new"))
    assert link.is_symlink()
    assert target.read_bytes() == b"new"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640
    target.unlink()
    write_atomically(link, lambda file: file.write(b"first"))
    assert target.read_bytes() == b"first"
    assert sorted(path.name for path in tmp_path.rglob("*") if path.is_file()) == [
        "file",
        "first",
        "second",
    ]


def test_links_that_lead_nowhere_are_refused(tmp_path):
    (tmp_path / "a").symlink_to("b")
    (tmp_path / "b").symlink_to("a")
    (tmp_path / "c").symlink_to("missing/file")
    with pytest.raises(LissomError, match="leads in a circle"):
        write_atomically(tmp_path / "a", lambda file: file.write(b""))
    with pytest.raises(LissomError, match="missing does not exist"):
        write_atomically(tmp_path / "c", lambda file: file.write(b""))


def test_a_name_may_be_as_long_as_the_disk_lets_it(tmp_path):
    path = tmp_path / ("n" * 255)
    write_atomically(path, lambda file: file.write(b"new"))
    assert path.read_bytes() == b"new"


def _fail_half_way(file):
    file.write(b"half")
    raise OSError(28, "No space left on device")


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"old")
    with pytest.raises(LissomError, match="No space left"):
        write_atomically(path, _fail_half_way)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_folders_are_refused(tmp_path):
    with pytest.raises(LissomError, match="it is a folder"):
        write_arrays(tmp_path, {"a": [1]})
    with pytest.raises(LissomError, match=NO_FOLDER.format(folder=tmp_path / "missing")):
        write_arrays(tmp_path / "missing" / "file", {"a": [1]})


def test_what_is_no_array_file_is_refused(tmp_path):
    path = tmp_path / "file.npz"
    with pytest.raises(LissomError, match="No such file"):
        read_arrays(path, required=())
    write_arrays(path, {"a": np.arange(1000)})
    with pytest.raises(LissomError, match="has no array 'b'"):
        read_arrays(path, required=("b",))
    whole = path.read_bytes()
    for damaged in (b"", b"text", whole[:500], whole[:200] + b"\0" * 400 + whole[600:]):
        path.write_bytes(damaged)
        with pytest.raises(LissomError, match=says(NO_ARRAYS)):
            read_arrays(path, required=("a",))
    np.save(tmp_path / "one.npy", np.arange(3))
    with pytest.raises(LissomError, match=says(NO_ARRAYS)):
        read_arrays(tmp_path / "one.npy", required=("a",))
    np.savez(path, a=np.array([{"pickled": 1}], dtype=object))
    with pytest.raises(LissomError, match="not an NPZ file of numeric arrays"):
        read_arrays(path, required=("a",))


def abandoned(folder):
    """What a process leaves that is killed while it writes."""
    path = folder / ".lissom-0123456789abcdef.part"
    path.write_bytes(b"half")
    return path


def test_what_a_killed_process_left_half_written_is_removed_where_the_next_one_writes(tmp_path):
    part = abandoned(tmp_path)
    other = tmp_path / ".lissom-mine.part"
    other.write_bytes(b"not Lissom's")
    write_atomically(tmp_path / "a", lambda file: file.write(b"new"))
    assert not part.exists()
    assert other.exists()


def test_what_another_process_still_writes_is_not_removed(tmp_path):
    with atomic_file(tmp_path / "a") as file:
        file.write(b"slow")
        remove_abandoned_files(tmp_path)
    assert (tmp_path / "a").read_bytes() == b"slow"


def test_a_part_that_was_taken_for_abandoned_before_it_was_locked_is_made_again(
    tmp_path, monkeypatch
):
    taken = []

    def lock_too_late(descriptor):
        if not taken:
            (part,) = tmp_path.iterdir()
            taken.append(part)
            part.unlink()
        return lock(descriptor)

    monkeypatch.setattr("app.storage.files.atomic.lock", lock_too_late)
    write_atomically(tmp_path / "a", lambda file: file.write(b"new"))
    assert (tmp_path / "a").read_bytes() == b"new"
    assert taken


def test_where_the_disk_knows_no_locks_files_are_written_and_nothing_is_removed(
    tmp_path, monkeypatch
):
    def no_locks(_):
        raise OSError(errno.ENOLCK, "No locks available")

    part = abandoned(tmp_path)
    monkeypatch.setattr("app.storage.files.atomic.lock", no_locks)
    write_atomically(tmp_path / "a", lambda file: file.write(b"new"))
    assert (tmp_path / "a").read_bytes() == b"new"
    assert part.exists()


def test_a_picture_that_was_to_be_given_away_is_cleared_like_what_is_half_written(tmp_path):
    path = temporary_picture(tmp_path)
    write_atomically(path, lambda file: file.write(b"whole"))
    with path.open("rb") as file:
        assert lock(file.fileno())
        remove_abandoned_files(tmp_path)
        assert path.exists()
    remove_abandoned_files(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_gets_full_at_any_byte_leaves_the_old_file_whole(tmp_path, monkeypatch):
    path = tmp_path / "a.lissom"
    save_project(path, full_document())
    size = path.stat().st_size
    save_project(path, disc_document())
    before = path.read_bytes()
    monkeypatch.setattr("app.storage.files.atomic.os.fdopen", FullDisk)
    for room in np.unique(np.linspace(0, size - 1, 24, dtype=int)):
        FullDisk.room = room
        # To the byte, however few of them were written.
        with pytest.raises(LissomError, match=f"No space left .*needs {size / 1e3:.1f} KB, but"):
            save_project(path, full_document())
        assert path.read_bytes() == before
        assert list(tmp_path.iterdir()) == [path]


def test_what_never_ends_is_not_read(tmp_path):
    pipe = tmp_path / "pipe.png"
    os.mkfifo(pipe)
    for read in (read_file, load_project, lambda path: read_arrays(path, required=())):
        for path in (pipe, Path("/dev/zero")):
            with pytest.raises(LissomError, match=says(NOT_ORDINARY)):
                read(path)
    assert read_thumbnail(pipe) is None


def test_a_file_that_is_too_large_is_not_read(tmp_path):
    path = tmp_path / "large.png"
    with path.open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    with pytest.raises(LissomError, match="reads at most"):
        read_file(path)


def npz(path, content, *, size=None, method=zipfile.ZIP_STORED):
    with zipfile.ZipFile(path, "w", method) as archive:
        archive.writestr("a.npy", content)
    if size is not None:
        packed = path.read_bytes()
        path.write_bytes(packed.replace(struct.pack("<L", len(content)), struct.pack("<L", size)))
    return path


def npy(array, shape=None):
    file = io.BytesIO()
    np.save(file, array)
    content = file.getvalue()
    return content if shape is None else content.replace(*shape)


@pytest.mark.parametrize(
    "content",
    [
        npy(np.zeros(5), (b"(5,), }           ", b"(99999999999,), } ")),
        npy(np.zeros(5), (b"(5,)", b"(-5,)")),
        npy(np.zeros(5), (b"'<f8'", b"'|O' ")),
        npy(np.zeros(2, dtype=[("x", "f8")])),
        npy(np.zeros(5))[:-1],
        npy(np.zeros(5)) + b"more",
        b"",
        b"\x93NUMPY\x01\x00\x02\x00((",
        b"\x93NUMPY\x09\x00",
    ],
)
def test_arrays_that_are_not_what_they_say_are_refused(tmp_path, content):
    with pytest.raises(LissomError, match=says(NO_ARRAYS)):
        read_arrays(npz(tmp_path / "case.npz", content), required=("a",))


def test_text_in_place_of_numbers_is_reported(tmp_path):
    path = npz(tmp_path / "case.npz", npy(np.array(["text"])))
    with pytest.raises(LissomError, match="the array 'a' contains text"):
        read_arrays(path, required=("a",))


def test_packed_arrays_are_unpacked_within_limits(tmp_path, monkeypatch):
    content = npy(np.zeros(100_000))
    path = npz(tmp_path / "case.npz", content, method=zipfile.ZIP_DEFLATED)
    assert len(read_arrays(path, required=("a",))["a"]) == 100_000
    monkeypatch.setattr("app.storage.files.arrays.MOST_UNPACKED", 700_000)
    with pytest.raises(LissomError, match="would unpack to"):
        read_arrays(path, required=("a",))
    damaged = bytearray(path.read_bytes())
    damaged[60] ^= 0xFF
    path.write_bytes(damaged)
    monkeypatch.undo()
    with pytest.raises(LissomError, match="damaged"):
        read_arrays(path, required=("a",))


def test_file_lock_names_its_holder_when_another_asks(tmp_path):
    path = tmp_path / "a.lissom"
    hold = FileLock(path)
    with pytest.raises(FileLockedError, match=r"by .* on .*, since 20"):
        FileLock(path)
    hold.release()
    assert list(tmp_path.iterdir()) == []
    FileLock(path).release()


LOCK_CONTENT = """
import fcntl, sys
with open(sys.argv[1], "r+b") as file:
    fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, int(sys.argv[2]))
"""


def test_on_windows_no_byte_is_locked_that_others_read(tmp_path):
    """There a lock is of bytes and keeps others from reading them; `lockf` locks bytes here."""
    fcntl = pytest.importorskip("fcntl")
    path = tmp_path / "lock"

    def lets_others_read():
        words = [sys.executable, "-c", LOCK_CONTENT, path, str(LARGEST_LOCK_TEXT)]
        return subprocess.run(words, stderr=subprocess.DEVNULL, check=False).returncode == 0

    def lock_byte(file):
        # Where the file is just then, as msvcrt.locking does.
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, 0, os.SEEK_CUR)

    with path.open("w+b") as file:
        file.write(b"who")
        file.flush()
        with at_lock_byte(file.fileno()):
            lock_byte(file.fileno())
        assert file.tell() == os.lseek(file.fileno(), 0, os.SEEK_CUR) == 3
        assert lets_others_read()
        file.seek(0)
        lock_byte(file.fileno())
        assert not lets_others_read()
    assert path.read_bytes() == b"who"


def test_a_lock_file_that_a_dead_process_left_holds_nothing(tmp_path):
    path = tmp_path / "a.lissom"
    hold = FileLock(path)
    # What the system does when a process ends.
    os.close(hold._descriptor)
    assert len(list(tmp_path.iterdir())) == 1
    FileLock(path).release()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "content", [b"", b"[" * 999, b"{}", b'{"who": "a\\u0007", "since": 1e308}']
)
def test_nonsense_in_a_lock_file_is_reported_as_what_is_known(tmp_path, content):
    hold = FileLock(tmp_path / "a.lissom")
    (beside,) = tmp_path.iterdir()
    beside.write_bytes(content)
    with pytest.raises(FileLockedError, match="in another window"):
        FileLock(tmp_path / "a.lissom")
    hold.release()


def test_a_file_that_is_cancelled_while_it_is_written_is_gone_at_once(tmp_path):
    path, cancellation = tmp_path / "a", Cancellation()
    path.write_bytes(b"before")

    def write(file):
        file.write(b"new")
        assert len(list(tmp_path.iterdir())) == 2
        assert cancellation.cancel()
        assert os.name == "nt" or list(tmp_path.iterdir()) == [path]
        file.write(b"more, as whoever writes it cannot know")

    with pytest.raises(LissomError, match=CANCELLED):
        write_atomically(path, write, cancellation)
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == b"before"
    with pytest.raises(LissomError, match=CANCELLED):
        write_atomically(path, lambda file: file.write(b"never"), cancellation)
    assert path.read_bytes() == b"before"


def test_a_file_that_is_in_its_place_cannot_be_cancelled_but_those_after_it_can(tmp_path):
    first, second, cancellation = tmp_path / "a", tmp_path / "b", Cancellation()
    write_atomically(first, lambda file: file.write(b"new"), cancellation)
    with pytest.raises(LissomError), atomic_file(second, cancellation):
        assert not cancellation.cancel()
    assert list(tmp_path.iterdir()) == [first]

import os
import stat
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from app.errors import LissomError
from app.storage.files import read_arrays, write_arrays, write_atomically


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
    with pytest.raises(LissomError, match="does not exist"):
        write_arrays(tmp_path / "missing" / "file", {"a": [1]})


def test_what_is_no_array_file_is_refused(tmp_path):
    path = tmp_path / "file.npz"
    with pytest.raises(LissomError, match="No such file"):
        read_arrays(path, required=())
    write_arrays(path, {"a": np.arange(1000)})
    with pytest.raises(LissomError, match="lacks the array 'b'"):
        read_arrays(path, required=("b",))
    whole = path.read_bytes()
    for damaged in (b"", b"text", whole[:500], whole[:200] + b"\0" * 400 + whole[600:]):
        path.write_bytes(damaged)
        with pytest.raises(LissomError, match="not an NPZ file"):
            read_arrays(path, required=("a",))
    np.save(tmp_path / "one.npy", np.arange(3))
    with pytest.raises(LissomError, match="not an NPZ file"):
        read_arrays(tmp_path / "one.npy", required=("a",))
    np.savez(path, a=np.array([{"pickled": 1}], dtype=object))
    with pytest.raises(LissomError, match="not an NPZ file of numeric arrays"):
        read_arrays(path, required=("a",))

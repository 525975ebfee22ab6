"""Project files that nobody saved: they open as valid documents or are refused in plain words.

Whatever stands in them, reading neither raises anything else nor takes more memory than is said.
"""

import copy
import io
import json
import tracemalloc
import zipfile
from contextlib import contextmanager

import numpy as np
import pytest
from documents import clocked_document, differences
from messages import says

from app.errors import LissomError
from app.storage.project.archive import MEMBER_TOO_LARGE, MIMETYPE
from app.storage.project_file import load_project, save_project

MEBIBYTE = 1024 * 1024
ODD = (
    *(None, True, False, 0, 1, -1, 2, 10**9, -(10**9), 10**30, 0.5, -0.5, 1e-300, 1e308, -1e308),
    *(
        "",
        "x",
        "linear",
        "transparent",
        "\ud800",
        "x" * 10_000,
        [],
        {},
        [[]],
        [0, 0],
        [1e308, 1e308],
    ),
    *([0, 1], [3, 2, 1], {"": {}}, {"id": 0}, [None] * 50),
)


@pytest.fixture(scope="module")
def members(tmp_path_factory):
    path = tmp_path_factory.mktemp("project") / "full.lissom"
    save_project(path, clocked_document())
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@contextmanager
def memory_below(most):
    """Assert that what is done takes less memory at any moment, in bytes."""
    tracemalloc.start()
    try:
        yield
        assert tracemalloc.get_traced_memory()[1] < most
    finally:
        tracemalloc.stop()


def pack(path, members, *, method=zipfile.ZIP_STORED):
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            kind = zipfile.ZIP_STORED if name == "mimetype" else method
            archive.writestr(name, content, compress_type=kind)
    return path


def places(content, way=()):
    """All places in a JSON text, each as the steps that lead there."""
    parts = content.items() if isinstance(content, dict) else enumerate(content)
    for step, value in parts:
        yield (*way, step)
        if isinstance(value, (dict, list)):
            yield from places(value, (*way, step))


def edited(rng, text):
    """Change, remove, repeat or exchange some values of a JSON text."""
    content = json.loads(text)
    for _ in range(rng.integers(1, 4)):
        ways = list(places(content))
        way, other = (ways[rng.integers(len(ways))] for _ in range(2))
        holder, source = content, content
        for step in way[:-1]:
            holder = holder[step]
        for step in other:
            source = source[step]
        kind = rng.integers(4)
        if kind == 0:
            del holder[way[-1]]
        elif kind == 1:
            holder[way[-1]] = copy.deepcopy(source)
        elif kind == 2 and isinstance(holder, list):
            holder.insert(0, copy.deepcopy(holder[way[-1]]))
        else:
            holder[way[-1]] = copy.deepcopy(ODD[rng.integers(len(ODD))])
    return json.dumps(content).encode()


def flipped(rng, content):
    """Flip some bits, in the data of arrays more often than in their headers."""
    changed = bytearray(content)
    for _ in range(rng.integers(1, 4)):
        if changed:
            changed[rng.integers(len(changed))] ^= 1 << rng.integers(8)
    return bytes(changed)


def tampered(rng, members):
    members = dict(members)
    names = list(members)[1:]
    name, other = (names[rng.integers(len(names))] for _ in range(2))
    kind = rng.integers(5)
    if kind < 2:
        members["project.json"] = edited(rng, members["project.json"])
    elif kind == 2:
        members[name], members[other] = members[other], members[name]
    elif kind == 3:
        arrays = [name for name in names if name.endswith(".npy")]
        name = arrays[rng.integers(len(arrays))]
        members[name] = flipped(rng, members[name])
    else:
        members[name] = members[name][: rng.integers(len(members[name]))]
    return members


def test_tampered_file_opens_as_a_valid_document_or_is_refused(tmp_path, members):
    rng = np.random.default_rng(2)
    opened = 0
    for _ in range(30):
        pack(tmp_path / "a", tampered(rng, members))
        try:
            with memory_below(16 * MEBIBYTE):
                document = load_project(tmp_path / "a")
        except LissomError:
            continue
        opened += 1
        save_project(tmp_path / "b", document)
        assert not differences(load_project(tmp_path / "b"), document)
    assert 2 < opened < 28


def npy(array):
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def test_small_file_is_refused_unread_when_it_has_large_arrays(tmp_path, members):
    """The most that was ever taken by one of these: 0.9 MB of file, 792 MiB."""
    content = json.loads(members["project.json"])
    layer = content["layers"][0]
    layer["keys"] = [layer["keys"][0] | {"frame": frame} for frame in range(3, 43)]
    zeros = npy(np.zeros(MEBIBYTE // 4, complex))
    keys = [
        f"layers/0/keys/{index:05}.{part}.npy" for index in range(40) for part in ("phi", "psi")
    ]
    large = members | {"project.json": json.dumps(content).encode()} | dict.fromkeys(keys, zeros)
    path = pack(tmp_path / "a", large, method=zipfile.ZIP_DEFLATED)
    assert path.stat().st_size < MEBIBYTE
    with memory_below(MEBIBYTE), pytest.raises(LissomError, match="would unpack to"):
        load_project(path)


def test_arrays_larger_than_a_domain_can_be_are_not_read(tmp_path, members):
    large = members | {"layers/0/keys/00001.phi.npy": npy(np.zeros(MEBIBYTE, complex))}
    path = pack(tmp_path / "a", large, method=zipfile.ZIP_DEFLATED)
    with (
        memory_below(4 * MEBIBYTE),
        pytest.raises(
            LissomError, match=says(MEMBER_TOO_LARGE, name="layers/0/keys/00001.phi.npy")
        ),
    ):
        load_project(path)


@pytest.mark.parametrize("text", [b"[" + b"[]," * 1_500_000 + b"0]", b'{"x":[' + b"0," * 1_500_000])
def test_json_of_many_values_is_not_decoded(tmp_path, members, text):
    path = pack(tmp_path / "a", members | {"project.json": text}, method=zipfile.ZIP_DEFLATED)
    refused = pytest.raises(LissomError, match="too many values")
    with memory_below(16 * MEBIBYTE), refused:
        load_project(path)


def test_layer_is_never_read_when_it_is_named_many_times(tmp_path, members):
    content = json.loads(members["project.json"])
    content["layers"] = content["layers"] * 100
    picture = members["layers/0/source.png"] + bytes(MEBIBYTE)
    again = members | {"project.json": json.dumps(content).encode()}
    path = pack(tmp_path / "a", again | {"layers/0/source.png": picture})
    refused = pytest.raises(LissomError, match="two of its layers have the same id")
    with memory_below(16 * MEBIBYTE), refused:
        load_project(path)


@pytest.mark.parametrize("method", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_other_ways_of_packing_are_refused(tmp_path, members, method):
    with pytest.raises(LissomError, match="is not a Lissom project, or it is damaged"):
        load_project(pack(tmp_path / "a", members, method=method))


def test_members_that_overlap_are_refused(tmp_path):
    """The end of the file lists one member many times, under other names."""
    path = tmp_path / "a"
    names = [f"notes/{index:04}" for index in range(1000)]
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", MIMETYPE)
        archive.writestr("project.json", b"{}")
        archive.writestr(names[0], bytes(100_000))
        (first,) = [member for member in archive.filelist if member.filename == names[0]]
        for name in names[1:]:
            again = copy.copy(first)
            again.filename = name
            archive.filelist.append(again)
    with pytest.raises(LissomError, match="its members overlap"):
        load_project(path)

"""What strangers hand in: refused in one line, whatever it is."""

import io
import json
import os
import re
import resource
import subprocess
import sys
import zipfile

import numpy as np
import pytest
from documents import disc_document
from layered import blob, openraster
from messages import says
from refusals import refusal

from app.cli import process
from app.cli.arrays.hole_arrays import HOLE_SIZES
from app.cli.main import TOO_LITTLE_MEMORY, main
from app.cli.process import LEAST_MEMORY
from app.errors import MAX_TEXT_LENGTH
from app.storage import NO_ARRAYS, sample_images, save_project
from app.storage.files.reading import FOLDER_READ, NOT_ORDINARY
from engine.geometry.polygon import CAGE_FAR, CAGE_REPEATS, FEW_DIGITS

SQUARE = np.array([0, 1, 1 + 1j, 1j])
CAGE = (SQUARE - 0.5 - 0.5j) * 1.4 + 0.5 + 0.5j
MAPS = {
    "outline": SQUARE,
    "cage": CAGE,
    "points": np.array([0.5 + 0.5j, 0.3 + 0.4j, 0.6 + 0.4j]),
    "phi": np.array([CAGE, 1.2j * CAGE]),
    "psi": np.zeros((2, 4)),
}
BY_BOUNDARY = {name: MAPS[name] for name in ("outline", "cage", "points")}
HOLE = np.array([0.4 + 0.4j, 0.4 + 0.6j, 0.6 + 0.6j, 0.6 + 0.4j])
HUGE = 2**63 - 1


def sample_project(folder):
    save_project(folder / "a.lissom", disc_document())
    return folder / "a.lissom"


def interpolated(capsys, tmp_path, *paths, variant="nu"):
    words = ("interpolate", *paths, "--variant", variant, "--times=0", "--out", tmp_path / "out")
    return refusal(capsys, *words)


@pytest.mark.parametrize("packing", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_what_is_packed_in_rare_ways_is_refused(tmp_path, capsys, packing):
    path = tmp_path / "a.npz"
    with zipfile.ZipFile(path, "w", packing) as archive:
        for name, values in MAPS.items():
            file = io.BytesIO()
            np.save(file, values)
            archive.writestr(f"{name}.npy", file.getvalue())
    content = bytearray(path.read_bytes())
    content[60:70] = b"\xff" * 10  # of the first member, packed
    path.write_bytes(content)
    assert re.search(says(NO_ARRAYS), interpolated(capsys, tmp_path, path))
    path = path.rename(tmp_path / "a.ora")
    assert "not an OpenRaster" in refusal(capsys, "domain", path, "--out", tmp_path / "out")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({**MAPS, "cage": 1e300 * CAGE}, says(CAGE_FAR)),
        ({**MAPS, "cage": 1e9 * CAGE}, says(CAGE_FAR)),
        ({**MAPS, "outline": 1e200 * SQUARE, "cage": 1e200 * CAGE}, says(FEW_DIGITS)),
        ({**MAPS, "outline": 1e-200 * SQUARE, "cage": 1e-200 * CAGE}, says(FEW_DIGITS)),
        ({**MAPS, "outline": SQUARE + 1e12, "cage": CAGE + 1e12}, says(FEW_DIGITS)),
        ({**MAPS, "cage": CAGE[[0, 1, 1, 2]]}, says(CAGE_REPEATS)),
        ({**MAPS, "triangles": np.empty((0, 3), int)}, "no triangles"),
        ({**BY_BOUNDARY, "boundary": np.empty((0, 4))}, "must have the shape"),
        ({**BY_BOUNDARY, "boundary": np.zeros((2, 4))}, "more than one point"),
        ({**BY_BOUNDARY, "boundary": np.full((2, 4), 1e308) * SQUARE}, "finite positions only"),
        *(
            (
                {
                    **MAPS,
                    "hole_outlines": np.tile(HOLE, len(sizes)),
                    "hole_cages": np.tile(HOLE, len(sizes)),
                    "hole_outline_sizes": np.array(sizes),
                    "hole_cage_sizes": np.array(sizes),
                    "hole_centres": np.full(len(sizes), 0.5 + 0.5j),
                },
                says(HOLE_SIZES),
            )
            for sizes in ([-4, 12], [HUGE, HUGE, 14])  # the latter wrap around to 12
        ),
    ],
)
def test_arrays_that_make_no_sense_are_refused(tmp_path, capsys, changes, words):
    path = tmp_path / "a.npz"
    np.savez(path, **changes)
    assert re.search(words, interpolated(capsys, tmp_path, path))


@pytest.mark.parametrize(
    ("face", "words"),
    [
        ("f 1 2 4294967297", "names vertex 4294967297"),
        ("f 1 2 999999999999999999999", "line 4"),
        ("f 1 2 4", "names vertex 4"),
        ("f", "line 4"),
        ("v nan 0 0\nf 1 2 3", "not finite"),
    ],
)
def test_meshes_that_make_no_sense_are_refused(tmp_path, capsys, face, words):
    path = tmp_path / "a.obj"
    path.write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\n{face}\n")
    assert words in interpolated(capsys, tmp_path, path, path, variant="arap")


@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
@pytest.mark.parametrize("suffix", [".obj", ".npz", ".png", ".lissom", ".ora", ".json"])
def test_what_is_no_plain_file_is_never_waited_for(tmp_path, capsys, suffix, kind):
    path, out = tmp_path / f"a{suffix}", tmp_path / "out"
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    else:
        path.mkdir()
    calls = {
        ".obj": ("interpolate", path, path, "--variant", "arap", "--times=0", "--out", out),
        ".npz": ("deform", path, "--out", out),
        ".lissom": ("certify", path),
        ".json": ("pose", __file__, path, "--out", out),
    }
    said = refusal(capsys, *calls.get(suffix, ("domain", path, "--out", out)))
    assert re.search(f"{says(NOT_ORDINARY)}|{says(FOLDER_READ)}", said)


FULL = "lissom: error: cannot use standard output: No space left on device"
SAMPLE = sample_images() / "bar.png"
PROGRAM = [sys.executable, "-m", "app"]


def run(*words, **how):
    how = {"capture_output": True, "text": True, **how}
    return subprocess.run([*PROGRAM, *map(str, words)], check=False, **how)


def test_full_standard_output_is_reported_after_a_command(monkeypatch, capsys):
    with open("/dev/full", "w") as full:  # noqa: PTH123 - it is no file
        monkeypatch.setattr(sys, "stdout", full)
        said = refusal(capsys, "move", "--list")
    assert said == FULL


@pytest.mark.parametrize("words", [("--version",), ("domain", "--help")])
def test_a_full_standard_output_is_reported_in_one_line(words):
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    with open("/dev/full", "w") as full:  # noqa: PTH123 - it is no file
        ended = run(
            *words, env=environment, capture_output=False, stdout=full, stderr=subprocess.PIPE
        )
    assert ended.returncode == 2
    assert ended.stderr == f"{FULL}\n"


def test_closed_streams_stop_nothing(tmp_path):
    out = tmp_path / "out.npz"
    words = ("domain", SAMPLE, "--triangles", 1000, "--out", out)

    def close():
        os.closerange(0, 3)

    ended = run(*words, capture_output=False, preexec_fn=close)
    assert ended.returncode == 0
    with np.load(out) as written:
        assert "outline" in written


def test_poor_alphabets_stop_nothing():
    words = ("pose", "--help")
    ended, rich = (
        run(*words, env={**os.environ, "PYTHONIOENCODING": name}) for name in ("ascii", "utf-8")
    )
    assert (ended.returncode, ended.stderr) == (0, "")
    assert not rich.stdout.isascii()
    assert ended.stdout == rich.stdout.encode("ascii", "replace").decode("ascii")


@pytest.mark.parametrize(
    ("command", "limit"),
    [
        ("domain", 150_000_000),
        ("domain", LEAST_MEMORY - 1),
        # With which software OpenGL ended the process in other ways.
        pytest.param("export", 700_000_000, marks=pytest.mark.long),
        ("export", 1_200_000_000),
    ],
)
def test_too_little_memory_is_reported_in_one_line(tmp_path, command, limit):
    def lessen():
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    given = SAMPLE if command == "domain" else sample_images() / "friend.lissom"
    ended = run(command, given, "--out", tmp_path / "out", preexec_fn=lessen)
    assert ended.returncode == 2
    assert ended.stderr.startswith(f"lissom: error: {TOO_LITTLE_MEMORY}")
    assert ended.stderr.count("\n") == 1


def test_a_library_that_cannot_be_loaded_is_reported_in_one_line(monkeypatch, capsys, tmp_path):
    def missing(_):
        raise ImportError("libfine.so: failed to map segment")

    monkeypatch.setattr("app.cli.main.importlib.import_module", missing)
    assert "cannot be loaded (libfine.so" in refusal(capsys, "doctor")
    monkeypatch.undo()
    monkeypatch.setattr(process.threading.Thread, "start", _no_thread)
    words = ("domain", SAMPLE, "--out", tmp_path / "out")
    assert TOO_LITTLE_MEMORY in refusal(capsys, *words)
    # Nor later.
    monkeypatch.undo()
    monkeypatch.setattr("app.cli.commands.domain.run", _no_thread)
    assert TOO_LITTLE_MEMORY in refusal(capsys, *words)


def _no_thread(_):
    raise RuntimeError("can't start new thread")


@pytest.mark.parametrize("name", [".html", ".PNG", "there/.gif"])
def test_a_name_that_is_only_an_ending_is_refused(tmp_path, capsys, name):
    (tmp_path / "there").mkdir()
    project = sample_project(tmp_path)
    assert "only the ending of a file name" in refusal(
        capsys, "export", project, "--out", tmp_path / name
    )
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.lissom", "there"]


def test_an_empty_name_is_refused(tmp_path, capsys):
    project = sample_project(tmp_path)
    assert "is empty" in refusal(capsys, "export", project, "--out", "")
    assert "is empty" in refusal(capsys, "certify", "")


@pytest.mark.parametrize("name", ["a.png", "a.ora", "a.psd", "a.json"])
def test_a_folder_in_the_place_of_a_file_is_refused(tmp_path, capsys, name):
    (tmp_path / name).mkdir()
    picture = sample_images() / "bar.png" if name.endswith("json") else tmp_path / name
    words = ("pose", picture, tmp_path / "a.json", "--out", tmp_path / "a.lissom")
    if not name.endswith("json"):
        (tmp_path / "a.json").write_text('{"schema": 1, "handles": {}, "keys": [{"frame": 0}]}')
    assert re.search(says(FOLDER_READ), refusal(capsys, *words))


def test_names_and_notices_of_a_drawing_are_printable_and_few(tmp_path, capsys):
    names = ["a&#x9b;31m&#10;b", *map(str, range(1, 2_000))]
    odd = "".join(f'<stack composite-op="m{name}" name="{name}"/>' for name in names)
    layer = '<layer name="&#x9b;31m" src="data/0.png"/>'
    path = tmp_path / "a.ora"
    path.write_bytes(openraster((60, 60), layer + odd, [blob(50, 50)]))
    script = tmp_path / "a.json"
    script.write_text('{"schema": 1, "handles": {}, "keys": [{"frame": 0}]}')
    words = ["pose", path, script, "--out", tmp_path / "a.lissom", "--triangles", "1000"]
    assert main([str(word) for word in words]) == 0
    first, *others, last = capsys.readouterr().err.splitlines()
    assert first.startswith(r"lissom: a\x9b31m\nb: ")
    assert len(others) == 9
    assert last == "lissom: and 1,990 more"
    assert main(["certify", str(tmp_path / "a.lissom")]) == 0
    assert capsys.readouterr().out.isascii()


def test_the_version_of_a_newer_project_is_shortened(tmp_path, capsys):
    project = sample_project(tmp_path)
    with zipfile.ZipFile(project) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    content = json.loads(members["project.json"])
    members["project.json"] = json.dumps(content | {"schema": 99, "app_version": "9\n" * 500})
    with zipfile.ZipFile(project, "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    reported = refusal(capsys, "certify", project)
    assert r"newer Lissom (9\n9\n" in reported
    assert reported.count("9") < MAX_TEXT_LENGTH

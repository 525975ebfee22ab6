"""Nothing is written over what it is made from, nor over what is no plain file."""

import os
import re
import socket
from pathlib import Path

import pytest
from animations import moving_document
from messages import says
from refusals import refusal

from app.cli.options import NAMED_LIKE_FOLDER, NO_STANDARD_OUTPUT
from app.storage import IS_FILE, SAME_FILE
from app.storage.project_file import save_project

# Of each command, how it is called with an input and an output in places of its own.
CALLS = {
    "thumbnail": ["thumbnail", "INPUT", "--out", "OUT"],
    "deform": ["deform", "INPUT", "--out", "OUT"],
    "interpolate": ["interpolate", "INPUT", "--variant", "nu", "--times=0", "--out", "OUT"],
    "a later mesh": [
        *("interpolate", "other", "INPUT", "--variant", "arap", "--times=0", "--out", "OUT")
    ],
    "domain": ["domain", "INPUT", "--out", "OUT"],
    "preview": ["domain", "INPUT", "--out", "other", "--preview", "OUT"],
    "mask": ["domain", "other", "--mask", "INPUT", "--out", "OUT"],
    "picture of a pose": ["pose", "INPUT", "other", "--out", "OUT"],
    "script of a pose": ["pose", "other", "INPUT", "--out", "OUT"],
    "mask of a pose": ["pose", "other", "other", "--mask", "INPUT", "--out", "OUT"],
    "picture": ["export", "INPUT", "--frame", "1", "--format", "picture", "--out", "OUT"],
    "gif": ["export", "INPUT", "--format", "gif", "--out", "OUT"],
    "model": ["export", "INPUT", "--format", "glb", "--out", "OUT"],
}


@pytest.fixture(scope="module")
def project(tmp_path_factory) -> bytes:
    path = tmp_path_factory.mktemp("project") / "walk.lissom"
    save_project(path, moving_document())
    return path.read_bytes()


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "other").write_bytes(b"other")
    return tmp_path


@pytest.mark.parametrize("how", ["itself", "by another way", "link", "hard link", "linked input"])
@pytest.mark.parametrize("call", CALLS)
def test_no_output_takes_the_place_of_its_input(here, project, capsys, call, how):
    given = here / "given"
    given.write_bytes(project)
    out = here / "out"
    match how:
        case "itself":
            out = given
        case "by another way":
            (here / "folder").mkdir()
            out = here / "folder" / ".." / "given"
        case "link":
            out.symlink_to(given)
        case "hard link":
            out.hardlink_to(given)
        case "linked input":
            (here / "real").hardlink_to(given)
            given.unlink()
            given.symlink_to("real")
            out = here / "real"
    words = [{"INPUT": given, "OUT": out}.get(word, word) for word in CALLS[call]]
    assert "is the same file as" in refusal(capsys, *words)
    assert given.read_bytes() == project


def test_the_files_beside_an_output_are_looked_at_too(here, project, capsys):
    given = here / "walk.json"
    given.write_bytes(project)
    words = ["export", given, "--format", "spritesheet", "--out", here / "walk.png"]
    assert re.search(says(SAME_FILE), refusal(capsys, *words))
    frames = here / "frames"
    frames.mkdir()
    (frames / "frame_0003.png").symlink_to(given)
    words = ["export", given, "--format", "png", "--out", frames]
    assert re.search(says(SAME_FILE), refusal(capsys, *words))
    assert given.read_bytes() == project


@pytest.mark.parametrize("is_there", [True, False])
def test_two_outputs_are_two_files(here, capsys, is_there):
    out = here / "out"
    if is_there:
        out.write_bytes(b"old")
    (here / "link").symlink_to(out)
    for preview in (out, here / "link"):
        words = ["domain", "other", "--out", out, "--preview", preview]
        assert re.search(says(SAME_FILE), refusal(capsys, *words))


@pytest.mark.parametrize("kind", ["pipe", "socket", "device", "link to a device"])
def test_only_plain_files_are_written_over(here, capsys, kind):
    out = here / "out"
    if kind == "pipe":
        os.mkfifo(out)
    elif kind == "socket":
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind("out")
    else:
        out.symlink_to("/dev/null")
    target = Path("/dev/null") if kind == "device" else out
    before = target.stat()
    for call in ("thumbnail", "deform", "interpolate", "domain", "picture of a pose"):
        words = [{"INPUT": "other", "OUT": target}.get(word, word) for word in CALLS[call]]
        assert "name an ordinary file" in refusal(capsys, *words)
    assert os.path.samestat(target.stat(), before)


@pytest.mark.usefixtures("here")
def test_standard_output_is_not_offered(capsys, monkeypatch):
    monkeypatch.setattr("app.storage.files.outputs.STREAMS", (99,))
    os.dup2(os.open("redirected", os.O_WRONLY | os.O_CREAT), 99)
    try:
        assert "standard output" in refusal(capsys, "domain", "other", "--out", "/dev/fd/99")
    finally:
        os.close(99)
    for words in (["domain", "other", "--out", "-"], ["export", "other", "--out", "-"]):
        assert NO_STANDARD_OUTPUT in refusal(capsys, *words)
    assert NO_STANDARD_OUTPUT in refusal(
        capsys, "domain", "other", "--out", "out", "--preview", "-"
    )


@pytest.mark.parametrize("name", ["n" * 256, "a/" * 3000 + "b", "nul\0"])
@pytest.mark.usefixtures("here")
def test_names_that_no_file_can_have_are_refused_in_words(capsys, name):
    for call in ("thumbnail", "domain", "preview"):
        words = [{"INPUT": "other", "OUT": name}.get(word, word) for word in CALLS[call]]
        assert "cannot write" in refusal(capsys, *words)


@pytest.mark.parametrize("command", ["manual", "figures"])
@pytest.mark.parametrize("name", ["other", "other/within"])
@pytest.mark.usefixtures("here")
def test_a_file_in_the_place_of_a_folder_is_reported(capsys, command, name):
    assert IS_FILE.format(file="other") in refusal(capsys, command, "--out", name)


@pytest.mark.parametrize("ending", ["/", "/."])
@pytest.mark.parametrize("call", [*CALLS, "webp", "html"])
@pytest.mark.usefixtures("here")
def test_a_file_that_is_named_like_a_folder_is_refused(capsys, call, ending, project):
    Path("walk.lissom").write_bytes(project)
    name = f"new.gif{ending}"
    given = CALLS.get(call, ["export", "INPUT", "--format", call, "--out", "OUT"])
    source = "walk.lissom" if given[0] == "export" else "other"
    words = [{"INPUT": source, "OUT": name}.get(word, word) for word in given]
    assert NAMED_LIKE_FOLDER.format(name=name) in refusal(capsys, *words)
    assert not Path("new.gif").exists()

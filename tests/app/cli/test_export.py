import os
import pty
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from animations import BLOB, moving_document
from documents import altered
from numpy.testing import assert_array_equal
from PIL import Image, ImageSequence

from app.cli.console import NO_NUMBER, NO_WHOLE
from app.cli.main import main
from app.cli.options import NAMED_LIKE_FOLDER
from app.document.settings import ExportSettings, FrameRange
from app.export_formats import EXPORT_FORMATS
from app.storage import NO_FOLDER
from app.storage.project.archive import NO_PROJECT
from app.storage.project_file import save_project
from engine.arrays import Bytes

pytestmark = pytest.mark.usefixtures("one_context")


@pytest.fixture(scope="module")
def document():
    return altered(moving_document(), export=ExportSettings(framing="canvas"))


@pytest.fixture
def project(document, tmp_path) -> Path:
    path = tmp_path / "turn.lissom"
    save_project(path, document)
    return path


def export(project: Path, *words: object) -> None:
    assert main(["export", str(project), *map(str, words)]) == 0


def error_of(capsys, project: Path, *words: object) -> str:
    with pytest.raises(SystemExit) as leaving:
        main(["export", str(project), *map(str, words)])
    assert leaving.value.code == 2
    (line,) = [
        line for line in capsys.readouterr().err.splitlines() if line.startswith("lissom: error:")
    ]
    return line


def pixels(path: Path) -> Bytes:
    return np.asarray(Image.open(path).convert("RGBA"))


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_the_first_key_comes_out_as_the_picture_and_the_shape_moves(project, tmp_path, capsys):
    out = tmp_path / "frames"
    export(project, "--out", out)
    said = capsys.readouterr()
    assert said.out == f"{out}: 7 frames of 120 × 90 pixels, frame_0000.png to frame_0006.png\n"
    assert "\r" not in said.err
    assert sorted(contents(out)) == [f"frame_{number:04d}.png" for number in range(7)]
    frames = [pixels(out / f"frame_{number:04d}.png") for number in range(7)]
    seen = BLOB[..., 3] >= 8
    assert_array_equal(frames[0][seen], BLOB[seen])
    assert not frames[0][BLOB[..., 3] == 0].any()
    away = [np.abs(frame[..., 3].astype(int) - frames[0][..., 3]).sum() for frame in frames]
    assert (np.diff(away) > 0).all()
    with Image.open(out / "frame_0000.png") as image:
        assert image.mode == "RGBA"


def test_a_new_project_is_exported_whole_whatever_its_motion(tmp_path, capsys):
    project = tmp_path / "whole.lissom"
    save_project(project, moving_document())
    export(project, "--out", tmp_path / "frames")
    assert "120 × 90" not in capsys.readouterr().out
    for path in (tmp_path / "frames").iterdir():
        alpha = pixels(path)[..., 3]
        assert alpha.any()
        assert not alpha[[0, -1]].any()
        assert not alpha[:, [0, -1]].any()
    part = tmp_path / "part"
    export(project, "--out", part, "--frames", "2:4")
    whole = contents(tmp_path / "frames")
    assert contents(part) == {name: whole[name] for name in contents(part)}


def test_two_exports_are_the_same_bytes(project, tmp_path):
    for name in ("first", "second"):
        export(project, "--out", tmp_path / name, "--frames", "3:4")
    assert contents(tmp_path / "first") == contents(tmp_path / "second")


def test_ranges_and_rates(project, tmp_path):
    export(project, "--out", tmp_path / "all")
    export(project, "--out", tmp_path / "some", "--frames", "2:4")
    whole, some = contents(tmp_path / "all"), contents(tmp_path / "some")
    assert some == {
        name: whole[name] for name in (f"frame_000{number}.png" for number in (2, 3, 4))
    }
    export(project, "--out", tmp_path / "half", "--frames", "2:6", "--fps", 12)
    half = contents(tmp_path / "half")
    assert half == {
        "frame_0002.png": whole["frame_0002.png"],
        "frame_0003.png": whole["frame_0004.png"],
        "frame_0004.png": whole["frame_0006.png"],
    }


def test_another_variant_blends_differently(project, tmp_path):
    for variant in ("nu", "linear"):
        export(project, "--out", tmp_path / variant, "--frames", "0:3", "--variant", variant)
    nu, linear = (contents(tmp_path / variant) for variant in ("nu", "linear"))
    assert nu["frame_0000.png"] == linear["frame_0000.png"]
    assert nu["frame_0003.png"] != linear["frame_0003.png"]


def test_options_stand_in_for_the_projects_own_settings(document, tmp_path, capsys):
    own = ExportSettings(
        format="spritesheet", size=(60, 45), background="#112233", frames=FrameRange(1, 4)
    )
    project = tmp_path / "own.lissom"
    save_project(project, altered(document, export=own))
    export(project, "--out", tmp_path / "sheet", "--no-trim", "--padding", 0)
    assert "4 frames of 60 × 45 pixels in 2 columns and 2 rows" in capsys.readouterr().out
    sheet = pixels(tmp_path / "sheet")
    assert sheet.shape == (90, 120, 4)
    assert sheet[0, 0].tolist() == [0x11, 0x22, 0x33, 255]
    export(
        project,
        *("--out", tmp_path / "moving.webp", "--size", "40x50", "--framing", "fit"),
        *("--background", "transparent", "--frames", "0:2", "--fps", "48"),
    )
    with Image.open(tmp_path / "moving.webp") as image:
        frames = [np.asarray(frame.convert("RGBA")) for frame in ImageSequence.Iterator(image)]
    assert [frame.shape for frame in frames] == [(50, 40, 4)] * 5
    assert all(frame[0, 0].tolist() == [0, 0, 0, 0] for frame in frames)
    assert "5 frames of 40 × 50 pixels, 48 a second" in capsys.readouterr().out


def test_a_format_has_the_pictures_that_it_had_last_in_the_project(document, tmp_path):
    frames = replace(document.export, size=(60, 45))
    film = replace(frames.in_format("mp4"), size=(120, 90), background="#ffffff")
    project = tmp_path / "film.lissom"
    save_project(project, altered(document, export=film))
    export(project, "--format", "png", "--frames", "0:0", "--out", tmp_path / "frames")
    frame = pixels(tmp_path / "frames" / "frame_0000.png")
    assert frame.shape == (45, 60, 4)
    assert not frame[0, 0].any()


def test_a_name_chooses_its_format(project, tmp_path):
    for name, kind in (("a.gif", "GIF"), ("a.webp", "WEBP"), ("a.apng", "PNG")):
        export(project, "--out", tmp_path / name, "--frames", "0:1")
        with Image.open(tmp_path / name) as image:
            assert image.format == kind
            assert image.n_frames == 2
    export(project, "--out", tmp_path / "a.mp4", "--background", "#ffffff", "--frames", "0:1")
    assert (tmp_path / "a.mp4").read_bytes()[4:8] == b"ftyp"


@pytest.mark.parametrize("here", [".", "./"])
def test_frames_go_where_one_is_and_files_have_a_name(project, tmp_path, monkeypatch, capsys, here):
    monkeypatch.chdir(tmp_path)
    assert main(["export", str(project), "--out", here, "--frames", "1:2"]) == 0
    assert [path.name for path in tmp_path.glob("*.png")] != []
    for name in ("gif", "spritesheet", "glb"):
        with pytest.raises(SystemExit) as leaving:
            main(["export", str(project), "--out", here, "--format", name])
        assert leaving.value.code == 2
        assert NAMED_LIKE_FOLDER.format(name=here) in capsys.readouterr().err


def test_a_model_needs_no_graphics_and_tells_how_good_it_is(project, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("app.cli.project_export.create_context", None)
    export(project, "--out", tmp_path / "{name}.glb", "--triangles", 600)
    out = tmp_path / f"{project.stem}.glb"
    assert out.read_bytes()[:4] == b"glTF"
    said = capsys.readouterr().out
    assert said.startswith(f"{out}: ")
    assert "vertices within" in said


def test_a_model_of_a_single_shape_says_one_shape(tmp_path, capsys):
    save_project(tmp_path / "short.lissom", altered(moving_document(last=1), variant="linear"))
    export(tmp_path / "short.lissom", "--out", tmp_path / "short.glb", "--triangles", 600)
    assert " 1 shape of " in capsys.readouterr().out


def test_one_frame_is_a_picture_of_any_size(project, tmp_path, capsys):
    export(project, "--out", tmp_path / "frames", "--frames", "3:3")
    export(project, "--out", tmp_path / "pose.png", "--frame", 3)
    assert (
        pixels(tmp_path / "pose.png").tobytes()
        == pixels(tmp_path / "frames" / "frame_0003.png").tobytes()
    )
    capsys.readouterr()
    export(project, "--out", tmp_path / "large.png", "--frame", 3, "--size", "1501x999")
    assert capsys.readouterr().out.endswith("large.png: 1501 × 999 pixels\n")
    assert pixels(tmp_path / "large.png").shape == (999, 1501, 4)
    export(project, "--out", tmp_path / "one", "--frame", 3)
    assert [path.name for path in (tmp_path / "one").iterdir()] == ["frame_0003.png"]


def test_frames_are_named_as_one_likes(project, tmp_path):
    export(project, "--out", tmp_path / "frames", "--frames", "2:4", "--names", "{name}_v2_##x")
    names = sorted(path.name for path in (tmp_path / "frames").iterdir())
    assert names == [f"{project.stem}_v2_0{number}x.png" for number in (2, 3, 4)]


def test_notices_tell_what_the_person_should_know(project, tmp_path, capsys):
    out = tmp_path / "frames"
    export(project, "--out", out)
    before = contents(out)
    assert "another export" not in capsys.readouterr().err
    export(project, "--out", out, "--frames", "0:2", "--size", "240x180")
    said = capsys.readouterr().err
    assert "4 frames of another export (frame_0003.png … frame_0006.png)" in said
    after = contents(out)
    changed = [name for name in sorted(before) if before[name] != after.pop(name)]
    assert changed == sorted(before)[:3]
    assert after == {}


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--out", "frames", "--frames", "3"], "0:47"),
        (["--out", "frames", "--frames", "4:2"], "not a valid range"),
        (["--out", "frames", "--frames", "0:99"], "0 to 6"),
        (["--out", "frames", "--size", "100"], "1920x1080"),
        (["--out", "frames", "--size", "0x10"], "1 to 65,535 pixels each way, not 0 × 10."),
        (["--out", "frames", "--size", "65535x65535"], "too large"),
        (["--out", "frames", "--background", "red"], "#rrggbb"),
        (["--out", "frames", "--fps", "0"], "from 1/60 to 1,000"),
        (["--out", "frames", "--fps", "fast"], NO_NUMBER.format(text="fast")),
        (["--out", "frames", "--format", "avi"], "spritesheet"),
        (["--out", "frames", "--framing", "wide"], "canvas"),
        (["--out", "frames", "--variant", "cubic"], "metric"),
        (["--out", "no/frames"], NO_FOLDER.format(folder="no")),
        (["--out", "walk.xyz"], "no format has the file name ending .xyz"),
        (["--out", "walk.glb", "--size", "10x10"], "does not use --size"),
        (["--out", "walk.gif", "--no-trim"], "does not use --trim"),
        (["--out", "walk.html", "--power-of-two"], "does not use --power-of-two"),
        (["--out", "frames", "--tolerance", "1"], "does not use --tolerance"),
        (["--out", "walk.png"], "(picture, apng, spritesheet)"),
        (
            ["--out", "walk.png", "--frame", "7"],
            "frame 7 is not in the animation; choose one from 0 to 6",
        ),
        (["--out", "walk.png", "--frame", "1e3"], NO_WHOLE.format(text="1e3")),
        (["--out", "walk.obj", "--format", "gif"], "use the ending .gif"),
        (["--out", "walk.glb", "--format", "gif"], "use the ending .gif"),
        (["--out", "walk.glb", "--format", "png"], "the name of a file"),
        (["--out", "walk.glb", "--fps", "12"], "any rate"),
        (["--out", "walk.glb", "--triangles", "5"], "100 to"),
        (["--out", "walk.glb", "--tolerance", "0"], "0.001 to 100"),
        (["--out", "walk.gif", "--fps", "60"], "50 frames a second"),
        (["--out", "walk.webp", "--size", "20000x9"], "16,383 pixels"),
        (["--out", "frames", "--names", "frame"], "'#' for each digit"),
        (["--out", "frames", "--names", "a/##"], "'#' for each digit"),
        (["--out", "a.mp4"], "background"),
        ([], "--out"),
    ],
)
def test_bad_usage_is_one_line_and_writes_nothing(project, capsys, monkeypatch, words, reason):
    tmp_path = project.parent
    monkeypatch.chdir(tmp_path)
    assert reason in error_of(capsys, project, *words)
    assert list(tmp_path.iterdir()) == [project]


def test_bad_projects_are_refused(tmp_path, capsys):
    (tmp_path / "text.lissom").write_text("no project")
    for name, reason in (("text.lissom", NO_PROJECT), ("none.lissom", "No such file")):
        assert reason in error_of(capsys, tmp_path / name, "--out", tmp_path / "frames")
    assert not (tmp_path / "frames").exists()


def test_an_interrupted_export_leaves_whole_frames_only(tmp_path):
    project, out = tmp_path / "long.lissom", tmp_path / "frames"
    save_project(
        project, altered(moving_document(last=1500), export=ExportSettings(framing="canvas"))
    )
    terminal, its_end = pty.openpty()
    # What a shell puts into the background ignores interrupts, and so would its children.
    words = ["env", "--default-signal=INT"]
    words += [sys.executable, "-m", "app", "export", str(project), "--out", str(out)]
    with subprocess.Popen(words, stderr=its_end, stdout=subprocess.PIPE) as process:
        os.close(its_end)
        shown = b""
        while b"\r\x1b[K20 of 1501 frames" not in shown:
            shown += os.read(terminal, 1000)
        process.send_signal(signal.SIGINT)
        while b"interrupted" not in shown:
            shown += os.read(terminal, 1000)
        assert process.wait() == 130
        assert process.stdout is not None
        assert process.stdout.read() == b""
    os.close(terminal)
    names = sorted(path.name for path in out.iterdir())
    assert 10 <= len(names) < 1501
    assert names == [f"frame_{number:04d}.png" for number in range(len(names))]
    for name in names:
        with Image.open(out / name) as image:
            image.load()
            assert image.size == (120, 90)


@pytest.mark.parametrize("kind", ["html", "glb", "spritesheet", "gif", "picture"])
def test_names_that_are_not_utf_8_are_written_and_reported(project, tmp_path, capsys, kind):
    odd = os.fsdecode(b"caf\xe9")
    try:
        renamed = project.rename(tmp_path / f"{odd}.lissom")
    except OSError:
        pytest.skip("this system lets no name be anything but UTF-8")
    ending = EXPORT_FORMATS[kind].suffixes[0]
    still = ("--frame", 0) if kind == "picture" else ()
    export(renamed, "--format", kind, "--out", tmp_path / f"{{name}}{ending}", *still)
    assert capsys.readouterr().out.startswith(f"{tmp_path}/caf\N{REPLACEMENT CHARACTER}{ending}: ")
    assert (tmp_path / f"{odd}{ending}").stat().st_size
    reported = error_of(capsys, tmp_path / f"{odd} too.lissom", "--out", tmp_path / odd)
    assert "caf\N{REPLACEMENT CHARACTER} too.lissom" in reported


# An export whose in-betweens are never prepared.
STUCK = """
import sys, threading
from app.cli.main import main
from app.motion.inbetweens import pose_sampler
def prepare(*_, **__):
    print("stuck", flush=True)
    threading.Event().wait()
pose_sampler.prepare_inbetweens = prepare
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.parametrize(
    "name",
    [
        "film.webm",
        "model.glb",
        *(pytest.param(name, marks=pytest.mark.long) for name in ("frames", "film.gif")),
    ],
)
def test_an_interrupt_is_answered_at_once_whatever_is_being_prepared(tmp_path, name):
    project, out = tmp_path / "walk.lissom", tmp_path / "out" / name
    out.parent.mkdir()
    save_project(project, altered(moving_document(), export=ExportSettings(framing="canvas")))
    words = ["env", "--default-signal=INT", sys.executable, "-c", STUCK]
    words += ["export", str(project), "--out", str(out)]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "stuck\n"
        process.send_signal(signal.SIGINT)
        _, said = process.communicate()
    # After ten seconds the process would end in any case.
    assert "interrupted by SIGINT" in said
    assert process.returncode == 130
    assert all(path.suffix == ".png" for path in out.parent.rglob("*") if path.is_file())

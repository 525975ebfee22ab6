"""`lissom pose --reload`: a changed drawing under the rig of a project."""

import json

import pytest
from layered import blob, openraster
from PIL import ImageDraw

from app.cli.main import main
from app.storage import FileLock, load_project

SCRIPT = {
    "schema": 1,
    "layers": [
        {
            "layer": "arm",
            "anchor": [110, 120],
            "handles": {"shoulder": [110, 120], "hand": [180, 125]},
            "keys": [{"frame": 0}, {"frame": 12, "targets": {"hand": [176, 150]}}],
            "attach": {"to": "body", "at": [110, 120]},
        }
    ],
}


def write(path, arm, left=100):
    stack = (
        f'<layer name="arm" src="data/0.png" x="{left}" y="60"/>'
        '<layer name="body" src="data/1.png" x="40" y="40"/>'
    )
    path.write_bytes(openraster((240, 200), stack, [arm, blob(80, 130, (30, 60, 200))]))
    return str(path)


@pytest.fixture
def project(tmp_path, capsys):
    write(tmp_path / "man.ora", blob(90, 30))
    (tmp_path / "s.json").write_text(json.dumps(SCRIPT))
    out = tmp_path / "man.lissom"
    words = ["--triangles", "1000", "--detail", "coarse", "--out", str(out)]
    assert main(["pose", str(tmp_path / "man.ora"), str(tmp_path / "s.json"), *words]) == 0
    capsys.readouterr()
    return out


def test_the_table_is_printed_and_the_project_keeps_its_keys(project, tmp_path, capsys):
    arm = blob(90, 30)
    ImageDraw.Draw(arm).rectangle((60, 0, 88, 12), fill=(20, 20, 20, 255))
    new = write(tmp_path / "new.ora", arm)
    before = load_project(project)
    assert main(["pose", "--reload", new, str(project)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == ["redrawn  arm", "same     body"]
    assert lines[2].endswith(": 1 redrawn, 0 moved, 0 new, 0 gone, 1 same")
    after = load_project(project)
    layer, old = after.layers[1], before.layers[1]
    assert layer.picture.sha256 != old.picture.sha256
    assert (layer.handles, layer.attachments) == (old.handles, old.attachments)
    assert [key.frame for key in layer.keys] == [0, 12]
    # Once more, nothing is written.
    written = project.read_bytes()
    assert main(["pose", "--reload", new, str(project)]) == 0
    assert "nothing changed" in capsys.readouterr().out
    assert project.read_bytes() == written


def test_one_layer_goes_to_another_file(project, tmp_path, capsys):
    new = write(tmp_path / "new.ora", blob(90, 30), left=104)
    written = project.read_bytes()
    out = tmp_path / "other.lissom"
    assert main(["pose", "--reload", new, "--layer", "arm", str(project), "--out", str(out)]) == 0
    assert "moved  arm  by +4, +0 pixels" in capsys.readouterr().out
    assert project.read_bytes() == written
    assert load_project(out).layers[1].anchor == 114 + 120j


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["{project}"], "SCRIPT.json is missing"),
        (["--reload", "{new}", "{project}", "{new}"], "takes a project alone"),
        (["--reload", "{new}", "{project}", "--layer", "leg"], "no layer 'leg'"),
        (["--reload", "{project}", "{project}"], "same file"),
    ],
)
def test_what_cannot_be_reloaded_is_refused_and_nothing_is_written(
    project, tmp_path, capsys, words, complaint
):
    places = {"project": str(project), "new": write(tmp_path / "new.ora", blob(90, 20))}
    written = project.read_bytes()
    with pytest.raises(SystemExit):
        main(["pose", *(word.format(**places) for word in words)])
    assert complaint in capsys.readouterr().err
    assert project.read_bytes() == written


def test_a_project_that_a_window_has_open_is_not_overwritten(project, tmp_path, capsys):
    new = write(tmp_path / "new.ora", blob(90, 20))
    lock = FileLock(project)
    try:
        with pytest.raises(SystemExit):
            main(["pose", "--reload", new, str(project)])
    finally:
        lock.release()
    assert "reload the drawing there" in capsys.readouterr().err

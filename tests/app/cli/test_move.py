"""`lissom move`: a drawing and a ready motion make a project that loops and is certified."""

import json

import pytest
from bodies import JOINTS, drawing, told
from layered import openraster

from app.cli.main import main
from app.document import FrameRange
from app.rigging import MOTIONS
from app.storage import load_project

FEW = ["--triangles", "1000", "--detail", "coarse"]
# Of each kind what is quickly solved; that motions are what they are is proven where they are made.
CALLS = {
    "biped-front": ["walk", "--speed", "2", "--size", "0.6"],
    "four-legs": ["walk", "--speed", "2", "--size", "0.6"],
    "chain": ["slither", "--size", "0.5"],
    "anything": ["breathe"],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("moved")
    for kind in JOINTS:
        drawing(kind).save(folder / f"{kind}.png")
        (folder / f"{kind}.json").write_text(json.dumps(told(kind)))
    return folder


@pytest.mark.parametrize(
    "kind",
    [
        "chain",
        *(pytest.param(kind, marks=pytest.mark.long) for kind in CALLS if kind != "chain"),
    ],
)
def test_each_kind_of_body_moves_in_a_loop(kind, folder, capsys):
    out = folder / f"{kind}.lissom"
    words = ["--joints", str(folder / f"{kind}.json"), "--out", str(out), *FEW]
    assert main(["move", str(folder / f"{kind}.png"), "--motion", *CALLS[kind], *words]) == 0
    assert "looped" in capsys.readouterr().out
    document = load_project(out)
    assert document.loop
    assert document.frames.last - document.frames.first >= 12
    (layer,) = document.layers
    assert layer.motions[0].kind == kind
    assert all(layer.is_proven(key.pose) for key in layer.keys)
    # What is in between takes long where there are many limbs.
    if kind == "anything":
        assert main(["certify", str(out)]) in (0, 3)


def test_kind_and_joints_are_guessed_and_printed(folder, capsys):
    out = folder / "guessed.lissom"
    words = ["--motion", "wag", "--out", str(out), *FEW]
    assert main(["move", str(folder / "chain.png"), *words]) == 0
    printed = capsys.readouterr().out
    assert "kind: chain (guessed)" in printed
    assert "joints: joint.1, joint.2" in printed


def test_travel_ends_a_stride_farther_without_a_loop(folder):
    out = folder / "travelled.lissom"
    words = ["--joints", str(folder / "biped-side.json"), "--out", str(out), *FEW]
    words += ["--travel", "--speed", "2", "--size", "0.6", "--facing", "right"]
    assert main(["move", str(folder / "biped-side.png"), "--motion", "walk", *words]) == 0
    document = load_project(out)
    assert (document.loop, document.frames) == (False, FrameRange(0, 12))
    layer = document.layers[0]
    foot = layer.motions[0].joints["foot.R"]
    ways = [key.pose.targets[foot].position for key in layer.keys]
    assert (ways[-1] - ways[0]).real > 20


def test_layers_are_merged(folder, capsys):
    drawn = drawing("anything")
    stack = (
        '<layer name="front" src="data/0.png" x="90" y="90"/><layer name="back" src="data/1.png"/>'
    )
    pictures = [drawn.crop((90, 90, 200, 200)), drawn]
    (folder / "layers.ora").write_bytes(openraster(drawn.size, stack, pictures))
    out = folder / "layers.lissom"
    words = ["--motion", "breathe", "--out", str(out), *FEW]
    assert main(["move", str(folder / "layers.ora"), *words]) == 0
    assert "the 2 layers of layers.ora were merged" in capsys.readouterr().err
    assert len(load_project(out).layers) == 1


def test_motions_are_listed_with_their_kinds(capsys):
    assert main(["move", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(MOTIONS)
    assert "biped-side, biped-front, four-legs" in lines[0]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--motion", "dance"], "There is no motion preset 'dance'; choose one of walk"),
        (["--motion", "trot", "--kind", "chain"], "'trot' is not a motion for 'chain'"),
        (["--motion", "wag", "--kind", "worm"], "There is no kind of body 'worm'"),
        (["--motion", "walk", "--size", "9"], "size must be from 0.05 to 2, not 9"),
        (
            ["--motion", "wag", "--travel", "--kind", "chain"],
            "'wag' has no steps, so it cannot travel",
        ),
        (["--motion", "walk", "--kind", "biped-side"], "--kind is 'biped-side', but"),
        ([], "--motion is missing"),
        (["--motion", "wag"], "the joint 'joint.1' at (2, 3) is not on the drawing"),
        (["--motion", "wag"], "'chain' has no joint 'wing'"),
        (["--motion", "wag"], "schema must be 1, not 7"),
        (["--motion", "wag"], "joints.json is not JSON"),
        (["--motion", "wag"], "unknown field 'limbs'"),
    ],
)
def test_what_cannot_be_done_is_refused_in_a_sentence(words, said, folder, tmp_path, capsys):
    joints = told("chain")
    joints |= {"schema": 7} if "schema" in said else {}
    joints |= {"limbs": []} if "limbs" in said else {}
    if "(2, 3)" in said or "'wing'" in said:
        joints["joints"]["wing" if "'wing'" in said else "joint.1"] = [2, 3]
    text = json.dumps(joints)
    (tmp_path / "joints.json").write_text(text[:-9] if "JSON" in said else text)
    with_joints = ["--joints", str(tmp_path / "joints.json")]
    with_joints = [] if "--kind" in words and "biped-side" not in words else with_joints
    out = ["--out", str(tmp_path / "out.lissom"), *FEW]
    with pytest.raises(SystemExit) as ended:
        main(["move", str(folder / "chain.png"), *words, *with_joints, *out])
    assert ended.value.code == 2
    error_text = capsys.readouterr().err
    assert said in error_text
    assert error_text.count("\n") == 1
    assert not (tmp_path / "out.lissom").exists()

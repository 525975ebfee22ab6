"""A drawing on layers, from its script to frames, as a person does it in a shell."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from layered import openraster
from messages import says
from PIL import Image, ImageDraw

from app.cli.main import main
from app.document import DEPTH, IK_TARGET, IkTarget, Meshing, is_visible
from app.document.model import PARENT_CIRCLE
from app.errors import LissomError
from app.motion import ParentTransforms
from app.solving import pose_document
from app.solving.script.fields import NOT_A_FRAME, OUT_OF_ORDER
from app.solving.script.pose_script import parse_pose_script
from app.storage import open_layered
from app.storage.json_values import LACKS_FIELD, NOT_LIST, NOT_TRUE_OR_FALSE
from app.storage.project_file import load_project, save_project
from engine.errors import EngineError
from engine.maps import Bounds

pytestmark = pytest.mark.usefixtures("one_context")

WIDTH, HEIGHT = 240, 200
# No test looks at the mesh, nor at which variant leads from key to key.
FEW = ("--triangles", "1000", "--detail", "coarse")
STACK = "".join(
    f'<layer name="{name}" src="data/{index}.png"/>'
    for index, name in enumerate(("patch", "arm", "body", "wall"))
)
SCRIPT = {
    "schema": 1,
    "variant": "nu",
    "layers": [
        {
            "layer": "body",
            "handles": {"foot": [80, 40], "head": {"at": [80, 160], "front": 0.5, "extent": 30}},
            "keys": [
                {"frame": 0},
                {"frame": 8, "targets": {"head": [100, 158]}, "front": {"head": -1}},
            ],
        },
        {
            "layer": "arm",
            "handles": {"hand": [190, 120]},
            "keys": [{"frame": 0}, {"frame": 8, "targets": {"hand": [180, 150]}}],
            "attach": {"to": "body", "at": [95, 120]},
        },
        {
            "layer": "patch",
            "handles": {},
            "keys": [{"frame": 0}],
            "attach": {"to": "arm", "at": [180, 120], "turn": False},
            "visible": [[0, True], [4, False]],
        },
    ],
}


def painted(shape, box, colour):
    image = Image.new("RGBA", (WIDTH, HEIGHT))
    getattr(ImageDraw.Draw(image), shape)(box, fill=colour)
    return image


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scene")
    pictures = [
        painted("ellipse", (170, 70, 192, 92), (250, 250, 0, 255)),
        painted("rectangle", (85, 70, 200, 90), (200, 40, 40, 255)),
        painted("rectangle", (60, 25, 110, 180), (40, 40, 200, 255)),
        painted("rectangle", (0, 0, WIDTH, HEIGHT), (220, 230, 220, 255)),
    ]
    (folder / "man.ora").write_bytes(openraster((WIDTH, HEIGHT), STACK, pictures))
    (folder / "man.json").write_text(json.dumps(SCRIPT))
    return folder


@pytest.fixture(scope="module")
def project(folder):
    out = folder / "man.lissom"
    arguments = [str(folder / "man.ora"), str(folder / "man.json"), "--out", str(out)]
    assert main(["pose", *arguments, *FEW]) == 0
    return out


@pytest.fixture(scope="module")
def drawing(folder):
    """The document of the drawing as it is opened."""
    return open_layered(folder / "man.ora", Meshing(triangles=1000, detail="coarse")).document


def refused(drawing, script):
    """Return what is said where a script cannot be followed."""
    with pytest.raises((LissomError, EngineError)) as refusal:
        pose_document(drawing, parse_pose_script(script), str)
    return str(refusal.value)


def test_a_script_poses_the_layers_that_it_names(project):
    document = load_project(project)
    wall, body, arm, patch = document.layers
    assert [layer.name for layer in document.layers] == ["wall", "body", "arm", "patch"]
    assert (wall.still, body.still) == (True, False)
    assert document.canvas == (WIDTH, HEIGHT)
    assert (arm.attachments[0].parent, arm.attachments[0].parent_point, arm.anchor) == (
        body.id,
        95 + 120j,
        95 + 120j,
    )
    assert [is_visible(document, patch, frame) for frame in (3, 4)] == [True, False]
    head = body.handles[1]
    assert (head.depth, head.extent) == (0.5, 30.0)
    assert body.channels == {(DEPTH.name, head.id): (DEPTH.key(8, -1.0),)}
    # The joint of a joint is closed, and the patch keeps its own turn.
    joints = ParentTransforms(document)
    at = np.array([patch.attachments[0].parent_point])
    arm_place = joints.placement(arm.id, 8).apply(arm.map_of(arm.keys[1].pose)(at))
    own = joints.placement(patch.id, 8)
    assert own.factor == 1
    assert abs(own.apply(patch.map_of(patch.keys[0].pose)(at))[0] - arm_place[0]) < 1e-9 * WIDTH


def test_pose_opens_the_layers_as_one_picture(folder, tmp_path):
    (tmp_path / "one.json").write_text(
        '{"schema": 1, "handles": {"foot": [80, 40]}, "keys": [{"frame": 0}]}'
    )
    out = tmp_path / "one.lissom"
    arguments = [str(folder / "man.ora"), str(tmp_path / "one.json"), "--out", str(out)]
    assert main(["pose", *arguments, "--one-picture", *FEW]) == 0
    (layer,) = load_project(out).layers
    assert layer.picture.size == (WIDTH, HEIGHT)


def test_certify_tells_of_each_layer(project, capsys):
    assert main(["certify", str(project), "--json"]) == 0
    layers = json.loads(capsys.readouterr().out)["layers"]
    assert set(layers) == {"body", "arm", "patch"}
    assert all(block["certified"] for block in layers.values())
    assert main(["certify", str(project), "--details"]) == 0
    overview, *details = capsys.readouterr().out.split("\n\n")
    first, header, *lines, _ = overview.splitlines()
    assert first == (
        "Overall: proven. All 3 layers are proven to keep their limits at every moment."
    )
    assert header.split() == ["k", "sigma_a", "sigma_b"]
    assert [line.split()[0] for line in lines] == ["body", "arm", "patch"]
    for line in lines:
        name, *values, verdict = line.split()
        block, worst = layers[name], (max, max, min)
        parts = [*block["keys"], *block["intervals"], *filter(None, [block["corrected"]])]
        for column, value, extreme in zip(("k", "sigma_a", "sigma_b"), values, worst, strict=True):
            assert float(value) == pytest.approx(extreme(p[column] for p in parts), abs=1e-4)
        assert verdict == "proven"
    assert any(part.startswith("arm\n") for part in details)


def test_certify_names_what_is_over_first(project, capsys, tmp_path):
    document = load_project(project)
    arm = next(layer for layer in document.layers if layer.name == "arm")
    narrow = replace(arm, bounds=Bounds(k=0.01, sigma_a=1.01, sigma_b=0.99))
    save_project(tmp_path / "over.lissom", document.with_layer(narrow))
    assert main(["certify", str(tmp_path / "over.lissom")]) == 1
    first, _, _, line, _, more = capsys.readouterr().out.splitlines()
    assert first == "Overall: OVER. Layers that exceed their limits, or may fold: 1 of 3."
    assert line.split()[0] == "arm"
    assert "OVER at key 8" in line
    assert "--details" in more


def exported(project, name, *options):
    """Return the frames that an export of a project writes."""
    out = project.parent / name
    assert main(["export", str(project), "--out", str(out), "--framing", "canvas", *options]) == 0
    return [np.asarray(Image.open(path)).astype(int) for path in sorted(out.glob("*.png"))]


def test_export_draws_the_scene_or_one_layer_of_it(project):
    (whole,) = exported(project, "whole", "--frames", "2:2")
    assert whole.shape == (HEIGHT, WIDTH, 4)
    assert (whole[..., 3] == 255).all()
    assert abs(whole[5, 5, :3] - (220, 230, 220)).max() <= 2
    # Yellow in front of red in front of blue.
    assert abs(whole[..., :3] - (250, 250, 0)).max(axis=2).min() <= 2
    alone, *_, gone = exported(project, "alone", "--frames", "2:5", "--layer", "patch")
    seen = alone[..., 3] > 128
    assert 200 < seen.sum() < 600
    assert abs(alone[seen][:, :3] - (250, 250, 0)).max() <= 40
    assert not gone[..., 3].any()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"layer": "leg"}, "there is no layer 'leg'; choose from: wall, body, arm, patch"),
        ({"layer": "wall"}, "'wall' cannot be posed"),
        ({"attach": {"to": "leg", "at": [1, 2]}}, "there is no layer 'leg'"),
        ({"attach": {"to": "body", "at": [1, 2]}}, "'body' has no shape there"),
        ({"attach": {"to": "arm", "at": [180, 120]}}, says(PARENT_CIRCLE)),
        (
            {"attach": {"to": "body", "at": [70, 40]}},
            r"layer 'arm': it is attached at \(70, 40\), where only 'body' has a shape",
        ),
        ({"attach": {"to": "body"}}, says(LACKS_FIELD, where="layers[0].attach", name="at")),
        ({"attach": {"at": [1, 2]}}, says(LACKS_FIELD, where="layers[0].attach", name="to")),
        ({"attach": {"to": "wall", "at": [5, 5], "anchor": 1}}, "unknown field 'anchor'"),
        ({"anchor": [5, 5]}, r"layer 'arm': The anchor at \(5, 5\) lies outside"),
        ({"handles": {"hand": [5, 5]}}, "layer 'arm': "),
        (
            {"handles": {"hand": {"at": [190, 120], "front": 2}}},
            "layer 'arm': ",
        ),
        (
            {"handles": {"hand": {"at": [190, 120], "extent": -3}}},
            "layer 'arm': ",
        ),
        (
            {"handles": {"hand": {"front": 1}}},
            says(LACKS_FIELD, where="layers[0].handle 'hand'", name="at"),
        ),
        (
            {"keys": [{"frame": 0, "front": {"foot": 1}}]},
            r"layers\[0\]\.keys\[0\] names the handle 'foot', which does not exist; the handles",
        ),
        (
            {"keys": [{"frame": 0, "front": {"hand": "high"}}]},
            r"layers\[0\]\.keys\[0\]\.front\.hand",
        ),
        (
            {"visible": [[4, True], [2, False]]},
            says(OUT_OF_ORDER, where="layers[0].visible", after=2, before=4),
        ),
        ({"visible": [[4, 1]]}, r"layers\[0\]\.visible\[0\]"),
        ({"visible": True}, r"layers\[0\]\.visible"),
        (
            {"tracks": [{"handle": "thumb", "keys": [{"frame": 0, "offset": [1, 2]}]}]},
            (
                r"layers\[0\]\.tracks\[0\]\.handle names the handle 'thumb', which does not "
                r"exist; the handles are hand"
            ),
        ),
        (
            {"springs": [{"handle": "thumb", "preset": "ear"}]},
            r"layers\[0\]\.springs\[0\]\.handle names the handle 'thumb'",
        ),
        ({"still": "no"}, says(NOT_TRUE_OR_FALSE, where="layers[0].still")),
        (
            {"attach": [{"to": "body", "at": [95, 120]}, {"to": "body", "keep": True}]},
            says(OUT_OF_ORDER, where="layers[0].attach", after=0, before=0),
        ),
        (
            {"attach": [{"frame": -1, "to": None}]},
            r"layers\[0\]\.attach\[0\]\.frame must be a whole",
        ),
        ({"attach": [{"to": None, "at": [1, 2]}]}, "detaches the layer and cannot have at"),
        ({"attach": [{"to": "body"}]}, says(LACKS_FIELD, where="layers[0].attach[0]", name="at")),
        ({"attach": [{"frame": 4, "to": "leg", "keep": True}]}, "there is no layer 'leg'"),
        (
            {"attach": [{"to": "body", "at": [95, 120]}, {"frame": 4, "to": "arm", "keep": True}]},
            "'arm' would be attached to itself at frame 4: 'arm' → 'arm'",
        ),
    ],
)
def test_script_is_refused_when_drawing_lacks_what_it_names(drawing, change, words):
    script = {**SCRIPT, "layers": [{**SCRIPT["layers"][1], **change}]}
    assert re.search(words, refused(drawing, script))


def test_pose_writes_nothing_when_the_script_is_refused(folder, capsys):
    script = {**SCRIPT, "layers": [{**SCRIPT["layers"][1], "layer": "leg"}]}
    path, out = folder / "bad.json", folder / "bad.lissom"
    path.write_text(json.dumps(script))
    with pytest.raises(SystemExit) as leaving:
        main(["pose", str(folder / "man.ora"), str(path), "--out", str(out), *FEW])
    assert leaving.value.code == 2
    assert "there is no layer 'leg'; choose from: wall, body, arm, patch" in (
        capsys.readouterr().err
    )
    assert not out.exists()


def test_refusal_names_layer_when_script_is_of_one_layer(drawing):
    script = {"schema": 1, "handles": {"foot": [80, 40]}, "keys": [{"frame": 0}]}
    notice = refused(drawing, script)
    assert "The handle 'foot' at (80, 40) lies outside" in notice
    assert "on the front layer 'patch'" in notice
    assert "also has 'wall', 'body', 'arm'" in notice
    assert '"layers": [{"layer": "patch", ...}]' in notice
    # What is wrong with it on any layer says nothing of others.
    on_it = {**script, "handles": {"spot": {"at": [180, 120], "front": 3}}}
    assert "layers" not in refused(drawing, on_it)


def test_layer_attached_by_another_anchor_comes_to_its_parent(drawing):
    """Its targets are those without the parent."""
    body, arm, _ = SCRIPT["layers"]
    elsewhere = {**arm, "anchor": [190, 120], "handles": {"hand": [100, 120]}}
    keys = [{"frame": 0}, {"frame": 8, "targets": {"hand": [104, 132]}}]
    script = {**SCRIPT, "layers": [body, {**elsewhere, "keys": keys}]}
    document, _ = pose_document(drawing, parse_pose_script(script), str)
    layers = {layer.name: layer for layer in document.layers}
    arm, body, joints = layers["arm"], layers["body"], ParentTransforms(document)
    assert arm.keys[1].pose.targets[0].position == 104 + 132j
    for frame, index in ((0, 0), (8, 1)):
        f, g = (each.map_of(each.keys[index].pose) for each in (arm, body))
        at = np.array([95 + 120j])
        own = joints.placement(arm.id, frame)
        here = own.apply(f(np.array([190 + 120j])))[0]
        assert abs(here - g(at)[0]) < 1e-9 * WIDTH
        fz = g.derivatives(at)[0][0]
        assert abs(own.factor - fz / abs(fz)) < 1e-12


def test_a_short_colour_is_one(project):
    options = ("--frames", "5:5", "--background", "#fA0", "--layer", "patch")
    (short,) = exported(project, "short", *options)
    assert (short.reshape(-1, short.shape[-1])[:, :3] == (255, 170, 0)).all()


def test_a_layer_that_is_not_there_is_reported(project, folder, capsys):
    arguments = ["export", str(project), "--out", str(folder / "no"), "--layer", "leg"]
    with pytest.raises(SystemExit):
        main(arguments)
    assert "choose from: wall, body, arm, patch" in capsys.readouterr().err


def test_what_changes_hands_does_not_jump(folder, capsys):
    patch = {
        **SCRIPT["layers"][2],
        "visible": [],
        "attach": [
            {"to": "arm", "at": [180, 120]},
            {"frame": 3, "to": "body", "keep": True},
            {"frame": 6, "to": None, "keep": True},
            {"frame": 30, "to": "arm", "at": [180, 120], "keep": True},
        ],
    }
    script = {**SCRIPT, "layers": [*SCRIPT["layers"][:2], patch]}
    (folder / "hands.json").write_text(json.dumps(script))
    out = folder / "hands.lissom"
    arguments = [str(folder / "man.ora"), str(folder / "hands.json"), "--out", str(out)]
    assert main(["pose", *arguments, *FEW]) == 0
    notice = " ".join(capsys.readouterr().err.split())
    assert "the parent of patch from frame 30 on has no effect: the animation ends" in notice
    document = load_project(out)
    patch, body = (next(f for f in document.layers if f.name == n) for n in ("patch", "body"))
    assert [joint.frame for joint in patch.attachments] == [0, 3, 6, 30]
    assert patch.attachments[1].parent == body.id
    joints = ParentTransforms(document)
    for frame in (3, 6):
        just, now = (joints.placement(patch.id, at) for at in (frame - 1e-6, frame))
        assert abs(just.shift - now.shift) < 1e-3
        assert abs(just.factor - now.factor) < 1e-5
    assert joints.placement(patch.id, 8) == joints.placement(patch.id, 6)
    # The nearest point of the body when it is handed over, not as it was drawn.
    as_drawn = body.domain.nearest(np.array([patch.attachments[0].parent_point]))[0]
    assert patch.attachments[1].parent_point.real > 105
    assert abs(patch.attachments[1].parent_point - as_drawn) > 1


def test_layer_changes_its_parent_in_every_repeat_of_a_cycle(drawing):
    cycles = [{"from": 0, "to": 12}]
    body, arm, patch = SCRIPT["layers"]
    joints = [
        {"to": "arm", "at": [180, 120]},
        {"frame": 3, "to": "body", "keep": True},
        {"frame": 9, "to": "arm", "at": [180, 120], "keep": True},
    ]
    common = {"cycles": cycles, "still": False}
    patch = {**patch, **common, "visible": [], "attach": joints}
    layers = [{**body, **common}, {**arm, **common}, patch]
    frames = {
        "fps": 24,
        "camera": {"keys": [{"frame": frame, "centre": [120, 100]} for frame in (0, 40)]},
    }

    def posed(patch):
        script = {**SCRIPT, "layers": [*layers[:2], patch], **frames}
        document, notices = pose_document(drawing, parse_pose_script(script), str)
        return document, " ".join(notices)

    document, notice = posed(patch)
    assert "repeat" not in notice
    identity = next(each.id for each in document.layers if each.name == "patch")
    names = [
        [each.name for each in document.parent_chain(identity, frame)[1:2]]
        for frame in (1, 4, 16, 22)
    ]
    assert names == [["arm"], ["body"], ["body"], ["arm"]]
    placed = ParentTransforms(document).placement
    for frame in (2, 5, 10.5):
        one, other = placed(identity, frame), placed(identity, frame + 24)
        assert abs(one.shift - other.shift) < 1e-6
    for frame in (12, 15, 21, 24, 27, 36):
        assert abs(placed(identity, frame - 1e-6).shift - placed(identity, frame).shift) < 1e-3
    # Given away at the end, it does not come round, and a notice says so.
    away = {"to": "body", "at": [95, 120], "keep": True}
    joints[1:] = [{**away, "frame": 3}, {**away, "frame": 12}]
    _, notice = posed({**patch, "attach": joints})
    assert "its attachments do not repeat with frames 0 to 12" in notice


MOUTHS = "".join(
    f'<layer name="{name}" src="data/{index}.png" visibility="{visibility}"/>'
    for index, (name, visibility) in enumerate(
        (("oh", "hidden"), ("ah", "hidden"), ("closed", "visible"), ("head", "visible"))
    )
)


@pytest.fixture(scope="module")
def face(tmp_path_factory):
    """A drawing of a head with three mouths, of which two are hidden."""
    pictures = [
        painted("ellipse", (100, 100, 140, 140), (250, 250, 0, 255)),
        painted("ellipse", (100, 100, 140, 140), (0, 250, 0, 255)),
        painted("ellipse", (100, 110, 140, 130), (250, 0, 0, 255)),
        painted("ellipse", (40, 20, 200, 180), (40, 40, 200, 255)),
    ]
    path = tmp_path_factory.mktemp("face") / "face.ora"
    path.write_bytes(openraster((WIDTH, HEIGHT), MOUTHS, pictures))
    return path


@pytest.fixture(scope="module")
def opened(face):
    """The document of the head as it is opened."""
    return open_layered(face, Meshing(triangles=1000, detail="coarse")).document


def face_script(**stage):
    head = {"layer": "head", "handles": {}, "keys": [{"frame": 0}, {"frame": 12}]}
    return {"schema": 1, "variant": "nu", "layers": [head], **stage}


def posed_face(opened, **stage):
    """Return the head posed by a script, and its notices."""
    document, notices = pose_document(opened, parse_pose_script(face_script(**stage)), str)
    return document, " ".join(notices)


def saved_face(face, folder, **stage):
    """Return the project that the command makes of the head by a script."""
    script, out = folder / "face.json", folder / "face.lissom"
    script.write_text(json.dumps(face_script(**stage)))
    assert main(["pose", str(face), str(script), "--out", str(out), *FEW]) == 0
    return out


def mouths(frames):
    """The colours of the mouth in frames."""
    return [frame[HEIGHT - 80, 120, :3].tolist() for frame in frames]


CHOICE = {
    "name": "mouth",
    "layers": ["closed", "ah", "oh"],
    "keys": [[0, "closed"], [4, "ah"], [8, "oh"], [10, "closed"]],
}


def test_choice_shows_one_layer_when_the_drawing_hides_it(face, tmp_path, capsys):
    out = saved_face(face, tmp_path, choices=[CHOICE])
    assert "never visible" not in capsys.readouterr().err
    document = load_project(out)
    for number, name in ((0, "closed"), (3, "closed"), (4, "ah"), (8, "oh"), (12, "closed")):
        assert [f.name for f in document.layers if is_visible(document, f, number)] == [
            "head",
            name,
        ]
    closed, ah, oh = [250, 0, 0], [0, 250, 0], [250, 250, 0]
    frames = exported(out, "frames", "--frames", "2:8")
    assert mouths(frames) == [closed, closed, ah, ah, ah, ah, oh]
    # One layer of it alone is seen when it is chosen.
    alone = exported(out, "ah", "--layer", "ah", "--frames", "5:9")
    assert [bool(frame[..., 3].any()) for frame in alone] == [True, True, True, False, False]


def test_choice_repeats_with_a_cycle_of_all_its_layers(opened):
    cycles, still = [{"from": 0, "to": 12}], {"handles": {}, "keys": [{"frame": 0}]}
    head = {"layer": "head", "handles": {}, "keys": [{"frame": 0}, {"frame": 30}]}
    mouths = [{"layer": name, **still, "cycles": cycles} for name in CHOICE["layers"]]
    document, notice = posed_face(opened, layers=[head, *mouths], choices=[CHOICE])
    assert "repeat" not in notice
    names = [
        next(each.name for each in document.layers[1:] if is_visible(document, each, frame))
        for frame in (1, 5, 9, 11, 13, 17, 21, 23, 25, 29)
    ]
    assert names == [*["closed", "ah", "oh", "closed"] * 2, "closed", "ah"]
    _, notice = posed_face(opened, layers=[head, *mouths[1:]], choices=[CHOICE])
    assert (
        "its keys do not repeat, because frames 0 to 12 do not repeat in closed. Give all its "
        "layers" in notice
    )


def test_script_shows_what_the_drawing_hides(face, tmp_path, capsys):
    oh = {"layer": "oh", "handles": {}, "keys": [{"frame": 0}, {"frame": 12}]}
    out = saved_face(face, tmp_path, layers=[{**oh, "visible": [[0, False], [6, True]]}])
    assert "never visible" not in capsys.readouterr().err
    frames = exported(out, "frames", "--frames", "5:6")
    assert mouths(frames) == [[250, 0, 0], [250, 250, 0]]


@pytest.mark.parametrize(
    ("visible", "words"),
    [
        (
            {},
            ('oh is hidden in the drawing and never visible; show it with "visible": [[0, true]]'),
        ),
        ({"visible": [[0, False]]}, 'oh is never visible: its "visible" shows it at no frame'),
        (
            {"visible": [[0, False], [40, True]]},
            "oh is never visible: it is shown from frame 40 on, but the animation ends at frame 12",
        ),
    ],
)
def test_layer_is_named_when_it_is_never_seen(opened, visible, words):
    oh = {"layer": "oh", "handles": {}, "keys": [{"frame": 0}, {"frame": 12}], **visible}
    assert words in posed_face(opened, layers=[oh])[1]


def test_layer_is_named_when_its_choice_never_shows_it(opened):
    oh = {"layer": "oh", "handles": {}, "keys": [{"frame": 0}, {"frame": 12}]}
    never = {**CHOICE, "keys": [[0, "closed"], [4, "ah"]]}
    _, notice = posed_face(opened, layers=[oh], choices=[never])
    assert "oh is never visible: the switch 'mouth' never shows it" in notice


def test_script_shows_layers_of_hidden_groups_and_no_others(tmp_path):
    stack = (
        '<stack name="extras" visibility="hidden"><layer name="hat" src="data/0.png"/>'
        '<stack name="inner"><layer name="star" src="data/0.png"/>'
        '<layer name="moon" src="data/0.png"/></stack></stack>'
        '<layer name="body" src="data/2.png"/>'
    )
    pictures = [painted("ellipse", (60, 25, 110, 180), (40, 40, 200, 255))] * 3
    (tmp_path / "a.ora").write_bytes(openraster((WIDTH, HEIGHT), stack, pictures))
    still = {"handles": {}, "keys": [{"frame": 0}, {"frame": 12}]}

    drawing = open_layered(tmp_path / "a.ora", Meshing(triangles=1000, detail="coarse")).document

    def seen(**stage):
        script = {"schema": 1, "layers": [{"layer": "body", **still}], **stage}
        document, notices = pose_document(drawing, parse_pose_script(script), str)
        assert "never visible" not in " ".join(notices)
        return [
            {f.name for f in document.layers if is_visible(document, f, number)}
            for number in (3, 9)
        ]

    star = {"layer": "star", **still, "visible": [[0, False], [6, True]]}
    assert seen(layers=[star]) == [{"body"}, {"body", "star"}]
    turns = {"name": "sky", "layers": ["star", "moon"], "keys": [[0, "star"], [6, "moon"]]}
    assert seen(choices=[turns]) == [{"body", "star"}, {"body", "moon"}]


def test_script_that_names_no_layer_takes_the_front_visible_one(opened):
    script = {"schema": 1, "handles": {"chin": [45, 100]}, "keys": [{"frame": 0}]}
    assert "its handles are on the front layer 'closed'" in refused(opened, script)


def test_choice_is_named_when_its_key_is_after_the_end(opened):
    late = {**CHOICE, "keys": [[0, "closed"], [99, "ah"]]}
    _, notice = posed_face(opened, choices=[late])
    assert "switch 'mouth': ah from frame 99 on has no effect: the animation ends" in notice


@pytest.mark.parametrize(
    ("stage", "words"),
    [
        ([{**CHOICE, "layers": ["closed", "eh"], "keys": []}], "'mouth': there is no layer 'eh'"),
        (
            [{**CHOICE, "layers": ["closed"], "keys": []}],
            r"choices\[0\]\.layers must list at least two layers",
        ),
        (
            [{**CHOICE, "layers": ["ah", "ah"], "keys": []}],
            r"choices\[0\]\.layers lists 'ah' twice",
        ),
        (
            [{**CHOICE, "keys": [[0, "head"]]}],
            r"choices\[0\]\.keys\[0\] shows 'head', which is not",
        ),
        (
            [{**CHOICE, "keys": [[4, "ah"], [2, "oh"]]}],
            says(OUT_OF_ORDER, where="choices[0].keys", after=2, before=4),
        ),
        ([{**CHOICE, "keys": [4]}], says(NOT_LIST, where="choices[0].keys[0]")),
        ([CHOICE, {**CHOICE, "name": "lips"}], "the layer 'closed' is in two switches"),
        ([CHOICE, {**CHOICE, "layers": ["head", "eh"], "keys": []}], "two switches have the name"),
        ([{"layers": ["ah", "oh"]}], says(LACKS_FIELD, where="choices[0]", name="name")),
        ([{**CHOICE, "shown": 1}], "unknown field 'shown'; it may have name, layers, keys"),
        ([{**CHOICE, "name": " "}], r"choices\[0\]\.name is empty; give the switch a name"),
        (
            [{**CHOICE, "keys": [[-4, "ah"]]}],
            says(NOT_A_FRAME, where="choices[0].keys[0]", name="frame"),
        ),
        ({"mouth": []}, says(NOT_LIST, where="choices")),
    ],
)
def test_choice_is_refused_when_it_cannot_be(opened, stage, words):
    assert re.search(words, refused(opened, face_script(choices=stage)))


def test_layer_of_a_choice_is_refused_when_it_has_visible(opened):
    oh = {"layer": "oh", "handles": {}, "keys": [{"frame": 0}], "visible": [[0, True]]}
    notice = refused(opened, face_script(layers=[oh], choices=[CHOICE]))
    assert "the layer 'oh' is in a switch, which alone decides" in notice


STAGED = {
    "schema": 1,
    "variant": "nu",
    "canvas": [120, 100],
    "camera": {"keys": [{"frame": 0, "centre": [120, 100]}, {"frame": 8, "centre": [85, 100]}]},
    "layers": [
        {
            "layer": "body",
            "handles": {},
            "keys": [{"frame": 0}],
            "order": [[4, {"in_front_of": "arm"}], [8, None]],
        },
        {"layer": "arm", "handles": {}, "keys": [{"frame": 0}], "opacity": [[0, 1], [8, 0]]},
        {
            "layer": "wall",
            "handles": {},
            "keys": [{"frame": 0}],
            "movement": {"keys": [{"frame": 0}, {"frame": 8, "shift": [500, 0]}]},
        },
    ],
}


def test_a_camera_a_fade_an_order_and_a_still_layer_that_moves_are_exported(folder, capsys):
    script, out, frames = folder / "staged.json", folder / "staged.lissom", folder / "staged"
    script.write_text(json.dumps(STAGED))
    assert main(["pose", str(folder / "man.ora"), str(script), "--out", str(out), *FEW]) == 0
    assert main(["export", str(out), "--out", str(frames), "--format", "png"]) == 0
    first, middle, last = (
        np.asarray(Image.open(frames / f"frame_{frame:04}.png")) for frame in (0, 4, 8)
    )
    assert first.shape == last.shape == (100, 120, 4)
    # At (100, 120) the arm crosses the body.
    assert first[30, 40].tolist() == [200, 40, 40, 255]
    assert middle[30, 57].tolist() == [40, 40, 200, 255]
    assert last[30, 75].tolist() == [40, 40, 200, 255]
    assert first[5, 100].tolist() == [220, 230, 220, 255]
    assert last[5, 100].tolist() == [0, 0, 0, 0]
    capsys.readouterr()
    assert main(["export", str(out), "--out", str(folder / "staged.glb")]) == 0
    notice = capsys.readouterr().err
    assert "does not animate Draw order of 'body', Opacity of 'arm', the camera" in notice


LIMB = {
    "schema": 1,
    "bones": [{"layers": ["body", "arm"], "side": 1}],
    "layers": [
        SCRIPT["layers"][0],
        {
            **SCRIPT["layers"][1],
            "channels": {"ik_target": [{"frame": 0, "place": [60, 60], "turn": 90, "mix": 1}]},
        },
    ],
}


def test_script_names_layers_that_bend_as_a_limb(drawing):
    document, notices = pose_document(drawing, parse_pose_script(LIMB), str)
    arm = next(layer for layer in document.layers if layer.name == "arm")
    assert (arm.ik_parents, arm.pole_side) == (1, 1)
    (key,) = arm.keys_of(IK_TARGET)
    assert key.value == IkTarget(60 + 60j, math.pi / 2)
    assert any("px from its IK target, beyond the reach of its bones" in each for each in notices)


@pytest.mark.parametrize(
    ("bones", "message"),
    [
        ([["arm", "body"]], "'body' is not attached to 'arm'"),
        ([["arm"]], "at least two different layers"),
        ([["body", "leg"]], "the script has no layer 'leg'"),
        ([["body", "arm"], ["body", "arm"]], "two rows of bones end at 'arm'"),
        ([["body", "arm"], ["body", "patch"]], "'body' is in two rows of bones"),
        ([{"layers": ["body", "arm"], "side": 3}], "must be -1, 0 or 1, not 3"),
    ],
)
def test_wrong_limbs_of_layers_are_refused_by_name(drawing, bones, message):
    script = {**LIMB, "layers": [*LIMB["layers"], SCRIPT["layers"][2]], "bones": bones}
    with pytest.raises(LissomError, match=message):
        pose_document(drawing, parse_pose_script(script), str)


def test_what_fades_in_is_seen_in_a_model(folder):
    script, out, model = (folder / f"fading{suffix}" for suffix in (".json", ".lissom", ".glb"))
    arm = {**STAGED["layers"][1], "opacity": [[0, 0], [8, 0.75]]}
    script.write_text(json.dumps({**STAGED, "layers": [arm]}))
    assert main(["pose", str(folder / "man.ora"), str(script), "--out", str(out), *FEW]) == 0
    assert main(["export", str(out), "--out", str(model)]) == 0
    assert b'"baseColorFactor":[1.0,1.0,1.0,0.75]' in model.read_bytes()


def test_still_layer_is_refused_when_it_has_handles(drawing):
    wall = {**STAGED["layers"][2], "handles": {"h": [20, 20]}}
    assert "because it contains no shape" in refused(drawing, {**STAGED, "layers": [wall]})


def test_order_is_refused_beside_a_layer_that_is_not_there(drawing):
    body = {**STAGED["layers"][0], "order": [[4, {"behind": "hat"}]]}
    notice = refused(drawing, {**STAGED, "layers": [body]})
    assert "layer 'body': Draw order: there is no layer 'hat'" in notice


def test_nothing_is_said_of_the_shapes_of_layers_that_bend_as_one(tmp_path, capsys):
    """Their group has a mesh of its own; the gap in one of them is filled by the other one."""
    dots = painted("ellipse", (20, 60, 80, 120), (0, 0, 0, 255))
    ImageDraw.Draw(dots).ellipse((150, 60, 210, 120), fill=(0, 0, 0, 255))
    pictures = [dots, painted("rectangle", (15, 50, 220, 130), (250, 250, 0, 255))]
    stack = "".join(
        f'<layer name="{name}" src="data/{index}.png"/>'
        for index, name in enumerate(("dots", "bar"))
    )
    drawing = tmp_path / "bar.ora"
    drawing.write_bytes(openraster((WIDTH, HEIGHT), stack, pictures))
    keys = {"handles": {"end": [200, 110]}, "keys": [{"frame": 0}]}
    for layers, count in (({"layer": "dots"}, 1), ({"layers": ["dots", "bar"]}, 0)):
        script = tmp_path / "bar.json"
        script.write_text(json.dumps({"schema": 1, "layers": [{**layers, **keys}]}))
        out = tmp_path / "bar.lissom"
        assert main(["pose", str(drawing), str(script), "--out", str(out), *FEW]) == 0
        assert capsys.readouterr().err.count("2 parts joined by invisible bridges") == count
        assert len(load_project(out).import_log.notes) == count

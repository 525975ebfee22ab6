import copy
import json
import re

import numpy as np
import pytest
from animations import still_document

from app.document.timing import PRESETS
from app.errors import LissomError
from app.solving import pose_document
from app.solving.script import ScriptHandle, ScriptJoint, load_pose_script, parse_pose_script
from engine.maps.bounds import Bounds

WHOLE = {
    "schema": 1,
    "fps": 12.5,
    "loop": True,
    "variant": "scaled-eta",
    "bounds": {"k": 0.7, "sigma_a": 4, "sigma_b": 0.25},
    "anchor": [10, 20.5],
    "handles": {"nose": [1, 2], "hoof": [3, 4]},
    "keys": [
        {"frame": 0},
        {"frame": 24, "targets": {"nose": [5, 6]}, "ease": "in-out"},
        {"frame": 30, "targets": {}, "ease": [0.1, 0.2, 0.3, 0.4]},
    ],
}


def changed(path, value):
    """Return the whole script with the entry at `path` replaced, or removed for None."""
    script = copy.deepcopy(WHOLE)
    *way, last = path
    place = script
    for step in way:
        place = place[step]
    if value is None:
        del place[last]
    else:
        place[last] = value
    return script


def test_a_whole_script_is_read(tmp_path):
    path = tmp_path / "wave.json"
    path.write_text(json.dumps(WHOLE), encoding="utf-8-sig")
    script = load_pose_script(path)
    assert (script.fps, script.loop) == (12.5, True)
    (script,) = script.figures
    assert (script.layer, script.variant) == (None, "scaled-eta")
    assert script.bounds == Bounds(k=0.7, sigma_a=4.0, sigma_b=0.25)
    assert script.anchor == 10 + 20.5j
    assert script.handles == {"nose": ScriptHandle(at=1 + 2j), "hoof": ScriptHandle(at=3 + 4j)}
    assert [key.frame for key in script.keys] == [0, 24, 30]
    assert script.keys[1].targets == {"nose": 5 + 6j}
    assert script.keys[1].ease == PRESETS["in-out"]
    assert script.keys[2].ease.curve == (0.1, 0.2, 0.3, 0.4)


def test_what_is_left_out_has_its_documented_default():
    script = parse_pose_script({"schema": 1, "handles": {}, "keys": [{"frame": 3}]})
    assert (script.fps, script.loop) == (24.0, False)
    (script,) = script.figures
    assert (script.variant, script.attach, script.visible) == ("metric", None, ())
    assert script.bounds == Bounds(k=0.5, sigma_a=2.0, sigma_b=0.5)
    assert script.anchor is None
    assert script.keys[0].ease == PRESETS["linear"]


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (["schema"], 2, "schema must be 1, not 2"),
        (["schema"], True, "schema must be 1"),
        (["schema"], None, "schema must be 1, not null"),
        (["handles"], None, "the script lacks the field 'handles'"),
        (["keys"], None, "the script lacks the field 'keys'"),
        (["keys"], [], "at least one key"),
        (["colour"], "red", "unknown field 'colour'"),
        (["fps"], "fast", "fps must be a number"),
        (["fps"], float("inf"), "fps must be finite"),
        (["loop"], 1, "loop must be true or false"),
        (["variant"], "cubic", "variant must be one of metric, nu"),
        (["variant"], ["nu"], "variant must be one of"),
        (["bounds", "k"], 1.5, "bound on k"),
        (["bounds", "tau"], 1.5, "unknown field 'tau'"),
        (["anchor"], [1], r"anchor must be a point \[x, y\]"),
        (["handles", "nose"], [1, "2"], r"handle 'nose'\[1\] must be a number"),
        (["handles"], [[1, 2]], "handles must be an object"),
        (["keys", 0, "frame"], None, r"keys\[0\].frame must be a whole number"),
        (["keys", 0, "frame"], 1.5, "whole number"),
        (["keys", 0, "frame"], -1, "whole number"),
        (["keys", 1, "frame"], 0, "out of order: frame 0 after 0"),
        (["keys", 1, "frame"], 31, "out of order: frame 30 after 31"),
        (["keys", 1, "targets", "tail"], [1, 2], "names the handle 'tail'"),
        (["keys", 1, "target"], {}, "unknown field 'target'"),
        (["keys", 1, "pull"], "hard", r"keys\[1\].pull"),
        (["keys", 1, "pull"], 0, r"keys\[1\].pull must be positive, not 0"),
        (["keys", 1, "pull"], 10**400, r"keys\[1\].pull"),
        (["keys", 1, "ease"], "bouncy", "no easing 'bouncy'"),
        (["keys", 1, "ease"], [0, 0, 2, 1], "four numbers from 0 to 1"),
        (["keys", 1, "ease"], [10**400, 0, 1, 1], "four numbers from 0 to 1"),
        (["keys", 1, "ease"], [float("nan"), 0, 1, 1], "four numbers from 0 to 1"),
        (["keys", 1, "ease"], {"x": 1}, "a name or four numbers from 0 to 1"),
        (["keys", 1, "frame"], 10**400, "a whole number from 0 to"),
        (["keys", 1, "targets", "nose"], [10**400, 0], "must be finite"),
    ],
)
def test_whatever_a_script_cannot_say_is_refused(path, value, message):
    with pytest.raises(ValueError if "bound on" in message else LissomError, match=message):
        parse_pose_script(changed(path, value))


ARM = {
    "layer": "arm",
    "handles": {"hand": {"at": [7, 8], "front": 0.5, "extent": 60}, "elbow": [5, 6]},
    "keys": [{"frame": 0}, {"frame": 9, "front": {"hand": -1}}],
    "attach": {"to": "body", "at": [3, 4], "turn": False},
    "visible": [[0, True], [12, False]],
    "variant": "nu",
}
BODY = {"layer": "body", "handles": {}, "keys": [{"frame": 0}]}
SCENE = {"schema": 1, "fps": 8, "bounds": {"k": 0.7}, "figures": [BODY, ARM]}


def test_a_script_of_several_figures():
    script = parse_pose_script(SCENE)
    body, arm = script.figures
    assert (script.fps, body.layer, arm.layer) == (8, "body", "arm")
    # What the scene says holds for all figures that say nothing else.
    assert (body.variant, arm.variant) == ("metric", "nu")
    assert body.bounds == arm.bounds == Bounds(k=0.7, sigma_a=2.0, sigma_b=0.5)
    assert arm.handles["hand"] == ScriptHandle(at=7 + 8j, front=0.5, extent=60.0)
    assert arm.keys[1].fronts == {"hand": -1.0}
    assert arm.attach == ScriptJoint(to="body", at=3 + 4j, turns=False)
    assert arm.visible == ((0, True), (12, False))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"layer": 5}, r"figures\[0\].layer must be a text"),
        ({"colour": 1}, r"figures\[0\] has an unknown field 'colour'"),
        ({"keys": []}, r"figures\[0\].keys must be a list of at least one"),
        ({"keys": [{"frame": 0, "front": {"toe": 1}}]}, r"keys\[0\] names the handle 'toe'"),
        ({"handles": {"hand": {"front": 1}}}, "lacks the field 'at'"),
        ({"handles": {"hand": {"at": [1, 2], "depth": 1}}}, "unknown field 'depth'"),
        ({"attach": {"to": "body"}}, "lacks the field 'at'"),
        ({"visible": [[0]]}, "a frame and true or false"),
        ({"visible": [[0.5, True]]}, "whole number"),
    ],
)
def test_whatever_a_figure_cannot_say_is_refused(change, message):
    with pytest.raises(LissomError, match=message):
        parse_pose_script({**SCENE, "figures": [{**ARM, **change}]})


def test_figures_have_layers_of_their_own():
    with pytest.raises(LissomError, match="two figures are of the layer 'arm'"):
        parse_pose_script({**SCENE, "figures": [ARM, ARM]})
    with pytest.raises(LissomError, match="at least one figure"):
        parse_pose_script({**SCENE, "figures": []})
    with pytest.raises(LissomError, match="unknown field 'handles'"):
        parse_pose_script({**SCENE, "handles": {}})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "is not JSON: .* in line 1"),
        ("[]", "the script must be an object"),
        ('{"schema": 1, "schema": 1}', "'schema' is given twice"),
        ("[" * 100_000, "nested too deeply"),
    ],
)
def test_bad_files_are_refused_with_their_name(tmp_path, text, message):
    path = tmp_path / "script.json"
    path.write_text(text)
    with pytest.raises(LissomError, match=message) as refused:
        load_pose_script(path)
    assert "script.json" in str(refused.value)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(LissomError, match="UTF-8"):
        load_pose_script(path)
    with pytest.raises(LissomError, match="No such file"):
        load_pose_script(tmp_path / "missing.json")


def test_a_key_on_request_pulls_with_bounded_force():
    picture = np.zeros((80, 240, 4), np.uint8)
    picture[20:60, 20:220] = 255
    document = still_document(picture)
    handles = {"end": [210, 40], "middle": [120, 40], "start": [30, 40]}
    posed = {}
    for pull in ({}, {"pull": 10}):
        far = {"frame": 8, "targets": {"end": [500, 60]}, **pull}
        after = {"frame": 16, "targets": {"start": [32, 44]}}
        script = {"schema": 1, "handles": handles, "keys": [{"frame": 0}, far, after]}
        script["bounds"] = {"k": 0.5, "sigma_a": 2, "sigma_b": 0.5}
        told, notices = pose_document(document, parse_pose_script(script), lambda _: None)
        posed[bool(pull)] = told.figures[0], notices
    (held, _), (pulled, notices) = posed[False], posed[True]
    for figure, far in ((held, True), (pulled, False)):
        for key in figure.keys[1:]:
            assert (abs(figure.lags(key.pose)[1]) > 5) == far
    # It is told how far short it is, and it is wanted where it came to.
    assert len(notices) == 1
    assert re.fullmatch(r"frame 8: 'end' is \d+\.\d px short .* by the limits", notices[0])
    wanted = pulled.keys[1].pose.targets[0].position
    assert wanted.real < 450
    assert pulled.lags(pulled.keys[1].pose)[0] < 1
    assert pulled.keys[2].pose.targets[0].position == wanted

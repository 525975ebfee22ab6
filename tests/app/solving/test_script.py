import copy
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from animations import bar_document, bar_picture, still_document
from messages import says

from app.document.channels.cycles import Cycle
from app.document.channels.easing import HOLD, LINEAR, PRESETS
from app.document.channels.kind import Quantity
from app.document.channels.kinds import (
    CAMERA as CAMERA_KIND,
    DEPTH,
    LAYER_KINDS,
    OPACITY,
    TRANSFORM,
    VISIBILITY,
)
from app.document.channels.springs import Spring
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import Track, TrackKey
from app.document.channels.values import Camera, Transform
from app.errors import LissomError
from app.solving import pose_document
from app.solving.script.channels import NO_PAIR, TWICE
from app.solving.script.fields import NO_KEYS, NOT_A_FRAME, OUT_OF_ORDER
from app.solving.script.layers import ScriptAttachment
from app.solving.script.pose_script import (
    NO_VARIANT,
    WRONG_SCHEMA,
    ScriptHandle,
    load_pose_script,
    parse_pose_script,
)
from app.solving.script.tracks import HANDLE_OR_HANDLES, NEEDLESS_VELOCITY, NO_BASIS, NO_PRESET
from app.storage.json_values import (
    LACKS_FIELD,
    NOT_FINITE,
    NOT_JSON,
    NOT_LIST,
    NOT_NUMBER,
    NOT_OBJECT,
    NOT_POINT,
    NOT_TEXT,
    NOT_TRUE_OR_FALSE,
    NOT_WHOLE,
    TOO_NESTED,
)
from engine.maps.bounds import IMPOSSIBLE_BOUND, Bounds

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
        {"frame": 30, "targets": {}, "turn": {"nose": 90}, "ease": [0.1, 0.2, 0.3, 0.4]},
    ],
}


def changed(path, value, script=WHOLE):
    """Return a script with the entry at `path` replaced, or removed for None."""
    script = copy.deepcopy(script)
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
    (script,) = script.layers
    assert (script.layer, script.variant) == (None, "scaled-eta")
    assert script.bounds == Bounds(k=0.7, sigma_a=4.0, sigma_b=0.25)
    assert script.anchor == 10 + 20.5j
    assert script.handles == {"nose": ScriptHandle(at=1 + 2j), "hoof": ScriptHandle(at=3 + 4j)}
    assert [key.frame for key in script.keys] == [0, 24, 30]
    assert script.keys[1].targets == {"nose": 5 + 6j}
    assert script.keys[1].ease == PRESETS["in-out"]
    assert script.keys[2].turns == {"nose": np.pi / 2}
    assert script.keys[2].ease.curve == (0.1, 0.2, 0.3, 0.4)


def test_what_is_left_out_has_its_documented_default():
    script = parse_pose_script({"schema": 1, "handles": {}, "keys": [{"frame": 3}]})
    assert (script.fps, script.loop) == (24.0, False)
    (script,) = script.layers
    assert (script.variant, script.attach, script.channels) == ("metric", (), {})
    assert script.bounds == Bounds(k=0.5, sigma_a=2.0, sigma_b=0.5)
    assert script.anchor is None
    assert script.keys[0].ease == PRESETS["linear"]


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (["schema"], 2, says(WRONG_SCHEMA, own=1, content=2)),
        (["schema"], True, says(WRONG_SCHEMA, own=1)),
        (["schema"], None, says(LACKS_FIELD, where="the script", name="schema")),
        (["handles"], None, says(LACKS_FIELD, where="the script", name="handles")),
        (["keys"], None, says(LACKS_FIELD, where="the script", name="keys")),
        (["keys"], [], "at least one key"),
        (["colour"], "red", "unknown field 'colour'"),
        (["fps"], "fast", says(NOT_NUMBER, where="fps")),
        (["fps"], float("inf"), says(NOT_FINITE, where="fps")),
        (["loop"], 1, says(NOT_TRUE_OR_FALSE, where="loop")),
        (["variant"], "cubic", says(NO_VARIANT, where="", content='"cubic"')),
        (["variant"], ["nu"], says(NO_VARIANT)),
        (["bounds", "k"], 1.5, says(IMPOSSIBLE_BOUND, name="k")),
        (["bounds", "tau"], 1.5, "unknown field 'tau'"),
        (["anchor"], [1], says(NOT_POINT, where="anchor")),
        (["handles", "nose"], [1, "2"], says(NOT_NUMBER, where="handle 'nose'[1]")),
        (["handles"], [[1, 2]], says(NOT_OBJECT, where="handles")),
        (["keys", 0, "frame"], None, says(NOT_A_FRAME, where="keys[0]", name="frame")),
        (["keys", 0, "frame"], 1.5, "whole number"),
        (["keys", 0, "frame"], -1, "whole number"),
        (["keys", 1, "frame"], 0, says(OUT_OF_ORDER, after=0, before=0)),
        (["keys", 1, "frame"], 31, says(OUT_OF_ORDER, after=30, before=31)),
        (["keys", 2, "turn", "hoof"], "far", r"keys\[2\].turn.hoof must be a number"),
        (["keys", 2, "turn", "ear"], 5, "ear"),
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
        (["keys", 1, "frame"], 10**400, says(NOT_A_FRAME)),
        (["keys", 1, "targets", "nose"], [10**400, 0], says(NOT_FINITE)),
    ],
)
def test_whatever_a_script_cannot_say_is_refused(path, value, message):
    with pytest.raises(
        ValueError if message == says(IMPOSSIBLE_BOUND, name="k") else LissomError, match=message
    ):
        parse_pose_script(changed(path, value))


CLOCKED = {
    "schema": 1,
    "loop": True,
    "handles": {"nose": [1, 2], "hoof": {"at": [3, 4], "still": False}, "tail": [5, 6]},
    "keys": [{"frame": 0}, {"frame": 24}],
    "tracks": [
        {
            "handle": "tail",
            "with": "pose",
            "keys": [
                {"frame": 0, "offset": [0, 0]},
                {"frame": 9, "offset": [7, -8.5], "ease": "in", "turn": 90},
                {"frame": 11, "offset": [1, 1], "velocity": [-2, 0.5]},
                {"frame": 12, "offset": [1, 1], "passing": "hold"},
                {"frame": 30, "offset": [0, 0], "passing": "stop"},
            ],
            "delay": 4,
            "reach": 0.3,
        },
        {"handles": ["hoof", "nose"], "with": "picture", "keys": [{"frame": 3, "at": [9, 0]}]},
    ],
    "springs": [
        {"handle": "nose", "preset": "ear"},
        {"handle": "tail", "preset": "tail", "damping": 0.5, "lag": 1.5},
        {
            "handle": "hoof",
            "frequency": 3,
            "damping": 0.25,
            "lag": 1,
            "strength": 0.5,
            "root": "tail",
            "stretch": 0.5,
        },
    ],
}


def test_tracks_and_springs_are_read():
    script = parse_pose_script(CLOCKED)
    (layer,) = script.layers
    tail, hoof = layer.tracks
    assert tail == Track(
        handles=(2,),
        keys=(
            TrackKey(frame=0, place=0),
            TrackKey(
                frame=9,
                place=7 - 8.5j,
                turn=np.pi / 2,
                easing=PRESETS["in"],
                tangent_mode=TangentMode.CORNER,
            ),
            TrackKey(frame=11, place=1 + 1j, velocity=-2 + 0.5j),
            TrackKey(frame=12, place=1 + 1j, easing=HOLD),
            TrackKey(frame=30, place=0, easing=LINEAR, tangent_mode=TangentMode.STOP),
        ),
        delay=4,
        reach=0.3,
        keys_rotation=True,
    )
    assert hoof == Track(handles=(1, 0), is_scene_space=True, keys=(TrackKey(frame=3, place=9),))
    assert layer.springs == (
        Spring(handle=0, frequency=3.0, damping=0.25),
        Spring(handle=2, frequency=1.6, damping=0.5, lag=1.5),
        Spring(handle=1, frequency=3.0, damping=0.25, lag=1.0, strength=0.5, root=2, stretch=0.5),
    )
    # Keys of tracks make an animation as long as those of poses do.
    assert script.last == 30


def test_handles_stay_where_keys_have_them_unless_a_script_says_otherwise():
    (layer,) = parse_pose_script(CLOCKED).layers
    assert layer.still
    assert [handle.still for handle in layer.handles.values()] == [True, False, True]
    (layer,) = parse_pose_script({**CLOCKED, "still": False}).layers
    assert not layer.still
    body, arm = parse_pose_script({**SCENE, "layers": [BODY, {**ARM, "still": False}]}).layers
    assert (body.still, arm.still) == (True, False)
    loose = {**SCENE, "still": False, "layers": [BODY, {**ARM, "still": True}]}
    body, arm = parse_pose_script(loose).layers
    assert (body.still, arm.still) == (False, True)


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (["still"], 0, says(NOT_TRUE_OR_FALSE, where="still")),
        (["handles", "hoof", "still"], "no", says(NOT_TRUE_OR_FALSE, where="handle 'hoof'.still")),
        (["tracks"], {}, says(NOT_LIST, where="tracks")),
        (["tracks", 0], [], says(NOT_OBJECT, where="tracks[0]")),
        (
            ["tracks", 0, "handle"],
            "tial",
            r"tracks\[0\].handle names the handle 'tial', which does not exist",
        ),
        (["tracks", 0, "handle"], 2, says(NOT_TEXT, where="tracks[0].handle")),
        (["tracks", 0, "handle"], None, says(HANDLE_OR_HANDLES, where="tracks[0]")),
        (["tracks", 0, "handles"], ["hoof"], says(HANDLE_OR_HANDLES, where="tracks[0]")),
        (["tracks", 1, "handles"], [], r"tracks\[1\]: A track needs at least one handle"),
        (["tracks", 1, "handles"], ["hoof", "ear"], r"handles\[1\] names the handle 'ear'"),
        (["tracks", 1, "handles"], ["hoof", "hoof"], r"tracks\[1\].handles lists 'hoof' twice"),
        (["tracks", 1, "handles"], ["tail"], r"tracks\[0\] and tracks\[1\] both have .* 'tail'"),
        (["tracks", 0, "with"], "body", says(NO_BASIS, where="tracks[0]", content='"body"')),
        (["tracks", 0, "with"], ["pose"], says(NO_BASIS)),
        (["tracks", 0, "keys"], None, says(LACKS_FIELD, name="keys")),
        (["tracks", 0, "keys"], [], r"tracks\[0\]: A track needs at least one key"),
        (
            ["tracks", 0, "keys", 1, "frame"],
            0,
            says(OUT_OF_ORDER, where="tracks[0].keys", after=0, before=0),
        ),
        (["tracks", 0, "keys", 1, "frame"], 99, says(OUT_OF_ORDER, after=11, before=99)),
        (["tracks", 0, "keys", 1, "frame"], 1.5, says(NOT_A_FRAME, where="keys[1]", name="frame")),
        (["tracks", 0, "keys", 1, "frame"], -1, says(NOT_A_FRAME)),
        (["tracks", 0, "keys", 3, "frame"], 10**9, says(NOT_A_FRAME)),
        (["tracks", 0, "keys", 1, "offset"], None, says(LACKS_FIELD, name="offset")),
        (["tracks", 0, "keys", 1, "offset"], [1], says(NOT_POINT, where="keys[1].offset")),
        (["tracks", 0, "keys", 1, "offset"], [float("nan"), 0], says(NOT_FINITE)),
        (
            ["tracks", 0, "keys", 1, "offset"],
            [1e9, 0],
            r"keys\[1\]: A key of a track must be within",
        ),
        (["tracks", 0, "keys", 1, "at"], [1, 2], "has 'at', but the keys of a track with 'pose'"),
        (
            ["tracks", 1, "keys", 0, "offset"],
            [1, 2],
            "'offset', but the keys of a track with 'picture'",
        ),
        (["tracks", 0, "keys", 0, "velocity"], 3, says(NOT_POINT, where="keys[0].velocity")),
        (["tracks", 0, "keys", 0, "velocity"], [float("nan"), 0], says(NOT_FINITE)),
        (["tracks", 0, "keys", 0, "velocity"], [1e9, 0], "at most 10,000,000 pixels"),
        (
            ["tracks", 0, "keys", 1, "velocity"],
            [1, 0],
            says(NEEDLESS_VELOCITY),
        ),
        (
            ["tracks", 0, "keys", 3, "velocity"],
            [1, 0],
            says(NEEDLESS_VELOCITY),
        ),
        (
            ["tracks", 0, "keys", 4, "velocity"],
            [1, 0],
            says(NEEDLESS_VELOCITY),
        ),
        (["tracks", 0, "keys", 1, "turn"], float("inf"), says(NOT_FINITE, where="keys[1].turn")),
        (["tracks", 0, "keys", 1, "turn"], 7201, "by at most 20 whole turns, not 20.0028"),
        (["tracks", 0, "keys", 1, "turn"], True, says(NOT_NUMBER, where="keys[1].turn")),
        (["tracks", 0, "keys", 1, "ease"], "bouncy", "no easing 'bouncy'"),
        (["tracks", 0, "keys", 1, "passing"], "over", "passing must be one of through"),
        (["tracks", 0, "keys", 1, "passing"], "hold", "its ease has no effect"),
        (["tracks", 0, "keys", 1, "pull"], 3, "unknown field 'pull'"),
        (["tracks", 0, "delay"], -1, r"tracks\[0\]: The delay of a track must be from 0"),
        (["tracks", 0, "delay"], 2.5, says(NOT_WHOLE, where="tracks[0].delay")),
        (["tracks", 0, "delay"], 31, r"tracks\[0\].delay is 31 frames, longer than the loop"),
        (["tracks", 0, "reach"], 2, r"tracks\[0\]: The reach of a track must be from 0 to 1"),
        (["tracks", 0, "reach"], float("nan"), says(NOT_FINITE, where="reach")),
        (["tracks", 0, "color"], 2, "unknown field 'color'"),
        (["springs", 0, "handle"], "ear", r"springs\[0\].handle names the handle 'ear'"),
        (["springs", 0, "handle"], "tail", r"springs\[0\] and springs\[1\] both have .* 'tail'"),
        (["springs", 0, "handle"], None, says(LACKS_FIELD, name="handle")),
        (["springs", 0, "preset"], "leg", "preset must be one of tail, ear, .* not 'leg'"),
        (["springs", 0, "preset"], None, says(NO_PRESET, presets="tail, ear, hair, cloth, jelly")),
        (["springs", 2, "damping"], None, says(NO_PRESET)),
        (["springs", 2, "damping"], 0, r"springs\[2\].damping must be above 0 in a loop"),
        (["springs", 2, "damping"], -0.1, r"springs\[2\]: The damping of a spring must be from 0"),
        (["springs", 2, "frequency"], 0, "frequency of a spring must be above 0"),
        (["springs", 2, "frequency"], float("nan"), says(NOT_FINITE, where="frequency")),
        (["springs", 2, "lag"], -1, "lag of a spring must be from 0"),
        (["springs", 2, "strength"], "much", says(NOT_NUMBER, where="strength")),
        (["springs", 2, "mass"], 1, "unknown field 'mass'"),
        (
            ["springs", 2, "stretch"],
            2,
            r"springs\[2\]: The stretch of a spring must be from 0 to 1",
        ),
        (["springs", 2, "root"], "ear", r"springs\[2\].root names the handle 'ear'"),
        (
            ["springs", 2, "root"],
            "hoof",
            r"springs\[2\]: The root of a spring must be another handle",
        ),
    ],
)
def test_whatever_tracks_and_springs_cannot_be_is_refused(path, value, message):
    with pytest.raises(LissomError, match=message):
        parse_pose_script(changed(path, value, CLOCKED))


def test_what_only_a_loop_cannot_have_is_fine_without():
    for path, value in ((["tracks", 0, "delay"], 31), (["springs", 2, "damping"], 0)):
        once = changed(path, value, CLOCKED)
        assert parse_pose_script({**once, "loop": False})


ARM = {
    "layer": "arm",
    "handles": {"hand": {"at": [7, 8], "front": 0.5, "extent": 60}, "elbow": [5, 6]},
    "keys": [{"frame": 0}, {"frame": 9, "front": {"hand": -1}}],
    "attach": {"to": "body", "at": [3, 4], "turn": False},
    "visible": [[0, True], [12, False]],
    "variant": "nu",
}
BODY = {"layer": "body", "handles": {}, "keys": [{"frame": 0}]}
SCENE = {"schema": 1, "fps": 8, "bounds": {"k": 0.7}, "layers": [BODY, ARM]}


def test_a_script_of_several_layers():
    script = parse_pose_script(SCENE)
    body, arm = script.layers
    assert (script.fps, body.layer, arm.layer) == (8, "body", "arm")
    # What the scene says holds for all layers that say nothing else.
    assert (body.variant, arm.variant) == ("metric", "nu")
    assert body.bounds == arm.bounds == Bounds(k=0.7, sigma_a=2.0, sigma_b=0.5)
    assert arm.handles["hand"] == ScriptHandle(at=7 + 8j, front=0.5, extent=60.0)
    assert arm.attach == (ScriptAttachment(to="body", at=3 + 4j, turns=False),)
    assert arm.channels == {
        (VISIBILITY.name, None): (VISIBILITY.key(0, value=True), VISIBILITY.key(12, value=False)),
        (DEPTH.name, "hand"): (DEPTH.key(9, -1.0),),
    }
    # A mouth that moves with its parent needs neither handles nor keys.
    without = {name: value for name, value in BODY.items() if name not in {"handles", "keys"}}
    assert parse_pose_script({**SCENE, "layers": [without, ARM]}).layers == script.layers
    # In a loop, the last depth holds before the first pose, and the first pose ends it.
    _, arm = parse_pose_script({**SCENE, "loop": True}).layers
    assert arm.channels[DEPTH.name, "hand"] == (DEPTH.key(0, 0.5), DEPTH.key(9, -1.0))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"layer": 5}, says(NOT_TEXT, where="layers[0].layer")),
        ({"colour": 1}, r"layers\[0\] has an unknown field 'colour'"),
        ({"keys": []}, says(NO_KEYS, where="layers[0].keys")),
        ({"keys": [{"frame": 0, "front": {"toe": 1}}]}, r"keys\[0\] names the handle 'toe'"),
        ({"handles": {"hand": {"front": 1}}}, says(LACKS_FIELD, name="at")),
        ({"handles": {"hand": {"at": [1, 2], "depth": 1}}}, "unknown field 'depth'"),
        ({"attach": {"to": "body"}}, says(LACKS_FIELD, name="at")),
        ({"visible": [[0]]}, says(NO_PAIR, where="layers[0].visible[0]")),
        ({"visible": [[0.5, True]]}, "whole number"),
    ],
)
def test_whatever_a_layer_cannot_say_is_refused(change, message):
    with pytest.raises(LissomError, match=message):
        parse_pose_script({**SCENE, "layers": [{**ARM, **change}]})


def test_layers_have_layers_of_their_own():
    with pytest.raises(LissomError, match="two layers have the name 'arm'"):
        parse_pose_script({**SCENE, "layers": [ARM, ARM]})
    with pytest.raises(LissomError, match="at least one layer"):
        parse_pose_script({**SCENE, "layers": []})
    with pytest.raises(LissomError, match="unknown field 'handles'"):
        parse_pose_script({**SCENE, "handles": {}})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", says(NOT_JSON, line=1)),
        ("[]", says(NOT_OBJECT, where="the script")),
        ('{"schema": 1, "schema": 1}', "has the field 'schema' twice"),
        ("[" * 100_000, says(TOO_NESTED)),
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
    document = bar_document()
    handles = {"end": [210, 40], "middle": [120, 40], "start": [30, 40]}
    posed = {}
    for pull in ({}, {"pull": 10}):
        far = {"frame": 8, "targets": {"end": [500, 60]}, **pull}
        after = {"frame": 16, "targets": {"start": [32, 44]}}
        script = {"schema": 1, "handles": handles, "keys": [{"frame": 0}, far, after]}
        script["bounds"] = {"k": 0.5, "sigma_a": 2, "sigma_b": 0.5}
        result, notices = pose_document(document, parse_pose_script(script), lambda _: None)
        posed[bool(pull)] = result.layers[0], notices
    (held, _), (pulled, notices) = posed[False], posed[True]
    for layer, far in ((held, True), (pulled, False)):
        for key in layer.keys[1:]:
            assert (abs(layer.target_errors(key.pose)[1]) > 5) == far
    # A notice names the target error, and the target moves to where the handle is.
    assert len(notices) == 1
    assert re.fullmatch(
        r"frame 8: 'end' is \d+\.\d px from its target, .* by the limits", notices[0]
    )
    wanted = pulled.keys[1].pose.targets[0].position
    assert wanted.real < 450
    assert pulled.target_errors(pulled.keys[1].pose)[0] < 1
    assert pulled.keys[2].pose.targets[0].position == wanted


def test_a_script_gives_its_layer_tracks_springs_and_auto_pins():
    opened = still_document(bar_picture())
    handles = {"end": [210, 40], "start": {"at": [30, 40], "still": False}}
    script = {
        **CLOCKED,
        "handles": handles,
        "tracks": [{"handle": "start", "keys": [{"frame": 40, "offset": [3, 4]}]}],
        "springs": [{"handle": "end", "preset": "tail", "root": "start"}],
    }
    document, _ = pose_document(opened, parse_pose_script(script), lambda _: None)
    layer = document.layers[0]
    end, start = layer.handles
    assert (document.frames.last, document.loop) == (40, True)
    assert layer.has_auto_pins
    assert (end.is_unpinned, start.is_unpinned) == (False, True)
    assert layer.track_of(start.id).keys == (TrackKey(frame=40, place=3 + 4j),)
    assert layer.spring_of(end.id).frequency == 1.6
    assert layer.spring_of(end.id).root == start.id
    loose = parse_pose_script({**script, "still": False})
    document, _ = pose_document(opened, loose, lambda _: None)
    assert not document.layers[0].has_auto_pins


CAMERA = {"keys": [{"frame": 0, "centre": [100, 60]}, {"frame": 12, "centre": [1, 2], "turn": 90}]}


def test_the_camera_and_movements_are_read():
    (one, two) = parse_pose_script({**WHOLE, "camera": CAMERA, "canvas": [640, 360]}).camera
    assert one == CAMERA_KIND.key(0, Camera(100 + 60j))
    assert two.value.turn == np.pi / 2
    eased = changed(("keys", 1, "ease"), "in", CAMERA)
    camera = parse_pose_script({**WHOLE, "camera": eased}).camera
    assert (camera[0].tangent_mode, camera[1].tangent_mode) == (
        TangentMode.SMOOTH,
        TangentMode.CORNER,
    )
    moved = {"keys": [{"frame": 0}, {"frame": 40, "shift": [3, -4], "turn": -180}]}
    script = parse_pose_script({**WHOLE, "movement": moved, "opacity": [[0, 1], [50, 0.5]]})
    (layer,) = script.layers
    assert layer.channels == {
        (TRANSFORM.name, None): (
            TRANSFORM.key(0, Transform()),
            TRANSFORM.key(40, Transform(3 - 4j, -np.pi)),
        ),
        (OPACITY.name, None): (OPACITY.key(0, 1.0), OPACITY.key(50, 0.5)),
    }
    assert layer.opacity is None
    assert script.last == 50
    assert parse_pose_script({**WHOLE, "opacity": 0.25}).layers[0].opacity == 0.25


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"camera": {"keys": []}}, says(NO_KEYS, where="camera.keys")),
        ({"camera": {"key": []}}, "unknown field 'key'"),
        (
            {"camera": changed(("keys", 1, "zoom"), 0, CAMERA)},
            r"camera\.keys\[1\]: The zoom must be from 0\.001 to 1000, not 0",
        ),
        (
            {"camera": changed(("keys", 1, "zoom"), -2, CAMERA)},
            r"camera\.keys\[1\]: The zoom must be from 0\.001 to 1000, not -2",
        ),
        (
            {"camera": changed(("keys", 1, "zoom"), float("inf"), CAMERA)},
            says(NOT_FINITE, where="zoom"),
        ),
        (
            {"camera": changed(("keys", 1, "frame"), 0, CAMERA)},
            says(OUT_OF_ORDER, where="camera.keys"),
        ),
        ({"camera": changed(("keys", 1, "tilt"), 1, CAMERA)}, "unknown field 'tilt'"),
        (
            {"camera": changed(("keys", 0, "centre"), None, CAMERA)},
            says(LACKS_FIELD, name="centre"),
        ),
        ({"camera": changed(("keys", 0, "centre"), [1e9, 0], CAMERA)}, r"keys\[0\]: The camera's"),
        ({"canvas": [640]}, "canvas must be width and height"),
        ({"canvas": [640, 1.5]}, "canvas must be a whole number"),
        ({"movement": {"keys": [{"frame": 0, "zoom": 2}]}}, "unknown field 'zoom'"),
        (
            {"movement": {"keys": [{"frame": 3}, {"frame": 2}]}},
            says(OUT_OF_ORDER, where="movement.keys"),
        ),
        ({"opacity": 2}, "Opacity must be from 0 to 1"),
        ({"opacity": [[0, 1], [0, 0]]}, says(OUT_OF_ORDER, where="opacity")),
        ({"opacity": [[0]]}, says(NO_PAIR, where="opacity[0]")),
        ({"opacity": []}, says(NO_KEYS, where="opacity")),
        ({"opacity": [[0, 1], [4, "much"]]}, says(NOT_NUMBER, where="opacity[1]")),
        (
            {"movement": {"keys": [{"frame": 0, "turn": "left"}]}},
            r"^movement\.keys\[0\]\.turn must",
        ),
        ({"movement": {"keys": [{"frame": 0, "ease": "x"}]}}, r"^movement\.keys\[0\]\.ease: There"),
        ({"order": [[0, None]]}, 'order needs "layers"'),
    ],
)
def test_a_camera_that_cannot_be_is_refused(change, words):
    with pytest.raises(LissomError, match=words):
        parse_pose_script({**WHOLE, **change})


@pytest.mark.parametrize("place", [{}, {"beside": "arm"}, 3, {"in_front_of": "a", "behind": "b"}])
def test_an_order_is_in_front_of_a_layer_or_behind_it(place):
    own = {"layer": "arm", "handles": {}, "keys": [{"frame": 0}], "order": [[3, place]]}
    with pytest.raises(LissomError, match=r"layers\[0\]\.order\[0\] must"):
        parse_pose_script({"schema": 1, "layers": [own]})


IN_OUT = {"easing": "in-out", "tangent_mode": "stop"}
MADE = {"easing": PRESETS["in-out"], "tangent_mode": TangentMode.STOP}
# For each quantity, two values in a script, and what they mean.
SAMPLES = dict.fromkeys(Quantity, ((0.25, 0.5), (0.25, 0.5))) | {
    Quantity.POINT: (([3, -4], [0, 1]), (3 - 4j, 1j)),
    Quantity.ANGLE: ((90, -180), (np.pi / 2, -np.pi)),
    Quantity.FLAG: ((False, True), (False, True)),
    Quantity.LAYER: (("bar", "bar"), (0, 0)),
    Quantity.COLOUR: (([0, 0.5, 1], [1, 0.5, 0]), ((0, 0.5, 1), (1, 0.5, 0))),
}


IN_CHANNELS = [kind for kind in LAYER_KINDS.values() if not kind.of_sliders]


@pytest.mark.parametrize("kind", IN_CHANNELS, ids=lambda kind: kind.name)
def test_a_channel_of_any_kind_is_read(kind):
    opened = still_document(bar_picture())
    bar = replace(opened.layers[0], name="bar")
    opened = replace(opened, layers=(bar, replace(bar, id=1, name="other")))
    fields, values = (
        [[SAMPLES[each.quantity][side][index] for each in kind.fields] for index in (0, 1)]
        for side in (0, 1)
    )
    one, two = (
        dict(zip((each.name for each in kind.fields), some, strict=True)) for some in fields
    )
    keys = [{"frame": 2, **one}, {"frame": 9, **two, **IN_OUT}]
    other = {"layer": "other", "handles": {"end": [210, 40]}, "keys": [{"frame": 0}]}
    other["channels"] = {kind.name: {"end": keys} if kind is DEPTH else keys}
    script = parse_pose_script({"schema": 1, "layers": [other]})
    assert script.last == (0 if kind.is_held else 9)
    document, _ = pose_document(opened, script, lambda _: None)
    layer = document.layer(1)
    part = layer.handles[0].id if kind is DEPTH else None
    made = kind.key(2, kind.make(*values[0])), kind.key(9, kind.make(*values[1]), **MADE)
    assert layer.channels == {(kind.name, part): made}


def test_earlier_fields_say_the_same_as_channels():
    keys = [{"frame": 0}, {"frame": 9, "front": {"hand": -1}}]
    still = {"layer": "arm", "handles": ARM["handles"], "keys": [{"frame": 0}, {"frame": 9}]}
    earlier = {
        "movement": {
            "keys": [
                {"frame": 0, "shift": [3, -4], "ease": "in-out", "passing": "stop"},
                {"frame": 6, "turn": 90, "ease": "in"},
                {"frame": 9, "passing": "hold"},
            ]
        },
        "opacity": [[0, 1], [5, 0.5]],
        "visible": [[0, True], [4, False]],
        "order": [[0, {"behind": "body"}], [4, {"in_front_of": "body"}], [6, None]],
    }
    channels = {
        "transform": [
            {"frame": 0, "shift": [3, -4], **IN_OUT},
            {"frame": 6, "turn": 90, "easing": "in", "tangent_mode": "corner"},
            {"frame": 9, "easing": "hold"},
        ],
        "opacity": [{"frame": 0, "opacity": 1}, {"frame": 5, "opacity": 0.5}],
        "visibility": [{"frame": 0, "visible": True}, {"frame": 4, "visible": False}],
        "draw_order": [
            {"frame": 0, "beside": "body", "in_front": False},
            {"frame": 4, "beside": "body"},
            {"frame": 6, "beside": None},
        ],
        "depth": {"hand": [{"frame": 0, "depth": 0.5}, {"frame": 9, "depth": -1}]},
    }
    (old,) = parse_pose_script(
        {**SCENE, "loop": True, "layers": [{**still, **earlier, "keys": keys}]}
    ).layers
    (new,) = parse_pose_script(
        {**SCENE, "loop": True, "layers": [{**still, "channels": channels}]}
    ).layers
    assert old == new


@pytest.mark.parametrize(
    ("channels", "message"),
    [
        ([], says(NOT_OBJECT, where="layers[0].channels")),
        ({"colour": []}, r"layers\[0\]\.channels has an unknown field 'colour'; it may have tra"),
        ({"opacity": {}}, says(NOT_LIST, where="layers[0].channels.opacity")),
        ({"opacity": []}, says(NO_KEYS, where="layers[0].channels.opacity")),
        ({"opacity": [[0, 1]]}, says(NOT_OBJECT, where="channels.opacity[0]")),
        ({"opacity": [{"opacity": 1}]}, says(NOT_A_FRAME, where="channels.opacity[0]")),
        ({"opacity": [{"frame": 0, "opacity": 2}]}, r"channels\.opacity\[0\]: Opacity must"),
        ({"opacity": [{"frame": 0, "opacity": 1, "ease": "in"}]}, "unknown field 'ease'"),
        (
            {"opacity": [{"frame": 0, "opacity": 1, "easing": "bouncy"}]},
            r"channels\.opacity\[0\]\.easing: There is no easing",
        ),
        (
            {"opacity": [{"frame": 0, "opacity": 1, "tangent_mode": "hold"}]},
            r"channels\.opacity\[0\]: The tangent of a key must be",
        ),
        (
            {"visibility": [{"frame": 3, "visible": True}, {"frame": 3, "visible": True}]},
            says(OUT_OF_ORDER, where="layers[0].channels.visibility", after=3, before=3),
        ),
        ({"draw_order": [{"frame": 0, "beside": 3}]}, says(NOT_TEXT, where="draw_order[0].beside")),
        ({"depth": []}, says(NOT_OBJECT, where="channels.depth")),
        ({"depth": {"toe": []}}, r"channels\.depth names the handle 'toe'"),
        ({"depth": {"hand": [{"frame": 0, "depth": "far"}]}}, r"depth\.hand\[0\]\.depth must be"),
        ({"depth": {}}, says(TWICE, where="layers[0].front")),
        (
            {"visibility": []},
            says(TWICE, where="layers[0].visible", other="layers[0].channels.visibility"),
        ),
    ],
)
def test_channels_that_cannot_be_are_refused_with_their_place(channels, message):
    arm = {**ARM, "channels": channels}
    if channels != {"depth": {}}:
        arm["keys"] = [{"frame": 0}]
    if channels != {"visibility": []}:
        del arm["visible"]
    with pytest.raises(LissomError, match=message):
        parse_pose_script({**SCENE, "layers": [arm]})


ROUND = {"schema": 1, "handles": {"end": [210, 40], "start": [30, 40]}, "keys": [{"frame": 0}]}
ROUND["keys"] += [{"frame": f, "targets": {"end": [210, y]}} for f, y in ((8, 60), (16, 20))]


def test_a_script_says_what_repeats():
    opened = still_document(bar_picture())
    keys = [*ROUND["keys"], {"frame": 24, "targets": {"end": [210, 40]}}]
    cycles = [{"from": 48, "to": 60}, {"from": 0, "to": 24, "until": 48}]
    second = [{"frame": 48, "targets": {"end": [210, 40]}}, {"frame": 54, "targets": {}}]
    script = parse_pose_script({**ROUND, "keys": keys + second, "cycles": cycles})
    assert script.last == 60
    document, _ = pose_document(opened, script, lambda _: None)
    layer = document.layers[0]
    # The key at 24 is the first one again, and what comes at 48 is like it to the last digit.
    assert [key.frame for key in layer.keys] == [0, 8, 16, 48, 54]
    assert layer.cycles == (Cycle(first=0, last=24, until=48), Cycle(first=48, last=60))
    assert layer.key(48).pose is layer.key(0).pose
    keys[-1] = {"frame": 24, "targets": {"end": [210, 50]}}
    script = parse_pose_script({**ROUND, "keys": keys, "cycles": cycles[1:]})
    with pytest.raises(LissomError, match="frame 24 lies where frames 0 to 24 repeat, but it"):
        pose_document(opened, script, lambda _: None)


@pytest.mark.parametrize(
    ("cycles", "message"),
    [
        (
            [{"from": 8, "to": 8}],
            r"cycles\[0\]: A cycle must end after its first frame, 8, not at frame 8",
        ),
        ([{"from": 8, "to": 0}], "not at frame 0"),
        ([{"from": 0, "to": 24, "until": 20}], "cannot repeat until frame 20, which is not after"),
        (
            [{"from": 8, "to": 24}, {"from": 0, "to": 8, "until": 16}],
            "cycles: The repeats of frames 0 to 8 and frames 8 to 24 overlap",
        ),
        ([{"from": 0, "to": 24}, {"from": 30, "to": 40}], "at frame 30 or earlier"),
        ([{"from": 0, "to": 12, "until": 24}], "key at frame 16 lies where frames 0 to 12 repeat"),
        ([{"from": 9, "to": 12, "until": 12}], "No key in frames 9 to 12 could repeat"),
        ([{"from": 4, "to": 12, "until": 16}], "starts at frame 4. Set a key there"),
        (
            [{"from": 0, "to": 12, "until": 13}],
            "end at frame 13, .* no motion leads to the key at frame 16. .* frame 12 instead",
        ),
        ([{"from": 0}], says(NOT_A_FRAME, where="cycles[0]", name="to")),
        ([{"from": 0, "to": 24.5}], says(NOT_A_FRAME, where="cycles[0]", name="to")),
        ([{"from": 0, "to": 24, "til": 96}], "unknown field 'til'"),
        ({"from": 0, "to": 24}, says(NOT_LIST, where="cycles")),
    ],
)
def test_what_cannot_repeat_is_refused(cycles, message):
    with pytest.raises(LissomError, match=message):
        parse_pose_script({**ROUND, "cycles": cycles})

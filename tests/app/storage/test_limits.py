"""What commands make can be opened again, at the limits of each field; nothing else is written."""

import json
import sys
import zipfile
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from documents import (
    CENTRE,
    clocked_document,
    differences,
    disc_document,
    disc_domain,
    inside,
    random_command,
)
from hypothesis import given, settings, strategies as st
from pictures import blank_png

from app.document import (
    CAMERA,
    DRAW_ORDER,
    FASTEST,
    LAST_FRAME,
    OPACITY,
    SLOWEST,
    TRANSFORM,
    AppliedMotion,
    Attachment,
    Camera,
    Channel,
    Cycle,
    Document,
    DrawOrder,
    FrameRange,
    Meshing,
    PictureFile,
    Spring,
    Track,
    TrackKey,
    Transform,
    channel_commands,
    group_commands,
    handle_commands,
    key_commands,
    layer_commands,
    motion_notices,
    new_layer,
    pose_commands,
    rest_pose,
    scene_commands,
    shape_commands,
    switch_group_commands,
    track_commands,
)
from app.document.channels.cycles import MAX_CYCLES
from app.document.checks import MAX_COORDINATE, MAX_ID, MAX_PICTURE_SIDE
from app.document.keyframe import LARGEST_COEFFICIENT
from app.document.model import MAX_CHANGES
from app.document.rig.mirror_names import MAX_PAIRS
from app.errors import LissomError
from app.rigging import Parameters
from app.storage import project_file
from app.storage.autosave import Autosave, SourceInfo, load_recoverable_file
from app.storage.project import archive
from app.storage.project_file import load_project, save_project
from engine.domain import MeshedDomain
from engine.maps import Bounds
from tests.bench.opening import FILLINGS

NAMES = ("x", "é\u0301 \U0001f600" * 2000, "{0} %s {", "\x00\x1b[31m\n", "\u202e right to left")
FRAMES = (0, 1, LAST_FRAME - 1, LAST_FRAME)
FAR = (
    MAX_COORDINATE,
    -MAX_COORDINATE,
    complex(MAX_COORDINATE, -MAX_COORDINATE),
    1j * MAX_COORDINATE,
)
SIZES = (1, 2, MAX_PICTURE_SIDE)
BREATHE = AppliedMotion(
    motion="breathe",
    kind="anything",
    joints={},
    facing=1,
    parameters=Parameters(),
    first=0,
    start=0,
    last=LAST_FRAME,
)


def far_pose(layer, place):
    """The pose of a layer as it was drawn, moved as a whole, with its handles' targets there."""
    drawn = rest_pose(layer.domain, layer.handles)
    targets = {
        identity: replace(target, position=place) for identity, target in drawn.targets.items()
    }
    return replace(drawn, phi=drawn.phi + place, targets=targets)


def extreme_command(rng, document):
    """A command that brings a field of a document to its limit, or beyond."""
    frame, to = (FRAMES[at] for at in rng.integers(len(FRAMES), size=2))
    name, place = NAMES[rng.integers(len(NAMES))], complex(FAR[rng.integers(len(FAR))])
    layer = document.layers[rng.integers(len(document.layers))]
    identity, pose = layer.id, far_pose(layer, place)
    turn = float(rng.choice([-40 * np.pi, 40 * np.pi]))
    commands = [
        scene_commands.set_fps(float(rng.choice([SLOWEST, FASTEST]))),
        scene_commands.set_frames(FrameRange(0, LAST_FRAME)),
        scene_commands.add_marker(frame, name),
        scene_commands.set_mirror_names(tuple((f"l{i}", f"r{i}") for i in range(MAX_PAIRS))),
        channel_commands.set_key(Channel(CAMERA), frame, Camera(place, zoom=1e3, turn=turn)),
        channel_commands.set_key(Channel(TRANSFORM, identity), frame, Transform(place, turn)),
        channel_commands.set_key(Channel(OPACITY, identity), frame, float(rng.integers(2))),
        channel_commands.set_key(Channel(DRAW_ORDER, identity), frame, DrawOrder(None)),
        key_commands.insert_pose(identity, frame, pose, layer.keys[0].easing),
        key_commands.insert_key(identity, to, pose),
        pose_commands.save_pose(identity, pose, name),
        pose_commands.set_mirror(identity, MAX_COORDINATE),
        handle_commands.add_handle(identity, inside(rng), name=name),
        layer_commands.rename_layer(identity, name),
        layer_commands.duplicate_layer(identity),
        layer_commands.key_visibility(identity, frame, visible=bool(rng.integers(2))),
        layer_commands.attach_layer(
            identity,
            CENTRE,
            Attachment(
                parent=document.layers[0].id,
                parent_point=place,
                rest_rotation=turn,
                frame=frame,
                offset=place,
            ),
        ),
        switch_group_commands.create_switch_group(name, [each.id for each in document.layers][:2]),
        switch_group_commands.choose_at(identity, frame),
        shape_commands.set_limits(identity, Bounds(k=1 - 1e-9, sigma_a=1e9, sigma_b=1e-9)),
        group_commands.group_layers([identity], name.strip()),
    ]
    if layer.handles:
        handle = layer.handles[0].id
        key = TrackKey(frame=frame, place=place, turn=turn, velocity=place)
        track = Track(
            handles=(handle,),
            keys=(key,),
            delay=LAST_FRAME,
            is_scene_space=True,
            keys_rotation=True,
        )
        spring = Spring(handle=handle, frequency=1e3, damping=100.0, lag=10_000.0, strength=10.0)
        commands += [
            track_commands.put_track(identity, track),
            track_commands.put_spring(identity, spring),
            handle_commands.set_handle_weight(identity, {handle}, 1e6),
        ]
    return commands[rng.integers(len(commands))]


def far_document():
    """A layer of one pixel, as far from the lower left corner of the canvas as one may lie."""
    disc, corner = disc_domain(), complex(MAX_COORDINATE, MAX_COORDINATE)
    outline, cage = disc.outline / 200 + corner, disc.cage / 200 + corner
    mesh = replace(disc.mesh, vertices=outline)
    domain = MeshedDomain(outline=outline, cage=cage, mesh=mesh)
    picture = PictureFile(data=blank_png(1, 1), suffix=".png", size=(1, 1))
    layer = replace(new_layer(picture, domain, Meshing()), corner=corner)
    return Document(layers=(layer,), size=(MAX_PICTURE_SIDE, MAX_PICTURE_SIDE))


BEGINNINGS = (disc_document, clocked_document, far_document)


def require_reopened(path, begin, seeds):
    document = begin()
    for seed in seeds:
        rng = np.random.default_rng(seed)
        make = extreme_command if seed % 4 else random_command
        try:
            document = make(rng, document)(document)
        except LissomError:
            continue
    save_project(path, document)
    assert not differences(load_project(path), document)


@settings(max_examples=16)
@given(st.sampled_from(BEGINNINGS), st.lists(st.integers(0, 2**32 - 1), max_size=15))
def test_what_commands_make_at_limits_opens_again(tmp_path_factory, begin, seeds):
    require_reopened(tmp_path_factory.getbasetemp() / "limits.lissom", begin, seeds)


@pytest.mark.long
@settings(max_examples=120)
@given(st.sampled_from(BEGINNINGS), st.lists(st.integers(0, 2**32 - 1), max_size=40))
def test_many_commands_at_limits_open_again(tmp_path_factory, begin, seeds):
    require_reopened(tmp_path_factory.getbasetemp() / "more_limits.lissom", begin, seeds)


def read_content(path):
    with zipfile.ZipFile(path) as packed:
        return json.loads(packed.read("project.json"))


def with_content(path, change):
    """Change the JSON of a project in its place."""
    with zipfile.ZipFile(path) as packed:
        members = {name: packed.read(name) for name in packed.namelist()}
    content = json.loads(members["project.json"])
    change(content)
    with zipfile.ZipFile(path, "w") as packed:
        for name, data in (members | {"project.json": json.dumps(content).encode()}).items():
            packed.writestr(name, data)
    return path


@pytest.fixture
def saved(tmp_path):
    """The path of a project of two layers with a handle each, without any clock."""
    document = two_layers()
    save_project(tmp_path / "two.lissom", document)
    return tmp_path / "two.lissom"


def two_layers():
    document = handle_commands.add_handle(0, CENTRE)(disc_document())
    return layer_commands.duplicate_layer(0)(document)


NOT_READ_BACK = (
    (project_file, "MOST_VALUES", "has too many values; a project has at most 3"),
    (project_file, "LARGEST_JSON", "project.json is too large"),
    (project_file, "DEEPEST", "nested deeper than 3 levels"),
    (archive, "MOST_MEMBERS", "a project has at most 3"),
)


@pytest.mark.parametrize(("module", "limit", "refusal"), NOT_READ_BACK)
def test_save_is_refused_when_the_file_would_not_open(monkeypatch, saved, module, limit, refusal):
    before, tmp_path = saved.read_bytes(), saved.parent
    monkeypatch.setattr(module, limit, 3)
    with pytest.raises(LissomError, match=f"could not open the file again: .*{refusal}"):
        save_project(saved, clocked_document())
    assert saved.read_bytes() == before
    assert [*tmp_path.iterdir()] == [saved]


def test_autosave_keeps_earlier_work_when_newer_is_refused(monkeypatch, tmp_path):
    own = Autosave(tmp_path)
    own.write(disc_document(), SourceInfo("a", None))
    with monkeypatch.context() as patched:
        patched.setattr(project_file, "MOST_VALUES", 10)
        with pytest.raises(LissomError, match="could not open the file again"):
            own.write(clocked_document(), SourceInfo("b", None))
    (kept,) = tmp_path.glob("unsaved-*.lissom")
    document, origin = load_recoverable_file(kept)
    assert origin.name == "a"
    assert not differences(document, disc_document())
    own.remove()


def test_arrays_are_not_packed_when_they_would_be_refused(monkeypatch, saved):
    packed = saved.stat().st_size
    monkeypatch.setattr(archive, "MOST_UNPACKED", 1_000)
    save_project(saved, two_layers())
    assert saved.stat().st_size > packed
    assert not differences(load_project(saved), two_layers())


def test_a_pose_beyond_all_pixels_is_refused():
    layer = disc_document().layers[0]
    with pytest.raises(LissomError, match="coefficients of a pose"):
        far_pose(layer, 2 * LARGEST_COEFFICIENT)


KNOWN = {
    "id": 1,
    "motion": "breathe",
    "kind": "anything",
    "joints": {"top": 0},
    "facing": 1,
    "first": 0,
    "start": 0,
    "last": 8,
    "repeat_count": 1,
    "digest": "",
    "parameters": {
        "speed": 1.0,
        "size": 1.0,
        "energy": 1.0,
        "start": 0.0,
        "mirrored": False,
        "travel": False,
    },
}
BETWEEN = KNOWN | {"id": 2, "first": 8, "start": 8, "last": 10}
UNKNOWN_MOTIONS = (
    (BETWEEN | {"motion": "nosuch"}, "There is no motion preset 'nosuch'"),
    (BETWEEN | {"kind": "snake"}, "'breathe' is not a motion for 'snake'"),
    (BETWEEN | {"motion": "wave", "kind": "biped-side"}, "has no joint 'top'"),
    (BETWEEN | {"joints": {"top": 7}}, "is at handle 7, which does not exist"),
    (BETWEEN | {"first": -1}, "A motion must run from a frame to a later frame"),
    (BETWEEN | {"last": LAST_FRAME + 1}, "A motion must run from a frame to a later frame"),
    (BETWEEN | {"repeat_count": 10**30}, "A motion can play 1 to 1,000 times"),
    (BETWEEN | {"parameters": {"speed": 1e300}}, "needs the field 'size'"),
    ({"later": [1, 2.5, None, "x"]}, "needs the field 'id'"),
    ("hop", "must be an object"),
)


@pytest.mark.parametrize(("motion", "reason"), UNKNOWN_MOTIONS)
def test_motion_is_kept_and_reported_when_it_is_not_known(saved, motion, reason):
    later = KNOWN | {"id": 3, "first": 10, "start": 10, "last": 20}
    with_content(saved, lambda c: c["layers"][0].update(motions=[KNOWN, motion, later]))
    document = load_project(saved)
    layer = document.layers[0]
    assert [each.first for each in layer.motions] == [0, 10]
    (notice,) = motion_notices(document)
    assert layer.name in notice
    assert reason in notice
    renamed = layer_commands.rename_layer(layer.id, "other")(document)
    save_project(saved, renamed)
    assert read_content(saved)["layers"][0]["motions"] == [KNOWN, motion, later]


def test_motion_is_not_shown_with_the_id_of_another(saved):
    with_content(saved, lambda c: c["layers"][0].update(motions=[KNOWN, KNOWN]))
    (layer, _) = load_project(saved).layers
    assert (len(layer.motions), len(layer.unread_motions)) == (1, 1)


def test_motion_keeps_its_other_joints_when_a_handle_goes():
    document = handle_commands.add_handle(0, CENTRE + 9)(two_layers())
    motion = replace(BREATHE, joints={"top": 0, "foot": 1})
    layer = replace(document.layer(0), motions=(motion,))
    left = handle_commands.remove_handles(0, {0})(document.with_layer(layer))
    assert left.layer(0).motions[0].joints == {"foot": 1}


def shown_at(frame):
    return [{"kind": "visibility", "keys": [{"frame": frame, "visible": True}]}]


REFUSED = (
    (lambda c: c.update(fps=0.01), "speed must be from 1/60 to 1,000 frames"),
    (lambda c: c.update(fps=5e-324), "speed must be from 1/60 to 1,000 frames"),
    (lambda c: c.update(fps=1000.1), "speed must be from 1/60 to 1,000 frames"),
    (
        lambda c: c["layers"][0].update(channels=shown_at(-1)),
        "frame from 0 to 999,999, not at -1",
    ),
    (
        lambda c: c["layers"][0].update(channels=shown_at(10**6)),
        "frame from 0 to 999,999",
    ),
    (lambda c: c["layers"][0].update(id=MAX_ID + 1), "lacks layers/2147483648"),
    (
        lambda c: c["layers"][0].update(next_handle=2**31),
        "The next handle must have an id from 0 to",
    ),
    (
        lambda c: c["layers"][0]["handles"][0].update(id=10**30),
        "A handle must have an id from 0 to",
    ),
    (
        lambda c: c.update(
            switch_groups=[{"name": "{", "layers": [0, 1], "keys": [{"frame": 10**6, "layer": 0}]}]
        ),
        "frame from 0 to 999,999",
    ),
    (
        lambda c: c.update(switch_groups=[{"name": "{", "layers": [0, 0], "keys": []}]),
        "A switch lists 0 twice",
    ),
    (
        lambda c: c["layers"][0].update(cycles=[{"first": -2, "last": 2, "until": None}]),
        "frame from 0 to 999,999, not at -2",
    ),
    (
        lambda c: c.update(pairs=[[f"a{i}", f"b{i}"] for i in range(MAX_PAIRS + 1)]),
        "at most 1,000 pairs, not 1,001",
    ),
    (
        lambda c: c["layers"][0].update(
            cycles=[
                {"first": 2 * i, "last": 2 * i + 1, "until": 2 * i + 1}
                for i in range(MAX_CYCLES + 1)
            ]
        ),
        "at most 1,000 cycles, not 1,001",
    ),
)


@pytest.mark.parametrize(("change", "message"), REFUSED)
def test_project_is_refused_when_a_value_is_out_of_range(saved, change, message):
    with pytest.raises(LissomError, match=message):
        load_project(with_content(saved, change))


def test_changes_are_refused_when_they_repeat_too_often():
    document = two_layers()
    layer = document.layer(0)
    cycles = (Cycle(first=0, last=2),)
    layer = layer_commands.key_visibility(0, 1, visible=False)(document).layer(0)
    repeating = document.with_layer(replace(layer, cycles=cycles))
    count = MAX_CHANGES - 3
    assert scene_commands.set_frames(FrameRange(0, 2 * count // 3))(repeating)
    with pytest.raises(LissomError, match=f"more than {MAX_CHANGES:,}. End the repeats"):
        scene_commands.set_frames(FrameRange(0, LAST_FRAME))(repeating)


def calls_of(work):
    """Count the calls that something makes, of Python's and of C's functions."""
    count = 0

    def listen(_, event, __):
        nonlocal count
        count += event.endswith("call")

    sys.setprofile(listen)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.parametrize("kind", FILLINGS)
def test_opening_works_twice_as_much_for_twice_as_much(saved, kind):
    content = read_content(saved)
    counts = []
    for size in (0, 4_000, 8_000):

        def fill(changed, size=size):
            changed.clear()
            changed.update(json.loads(json.dumps(content)) | {"frames": [0, LAST_FRAME]})
            if size:
                FILLINGS[kind](changed, size)

        with_content(saved, fill)
        counts.append(calls_of(lambda: try_to_open(saved)))
    none, some, more = counts
    assert more - none < 2.5 * (some - none) + 500


def try_to_open(path):
    with suppress(LissomError):
        load_project(path)

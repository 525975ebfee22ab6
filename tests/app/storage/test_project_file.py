import io
import json
import struct
import tracemalloc
import zipfile
from dataclasses import astuple, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest
from documents import (
    altered,
    clocked_document,
    differences,
    disc_document,
    disc_domain,
    full_document,
    random_command,
)
from hypothesis import given, settings, strategies as st
from messages import says

from app.cut_out import CutLine, CutOut
from app.document.channels.cycles import Cycle
from app.document.channels.easing import PRESETS
from app.document.channels.kind import KEYS_OUT_OF_ORDER
from app.document.channels.kinds import (
    CAMERA,
    DEPTH,
    DRAW_ORDER,
    OPACITY,
    SWITCH,
    TRANSFORM,
    VISIBILITY,
)
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.values import Camera, DrawOrder, Transform
from app.document.commands import (
    handle_commands,
)
from app.document.commands.keys import (
    key_commands,
    track_commands,
)
from app.document.commands.layers import layer_commands
from app.document.layer import DUPLICATE_BONES, NO_HANDLE
from app.document.model import NO_LAYER, PARENT_CIRCLE
from app.errors import LissomError, join_names
from app.storage import NO_FOLDER
from app.storage.assets import sample_images
from app.storage.json_values import (
    LACKS_FIELD,
    NOT_LIST,
    NOT_NUMBER,
    NOT_OBJECT,
    NOT_POINT,
    NOT_TEXT,
    NOT_TRUE_OR_FALSE,
    NOT_WHOLE,
    JsonObject,
)
from app.storage.project.archive import (
    MEMBER_TOO_LARGE,
    MIMETYPE,
    NO_PROJECT,
    NOT_ARRAY,
    array_member,
)
from app.storage.project.channel_codecs import DUPLICATE_CHANNEL
from app.storage.project.document_json import EARLIER_BONES
from app.storage.project.earlier_schemas import update_schema
from app.storage.project.members import OTHER_CHECKSUM
from app.storage.project_file import NEWER_LISSOM, load_project, load_thumbnail, save_project
from engine.arrays import FEW_ENTRIES, NOT_FINITE
from engine.domain.validity import (
    MESH_CORNERS,
    MESH_FLAT,
    MESH_SIZE,
    MESH_UNFILLED,
    MESH_UNUSED,
    TOO_FAR,
)
from engine.geometry.polygon import CAGE_ORDER, CAGE_REPEATS, CAGE_TOUCHES
from engine.maps import Boundary, certify
from engine.maps.bounds import IMPOSSIBLE_BOUND

CAGE, MESH = disc_domain().cage, disc_domain().mesh
THUMBNAIL = b"\x89PNG small"
# Written once, by `save_project(STORED, full_document(), thumbnail=THUMBNAIL)`, and STORED_2 later,
# without a thumbnail. They stay as they are: they stand for the files that people have.
STORED = Path(__file__).parent / "data" / "schema_1.lissom"
STORED_2 = Path(__file__).parent / "data" / "schema_2.lissom"

# The fields that a scene of one layer says nothing of.
LAYER = ("name", "corner", "still", "reference", "locked", "hidden", "channels", "opacity")
LAYER += ("attachment", "handovers", "ik_parents", "pole_side")
# What an animation has that is more than poses: older projects have none of it.
CLOCKS = ("is_unpinned", "has_auto_pins", "tracks", "springs", "bones", "stiffness")


@pytest.fixture(scope="module")
def members(tmp_path_factory):
    """The members of a project file, in their order."""
    path = tmp_path_factory.mktemp("project") / "full.lissom"
    save_project(path, full_document(), thumbnail=THUMBNAIL)
    return read_members(path)


def read_members(path):
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def pack(path, members):
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def with_json(members, *way, value):
    """Return the members with one field of project.json replaced."""
    content = json.loads(members["project.json"])
    place = content
    for step in way[:-1]:
        place = place[step]
    place[way[-1]] = value
    return members | {"project.json": json.dumps(content).encode()}


def npy(array):
    file = io.BytesIO()
    np.save(file, array, allow_pickle=True)
    return file.getvalue()


def test_a_full_document_comes_back_to_the_last_bit(tmp_path):
    path = tmp_path / "a.lissom"
    save_project(path, full_document(), thumbnail=THUMBNAIL)
    assert not differences(load_project(path), full_document())
    assert load_thumbnail(path) == THUMBNAIL
    save_project(path, clocked_document())
    assert not differences(load_project(path), clocked_document())


def test_only_clocks_that_there_are_are_written(tmp_path):
    for document, written in ((full_document(), set()), (clocked_document(), set(CLOCKS))):
        save_project(tmp_path / "a", document)
        text = read_members(tmp_path / "a")["project.json"]
        assert {name for name in CLOCKS if f'"{name}"'.encode() in text} == written
    # What is new keeps still what is still; what older versions made does as it did.
    save_project(tmp_path / "a", disc_document())
    assert load_project(tmp_path / "a").layers[0].has_auto_pins
    assert not load_project(STORED).layers[0].has_auto_pins
    assert not load_project(STORED_2).layers[1].has_auto_pins


@settings(max_examples=20)
@given(
    st.lists(st.integers(0, 2**32 - 1), max_size=12),
    st.sampled_from([disc_document, full_document, clocked_document]),
)
def test_any_document_comes_back_to_the_last_bit(tmp_path_factory, seeds, begin):
    document = begin()
    for seed in seeds:
        try:
            document = random_command(np.random.default_rng(seed), document)(document)
        except LissomError:
            continue
    path = tmp_path_factory.getbasetemp() / "any.lissom"
    save_project(path, document)
    loaded = load_project(path)
    assert not differences(loaded, document)
    for array in (
        loaded.layers[0].domain.cage,
        loaded.layers[0].domain.mesh.triangles,
        loaded.layers[0].keys[0].pose.phi,
    ):
        assert not array.flags.writeable
        assert array.dtype.isnative


def test_a_stored_file_of_schema_1_opens():
    full = full_document()
    layer = full.layers[0]
    usual = disc_document().layers[0]
    own = [name for name in LAYER if hasattr(usual, name)]
    as_layer = {name: getattr(usual, name) for name in own}
    first = altered(
        replace(full, layers=(replace(layer, attachments=()),), size=None, sounds=()),
        markers=(),
        library=(),
        mirror=None,
        # Holes were filled, and what was enclosed was kept.
        cut_out=CutOut(tolerance=layer.cut_out.tolerance, enclosed="keep", holes="fill"),
        is_stale=False,
        handles=tuple(replace(handle, depth=0.0, extent=None) for handle in layer.handles),
        # Keys of that time have corners.
        keys=tuple(replace(key, tangent_mode=TangentMode.CORNER) for key in layer.keys),
        **as_layer,
    )
    assert not differences(load_project(STORED), first)
    assert load_thumbnail(STORED) == THUMBNAIL


# What fields of schema 2 are called now.
RENAMED = {
    "figures": "layers",
    "choices": "switch_groups",
    "told": "import_log",
    "losses": "warnings",
    "matters": "notes",
    "front": "depth",
    "free": "is_unpinned",
    "passing": "tangent_mode",
    "planted": "is_scene_space",
    "amount": "stiffness",
    "rounds": "repeat_count",
    "stillness": "has_auto_pins",
    "swapped": "toggled_holes",
    "slits": "cut_lines",
}
OF_ATTACHMENTS = {
    "to": "parent",
    "at": "parent_point",
    "rest": "rest_rotation",
    "keeps": "keep_world_transform",
    "since": "kept_since",
    "leads": "blends_to_next",
}
# Turns were of keys, of tracks, of attachments and of switches.
TURNS = {"targets": "revolutions", "delay": "keys_rotation", "rest": "inherits_rotation"}


def renamed(content):
    """The fields of schema 2 by their present names."""
    if isinstance(content, list):
        return [renamed(each) for each in content]
    if isinstance(content, dict):
        turns = next((new for name, new in TURNS.items() if name in content), "keys")
        names = RENAMED | {"turns": turns} | (OF_ATTACHMENTS if "rest" in content else {})
        return {names.get(name, name): renamed(each) for name, each in content.items()}
    return content


def members_by_their_present_names(path):
    """The members of a file of schema 2 but for its thumbnail, and what its JSON says."""
    members = read_members(path)
    content = JsonObject(renamed(json.loads(members.pop("project.json"))), "project.json")
    update_schema(content)
    content["schema"] = 6
    for layer in content["layers"]:
        for channel in layer.get("channels", ()):
            for key in channel["keys"] if channel["kind"] == "transform" else ():
                key.setdefault("scale", 1.0)  # which came later
    del content["app_version"]
    members = {name.replace("figures/", "layers/"): each for name, each in members.items()}
    return members, content


def written_again(path, to):
    """What a file's document is saved as."""
    save_project(to, load_project(path))
    members = read_members(to)
    content = json.loads(members.pop("project.json"))
    del content["app_version"]
    return members, content


def test_stored_schema_2_keeps_everything_but_its_names(tmp_path):
    full = replace(full_document(), sounds=())
    # In a loop, the last depth held before the first pose too, and the first pose ended it.
    for layer, handle in [(each, handle) for each in full.layers for handle in each.handles]:
        held = (DEPTH.key(3, handle.depth), *layer.keys_of(DEPTH, handle.id))
        full = full.with_layer(full.layer(layer.id).with_keys_of(DEPTH, held, handle.id))
    for layer in full.layers:
        # Transforms did not act at joints.
        ignores = [replace(each, applies_transform=False) for each in layer.attachments]
        if layer.keys_of(TRANSFORM):
            full = full.with_layer(replace(full.layer(layer.id), attachments=tuple(ignores)))
    assert not differences(load_project(STORED_2), full)
    assert written_again(STORED_2, tmp_path / "a") == members_by_their_present_names(STORED_2)


WAY = {"easing": "in", "tangent_mode": "stop"}
SCHEMA_3 = {
    "visibility_keys": [[0, True], [12, False]],
    "opacity_keys": [{"frame": 3, "opacity": 0.5, **WAY, "colour": "red"}],
    "transform_keys": [{"frame": 2, "shift": [3, -4], "turn": 0.5, **WAY}],
    "draw_order_keys": [
        {"frame": 7, "beside": 5, "in_front": False},
        {"frame": 9, "beside": None, "in_front": True},
    ],
}
SCHEMA_3_CAMERA = [{"frame": 1, "centre": [5, 6], "zoom": 2.0, "turn": -0.5, **WAY}]


@pytest.mark.parametrize("loop", [False, True])
def test_keys_of_schema_3_become_channels(tmp_path, members, loop):
    content = json.loads(members["project.json"])
    layer, other = content["layers"]
    del layer["channels"], other["channels"]
    layer |= SCHEMA_3
    layer["keys"][1]["depths"] = [[4, 0.25], [1, 0.0]]
    layer["keys"][2]["depths"] = [[4, 0.5]]
    content |= {"schema": 3, "loop": loop, "camera": SCHEMA_3_CAMERA}
    text = json.dumps(content).encode()
    document = load_project(pack(tmp_path / "a", members | {"project.json": text}))
    way = {"easing": PRESETS["in"], "tangent_mode": TangentMode.STOP}
    first = {1: (DEPTH.key(3, -0.75),), 4: (DEPTH.key(3, 0.0),)} if loop else {1: (), 4: ()}
    assert document.layers[0].channels == {
        (VISIBILITY.name, None): (VISIBILITY.key(0, value=True), VISIBILITY.key(12, value=False)),
        (OPACITY.name, None): (OPACITY.key(3, 0.5, **way, unknown={"colour": "red"}),),
        (TRANSFORM.name, None): (TRANSFORM.key(2, Transform(3 - 4j, 0.5), **way),),
        (DRAW_ORDER.name, None): (
            DRAW_ORDER.key(7, DrawOrder(5, in_front=False)),
            DRAW_ORDER.key(9, DrawOrder(None)),
        ),
        (DEPTH.name, 4): (*first[4], DEPTH.key(10, 0.25), DEPTH.key(40, 0.5)),
        (DEPTH.name, 1): (*first[1], DEPTH.key(10, 0.0)),
    }
    assert document.layers[1].channels == {}
    assert document.camera == (CAMERA.key(1, Camera(5 + 6j, 2.0, -0.5), **way),)
    save_project(tmp_path / "b", document)
    assert not differences(load_project(tmp_path / "b"), document)


@pytest.mark.parametrize(
    "names", [("switch_groups", "layers", "keys"), ("choices", "figures", "turns")]
)
def test_switches_of_schema_3_and_earlier_open(tmp_path, members, names):
    groups, layers, keys = names
    content = json.loads(members["project.json"])
    for layer in content["layers"]:
        del layer["channels"]
    content |= {"schema": 3, groups: [{"name": "mouth", layers: [0, 5], keys: [[0, 5], [4, 0]]}]}
    text = json.dumps(content).encode()
    document = load_project(pack(tmp_path / "a", members | {"project.json": text}))
    assert document.switch_groups[0].keys == (SWITCH.key(0, 5), SWITCH.key(4, 0))


@pytest.mark.parametrize(
    ("way", "value", "message"),
    [
        (["visibility_keys"], {}, says(NOT_LIST, where="layers[0].visibility_keys")),
        (["visibility_keys"], [7], says(NOT_OBJECT)),
        (["keys", 1, "depths"], [[4]], r"keys\[1\].depths\[0\] must be a handle and a number"),
        (["keys", 1, "depths"], [[[], 1]], says(NOT_WHOLE, where="layers[0].keys[1].depths[0]")),
        (["keys", 1, "fronts"], [[9, 0.5]], "belongs to the handle 9, which does not exist"),
        (["handles", 0, "id"], [], says(NOT_WHOLE, where="layers[0].handles[0].id")),
    ],
)
def test_keys_of_schema_3_that_make_no_sense_are_named(tmp_path, members, way, value, message):
    broken = with_json(members, "layers", 0, *way, value=value)
    with pytest.raises(LissomError, match=message):
        load_project(pack(tmp_path / "a", with_json(broken, "schema", value=3)))


@pytest.mark.parametrize(
    "channel",
    [
        {"kind": "colour", "keys": [{"frame": 3, "colour": [1, 0.1, 1e-320]}], "space": None},
        {"kind": "opacity", "part": "shadow", "keys": "later"},
        {"kind": "depth", "keys": []},
        {"kind": ["opacity"]},
        "a word",
    ],
)
def test_channels_of_later_versions_are_kept(tmp_path, members, channel):
    content = json.loads(members["project.json"])
    content["layers"][0]["channels"].append(channel)
    text = json.dumps(content).encode()
    document = load_project(pack(tmp_path / "a", members | {"project.json": text}))
    assert document.layers[0].unread_channels == (channel,)
    save_project(tmp_path / "b", handle_commands.rename_handle(0, 4, "other")(document))
    content["layers"][0]["handles"][1]["name"] = "other"
    written = json.loads(read_members(tmp_path / "b")["project.json"])
    assert json.dumps(written) == json.dumps(content, sort_keys=True)


@pytest.mark.parametrize("sample", sorted(sample_images().glob("*.lissom")), ids=lambda p: p.stem)
def test_samples_are_written_again_as_they_were(tmp_path, sample):
    members, content = members_by_their_present_names(sample)
    del members["thumbnail.png"]
    for layer in content["layers"]:
        layer["domain"].setdefault("enclosed", "keep")  # which came later
    assert written_again(sample, tmp_path / "a") == (members, content)


def test_what_played_in_a_file_of_schema_1_is_still_exported(tmp_path):
    members = read_members(STORED)
    played = with_json(members, "export", "frames", value=None)
    loaded = load_project(pack(tmp_path / "a", played))
    assert loaded.preview == loaded.export.frames == full_document().preview


def test_the_same_document_gives_the_same_bytes_whenever_it_is_saved(tmp_path):
    for name in ("a", "b"):
        save_project(tmp_path / name, full_document(), thumbnail=THUMBNAIL)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    with zipfile.ZipFile(tmp_path / "a") as archive:
        assert {member.date_time for member in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_a_save_never_writes_into_the_old_file(tmp_path):
    save_project(tmp_path / "a", disc_document())
    (tmp_path / "the same file").hardlink_to(tmp_path / "a")
    save_project(tmp_path / "a", full_document())
    assert not differences(load_project(tmp_path / "the same file"), disc_document())


def test_the_layout_of_the_file(tmp_path, members):
    path = tmp_path / "a.lissom"
    save_project(path, full_document())
    # The mimetype can be read at a fixed place, as `file` and desktops do.
    assert path.read_bytes()[30:].startswith(b"mimetype" + MIMETYPE)
    assert list(read_members(path)) == [name for name in members if name != "thumbnail.png"]
    assert list(members)[:3] == ["mimetype", "project.json", "layers/0/source.png"]
    assert members["layers/0/source.png"] == full_document().layers[0].picture.data
    phi = np.load(io.BytesIO(members["layers/0/keys/00001.phi.npy"]), allow_pickle=False)
    assert phi.tobytes() == full_document().layers[0].keys[1].pose.phi.tobytes()
    content = json.loads(members["project.json"])
    assert content["schema"] == 6
    assert content["app_version"].count(".") >= 1
    assert list(content) == sorted(content)
    keys = content["layers"][0]["keys"]
    assert keys[0]["easing"] == "in-out"
    # What a map is proven to keep is found out anew by whoever reads it.
    assert "certificate" not in keys[1]


def test_unknown_fields_are_kept_everywhere(tmp_path, members):
    content = json.loads(members["project.json"])
    layer = content["layers"][0]
    places = [content, content["export"], layer]
    places += [layer["picture"], layer["domain"], layer["bounds"], layer["handles"][0]]
    places += [layer["keys"][1], layer["keys"][2]["targets"][1]]
    for index, place in enumerate(places):
        place["from the future"] = {"list": [index, None, {"x": 1.5}]}
    text = json.dumps(content).encode()
    document = load_project(pack(tmp_path / "a", members | {"project.json": text}))
    changed = handle_commands.rename_handle(0, 4, "other")(document)
    save_project(tmp_path / "b", changed)
    layer["handles"][1]["name"] = "other"
    assert json.loads(read_members(tmp_path / "b")["project.json"]) == content


def test_unknown_fields_of_tracks_and_springs_are_kept(tmp_path):
    save_project(tmp_path / "a", clocked_document())
    members = read_members(tmp_path / "a")
    content = json.loads(members["project.json"])
    layer = content["layers"][0]
    track = layer["tracks"][0]
    for index, place in enumerate([track, track["keys"][1], layer["springs"][0]]):
        place["from the future"] = {"list": [index, None]}
    text = json.dumps(content).encode()
    document = load_project(pack(tmp_path / "a", members | {"project.json": text}))
    save_project(tmp_path / "b", track_commands.set_delay(0, 1, 8)(document))
    track["delay"] = 8
    assert json.loads(read_members(tmp_path / "b")["project.json"]) == content


def test_springs_of_older_files_swing_as_freely_as_they_did(tmp_path):
    save_project(tmp_path / "a", clocked_document())
    members = read_members(tmp_path / "a")
    content = json.loads(members["project.json"])
    (spring,) = content["layers"][0]["springs"]
    del spring["stretch"], spring["root"]
    older = pack(tmp_path / "b", members | {"project.json": json.dumps(content).encode()})
    (spring,) = load_project(older).layers[0].springs
    assert (spring.stretch, spring.root) == (1.0, None)


@pytest.mark.parametrize(
    ("way", "value", "message"),
    [
        (["has_auto_pins"], 1, says(NOT_TRUE_OR_FALSE, where="has_auto_pins")),
        (
            ["handles", 0, "is_unpinned"],
            "no",
            says(NOT_TRUE_OR_FALSE, where="handles[0].is_unpinned"),
        ),
        (["tracks"], {}, says(NOT_LIST, where="tracks")),
        (["tracks", 0], 7, says(NOT_OBJECT, where="tracks[0]")),
        (["tracks", 0, "handles"], [], "track needs at least one handle"),
        (["tracks", 0, "handles"], [4, 4], "track lists the handle 4 twice"),
        (["tracks", 0, "handles"], [7], says(NO_HANDLE, identity=7)),
        (["tracks", 0, "handles"], ["4"], says(NOT_WHOLE, where="handles[0]")),
        (["tracks", 0, "is_scene_space"], 1, says(NOT_TRUE_OR_FALSE, where="is_scene_space")),
        (["tracks", 0, "keys"], [], "track needs at least one key"),
        (["tracks", 0, "keys", 1, "frame"], 2, "track has two keys at frame 2"),
        (["tracks", 0, "keys", 1, "frame"], 1, "frames 2 and 1 are out of order"),
        (["tracks", 0, "keys", 3, "frame"], 61, "key at frame 61 lies outside"),
        (["tracks", 0, "keys", 0, "frame"], 0, "key at frame 0 lies outside"),
        (["tracks", 0, "keys", 1, "frame"], 2.5, says(NOT_WHOLE, where="frame")),
        (["tracks", 0, "keys", 1, "place"], [1], says(NOT_POINT, where="keys[1].place")),
        (["tracks", 0, "keys", 1, "place"], [1e9, 0], "A key of a track must be within"),
        (["tracks", 0, "keys", 1, "velocity"], 3, says(NOT_POINT, where="keys[1].velocity")),
        (["tracks", 0, "keys", 1, "velocity"], [1e9, 0], "10,000,000 pixels a frame"),
        (["tracks", 0, "keys", 1, "turn"], "left", says(NOT_NUMBER, where="turn")),
        (["tracks", 0, "keys", 1, "turn"], 10**400, "turn must be finite"),
        (["tracks", 0, "keys", 1, "turn"], -130, "rotate by at most 20 whole turns, not -20.69"),
        (["tracks", 0, "keys", 1, "easing"], "bounce", "no easing 'bounce'"),
        (["tracks", 0, "keys", 1, "tangent_mode"], "hold", "hold is an easing"),
        (["tracks", 0, "delay"], -1, "delay of a track must be from 0"),
        (["tracks", 0, "delay"], 10**30, "delay of a track must be from 0"),
        (["tracks", 0, "delay"], 60, "delayed by 60 frames, longer than the loop of 59"),
        (["tracks", 0, "reach"], 1.1, "reach of a track must be from 0 to 1"),
        (["tracks", 0, "enabled"], None, says(NOT_TRUE_OR_FALSE, where="enabled")),
        (["tracks", 0, "keys_rotation"], 0.1, says(NOT_TRUE_OR_FALSE, where="keys_rotation")),
        (["springs", 0, "handle"], 7, says(NO_HANDLE, identity=7)),
        (["springs", 0, "frequency"], 0, "frequency of a spring must be above 0"),
        (["springs", 0, "damping"], -1, "damping of a spring must be from 0"),
        (["springs", 0, "lag"], 1e9, "lag of a spring must be from 0"),
        (["springs", 0, "strength"], -0.1, "strength of a spring must be from 0"),
        (["springs", 0, "damping"], "none", says(NOT_NUMBER, where="damping")),
        (["springs", 0, "stretch"], 1.5, "stretch of a spring must be from 0 to 1, not 1.5"),
        (["springs", 0, "root"], 7, "spring has the root handle 7, which does not exist"),
        (["springs", 0, "root"], 1, "another handle than the spring's own"),
        (["springs", 0, "root"], "4", says(NOT_WHOLE, where="root")),
    ],
)
def test_clocks_that_make_no_sense_are_named(tmp_path, way, value, message):
    save_project(tmp_path / "a", clocked_document())
    broken = with_json(read_members(tmp_path / "a"), "layers", 0, *way, value=value)
    with pytest.raises(LissomError, match=message) as raised:
        load_project(pack(tmp_path / "a.lissom", broken))
    assert str(raised.value).startswith(f"cannot open {tmp_path / 'a.lissom'}: ")


@pytest.mark.parametrize(
    ("way", "value", "message"),
    [
        (["stiffness"], 1, says(NOT_TRUE_OR_FALSE, where="stiffness")),
        (["bones"], {}, says(NOT_LIST, where="bones")),
        (["bones", 0, "ends"], [4, 7], "bone ends at handle 7, which does not exist"),
        (["bones", 0, "ends"], [4, 4], "connect two different handles"),
        (["bones", 0, "ends"], [4], "ends must be two handles"),
        (["bones", 0, "stiffness"], 101, "Stiffness must be from 1/30 to 100"),
        (["bones", 0, "stiffness"], 0, "Stiffness must be from 1/30 to 100"),
        (["bones", 0, "stiffness"], "much", says(NOT_NUMBER, where="stiffness")),
        (["bones", 0, "is_shown"], 2, says(NOT_TRUE_OR_FALSE, where="is_shown")),
    ],
)
def test_material_that_makes_no_sense_is_named(tmp_path, way, value, message):
    save_project(tmp_path / "a", clocked_document())
    broken = with_json(read_members(tmp_path / "a"), "layers", 0, *way, value=value)
    with pytest.raises(LissomError, match=message):
        load_project(pack(tmp_path / "a.lissom", broken))


def test_bones_of_earlier_versions_get_a_direction_and_are_told_once(tmp_path):
    save_project(tmp_path / "a", clocked_document())
    members = read_members(tmp_path / "a")
    content = json.loads(members["project.json"])
    for bone in content["layers"][0]["bones"]:
        del bone["is_directed"]
        bone["stiffness"] = 10.0
    earlier = {**members, "project.json": json.dumps(content).encode()}
    opened = load_project(pack(tmp_path / "b", earlier))
    layer = opened.layers[0]
    assert all(bone.is_directed for bone in layer.bones)
    assert opened.import_log.notes[-1] == EARLIER_BONES.format(layers=join_names([layer.name]))
    save_project(tmp_path / "c", opened)
    again = load_project(tmp_path / "c")
    assert again.import_log == opened.import_log
    assert again.layers[0].bones == layer.bones


def test_two_bones_in_one_place_and_wild_stiffnesses_are_refused(tmp_path):
    save_project(tmp_path / "a", clocked_document())
    members = read_members(tmp_path / "a")
    bone = json.loads(members["project.json"])["layers"][0]["bones"][0]
    twice = with_json(members, "layers", 0, "bones", value=[bone, bone | {"ends": [1, 4]}])
    with pytest.raises(LissomError, match=says(DUPLICATE_BONES)):
        load_project(pack(tmp_path / "b", twice))
    (name,) = (name for name in members if name.endswith("stiffness.npy"))
    count = len(clocked_document().layers[0].stiffness)
    for wrong, message in (
        (np.ones(count - 1), "stiffness must be one number for each"),
        (np.full(count, np.nan), "stiffness must be from 1/30"),
        (np.full(count, 1e3), "stiffness must be from 1/30"),
        (np.ones(count + 1), "cut short|too large|one number for each"),
        (np.ones(count, np.float32), "is not an array of type float64"),
    ):
        other = members | {name: array_member(wrong)}
        with pytest.raises(LissomError, match=message):
            load_project(pack(tmp_path / "b", other))
    del members[name]
    with pytest.raises(LissomError, match=r"lacks layers/0/stiffness\.npy"):
        load_project(pack(tmp_path / "b", members))


def test_what_repeats_comes_back_and_is_written_where_it_is_there(tmp_path):
    more = MappingProxyType({"colour": "#123456"})
    cycles = (Cycle(first=0, last=24, until=40, unknown=more), Cycle(first=40, last=48))
    path = tmp_path / "a.lissom"
    save_project(path, altered(disc_document(), cycles=cycles))
    assert load_project(path).layers[0].cycles == cycles
    members = read_members(path)
    apart = with_json(members, "layers", 0, "cycles", 0, "until", value=41)
    with pytest.raises(LissomError, match="repeats of frames 0 to 24 and frames 40 to 48 overl"):
        load_project(pack(tmp_path / "b", apart))
    save_project(path, disc_document())
    assert b'"cycles"' not in read_members(path)["project.json"]


def test_a_spring_without_damping_is_refused_in_a_loop(tmp_path):
    save_project(tmp_path / "a", clocked_document())
    members = read_members(tmp_path / "a")
    undamped = with_json(members, "layers", 0, "springs", 0, "damping", value=0)
    # It swings nowhere as long as it is switched off.
    assert load_project(pack(tmp_path / "b", undamped)).layers[0].springs[0].damping == 0
    swinging = with_json(undamped, "layers", 0, "springs", 0, "enabled", value=True)
    with pytest.raises(LissomError, match="no damping, so its swing never repeats in a loop"):
        load_project(pack(tmp_path / "b", swinging))
    once = with_json(swinging, "loop", value=False)
    assert load_project(pack(tmp_path / "b", once)).layers[0].springs[0].enabled


def test_an_unknown_field_of_a_joint_goes_with_the_joint(tmp_path, members):
    newer = with_json(members, "layers", 0, "attachment", "spring", value=0.5)
    document = load_project(pack(tmp_path / "a", newer))
    save_project(tmp_path / "b", document)
    layers = json.loads(read_members(tmp_path / "b")["project.json"])["layers"]
    assert layers[0]["attachment"]["spring"] == 0.5
    save_project(tmp_path / "b", layer_commands.detach_layer(0, 1.0, 0j)(document))
    assert load_project(tmp_path / "b").layers[0].attachments == ()


def test_unknown_members_are_handed_on_and_never_unpacked(tmp_path, members):
    inner = tmp_path / "inner"
    inner.mkdir()
    strange = {"../escaped.txt": b"x", "/etc/lissom": b"", "C:\\x": b"x", "sound/ü.ogg": b"\0" * 99}
    document = load_project(pack(inner / "a", members | strange | {"folder/": b""}))
    assert document.unknown_members == strange
    assert not differences(replace(document, unknown_members={}), full_document())
    assert sorted(tmp_path.rglob("*")) == [inner, inner / "a"]
    changed = handle_commands.rename_handle(0, 4, "other")(document)
    save_project(inner / "a", changed)
    assert load_project(inner / "a").unknown_members == strange
    assert strange.items() <= read_members(inner / "a").items()


def test_unknown_members_never_take_a_known_one_s_place(tmp_path, members):
    stale = {"layers/0/keys/00003.phi.npy": b"stale", "layers/0/keys/00003.psi.npy": b"stale"}
    document = load_project(pack(tmp_path / "a", members | stale))
    pose = document.layers[0].keys[0].pose
    save_project(tmp_path / "b", key_commands.insert_key(0, 50, pose)(document))
    loaded = load_project(tmp_path / "b")
    assert loaded.unknown_members == {}
    assert loaded.layers[0].keys[3].pose.phi.tobytes() == pose.phi.tobytes()


def test_what_a_map_is_said_to_keep_is_not_believed(tmp_path, members):
    said = {"k": 0.1, "sigma_a": 1.0, "sigma_b": 1.0, "winding": 0, "certified": True}
    forged = with_json(members, "layers", 0, "keys", 1, "certificate", value=said)
    layer = load_project(pack(tmp_path / "a", forged)).layers[0]
    boundary = Boundary.sample(layer.domain)
    assert [key.pose.certificate.is_certified for key in layer.keys] == [True, False, True]
    for key in layer.keys:
        proven = certify(layer.map_of(key.pose), boundary, layer.bounds)
        assert astuple(key.pose.certificate)[:3] == pytest.approx(astuple(proven)[:3], rel=1e-9)
        assert key.pose.certificate.limits == layer.bounds


def test_there_may_be_no_thumbnail(tmp_path):
    save_project(tmp_path / "a", disc_document())
    assert load_thumbnail(tmp_path / "a") is None
    assert load_thumbnail(tmp_path / "missing") is None
    (tmp_path / "b").write_bytes(b"text")
    assert load_thumbnail(tmp_path / "b") is None


def test_a_newer_schema_is_refused_by_its_version(tmp_path, members):
    newer = with_json(with_json(members, "schema", value=7), "app_version", value="9.1")
    with pytest.raises(LissomError, match=says(NEWER_LISSOM, version="9.1", schema=7)):
        load_project(pack(tmp_path / "a", newer))


def test_a_newer_schema_need_have_nothing_else_in_common(tmp_path):
    text = json.dumps({"schema": 8, "app_version": "9.1"}).encode()
    members = {"mimetype": MIMETYPE, "project.json": text}
    with pytest.raises(LissomError, match=says(NEWER_LISSOM)):
        load_project(pack(tmp_path / "a", members))


@pytest.mark.parametrize(
    ("way", "value", "message"),
    [
        (["schema"], 0, "schema 0"),
        (["schema"], "1", says(NOT_WHOLE, where="schema")),
        (["schema"], True, says(NOT_WHOLE, where="schema")),
        (["fps"], "24", says(NOT_NUMBER, where="fps")),
        (["fps"], -1, "frames per second"),
        (["loop"], 1, says(NOT_TRUE_OR_FALSE, where="loop")),
        (["frames"], [0], "frames must be two whole numbers"),
        (["frames"], [0, 5], "outside the animation"),
        (["frames"], [0, 1.5], says(NOT_WHOLE, where="frames")),
        (["preview"], [0, 900], "preview range"),
        (["markers"], {}, says(NOT_LIST, where="markers")),
        (["markers", 0, "name"], " ", "marker needs a name"),
        (["markers", 0, "frame"], 700, "Two markers are at frame 700"),
        (["markers", 0, "frame"], 701, "out of order"),
        (["markers", 1, "frame"], 10**30, "must be at a frame from 0 to"),
        (["layers", 0, "mirror"], 1e9, "axis of mirroring"),
        (["layers", 0, "library", 0, "name"], "über\n", "Two poses have the name"),
        (["layers", 0, "library", 0, "targets"], [], "one target for each handle"),
        (["layers", 0, "anchor"], [0], says(NOT_POINT, where="anchor")),
        (["layers", 0, "anchor"], [0, 0], "anchor at"),
        (["layers", 0, "variant"], "arap", "variant"),
        (["layers", 0, "bounds", "k"], 1.5, says(IMPOSSIBLE_BOUND, name="k")),
        (["layers", 0, "bounds"], [], says(NOT_OBJECT, where="bounds")),
        (["export", "format"], "bmp", "export format"),
        (["export", "size"], [1, 2, 3], "export.size must be two whole numbers"),
        (["layers", 0, "domain", "detail"], "best", "detail"),
        (
            ["layers", 0, "domain", "triangles"],
            1.5,
            says(NOT_WHOLE, where="domain.triangles"),
        ),
        (["layers", 0, "picture", "sha256"], "0" * 64, says(OTHER_CHECKSUM)),
        (["layers", 0, "picture", "suffix"], ".jpg", "lacks layers/0/source.jpg"),
        (["layers", 0, "picture", "suffix"], "/../../x", "lacks layers/0/source"),
        (["layers", 0, "picture", "size"], [0, 5], "The picture must have 1 to"),
        (
            ["layers", 0, "picture", "size"],
            [200, 201],
            "200 × 200 pixels, but the project says 200 × 201",
        ),
        (["layers", 0, "picture", "size"], [10**30, 200], "The picture must have 1 to"),
        (["layers", 0, "id"], -1, "lacks layers/-1"),
        (["layers", 0, "handles"], {}, says(NOT_LIST, where="handles")),
        (["layers", 0, "handles", 0, "name"], 5, says(NOT_TEXT, where="handles[0].name")),
        (["layers", 0, "handles", 0, "id"], 4, "belongs to the handle 1, which does not exist"),
        (["layers", 0, "handles", 0, "position"], [0, 0], "outside the shape"),
        (["layers", 0, "handles", 0, "weight"], 10**400, "finite"),
        (["layers", 0, "next_handle"], 2, "already belongs to a handle"),
        (["layers", 0, "keys"], [], "at least one key"),
        (["layers", 0, "keys", 1, "frame"], 3, says(KEYS_OUT_OF_ORDER, before=3, after=3)),
        (["layers", 0, "keys", 1, "frame"], 2, says(KEYS_OUT_OF_ORDER, before=3, after=2)),
        (["layers", 0, "keys", 1, "revolutions"], 0.5, says(NOT_WHOLE, where="revolutions")),
        (["layers", 0, "keys", 1, "revolutions"], 10**30, "whole turns"),
        (["layers", 0, "keys", 1, "easing"], "bounce", "no easing 'bounce'"),
        (["layers", 0, "keys", 1, "easing"], [0, 0, 2, 0], "easing curve"),
        (["layers", 0, "keys", 1, "targets"], [], "one target for each handle"),
        (["layers", 0, "keys", 1, "targets", 0, "handle"], 4, "two targets for the same handle"),
        (
            ["layers", 0, "keys", 1, "targets", 0, "rotation"],
            "x",
            says(NOT_NUMBER, where="rotation"),
        ),
        (["layers", 0, "keys", 1], 7, says(NOT_OBJECT, where="keys[1]")),
        (["layers", 0, "handles", 0, "depth"], 2, r"from −1 \(behind\) to 1 \(in front\)"),
        (["layers", 0, "handles", 0, "extent"], 0, "extent of handle 'nose'"),
        (["layers", 0, "name"], " ", "needs a name"),
        (["layers", 0, "name"], "parent", "Two layers have the name 'parent'"),
        (["layers", 0, "corner"], [1e9, 0], "corner of 'Körper'"),
        (["layers", 0, "still"], True, "still picture"),
        (["layers", 0, "opacity"], 1.5, "Opacity must be from 0 to 1"),
        (["layers", 0, "channels"], {}, says(NOT_LIST, where="channels")),
        (["layers", 0, "channels", 0, "keys"], {}, says(NOT_LIST, where="channels[0].keys")),
        (["layers", 0, "channels", 0, "keys", 1, "frame"], 0, says(KEYS_OUT_OF_ORDER)),
        (
            ["layers", 0, "channels", 0, "keys", 1, "visible"],
            1,
            says(NOT_TRUE_OR_FALSE, where="layers[0].channels[0].keys[1].visible"),
        ),
        (["layers", 0, "channels", 1, "keys", 0, "depth"], 7, r"from −1 \(behind\) to 1"),
        (["layers", 0, "channels", 1, "part"], 9, "which does not exist"),
        (["layers", 0, "channels", 1, "part"], "4", says(NOT_WHOLE, where="channels[1].part")),
        (["layers", 0, "channels", 2, "part"], 1, says(DUPLICATE_CHANNEL)),
        (["layers", 0, "attachment", "parent"], 7, says(NO_LAYER, identity=7)),
        (["layers", 0, "attachment", "parent"], 0, says(PARENT_CIRCLE)),
        (["layers", 0, "attachment", "parent_point"], [1e9, 0], "A joint must be within"),
        (["layers", 0, "anchor"], None, "attached but has no anchor"),
        (["size"], [0, 5], "The canvas must have 1 to"),
    ],
)
def test_fields_that_make_no_sense_are_named(tmp_path, members, way, value, message):
    broken = with_json(members, *way, value=value)
    with pytest.raises(LissomError, match=message) as raised:
        load_project(pack(tmp_path / "a.lissom", broken))
    assert str(raised.value).startswith(f"cannot open {tmp_path / 'a.lissom'}: ")


@pytest.mark.parametrize(
    ("way", "value", "message"),
    [
        ([], [], says(NOT_OBJECT, where="import_log")),
        (["warnings"], "glow", says(NOT_LIST, where="import_log.warnings")),
        (["notes", 0], 7, says(NOT_TEXT, where="import_log.notes[0]")),
    ],
)
def test_what_was_reported_of_an_import_must_be_lines(tmp_path, way, value, message):
    save_project(tmp_path / "a", clocked_document())
    broken = with_json(read_members(tmp_path / "a"), "import_log", *way, value=value)
    with pytest.raises(LissomError, match=message):
        load_project(pack(tmp_path / "a.lissom", broken))


def test_every_field_is_needed(tmp_path, members):
    def ways(content, way=()):
        for name, value in content.items() if isinstance(content, dict) else enumerate(content):
            if isinstance(content, dict):
                yield (*way, name)
            if isinstance(value, (dict, list)):
                yield from ways(value, (*way, name))

    whole = json.loads(members["project.json"])
    known = json.loads(members["project.json"].replace(b'"nested"', b'"colour"'))
    kept = {"colour", "nested", "list", "tau", "extension", "quality", "visible", "app_version"}
    # What is as usual is not written.
    kept |= {"size", "depth", "extent", "tangent_mode", *LAYER}
    kept |= {"names", "sheet", "shapes"}  # of exports; earlier versions did not write them
    # Of the cut-out, likewise.
    kept |= {"background", "enclosed", "mask", "strokes", "holes", "toggled_holes", "stale"}
    kept |= {"cut_lines", "parted", *CLOCKS}
    # A channel without a known kind is kept as it is.
    kept |= {"sounds", "mouths", "volume", "volume_keys"}
    kept_channels = {"kind", "part", "easing"}
    missing = [
        way
        for way in ways(known)
        if way[-1] not in kept
        and not ({"channels", "sounds"} & {*way} and way[-1] in kept_channels)
    ]
    assert len(missing) > 60
    for way in missing:
        content = json.loads(json.dumps(whole))
        place = content
        for step in way[:-1]:
            place = place[step]
        del place[way[-1]]
        broken = members | {"project.json": json.dumps(content).encode()}
        with pytest.raises(LissomError, match=says(LACKS_FIELD, name=way[-1])):
            load_project(pack(tmp_path / "a", broken))


@pytest.mark.parametrize("text", [b"", b"{", b"\xff\xfe", b"[]", b"null", b"[" * 100_000])
def test_text_that_is_no_object_is_refused(tmp_path, members, text):
    with pytest.raises(LissomError, match=r"project\.json"):
        load_project(pack(tmp_path / "a", members | {"project.json": text}))


@pytest.mark.parametrize(
    ("field", "message"),
    [
        (b'"x": NaN', "contains NaN"),
        (b'"x": -Infinity', "contains -Infinity"),
        (b'"x": 1e999', "contains 1e999"),
        (b'"x": ' + b"[" * 45 + b"]" * 45, "nested deeper than"),
        (b'"x": ' + b'{"x":' * 45 + b"1" + b"}" * 45, "nested deeper than"),
        (b'"x": 1' + b"0" * 5000, "not JSON"),
        (b'"fps": 24', "has the field 'fps' twice"),
    ],
)
def test_what_could_not_be_written_again_is_refused(tmp_path, members, field, message):
    text = members["project.json"].replace(b"{", b"{" + field + b",", 1)
    with pytest.raises(LissomError, match=message):
        load_project(pack(tmp_path / "a", members | {"project.json": text}))


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("layers/0/source.png", b"other", says(OTHER_CHECKSUM)),
        ("layers/0/cage.npy", npy(CAGE[::-1]), says(CAGE_ORDER)),
        ("layers/0/cage.npy", npy(100 + 100j + 0.5 * (CAGE - 100 - 100j)), says(CAGE_TOUCHES)),
        ("layers/0/triangles.npy", npy(MESH.triangles[:, ::-1].copy()), says(MESH_FLAT)),
        ("layers/0/triangles.npy", npy(MESH.triangles[:-1].copy()), says(MESH_UNUSED)),
        ("layers/0/vertices.npy", npy(MESH.vertices + 500), says(MESH_UNFILLED)),
        ("layers/0/vertices.npy", npy(np.full(12, 1e200 + 0j)), says(TOO_FAR)),
        ("layers/0/cage.npy", npy(np.zeros(600, complex)), says(MEMBER_TOO_LARGE)),
        ("layers/0/cage.npy", b"", says(NOT_ARRAY)),
        ("layers/0/cage.npy", npy(np.zeros(12)), says(NOT_ARRAY, dtype="complex128", shape=",")),
        ("layers/0/cage.npy", npy(np.zeros((12, 1), complex)), says(NOT_ARRAY)),
        ("layers/0/cage.npy", npy(np.zeros(12, ">c16")), says(NOT_ARRAY)),
        ("layers/0/cage.npy", npy(np.zeros(12, complex))[:-1], "cut short"),
        ("layers/0/cage.npy", npy(np.zeros(12, complex)) + b"x", "cut short"),
        ("layers/0/cage.npy", npy(np.ones(2, complex)), says(FEW_ENTRIES, at_least=3)),
        ("layers/0/cage.npy", npy(np.ones(11, complex)), says(CAGE_REPEATS)),
        ("layers/0/cage.npy", npy(np.full(12, complex("nan"))), says(NOT_FINITE, name="cage")),
        ("layers/0/outline.npy", npy(np.ones(12, complex)), "outline has the same vertex twice"),
        ("layers/0/outline.npy", npy(np.array([0, 2, 2j, 1 + 2j, 0.5])), "crosses"),
        (
            "layers/0/vertices.npy",
            npy(np.full(12, complex("inf"))),
            says(NOT_FINITE, name="vertices"),
        ),
        (
            "layers/0/triangles.npy",
            npy(np.zeros((1, 2), np.int32)),
            says(NOT_ARRAY, dtype="int32", shape=", 3"),
        ),
        ("layers/0/triangles.npy", npy(np.zeros((1, 3), np.int64)), says(NOT_ARRAY)),
        ("layers/0/triangles.npy", npy(np.zeros((0, 3), np.int32)), says(MESH_SIZE)),
        (
            "layers/0/triangles.npy",
            npy(np.array([[0, 1, 12]], np.int32)),
            says(MESH_CORNERS),
        ),
        (
            "layers/0/triangles.npy",
            npy(np.array([[0, 1, -1]], np.int32)),
            says(MESH_CORNERS),
        ),
        ("layers/0/keys/00002.psi.npy", npy(np.ones(11, complex)), "as many coefficients|cage of"),
        (
            "layers/0/keys/00002.psi.npy",
            npy(np.full(12, complex("nan"))),
            says(NOT_FINITE, name="psi"),
        ),
        ("layers/0/keys/00002.phi.npy", npy(np.array([{}], dtype=object)), says(NOT_ARRAY)),
        ("mimetype", b"application/zip", NO_PROJECT),
        ("mimetype", b"application/epub+zip and more", says(MEMBER_TOO_LARGE)),
    ],
)
def test_members_that_make_no_sense_are_named(tmp_path, members, name, content, message):
    assert name in members
    with pytest.raises(LissomError, match=message):
        load_project(pack(tmp_path / "a", members | {name: content}))


def test_every_member_but_thumbnail_and_sounds_is_needed(tmp_path, members):
    for name in members:
        fewer = {other: content for other, content in members.items() if other != name}
        path = pack(tmp_path / "a", fewer)
        if name == "thumbnail.png":
            assert not differences(load_project(path), full_document())
        elif name.startswith("sounds/"):
            lost = differences(load_project(path), full_document())
            assert lost == ["document.sounds.0.file.data"]
        else:
            with pytest.raises(LissomError, match=f"lacks {name}|{NO_PROJECT}"):
                load_project(path)


def test_a_header_that_claims_a_huge_array_allocates_nothing(tmp_path, members):
    header = npy(np.zeros(12, complex)).replace(b"(12,), }            ", b"(9000000000000,), } ")
    assert b"(9000000000000,)" in header
    tracemalloc.start()
    with pytest.raises(LissomError, match="cut short"):
        load_project(pack(tmp_path / "a", members | {"layers/0/cage.npy": header}))
    assert tracemalloc.get_traced_memory()[1] < 10_000_000
    tracemalloc.stop()


def bomb(path, name, *, declared):
    """A zip whose member unpacks to 100 MB of zeros and declares another size."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(zipfile.ZipInfo("mimetype"), MIMETYPE)
        with archive.open(name, "w") as member:
            for _ in range(100):
                member.write(bytes(1_000_000))
    if declared is not None:
        size = struct.pack("<L", 100_000_000)
        content = path.read_bytes()
        assert content.count(size) == 2
        path.write_bytes(content.replace(size, struct.pack("<L", declared)))


@pytest.mark.parametrize("declared", [None, 1000])
def test_a_bomb_is_not_unpacked(tmp_path, declared):
    bomb(tmp_path / "a", "project.json", declared=declared)
    tracemalloc.start()
    with pytest.raises(
        LissomError, match=says(MEMBER_TOO_LARGE) if declared is None else "damaged|not JSON"
    ):
        load_project(tmp_path / "a")
    assert tracemalloc.get_traced_memory()[1] < 5_000_000
    tracemalloc.stop()


def test_too_many_members_and_members_of_one_name_are_refused(tmp_path, members):
    path = pack(tmp_path / "a", members)
    data = path.read_bytes()
    start, end = data.index(b"PK\1\2"), data.index(b"PK\5\6")
    table = data[start:end] * (65_536 // len(members) + 1)
    closing = struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, 0xFFFF, 0xFFFF, len(table), start, 0)
    path.write_bytes(data[:start] + table + closing)
    with pytest.raises(LissomError, match="members; a project has at most 65,535"):
        load_project(path)
    path = pack(tmp_path / "b", members)
    with zipfile.ZipFile(path, "a") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("project.json", b"{}")
    with pytest.raises(LissomError, match="two members of the same name"):
        load_project(path)


@pytest.mark.parametrize("content", [b"", b"text", b"PK\x05\x06" + bytes(18), b"\x89PNG\r\n\x1a\n"])
def test_other_files_are_no_projects(tmp_path, content):
    (tmp_path / "a").write_bytes(content)
    with pytest.raises(LissomError, match=NO_PROJECT):
        load_project(tmp_path / "a")


def test_another_zip_file_is_no_project(tmp_path, members):
    with pytest.raises(LissomError, match=NO_PROJECT):
        load_project(pack(tmp_path / "a", {"project.json": b"{}", **members}))


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(LissomError, match=r"cannot read .*missing: No such file"):
        load_project(tmp_path / "missing")
    with pytest.raises(LissomError, match="cannot read"):
        load_project(tmp_path)
    with pytest.raises(LissomError, match="cannot write"):
        save_project(tmp_path, disc_document())
    with pytest.raises(LissomError, match=NO_FOLDER.format(folder=tmp_path / "no")):
        save_project(tmp_path / "no" / "a", disc_document())


@pytest.mark.parametrize("count", [60, pytest.param(300, marks=pytest.mark.long)])
def test_no_damage_gets_through(tmp_path, count):
    """Cut, flip or overwrite anywhere: what opens is what was saved, all else is a plain error."""
    path = tmp_path / "a"
    save_project(path, full_document())
    whole = path.read_bytes()
    rng = np.random.default_rng(7)
    refused = 0
    for trial in range(count):
        damaged = bytearray(whole)
        if trial % 3 == 0:
            del damaged[rng.integers(len(whole)) :]
        elif trial % 3 == 1:
            damaged[rng.integers(len(whole))] ^= 1 << rng.integers(8)
        else:
            start = rng.integers(len(whole))
            damaged[start : start + 20] = rng.bytes(20)
        path.write_bytes(damaged)
        try:
            document = load_project(path)
        except LissomError:
            refused += 1
        else:
            found = differences(document, full_document())
            # A project opens without the bytes of a sound, which can be found again.
            lost = [f"document.sounds.{i}.file.data" for i, _ in enumerate(document.sounds)]
            assert set(found) <= set(lost)
            assert all(document.sounds[lost.index(each)].file.data is None for each in found)
    assert refused > 2 * count / 3


def test_a_domain_that_was_parted_comes_back_so_and_needs_what_closes_it(tmp_path):
    whole = full_document()
    (first, second) = whole.layers
    loops = np.concatenate(first.domain.loops)
    slits = (
        CutLine(points=np.array([-5 + 20j, 1 / 3])),
        CutLine(points=np.array([3.0 + 199j, 4, 5]), covered="right", covered_from=1),
    )
    parted = replace(
        first,
        cut_out=replace(first.cut_out, cut_lines=slits),
        domain=replace(first.domain, closed=loops + 0.01),
    )
    document = replace(whole, layers=(parted, second))
    path = tmp_path / "a.lissom"
    save_project(path, document)
    assert not differences(load_project(path), document)
    members = read_members(path)
    name = "layers/0/closed.npy"
    for content, message in (
        (npy(loops[1:]), "closed beside"),
        (npy(loops + 1000.0), "closed beside"),
        (npy(np.full(len(loops), complex("nan"))), "closed beside"),
    ):
        with pytest.raises(LissomError, match=message):
            load_project(pack(tmp_path / "b", members | {name: content}))
    for field, value in (
        ("covered", ["right"]),
        ("covered", ["x", "none"]),
        ("covered_from", [9, 9]),
    ):
        broken = with_json(members, "layers", 0, "domain", field, value=value)
        with pytest.raises(LissomError, match=r"cover"):
            load_project(pack(tmp_path / "b", broken))
    for counts, message in (([2, 2], "slits of a cut-out"), ([4, 1], "at least 2"), (3, "a list")):
        broken = with_json(members, "layers", 0, "domain", "cut_lines", value=counts)
        with pytest.raises(LissomError, match=message):
            load_project(pack(tmp_path / "b", broken))
    for lost in (name, "layers/0/slits.npy"):
        fewer = {other: content for other, content in members.items() if other != lost}
        with pytest.raises(LissomError, match=f"lacks {lost}"):
            load_project(pack(tmp_path / "b", fewer))

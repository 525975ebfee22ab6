from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
from documents import (
    CENTRE,
    PICTURE,
    RADIUS,
    altered,
    differences,
    disc_document,
    disc_domain,
    inside,
    random_pose,
)
from messages import says
from numpy.testing import assert_allclose

from app.document import (
    MARKER,
    Channel,
    channel_commands as channels,
    handle_commands as handles,
    key_commands as keys,
    pose_channel,
    pose_commands as poses,
    scene_commands as settings,
    shape_commands as layers,
)
from app.document.channels.easing import HOLD, LINEAR, PRESETS
from app.document.commands.keys.retime import BAD_TIME_FACTOR, KEYS_COLLIDE, KEYS_MEET
from app.document.commands.scene_commands import KEY_OUTSIDE
from app.document.keyframe import MAX_REVOLUTIONS, Handle, Keyframe, Target
from app.document.layer import NO_HANDLE, NO_KEY, POSE_COUNT, PictureFile
from app.document.model import Document
from app.document.settings import NATURAL, VARIANTS, ExportSettings, FrameRange, Marker, Meshing
from app.errors import LissomError
from engine.arrays import NOT_FINITE
from engine.errors import EngineError
from engine.maps.bounds import Bounds
from engine.maps.certificate import Certificate

POSES = pose_channel(0)
MARKERS = Channel(MARKER)


def animated(*frames: int, count: int = 2, seed: int = 3) -> Document:
    """A document with keys at these frames and `count` handles."""
    rng = np.random.default_rng(seed)
    document = disc_document()
    for _ in range(count):
        document = handles.add_handle(0, inside(rng))(document)
    made = tuple(Keyframe(frame=frame, pose=random_pose(rng, document)) for frame in frames)
    return altered(document, keys=made)


def frames_of(document):
    return [key.frame for key in document.layers[0].keys]


def test_a_new_document_shows_the_picture_as_it_is():
    document = disc_document()
    points = np.array([CENTRE, CENTRE + 40j])
    (key,) = document.layers[0].keys
    assert_allclose(document.layers[0].map_of(key.pose)(points), points, rtol=0, atol=1e-12)
    assert key.pose.certificate.is_certified
    assert document.played_frames == document.frames


def test_adding_a_handle_changes_no_map_and_takes_the_place_where_it_is_now():
    document = animated(0, 10, 30)
    place = CENTRE + 20 - 35j
    grown = handles.add_handle(0, place, name="tail", weight=2.0)(document)
    handle = grown.layers[0].handle(document.layers[0].next_handle)
    assert (handle.name, handle.position, handle.weight) == ("tail", place, 2.0)
    for old, new in zip(document.layers[0].keys, grown.layers[0].keys, strict=True):
        assert new.pose.phi is old.pose.phi
        assert new.pose.psi is old.pose.psi
        expected = document.layers[0].map_of(old.pose)(np.array([place]))[0]
        assert_allclose(new.pose.targets[handle.id].position, expected, rtol=0, atol=1e-12)
        assert new.pose.targets[handle.id].rotation is None
        assert {i: new.pose.targets[i] for i in old.pose.targets} == dict(old.pose.targets)
        assert_allclose(grown.layers[0].target_errors(new.pose)[handle.id], 0.0, rtol=0, atol=1e-10)


def test_handles_may_sit_on_the_outline_itself():
    document = disc_document()
    outline = document.layers[0].domain.outline
    for fraction in (0.0, 0.3, 0.7):
        for place in outline + fraction * (np.roll(outline, -1) - outline):
            assert handles.add_handle(0, complex(place))(document).layers[0].handles


def test_a_variant_may_be_given_by_its_name_in_files():
    document = disc_document()
    for variant in VARIANTS:
        (layer,) = layers.set_variant(0, variant.value)(document).layers
        assert layer.variant is variant
    with pytest.raises(LissomError, match=r"variant must be one of metric, nu, .*not 'wobbly'"):
        layers.set_variant(0, "wobbly")(document)


def test_a_pose_is_proven_for_bounds_that_its_certificate_keeps():
    (layer,) = disc_document().layers
    pose = layer.keys[0].pose
    stretched = Certificate(k=0.3, sigma_a=2.0, sigma_b=0.5, winding=0, is_certified=True)
    for bounds, is_proven in (
        (Bounds(), True),
        (Bounds(k=0.3, sigma_a=2.0, sigma_b=0.5), True),
        (Bounds(k=0.29), False),
        (Bounds(sigma_a=1.9), False),
        (Bounds(sigma_b=0.51), False),
    ):
        bounded = replace(layer, bounds=bounds)
        assert bounded.is_proven(replace(pose, certificate=stretched)) == is_proven
        folded = replace(stretched, is_certified=False)
        assert not bounded.is_proven(replace(pose, certificate=folded))


def test_lags_are_the_distances_from_the_targets():
    document = handles.add_handle(0, CENTRE)(disc_document())
    pose = document.layers[0].keys[0].pose
    pulled = replace(pose, targets={0: Target(position=CENTRE + 3 + 4j)})
    assert_allclose(document.layers[0].target_errors(pulled)[0], 5.0, rtol=0, atol=1e-10)
    assert disc_document().layers[0].target_errors(disc_document().layers[0].keys[0].pose) == {}


def test_names_and_ids_are_never_given_twice():
    document = animated(0)
    assert [handle.name for handle in document.layers[0].handles] == ["handle 1", "handle 2"]
    document = handles.remove_handles(0, {1})(document)
    document = handles.rename_handle(0, 0, "handle 3")(document)
    document = handles.add_handle(0, CENTRE)(document)
    assert [handle.id for handle in document.layers[0].handles] == [0, 2]
    assert document.layers[0].handle(2).name == "handle 4"


def test_removing_a_handle_keeps_the_poses():
    document = animated(0, 10)
    fewer = handles.remove_handles(0, {0})(document)
    assert [handle.id for handle in fewer.layers[0].handles] == [1]
    for old, new in zip(document.layers[0].keys, fewer.layers[0].keys, strict=True):
        assert new.pose.phi is old.pose.phi
        assert dict(new.pose.targets) == {1: old.pose.targets[1]}


def test_moving_a_handle_moves_its_targets_along_the_maps():
    document = animated(0, 10)
    turned = Target(position=CENTRE, rotation=0.5)
    targets = {**document.layers[0].keys[1].pose.targets, 0: turned}
    document = keys.replace_key_pose(
        0, 10, replace(document.layers[0].keys[1].pose, targets=targets)
    )(document)
    moved = handles.move_handle(0, 0, CENTRE + 5)(document)
    assert moved.layers[0].handle(0).position == CENTRE + 5
    expected = document.layers[0].map_of(document.layers[0].keys[1].pose)(np.array([CENTRE + 5]))[0]
    assert_allclose(moved.layers[0].keys[1].pose.targets[0].position, expected, rtol=0, atol=1e-12)
    assert moved.layers[0].keys[1].pose.targets[0].rotation == 0.5
    assert moved.layers[0].keys[1].pose.targets[1] is document.layers[0].keys[1].pose.targets[1]


def test_naming_and_weighing_handles():
    document = animated(0)
    assert handles.rename_handle(0, 1, "Fuß")(document).layers[0].handle(1).name == "Fuß"
    assert handles.set_handle_weight(0, {1}, 3.0)(document).layers[0].handle(1).weight == 3.0


def test_posing_and_inserting_keys():
    document = animated(0, 10)
    pose = random_pose(np.random.default_rng(1), document)
    assert keys.replace_key_pose(0, 10, pose)(document).layers[0].key(10).pose is pose
    document = channels.set_easing({POSES: {0}}, HOLD)(document)
    grown = keys.insert_key(0, 5, pose)(document)
    assert frames_of(grown) == [0, 5, 10]
    assert grown.layers[0].key(5).easing == HOLD
    assert keys.insert_key(0, 15, pose)(document).layers[0].key(15).easing == LINEAR
    eased = keys.insert_key(0, 15, pose, easing=HOLD)(document).layers[0]
    assert [key.easing for key in eased.keys] == [HOLD, HOLD, HOLD]
    chosen = channels.set_easing({POSES: {10}}, PRESETS["in"])(document)
    eased = keys.insert_key(0, 15, pose, easing=HOLD)(chosen).layers[0]
    assert [key.easing for key in eased.keys] == [HOLD, PRESETS["in"], HOLD]
    assert keys.insert_key(0, 70, pose)(document).frames == FrameRange(0, 70)


def test_moving_and_copying_keys():
    document = animated(0, 10, 20)
    assert frames_of(channels.move_keys({POSES: {10, 20}}, 5)(document)) == [0, 15, 25]
    assert frames_of(channels.move_keys({POSES: {10}}, 40)(document)) == [0, 20, 50]
    assert channels.move_keys({POSES: {10}}, 40)(document).frames == FrameRange(0, 50)
    copied = channels.copy_keys({POSES: {0, 10}}, 25)(document)
    assert frames_of(copied) == [0, 10, 20, 25, 35]
    assert copied.layers[0].key(35).pose is document.layers[0].key(10).pose
    # Into each other's places, as they move together.
    assert frames_of(channels.move_keys({POSES: {0, 10, 20}}, 10)(document)) == [10, 20, 30]


def test_deleting_keys():
    document = animated(0, 10, 20)
    assert frames_of(channels.delete_keys({POSES: {0, 20}})(document)) == [10]


def test_reversing_keys_turns_the_motion_round():
    document = animated(0, 10, 30)
    document = channels.set_easing({POSES: {0}}, PRESETS["in"])(document)
    document = channels.set_easing({POSES: {10}}, HOLD)(document)
    document = channels.set_easing({POSES: {30}}, PRESETS["out"])(document)
    document = keys.set_revolutions(0, {10, 30}, 1)(document)
    turned = channels.reverse_keys({POSES: {0, 10, 30}})(document)
    assert [key.revolutions for key in turned.layers[0].keys] == [-1, 0, 1]
    assert frames_of(turned) == [0, 20, 30]
    assert [key.pose for key in turned.layers[0].keys] == [
        key.pose for key in reversed(document.layers[0].keys)
    ]
    assert [key.easing for key in turned.layers[0].keys] == [
        HOLD,
        PRESETS["in"].reversed(),
        PRESETS["out"],
    ]
    twice = channels.reverse_keys({POSES: {0, 20, 30}})(turned)
    assert [(key.frame, key.pose) for key in twice.layers[0].keys] == [
        (key.frame, key.pose) for key in document.layers[0].keys
    ]


def test_scaling_time():
    document = settings.set_preview(FrameRange(2, 30))(animated(4, 10, 20))
    assert frames_of(channels.scale_keys({POSES: {10, 20}}, 1.5)(document)) == [4, 10, 25]
    double = settings.scale_time(2.0)(document)
    assert frames_of(double) == [8, 20, 40]
    assert (double.frames, double.preview) == (FrameRange(0, 96), FrameRange(4, 60))


def test_the_last_key_becomes_the_first():
    document = animated(0, 10, 20)
    closed = keys.match_loop_ends(0)(document)
    assert closed.layers[0].key(20).pose is document.layers[0].key(0).pose
    assert keys.match_loop_ends(0)(closed) is closed


def test_settings():
    document = animated(0, 10)
    assert settings.set_fps(12)(document).fps == 12.0
    assert settings.set_loop(loop=True)(document).loop
    assert layers.set_variant(0, "nu")(document).layers[0].variant == "nu"
    assert layers.set_anchor(0, CENTRE)(document).layers[0].anchor == CENTRE
    assert (
        layers.set_anchor(0, None)(layers.set_anchor(0, CENTRE)(document)).layers[0].anchor is None
    )
    export = ExportSettings(format="gif", size=(64, 32), background="#ffFF00")
    assert settings.set_export(export)(document).export == export
    assert layers.set_limits(0, Bounds(k=0.5))(document).layers[0].bounds.k == 0.5


def set_exported(frames):
    return settings.set_export(ExportSettings(frames=frames))


@pytest.mark.parametrize(
    ("set_range", "range_of"),
    [
        (settings.set_preview, lambda document: document.preview),
        (set_exported, lambda document: document.export.frames),
    ],
)
def test_ranges_of_frames_follow_the_animation(set_range, range_of):
    document = set_range(FrameRange(5, 30))(animated(0, 10))
    assert range_of(settings.set_frames(FrameRange(0, 20))(document)) == FrameRange(5, 20)
    assert range_of(settings.scale_time(0.5)(document)) == FrameRange(3, 15)
    document = set_range(FrameRange(25, 30))(document)
    assert range_of(settings.set_frames(FrameRange(0, 20))(document)) is None


def test_bounds_and_a_new_domain_come_with_solved_poses():
    document = animated(0, 10)
    rng = np.random.default_rng(4)
    poses = [random_pose(rng, document) for _ in range(2)]
    assert [k.pose for k in layers.set_limits(0, Bounds(), poses)(document).layers[0].keys] == poses
    domain = disc_domain(15)
    again = [random_pose(rng, document, domain) for _ in range(2)]
    layer = replace(document.layers[0], unknown={"domain": {"brush": 1}, "kept": 2})
    document = document.with_layer(layer)
    rebuilt = layers.replace_domain(0, domain, Meshing(detail="fine"), again)(document)
    assert rebuilt.layers[0].domain is domain
    assert rebuilt.layers[0].meshing.detail == "fine"
    assert rebuilt.layers[0].handles == document.layers[0].handles
    assert [key.pose for key in rebuilt.layers[0].keys] == again
    assert rebuilt.layers[0].unknown == {"kept": 2}


@pytest.mark.parametrize(
    "command",
    [
        handles.move_handle(0, 0, animated(0).layers[0].handle(0).position),
        handles.remove_handles(0, ()),
        handles.rename_handle(0, 0, "handle 1"),
        handles.set_handle_weight(0, {0}, 1.0),
        channels.move_keys({POSES: {0}}, 0),
        channels.move_keys({POSES: ()}, 4),
        channels.copy_keys({POSES: ()}, 4),
        channels.delete_keys({POSES: ()}),
        channels.reverse_keys({POSES: {10}}),
        channels.reverse_keys({POSES: ()}),
        channels.scale_keys({POSES: ()}, 2.0),
        channels.scale_keys({POSES: {0, 10}}, 1.0),
        channels.scale_keys({POSES: {10}}, 2.0),
        settings.scale_time(1.0),
        channels.set_easing({POSES: {0, 10}}, LINEAR),
        keys.set_revolutions(0, {0, 10}, 0),
        settings.set_fps(24.0),
        settings.set_frames(FrameRange(0, 48)),
        settings.set_preview(None),
        settings.set_loop(loop=False),
        layers.set_variant(0, "metric"),
        layers.set_anchor(0, None),
        settings.set_export(ExportSettings()),
        layers.set_limits(0, NATURAL.bounds),
    ],
)
def test_what_changes_nothing_gives_the_same_document(command):
    document = animated(0, 10)
    assert command(document) is document
    assert command.label


DOCUMENT = animated(0, 10, 20)
POSE = DOCUMENT.layers[0].keys[0].pose
OTHER_CAGE = random_pose(np.random.default_rng(0), DOCUMENT, disc_domain(13))


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (handles.add_handle(0, CENTRE + 2 * RADIUS), "outside the shape"),
        (handles.add_handle(0, complex("nan")), "within 10,000,000 pixels"),
        (handles.add_handle(0, CENTRE, name="handle 1"), "name 'handle 1'"),
        (handles.add_handle(0, CENTRE, name="  "), "needs a name"),
        (handles.add_handle(0, CENTRE, weight=0.0), "weight"),
        (
            handles.add_handle(0, DOCUMENT.layers[0].handles[0].position),
            "are at one place",
        ),
        (handles.move_handle(0, 0, CENTRE - 2 * RADIUS), "outside the shape"),
        (handles.move_handle(0, 7, CENTRE), says(NO_HANDLE, identity=7)),
        (handles.remove_handles(0, {0, 7}), says(NO_HANDLE, identity=7)),
        (handles.rename_handle(0, 7, "x"), says(NO_HANDLE, identity=7)),
        (handles.rename_handle(0, 0, "handle 2"), "name 'handle 2'"),
        (handles.rename_handle(0, 0, ""), "needs a name"),
        (handles.set_handle_weight(0, {0}, float("inf")), "weight"),
        (handles.set_handle_weight(0, {0}, float("nan")), "weight"),
        (keys.replace_key_pose(0, 5, POSE), says(NO_KEY, frame=5)),
        (keys.replace_key_pose(0, 0, replace(POSE, targets={})), "one target for each handle"),
        (
            keys.replace_key_pose(0, 0, OTHER_CAGE),
            "cage of 13 vertices, but the layer's cage has 12",
        ),
        (keys.insert_key(0, 10, POSE), KEYS_COLLIDE.format(frame=10)),
        (keys.insert_key(0, -1, POSE), "key must be at a frame from 0"),
        (keys.insert_key(0, 1_000_000, POSE), "key must be at a frame from 0"),
        (channels.move_keys({POSES: {0, 10}}, 10), KEYS_COLLIDE.format(frame=20)),
        (channels.move_keys({POSES: {0}}, -1), "key must be at a frame from 0"),
        (channels.move_keys({POSES: {3}}, 1), says(NO_KEY, frame=3)),
        (channels.copy_keys({POSES: {0}}, 0), KEYS_COLLIDE.format(frame=0)),
        (channels.copy_keys({POSES: {0}}, 20), KEYS_COLLIDE.format(frame=20)),
        (channels.delete_keys({POSES: {0, 10, 20}}), "at least one key"),
        (channels.delete_keys({POSES: {0, 11}}), says(NO_KEY, frame=11)),
        (channels.reverse_keys({POSES: {0, 11}}), says(NO_KEY, frame=11)),
        (channels.scale_keys({POSES: {0, 10}}, 2.0), KEYS_COLLIDE.format(frame=20)),
        (channels.scale_keys({POSES: {0, 10}}, 0.0), says(BAD_TIME_FACTOR)),
        (channels.scale_keys({POSES: {0, 10}}, float("nan")), says(BAD_TIME_FACTOR)),
        (settings.scale_time(0.01), says(KEYS_MEET, one=0, other=10, frame=0)),
        (settings.scale_time(-1.0), says(BAD_TIME_FACTOR)),
        (keys.match_loop_ends(0), None),
        (channels.set_easing({POSES: {5}}, LINEAR), says(NO_KEY, frame=5)),
        (settings.set_fps(0.0), "frames per second"),
        (settings.set_fps(float("nan")), "frames per second"),
        (settings.set_frames(FrameRange(0, 15)), says(KEY_OUTSIDE, frame=20)),
        (settings.set_preview(FrameRange(3, 49)), "preview range"),
        (layers.set_variant(0, "arap"), "variant"),
        (layers.set_anchor(0, CENTRE + 2 * RADIUS), "The anchor"),
        (layers.set_anchor(0, complex("inf")), "anchor must be within"),
        (settings.add_marker(-1), "key must be at a frame from 0"),
        (channels.delete_keys({MARKERS: {3}}), says(NO_KEY, frame=3)),
        (poses.delete_pose(0, "bow"), "no pose 'bow'"),
        (poses.save_pose(0, POSE, "  "), "needs a name"),
        (poses.save_pose(0, OTHER_CAGE, "bow"), "cage of 13"),
        (layers.set_limits(0, Bounds(), [POSE]), says(POSE_COUNT, count=3, given=1)),
        (layers.replace_domain(0, disc_domain(13), Meshing(), [POSE] * 3), "cage of 12"),
        (
            layers.replace_domain(0, disc_domain(13), Meshing(), [OTHER_CAGE]),
            says(POSE_COUNT, count=3, given=1),
        ),
    ],
)
def test_what_is_not_possible_says_why(command, message):
    document = keys.match_loop_ends(0)(DOCUMENT) if message is None else DOCUMENT
    if message is None:
        document, message = channels.delete_keys({POSES: {0, 10}})(document), "needs two keys"
    with pytest.raises(LissomError, match=message):
        command(document)


def test_a_domain_that_loses_a_handle_is_refused_by_the_handle_s_name():
    document = handles.add_handle(0, CENTRE + 0.95 * RADIUS, name="ear")(disc_document())
    small = disc_domain()
    half = replace(small, outline=CENTRE + (small.outline - CENTRE) / 2)
    with pytest.raises(LissomError, match="handle 'ear'"):
        layers.replace_domain(0, half, Meshing(), [document.layers[0].keys[0].pose])(document)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PictureFile(data=b"", suffix=".png", size=(1, 1)), "empty"),
        (lambda: PictureFile(data=b"x", suffix="/../x", size=(1, 1)), "file name"),
        (lambda: PictureFile(data=b"x", suffix=".png", size=(0, 1)), "The picture must have 1 to"),
        (
            lambda: PictureFile(data=b"x", suffix=".png", size=(1, 70_000)),
            "The picture must have 1 to",
        ),
        (lambda: FrameRange(5, 4), "not a valid range"),
        (lambda: FrameRange(-1, 4), "not a valid range"),
        (lambda: FrameRange(0, 1_000_000), "not a valid range"),
        (lambda: ExportSettings(format="bmp"), "export format"),
        (lambda: ExportSettings(size=(0, 5)), "The export must have 1 to .*, not 0 × 5"),
        (lambda: ExportSettings(background="red"), "background"),
        (lambda: ExportSettings(background="#12345"), "background"),
        (lambda: ExportSettings(background="#123456\n"), "background"),
        (lambda: ExportSettings(framing="zoom"), "framing"),
        (lambda: Meshing(detail="best"), "detail"),
        (lambda: Meshing(triangles=0), "triangles"),
        (lambda: Meshing(triangles=10**30), "triangles"),
        (lambda: Handle(id=-1, name="x", position=0j), "A handle must have an id from 0 to"),
        (lambda: Handle(id=0, name="x", position=0j, weight=float("nan")), "weight"),
        (lambda: Handle(id=0, name="x", position=0j, weight=1e300), "weight"),
        (lambda: Target(position=complex(0, float("inf"))), "within 10,000,000 pixels"),
        (lambda: Target(position=2e7 - 5j), r"within 10,000,000 pixels, not at \(2e\+07, -5\)"),
        (lambda: Target(position=complex(1e300, 0)), "within 10,000,000 pixels"),
        (lambda: Target(position=complex(float("nan"), 0)), "within 10,000,000 pixels"),
        (lambda: Target(position=complex(0, float("nan"))), "within 10,000,000 pixels"),
        (
            lambda: replace(DOCUMENT.layers[0].keys[0], revolutions=MAX_REVOLUTIONS + 1),
            "whole turns",
        ),
        (lambda: replace(DOCUMENT.layers[0].keys[0], revolutions=-(10**30)), "whole turns"),
        (lambda: Target(position=0j, rotation=float("nan")), "rotation"),
        (lambda: altered(DOCUMENT, keys=()), "at least one key"),
        (lambda: altered(DOCUMENT, keys=DOCUMENT.layers[0].keys[::-1]), "out of order"),
        (
            lambda: altered(DOCUMENT, keys=DOCUMENT.layers[0].keys[:1] * 2),
            "keys at frames 0 and 0 are out of order",
        ),
        (lambda: altered(DOCUMENT, next_handle=1), "already belongs to a handle"),
        (lambda: altered(DOCUMENT, frames=FrameRange(0, 19)), "outside the animation"),
        (
            lambda: altered(DOCUMENT, handles=DOCUMENT.layers[0].handles * 2),
            "Two handles have the id",
        ),
    ],
)
def test_values_that_make_no_sense_are_refused(make, message):
    with pytest.raises(LissomError, match=message):
        make()


def test_coefficients_must_be_finite():
    broken = np.array(POSE.phi)
    broken[3] = np.nan
    with pytest.raises(EngineError, match=says(NOT_FINITE, name="phi")):
        replace(POSE, phi=broken)


def test_nothing_in_a_document_can_be_written_to():
    pose = DOCUMENT.layers[0].keys[0].pose
    for array in (pose.phi, pose.psi, DOCUMENT.layers[0].domain.mesh.triangles):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(TypeError):
        pose.targets[0] = Target(position=0j)
    with pytest.raises(FrozenInstanceError):
        DOCUMENT.fps = 3.0


def test_targets_do_not_follow_the_caller_s_mapping():
    targets = dict(POSE.targets)
    pose = replace(POSE, targets=targets)
    targets.clear()
    assert not differences(pose, POSE)


def test_two_pictures_of_one_content_have_one_hash():
    again = PictureFile(data=PICTURE.data, suffix=".png", size=(200, 200))
    assert again.sha256 == PICTURE.sha256
    assert len(PICTURE.sha256) == 64


def test_markers_stay_in_order_and_apart():
    document = settings.add_marker(20)(settings.add_marker(6, "beat")(disc_document()))
    assert [(m.frame, m.name) for m in document.markers] == [(6, "beat"), (20, "Marker 2")]
    moved = channels.move_keys({MARKERS: {6}}, 24)(settings.rename_marker(20, "end")(document))
    assert [(m.frame, m.name) for m in moved.markers] == [(20, "end"), (30, "beat")]
    with pytest.raises(LissomError, match=says(KEYS_COLLIDE, frame=30)):
        channels.move_keys({MARKERS: {20}}, 10)(moved)
    assert channels.delete_keys({MARKERS: {20}})(moved).markers == (Marker(frame=30, name="beat"),)
    assert [m.frame for m in settings.scale_time(2.0)(moved).markers] == [40, 60]
    assert channels.move_keys({MARKERS: {6}}, 0)(document) is document


def test_poses_of_the_library_follow_handles_as_keys_do():
    document = animated(0, 10)
    pose = document.layers[0].keys[1].pose
    document = poses.save_pose(0, pose, "bow")(poses.save_pose(0, pose)(document))
    assert [kept.name for kept in document.layers[0].library] == ["Pose 1", "bow"]
    place = CENTRE + 20 - 35j
    for command in (
        handles.add_handle(0, place),
        handles.move_handle(0, 0, CENTRE + 5),
        handles.remove_handles(0, {1}),
    ):
        document = command(document)
        (layer,) = document.layers
        assert layer.library_pose("bow").pose.targets == layer.keys[1].pose.targets
    renamed = poses.rename_pose(0, "bow", "low bow")(document)
    with pytest.raises(LissomError, match="Two poses have the name 'Pose 1'"):
        poses.rename_pose(0, "low bow", "Pose 1")(renamed)
    assert [k.name for k in poses.delete_pose(0, "Pose 1")(renamed).layers[0].library] == [
        "low bow"
    ]


def test_the_axis_of_mirroring_is_in_the_middle_until_it_is_moved():
    document = disc_document()
    assert document.layers[0].axis == pytest.approx(CENTRE.real)
    for name, place in (("paw.L", CENTRE - 40), ("paw.R", CENTRE + 60), ("tail", CENTRE + 80)):
        document = handles.add_handle(0, place, name=name)(document)
    assert document.layers[0].axis == CENTRE.real + 10
    assert poses.set_mirror(0, 7.0)(document).layers[0].axis == 7.0

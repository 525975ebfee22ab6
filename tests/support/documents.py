"""Documents, random commands on them, and exact comparison, shared by the tests."""

import dataclasses
import hashlib
import struct
from collections.abc import Mapping
from math import inf, tau
from types import MappingProxyType

import numpy as np
from pictures import blank_png
from shapes import regular_polygon

from app.cut_out import CutOut, Mask, Stroke
from app.document import (
    CAMERA,
    DEPTH,
    DRAW_ORDER,
    MARKER,
    OPACITY,
    SLIDER,
    SWITCH,
    TRACK,
    TRANSFORM,
    VISIBILITY,
    VOLUME,
    Camera,
    Channel,
    Cue,
    DrawOrder,
    Mouths,
    Slider,
    SliderPose,
    Sound,
    SoundFile,
    Transform,
    VolumeKeys,
    channel_commands,
    pose_channel,
    slider_commands,
)
from app.document.channels.easing import HOLD, LINEAR, PRESETS, Easing
from app.document.channels.springs import Spring
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import Track, TrackKey
from app.document.checks import Unknown
from app.document.commands import (
    handle_commands,
    pose_commands,
    scene_commands,
    shape_commands,
    stiffness_commands,
)
from app.document.commands.command import Command
from app.document.commands.keys import (
    key_commands,
    track_commands,
)
from app.document.commands.layers import layer_commands, switch_group_commands
from app.document.keyframe import Handle, Keyframe, LibraryPose, Pose, Target
from app.document.layer import PictureFile, new_layer
from app.document.layers.attachments import Attachment
from app.document.layers.groups import Group
from app.document.model import Document
from app.document.rig.chains import Bone
from app.document.settings import FRAMINGS, VARIANTS, ExportSettings, FrameRange, Marker, Meshing
from app.errors import ImportLog
from app.export_formats import EXPORT_FORMATS, MeshOptions, SpriteSheetOptions
from engine.domain.build import MeshedDomain
from engine.domain.meshing.mesh import Mesh
from engine.maps.bounds import Bounds
from engine.maps.certificate import Certificate

RADIUS = 90.0
CENTRE = 100 + 100j
PICTURE = PictureFile(data=blank_png(200, 200), suffix=".png", size=(200, 200))


def disc_domain(n: int = 12) -> MeshedDomain:
    """A disc around the middle of the picture, as a fan of triangles."""
    outline = CENTRE + RADIUS * regular_polygon(n)
    fan = [[0, i, i + 1] for i in range(1, n - 1)]
    mesh = Mesh(vertices=outline, triangles=np.array(fan, dtype=np.int32))
    return MeshedDomain(outline=outline, cage=CENTRE + 1.2 * RADIUS * regular_polygon(n), mesh=mesh)


def disc_document(n: int = 12) -> Document:
    """A new document: one layer with one key and no handles."""
    return Document(layers=(new_layer(PICTURE, disc_domain(n), Meshing()),))


def altered(document: Document, **changes: object) -> Document:
    """The document with other values in fields of its own, or of its one layer."""
    (layer,) = document.layers
    own = {field.name for field in dataclasses.fields(Document)} - {"unknown"}
    scene = {name: value for name, value in changes.items() if name in own}
    rest = {name: value for name, value in changes.items() if name not in own}
    layers = (dataclasses.replace(layer, **rest),) if rest else document.layers
    return dataclasses.replace(document, **{"layers": layers, **scene})


def inside(rng: np.random.Generator) -> complex:
    """A random point of the disc."""
    return CENTRE + complex(0.9 * RADIUS * np.sqrt(rng.random()) * np.exp(1j * tau * rng.random()))


def random_pose(
    rng: np.random.Generator, document: Document, domain: MeshedDomain | None = None
) -> Pose:
    cage = document.layers[0].domain.cage if domain is None else domain.cage
    noise = rng.normal(size=(4, len(cage)))
    return Pose(
        targets={
            handle.id: Target(
                position=inside(rng), rotation=rng.normal() if rng.random() < 0.3 else None
            )
            for handle in document.layers[0].handles
        },
        phi=cage * np.exp(1j * rng.normal()) + noise[0] + 1j * noise[1],
        psi=noise[2] + 1j * noise[3],
        certificate=Certificate(
            k=float(rng.choice([rng.random(), inf])),
            sigma_a=1 + rng.random(),
            sigma_b=float(rng.choice([rng.random(), -inf])),
            winding=rng.choice([0, 1, None]),
            is_certified=bool(rng.integers(2)),
        ),
    )


def random_command(rng: np.random.Generator, document: Document) -> Command:
    """One of all commands; some are not possible on the document."""
    makers = (
        _random_handle_command,
        _random_key_command,
        _random_choice_command,
        _random_layer_command,
        _random_material_command,
        _random_pose_command,
        _random_settings_command,
        _random_slider_command,
        _random_track_command,
    )
    return makers[rng.integers(len(makers))](rng, document)


def _random_layer_command(rng: np.random.Generator, document: Document) -> Command:
    layers = document.layers
    layer = layers[rng.integers(len(layers))]
    other = layers[rng.integers(len(layers))]
    joint = Attachment(
        parent=other.id,
        parent_point=inside(rng),
        inherits_rotation=bool(rng.integers(2)),
        rest_rotation=rng.random(),
    )
    copy = dataclasses.replace(layer, id=layer_commands.next_layer_id(document), corner=inside(rng))
    turn = complex(np.exp(1j * rng.normal()))
    flag, to = bool(rng.integers(2)), int(rng.integers(50))
    shown = layer.keys_of(VISIBILITY)[0].frame if layer.keys_of(VISIBILITY) else 3
    commands = [
        layer_commands.duplicate_layer(layer.id),
        layer_commands.add_layer(copy),
        layer_commands.add_layer(copy, 0),
        layer_commands.remove_layer(max(each.id for each in layers)),
        layer_commands.move_layer(layer.id, int(rng.integers(len(layers) + 1))),
        layer_commands.rename_layer(layer.id, f"layer {rng.integers(4)}"),
        layer_commands.set_opacity(layer.id, rng.random()),
        layer_commands.set_hidden(layer.id, hidden=flag),
        layer_commands.set_locked(layer.id, locked=flag),
        layer_commands.set_reference(layer.id, reference=flag),
        layer_commands.key_visibility(layer.id, int(rng.integers(50)), visible=flag),
        channel_commands.delete_keys({Channel(VISIBILITY, layer.id): {int(rng.integers(50))}}),
        channel_commands.move_keys({Channel(VISIBILITY, layer.id): {shown}}, to - shown),
        layer_commands.attach_layer(layer.id, inside(rng), joint),
        layer_commands.detach_layer(layer.id, turn, inside(rng)),
    ]
    if layer.handles:
        handle = layer.handles[rng.integers(len(layer.handles))].id
        frame = layer.keys[rng.integers(len(layer.keys))].frame
        commands += [
            layer_commands.set_depth(layer.id, handle, rng.uniform(-1, 1), None),
            layer_commands.set_depth(layer.id, handle, 0.5, 10 * rng.random() + 1),
            channel_commands.set_key(Channel(DEPTH, layer.id, handle), frame, rng.uniform(-1, 1)),
            channel_commands.delete_keys({Channel(DEPTH, layer.id, handle): {frame}}),
        ]
    return commands[rng.integers(len(commands))]


def _random_slider_command(rng: np.random.Generator, document: Document) -> Command:
    name, other = (f"slider {number}" for number in rng.integers(3, size=2))
    places = rng.permutation(4)[:2].tolist()
    poses = tuple(SliderPose(at=complex(at), pose=None) for at in sorted(places))
    slider = Slider(name=name, poses=poses, value=complex(rng.random()))
    at, frame = complex(rng.integers(4)), int(rng.integers(50))
    commands = [
        slider_commands.add_slider(0, slider),
        slider_commands.change_slider(0, other, slider),
        slider_commands.set_slider_value(0, name, complex(rng.random())),
        slider_commands.set_slider_pose(0, name, at, random_pose(rng, document)),
        slider_commands.delete_slider(0, name),
        channel_commands.set_key(Channel(SLIDER, 0, name), frame, complex(rng.random())),
        channel_commands.delete_keys({Channel(SLIDER, 0, name): {frame}}),
    ]
    return commands[rng.integers(len(commands))]


def _random_choice_command(rng: np.random.Generator, document: Document) -> Command:
    ids = [layer.id for layer in document.layers]
    identity, frame, to = ids[rng.integers(len(ids))], *(int(at) for at in rng.integers(50, size=2))
    choice = document.switch_groups[0] if document.switch_groups else None
    name = choice.name if choice else "none"
    turn = choice.keys[0].frame if choice and choice.keys else frame
    commands = [
        switch_group_commands.create_switch_group(
            f"choice {rng.integers(3)}", ids[: 2 + int(rng.integers(2))]
        ),
        switch_group_commands.create_switch_group("two", rng.permutation(ids)[:2].tolist()),
        switch_group_commands.choose_at(identity, frame),
        channel_commands.delete_keys({Channel(SWITCH, part=name): {turn}}),
        channel_commands.move_keys({Channel(SWITCH, part=name): {turn}}, to - turn),
        switch_group_commands.rename_switch_group(name, f"choice {rng.integers(3)}"),
        switch_group_commands.add_to_switch_group(name, [identity]),
        switch_group_commands.remove_from_switch_group(identity),
        switch_group_commands.delete_switch_group(name),
    ]
    return commands[rng.integers(len(commands))]


def _random_handle_command(rng: np.random.Generator, document: Document) -> Command:
    commands = [
        handle_commands.add_handle(0, inside(rng), weight=1 + rng.random()),
        handle_commands.add_handle(0, inside(rng), name=f"é {rng.integers(4)}"),
        handle_commands.add_handle(0, CENTRE + 2 * RADIUS),
    ]
    if document.layers[0].handles:
        handle = document.layers[0].handles[rng.integers(len(document.layers[0].handles))]
        commands += [
            handle_commands.move_handle(0, handle.id, inside(rng)),
            handle_commands.rename_handle(0, handle.id, f"name {rng.integers(3)}"),
            handle_commands.set_handle_weight(0, {handle.id}, float(rng.integers(1, 3))),
            handle_commands.remove_handles(0, {handle.id}),
            handle_commands.lock_handles(0, {handle.id}, locked=bool(rng.integers(2))),
            handle_commands.group_handles(0, {handle.id}, ("", "arms", "é")[rng.integers(3)]),
            handle_commands.unpin_handles(0, {handle.id}, free=bool(rng.integers(2))),
        ]
    return commands[rng.integers(len(commands))]


def _random_key_command(rng: np.random.Generator, document: Document) -> Command:
    count = rng.integers(1, len(document.layers[0].keys) + 1)
    frames = [
        key.frame for key in rng.choice(np.array(document.layers[0].keys), count, replace=False)
    ]
    by = int(rng.integers(-8, 9))
    easing = [*PRESETS.values(), Easing(tuple(rng.random(4).tolist()))][rng.integers(6)]
    pose = random_pose(rng, document)
    commands = [
        key_commands.replace_key_pose(0, frames[0], pose),
        key_commands.insert_key(0, int(rng.integers(80)), pose),
        key_commands.insert_key(0, int(rng.integers(80)), pose, easing=easing),
        channel_commands.move_keys({pose_channel(0): frames}, by),
        channel_commands.copy_keys({pose_channel(0): frames}, by),
        channel_commands.delete_keys({pose_channel(0): frames}),
        channel_commands.reverse_keys({pose_channel(0): frames}),
        channel_commands.insert_keys(
            {pose_channel(0): [document.layers[0].key(frame) for frame in frames]}
        ),
        key_commands.insert_pose(0, int(rng.integers(80)), pose, easing),
        channel_commands.scale_keys(
            {pose_channel(0): frames}, float(rng.choice([0.5, 1.0, 1.5, 2.0]))
        ),
        scene_commands.scale_time(float(rng.choice([0.5, 1.0, 1.5, 2.0]))),
        key_commands.match_loop_ends(0),
        channel_commands.set_easing({pose_channel(0): frames}, easing),
        key_commands.set_revolutions(0, frames, int(rng.integers(-1, 2))),
        channel_commands.set_tangent_mode(
            {pose_channel(0): frames}, TangentMode(rng.choice(list(TangentMode)))
        ),
    ]
    return commands[rng.integers(len(commands))]


def random_track(rng: np.random.Generator, handles: tuple[int, ...]) -> Track:
    frames = np.sort(rng.choice(60, rng.integers(1, 6), replace=False)).tolist()
    return Track(
        handles=handles,
        is_scene_space=bool(rng.integers(2)),
        keys=tuple(
            TrackKey(
                frame=frame,
                place=inside(rng),
                turn=float(rng.choice([0.0, rng.normal()])),
                easing=rng.choice(np.array([*PRESETS.values()], object)),
                tangent_mode=TangentMode(rng.choice(["through", "corner", "stop"])),
                velocity=rng.choice([None, inside(rng) / 9]),
            )
            for frame in frames
        ),
        delay=int(rng.integers(6)),
        reach=float(rng.choice([1.0, rng.random()])),
        keys_rotation=bool(rng.integers(2)),
        enabled=bool(rng.integers(2)),
    )


def random_spring(rng: np.random.Generator, handle: int) -> Spring:
    return Spring(
        handle=handle,
        frequency=0.1 + 5 * rng.random(),
        damping=float(rng.choice([0.0, rng.random()])),
        lag=float(rng.integers(3)),
        strength=float(rng.choice([1.0, rng.random()])),
        stretch=float(rng.choice([0.0, rng.random()])),
        enabled=bool(rng.integers(2)),
    )


def _random_track_command(rng: np.random.Generator, document: Document) -> Command:
    layer = document.layers[0]
    ids = [handle.id for handle in layer.handles] or [99]
    one, other = rng.choice(ids, 2).tolist()
    some = tuple(rng.permutation(ids)[: rng.integers(1, 4)].tolist())
    track = layer.track_of(one) or random_track(rng, some)
    every = [key.frame for key in track.keys]
    frames = rng.choice(every, rng.integers(1, len(every) + 1), replace=False).tolist()
    by, factor = int(rng.integers(-8, 9)), float(rng.choice([0.5, 1.0, 1.5, 2.0]))
    places = [inside(rng) for _ in every]
    flag = bool(rng.integers(2))
    commands = [
        *3 * [track_commands.put_track(0, random_track(rng, some))],
        *2 * [track_commands.put_spring(0, random_spring(rng, one))],
        track_commands.put_track_key(0, one, int(rng.integers(60)), inside(rng), planted=flag),
        track_commands.put_track_key(0, one, every[0], inside(rng), turn=rng.normal()),
        channel_commands.insert_keys({Channel(TRACK, 0, one): random_track(rng, (one,)).keys}),
        channel_commands.move_keys({Channel(TRACK, 0, one): frames}, by),
        channel_commands.copy_keys({Channel(TRACK, 0, one): frames}, by),
        channel_commands.delete_keys({Channel(TRACK, 0, one): frames}),
        channel_commands.reverse_keys({Channel(TRACK, 0, one): frames}),
        channel_commands.scale_keys({Channel(TRACK, 0, one): frames}, factor),
        channel_commands.set_easing(
            {Channel(TRACK, 0, one): frames}, PRESETS["in"] if flag else LINEAR
        ),
        channel_commands.set_tangent_mode(
            {Channel(TRACK, 0, one): frames}, TangentMode(rng.choice(list(TangentMode)))
        ),
        track_commands.set_delay(0, one, int(rng.integers(50))),
        track_commands.set_reach(0, one, rng.random()),
        track_commands.set_turning(0, one, turns=flag),
        track_commands.enable_track(0, one, enabled=flag),
        track_commands.plant_track(0, one, places, planted=flag),
        track_commands.set_track_handles(0, one, some),
        track_commands.copy_track(0, one, other),
        track_commands.mirror_track(0, one),
        track_commands.remove_tracks(0, {one}),
        track_commands.remove_springs(0, {one}),
    ]
    return commands[rng.integers(len(commands))]


def _random_material_command(rng: np.random.Generator, document: Document) -> Command:
    layer = document.layers[0]
    ids = [handle.id for handle in layer.handles] or [99]
    ends = tuple(rng.choice(ids, 2).tolist())
    amount = float(np.exp(rng.uniform(-3, 4)))
    way = [inside(rng) for _ in range(3)]
    commands = [
        *2
        * [
            stiffness_commands.paint_stiffness(
                0, way, radius=60.0, amount=amount, softness=rng.random()
            )
        ],
        *2 * [stiffness_commands.add_bone(0, ends, amount)],
        stiffness_commands.set_bone_stiffness(0, ends, amount),
        stiffness_commands.remove_bone(0, ends),
        stiffness_commands.set_bones_visible(0, shown=bool(rng.integers(2))),
        stiffness_commands.clear_stiffness(0),
        stiffness_commands.mirror_stiffness(0),
    ]
    return commands[rng.integers(len(commands))]


def _random_pose_command(rng: np.random.Generator, document: Document) -> Command:
    pose = random_pose(rng, document)
    commands = [
        pose_commands.save_pose(0, pose),
        pose_commands.save_pose(0, document.layers[0].keys[0].pose, f"é {rng.integers(3)}"),
        pose_commands.set_mirror(0, None if rng.random() < 0.3 else 200 * rng.random()),
    ]
    if document.layers[0].library:
        kept = document.layers[0].library[rng.integers(len(document.layers[0].library))]
        commands += [
            pose_commands.rename_pose(0, kept.name, f"name {rng.integers(3)}"),
            pose_commands.delete_pose(0, kept.name),
        ]
    return commands[rng.integers(len(commands))]


def _random_settings_command(rng: np.random.Generator, document: Document) -> Command:
    frames = FrameRange(int(rng.integers(4)), int(rng.integers(4, 90)))
    poses = [random_pose(rng, document) for _ in document.layers[0].poses]
    bounds = Bounds(k=0.5 + rng.random() / 3)
    domain = disc_domain(int(rng.integers(10, 16)))
    again = [random_pose(rng, document, domain) for _ in document.layers[0].poses]
    at = document.markers[0].frame if document.markers else 7
    commands = [
        scene_commands.set_fps(float(rng.choice([12, 23.976, 60]))),
        scene_commands.set_frames(frames),
        scene_commands.set_preview(None if rng.random() < 0.5 else frames),
        scene_commands.add_marker(int(rng.integers(90)), [None, "beat"][rng.integers(2)]),
        scene_commands.rename_marker(at, f"ü {rng.integers(3)}"),
        channel_commands.move_keys({Channel(MARKER): {at}}, int(rng.integers(90)) - at),
        channel_commands.delete_keys({Channel(MARKER): {at}}),
        scene_commands.set_loop(loop=bool(rng.integers(2))),
        *_camera_commands(rng, document),
        scene_commands.set_mirror_names((("near", "far"), (f"é {rng.integers(3)}", "B"))),
        shape_commands.set_variant(0, VARIANTS[rng.integers(len(VARIANTS))]),
        shape_commands.set_auto_pins(0, enabled=bool(rng.integers(2))),
        shape_commands.set_anchor(0, None if rng.random() < 0.3 else inside(rng)),
        scene_commands.set_export(_random_export(rng)),
        shape_commands.set_limits(0, bounds),
        shape_commands.set_limits(0, bounds, poses),
        shape_commands.replace_domain(0, domain, Meshing(detail="fine"), again),
        shape_commands.cut_with_brush(0, _random_stroke(rng)),
        shape_commands.set_cut_out(0, CutOut(tolerance=int(rng.integers(5)))),
    ]
    return commands[rng.integers(len(commands))]


def _camera_commands(rng: np.random.Generator, document: Document) -> list[Command]:
    frame, to = (int(at) for at in rng.integers(50, size=2))
    at = document.camera[0].frame if document.camera else frame
    faded, moved = document.layer(0).keys_of(OPACITY), document.layer(0).keys_of(TRANSFORM)
    other = int(rng.integers(len(document.layers)))
    camera = Camera(centre=inside(rng), zoom=rng.uniform(0.1, 9), turn=rng.normal())
    return [
        channel_commands.set_key(Channel(CAMERA), frame, camera),
        channel_commands.move_keys({Channel(CAMERA): {at}}, to - at),
        channel_commands.delete_keys({Channel(CAMERA): {at}}),
        channel_commands.set_key(Channel(OPACITY, 0), frame, rng.random()),
        channel_commands.delete_keys({Channel(OPACITY, 0): {faded[0].frame if faded else frame}}),
        channel_commands.set_key(
            Channel(TRANSFORM, 0), frame, Transform(inside(rng), rng.normal())
        ),
        channel_commands.delete_keys({Channel(TRANSFORM, 0): {moved[0].frame if moved else frame}}),
        channel_commands.set_key(
            Channel(DRAW_ORDER, 0), frame, DrawOrder(other, bool(rng.integers(2)))
        ),
        channel_commands.delete_keys({Channel(DRAW_ORDER, 0): {frame}}),
    ]


def _random_stroke(rng: np.random.Generator) -> Stroke:
    way = np.array([inside(rng) for _ in range(rng.integers(1, 5))])
    return Stroke(points=way, radius=float(rng.uniform(1, 30)), keeps=bool(rng.integers(2)))


def _random_export(rng: np.random.Generator) -> ExportSettings:
    first, second = (tuple(EXPORT_FORMATS)[i] for i in rng.integers(len(EXPORT_FORMATS), size=2))
    settings = ExportSettings(
        format=first,
        size=None if rng.random() < 0.5 else (int(rng.integers(1, 5000)), 1080),
        background=["transparent", "#12aBef"][rng.integers(2)],
        framing=FRAMINGS[rng.integers(2)],
        frames=None if rng.random() < 0.5 else FrameRange(2, int(rng.integers(2, 50))),
        names=["frame_####", "{name} ##é"][rng.integers(2)],
        sheet=SpriteSheetOptions(
            trimmed=bool(rng.integers(2)),
            padding=int(rng.integers(9)),
            power_of_two=bool(rng.integers(2)),
        ),
        shapes=MeshOptions(
            triangles=int(rng.integers(100, 9999)), tolerance=[None, 0.1][rng.integers(2)]
        ),
    )
    return settings.in_format(second)


def hand_made_cut_out() -> CutOut:
    """A cut-out with something other than the default in every field."""
    kept = np.random.default_rng(0).random((200, 200)) < 0.5
    return CutOut(
        tolerance=7,
        background=(250, 0, 3),
        enclosed="remove",
        mask=Mask.of(kept),
        strokes=(
            Stroke(points=np.array([10 + 20j, 1 / 3 + 0j]), radius=2.5, keeps=True),
            Stroke(points=np.array([-5.0 + 199j]), radius=40.0, keeps=False),
        ),
        holes="keep",
        toggled_holes=(100 + 1 / 3j, 3j),
    )


def full_sound(unknown: Unknown) -> Sound:
    """A sound with something other than the default in every field; its bytes are no sound."""
    data = b"RIFF and more"
    return Sound(
        name="talk",
        file=SoundFile(
            name="talk.wav",
            sha256=hashlib.sha256(data).hexdigest(),
            size=len(data),
            rate=44_100,
            channels=2,
            samples=90_000,
            data=data,
        ),
        start=-3.25,
        skip=0.1,
        length=1 / 3,
        volume=0.7,
        keys=(VOLUME.key(0, 0.25, unknown=unknown), VOLUME.key(5, 1.0)),
        muted=True,
        mouths=Mouths(
            switch="mouth",
            cues=(Cue(seconds=0.0, name="X"), Cue(seconds=0.25, name="A")),
            drawings=(("X", 0), ("A", 5)),
            keys=(SWITCH.key(2, 5),),
            unknown=unknown,
        ),
        volume_keys=(
            VolumeKeys(kind="track", layer=0, part=4, keys=((1, 2 + 3j), (4, 0j))),
            VolumeKeys(kind="slider", layer=0, part="jaw", keys=()),
        ),
        unknown=unknown,
    )


def full_document() -> Document:
    """A document with something other than the default in every field."""
    empty = disc_document()
    more = MappingProxyType({"colour": "#123456", "nested": {"list": [1, None, "ü"]}})
    handles = (
        Handle(
            id=1,
            name="nose",
            position=110 + 95.5j,
            weight=2.5,
            depth=-0.75,
            extent=12.5,
            unknown=more,
        ),
        Handle(id=4, name="Fuß\n\N{REPLACEMENT CHARACTER}", position=60 + 100j),
    )
    targets = {
        1: Target(position=1e3 - 0.1j, rotation=-0.25, unknown=more),
        4: Target(position=complex(-0.0, 5e-324)),
    }
    cage = empty.layers[0].domain.cage
    bent = Pose(
        targets=targets,
        phi=cage * np.exp(0.3j) + 1 / 3,
        psi=0.01 * cage.conj(),
        certificate=Certificate(k=0.25, sigma_a=1.5, sigma_b=0.75, winding=0, is_certified=True),
    )
    folded = Pose(
        targets=targets,
        phi=bent.psi,
        psi=bent.phi,
        certificate=Certificate(k=inf, sigma_a=2.0, sigma_b=-inf, winding=None, is_certified=False),
    )
    layer = dataclasses.replace(
        empty.layers[0],
        id=0,
        meshing=Meshing(detail="coarse", triangles=2_000),
        cut_out=hand_made_cut_out(),
        is_stale=True,
        handles=handles,
        next_handle=9,
        keys=(
            Keyframe(frame=3, pose=bent, easing=PRESETS["in-out"], unknown=more),
            Keyframe(frame=10, pose=folded, easing=Easing((0.1, 0.2, 1 / 3, 1.0)), revolutions=-1),
            Keyframe(frame=40, pose=bent, easing=HOLD),
        ),
        anchor=100.5 + 99j,
        has_auto_pins=False,
        variant="scaled-eta",
        bounds=Bounds(k=0.5, sigma_a=3.0, sigma_b=0.4),
        library=(
            LibraryPose(name="bow", pose=bent, unknown=more),
            LibraryPose(name="über\n", pose=dataclasses.replace(bent, psi=0.02 * cage.conj())),
        ),
        mirror=1 / 3,
        name="Körper",
        corner=-3.5 + 2j,
        reference=True,
        locked=True,
        hidden=True,
        opacity=0.25,
        attachments=(
            Attachment(
                parent=5, parent_point=90 + 80j, inherits_rotation=False, rest_rotation=-0.5
            ),
        ),
        unknown=MappingProxyType({"visible": False, "bounds": {"tau": 4}}),
        channels={
            (VISIBILITY.name, None): (
                VISIBILITY.key(0, value=False),
                VISIBILITY.key(12, value=True),
            ),
            (DEPTH.name, 1): (DEPTH.key(40, 0.0),),
            (DEPTH.name, 4): (DEPTH.key(40, 0.25),),
        },
    )
    return dataclasses.replace(
        empty,
        layers=(layer, dataclasses.replace(layer, id=5, name="parent", attachments=())),
        size=(640, 480),
        frames=FrameRange(1, 60),
        preview=FrameRange(3, 40),
        markers=(Marker(frame=0, name="go", unknown=more), Marker(frame=700, name="ü")),
        sounds=(full_sound(more),),
        fps=23.976,
        loop=True,
        export=ExportSettings(
            format="mp4",
            size=(1920, 1080),
            background="#00ff7F",
            framing="fit",
            frames=FrameRange(3, 9),
        ),
        unknown=MappingProxyType({"extension": [1, 2], "export": {"quality": 4}}),
    )


def clocked_document() -> Document:
    """The full document with what came later: clocks of handles, material, groups, and pairs."""
    full = full_document()
    layer = full.layers[0]
    nose, foot = layer.handles
    more = MappingProxyType({"colour": "#123456"})
    keys = (
        TrackKey(frame=2, place=0j, unknown=more),
        TrackKey(
            frame=9, place=3 - 4j, turn=0.25, easing=PRESETS["in"], tangent_mode=TangentMode.STOP
        ),
        TrackKey(frame=12, place=0j, velocity=complex(1 / 3, -0.0)),
        TrackKey(frame=60, place=complex(1 / 3, -0.0), easing=Easing((0.1, 0.2, 1 / 3, 1.0))),
    )
    track = Track(
        handles=(4, 1),
        keys=keys,
        delay=7,
        reach=0.3,
        keys_rotation=True,
        enabled=False,
        unknown=more,
    )
    planted = Track(handles=(1,), is_scene_space=True, keys=(TrackKey(frame=1, place=70 + 90.5j),))
    spring = Spring(
        handle=1,
        frequency=3.1,
        damping=0.2,
        lag=1.5,
        strength=0.7,
        root=4,
        stretch=0.25,
        enabled=False,
        unknown=more,
    )
    parent = dataclasses.replace(
        full.layers[1],
        handles=(nose, dataclasses.replace(foot, is_unpinned=True)),
        has_auto_pins=True,
        tracks=(planted,),
    )
    painted = np.exp(np.linspace(-3, 4, sum(map(len, layer.domain.loops))))
    child = dataclasses.replace(
        layer,
        tracks=(track,),
        springs=(spring,),
        stiffness=painted,
        bones=(Bone(ends=(4, 1), stiffness=1 / 3, is_shown=False, unknown=more),),
        blend="multiply",
        clipped=True,
        group="limbs/left",
        channels={
            (TRANSFORM.name, None): (
                TRANSFORM.key(2, Transform(shift=complex(1 / 3, -0.0), turn=0.1), unknown=more),
                TRANSFORM.key(9, Transform(), easing=PRESETS["in"], tangent_mode=TangentMode.STOP),
            ),
            (OPACITY.name, None): (OPACITY.key(3, 1 / 3), OPACITY.key(60, 0.0)),
            (DRAW_ORDER.name, None): (
                DRAW_ORDER.key(7, DrawOrder(beside=5, in_front=False)),
                DRAW_ORDER.key(70, DrawOrder(beside=None)),
            ),
        },
    )
    groups = (
        Group(name="limbs", hidden=True, unknown=more),
        Group(name="limbs/left", opacity=1 / 3, blend="screen", clipped=True),
    )
    camera = (
        CAMERA.key(1, Camera(centre=complex(1 / 3, -0.0), zoom=2.0, turn=-0.5), unknown=more),
        CAMERA.key(9, Camera(centre=9j, zoom=0.1), easing=HOLD, tangent_mode=TangentMode.CORNER),
    )
    pairs = (("L", "R"), ("Fuß", "Tatze\n"))
    layers = (child, parent)
    told = ImportLog(warnings=("glow: drawn normally",), notes=("Körper: left out", "ü"))
    return dataclasses.replace(
        full, layers=layers, groups=groups, camera=camera, pairs=pairs, import_log=told
    )


def differences(first: object, second: object, where: str = "document") -> list[str]:
    """Return the places at which two values are not the same to the last bit.

    Certificates are left out: they follow from the maps, but for the last bits. So is the sign of a
    zero, which a field that equals its default loses.
    """
    if type(first) is not type(second) and not isinstance(first, Mapping):
        return [where]
    if isinstance(first, np.ndarray):
        same = (first.dtype, first.shape) == (second.dtype, second.shape)
        return [] if same and first.tobytes() == second.tobytes() else [where]
    parts, others = _parts(first), _parts(second)
    if not parts:
        return [] if _bits(first) == _bits(second) else [where]
    if parts.keys() != others.keys():
        return [where]
    return [
        place
        for name, part in parts.items()
        for place in differences(part, others[name], f"{where}.{name}")
    ]


def _parts(value: object) -> dict[object, object]:
    if dataclasses.is_dataclass(value):
        names = {field.name for field in dataclasses.fields(value)} - {"certificate"}
        return {name: getattr(value, name) for name in names}
    if isinstance(value, Mapping):
        return dict(value)
    return dict(enumerate(value)) if isinstance(value, (tuple, list)) else {}


def _bits(value: object) -> object:
    """Return something that is equal for equal bits only, and for empty containers."""
    if isinstance(value, complex):
        return struct.pack("<dd", value.real + 0.0, value.imag + 0.0)
    if isinstance(value, float):
        return struct.pack("<d", value + 0.0)
    return dict(value) if isinstance(value, Mapping) else value

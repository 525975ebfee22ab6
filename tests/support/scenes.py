"""Random scenes of several layers with all that a document can hold, and odd states of a window."""

from dataclasses import replace
from functools import cache

import numpy as np
from animations import BLOB, still_document, within
from documents import random_spring, random_track
from shapes import regular_polygon

from app.document import (
    CAMERA,
    DEPTH,
    DRAW_ORDER,
    OPACITY,
    TRANSFORM,
    Camera,
    Channel,
    DrawOrder,
    Transform,
    all_keys,
    channel_commands,
)
from app.document.channels.easing import PRESETS
from app.document.channels.tangent_mode import TangentMode
from app.document.commands import (
    handle_commands,
    scene_commands,
    shape_commands,
    stiffness_commands,
)
from app.document.commands.command import Command
from app.document.commands.keys import (
    cycle_commands,
    track_commands,
)
from app.document.commands.layers import group_commands, layer_commands, switch_group_commands
from app.document.keyframe import Keyframe, LibraryPose, Pose, Target
from app.document.layer import Layer
from app.document.layers.attachments import Attachment
from app.document.model import Document
from app.document.rig.applied_motion import AppliedMotion
from app.document.settings import VARIANTS, FrameRange
from app.editor import Session
from app.editor.project import Project
from app.errors import LissomError
from app.rigging import Parameters
from app.storage.scenes.layers import make_still_layer
from engine.maps.certificate import Certificate

LAST = 40  # frame
TRIES = 60  # random changes of a scene
NAMES = ("hand.L", "hand.R", "near foot", "far foot", "head", "tail", "é\N{COMBINING ACUTE ACCENT}")
PICTURE = BLOB


@cache
def drawn() -> Document:
    """Return a drawing as it was opened, within twelve corners."""
    circle = regular_polygon(12)
    return within(still_document(), 60 + 47j + 54 * circle.real + 40j * circle.imag)


def random_scene(rng: np.random.Generator) -> Document:
    """Return a document of up to four layers, some of which hang on each other, move and repeat."""
    base = drawn()
    layers = [_random_layer(rng, base.layers[0], number) for number in range(rng.integers(1, 5))]
    document = replace(
        base, layers=tuple(layers), frames=FrameRange(0, LAST), loop=bool(rng.integers(2))
    )
    for _ in range(int(rng.integers(TRIES))):
        try:
            document = _random_change(rng, document)(document)
        except LissomError:
            continue
    return document


def _random_layer(rng: np.random.Generator, drawn: Layer, number: int) -> Layer:
    layer = replace(drawn, id=number, name=f"layer {number}", corner=complex(0, 0))
    if rng.random() < 0.15:
        return make_still_layer(layer)
    document = Document(layers=(replace(layer, id=0),))
    for name in rng.permutation(NAMES)[: rng.integers(5)].tolist():
        place = complex(rng.uniform(30, 90), rng.uniform(30, 65))
        document = handle_commands.add_handle(0, place, name=name)(document)
    layer = replace(document.layers[0], id=number)
    frames = rng.choice(LAST + 1, rng.integers(1, 6), replace=False)
    keys = tuple(
        Keyframe(
            frame=frame,
            pose=random_affine(rng, layer),
            easing=_any(rng, PRESETS.values()),
            tangent_mode=_any(rng, (TangentMode.SMOOTH, TangentMode.CORNER, TangentMode.STOP)),
            revolutions=int(rng.integers(-1, 2)),
        )
        for frame in sorted(map(int, frames))
    )
    library = tuple(
        LibraryPose(name=f"pose {count}", pose=random_affine(rng, layer))
        for count in range(rng.integers(3))
    )
    variant = VARIANTS[rng.integers(len(VARIANTS))]
    return replace(
        layer,
        keys=keys,
        library=library,
        variant=variant,
        locked=bool(rng.random() < 0.2),
        hidden=bool(rng.random() < 0.2),
    )


def random_affine(rng: np.random.Generator, layer: Layer) -> Pose:
    """Return a pose of a layer that is the same map everywhere, within the usual limits."""
    cage, middle = layer.domain.cage, layer.domain.cage.mean()
    turn, shift = np.exp(1j * rng.normal(0, 0.4)), complex(*rng.normal(0, 8, 2))
    shear = 0.2 * rng.random() * np.exp(1j * rng.normal())
    places = np.array([handle.position for handle in layer.handles], np.complex128) - middle
    places = middle + shift + turn * places + np.conj(shear * places)
    targets = {
        handle.id: Target(position=complex(place))
        for handle, place in zip(layer.handles, places, strict=True)
    }
    return Pose(
        targets=targets,
        phi=middle + shift + turn * (cage - middle),
        psi=shear * (cage - middle),
        certificate=Certificate(
            k=abs(shear),
            sigma_a=1 + abs(shear),
            sigma_b=1 - abs(shear),
            winding=0,
            is_certified=True,
        ),
    )


def _random_change(rng: np.random.Generator, document: Document) -> Command:
    layer = _any(rng, document.layers)
    other = _any(rng, document.layers)
    one, to = sorted(int(frame) for frame in rng.integers(LAST + 1, size=2))
    flag, ids = bool(rng.integers(2)), [each.id for each in document.layers]
    place = complex(rng.uniform(30, 90), rng.uniform(30, 65))
    handles = [handle.id for handle in layer.handles]
    group = _any(rng, ("body", "body/arms", "legs"))
    joint = Attachment(
        parent=None if rng.random() < 0.2 else other.id,
        parent_point=place,
        inherits_rotation=flag,
        frame=0 if flag else one,
        keep_world_transform=bool(rng.integers(2)),
    )
    until = _any(rng, (None, to, to + (to - one), LAST))
    camera = Camera(centre=place, zoom=rng.uniform(0.3, 4), turn=rng.normal())
    changes = [
        layer_commands.attach_layer(layer.id, place, joint),
        layer_commands.key_visibility(layer.id, one, visible=flag),
        switch_group_commands.create_switch_group(
            f"choice {one}", rng.permutation(ids)[:2].tolist()
        ),
        switch_group_commands.choose_at(layer.id, to),
        *2 * [cycle_commands.set_cycle(layer.id, one, to, until)],
        channel_commands.set_key(Channel(CAMERA), one, camera),
        channel_commands.set_key(Channel(OPACITY, layer.id), one, rng.random()),
        channel_commands.set_key(
            Channel(TRANSFORM, layer.id), to, Transform(place - 60, rng.normal())
        ),
        channel_commands.set_key(Channel(DRAW_ORDER, layer.id), one, DrawOrder(other.id, flag)),
        group_commands.group_layers([layer.id, other.id], group),
        group_commands.set_group_hidden(group, hidden=flag),
        scene_commands.add_marker(one, _any(rng, (None, "beat"))),
        scene_commands.set_preview(FrameRange(one, to) if flag else None),
        scene_commands.set_fps(float(_any(rng, (1, 12, 23.976, 60)))),
        layer_commands.set_clipped(layer.id, clipped=flag),
        layer_commands.set_reference(layer.id, reference=flag),
        shape_commands.set_anchor(layer.id, place if flag else None),
    ]
    if len(handles) > 1:
        some = tuple(rng.permutation(handles)[: rng.integers(1, 3)].tolist())
        ends = tuple(rng.permutation(handles)[:2].tolist())
        track = random_track(rng, some)
        offsets = tuple(replace(key, place=complex(*rng.normal(0, 3, 2))) for key in track.keys)
        changes += [
            *2
            * [
                track_commands.put_track(
                    layer.id, replace(track, is_scene_space=False, keys=offsets)
                )
            ],
            track_commands.put_spring(layer.id, random_spring(rng, handles[0])),
            stiffness_commands.add_bone(layer.id, ends, 10.0),
            handle_commands.group_handles(layer.id, set(some), "arms"),
            handle_commands.lock_handles(layer.id, set(some), locked=flag),
            channel_commands.set_key(Channel(DEPTH, layer.id, handles[0]), one, rng.uniform(-1, 1)),
            scene_commands.apply_motion(layer, _given(rng, handles, one, to)),
        ]
    return changes[rng.integers(len(changes))]


def _given(rng: np.random.Generator, handles: list[int], first: int, last: int) -> AppliedMotion:
    return AppliedMotion(
        motion="wave",
        kind="biped-front",
        joints={"hips": handles[0]},
        facing=_any(rng, (-1, 1)),
        parameters=Parameters(),
        first=first,
        start=first,
        last=max(last, first + 1),
    )


def random_state(rng: np.random.Generator, session: Session, project: Project) -> None:
    """Let things be chosen, in hand and under the playhead at random."""
    document = project.document
    project.selection.active = _any(rng, document.layers).id
    layer = project.layer
    project.selection.other_layers = frozenset(
        each.id for each in document.layers if rng.random() < 0.3
    )
    project.selection.handles = frozenset(
        handle.id for handle in layer.handles if rng.random() < 0.5
    )
    for channel, keyed in all_keys(document).items():
        frames = frozenset(frame for frame in sorted(keyed) if rng.random() < 0.4)
        if frames and rng.random() < 0.6:
            project.selection.keys[channel] = frames
    project.timeline.expanded_layers = frozenset(
        each.id for each in document.layers if rng.random() < 0.5
    )
    if layer.tracks and rng.random() < 0.5:
        project.selection.select_track(layer, _any(rng, layer.tracks).handles[0])
    project.viewport.is_camera_view = bool(document.camera) and bool(rng.integers(2))
    project.timeline.playhead = replace(
        project.timeline.playhead, frame=int(rng.integers(LAST + 1))
    )
    session.display.is_timeline_focused = bool(rng.integers(2))
    tools = ("keep", "remove", "knife", "pick", "holes", "stiff", "bone", "move", "record")
    session.tools.mode = _any(rng, ("pose",) * 10 + tools)


def _any(rng: np.random.Generator, options):
    """Return one of some options as it is, whatever NumPy would make of it."""
    options = list(options)
    return options[rng.integers(len(options))]

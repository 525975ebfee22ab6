"""Solving a pose script on a new document, as the window does."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from app.document import (
    VISIBILITY,
    Document,
    FrameRange,
    Keyframe,
    Layer,
    Pose,
    brushed_stiffness,
    handle_commands,
    is_visible,
    layer_commands,
    stiffness_commands,
    with_directed_bones,
)
from app.errors import LissomError
from app.solving.drag.rig import Rig
from app.solving.script.keys import PoseKey
from app.solving.script.pose_script import LayerScript, PoseScript
from app.solving.script.sounds import with_sounds
from app.solving.script_limbs import warn_missed_targets, with_limbs
from app.solving.script_poses import solve_pose, with_sliders
from app.solving.script_scene import (
    find_layer,
    resolve_channels,
    warn_invisible_layers,
    warn_unused_cycles,
    warn_unused_switches,
    with_attachments,
    with_deform_groups,
    with_switch_groups,
    with_world_transforms,
)
from app.storage import make_still_layer
from app.texts import _, message_of
from engine.errors import EngineError

SAME_PLACE = 1e-6  # pixels: tolerance for rounding


def pose_document(
    document: Document, script: PoseScript, progress: Callable[[str], None]
) -> tuple[Document, tuple[str, ...]]:
    """Return a document with the script's handles, keys and attachments, and notices.

    Each key is solved by a drag from the key before, the first one from the undeformed drawing. A
    handle without a target in a key keeps its last target. A script of one layer poses the
    frontmost visible layer. In a script of several, layers without an entry become still.

    The notices are target errors, and parts of the script without effect. `progress` receives the
    description of each step. Raises a `LissomError` or `EngineError` if a layer is missing or
    attached to itself, or if a point lies outside its shape.
    """
    document = with_deform_groups(document, script)
    named, notices = _by_layer(document, script), list[str]()
    document = replace(
        document,
        frames=FrameRange(0, script.last),
        fps=script.fps,
        loop=script.loop,
        camera=script.camera,
        size=script.canvas or document.size,
    )
    for identity, part in named.items():
        with _whose(part):
            with _among(document, identity, part):
                document = _prepared(document, identity, part)
            document, found = _with_material(document, identity, part)
        notices += found
    if script.layers[0].layer is not None:
        for layer in document.layers:
            if layer.id not in named and not layer.still:
                document = document.with_layer(make_still_layer(layer))
    for identity, part in named.items():
        with _whose(part):
            layer, found = _posed(document.layer(identity), part, progress, loop=script.loop)
            layer, more = with_sliders(document, layer, part.sliders, progress)
        document = document.with_layer(layer)
        notices += [*found, *more]
    document = with_limbs(with_world_transforms(document, script), script)
    document = with_switch_groups(document, script)
    document = with_sounds(document, script.sounds, script.folder)
    return document, (
        *notices,
        *warn_missed_targets(document),
        *warn_unused_switches(document),
        *warn_invisible_layers(document, script),
    )


@contextmanager
def _whose(part: LayerScript) -> Iterator[None]:
    """Name the layer in errors if the script has several."""
    try:
        yield
    except (LissomError, EngineError) as error:
        if part.layer is None:
            raise
        raise LissomError(
            _("layer {layer!r}: {error}").format(layer=part.layer, error=message_of(error))
        ) from error


@contextmanager
def _among(document: Document, identity: int, part: LayerScript) -> Iterator[None]:
    """Name in errors the layer that a script without layer names uses."""
    try:
        yield
    except (LissomError, EngineError) as error:
        layer = document.layer(identity)
        names = [repr(each.name) for each in document.layers if each is not layer]
        places = [handle.at for handle in part.handles.values()]
        places += [] if part.anchor is None else [part.anchor]
        are_on_it = layer.covers(np.array(places, dtype=np.complex128)).all()
        if part.layer is not None or not names or are_on_it:
            raise
        own = layer.name
        raise LissomError(
            _(
                "{error} The script names no layer, so its handles are on the front layer "
                '{own!r}. The drawing also has {names}. Name the layer in "layers": [{{"layer": '
                "{name}, ...}}]."
            ).format(
                error=message_of(error),
                own=own,
                names=", ".join(names),
                name=json.dumps(own, ensure_ascii=False),
            )
        ) from error


def _by_layer(document: Document, script: PoseScript) -> dict[int, LayerScript]:
    named = {}
    for part in script.layers:
        if part.layer is None:
            posable = [f for f in reversed(document.layers) if not f.still]
            seen = [f for f in posable if is_visible(document, f, 0)]
            layer = next(iter(seen or posable), None)
        else:
            layer = find_layer(document, part.layer)
        is_posed = bool(part.handles) or len(part.keys) > 1 or part.layer is None
        if layer is not None and layer.deform_group is not None and is_posed:
            text = _("{layer!r} bends with {group!r}; give that entry the handles and keys")
            group = document.deform_layer(layer).name
            raise LissomError(text.format(layer=layer.name, group=group))
        if layer is None or (layer.still and is_posed):
            raise LissomError(
                _(
                    "the layer {layer!r} cannot be posed, because it contains no shape. Leave "
                    "out its handles, and give it one key; it can still move as a whole"
                ).format(layer=part.layer)
            )
        named[layer.id] = part
    return named


def _prepared(document: Document, identity: int, part: LayerScript) -> Document:
    """Return the document with a layer's handles, settings and attachments."""
    first = document.layer(identity).next_handle
    for name, handle in part.handles.items():
        added = document.layer(identity).next_handle
        document = handle_commands.add_handle(identity, handle.at, name=name)(document)
        document = layer_commands.set_depth(identity, added, handle.front, handle.extent)(document)
        document = handle_commands.unpin_handles(identity, {added}, free=not handle.still)(document)
    if (VISIBILITY.name, None) in part.channels:
        # The script's visibility overrides hidden layers of the drawing.
        document = layer_commands.show_layer(identity)(document)
    layer = document.layer(identity)
    document = document.with_layer(
        replace(
            layer,
            variant=part.variant,
            bounds=part.bounds,
            anchor=part.anchor,
            has_auto_pins=part.still,
            opacity=layer.opacity if part.opacity is None else part.opacity,
            channels=resolve_channels(document, layer, part),
            tracks=tuple(
                replace(track, handles=tuple(first + number for number in track.handles))
                for track in part.tracks
            ),
            springs=tuple(
                replace(
                    spring,
                    handle=first + spring.handle,
                    root=None if spring.root is None else first + spring.root,
                )
                for spring in part.springs
            ),
        )
    )
    return with_attachments(document, identity, part)


def _with_material(
    document: Document, identity: int, part: LayerScript
) -> tuple[Document, list[str]]:
    """Return the document with a layer's stiffness, and notices of regions outside all outlines."""
    notices = []
    for each in part.parts:
        at, options = each.around, {"radius": each.radius, "amount": each.amount}
        *_stiffness, reached = brushed_stiffness(document.layer(identity), [at], **options)
        if not reached:
            whose = "" if part.layer is None else f"{part.layer}, "
            notices.append(
                whose
                + _(
                    "no outline lies within {radius:g} px of ({x:g}, {y:g}), so nothing becomes "
                    "stiff or soft there"
                ).format(radius=each.radius, x=at.real, y=at.imag)
            )
        document = stiffness_commands.paint_stiffness(identity, [at], **options)(document)
    ids = [handle.id for handle in document.layer(identity).handles]
    layer = document.layer(identity)
    for bone in part.bones:
        ends = (ids[bone.ends[0]], ids[bone.ends[1]])
        try:
            layer = stiffness_commands.with_bone(layer, replace(bone, ends=ends))
        except EngineError as error:
            first, second = (layer.handle(end).name for end in ends)
            raise LissomError(
                _("bone from {first!r} to {second!r}: {error}").format(
                    first=first, second=second, error=message_of(error)
                )
            ) from error
    return document.with_layer(with_directed_bones(layer)), notices


def _posed(
    layer: Layer, part: LayerScript, progress: Callable[[str], None], *, loop: bool
) -> tuple[Layer, list[str]]:
    rig = Rig.of(layer)
    pose = layer.keys[0].pose
    whose = "" if part.layer is None else f"{part.layer}, "
    keys: list[Keyframe] = []
    notices: list[str] = []
    for key in part.keys:
        progress(whose + _("solving the key at frame {frame}").format(frame=key.frame))
        pose, found = solve_pose(rig, pose, key, _("frame {frame}").format(frame=key.frame))
        again = keys[0] if loop and key is part.keys[-1] and keys else _repeated(part, keys, key)
        is_alike = again is not None and _has_same_targets(rig, pose, again.pose)
        if again is not None and is_alike:
            # The same pose to the last digit.
            pose, found = again.pose, []
        cycle = next((each for each in part.cycles if each.last == key.frame), None)
        if again is not None and cycle is not None and cycle.until != cycle.last:
            if not is_alike:
                raise LissomError(
                    _(
                        "the key at frame {frame} lies where {cycle} repeat, but it differs "
                        "from the key at frame {first}. Leave it out, or end the cycle elsewhere"
                    ).format(frame=key.frame, cycle=cycle.description, first=again.frame)
                )
            continue
        notices += [f"{whose}{notice}" for notice in found]
        keys.append(Keyframe(frame=key.frame, pose=pose, easing=key.ease, tangent_mode=key.passing))
    posed = replace(layer, keys=tuple(keys), cycles=part.cycles)
    return posed, [*notices, *(whose + notice for notice in warn_unused_cycles(posed, part))]


def _repeated(part: LayerScript, keys: Sequence[Keyframe], key: PoseKey) -> Keyframe | None:
    """Return the earlier key of a cycle that repeats at this key, if any."""
    for cycle in part.cycles:
        if key.frame >= cycle.last and cycle.covers(key.frame):
            source = cycle.source_frame(key.frame)
            return next((each for each in keys if each.frame == source), None)
    return None


def _has_same_targets(rig: Rig, pose: Pose, other: Pose) -> bool:
    """Return whether two poses have the same targets for handles that hold poses."""
    return all(
        abs(pose.targets[held.id].position - other.targets[held.id].position) <= SAME_PLACE
        and pose.targets[held.id].rotation == other.targets[held.id].rotation
        for held in rig.handles
    )

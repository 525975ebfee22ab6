"""Relations and channels of layers in a pose script, and the camera.

Attachments, switch groups, transforms, opacity and draw order.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import radians
from typing import Any, TypeVar

from app.document import CameraKey, OpacityKey, TransformKey
from app.errors import LissomError
from app.solving.script.fields import (
    build_value,
    check_frame_order,
    read_easing_and_tangent,
    read_fields,
    read_frame,
)
from app.storage import (
    JsonObject,
    as_flag,
    as_list,
    as_number,
    as_object,
    as_point,
    as_text,
    as_whole,
    repr_for_error,
)
from app.texts import N_, _

SWITCH_GROUP_FIELDS = ("name", "layers", "keys")
ATTACHMENT_FIELDS = ("to", "at", "turn", "frame", "keep")
TANGENT_FIELDS = ("frame", "ease", "passing")
CAMERA_FIELDS = (*TANGENT_FIELDS, "centre", "zoom", "turn")
TRANSFORM_FIELDS = (*TANGENT_FIELDS, "shift", "turn")
# Fields for a place beside another layer, and whether it is in front.
SIDES = {"in_front_of": True, "behind": False}

Key = TypeVar("Key", CameraKey, TransformKey)
ZOOM_NOT_POSITIVE = N_("{where}.zoom must be above 0, not {zoom:g}")
NO_KEYS = N_("{where}.keys must be a list of at least one key")


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptAttachment:
    """The parent of a layer from a frame on, and the undeformed place of the joint."""

    to: str | None  # None detaches the layer
    at: complex | None  # None takes the nearest point at that frame
    turns: bool = True
    frame: int = 0
    keeps: bool = False  # whether the layer keeps its place at that frame


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptSwitchGroup:
    """Layers of which one is visible, by name, and the switch keys."""

    name: str
    layers: tuple[str, ...]
    turns: tuple[tuple[int, str], ...] = ()


def parse_attachments(content: object, where: str) -> tuple[ScriptAttachment, ...]:
    """Return the attachments of a layer: one object or a list."""
    if not isinstance(content, list):
        return (_joint(content, where),)
    joints = tuple(_joint(each, f"{where}[{index}]") for index, each in enumerate(content))
    check_frame_order([joint.frame for joint in joints], where)
    return joints


def _joint(content: object, where: str) -> ScriptAttachment:
    joint = read_fields(content, where, ATTACHMENT_FIELDS)
    keeps = as_flag(joint.get("keep", False), f"{where}.keep")
    if joint["to"] is None:
        for name in ("at", "turn"):
            if name in joint:
                raise LissomError(
                    _("{where} detaches the layer and cannot have {name}; leave it out").format(
                        where=where, name=name
                    )
                )
    to = None if joint["to"] is None else as_text(joint["to"], f"{where}.to")
    at = None if to is None or (keeps and "at" not in joint) else joint["at"]
    return ScriptAttachment(
        to=to,
        at=None if at is None else as_point(at, f"{where}.at"),
        turns=as_flag(joint.get("turn", True), f"{where}.turn"),
        frame=read_frame(joint, where) if "frame" in joint else 0,
        keeps=keeps,
    )


def parse_visibility(content: object, where: str) -> tuple[tuple[int, bool], ...]:
    switches = [
        (frame, as_flag(visible, at))
        for at, frame, visible in _from_frames(content, where, _("true or false"))
    ]
    check_frame_order([frame for frame, _visible in switches], where)
    return tuple(switches)


def parse_switch_groups(
    script: JsonObject, switched: Sequence[str]
) -> tuple[ScriptSwitchGroup, ...]:
    """Return the switch groups; `switched` are layers with visibility keys of their own."""
    entries = as_list(script.get("choices", []), "choices")
    choices = [_choice(entry, f"choices[{index}]") for index, entry in enumerate(entries)]
    for name, count in Counter(choice.name for choice in choices).items():
        if count > 1:
            raise LissomError(
                _("two switches have the name {name!r}; rename one of them").format(name=name)
            )
    layers = Counter(layer for choice in choices for layer in choice.layers)
    for layer, count in layers.items():
        if count > 1:
            raise LissomError(
                _("the layer {layer!r} is in two switches; leave it out of one of them").format(
                    layer=layer
                )
            )
        if layer in switched:
            raise LissomError(
                _(
                    "the layer {layer!r} is in a switch, which alone decides its visibility; "
                    'leave out "visible"'
                ).format(layer=layer)
            )
    return tuple(choices)


def _choice(content: object, where: str) -> ScriptSwitchGroup:
    fields = read_fields(content, where, SWITCH_GROUP_FIELDS)
    layers = tuple(
        as_text(layer, f"{where}.layers") for layer in as_list(fields["layers"], f"{where}.layers")
    )
    if len(layers) < 2:
        raise LissomError(_("{where}.layers must list at least two layers").format(where=where))
    for layer, count in Counter(layers).items():
        if count > 1:
            raise LissomError(
                _("{where}.layers lists {layer!r} twice; list it once").format(
                    where=where, layer=layer
                )
            )
    turns = []
    for at, frame, layer in _from_frames(fields.get("keys", []), f"{where}.keys", _("a layer")):
        turn = frame, as_text(layer, at)
        if turn[1] not in layers:
            raise LissomError(
                _("{where} shows {layer!r}, which is not among its layers").format(
                    where=at, layer=turn[1]
                )
            )
        turns.append(turn)
    check_frame_order([frame for frame, _layer in turns], f"{where}.keys")
    name = as_text(fields["name"], f"{where}.name").strip()
    if not name:
        raise LissomError(_("{where}.name is empty; give the switch a name").format(where=where))
    return ScriptSwitchGroup(name=name, layers=layers, turns=tuple(turns))


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptDrawOrder:
    """From a frame on, a layer is directly in front of or behind another layer, by name."""

    frame: int
    beside: str | None  # None restores the layer's place in the drawing
    in_front: bool = True


def parse_camera(content: object) -> tuple[CameraKey, ...]:
    def key(read: JsonObject, where: str, **way: Any) -> CameraKey:
        zoom = as_number(read.get("zoom", 1.0), f"{where}.zoom")
        if not zoom > 0:
            raise LissomError(_(ZOOM_NOT_POSITIVE).format(where=where, zoom=zoom))
        return build_value(
            CameraKey,
            where,
            centre=as_point(read["centre"], f"{where}.centre"),
            zoom=zoom,
            turn=radians(as_number(read.get("turn", 0.0), f"{where}.turn")),
            **way,
        )

    return _parse_keys(content, "camera", CAMERA_FIELDS, key)


def parse_transform_keys(content: object, where: str) -> tuple[TransformKey, ...]:

    def key(read: JsonObject, where: str, **way: Any) -> TransformKey:
        return build_value(
            TransformKey,
            where,
            shift=as_point(read.get("shift", [0.0, 0.0]), f"{where}.shift"),
            turn=radians(as_number(read.get("turn", 0.0), f"{where}.turn")),
            **way,
        )

    return _parse_keys(content, where, TRANSFORM_FIELDS, key)


def _parse_keys(
    content: object, where: str, fields: tuple[str, ...], make: Callable[..., Key]
) -> tuple[Key, ...]:
    entries = as_list(read_fields(content, where, ("keys",))["keys"], f"{where}.keys")
    if not entries:
        raise LissomError(_(NO_KEYS).format(where=where))
    keys = []
    for index, entry in enumerate(entries):
        at = f"{where}.keys[{index}]"
        read = read_fields(entry, at, fields)
        easing, passing = read_easing_and_tangent(read, at)
        keys.append(make(read, at, frame=read_frame(read, at), easing=easing, tangent_mode=passing))
    check_frame_order([key.frame for key in keys], f"{where}.keys")
    return tuple(keys)


def parse_opacity(content: object, where: str) -> float | tuple[OpacityKey, ...]:
    """Return the opacity of a layer: a number, or keys."""
    if not isinstance(content, list):
        return build_value(OpacityKey, where, frame=0, opacity=as_number(content, where)).opacity
    if not content:
        raise LissomError(
            _("{where} must be a number, or a list of at least one key").format(where=where)
        )
    keys = tuple(
        build_value(OpacityKey, at, frame=frame, opacity=as_number(opacity, at))
        for at, frame, opacity in _from_frames(content, where, _("a number"))
    )
    check_frame_order([key.frame for key in keys], where)
    return keys


def parse_draw_order(content: object, where: str) -> tuple[ScriptDrawOrder, ...]:
    keys = []
    for at, frame, place in _from_frames(
        content, where, _('"in_front_of" or "behind" with a layer, or null')
    ):
        if place is None:
            keys.append(ScriptDrawOrder(frame=frame, beside=None))
            continue
        read = as_object(place, at)
        (side, *others) = read or {"": ""}
        if others or side not in SIDES:
            raise LissomError(
                _('{where} must have "in_front_of" or "behind" with a layer, not {content}').format(
                    where=at, content=repr_for_error(place)
                )
            )
        beside = as_text(read[side], f"{at}.{side}")
        keys.append(ScriptDrawOrder(frame=frame, beside=beside, in_front=SIDES[side]))
    check_frame_order([key.frame for key in keys], where)
    return tuple(keys)


def parse_canvas(content: object) -> tuple[int, int]:
    sides = as_list(content, "canvas")
    if len(sides) != 2:
        raise LissomError(
            _("canvas must be width and height, not {content}").format(
                content=repr_for_error(content)
            )
        )
    width, height = (as_whole(side, "canvas") for side in sides)
    return width, height


def _from_frames(content: object, where: str, what: str) -> list[tuple[str, int, Any]]:
    """Return pairs of a frame and a value, each after its place in the script."""
    found = []
    for index, entry in enumerate(as_list(content, where)):
        at = f"{where}[{index}]"
        pair = as_list(entry, at)
        if len(pair) != 2:
            raise LissomError(
                _("{where} must be a frame and {what}, not {content}").format(
                    where=at, what=what, content=repr_for_error(pair)
                )
            )
        found.append((at, read_frame({"frame": pair[0]}, at), pair[1]))
    return found

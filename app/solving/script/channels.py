"""Channels in a pose script: one codec per kind reads their keys.

The fields "movement", "opacity", "visible", "order", and "front" of poses came before "channels".
They become records that the codecs read, each with its place in the script.
"""

from collections.abc import Iterable, Iterator, Mapping
from math import degrees, radians
from typing import Any

from app.document import (
    CAMERA,
    DEPTH,
    DRAW_ORDER,
    LAYER_KINDS,
    OPACITY,
    SWITCH,
    TRANSFORM,
    VISIBILITY,
    VOLUME,
    ChannelKeys,
    ChannelKind,
    Key,
    Quantity,
)
from app.errors import LissomError
from app.solving.script.fields import (
    NO_KEYS,
    check_frame_order,
    check_handle_name,
    read_easing_and_tangent,
    read_fields,
    read_frame,
)
from app.storage import (
    IN_FILES,
    TEXT,
    Codec,
    JsonObject,
    as_list,
    as_number,
    as_object,
    as_text,
    key_codec,
    repr_for_error,
)
from app.texts import N_, _

# A key as in project files, after its place in the script.
Record = tuple[str, Mapping[str, object]]
TWICE = N_("{where} and {other} both set this channel; leave out {where}")
NO_PAIR = N_("{where} must be a frame and a value, not {content}")
# Fields for a place beside another layer, and whether it is in front.
SIDES = {"in_front_of": True, "behind": False}
EARLIER: Mapping[str, ChannelKind[Any]] = {
    "movement": TRANSFORM,
    "opacity": OPACITY,
    "visible": VISIBILITY,
    "order": DRAW_ORDER,
}
# As in project files, but with names of layers, and angles in degrees.
CODECS = {
    **IN_FILES,
    Quantity.LAYER: TEXT,
    Quantity.MEMBER: TEXT,
    Quantity.ANGLE: Codec(degrees, lambda content, where: radians(as_number(content, where))),
}
KEYS = {
    each.name: key_codec(each, CODECS) for each in (*LAYER_KINDS.values(), CAMERA, SWITCH, VOLUME)
}


def parse_channels(
    script: JsonObject, where: str, depths: Mapping[str, float], *, loop: bool
) -> ChannelKeys:
    """Return the channels of a layer, with names of handles and layers; `depths` of the handles."""
    found: dict[tuple[str, int | str | None], tuple[Key[Any], ...]] = {}
    whole = f"{where}channels"
    kinds = tuple(name for name, kind in LAYER_KINDS.items() if not kind.of_sliders)
    given = read_fields(script.get("channels", {}), whole, kinds)
    for name, content in given.items():
        at = f"{whole}.{name}"
        rows: dict[Any, Any] = as_object(content, at) if name == DEPTH.name else {None: content}
        for part, row in rows.items():
            place = at if part is None else f"{at}.{part}"
            if part is not None:
                check_handle_name(part, [*depths], at)
            keys = ((f"{place}[{i}]", each) for i, each in enumerate(as_list(row, place)))
            found[name, part] = read_keys(LAYER_KINDS[name], keys, place)
    fronts = _front_records(script, where, depths, loop=loop)
    earlier = {field: kind for field, kind in EARLIER.items() if script.get(field) is not None}
    for field, kind in (*earlier.items(), *[("front", DEPTH)] * bool(fronts)):
        if kind.name in given:
            at, other = f"{where}{field}", f"{whole}.{kind.name}"
            raise LissomError(_(TWICE).format(where=at, other=other))
    for field, kind in earlier.items():
        if kind is TRANSFORM:
            at = f"{where}{field}"
            keys = read_fields(script[field], at, ("keys",))["keys"]
            found[kind.name, None] = read_tangent_keys(kind, keys, f"{at}.keys")
        elif kind is not OPACITY or isinstance(script[field], list):
            found[kind.name, None] = read_pairs(kind, script[field], f"{where}{field}")
    for handle, records in fronts.items():
        found[DEPTH.name, handle] = read_keys(DEPTH, records, f"{where}keys")
    return found


def parse_opacity(content: object, where: str) -> float | None:
    """Return an opacity without keys, if there is one."""
    if content is None or isinstance(content, list):
        return None
    (key,) = read_keys(OPACITY, [_record(OPACITY, 0, content, where)], where)
    return float(key.value)


def parse_camera(content: object) -> tuple[Key[Any], ...]:
    keys = read_fields(content, "camera", ("keys",))["keys"]
    return read_tangent_keys(CAMERA, keys, "camera.keys")


def read_keys(
    kind: ChannelKind[Any], records: Iterable[Record], where: str
) -> tuple[Key[Any], ...]:
    """Return the keys of a channel; `where` is the place of the whole channel."""
    names = ("frame", "easing", "tangent_mode", *(each.name for each in kind.fields))
    keys = []
    for at, record in records:
        read_frame(read_fields(record, at, names), at)
        keys.append(KEYS[kind.name].read(record, at))
    if not keys and not kind.is_held:
        raise LissomError(_(NO_KEYS).format(where=where))
    check_frame_order([key.frame for key in keys], where)
    return tuple(keys)


def read_pairs(kind: ChannelKind[Any], content: object, where: str) -> tuple[Key[Any], ...]:
    """Return the keys of pairs of a frame and a value."""

    def records() -> Iterator[Record]:
        for index, entry in enumerate(as_list(content, where)):
            at = f"{where}[{index}]"
            pair = as_list(entry, at)
            if len(pair) != 2:
                raise LissomError(_(NO_PAIR).format(where=at, content=repr_for_error(pair)))
            if kind is DRAW_ORDER:
                yield at, {"frame": pair[0], **_place(pair[1], at)}
            else:
                yield _record(kind, pair[0], pair[1], at)

    return read_keys(kind, records(), where)


def _record(kind: ChannelKind[Any], frame: object, value: object, at: str) -> Record:
    """Return a key with a value of one field, which stands at `at`."""
    (field,) = kind.fields
    CODECS[field.quantity].read(value, at)  # an error names the place without the field
    return at, {"frame": frame, field.name: value}


def read_tangent_keys(kind: ChannelKind[Any], keys: object, where: str) -> tuple[Key[Any], ...]:
    """Return the keys of objects with "ease" and "passing"."""
    names = ("frame", "ease", "passing", *(each.name for each in kind.fields))
    records = []
    for index, entry in enumerate(as_list(keys, where)):
        at = f"{where}[{index}]"
        read = read_fields(entry, at, names)
        easing, mode = read_easing_and_tangent(read, at)
        values = {name: read[name] for name in read if name not in {"ease", "passing"}}
        records.append((at, {**values, "easing": easing.to_json(), "tangent_mode": mode}))
    return read_keys(kind, records, where)


def _place(content: object, at: str) -> Mapping[str, object]:
    """Return the fields of a draw order from "in_front_of" or "behind"."""
    if content is None:
        return {"beside": None}
    read = as_object(content, at)
    (side, *others) = read or {"": ""}
    if others or side not in SIDES:
        raise LissomError(
            _('{where} must have "in_front_of" or "behind" with a layer, not {content}').format(
                where=at, content=repr_for_error(content)
            )
        )
    return {"beside": as_text(read[side], f"{at}.{side}"), "in_front": SIDES[side]}


def _front_records(
    script: JsonObject, where: str, depths: Mapping[str, float], *, loop: bool
) -> dict[str, list[Record]]:
    """Return depth keys of the fields "front" of poses, by handle.

    Before the first pose of a loop, its last depths hold. The first pose keeps a handle's own depth
    if it sets no other.
    """
    found: dict[str, list[Record]] = {}
    for index, pose in enumerate(script["keys"]):
        at = f"{where}keys[{index}]"
        for handle, front in as_object(pose.get("front", {}), f"{at}.front").items():
            check_handle_name(handle, [*depths], at)
            record = _record(DEPTH, pose["frame"], front, f"{at}.front.{handle}")
            found.setdefault(handle, []).append(record)
    first = script["keys"][0]["frame"]
    for handle, records in found.items() if loop else ():
        if records[0][1]["frame"] != first:
            own = {"frame": first, "depth": depths[handle]}
            records.insert(0, (f"{where}handle {handle!r}", own))
    return found

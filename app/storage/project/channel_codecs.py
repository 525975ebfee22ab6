"""Keys of channels as JSON: one codec for each kind, generated from the kind's fields."""

from collections.abc import Mapping
from dataclasses import replace
from operator import attrgetter
from typing import Any

from app.document import (
    LAYER_KINDS,
    LINEAR,
    ChannelKeys,
    ChannelKind,
    Easing,
    Key,
    Quantity,
)
from app.errors import LissomError
from app.storage.json_values import as_list, as_number, as_object, as_point, as_text, as_whole
from app.storage.project import codecs
from app.storage.project.codecs import MISSING, Codec, Field, list_of, located, optional, record
from app.texts import N_, _

DUPLICATE_CHANNEL = N_("{where}: the layer already has this channel; leave one of them out")
EASING = Codec(Easing.to_json, lambda content, where: located(where, Easing.parse, content))
# Angles are in radians, and layers are ids.
IN_FILES: Mapping[Quantity, Codec] = dict.fromkeys(Quantity, codecs.NUMBER) | {
    Quantity.POINT: codecs.POINT,
    Quantity.FLAG: codecs.FLAG,
    Quantity.LAYER: codecs.WHOLE,
    Quantity.MEMBER: codecs.WHOLE_OR_TEXT,
    Quantity.VALUE: codecs.VALUE,
    Quantity.COLOUR: list_of(codecs.NUMBER),
    Quantity.ANYTHING: codecs.ANYTHING,
}


# Of a number, or of a point, per frame.
VELOCITY = Codec(
    codecs.VALUE.write,
    lambda content, where: (as_point if isinstance(content, list) else as_number)(content, where),
)


def key_codec(kind: ChannelKind[Any], forms: Mapping[Quantity, Codec] = IN_FILES) -> Codec:
    """Return the codec of a kind's keys: frame, easing, tangent, and the value's fields.

    In files, keys have velocities, too.
    """

    def make(
        frame: int,
        easing: Easing,
        tangent_mode: Any,
        unknown: Any,
        velocities: tuple[float | complex | None, ...] = (),
        **own: Any,
    ) -> Key[Any]:
        value = kind.make(*own.values())
        kind.check(value)
        key = kind.key(frame, value, easing=easing, tangent_mode=tangent_mode, unknown=unknown)
        return replace(key, velocities=velocities) if velocities else key

    return record(
        make,
        Field("frame", codecs.WHOLE),
        Field("easing", EASING, default=LINEAR),
        Field("tangent_mode", codecs.TEXT, default=kind.tangent_mode),
        *(
            Field(
                each.name,
                optional(forms[each.quantity]) if each.is_optional else forms[each.quantity],
                attrgetter("value" if len(kind.fields) == 1 else f"value.{each.name}"),
                legacy_default=MISSING if each.default is ... else each.default,
            )
            for each in kind.fields
        ),
        *([Field("velocities", list_of(optional(VELOCITY)), default=())] * (forms is IN_FILES)),
    )


LAYER_KEYS = {name: list_of(key_codec(kind)) for name, kind in LAYER_KINDS.items()}


def _write_channels(given: tuple[ChannelKeys, tuple[object, ...]]) -> list[Any]:
    """Return the channels of a layer, then those that this version could not read."""
    channels, unread = given
    written = [
        {"kind": name, "keys": LAYER_KEYS[name].write(keys)}
        | ({} if part is None else {"part": part})
        for (name, part), keys in channels.items()
    ]
    return [*written, *unread]


def _read_channels(content: object, where: str) -> tuple[ChannelKeys, tuple[object, ...]]:
    """Return the channels of a layer, and the JSON of those that this version cannot read."""
    channels: dict[Any, tuple[Key[Any], ...]] = {}
    unread = []
    for index, each in enumerate(as_list(content, where)):
        at, fields = f"{where}[{index}]", each if isinstance(each, dict) else {}
        name, part = fields.get("kind"), fields.get("part")
        kind = LAYER_KINDS.get(name) if isinstance(name, str) else None
        if kind is None or (part is None) == (kind.of_handles or kind.of_sliders):
            unread.append(each)
            continue
        own = as_whole if kind.of_handles else as_text
        channel = kind.name, None if part is None else own(part, f"{at}.part")
        if channel in channels:
            raise LissomError(_(DUPLICATE_CHANNEL).format(where=at))
        channels[channel] = LAYER_KEYS[kind.name].read(as_object(each, at)["keys"], f"{at}.keys")
    return channels, tuple(unread)


CHANNELS = Codec(_write_channels, _read_channels)

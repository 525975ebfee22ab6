"""Attachments, switch groups and the canvas in a pose script."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from app.document import SWITCH, Key
from app.errors import LissomError
from app.solving.script.channels import read_pairs
from app.solving.script.fields import check_frame_order, read_fields, read_frame
from app.storage import JsonObject, as_flag, as_list, as_point, as_text, as_whole, repr_for_error
from app.texts import _

SWITCH_GROUP_FIELDS = ("name", "layers", "keys")
ATTACHMENT_FIELDS = ("to", "at", "turn", "frame", "keep")


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
    keys: tuple[Key[str], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptLimb:
    """Layers that bend as bones, by name: from the root to the end."""

    layers: tuple[str, ...]
    side: int = 0  # to which they bend


def parse_limbs(content: object, names: Sequence[str | None]) -> tuple[ScriptLimb, ...]:
    """Return limbs of layers: lists of names, or objects with "layers" and "side"."""
    limbs = []
    for index, entry in enumerate(as_list(content, "bones")):
        where = f"bones[{index}]"
        limb: JsonObject | dict[str, object] = {"layers": entry}
        if not isinstance(entry, list):
            limb = read_fields(entry, where, ("layers", "side"))
        layers = tuple(as_text(each, where) for each in as_list(limb["layers"], where))
        side = as_whole(limb.get("side", 0), f"{where}.side")
        if len(layers) < 2 or len({*layers}) < len(layers):
            raise LissomError(
                _("{where} must name at least two different layers, from root to end").format(
                    where=where
                )
            )
        unknown = [each for each in layers if each not in names]
        if unknown:
            raise LissomError(
                _("{where}: the script has no layer {name!r}; give it an entry first").format(
                    where=where, name=unknown[0]
                )
            )
        if side not in {-1, 0, 1}:
            raise LissomError(
                _("{where}.side must be -1, 0 or 1, not {side}").format(where=where, side=side)
            )
        limbs.append(ScriptLimb(layers=layers, side=side))
    ends = Counter(limb.layers[-1] for limb in limbs)
    for name, count in ends.items():
        if count > 1:
            raise LissomError(
                _("two rows of bones end at {name!r}; leave one out").format(name=name)
            )
    for name, count in Counter(each for limb in limbs for each in limb.layers[:-1]).items():
        if count > 1:
            text = _("{name!r} is in two rows of bones; a layer can bend in one of them only")
            raise LissomError(text.format(name=name))
    return tuple(limbs)


def parse_members(content: object, where: str) -> tuple[str, ...]:
    """Return the names of layers that bend as one."""
    names = tuple(as_text(each, where) for each in as_list(content, where))
    if len(names) < 2 or len({*names}) < len(names):
        raise LissomError(
            _("{where} must name at least two different layers that bend as one").format(
                where=where
            )
        )
    return names


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


def parse_switch_groups(
    script: JsonObject, switched: Sequence[str | None]
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
    keys = read_pairs(SWITCH, fields.get("keys", []), f"{where}.keys")
    for index, key in enumerate(keys):
        if key.value not in layers:
            raise LissomError(
                _("{where} shows {layer!r}, which is not among its layers").format(
                    where=f"{where}.keys[{index}]", layer=key.value
                )
            )
    name = as_text(fields["name"], f"{where}.name").strip()
    if not name:
        raise LissomError(_("{where}.name is empty; give the switch a name").format(where=where))
    return ScriptSwitchGroup(name=name, layers=layers, keys=keys)


def check_distinct_layers(names: Sequence[str | None]) -> None:
    """Refuse a script that names a layer twice."""
    for name in names:
        if names.count(name) > 1:
            raise LissomError(
                _("two layers have the name {name!r}; rename one of them, or leave one out").format(
                    name=name
                )
            )


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

"""What a pose script says of its layers together: what hangs on what, and which take turns."""

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from app.errors import LissomError
from app.solving.script_fields import fields_in, frame_of, require_order
from app.storage import JsonObject, as_flag, as_list, as_point, as_text, as_whole

CHOICE_FIELDS = ("name", "layers", "keys")
JOINT_FIELDS = ("to", "at", "turn", "frame", "keep")


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptJoint:
    """The layer that a figure hangs on from a frame on, and where the joint is as it was drawn."""

    to: str | None  # None lets it go
    at: complex | None  # None takes the nearest point at that frame
    turns: bool = True
    frame: int = 0
    keeps: bool = False  # whether nothing jumps at that frame


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptChoice:
    """Layers that take turns, by their names, and which is seen from which frame on."""

    name: str
    layers: tuple[str, ...]
    turns: tuple[tuple[int, str], ...] = ()


def parse_joints(content: object, where: str) -> tuple[ScriptJoint, ...]:
    """Return the joints of a figure: one, or several from one frame to the next."""
    if not isinstance(content, list):
        return (_joint(content, where),)
    joints = tuple(_joint(each, f"{where}[{index}]") for index, each in enumerate(content))
    require_order([joint.frame for joint in joints], f"{where} is")
    return joints


def _joint(content: object, where: str) -> ScriptJoint:
    joint = fields_in(content, where, JOINT_FIELDS)
    keeps = as_flag(joint.get("keep", False), f"{where}.keep")
    if joint["to"] is None:
        for name in ("at", "turn"):
            if name in joint:
                raise LissomError(f"{where} lets go, so that it has no {name}; leave that out")
    to = None if joint["to"] is None else as_text(joint["to"], f"{where}.to")
    at = None if to is None or (keeps and "at" not in joint) else joint["at"]
    return ScriptJoint(
        to=to,
        at=None if at is None else as_point(at, f"{where}.at"),
        turns=as_flag(joint.get("turn", True), f"{where}.turn"),
        frame=frame_of(joint, where) if "frame" in joint else 0,
        keeps=keeps,
    )


def parse_choices(script: JsonObject, switched: Sequence[str]) -> tuple[ScriptChoice, ...]:
    """Return the choices of a script.

    Parameters
    ----------
    script : JsonObject
    switched : sequence of str
        The layers that have frames of their own at which they are seen.
    """
    entries = as_list(script.get("choices", []), "choices")
    choices = [_choice(entry, f"choices[{index}]") for index, entry in enumerate(entries)]
    for name, count in Counter(choice.name for choice in choices).items():
        if count > 1:
            raise LissomError(f"two choices are called {name!r}")
    layers = Counter(layer for choice in choices for layer in choice.layers)
    for layer, count in layers.items():
        if count > 1:
            raise LissomError(f"the layer {layer!r} is in two choices; leave it out of one")
        if layer in switched:
            raise LissomError(
                f"the layer {layer!r} is in a choice, which alone decides when it is seen; leave "
                "out its visible"
            )
    return tuple(choices)


def _choice(content: object, where: str) -> ScriptChoice:
    fields = fields_in(content, where, CHOICE_FIELDS)
    layers = tuple(
        as_text(layer, f"{where}.layers") for layer in as_list(fields["layers"], f"{where}.layers")
    )
    if len(layers) < 2:
        raise LissomError(f"{where}.layers must be two layers or more")
    for layer, count in Counter(layers).items():
        if count > 1:
            raise LissomError(f"{where}.layers has {layer!r} twice")
    turns = []
    for index, entry in enumerate(as_list(fields.get("keys", []), f"{where}.keys")):
        at = f"{where}.keys[{index}]"
        pair = as_list(entry, at)
        if len(pair) != 2:
            raise LissomError(f"{at} must be a frame and a layer, not {json.dumps(pair)}")
        turn = as_whole(pair[0], at), as_text(pair[1], at)
        if turn[1] not in layers:
            raise LissomError(f"{at} shows {turn[1]!r}, which is not among its layers")
        turns.append(turn)
    require_order([frame for frame, _ in turns], f"{where}.keys are")
    return ScriptChoice(
        name=as_text(fields["name"], f"{where}.name"), layers=layers, turns=tuple(turns)
    )

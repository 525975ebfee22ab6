"""The joints of a drawing: from JSON files, or guessed."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from app.document import Layer
from app.errors import LissomError
from app.rigging import Motion, find_kind
from app.solving.motion_preset.joint_guess import guess_joints, guess_layer_kind
from app.storage import as_object, as_point, as_text, load_json, repr_for_error
from app.texts import _
from engine.arrays import Bytes

SCHEMA = 1
LARGEST = 1024 * 1024  # bytes
FIELDS = ("schema", "kind", "joints")
WHOLE = "anything"  # motions of the whole drawing suit any kind


@dataclass(frozen=True, slots=True, kw_only=True)
class JointsFile:
    kind: str | None  # None lets the program guess
    joints: Mapping[str, complex]  # in pixels from the lower left corner, y up


class LayerJoints(NamedTuple):
    kind: str
    joints: Mapping[str, complex]  # empty if the drawing moves as a whole


def find_joints(
    layer: Layer, motion: Motion, given: JointsFile, rgba: Bytes | None = None
) -> LayerJoints:
    """Return the kind and the joints of a drawing, guessed from its picture if not given."""
    kind = given.kind
    if kind is None:
        if given.joints:
            raise LissomError(
                _(
                    'the file of joints does not name the kind of body; add "kind" to it, or give '
                    "--kind"
                )
            )
        kind = guess_layer_kind(layer, rgba).name
        if kind not in motion.kinds and WHOLE in motion.kinds:
            kind = WHOLE
    joints = given.joints
    if not joints and find_kind(kind).parents:
        joints = guess_joints(layer, kind, rgba).joints
        if not joints:
            raise LissomError(
                _("Lissom found no joints for {kind!r} in the drawing; give --joints").format(
                    kind=kind
                )
            )
    return LayerJoints(kind, joints)


def load_joints(path: Path) -> JointsFile:
    """Read the joints of a drawing; an invalid or missing file raises a `LissomError`."""
    return load_json(path, _parsed, largest=LARGEST)


def _parsed(content: object) -> JointsFile:
    read = as_object(content, _("the file of joints"))
    for name in read:
        if name not in FIELDS:
            raise LissomError(
                _("the file of joints has an unknown field {name!r}; it may have {fields}").format(
                    name=name, fields=", ".join(FIELDS)
                )
            )
    schema = read["schema"]
    if schema != SCHEMA or isinstance(schema, bool):
        raise LissomError(
            _("schema must be {own}, not {content}").format(
                own=SCHEMA, content=repr_for_error(schema)
            )
        )
    kind = None if read.get("kind") is None else as_text(read["kind"], "kind")
    if kind is not None:
        find_kind(kind)
    joints = {
        name: as_point(place, f"joints.{name}")
        for name, place in as_object(read.get("joints", {}), "joints").items()
    }
    feet = [at.imag for name, at in joints.items() if name.startswith("foot")]
    if feet and "head" in joints and min(feet) > joints["head"].imag:
        raise LissomError(
            _("the feet are above the head; give pixels from the lower left corner, with y up")
        )
    return JointsFile(kind=kind, joints=joints)

"""Poses in a pose script: of keys, and of sliders."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Any

from app.document import LINEAR, Bone, Easing, TangentMode
from app.errors import LissomError
from app.solving.script.fields import (
    check_handle_name,
    read_easing_and_tangent,
    read_fields,
    read_frame,
)
from app.storage import JsonObject, as_number, as_object, as_point, repr_for_error
from app.texts import N_, _

POSE_FIELDS = ("targets", "turn", "angle", "side", "pull")
KEY_FIELDS = ("frame", *POSE_FIELDS, "ease", "passing", "front")
NO_JOINT = N_(
    "{where}.side names {name!r}, which is no joint between two bones; name the knee or the elbow "
    "of a chain"
)
NO_END = N_(
    "{where}.angle names {name!r}, where no chain of bones ends; name the foot or the hand of a "
    'chain, or give the rotation as "turn"'
)


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseKey:
    """A key: its frame, the targets of the handles that it moves, and its easing.

    A pose of a slider has no frame.
    """

    frame: int = 0
    targets: Mapping[str, complex]
    pull: float = inf  # largest force on each of them, over the shape's diameter
    ease: Easing = LINEAR
    passing: TangentMode = TangentMode.SMOOTH
    # Rotation of the shape at handles, in radians; other handles keep theirs.
    turns: Mapping[str, float] = field(default_factory=dict)
    angles: Mapping[str, float] = field(default_factory=dict)  # the same at ends of limbs
    # To which side joints of bones bend: 1 to the left of the way from root to end, or -1.
    sides: Mapping[str, int] = field(default_factory=dict)


def parse_key(content: object, where: str, handles: Collection[str]) -> PoseKey:
    """Return a key; `handles` are the names of the handles."""
    key = read_fields(content, where, KEY_FIELDS)
    ease, passing = read_easing_and_tangent(key, where)
    return PoseKey(
        frame=read_frame(key, where), ease=ease, passing=passing, **read_pose(key, where, handles)
    )


def read_pose(key: JsonObject, where: str, handles: Collection[str]) -> dict[str, Any]:
    """Return the targets, turns, angles, sides and pull of a key."""
    targets = {
        name: as_point(place, f"{where}.targets.{name}")
        for name, place in as_object(key.get("targets", {}), f"{where}.targets").items()
    }
    turns, angles = (
        {
            name: math.radians(as_number(turn, f"{where}.{field}.{name}"))
            for name, turn in as_object(key.get(field, {}), f"{where}.{field}").items()
        }
        for field in ("turn", "angle")
    )
    sides = {
        name: _side(side, f"{where}.side.{name}")
        for name, side in as_object(key.get("side", {}), f"{where}.side").items()
    }
    for name in (*targets, *turns, *angles, *sides):
        check_handle_name(name, handles, where)
    pull = as_number(key["pull"], f"{where}.pull") if "pull" in key else inf
    if not pull > 0:
        raise LissomError(
            _("{where}.pull must be positive, not {pull:g}").format(where=where, pull=pull)
        )
    return {"targets": targets, "turns": turns, "angles": angles, "sides": sides, "pull": pull}


def _side(content: object, where: str) -> int:
    if content not in {1, -1} or isinstance(content, bool):
        raise LissomError(
            _(
                "{where} must be 1 or -1, not {content}: 1 bends the joint to the left of the way "
                "from root to end"
            ).format(where=where, content=repr_for_error(content))
        )
    return 1 if content == 1 else -1


def check_limbs(key: PoseKey, where: str, bones: Collection[Bone], handles: Sequence[str]) -> None:
    """Refuse sides of handles that are no joints of bones, and angles of those that are no ends."""
    roots, ends = ({handles[bone.ends[i]] for bone in bones if bone.stiffness > 1} for i in (0, 1))
    for name in key.sides.keys() - (roots & ends):
        raise LissomError(_(NO_JOINT).format(where=where, name=name))
    for name in key.angles.keys() - (ends - roots):
        raise LissomError(_(NO_END).format(where=where, name=name))

"""Poses in a pose script: of keys, and of sliders."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Any

from app.document import LINEAR, Easing, TangentMode
from app.errors import LissomError
from app.solving.script.fields import (
    check_handle_name,
    read_easing_and_tangent,
    read_fields,
    read_frame,
)
from app.storage import JsonObject, as_number, as_object, as_point
from app.texts import _

POSE_FIELDS = ("targets", "turn", "pull")
KEY_FIELDS = ("frame", *POSE_FIELDS, "ease", "passing", "front")


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


def parse_key(content: object, where: str, handles: Collection[str]) -> PoseKey:
    """Return a key; `handles` are the names of the handles."""
    key = read_fields(content, where, KEY_FIELDS)
    ease, passing = read_easing_and_tangent(key, where)
    return PoseKey(
        frame=read_frame(key, where), ease=ease, passing=passing, **read_pose(key, where, handles)
    )


def read_pose(key: JsonObject, where: str, handles: Collection[str]) -> dict[str, Any]:
    """Return the targets, turns and pull of a key."""
    targets = {
        name: as_point(place, f"{where}.targets.{name}")
        for name, place in as_object(key.get("targets", {}), f"{where}.targets").items()
    }
    turns = {
        name: math.radians(as_number(turn, f"{where}.turn.{name}"))
        for name, turn in as_object(key.get("turn", {}), f"{where}.turn").items()
    }
    for name in (*targets, *turns):
        check_handle_name(name, handles, where)
    pull = as_number(key["pull"], f"{where}.pull") if "pull" in key else inf
    if not pull > 0:
        raise LissomError(
            _("{where}.pull must be positive, not {pull:g}").format(where=where, pull=pull)
        )
    return {"targets": targets, "turns": turns, "pull": pull}

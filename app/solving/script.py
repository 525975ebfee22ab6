"""An animation written as a small JSON text: handles, keys and where each key drags the handles."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from app.document import HOLD, LAST_FRAME, LINEAR, NATURAL, VARIANTS, Easing, Passing, Variant
from app.errors import LissomError
from app.storage import JsonObject, as_flag, as_number, as_object, as_point, without_repeats
from engine.maps import Bounds

SCHEMA = 1
FIELDS = ("schema", "fps", "loop", "variant", "bounds", "anchor", "handles", "keys")
KEY_FIELDS = ("frame", "targets", "ease", "passing")
BOUND_FIELDS = ("k", "sigma_a", "sigma_b")


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseKey:
    """One key: its frame, the handles that it moves, and the easing towards the next key."""

    frame: int
    targets: Mapping[str, complex]
    ease: Easing = LINEAR
    passing: Passing = Passing.THROUGH


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseScript:
    """A whole animation over one picture, in pixels of the picture with y up.

    The defaults are those of the file format.
    """

    handles: Mapping[str, complex]
    keys: tuple[PoseKey, ...]
    fps: float = 24.0
    loop: bool = False
    variant: Variant = Variant.METRIC
    bounds: Bounds = NATURAL.bounds
    anchor: complex | None = None


def load_pose_script(path: Path) -> PoseScript:
    """Read a pose script.

    Raises
    ------
    LissomError
        If the file is missing, is not JSON, or says anything that a pose script cannot say.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise LissomError(f"cannot read {path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise LissomError(f"{path} is not a text file in UTF-8") from error
    try:
        return parse_pose_script(json.loads(text, object_pairs_hook=without_repeats))
    except json.JSONDecodeError as error:
        raise LissomError(
            f"{path} is not JSON: {error.msg} in line {error.lineno}, column {error.colno}"
        ) from error
    except RecursionError as error:
        raise LissomError(f"{path} is nested too deeply") from error
    except (LissomError, ValueError) as error:
        raise LissomError(f"{path}: {error}") from error


def parse_pose_script(content: object) -> PoseScript:
    """Turn decoded JSON into a script.

    Raises
    ------
    LissomError
        If a field is unknown, missing or of the wrong kind, a key names an unknown handle, or the
        frames are out of order.
    """
    script = _object(content, "the script", FIELDS)
    schema = script.get("schema")
    if schema != SCHEMA or isinstance(schema, bool):
        raise LissomError(f"schema must be {SCHEMA}, not {json.dumps(schema)}")
    for name in ("handles", "keys"):
        if name not in script:
            raise LissomError(f"{name} is missing")
    handles = {
        name: as_point(place, f"handle {name!r}")
        for name, place in as_object(script["handles"], "handles").items()
    }
    keys = script["keys"]
    if not isinstance(keys, list) or not keys:
        raise LissomError("keys must be a list of at least one key")
    parsed = tuple(_key(key, index, handles) for index, key in enumerate(keys))
    for before, after in pairwise(parsed):
        if after.frame <= before.frame:
            raise LissomError(f"keys are out of order: frame {after.frame} after {before.frame}")
    return PoseScript(handles=handles, keys=parsed, **_options(script))


def _options(script: Mapping[str, Any]) -> dict[str, Any]:
    """Return those of the optional settings that the script gives."""
    options: dict[str, Any] = {}
    if "fps" in script:
        options["fps"] = as_number(script["fps"], "fps")
    if "loop" in script:
        options["loop"] = as_flag(script["loop"], "loop")
    if "variant" in script:
        if script["variant"] not in VARIANTS:
            raise LissomError(
                f"variant must be one of {', '.join(VARIANTS)}, not {json.dumps(script['variant'])}"
            )
        options["variant"] = Variant(script["variant"])
    if "bounds" in script:
        bounds = _object(script["bounds"], "bounds", BOUND_FIELDS)
        given = {name: as_number(value, f"bounds.{name}") for name, value in bounds.items()}
        options["bounds"] = replace(NATURAL.bounds, **given)
    if script.get("anchor") is not None:
        options["anchor"] = as_point(script["anchor"], "anchor")
    return options


def _key(content: object, index: int, handles: Mapping[str, complex]) -> PoseKey:
    where = f"keys[{index}]"
    key = _object(content, where, KEY_FIELDS)
    frame = key.get("frame")
    if not isinstance(frame, int) or isinstance(frame, bool) or not 0 <= frame <= LAST_FRAME:
        raise LissomError(
            f"{where}.frame must be a whole number from 0 to {LAST_FRAME}, not {json.dumps(frame)}"
        )
    targets = {
        name: as_point(place, f"{where}.targets.{name}")
        for name, place in as_object(key.get("targets", {}), f"{where}.targets").items()
    }
    for name in targets:
        if name not in handles:
            raise LissomError(
                f"{where} names the handle {name!r}, but the handles are {', '.join(handles)}"
            )
    ease, passing = _passage(key, where)
    return PoseKey(frame=frame, targets=targets, ease=ease, passing=passing)


def _passage(key: JsonObject, where: str) -> tuple[Easing, Passing]:
    """Return how time runs after a key, and how the motion passes it.

    By default it passes through, or with an easing of its own in a corner.
    """
    ease = Easing.parse(key["ease"]) if "ease" in key else LINEAR
    default = Passing.CORNER if "ease" in key else Passing.THROUGH
    word = key.get("passing", default)
    if word not in list(Passing):
        raise LissomError(
            f"{where}.passing must be one of {', '.join(Passing)}, not {json.dumps(word)}"
        )
    if word != Passing.HOLD:
        return ease, Passing(word)
    if "ease" in key and ease != HOLD:
        raise LissomError(f"{where} holds its pose, so that it has nothing to ease; leave out ease")
    return HOLD, default


def _object(content: object, where: str, fields: tuple[str, ...]) -> JsonObject:
    """Return an object that has none but these fields."""
    read = as_object(content, where)
    for name in read:
        if name not in fields:
            raise LissomError(f"{where} has an unknown field {name!r}; it may have {fields}")
    return read

"""Pose scripts: handles, keys and targets of an animation as JSON."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from app.document import (
    LAYER_KINDS,
    NATURAL,
    VARIANTS,
    VISIBILITY,
    Bone,
    Camera,
    ChannelKeys,
    Cycle,
    Key,
    Spring,
    Track,
    Variant,
)
from app.errors import LissomError
from app.solving.script.channels import parse_camera, parse_channels, parse_opacity
from app.solving.script.fields import (
    NO_KEYS,
    check_frame_order,
    read_fields,
)
from app.solving.script.keys import PoseKey, check_limbs, parse_key
from app.solving.script.layers import (
    ScriptAttachment,
    ScriptLimb,
    ScriptSwitchGroup,
    check_distinct_layers,
    parse_attachments,
    parse_canvas,
    parse_limbs,
    parse_members,
    parse_switch_groups,
)
from app.solving.script.material import StiffRegion, parse_bones, parse_material
from app.solving.script.sliders import ScriptSlider, parse_sliders
from app.solving.script.sounds import ScriptSound, parse_sounds
from app.solving.script.tracks import check_loop_periods, parse_cycles, parse_springs, parse_tracks
from app.storage import (
    JsonObject,
    as_flag,
    as_list,
    as_number,
    as_object,
    as_point,
    as_text,
    load_json,
    repr_for_error,
)
from app.texts import N_, _
from engine.maps import Bounds

SCHEMA = 1
LARGEST = 32 * 1024 * 1024  # bytes
SCENE_FIELDS = ("schema", "fps", "loop", "variant", "bounds", "still", "camera", "canvas", "sounds")
MOVING_FIELDS = (
    *("keys", "tracks", "springs", "sliders", "cycles"),
    *("movement", "opacity", "channels"),
)
OWN_FIELDS = ("anchor", "handles", "bones", *MOVING_FIELDS, "stiff")
STAGE_FIELDS = ("layers", "choices", "bones")
LAYER_FIELDS = ("layer", "variant", "bounds", "still", *OWN_FIELDS, "attach", "visible", "order")
# An entry of several layers that bend as one has "layers", and may name their group by "layer".
GROUP_FIELDS = ("layers", *(name for name in LAYER_FIELDS if name not in {"opacity", "order"}))
# What an entry of a layer may leave out, such as a mouth that moves with its parent.
RESTING: Mapping[str, object] = {"handles": {}, "keys": [{"frame": 0}]}
HANDLE_FIELDS = ("at", "front", "extent", "still")
BOUND_FIELDS = ("k", "sigma_a", "sigma_b")
NO_VARIANT = N_("{where}variant must be one of {variants}, not {content}")
WRONG_SCHEMA = N_("schema must be {own}, not {content}")


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptHandle:
    """A handle: its place in the picture, and its options."""

    at: complex
    front: float = 0.0
    extent: float | None = None
    still: bool = True  # whether auto-pin applies


@dataclass(frozen=True, slots=True, kw_only=True)
class LayerScript:
    """The animation of one layer, in pixels of the canvas, y up.

    The defaults are those of the file format. `layer` is None in a script of a single layer.
    Tracks, springs and bones refer to handles by index into `handles`.
    """

    layer: str | None = None
    members: tuple[str, ...] = ()  # names of the layers that bend as one, as the group `layer`
    handles: Mapping[str, ScriptHandle]
    keys: tuple[PoseKey, ...]
    variant: Variant = Variant.METRIC
    bounds: Bounds = NATURAL.bounds
    anchor: complex | None = None
    still: bool = True
    tracks: tuple[Track, ...] = ()
    springs: tuple[Spring, ...] = ()
    cycles: tuple[Cycle, ...] = ()
    parts: tuple[StiffRegion, ...] = ()
    bones: tuple[Bone, ...] = ()
    attach: tuple[ScriptAttachment, ...] = ()
    opacity: float | None = None  # None keeps the drawing's opacity
    # With names of handles and layers. An empty visibility channel shows a hidden layer.
    channels: ChannelKeys = field(default_factory=dict)
    sliders: tuple[ScriptSlider, ...] = ()

    @property
    def last(self) -> int:
        """The last frame of all repeats and all keys that are interpolated."""
        frames = [self.keys[-1].frame, *(track.keys[-1].frame for track in self.tracks)]
        frames += [cycle.last if cycle.until is None else cycle.until for cycle in self.cycles]
        for (name, _part), keys in self.channels.items():
            frames += [key.frame for key in keys if not LAYER_KINDS[name].is_held]
        frames += [key.frame for slider in self.sliders for key in slider.keys]
        return max(frames)


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseScript:
    """A whole animation."""

    layers: tuple[LayerScript, ...]
    fps: float
    loop: bool
    choices: tuple[ScriptSwitchGroup, ...] = ()
    limbs: tuple[ScriptLimb, ...] = ()
    camera: tuple[Key[Camera], ...] = ()
    canvas: tuple[int, int] | None = None  # None takes the drawing's size
    sounds: tuple[ScriptSound, ...] = ()
    folder: Path = Path()  # of the script and the files that it names

    @property
    def last(self) -> int:
        frames = [layer.last for layer in self.layers]
        return max(frames + [key.frame for key in self.camera])


def load_pose_script(path: Path) -> PoseScript:
    """Read a pose script; an invalid or missing file raises a `LissomError`."""
    return replace(load_json(path, parse_pose_script, largest=LARGEST), folder=path.parent)


def parse_pose_script(content: object) -> PoseScript:
    """Turn decoded JSON into a script.

    Raises a `LissomError` for unknown, missing or wrong fields, unknown handles, and frames out of
    order.
    """
    read = as_object(content, _("the script"))
    if "figures" in read and "layers" not in read:
        # The name of the field in earlier scripts.
        content = {("layers" if name == "figures" else name): read[name] for name in read}
        read = as_object(content, _("the script"))
    own = STAGE_FIELDS if "layers" in read else OWN_FIELDS
    lacking = [name for name in ("choices", "attach", "visible", "order") if name in read]
    if lacking and "layers" not in read:
        raise LissomError(
            _('{field} needs "layers": a list that says what each layer does').format(
                field=lacking[0]
            )
        )
    script = read_fields(content, _("the script"), (*SCENE_FIELDS, *own))
    schema = script["schema"]
    if schema != SCHEMA or isinstance(schema, bool):
        raise LissomError(_(WRONG_SCHEMA).format(own=SCHEMA, content=repr_for_error(schema)))
    usual = _options(script, "")
    loop = as_flag(script.get("loop", False), "loop")
    layers = [] if "layers" in script else [_layer(script, "", usual, loop=loop)]
    for index, entry in enumerate(as_list(script.get("layers", []), "layers")):
        where = f"layers[{index}]."
        is_group = isinstance(entry, dict) and "layers" in entry
        fields = GROUP_FIELDS if is_group else LAYER_FIELDS
        own_fields = {**RESTING, **read_fields(entry, where[:-1], fields)}
        layers.append(_layer(as_object(own_fields, where[:-1]), where, usual, loop=loop))
    names = [layer.layer for layer in layers]
    check_distinct_layers(names)
    if not layers:
        raise LissomError(_("layers must be a list of at least one layer"))
    switched = [each.layer for each in layers if each.channels.get((VISIBILITY.name, None))]
    parsed = PoseScript(
        layers=tuple(layers),
        fps=as_number(script.get("fps", 24.0), "fps"),
        loop=loop,
        choices=parse_switch_groups(script, switched),
        limbs=parse_limbs(script.get("bones", []), names) if "layers" in script else (),
        camera=parse_camera(script["camera"]) if script.get("camera") is not None else (),
        canvas=parse_canvas(script["canvas"]) if script.get("canvas") is not None else None,
        sounds=parse_sounds(script.get("sounds", [])),
    )
    for index, layer in enumerate(layers if parsed.loop else ()):
        where = "" if layer.layer is None else f"layers[{index}]."
        check_loop_periods(layer.tracks, layer.springs, parsed.last, where)
    return parsed


def _layer(script: JsonObject, where: str, usual: Mapping[str, Any], *, loop: bool) -> LayerScript:
    """Return the script of one layer; `where` begins the names of its fields in errors."""
    own: dict[str, Any] = {**usual, **_options(script, where)}
    if where:
        if "layers" in script:
            own["members"] = parse_members(script["layers"], f"{where}layers")
        if "layer" in script or "members" not in own:
            own["layer"] = as_text(script["layer"], f"{where}layer")
        else:
            own["layer"] = " + ".join(own["members"])
    handles = {
        name: _handle(handle, f"{where}handle {name!r}")
        for name, handle in as_object(script["handles"], f"{where}handles").items()
    }
    keys = script["keys"]
    if not isinstance(keys, list) or not keys:
        raise LissomError(_(NO_KEYS).format(where=f"{where}keys"))
    parsed = tuple(
        parse_key(key, f"{where}keys[{index}]", handles) for index, key in enumerate(keys)
    )
    check_frame_order([key.frame for key in parsed], f"{where}keys")
    if script.get("anchor") is not None:
        own["anchor"] = as_point(script["anchor"], f"{where}anchor")
    if script.get("attach") is not None:
        own["attach"] = parse_attachments(script["attach"], f"{where}attach")
    own["opacity"] = parse_opacity(script.get("opacity"), f"{where}opacity")
    depths = {name: handle.front for name, handle in handles.items()}
    own["channels"] = parse_channels(script, where, depths, loop=loop)
    own["tracks"] = parse_tracks(script.get("tracks", []), f"{where}tracks", tuple(handles))
    own["springs"] = parse_springs(script.get("springs", []), f"{where}springs", tuple(handles))
    own["cycles"] = parse_cycles(
        script.get("cycles", []), f"{where}cycles", [key.frame for key in parsed]
    )
    bones = parse_bones(script.get("bones", []), f"{where}bones", tuple(handles))
    own["parts"], strips = parse_material(script.get("stiff", []), f"{where}stiff", tuple(handles))
    own["bones"] = (*bones, *strips)
    own["sliders"] = parse_sliders(script.get("sliders", []), f"{where}sliders", handles)
    posed = [(f"{where}keys[{index}]", key) for index, key in enumerate(parsed)]
    posed += [(f"{where}sliders", key) for slider in own["sliders"] for key in slider.poses]
    for place, key in posed:
        check_limbs(key, place, own["bones"], tuple(handles))
    return LayerScript(handles=handles, keys=parsed, **own)


def _handle(content: object, where: str) -> ScriptHandle:
    if isinstance(content, list):
        return ScriptHandle(at=as_point(content, where))
    handle = read_fields(content, where, HANDLE_FIELDS)
    extent = handle.get("extent")
    return ScriptHandle(
        at=as_point(handle["at"], f"{where}.at"),
        front=as_number(handle.get("front", 0.0), f"{where}.front"),
        extent=None if extent is None else as_number(extent, f"{where}.extent"),
        still=as_flag(handle.get("still", True), f"{where}.still"),
    )


def _options(script: Mapping[str, Any], where: str) -> dict[str, Any]:
    options: dict[str, Any] = {}
    if "variant" in script:
        if script["variant"] not in VARIANTS:
            raise LissomError(
                _(NO_VARIANT).format(
                    where=where,
                    variants=", ".join(VARIANTS),
                    content=repr_for_error(script["variant"]),
                )
            )
        options["variant"] = Variant(script["variant"])
    if "bounds" in script:
        bounds = read_fields(script["bounds"], f"{where}bounds", BOUND_FIELDS)
        given = {name: as_number(value, f"{where}bounds.{name}") for name, value in bounds.items()}
        options["bounds"] = replace(NATURAL.bounds, **given)
    if "still" in script:
        options["still"] = as_flag(script["still"], f"{where}still")
    return options

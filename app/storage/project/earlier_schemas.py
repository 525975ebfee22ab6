"""Fields of earlier schemas, converted to the present ones before they are read."""

from typing import Any

from app.storage.json_values import JsonObject, as_list, as_object, as_whole
from app.storage.project.codecs import NUMBER, WHOLE, list_of, pair
from app.texts import N_

# Kinds of channels by a layer's fields of schema 3, and of schemas 1 and 2.
FIELDS = {
    **dict.fromkeys(("visibility_keys", "switches"), "visibility"),
    **dict.fromkeys(("opacity_keys", "opacities"), "opacity"),
    **dict.fromkeys(("transform_keys", "movement"), "transform"),
    **dict.fromkeys(("draw_order_keys", "placings"), "draw_order"),
}
DEPTHS = list_of(pair(WHOLE, NUMBER, N_("a handle and a number")))


def update_schema(content: JsonObject) -> None:
    """Give a document of an earlier schema the present fields, so that nothing looks different."""
    schema = as_whole(content["schema"], "schema")
    if schema == 1:
        # The preview range was exported, unless exports had frames of their own.
        content |= {"preview": content.pop("work"), "markers": []}
        export = as_object(content["export"], "export")
        if export["frames"] is None:
            content["export"] = {**export, "frames": content["preview"]}
        for layer in _objects(content, "figures"):
            layer |= {"library": [], "mirror": None}
    if schema < 4:
        _collect_channels(content)
    if schema < 5:
        for layer in _objects(content, "figures" if "figures" in content else "layers"):
            _ignore_transform(layer)


def _collect_channels(content: JsonObject) -> None:
    """Collect each layer's keys in its channels. Up to schema 3, each kind had a field."""
    for layer in _objects(content, "figures" if "figures" in content else "layers"):
        _add_channels(layer, is_loop=content["loop"] is True)
        _number_motions(layer)
    if "camera" in content:
        content["camera"] = _records(content["camera"], "camera")
    for name in {"choices", "switch_groups"} & content.keys():
        for switch in _objects(content, name):
            keys = switch.pop("turns") if "turns" in switch else switch["keys"]
            switch["keys"] = _records(keys, f"{switch.where}.keys", "layer")


def _ignore_transform(layer: JsonObject) -> None:
    """Keep the transform of a layer without an effect at its joints, as it was up to schema 4."""
    kinds = [
        each.get("kind")
        for each in as_list(layer.get("channels", []), "channels")
        if isinstance(each, dict)
    ]
    if "transform" not in kinds:
        return
    joints = [layer.get("attachment"), *as_list(layer.get("handovers", []), "handovers")]
    for joint in joints:
        if isinstance(joint, dict):
            joint["applies_transform"] = False


def _add_channels(layer: JsonObject, *, is_loop: bool) -> None:
    """Collect the keys of a layer, and the depths in its poses.

    Before the first pose of a loop, its last depths hold. The first pose keeps a handle's own
    depth if it sets no other.
    """
    channels: list[Any] = [
        {"kind": kind, "keys": _records(layer.pop(name), f"{layer.where}.{name}", "visible")}
        for name, kind in FIELDS.items()
        if name in layer
    ]
    depths: dict[int, list[Any]] = {}
    poses = _objects(layer, "keys")
    for pose in poses:
        name = "depths" if "depths" in pose else "fronts"
        for handle, depth in dict(DEPTHS.read(pose.pop(name, []), f"{pose.where}.{name}")).items():
            depths.setdefault(handle, []).append({"frame": pose["frame"], "depth": depth})
    for handle in _objects(layer, "handles") if is_loop else ():
        keys = depths.get(as_whole(handle["id"], f"{handle.where}.id"), [])
        if keys and keys[0]["frame"] != poses[0]["frame"]:
            own = handle.get("depth", handle.get("front", 0.0))
            keys.insert(0, {"frame": poses[0]["frame"], "depth": own})
    channels += [{"kind": "depth", "part": part, "keys": keys} for part, keys in depths.items()]
    if channels:
        layer["channels"] = channels


def _number_motions(layer: JsonObject) -> None:
    """Number the motions of a layer; keys in the range of a motion, after its blend in, are its."""
    for number, motion in enumerate(as_list(layer.get("motions", []), "motions"), start=1):
        if not isinstance(motion, dict):
            continue
        motion["id"] = number
        start, last = motion.get("start"), motion.get("last")
        for key in _objects(layer, "keys"):
            if isinstance(start, int) and isinstance(last, int) and start <= key["frame"] <= last:
                key["motion"] = number


def _records(content: object, where: str, name: str = "") -> list[Any]:
    """Return keys as objects. Some were pairs of a frame and a value, which is called `name`."""
    return [
        dict(zip(("frame", name), each, strict=True))
        if isinstance(each, list) and len(each) == 2
        else {"tangent_mode" if field == "passing" else field: each[field] for field in each}
        if isinstance(each, dict)
        else each
        for each in as_list(content, where)
    ]


def _objects(content: JsonObject, name: str) -> list[JsonObject]:
    """Return the objects in a field; a change of them changes the content."""
    where = name if content.where == "project.json" else f"{content.where}.{name}"
    content[name] = objects = [
        as_object(each, f"{where}[{i}]") for i, each in enumerate(as_list(content[name], where))
    ]
    return objects

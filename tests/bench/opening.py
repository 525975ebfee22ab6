"""Opening projects: 1 MB of each kind of thing that a project holds, by the clock."""

import json
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.document import (
    clip_of,
    composite_layers,
    depth_points_at,
    export_frame_range,
    layer_tree,
    suggest_switch_groups,
    visibility_keys,
)
from app.errors import LissomError
from app.storage import load_project, sample_images, save_project
from tests.bench.table import Row, Table

SAMPLE = "giraffe.lissom"
Content = dict[str, Any]
# Changes a project's JSON so that it holds so many bytes of something.
Filling = Callable[[Content, int], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    size: int = 1_000_000  # bytes of each kind


BRIEF = Extent(size=3_000)


def tables(extent: Extent) -> Iterator[Table]:
    """Open projects that hold much of one kind, and ask what is shown of them first."""
    members = _two_layers()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, fill in {"as it is": lambda _, __: None, **FILLINGS}.items():
            content = json.loads(members["project.json"])
            content["frames"] = [0, 999_999]
            fill(content, extent.size)
            path = Path(folder) / SAMPLE
            _write(path, members | {"project.json": json.dumps(content).encode()})
            rows.append(_opened(name, path))
    yield Table(
        title=f"Opening {SAMPLE}, twice in one scene, with {extent.size:,} bytes more",
        rows=tuple(rows),
    )


def _two_layers() -> dict[str, bytes]:
    """Return the members of a project in the present schema, with the sample twice."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / SAMPLE
        save_project(path, load_project(sample_images() / SAMPLE))
        with zipfile.ZipFile(path) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
    content = json.loads(members["project.json"])
    (layer,) = content["layers"]
    content["layers"].append(layer | {"id": 1, "name": "other"})
    twice = {name.replace("layers/0/", "layers/1/"): each for name, each in members.items()}
    return members | twice | {"project.json": json.dumps(content).encode()}


def _write(path: Path, members: Mapping[str, bytes]) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name, data)


def _opened(name: str, path: Path) -> Row:
    """Open a project, and ask of its layers what a window asks first."""
    begun, refusal = time.process_time(), ""
    try:
        document = load_project(path)
    except LissomError as error:
        _, _, refusal = str(error).partition(": ")
    else:
        layer_tree(document)
        suggest_switch_groups(document)
        composite_layers(document, {}, document.frames.last)
        export_frame_range(document)
        for layer in document.layers:
            visibility_keys(document, layer)
            depth_points_at(clip_of(document, layer.id), document.frames.last)
            document.parent_chain(layer.id, document.frames.last)
    return Row(name=name, seconds=time.process_time() - begun, note=refusal[:90])


def _many(size: int, make: Callable[[int], Any]) -> list[Any]:
    """Return as many things as take so many bytes; they are made of numbers from 0 on."""
    length = len(json.dumps(make(size // 60))) + 2
    return [make(number) for number in range(max(2, size // length))]


def _of_scene(name: str, make: Callable[[int], Any]) -> Filling:
    return lambda content, size: content.update({name: _many(size, make)})


def _of_layer(name: str, make: Callable[[int], Any]) -> Filling:
    return lambda content, size: content["layers"][0].update({name: _many(size, make)})


def _of_channel(kind: str, make: Callable[[int], Any]) -> Filling:
    return lambda content, size: content["layers"][0].update(
        channels=[{"kind": kind, "keys": _many(size, make)}]
    )


def _key(number: int, **own: Any) -> Content:
    return {"frame": number, "easing": "linear", "tangent_mode": "through", **own}


def _turns(content: Content, size: int) -> None:
    turns = _many(size, lambda number: {"frame": number, "layer": number % 2})
    content["switch_groups"] = [{"name": "mouth", "layers": [0, 1], "keys": turns}]


def _hang(content: Content, joints: list[Content]) -> None:
    layer = content["layers"][0]
    layer["anchor"] = layer["handles"][0]["position"]
    layer["attachment"], *layer["handovers"] = joints


def _joint(frame: int, to: int | None) -> Content:
    return {
        "frame": frame,
        "parent": to,
        "parent_point": [0, 0],
        "inherits_rotation": True,
        "rest_rotation": 0.0,
    }


def _joints(content: Content, size: int) -> None:
    _hang(content, _many(size, lambda number: _joint(number, 1 - number % 2 or None)))


def _circle(content: Content, size: int) -> None:
    """Let two layers carry each other in turn, in 59,000 frames for 1 MB."""
    _hang(content, [_joint(0, 1), _joint(1, None)])
    first, second = content["layers"]
    second |= {"anchor": first["anchor"], "attachment": _joint(1, 0)}
    second["handovers"] = [_joint(2, None)]
    repeat = {"first": 0, "last": 3, "until": None}
    for each in content["layers"]:
        each.update(keys=each["keys"][:1], cycles=[repeat])
    content["frames"] = [0, 59 * size // 1_000]


def _track(content: Content, size: int) -> None:
    layer = content["layers"][0]
    keys = _many(size, lambda number: _key(number, place=[0, 0]))
    layer["tracks"] = [{"handles": [layer["handles"][0]["id"]], "keys": keys}]


def _repeats(content: Content, size: int) -> None:
    """Let a layer come and go in every other frame."""
    layer = content["layers"][0]
    repeat = {"first": 0, "last": 2, "until": None}
    layer |= {"keys": layer["keys"][:1], "cycles": [repeat]}
    keys = [{"frame": 0, "visible": True}, {"frame": 1, "visible": False}]
    layer["channels"] = [{"kind": "visibility", "keys": keys}]
    content["frames"] = [0, 59 * size // 1_000]


MOTION = {
    "motion": "breathe",
    "kind": "anything",
    "joints": {},
    "facing": 1,
    "repeat_count": 1,
    "digest": "",
    "parameters": {
        "speed": 1.0,
        "size": 1.0,
        "energy": 1.0,
        "start": 0.0,
        "mirrored": False,
        "travel": False,
    },
}
FILLINGS: dict[str, Filling] = {
    "pairs": _of_scene("pairs", lambda number: [f"a{number}", f"b{number}"]),
    "markers": _of_scene("markers", lambda number: {"frame": number, "name": "beat"}),
    "groups": _of_scene("groups", lambda number: {"name": f"mouth {number}"}),
    "camera keys": _of_scene("camera", lambda n: _key(n, centre=[0, 0], zoom=1.0, turn=0.0)),
    "turns of a switch": _turns,
    "fields not known": _of_scene("later", lambda number: {"value": number}),
    "visibility keys": _of_channel("visibility", lambda n: {"frame": n, "visible": n % 2 == 0}),
    "movement keys": _of_channel("transform", lambda n: _key(n, shift=[0, 0], turn=0.0)),
    "opacity keys": _of_channel("opacity", lambda number: _key(number, opacity=0.5)),
    "draw order keys": _of_channel(
        "draw_order", lambda n: {"frame": n, "beside": 1, "in_front": n % 2 == 0}
    ),
    "track keys": _track,
    "joints": _joints,
    "joints in a circle that repeat": _circle,
    "visibility keys that repeat": _repeats,
    "stretches that repeat": _of_layer(
        "cycles", lambda n: {"first": 100 + 4 * n, "last": 102 + 4 * n, "until": 103 + 4 * n}
    ),
    "motions": _of_layer(
        "motions", lambda n: MOTION | {"id": n, "first": 3 * n, "start": 3 * n, "last": 3 * n + 2}
    ),
}

"""glTF 2.0 in one binary file: textured meshes, morph targets, and their weights in time.

Source: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
"""

import struct
from importlib.metadata import version
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from app.errors import display_name
from app.export.morph_mesh import MorphMesh, MorphScene
from app.export.node_motion import NodeMotion
from app.export.plan import ExportPlan
from app.export.writers.png import encode_png
from app.storage import strict_json
from engine.arrays import Complexes, Floats

PIXELS_PER_METRE: Final = 100  # the usual scale of sprites in game engines
_LAYER: Final = 0.01  # metres between two adjacent layers
_UNLIT: Final = "KHR_materials_unlit"
# Component types of glTF.
_UINT16, _UINT32, _FLOAT = 5123, 5125, 5126
_VERTICES, _INDICES = 34962, 34963
_LINEAR, _LINEAR_MIPMAPS, _CLAMP = 9729, 9987, 33071
_MOST_UINT16: Final = 65_534  # the largest number ends strips
_COMPONENTS: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def build_glb(scene: MorphScene, plan: ExportPlan) -> bytes:
    """Return a glTF file of layers, back to front."""
    asset = _Asset(plan)
    for shape in scene.meshes:
        asset.add(shape)
    return asset.file()


class _Asset:
    """A glTF file under construction: its JSON and its only buffer."""

    def __init__(self, plan: ExportPlan) -> None:
        width, _ = plan.canvas
        self._origin = complex(width / 2, 0)
        self._binary = bytearray()
        self._lists: dict[str, list[dict[str, Any]]] = {}
        self._channels: list[dict[str, Any]] = []
        self._samplers: list[dict[str, Any]] = []
        self._plan = plan
        self._roots: list[int] = []  # nodes of the scene

    def add(self, shape: MorphMesh) -> None:
        """Add a layer as a node with a mesh, a material and an animation."""
        motion = shape.node
        pivot = self._origin if motion is None else motion.pivot
        base, targets = shape.motion.base - pivot, shape.motion.targets
        weights = np.clip(shape.motion.weights, 0.0, 1.0)
        primitive: dict[str, Any] = {
            "attributes": {
                "POSITION": self._places(base),
                "TEXCOORD_0": self._numbers(shape.uv * (1, -1) + (0, 1), "VEC2", _VERTICES),
            },
            "indices": self._indices(shape),
            "material": self._material(shape),
        }
        mesh: dict[str, Any] = {"name": shape.name, "primitives": [primitive]}
        if len(targets):
            primitive["targets"] = [{"POSITION": self._places(target)} for target in targets]
            # Viewers without animation show the drawing at rest; a single frame shows its pose.
            is_still = len(weights) == 1
            mesh["weights"] = weights[0].tolist() if is_still else [0.0] * len(targets)
            names = [f"shape {number}" for number in range(1, len(targets) + 1)]
            mesh["extras"] = {"targetNames": names}
        node: dict[str, Any] = {"name": shape.name, "mesh": self._list("meshes", mesh)}
        height = _LAYER * len(self._roots)
        if motion is not None:
            node |= {name: rows[0].tolist() for name, rows in self._rows(motion, height).items()}
        elif height:
            node["translation"] = [0.0, 0.0, height]
        number = root = self._list("nodes", node)
        if len(targets) and len(weights) > 1:
            values = self._numbers(weights.ravel(), "SCALAR")
            self._animate(number, "weights", shape.motion.times, (values, "LINEAR"))
        hides = len(shape.visibility_changes) > 1 or not shape.visibility_changes[0][1]
        if motion is not None and len(motion.times) > 1:
            for name, rows in self._rows(motion, height).items():
                if np.ptp(rows, axis=0).any():
                    values = self._numbers(rows, f"VEC{rows.shape[1]}")
                    self._animate(number, name, motion.times, (values, "LINEAR"))
            if hides:
                # A node around it is hidden, since its own scale may be animated.
                root = self._list("nodes", {"name": shape.name, "children": [number]})
        self._roots.append(root)
        if hides:
            moments, seen = (
                np.array(column, dtype=np.float64)
                for column in zip(*shape.visibility_changes, strict=True)
            )
            # Scale 0 hides a layer.
            values = self._numbers(np.repeat(seen, 3), "VEC3")
            self._animate(root, "scale", moments, (values, "STEP"))

    def _rows(self, motion: NodeMotion, height: float) -> dict[str, Floats]:
        """Return translations (n, 3) in metres, rotations (n, 4) and scales (n, 3) of a layer."""
        x, y, turn, scale = motion.values.T
        flat, ones = np.zeros(len(x)), np.ones(len(x))
        x, y = x - self._origin.real, y - self._origin.imag
        return {
            "translation": np.column_stack(
                [x / PIXELS_PER_METRE, y / PIXELS_PER_METRE, height * ones]
            ),
            "rotation": np.column_stack([flat, flat, np.sin(turn / 2), np.cos(turn / 2)]),
            "scale": np.column_stack([scale, scale, ones]),
        }

    def file(self) -> bytes:
        name = display_name(self._plan.out.stem)
        content: dict[str, Any] = {
            "asset": {
                "version": "2.0",
                "generator": f"Lissom {version('lissom')}",
                "extras": {
                    "pixelsPerMetre": PIXELS_PER_METRE,
                    "origin": [self._origin.real, self._origin.imag],
                },
            },
            "extensionsUsed": [_UNLIT],
            "scene": 0,
            "scenes": [{"name": name, "nodes": self._roots}],
            **self._lists,
            "samplers": [
                {
                    "magFilter": _LINEAR,
                    "minFilter": _LINEAR_MIPMAPS,
                    "wrapS": _CLAMP,
                    "wrapT": _CLAMP,
                }
            ],
        }
        if self._channels:
            animation = {"name": name, "channels": self._channels, "samplers": self._samplers}
            content["animations"] = [animation | {"extras": {"loop": self._plan.loop}}]
        content["buffers"] = [{"byteLength": len(self._binary)}]
        text = strict_json(content).encode()
        chunks = _chunk(b"JSON", text, b" ") + _chunk(b"BIN\0", bytes(self._binary), b"\0")
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def _animate(self, node: int, path: str, times: Floats, output: tuple[int, str]) -> None:
        values, interpolation = output
        moments = self._numbers(times, "SCALAR", extent=True)
        sampler = {"input": moments, "output": values, "interpolation": interpolation}
        self._samplers.append(sampler)
        target = {"node": node, "path": path}
        self._channels.append({"sampler": len(self._samplers) - 1, "target": target})

    def _list(self, kind: str, entry: dict[str, Any]) -> int:
        """Add an entry to one of the lists of the file; return its index."""
        entries = self._lists.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def _view(self, data: bytes, target: int | None = None) -> int:
        self._binary += b"\0" * (-len(self._binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data)}
        self._binary += data
        return self._list("bufferViews", view if target is None else view | {"target": target})

    def _numbers(
        self,
        values: npt.NDArray[np.float64],
        kind: str,
        target: int | None = None,
        *,
        extent: bool = False,
    ) -> int:
        singles = values.astype("<f4").reshape(-1, _COMPONENTS[kind])
        entry: dict[str, Any] = {
            "bufferView": self._view(singles.tobytes(), target),
            "componentType": _FLOAT,
            "count": len(singles),
            "type": kind,
        }
        if extent:
            entry["min"] = singles.min(axis=0).tolist()
            entry["max"] = singles.max(axis=0).tolist()
        return self._list("accessors", entry)

    def _places(self, pixels: Complexes) -> int:
        metres = pixels / PIXELS_PER_METRE
        places = np.column_stack([metres.real, metres.imag, np.zeros(len(metres))])
        return self._numbers(places, "VEC3", _VERTICES, extent=True)

    def _indices(self, shape: MorphMesh) -> int:
        is_small = len(shape.uv) <= _MOST_UINT16
        # glTF has one triangle order for all times.
        _, triangles = shape.triangle_orders[0]
        indices = triangles.astype("<u2" if is_small else "<u4")
        entry = {
            "bufferView": self._view(indices.tobytes(), _INDICES),
            "componentType": _UINT16 if is_small else _UINT32,
            "count": indices.size,
            "type": "SCALAR",
        }
        return self._list("accessors", entry)

    def _material(self, shape: MorphMesh) -> int:
        picture = {
            "name": shape.name,
            "bufferView": self._view(encode_png(shape.texture)),
            "mimeType": "image/png",
        }
        texture = self._list("textures", {"source": self._list("images", picture), "sampler": 0})
        material = {
            "name": shape.name,
            "pbrMetallicRoughness": {
                # A transparent layer shows through itself where it overlaps itself.
                "baseColorFactor": [1.0, 1.0, 1.0, shape.opacity],
                "baseColorTexture": {"index": texture},
                "metallicFactor": 0.0,
                "roughnessFactor": 1.0,
            },
            "alphaMode": "BLEND",
            "doubleSided": True,
            "extensions": {_UNLIT: {}},
        }
        return self._list("materials", material)


def _chunk(kind: bytes, data: bytes, filler: bytes) -> bytes:
    data += filler * (-len(data) % 4)
    return struct.pack("<I", len(data)) + kind + data

"""A self-contained page that plays layers by WebGL 2."""

import base64
import html
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from string import Template
from typing import Any, Final

import numpy as np

from app.document import DEFAULT_EFFECTS, CompositeGroup
from app.errors import display_name
from app.export.framing import find_shown_box
from app.export.morph_mesh import MorphMesh, MorphScene
from app.export.plan import ExportPlan
from app.export.writers.png import encode_png
from app.sound import Soundtrack
from app.storage import shader_source, strict_json
from engine.arrays import Complexes, Floats

_PAGE: Final = Path(__file__).with_name("player.html")
# Declarations that GLSL requires in browsers only.
_HEADER: Final = (
    "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
)
# The renderer's own shader files, for opaque and for composited layers.
_SHADERS: Final = (
    ("vertex", ("mesh.vert", "positions.glsl", "placed.glsl")),
    ("fragment", ("picture.frag", "sample.glsl")),
    ("screen", ("screen.vert",)),
    ("faint", ("ghost.frag", "blend.glsl")),
)


def build_html_page(scene: MorphScene, plan: ExportPlan) -> bytes:
    """Return a page of layers, back to front."""
    box = find_shown_box(plan.view)
    (first, last), colour = plan.span, plan.background
    film = {
        "box": [box.lower.real, box.lower.imag, box.upper.real, box.upper.imag],
        "seconds": (last - first) / plan.timeline_fps,
        "fps": plan.timeline_fps,
        "loop": plan.loop,
        **{name: _HEADER + "\n".join(map(shader_source, files)) for name, files in _SHADERS},
        "figures": [_packed(shape) for shape in scene.meshes],
        "parts": _parts(scene.parts),
        "sound": None if plan.soundtrack is None else _sound(plan.soundtrack),
        "colour": None if colour is None else [level / 255 for level in colour],
    }
    page = Template(_PAGE.read_text(encoding="utf-8")).substitute(
        title=html.escape(display_name(plan.out.stem)),
        generator=f"Lissom {version('lissom')}",
        background="transparent" if colour is None else f"rgb{colour}",
        # No text may close the element around it.
        film=strict_json(film).replace("<", "\\u003c"),
    )
    return page.encode()


def _sound(soundtrack: Soundtrack) -> str:
    return f"data:audio/wav;base64,{_text(soundtrack.wav())}"


def _packed(shape: MorphMesh) -> dict[str, Any]:
    """Return a layer in the page's format: numbers one after the other, and a picture."""
    motion = shape.motion
    numbers = [
        _pairs(motion.base),
        shape.uv,
        *map(_pairs, motion.targets),
        motion.times,
        motion.weights,
    ]
    if shape.node is not None:
        numbers += [shape.node.times, shape.node.values]
    data = b"".join(part.astype("<f4").tobytes() for part in numbers)
    data += b"".join(order.astype("<u4").tobytes() for _, order in shape.triangle_orders)
    return {
        "texture": f"data:image/png;base64,{_text(encode_png(shape.texture))}",
        "data": _text(data),
        "vertices": len(shape.uv),
        "targets": len(motion.targets),
        "times": len(motion.times),
        "moments": 0 if shape.node is None else len(shape.node.times),
        "pivot": [] if shape.node is None else [shape.node.pivot.real, shape.node.pivot.imag],
        "triangles": len(shape.triangle_orders[0][1]),
        "orders": [seconds for seconds, _ in shape.triangle_orders],
        "visibility": shape.visibility_changes,
    }


def _parts(parts: Sequence[int | CompositeGroup[int]]) -> list[Any]:
    """Return the compositing tree: layer indices and nested objects."""
    return [
        part
        if isinstance(part, int)
        else {
            "parts": _parts(part.parts),
            "opacity": part.opacity,
            "blend": part.blend,
            "clipped": part.clipped,
            "passes": part.is_pass_through,
            "kept": _parts(part.kept),
            "effects": {
                name: np.atleast_1d(value).tolist()
                for name, value in {**DEFAULT_EFFECTS, **part.effects}.items()
            },
        }
        for part in parts
    ]


def _pairs(points: Complexes) -> Floats:
    return np.column_stack([points.real, points.imag])


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode()

"""Exports of models, and their numbers, for tests."""

import functools
from pathlib import Path

import numpy as np
from pygltflib import GLTF2

from app.document import ExportSettings
from app.export import (
    ExportRequest,
    MeshExport,
    check_request,
    plan_export,
    with_reduced_meshes,
)
from app.export_formats import MeshOptions
from app.motion import Animation, Evaluator
from app.storage import decode_picture
from engine.arrays import Floats

PIXELS = 100  # a metre
KINDS = {5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def settings(format_="glb", **shapes) -> ExportSettings:
    return ExportSettings(format=format_, shapes=MeshOptions(**shapes))


@functools.cache
def animation_of(clip):
    return Animation(clip)


def exported(document, out, chosen=None):
    """Export a document; return it with the meshes that were exported, and the export."""
    request = ExportRequest(out=out, settings=chosen or settings(), project="walk")
    check_request(document, request)
    light = with_reduced_meshes(document, request.settings.shapes.triangles)
    evaluator = Evaluator.exact(light)
    pictures = {f.id: decode_picture(f.picture.data, "").rgba for f in light.layers}
    maker = MeshExport(light, pictures, evaluator, plan_export(light, request, evaluator))
    steps = list(maker.run())
    assert steps == sorted(steps)
    assert steps[-1] == len(maker._plan.times)
    return light, maker


def read(path: Path) -> GLTF2:
    return GLTF2().load_binary(str(path))


def values(gltf: GLTF2, number: int) -> Floats:
    accessor = gltf.accessors[number]
    view = gltf.bufferViews[accessor.bufferView]
    flat = np.frombuffer(
        gltf.binary_blob(),
        KINDS[accessor.componentType],
        accessor.count * WIDTHS[accessor.type],
        view.byteOffset + (accessor.byteOffset or 0),
    )
    return flat.astype(np.float64).reshape(accessor.count, WIDTHS[accessor.type])

"""A layer for other programs: a light textured mesh with a few morph targets."""

import math
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby
from typing import Final, NamedTuple, TypeVar

import numpy as np
from PIL import Image

from app.document import (
    OPACITY,
    CompositeGroup,
    Document,
    camera_at,
    clip_of,
    composite_layers,
    is_visible,
    layers_in_draw_order,
)
from app.errors import LissomError
from app.export.alpha_bleed import bleed_edges, cut_texture
from app.export.node_motion import SCALE, NodeMotion, build_node_motion
from app.export.plan import ExportPlan
from app.export_formats import EXPORT_FORMATS
from app.motion import Evaluator, TriangleOrder
from app.texts import _
from engine.arrays import Bytes, Complexes, Floats, Integers, freeze
from engine.domain import ClosedCuts, find_closed_cuts
from engine.geometry import Similarity
from engine.streaming import MorphTargets, build_morph_targets

Value = TypeVar("Value")

DEFAULT_TOLERANCE: Final = 0.5  # pixels
MOST_TARGETS: Final = 8  # glTF viewers must support only this many
_CLOSE: Final = 0.5  # frames between the first samples
OF_NODE: Final = 0.1  # share of the tolerance for the motion of the whole layer


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MorphMesh:
    """A layer's mesh, picture and motion.

    Parameters
    ----------
    texture : uint8, shape (h, w, 4)
        The part of the picture inside the mesh; straight alpha, with colours under transparent
        pixels.
    opacity : float
        The layer's largest opacity in time, multiplied by its groups'.
    uv : float64, shape (v, 2)
        u right, v up; [0, 1] spans the texture.
    triangle_orders : tuple of (float, int32 of shape (m, 3))
        Start times, and counter-clockwise triangles in painting order.
    visibility_changes : tuple of (float, bool)
        Start times, and visibility from then on.
    motion : MorphTargets
        In pixels, y up. All times are in seconds from the first frame.
    node : NodeMotion, optional
        The motion of the whole layer after `motion`; None if it rests.
    """

    name: str
    texture: Bytes
    opacity: float
    uv: Floats
    triangle_orders: tuple[tuple[float, Integers], ...]
    visibility_changes: tuple[tuple[float, bool], ...]
    motion: MorphTargets
    node: NodeMotion | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MorphScene:
    """The meshes of a scene, from back to front, and their compositing by mesh index."""

    meshes: tuple[MorphMesh, ...]
    parts: tuple[int | CompositeGroup[int], ...]


class _Motion(NamedTuple):
    triangle_orders: tuple[tuple[float, Integers], ...]
    motion: MorphTargets
    node: NodeMotion | None


def build_morph_scene(
    document: Document,
    pictures: Mapping[int, Bytes],
    evaluator: Evaluator,
    plan: ExportPlan,
) -> Generator[float, None, MorphScene]:
    """Build the meshes of every layer; yield the finished share of the work, from 0 to 1.

    If the format shows a part of the plane, the layers are in the camera's view.

    Parameters
    ----------
    document : Document
        With the reduced meshes.
    pictures : mapping of int to uint8, shape (h, w, 4)
        Decoded pictures by layer id.
    evaluator : Evaluator
        Of the document's frames.

    Raises
    ------
    LissomError
        If no layer is visible, or the motion fails at some frame.
    """
    moving, document = document, _with_peak_opacity(document)
    first, last = plan.span
    times = np.linspace(first, last, round((last - first) / _CLOSE) + 1).tolist()
    tolerance = plan.shapes.tolerance
    numbers = range(first, last + 1)
    clips = [
        clip_of(document, layer.id)
        for layer in layers_in_draw_order(document, first)
        if layer in document.exported_layers
        and any(is_visible(document, layer, frame) for frame in numbers)
    ]
    if not clips:
        raise LissomError(
            _("no layer is visible in these frames, so there is nothing to export; show a layer")
        )
    found = []
    moved: dict[int, _Motion] = {}  # by layer; members of a deform group move alike
    for index, clip in enumerate(clips):
        layer, bent = clip.layer, document.deform_layer(clip.layer)
        mesh, seam = (
            bent.domain.mesh,
            find_closed_cuts(bent.domain, bent.cut_out.covered_lines(bent.corner)),
        )
        places = mesh.vertices if seam is None else seam.close_cuts(mesh.vertices)
        shown = mesh.vertices if seam is None else seam.find_painted(mesh.vertices)
        if bent.id not in moved:
            allowed = DEFAULT_TOLERANCE if tolerance is None else tolerance
            node = build_node_motion(
                partial(_placement, moving, evaluator, plan, bent.id),
                places,
                bent.pivot,
                times,
                OF_NODE * allowed,
            )
            if node is not None:
                allowed *= (1 - OF_NODE) / float(node.values[:, SCALE].max())
            steps = build_morph_targets(
                partial(_painted, moving, evaluator, seam, bent.id),
                places,
                times,
                tolerance=allowed,
                most=MOST_TARGETS if tolerance is None else None,
            )
            motion = yield from _share(steps, plan.span, (index, len(clips)))
            order, own = TriangleOrder(mesh), clip_of(document, bent.id)
            orders = [(frame, order.triangles(own, frame)) for frame in numbers]
            moved[bent.id] = _Motion(
                tuple(
                    (
                        (n - first) / plan.timeline_fps,
                        each if seam is None else seam.order_under(each),
                    )
                    for n, each in _changes(orders)
                ),
                replace(motion, times=freeze((motion.times - first) / plan.timeline_fps)),
                node and replace(node, times=freeze((node.times - first) / plan.timeline_fps)),
            )
        texture, uv = cut_texture(pictures[layer.id], shown - layer.corner)
        visibility = [(frame, is_visible(document, layer, frame)) for frame in numbers]
        shape = MorphMesh(
            name=plan.out.stem if len(document.layers) == 1 else layer.name,
            texture=bleed_edges(texture),
            opacity=layer.opacity
            * math.prod(group.opacity for group in document.groups_around(layer.group)),
            uv=uv,
            triangle_orders=moved[bent.id].triangle_orders,
            visibility_changes=tuple(
                ((n - first) / plan.timeline_fps, seen) for n, seen in _changes(visibility)
            ),
            motion=moved[bent.id].motion,
            node=moved[bent.id].node,
        )
        found.append(shape)
    numbered = {clip.layer.id: number for number, clip in enumerate(clips)}
    parts = composite_layers(document, numbered, first)
    return _merge_members(MorphScene(meshes=tuple(found), parts=parts))


def _merge_members(scene: MorphScene) -> MorphScene:
    """Return the scene with members of deform groups that lie on each other as one mesh each.

    A part of this mesh covers another part with all members. Members that are hidden at times,
    faded, clipped or blended stay apart.
    """
    runs: dict[tuple[int, ...], int] = {}

    def run_key(part: int | CompositeGroup[int]) -> object:
        if isinstance(part, CompositeGroup):
            return id(part)
        shape = scene.meshes[part]
        if not all(seen for _time, seen in shape.visibility_changes):
            return part
        # Members have the same vertices, so their textures have the same places.
        return id(shape.motion), shape.texture.shape, np.round(shape.uv, 6).tobytes()

    def merged(
        parts: Sequence[int | CompositeGroup[int]],
    ) -> tuple[int | CompositeGroup[int], ...]:
        found: list[int | CompositeGroup[int]] = []
        for _key, run in groupby(parts, run_key):
            first, *others = run
            if isinstance(first, CompositeGroup):
                found.append(replace(first, parts=merged(first.parts), kept=merged(first.kept)))
            else:
                numbers = (first, *(each for each in others if isinstance(each, int)))
                found.append(runs.setdefault(numbers, len(runs)))
        return tuple(found)

    parts = merged(scene.parts)
    meshes = tuple(_flattened([scene.meshes[number] for number in run]) for run in runs)
    return MorphScene(meshes=meshes, parts=parts)


def _flattened(members: Sequence[MorphMesh]) -> MorphMesh:
    """Return one mesh with the textures of members over each other."""
    if len(members) == 1:
        return members[0]
    texture = Image.fromarray(members[0].texture)
    for each in members[1:]:
        texture.alpha_composite(Image.fromarray(each.texture))
    name = " + ".join(each.name for each in members)
    return replace(members[0], name=name, texture=bleed_edges(np.asarray(texture)))


def _with_peak_opacity(document: Document) -> Document:
    """Return a document with each layer's largest opacity at all times."""
    layers = (
        replace(
            each.with_keys_of(OPACITY, ()),
            opacity=max((key.value for key in each.keys_of(OPACITY)), default=each.opacity),
        )
        for each in document.layers
    )
    return replace(document, layers=tuple(layers))


def _painted(
    document: Document,
    evaluator: Evaluator,
    seam: ClosedCuts | None,
    layer: int,
    frame: float,
) -> Complexes:
    """Return the painted vertices of a layer in its own space: cuts closed."""
    places = evaluator.evaluate(document, frame, only=[layer]).layers[layer].positions
    return places if seam is None else seam.close_cuts(places)


def _placement(
    document: Document, evaluator: Evaluator, plan: ExportPlan, layer: int, frame: float
) -> Similarity:
    """Return the motion of a whole layer, in the camera's view."""
    placement = evaluator.exact_placement(document, layer, frame)
    camera = camera_at(document, frame) if EXPORT_FORMATS[plan.format].has_frame else None
    return placement if camera is None else camera.canvas_motion(document.canvas).compose(placement)


def _changes(values: list[tuple[int, Value]]) -> list[tuple[int, Value]]:
    """Return the first of each run of values that are the same object."""
    return [
        pair
        for index, pair in enumerate(values)
        if not index or pair[1] is not values[index - 1][1]
    ]


def _share(
    steps: Generator[float, None, MorphTargets], frames: tuple[int, int], part: tuple[int, int]
) -> Generator[float, None, MorphTargets]:
    """Turn steps that yield frames into steps that yield the finished share of the whole work."""
    (first, last), (index, count) = frames, part
    while True:
        try:
            frame = next(steps)
        except StopIteration as stop:
            motion: MorphTargets = stop.value
            return motion
        yield (index + (frame - first) / max(last - first, 1)) / count

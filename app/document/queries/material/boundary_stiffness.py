"""Stiffness along a layer's boundary, from paint and bones."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from app.document.layer import Layer
from app.document.queries.memo import memoized_on
from app.document.rig.chains import Bone
from app.document.rig.stiffness import combined_stiffness, default_as_none
from engine.arrays import Complexes, Floats, as_points
from engine.domain import MeshedDomain
from engine.domain.material.brush import brush_weights
from engine.domain.material.limb import limb_weights
from engine.errors import EngineError
from engine.maps import Boundary, stiffness_along_loops

A_SIDE = 4  # samples per side of the outline


class StiffOutline(NamedTuple):
    """Points along the outline and the holes of a layer, in order, with their stiffness."""

    points: Complexes
    stiffness: Floats


def with_stiffness(layer: Layer, boundary: Boundary) -> Boundary:
    """Return the boundary of the layer's domain with the layer's stiffness."""
    points = np.split(boundary.points, boundary.starts[1:])
    return boundary.stiffened_at_samples(_stiffness_at(layer, points))


@memoized_on
def stiff_outline(layer: Layer) -> StiffOutline:
    """Return the stiffness at the vertices of a layer's loops and between them."""
    points = outline_points(layer.domain)
    return StiffOutline(np.concatenate(points), _stiffness_at(layer, points))


def outline_points(domain: MeshedDomain) -> list[Complexes]:
    """Return the vertices of each loop, and points between them."""
    share = np.arange(A_SIDE) / A_SIDE
    return [
        (loop[:, None] + (np.roll(loop, -1) - loop)[:, None] * share).ravel()
        for loop in domain.loops
    ]


@memoized_on
def stiffness_source(layer: Layer) -> tuple[object, ...]:
    """Return the values that determine the stiffness along the boundary of a layer's domain."""
    painted = None if layer.stiffness is None else layer.stiffness.tobytes()
    bones = [
        (bone.stiffness, *(layer.handle(end).position for end in bone.ends)) for bone in layer.bones
    ]
    return painted, tuple(bones)


def _stiffness_at(layer: Layer, points: Sequence[Complexes]) -> Floats:
    """Return the stiffness at points of each loop, ordered from its first vertex.

    A bone that leaves the drawing, as after a change of the cut-out, is ignored.
    """
    every = np.concatenate(points)
    parts = [np.ones(len(every))]
    if layer.stiffness is not None:
        parts[0] = stiffness_along_loops(layer.stiffness, layer.domain.loops, points)
    for bone in layer.bones:
        try:
            share = bone_region(layer, bone, every)
        except EngineError:
            continue
        parts.append(bone.stiffness**share)
    return combined_stiffness(parts)


def bone_region(layer: Layer, bone: Bone, points: Complexes) -> Floats:
    """Return the share (t,), from 0 to 1, of a bone's stiffness at points of the boundary.

    Raises an `EngineError` if the bone leaves the drawing or crosses a hole.
    """
    start, end = (layer.handle(identity).position for identity in bone.ends)
    return limb_weights(layer.domain.loops, start, end, points)


def brushed_stiffness(
    layer: Layer,
    places: Sequence[complex],
    *,
    radius: float,
    amount: float,
    softness: float = 0.5,
) -> tuple[Floats | None, bool]:
    """Return the painted stiffness after a brush stroke, and whether the stroke met an outline.

    The places are the centres of the dabs, in pixels of the canvas, y up. Within the radius of a
    dab, in pixels, the stiffness of the outline becomes `amount`. `softness` is the share of the
    radius over which the effect fades, 0 to 1.
    """
    loops = layer.domain.loops
    shares = brush_weights(loops, as_points(list(places), "places"), radius, softness)
    if not shares.any():
        return layer.stiffness, False
    before = np.ones(len(shares)) if layer.stiffness is None else layer.stiffness
    return default_as_none(before ** (1 - shares) * amount**shares), True

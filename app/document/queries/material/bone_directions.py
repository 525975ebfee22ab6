"""Directions of bones: which end is the root."""

from dataclasses import replace
from functools import partial

from app.document.layer import Layer
from app.document.rig.chains import Bone
from engine.domain.material.shafts import larger_end
from engine.errors import EngineError


def direct_bone(layer: Layer, ends: tuple[int, int]) -> tuple[int, int]:
    """Return the ends of a new bone, the root first.

    A bone continues a chain, and otherwise its root is where more of the drawing is.
    """
    taken = {bone.ends[1] for bone in layer.bones if bone.is_limb}
    if len(taken.intersection(ends)) == 1:
        return ends if ends[0] in taken else (ends[1], ends[0])
    return ends if _larger_end(layer, ends) == ends[0] else (ends[1], ends[0])


def with_directed_bones(layer: Layer) -> Layer:
    """Return the layer with the directions of all bones; earlier versions had none.

    A bone that would close a circle stays without a direction.
    """
    if all(bone.is_directed for bone in layer.bones):
        return layer
    directed: dict[tuple[int, int], Bone] = {}
    left = [bone for bone in layer.bones if not bone.is_directed]
    while left:
        part = _connected(left, left[0].ends[0])
        handles = dict.fromkeys(end for bone in part for end in bone.ends)
        root = max(handles, key=partial(_count_agreeing, layer, part))
        directed |= {bone.ends: found for bone, found in _directed_from(part, root)}
        left = [bone for bone in left if bone not in part]
    return replace(layer, bones=tuple(directed.get(bone.ends, bone) for bone in layer.bones))


def _count_agreeing(layer: Layer, bones: list[Bone], root: int) -> int:
    """Return how many bones lead away from the larger part of the drawing, seen from a root."""
    return sum(
        _larger_end(layer, bone.ends) == found.ends[0]
        for bone, found in _directed_from(bones, root)
    )


def _larger_end(layer: Layer, ends: tuple[int, int]) -> int:
    """Return the handle of a bone on whose side more of the drawing is."""
    start, end = (layer.handle(identity).position for identity in ends)
    anchor = layer.anchor if layer.has_parent else None
    if anchor is not None and anchor in {start, end}:
        return ends[anchor == end]
    try:
        return ends[larger_end(layer.domain.loops, start, end)]
    except EngineError:
        return ends[0]


def _connected(bones: list[Bone], handle: int) -> list[Bone]:
    """Return the bones that are connected to a handle."""
    reached = {handle}
    while True:
        wider = reached.union(*(bone.ends for bone in bones if reached & set(bone.ends)))
        if wider == reached:
            return [bone for bone in bones if reached & set(bone.ends)]
        reached = wider


def _directed_from(bones: list[Bone], root: int) -> list[tuple[Bone, Bone]]:
    """Return bones with the bones that lead away from a root; bones of circles are left out."""
    found, reached, waiting = list[tuple[Bone, Bone]](), {root}, [root]
    while waiting:
        here = waiting.pop(0)
        for bone in bones:
            other = bone.ends[1] if bone.ends[0] == here else bone.ends[0]
            if here in bone.ends and other not in reached:
                found.append((bone, replace(bone, ends=(here, other), is_directed=True)))
                reached.add(other)
                waiting.append(other)
    return found

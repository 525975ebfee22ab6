"""Moving and deleting pose keys, with the cycles and motion presets that they belong to."""

from collections.abc import Callable, Collection
from dataclasses import replace
from typing import Any

from app.document.channels.cycles import Cycle
from app.document.keyframe import Keyframe
from app.document.layer import Layer
from app.document.queries.applied_motion import (
    digest_motion,
    is_motion_unedited,
    keys_of_motion,
)
from app.document.rig.applied_motion import AppliedMotion


def cycles_with_keys(
    layer: Layer, left: tuple[Keyframe, ...], gone: Collection[int]
) -> tuple[Cycle, ...]:
    """Return a layer's cycles without those that lose all of their keys, which were at `gone`."""
    frames = [key.frame for key in left]
    return tuple(
        cycle
        for cycle in layer.cycles
        if any(map(cycle.contains, frames)) or not any(map(cycle.contains, gone))
    )


def moved_fields(
    layer: Layer, keys: tuple[Keyframe, ...], frames: Collection[int], to: Callable[[int], int]
) -> dict[str, Any]:
    """Return the cycles and motion presets of a layer whose keys at some frames have moved."""
    if keys == layer.keys:
        return {}
    changed = replace(layer, keys=keys, cycles=_moved_cycles(layer, frames, to), motions=())
    motions = _carried_motions(layer, changed, frames, to)
    return {"cycles": changed.cycles, "motions": motions}


def _carried_motions(
    layer: Layer, changed: Layer, frames: Collection[int], to: Callable[[int], int]
) -> tuple[AppliedMotion, ...]:
    """Return a layer's motion presets, moved with their keys.

    A preset that moves as a whole stays unedited. Otherwise its range is that of its keys.
    """
    motions: list[AppliedMotion] = []
    for motion in layer.motions:
        own = {key.frame for key in keys_of_motion(layer, motion)}
        if own.isdisjoint(frames):
            motions.append(motion)
        elif own <= set(frames):
            moved = motion.moved(to) if to(motion.start) < to(motion.last) else motion
            is_shifted = (
                len({to(frame) - frame for frame in (*own, motion.first, motion.last)}) == 1
            )
            if is_shifted and is_motion_unedited(layer, motion):
                moved = replace(moved, digest=digest_motion(changed, moved))
            motions.append(moved)
        else:
            now = [key.frame for key in keys_of_motion(changed, motion)]
            start, last = min(now), max(now)
            first = min(motion.first, start)
            motions.append(replace(motion, first=first, start=start, last=max(last, start + 1)))
    return tuple(sorted(motions, key=lambda motion: motion.first))


def _moved_cycles(
    layer: Layer, frames: Collection[int], to: Callable[[int], int]
) -> tuple[Cycle, ...]:
    """Return a layer's cycles; a cycle moves if all its keys move."""
    cycles = []
    for cycle in layer.cycles:
        own = {frame for frame in layer.key_frames if cycle.contains(frame)}
        cycles.append(cycle.retimed(to) if own and own <= set(frames) else cycle)
    return tuple(sorted(cycles, key=lambda cycle: cycle.first))

"""How the keys of a motion come among those that a layer has."""

from collections.abc import Sequence
from dataclasses import replace

from app.document import (
    AppliedMotion,
    Cycle,
    Document,
    Keyframe,
    Layer,
    cycle_commands,
    digest_keys,
)

BLEND = 0.25  # seconds over which a motion blends in from what is before it


def count_blend_frames(layer: Layer, first: int, fps: float) -> int:
    """Return over how many frames a motion blends in that is given at a frame.

    It does where the layer is keyed before; else its first key takes the place of what is there.
    """
    if any(key.frame < first for key in layer.keys):
        return max(2, round(BLEND * fps))
    return 0


def splice_motion(
    document: Document, identity: int, keys: Sequence[Keyframe], given: AppliedMotion, until: int
) -> Layer:
    """Return a layer with the keys of a motion in place of those that it has meanwhile.

    Parameters
    ----------
    document : Document
    identity : int
        The id of the layer.
    keys : sequence of Keyframe
        Of one cycle, and of how the motion blends in.
    given : AppliedMotion
        It gets the digest of its keys. Other motions that it interrupts are forgotten, and what
        repeats into it becomes keys.
    until : int
        The last frame whose key goes, where the motion takes the place of a longer one.
    """
    first, last = given.first, max(given.last, until)
    for cycle in document.layer(identity).cycles:
        if cycle.first < last and cycle.covers(first + 1):
            make_keys = cycle_commands.bake_cycle(identity, cycle.first, document.frames.last)
            document = make_keys(document)
    layer = document.layer(identity)
    cycles = [each for each in layer.cycles if not _is_during(each, first, last)]
    if given.repeat_count > 1 and not given.parameters.travel:
        period = (given.last - given.start) // given.repeat_count
        cycles.append(Cycle(first=given.start, last=given.start + period, until=given.last))
    kept = [key for key in layer.keys if not first <= key.frame <= last]
    motions = [each for each in layer.motions if not each.overlaps(first, last)]
    layer = replace(
        layer,
        keys=tuple(sorted([*kept, *keys], key=lambda key: key.frame)),
        cycles=tuple(sorted(cycles, key=lambda cycle: cycle.first)),
    )
    given = replace(given, digest=digest_keys(layer, first, given.last))
    motions.append(given)
    return replace(layer, motions=tuple(sorted(motions, key=lambda each: each.first)))


def _is_during(cycle: Cycle, first: int, last: int) -> bool:
    """Tell whether what repeats does so at some time strictly between two frames."""
    return cycle.first < last and (cycle.until is None or cycle.until > first)

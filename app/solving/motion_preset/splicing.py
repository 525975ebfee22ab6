"""Inserting the keys of a motion preset among the keys of a layer."""

from collections.abc import Sequence
from dataclasses import replace

from app.document import (
    AppliedMotion,
    Cycle,
    Document,
    Keyframe,
    Layer,
    cycle_commands,
    digest_motion,
)

BLEND = 0.25  # seconds over which a motion blends in


def count_blend_frames(layer: Layer, first: int, fps: float) -> int:
    """Return the number of frames over which a motion blends in at a frame.

    It is 0 without earlier keys: the motion's first key then replaces the layer's.
    """
    if any(key.frame < first for key in layer.keys):
        return max(2, round(BLEND * fps))
    return 0


def splice_motion(
    document: Document,
    identity: int,
    keys: Sequence[Keyframe],
    given: AppliedMotion,
    until: int,
    *,
    has_edits: bool = False,
) -> Layer:
    """Return a layer whose keys in the range of a motion are replaced by the motion's.

    `keys` are those of one repeat and of the blend in. `given` gets the digest of its keys, unless
    they have edits by hand.
    Overlapping motions are dropped, and cycles that repeat into it are baked. If the motion
    replaces a longer one, keys up to the frame `until` are deleted.
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
    used = {each.id for each in layer.motions} | {key.motion or 0 for key in layer.keys}
    given = replace(given, id=1 + max(used))
    # The key that it blends in from stays that of the motion before.
    before = {key.frame: key.motion for key in layer.keys}
    own = [
        replace(key, motion=given.id if key.frame >= given.start else before.get(key.frame))
        for key in keys
    ]
    kept = [key for key in layer.keys if not first <= key.frame <= last]
    motions = [each for each in layer.motions if not each.overlaps(first, last)]
    layer = replace(
        layer,
        keys=tuple(sorted([*kept, *own], key=lambda key: key.frame)),
        cycles=tuple(sorted(cycles, key=lambda cycle: cycle.first)),
    )
    given = replace(given, digest="" if has_edits else digest_motion(layer, given))
    motions.append(given)
    return replace(layer, motions=tuple(sorted(motions, key=lambda each: each.first)))


def _is_during(cycle: Cycle, first: int, last: int) -> bool:
    """Return whether a cycle or its repeats overlap a range."""
    return cycle.first < last and (cycle.until is None or cycle.until > first)

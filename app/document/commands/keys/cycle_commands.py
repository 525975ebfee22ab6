"""Commands on cycles: create, delete, and bake repeats into keys."""

from collections.abc import Iterable
from dataclasses import replace

from app.document.channels.cycles import Cycle
from app.document.channels.kinds import SWITCH
from app.document.commands.command import command, layer_command
from app.document.commands.keys.baked_repeats import baked_channels, baked_track
from app.document.commands.keys.retime import nearest_frame, sorted_by_frame, with_overwritten_keys
from app.document.layer import Layer
from app.document.layers.attachments import repeated_joints
from app.document.model import Document
from app.document.queries.channel_values.repeats import (
    switch_cycle,
    with_repeats,
)
from app.document.queries.pose_tangents import have_same_map
from app.errors import LissomError
from app.texts import N_, _

TWO_POSES_SHOWN = N_(
    "A cycle must end with the pose of its start, but frames {first} and {last} show different "
    "poses. Make the poses equal, or choose other keys."
)


@layer_command(_("Repeat"))
def set_cycle(layer: Layer, first: int, last: int, until: int | None = None) -> Layer:
    """Create a cycle that repeats until a frame, or until the end of the document.

    The cycle replaces one with the same first frame. A key at `last` with the pose of the first key
    is removed, since it repeats the first key. Raises a `LissomError` if the cycle overlaps another
    cycle, or keys are in the way of its repeats.
    """
    cycle = Cycle(first=first, last=last, until=until)
    keys = layer.keys
    if until != last and {first, last} <= layer.key_frames:
        if not have_same_map(layer.key(first), layer.key(last)):
            raise LissomError(_(TWO_POSES_SHOWN).format(first=first, last=last))
        keys = tuple(key for key in keys if key.frame != last)
    others = (each for each in layer.cycles if each.first != first)
    return replace(layer, keys=keys, cycles=_ordered((*others, cycle)))


@command(_("Stop repeating"))
def delete_cycle(document: Document, identity: int, first: int) -> Document:
    """Delete the cycle that begins at a frame; its range still ends as it began.

    Switch keys that repeat with the cycle stop repeating too.
    """
    cycle = cycle_starting_at(document.layer(identity), first)
    document = _with_baked_switch(document, identity, cycle, cycle.last)
    return document.with_layer(_without_cycle(document, document.layer(identity), first))


def _without_cycle(document: Document, layer: Layer, first: int) -> Layer:
    cycle = cycle_starting_at(layer, first)
    cycles = tuple(each for each in layer.cycles if each is not cycle)
    own = [key for key in layer.keys if cycle.contains(key.frame)]
    keys = layer.keys
    if len(own) > 1 and own[0].frame == first and cycle.last not in layer.key_frames:
        keys = sorted_by_frame((*keys, replace(own[0], frame=cycle.last)))
    return replace(
        layer,
        keys=keys,
        cycles=cycles,
        channels=baked_channels(document, layer, cycle, cycle.last),
        attachments=repeated_joints(
            layer.attachments, (replace(cycle, until=cycle.last),), cycle.last
        ),
    )


@command(_("Bake repeats"))
def bake_cycle(document: Document, identity: int, first: int, end: int) -> Document:
    """Replace the repeats of the cycle that begins at a frame with keys.

    Only the tangents into and out of the range may change. An incomplete repeat at the end stays a
    repeat of the one before. Repeats without an end stop at `end`, the document's last frame.
    Repeated switch keys are baked too. Raises a `LissomError` if a track acts in a part of the
    cycle only, and is not zero at its ends.
    """
    cycle = cycle_starting_at(document.layer(identity), first)
    document = _with_baked_switch(
        document, identity, cycle, end if cycle.until is None else cycle.until
    )
    baked = document.with_layer(_with_baked_keys(document, document.layer(identity), first, end))
    return _with_switch_as_before(baked, document, identity)


def _with_switch_as_before(document: Document, before: Document, identity: int) -> Document:
    """Return a document whose cycles do not repeat switch keys that did not repeat before."""
    for choice, _member in document.switches_around(document.layer(identity)):
        cycle = switch_cycle(document, choice)
        if cycle is None or switch_cycle(before, choice) is not None:
            continue
        at = cycle.last + (choice.member_at(cycle.last) == choice.member_at(cycle.first))
        key = SWITCH.key(at, choice.member_at(at))
        stopped = replace(choice, keys=with_overwritten_keys(choice.keys, (key,)))
        choices = tuple(stopped if each is choice else each for each in document.switch_groups)
        document = replace(document, switch_groups=choices)
    return document


def _with_baked_switch(document: Document, identity: int, cycle: Cycle, end: int) -> Document:
    """Return a document with the repeats of a layer's switch groups in a cycle as switch keys."""
    around = [each for each, _member in document.switches_around(document.layer(identity))]
    choices = tuple(
        with_repeats(document, each, max(end, cycle.last))
        if each in around and switch_cycle(document, each) == cycle
        else each
        for each in document.switch_groups
    )
    return (
        document if choices == document.switch_groups else replace(document, switch_groups=choices)
    )


def _with_baked_keys(document: Document, layer: Layer, first: int, end: int) -> Layer:
    cycle = cycle_starting_at(layer, first)
    until = max(cycle.last, end if cycle.until is None else cycle.until)
    own = [key for key in layer.keys if cycle.contains(key.frame)]
    rounds = (until - first) // cycle.period
    rest = (until - first) % cycle.period
    left: tuple[Cycle, ...] = ()
    if rest and own and own[0].frame == first:
        shift = (rounds - 1) * cycle.period
        moved = replace(cycle, first=first + shift, last=cycle.last + shift)
        left = (moved,) if shift else (cycle,)
    starts = [first + count * cycle.period for count in range(1, rounds)]
    copies = [replace(key, frame=key.frame + at - first) for at in starts for key in own]
    if not left and until not in layer.key_frames and len(own) > 1 and own[0].frame == first:
        copies.append(replace(own[0], frame=first + rounds * cycle.period))
    others = (each for each in layer.cycles if each is not cycle)
    return replace(
        layer,
        keys=sorted_by_frame((*layer.keys, *copies)),
        cycles=_ordered((*others, *left)),
        tracks=tuple(
            baked_track(document, layer, track, cycle, until)
            if cycle.repeats_keys(track.keys)
            else track
            for track in layer.tracks
        ),
        channels=baked_channels(document, layer, cycle, until, left=left),
        attachments=repeated_joints(layer.attachments, (cycle,), until),
    )


def end_of_cycle(layer: Layer, first: int, last: int) -> int | None:
    """Return the last frame of a cycle's repeats: whole repeats if possible; None is no end.

    Raises a `LissomError` if the next key leaves no room for a repeat, or another cycle begins
    within the range.
    """
    for cycle in layer.cycles:
        if first < cycle.first < last:
            raise LissomError(
                _(
                    "Frames {first} to {last} cannot repeat, because they overlap a cycle, "
                    "{cycle}. Delete that cycle first, or choose other keys."
                ).format(first=first, last=last, cycle=cycle.description)
            )
    after = [frame for frame in layer.key_frames if frame > last]
    after += [cycle.first for cycle in layer.cycles if cycle.first > first]
    if not after:
        return None
    period, limit = last - first, min(after)
    whole = last + (limit - last) // period * period
    own = [key.frame for key in layer.keys if first <= key.frame < last]
    ends = [frame + period for frame in own if last < frame + period <= limit]
    if whole == last and not ends:
        raise LissomError(
            _(
                "Frames {first} to {last} have no room to repeat before frame {limit}; move the "
                "keys there to later frames first."
            ).format(first=first, last=last, limit=limit)
        )
    return whole if whole > last else max(ends)


def nearest_cycle_end(layer: Layer, cycle: Cycle, frame: int, end: int) -> int | None:
    """Return the possible last frame of the repeats that is nearest to a frame; None is no end.

    A possible last frame shows a key of the cycle.
    """
    after = [each for each in layer.key_frames if each >= cycle.last]
    after += [other.first for other in layer.cycles if other.first > cycle.first]
    limit = min(after, default=end)
    if not after and frame >= end:
        return None
    own = {each for each in layer.key_frames if cycle.contains(each)} | {cycle.first}
    rounds = range(1, (limit - cycle.first) // cycle.period + 1)
    shown = {each + count * cycle.period for count in rounds for each in own}
    fitting = {each for each in shown if cycle.last <= each <= limit} | {cycle.last}
    return min(fitting, key=lambda each: abs(each - frame))


def with_cycle_end(layer: Layer, cycle: Cycle, frame: int) -> Cycle:
    """Return a cycle with its last frame near a frame, after its keys, and as many repeats."""
    own = [each for each in layer.key_frames if cycle.contains(each)]
    last = max([frame, cycle.first + 1, *(each + 1 for each in own)])
    until = cycle.until
    if until is not None:
        longer = (until - cycle.first) * (last - cycle.first) / cycle.period
        until = max(last, cycle.first + nearest_frame(longer))
    return replace(cycle, last=last, until=until)


def cycle_starting_at(layer: Layer, first: int) -> Cycle:
    for cycle in layer.cycles:
        if cycle.first == first:
            return cycle
    raise LissomError(
        _("No cycle of {layer!r} begins at frame {first}.").format(layer=layer.name, first=first)
    )


def _ordered(cycles: Iterable[Cycle]) -> tuple[Cycle, ...]:
    return tuple(sorted(cycles, key=lambda cycle: cycle.first))

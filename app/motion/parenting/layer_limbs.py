"""Layers that bend as bones: their rotations at joints by inverse kinematics."""

import cmath
from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import pairwise

import numpy as np

from app.document import (
    IK_TARGET,
    Document,
    IkTarget,
    Layer,
    bones_above,
    layer_value_at,
    layers_with_targets,
)
from app.motion.parenting.chain import (
    ChainLink,
    KeptTransform,
    PivotFrame,
    PivotFrameAt,
    compose_chain,
    parent_links,
    turn_links,
)
from app.rigging import bend_side, solve_chain
from engine.geometry import Similarity

Turns = Mapping[int, float]  # rotations of layers about their joints, in radians by id
# The placement of a layer, and its joint in the scene, under rotations of layers.
LayerPlaces = Callable[[int, Turns], tuple[Similarity, complex]]
SHORTEST_BONE = 1e-6  # of the chain's length; a chain with a shorter bone does not bend


def place_layer(
    document: Document,
    layer: int,
    frame: float,
    hinge: PivotFrameAt,
    kept: KeptTransform,
    *,
    before: bool = False,
) -> Similarity:
    """Return the transform of a layer at a frame: by its parents, its own, and by IK targets."""
    turns = find_turns(document, layer, frame, hinge, kept, before=before)
    links = parent_links(document, layer, frame, before=before)
    return compose_chain(turn_links(links, turns), hinge, kept)


def find_turns(
    document: Document,
    layer: int,
    frame: float,
    hinge: PivotFrameAt,
    kept: KeptTransform,
    *,
    before: bool = False,
) -> Turns:
    """Return the rotations by IK targets at a frame of all layers with the same root ancestor."""
    turns: Turns = {}
    ends = layers_with_targets(document)
    if not ends:
        return turns
    place = joint_places(document, frame, hinge, kept, before=before)
    root = document.parent_chain(layer, frame, before=before)[-1]
    chains = {end.id: document.parent_chain(end.id, frame, before=before) for end in ends}
    for end in sorted(ends, key=lambda end: len(chains[end.id])):
        if chains[end.id][-1] is not root:
            continue
        target = layer_value_at(document, end, IK_TARGET, document.loop_frame(frame))
        bones = bones_above(document, end.id, frame, before=before)
        if target is not None and target.mix > 0 and bones:
            turns = reach_target(target, bones, end, place, turns)
    return turns


def joint_places(
    document: Document,
    frame: float,
    hinge: PivotFrameAt,
    kept: KeptTransform,
    *,
    before: bool = False,
) -> LayerPlaces:
    """Return the function that places a layer and its joint under rotations of layers."""
    chains: dict[int, tuple[ChainLink, ...]] = {}
    hinges: dict[tuple[int, complex], PivotFrame] = {}

    def known_hinge(layer: Layer, point: complex) -> PivotFrame:
        if (layer.id, point) not in hinges:
            hinges[layer.id, point] = hinge(layer, point)
        return hinges[layer.id, point]

    def place(layer: int, turns: Turns) -> tuple[Similarity, complex]:
        if layer not in chains:
            chains[layer] = parent_links(document, layer, frame, before=before)
        links = turn_links(chains[layer], turns)
        placement = compose_chain(links, known_hinge, kept)
        return placement, placement.factor * links[0].pivot(known_hinge) + placement.shift

    return place


def reach_target(
    target: IkTarget,
    bones: Sequence[Layer],
    end: Layer,
    place: LayerPlaces,
    turns: Turns,
    *,
    flips: bool = False,
) -> Turns:
    """Return the rotations of bones and end that bring the end to its target.

    With `flips`, the bones bend to the other side.
    """
    own = complex(np.exp(1j * target.turn))
    before = place(end.id, turns)[0].factor
    side = choose_side(end, bones, [place(each.id, turns)[1] for each in (*bones, end)])
    bent = bend_layers(
        bones,
        lambda turns: place(end.id, turns)[1],
        lambda layer, turns: place(layer, turns)[1],
        target.place,
        turns,
        -side if flips else side,
    )
    mixed = dict(turns) | {
        each.id: turns.get(each.id, 0.0)
        + target.mix * (bent.get(each.id, 0.0) - turns.get(each.id, 0.0))
        for each in bones
    }
    wanted = before * np.exp(1j * target.mix * np.angle(own / before))
    swung = place(end.id, mixed)[0].factor
    mixed[end.id] = mixed.get(end.id, 0.0) + cmath.phase(complex(wanted / swung))
    return mixed


def bend_layers(
    bones: Sequence[Layer],
    end: Callable[[Turns], complex],
    joint: Callable[[int, Turns], complex],
    goal: complex,
    turns: Turns,
    side: int,
) -> Turns:
    """Return the rotations of layers that bring the end of their chain to a goal.

    Beyond reach the chain is straight. `end` and `joint` return the end and the joint of a layer in
    the scene under some rotations. The rotations stay if a bone has no length.
    """
    places = [*(joint(each.id, turns) for each in bones), end(turns)]
    lengths = [abs(b - a) for a, b in pairwise(places)]
    if min(lengths) <= SHORTEST_BONE * sum(lengths):
        return turns
    root, *start = places
    solved = [root, *solve_chain(root, lengths, goal, start, side)]
    found = dict(turns)
    for number, bone in enumerate(bones):
        last = number + 1 == len(bones)
        reached = end(found) if last else joint(bones[number + 1].id, found)
        here, wanted = solved[number], solved[number + 1]
        swing = cmath.phase((wanted - here) / (reached - joint(bone.id, found)))
        found[bone.id] = found.get(bone.id, 0.0) + swing
    return found


def choose_side(end: Layer, bones: Collection[Layer], places: Sequence[complex]) -> int:
    """Return the pole side of a chain: the given one, else the present or the drawn one."""
    if end.pole_side:
        return end.pole_side
    drawn = [each.pivot for each in (*bones, end)]
    for row in (places, drawn):
        for triple in zip(row, row[1:], row[2:], strict=False):
            if found := bend_side(*triple):
                return found
    return 1

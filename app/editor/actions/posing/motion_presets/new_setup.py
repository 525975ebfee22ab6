"""New drafts of a layer's motion: what is computed from the layer and its picture."""

from collections.abc import Collection
from dataclasses import replace

from app.document import AppliedMotion, Layer
from app.editor.work.motion_setup import MotionSetup
from app.rigging import MOTIONS, Parameters, find_kind
from app.solving import JointGuess, guess_joints, guess_layer_kind
from engine.arrays import Bytes
from engine.geometry import diameter

LINKS = 6
NEAR = 0.035  # of the diameter: a handle within this distance of a joint is the joint


def new_motion_setup(layer: Layer, rgba: Bytes, frame: int) -> MotionSetup:
    """Return a draft for a layer without a motion at a frame: like the last motion, or a guess.

    The joints of the last motion are reused. Takes up to a second: for the worker.
    """
    earlier = [each for each in layer.motions if each.first <= frame]
    if earlier:
        draft = setup_of_applied_motion(layer, earlier[-1])
        return replace(
            draft,
            suggested=find_joints(layer, rgba, draft.kind).joints,
            applied_motion=None,
            first=frame,
            parameters=Parameters(),
            rounds=1,
        )
    kind = guess_layer_kind(layer, rgba)
    guess = find_joints(layer, rgba, kind.name)
    return MotionSetup(
        layer=layer.id,
        domain=layer.domain,
        kind=kind.name,
        motion=find_first_motion(kind.name, guess.joints),
        joints=guess.joints,
        suggested=guess.joints,
        unsure=guess.unsure,
        first=frame,
    )


def setup_of_applied_motion(layer: Layer, given: AppliedMotion) -> MotionSetup:
    """Return the draft that gives an applied motion, without suggested joints."""
    there = {handle.id: handle.position for handle in layer.handles}
    names = given.joints.items()
    joints = {name: there[handle] for name, handle in names if handle in there}
    return MotionSetup(
        layer=layer.id,
        domain=layer.domain,
        kind=given.kind,
        motion=given.motion,
        joints=joints if given.kind != "anything" else {},
        suggested={},
        parameters=given.parameters,
        rounds=given.repeat_count,
        facing=given.facing,
        first=given.first,
        applied_motion=given,
    )


def find_first_motion(kind: str, joints: Collection[str]) -> str:
    """Return the first motion that fits a body kind and its joints; travelling ones first.

    A chain of few links, such as a fish, gets a tail wag instead of a wave.
    """
    if kind == "chain" and len(joints) < LINKS:
        return "wag"
    fitting = [name for name, motion in MOTIONS.items() if kind in motion.templates]
    possible = [name for name in fitting if {*MOTIONS[name].template_for(kind).needed} <= {*joints}]
    getting_on = [name for name in possible if MOTIONS[name].template_for(kind).can_travel]
    return (getting_on or possible or fitting)[0]


def find_joints(layer: Layer, rgba: Bytes, kind: str) -> JointGuess:
    """Return a body kind's joints in a layer: at its handles, or by the handles' names."""
    body = find_kind(kind)
    guess = guess_joints(layer, kind, rgba)
    joints = dict(guess.joints)
    near = NEAR * diameter(layer.domain.outline)
    named = {h.name: h.position for h in layer.handles if h.name in body.parents}
    free = [h.position for h in layer.handles if h.name not in named]
    for name, place in joints.items():
        nearest = min(free, key=lambda at: abs(at - place), default=None)
        if name not in named and nearest is not None and abs(nearest - place) <= near:
            joints[name] = nearest
            free.remove(nearest)
    joints |= named
    unsure = tuple(name for name in guess.unsure if name not in named)
    return JointGuess({name: joints[name] for name in body.parents if name in joints}, unsure)

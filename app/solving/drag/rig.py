"""The solver's data of a layer, at rest and in the pose in which a drag starts."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from app.document import (
    Handle,
    Layer,
    Limbs,
    Pose,
    Target,
    find_limbs,
    limits_along,
    stiffness_source,
    with_stiffness,
)
from app.solving.drag.limb_targets import (
    LimbTargets,
    carry_body,
    is_body_held_by_one,
    solve_limbs,
    straighten_flipping,
)
from app.solving.drag.limbs import BODY_FIRMNESS, END_FORCE, PosedLimbs
from engine.deform import (
    AIM_STIFFNESS,
    Armature,
    BoundedPull,
    Deformer,
    Handles,
    HandleTargets,
    State,
)
from engine.errors import EngineError
from engine.maps import Boundary, Certificate, HarmonicMap

# A drag may start at a pose outside the current limits. Its own distortion is then allowed, and
# this fraction of the remaining room.
LEEWAY = 0.02
# Weight of a joint; handles usually have weight 1.
PIN = 10.0
# Factor of the weights of ends without a rigid part: bones do not give way.
END_FIRMNESS = 40.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rig:
    """The solver's data of a layer.

    `handles` are those that hold poses, in the layer's order. Sprung handles are left out unless
    dragged. The deformer is for these handles, and for the fixed anchor of an attached layer.
    """

    layer: Layer
    handles: tuple[Handle, ...]
    deformer: Deformer
    limbs: Limbs | None = None
    free: frozenset[int] = frozenset()  # ids of sprung handles that are not dragged

    @classmethod
    def of(
        cls,
        layer: Layer,
        earlier: Self | None = None,
        pulled: Collection[int] = (),
    ) -> Self:
        """Return the rig of a layer; unchanged parts come from an earlier rig.

        `pulled` are the ids of dragged handles. They are included even with springs.
        """
        domain, pins = layer.domain, _pins(layer)
        free = layer.sprung_handles.difference(pulled)
        if earlier is not None and earlier.layer is layer and earlier.free == free:
            return earlier
        if earlier is not None and earlier.layer.domain is domain:
            boundary = earlier.deformer.boundary
            is_same = stiffness_source(earlier.layer) == stiffness_source(layer)
        else:
            boundary, is_same = Boundary.sample(domain), False
        if not is_same:
            boundary, earlier = with_stiffness(layer, boundary), None
        limbs, carried = find_limbs(layer), free
        if limbs is not None:
            # Joints and rigid ends are places of bones, which do not hold the drawing there.
            carried |= layer.bone_joints | limbs.rigid_ends
        held = tuple(handle for handle in layer.handles if handle.id not in carried)
        if earlier and earlier.handles == held and earlier.pins == pins:
            handles = earlier.deformer.handles
        else:
            handles = _place_handles(boundary, held, pins, limbs)
        # Stiff parts deform less in new poses, and joints of bones more.
        bounds = limits_along(layer, boundary)
        deformer = Deformer(boundary=boundary, handles=handles, bounds=bounds)
        return cls(layer=layer, handles=held, deformer=deformer, limbs=limbs, free=free)

    @property
    def pins(self) -> tuple[complex, ...]:
        """Points of the layer that a drag keeps fixed."""
        return _pins(self.layer)

    def place_handles(self, armature: Armature | None = None) -> Handles:
        """Return the rig's handles with an armature."""
        boundary = self.deformer.boundary
        return _place_handles(boundary, self.handles, self.pins, self.limbs, armature)

    def posed_at(
        self, shape: HarmonicMap, start: Mapping[int, Target], deformer: Deformer | None = None
    ) -> "PosedRig":
        """Return the rig with its limbs in the pose of a map with these targets."""
        return PosedRig(
            rig=self, shape=shape, start=start, deformer=deformer or self.deformer
        ).keeping_body(self.limbs is not None)

    def start_at(self, shape: HarmonicMap) -> State:
        """Return the solver's state at a map, or at rest if the map folds."""
        try:
            return self.deformer.resume(shape)
        except EngineError:
            return self.deformer.start()

    def allow_pose(self, pose: Pose) -> Deformer:
        """Return a deformer that allows the pose even outside the layer's limits."""
        return self.deformer.widened_for(self.layer.map_of(pose), LEEWAY)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PosedRig:
    """A rig in the pose in which a drag starts.

    The deformer's handles include the bones of the limbs, as they are in this pose. Targets that
    differ from those of the start are dragged.
    """

    rig: Rig
    shape: HarmonicMap
    start: Mapping[int, Target]
    deformer: Deformer
    limbs: PosedLimbs | None = None

    def keeping_body(self, keeps: bool) -> "PosedRig":  # noqa: FBT001 - a state
        """Return the same with or without a body that keeps its shape, if it has points."""
        limbs, known = self.rig.limbs, self.limbs
        if limbs is None:
            return self
        keeps = keeps and len(limbs.body) > 1
        if known is not None and known.has_body == keeps:
            return self
        boundary = self.deformer.boundary
        posed = PosedLimbs.at(limbs, boundary, self.shape, has_body=keeps)
        handles = self.rig.place_handles(posed.armature)
        return replace(self, limbs=posed, deformer=replace(self.deformer, handles=handles))

    def with_rig(self, rig: Rig) -> "PosedRig":
        """Return the same with a rig of other handles."""
        if rig.deformer.handles is self.rig.deformer.handles:
            return replace(self, rig=rig)
        armature = self.limbs and self.limbs.armature
        handles = rig.place_handles(armature) if armature else rig.deformer.handles
        return replace(self, rig=rig, deformer=replace(self.deformer, handles=handles))

    def follow(self, targets: Mapping[int, Target]) -> tuple["PosedRig", LimbTargets]:
        """Return the targets with joints and the body where a drag carries them."""
        limbs, layer = self.rig.limbs, self.rig.layer
        if limbs is None:
            return self, LimbTargets(targets, {})
        body = carry_body(layer, limbs, self.start, targets)
        posed = self.keeping_body(body.is_rigid)
        if posed.limbs is None:
            return posed, LimbTargets(body.targets, {})
        return posed, solve_limbs(layer, posed.limbs, self.start, body.targets)

    def straighten(self, followed: LimbTargets, shape: HarmonicMap) -> LimbTargets:
        """Return targets of `follow` for the next steps from a map: a limb flips when straight."""
        limbs, targets = self.limbs, followed.targets
        if limbs is None:
            return followed
        if straighten_flipping(limbs.limbs, limbs.start.places, targets) == targets:
            return followed
        now = limbs.locate(shape).places
        return followed._replace(targets=straighten_flipping(limbs.limbs, now, targets))

    @property
    def ends(self) -> frozenset[int]:
        """The ids of the ends of all limbs, which are dragged with a force of their own."""
        return self.rig.limbs.ends if self.rig.limbs is not None else frozenset()

    def build_targets(
        self, followed: LimbTargets, pins: tuple[Target, ...], hands: Sequence[BoundedPull] = ()
    ) -> HandleTargets:
        """Return targets of `follow` in the form of the deformer.

        Each of `hands` refers to handles by id. Handles that no longer exist or hold no pose are
        left out.
        """
        targets, angles = followed
        index = {handle.id: i for i, handle in enumerate(self.rig.handles)}
        pulling = [
            BoundedPull(
                [index[i] for i in sorted(hand.handles) if i in index],
                END_FORCE if self.ends.issuperset(hand.handles) else hand.max_force,
            )
            for hand in hands
            if not index.keys().isdisjoint(hand.handles)
        ]
        wanted = [*(targets[identity] for identity in index), *pins]
        aims = []
        if self.limbs is not None:
            places = {i: target.position for i, target in targets.items()}
            dragged = {identity for hand in hands for identity in hand.handles}
            aims = self.limbs.aims(
                places,
                angles,
                pulled=dragged,
                free=self.rig.free,
                holds_body=is_body_held_by_one(self.rig.layer, self.limbs.limbs, targets),
            )
        return self.deformer.handles.targets(
            np.array([target.position for target in wanted], dtype=np.complex128),
            [np.nan if target.rotation is None else target.rotation for target in wanted],
            pulling,
            aims,
        )

    def release_ends(
        self, targets: Mapping[int, Target], shape: HarmonicMap, pulled: Collection[int]
    ) -> dict[int, complex]:
        """Return targets of rigid ends, dragged with a bounded force, after release.

        Each target lies a little beyond the end, so that a pose at rest stays.
        """
        if self.limbs is None:
            return {}
        most = END_FORCE / (2 * AIM_STIFFNESS) * self.limbs.armature.size
        now = self.limbs.locate(shape).places
        left = {}
        for identity in self.limbs.limbs.rigid_ends.intersection(pulled) - self.rig.free:
            way = targets[identity].position - now[identity]
            is_reached = abs(way) <= most
            left[identity] = (
                targets[identity].position if is_reached else now[identity] + way * most / abs(way)
            )
        return left

    def make_pose(
        self, shape: HarmonicMap, targets: Mapping[int, Target], certificate: Certificate
    ) -> Pose:
        """Return a map as a pose with these targets; other handles get their own positions.

        Joints get the places to which their bones carry them.
        """
        rig = self.rig
        held = {handle.id for handle in rig.handles}
        carried = [handle for handle in rig.layer.handles if handle.id not in held]
        places = shape(np.array([handle.position for handle in carried], dtype=np.complex128))
        found = {h.id: complex(place) for h, place in zip(carried, places, strict=True)}
        if self.limbs is not None:
            joints = self.limbs.locate(shape).places
            found |= {identity: joints[identity] for identity in found.keys() & joints.keys()}
            for identity in self.limbs.limbs.rigid_ends - rig.free:
                del found[identity]
        here = {
            identity: replace(targets[identity], position=place, rotation=None)
            for identity, place in found.items()
        }
        return Pose.of(shape, {**targets, **here}, certificate)


def pins_of(layer: Layer, pose: Pose) -> tuple[Target, ...]:
    """Return the targets of the points that a drag keeps fixed: the anchor of an attached layer."""
    places = layer.map_of(pose)(np.array(_pins(layer), dtype=np.complex128))
    return tuple(Target(position=complex(place)) for place in places)


def _place_handles(
    boundary: Boundary,
    held: Sequence[Handle],
    pins: Sequence[complex],
    limbs: Limbs | None,
    armature: Armature | None = None,
) -> Handles:
    ends = limbs.ends if limbs is not None else ()
    others = BODY_FIRMNESS if limbs is not None else 1.0
    places = [*(handle.position for handle in held), *pins]
    weights = [
        handle.effective_weight * (END_FIRMNESS if handle.id in ends else others) for handle in held
    ]
    pulls = [*weights, *(PIN for _ in pins)]
    return Handles.place(boundary, np.array(places, dtype=np.complex128), pulls, armature)


def _pins(layer: Layer) -> tuple[complex, ...]:
    """Return the points of a layer that a drag keeps fixed."""
    anchor = layer.anchor
    if not layer.has_parent or anchor is None:
        return ()
    return () if any(handle.position == anchor for handle in layer.handles) else (anchor,)

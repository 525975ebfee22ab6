"""Pulling a layer by a point: the layer and its parents turn at their joints."""

import cmath
from dataclasses import dataclass, field, replace

import numpy as np

from app.document import (
    IK_TARGET,
    MAX_SCALE,
    TRANSFORM,
    Document,
    IkTarget,
    Layer,
    Transform,
    bones_above,
    layer_value_at,
    layers_with_targets,
)
from app.motion.parenting.attach import anchor_or_default
from app.motion.parenting.chain import UNMOVED, KeptTransform, PivotFrameAt, parent_links
from app.motion.parenting.layer_limbs import (
    LayerPlaces,
    Turns,
    bend_layers,
    choose_side,
    find_turns,
    joint_places,
    reach_target,
)
from engine.geometry import Similarity


@dataclass(frozen=True, slots=True)
class LayerPull:
    """The state of a document from which a layer is pulled; places are in the scene."""

    document: Document
    layer: int
    frame: float
    hinge: PivotFrameAt
    kept: KeptTransform
    _turns: Turns = field(init=False)
    _place: LayerPlaces = field(init=False)

    def __post_init__(self) -> None:
        given = (self.document, self.layer, self.frame, self.hinge, self.kept)
        object.__setattr__(self, "_turns", find_turns(*given))
        rest = (self.document, self.frame, self.hinge, self.kept)
        object.__setattr__(self, "_place", joint_places(*rest))

    @property
    def bones(self) -> tuple[Layer, ...]:
        """The parents that bend with the layer, from the root on."""
        return bones_above(self.document, self.layer, self.frame)

    @property
    def placement(self) -> Similarity:
        """The placement of the layer."""
        return self._place(self.layer, self._turns)[0]

    @property
    def joint(self) -> complex:
        """The place of the layer's joint; without a parent, of its anchor or its deepest point."""
        if self._has_joint:
            return self._place(self.layer, self._turns)[1]
        placement, point = self.placement, self._posed_anchor
        return placement.factor * point + placement.shift

    @property
    def _has_joint(self) -> bool:
        return parent_links(self.document, self.layer, self.frame)[0].has_joint

    @property
    def _posed_anchor(self) -> complex:
        """The place of a layer's anchor, as posed, in the layer's space."""
        own = self.document.layer(self.layer)
        return self.hinge(own, anchor_or_default(own)).position

    @property
    def target(self) -> IkTarget | None:
        """The IK target of the layer, if it has keys."""
        own = self.document.layer(self.layer)
        return layer_value_at(self.document, own, IK_TARGET, self._at)

    @property
    def planted_end(self) -> Layer | None:
        """The layer whose IK target bends the layer as one of its bones, if any."""
        for end in layers_with_targets(self.document):
            target = layer_value_at(self.document, end, IK_TARGET, self._at)
            bones = bones_above(self.document, end.id, self.frame)
            if target is not None and target.mix > 0 and self.layer in {each.id for each in bones}:
                return end
        return None

    def present_target(self) -> IkTarget:
        """Return the IK target that keeps the layer where it is."""
        return IkTarget(self.joint, float(np.angle(self.placement.factor)))

    def pulled(self, grabbed: complex, goal: complex, *, alone: bool) -> dict[int, Transform]:
        """Return the transforms, by layer id, that bring a grabbed point to a goal.

        With two bones and more, the layer keeps its rotation in the scene, and its parents bend.
        With one bone, the parent and the layer bend. Otherwise, or `alone`, the layer turns at its
        joint, towards the goal.
        """
        own, bones = self.document.layer(self.layer), self.bones
        if alone or not bones:
            return self.transformed(_angle(grabbed - self.joint, goal - self.joint))
        if len(bones) > 1:
            place = self.joint + goal - grabbed
            target = replace(self.present_target(), place=place)
            return self._with(reach_target(target, bones, own, self._place, self._turns))
        point = self.placement.apply_inverse(grabbed)
        chain = (*bones, own)

        def end(turns: Turns) -> complex:
            placement = self._place(self.layer, turns)[0]
            return placement.factor * point + placement.shift

        joints = [self._place(each.id, self._turns)[1] for each in chain]
        side = choose_side(own, bones, [*joints, grabbed])
        found = bend_layers(
            chain, end, lambda layer, turns: self._place(layer, turns)[1], goal, self._turns, side
        )
        return self._with(found)

    def flipped(self) -> dict[int, Transform]:
        """Return the transforms that bend the bones to the other side; the layer stays."""
        own = self.document.layer(self.layer)
        found = reach_target(
            self.present_target(), self.bones, own, self._place, self._turns, flips=True
        )
        return self._with(found)

    def transforms(self) -> dict[int, Transform]:
        """Return the transforms that keep the limb where its IK targets bring it."""
        limb = {self.layer, *(each.id for each in self.bones)}
        found = {}
        for layer in limb:
            own = self._transform(layer)
            found[layer] = replace(own, turn=own.turn + self._turns.get(layer, 0.0))
        return found

    @property
    def side(self) -> int:
        """The side to which the bones bend, as of `solve_chain`."""
        layers = (*self.bones, self.document.layer(self.layer))
        places = [self._place(each.id, self._turns)[1] for each in layers]
        return choose_side(layers[-1], layers[:-1], places)

    def transformed(
        self, turn: float, factor: float = 1.0, pivot: complex | None = None
    ) -> dict[int, Transform]:
        """Return the layer's transform, turned and scaled around a pivot, by default the joint.

        `turn` is in radians; the scale stays within the limits of keys.
        """
        own = self._transform(self.layer)
        scale = min(max(own.scale * factor, 1 / MAX_SCALE), MAX_SCALE)
        changed = replace(own, turn=own.turn + turn, scale=scale)
        if not self._has_joint:
            changed = self._about_anchor(changed)
        if pivot is not None:
            # The turn around the joint, then the way that brings the pivot back.
            arm = pivot - self.joint
            way = arm * (1 - scale / own.scale * cmath.exp(1j * turn))
            changed = replace(changed, shift=changed.shift + way / self._axes)
        return {self.layer: changed}

    def _about_anchor(self, changed: Transform) -> Transform:
        """Return a changed transform of a layer without a parent; its posed anchor stays.

        The transform is about the pivot, and a pose may move the anchor away from there.
        """
        arm = self._posed_anchor - self.document.layer(self.layer).pivot
        own = self._transform(self.layer)
        shift = own.shift + (own.factor - changed.factor) * arm
        return replace(changed, shift=shift)

    def moved(self, way: complex) -> dict[int, Transform]:
        """Return the layer's transform, moved in the scene, away from its joint."""
        own = self._transform(self.layer)
        return {self.layer: replace(own, shift=own.shift + way / self._axes)}

    @property
    def _axes(self) -> complex:
        """The axes of the shift: those of the joint, which the layer's own transform keeps."""
        own = self._transform(self.layer)
        axes = self.placement.factor / replace(own, shift=0j).factor
        return axes * cmath.exp(-1j * self._turns.get(self.layer, 0.0))

    @property
    def _at(self) -> float:
        return self.document.loop_frame(self.frame)

    def _transform(self, layer: int) -> Transform:
        own = layer_value_at(self.document, self.document.layer(layer), TRANSFORM, self._at)
        return own or UNMOVED

    def _with(self, turns: Turns) -> dict[int, Transform]:
        """Return the transforms of the layers that turn, with their rotations by `turns`."""
        found = {}
        for layer, turn in turns.items():
            extra = turn - self._turns.get(layer, 0.0)
            if extra:
                own = self._transform(layer)
                found[layer] = replace(own, turn=own.turn + extra)
        return found


def _angle(first: complex, second: complex) -> float:
    """Return the angle from one arm to another; 0 if an arm has no length."""
    return cmath.phase(second / first) if first and second else 0.0

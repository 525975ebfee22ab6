"""Transforms of attached layers at any time (Section 7, "a user curve for the anchor")."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from app.document import (
    TRANSFORM,
    Attachment,
    Document,
    Layer,
    Pose,
    clip_of,
    layer_value_at,
    limb_ends,
)
from app.motion.inbetweens.animation import Animation
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.spring_offsets import ParentMotion
from app.motion.parenting.chain import (
    UNMOVED,
    PivotFrame,
    blend_transforms,
    compose_chain,
    parent_links,
    pivot_frame_at,
    require_anchor,
    turn_links,
)
from app.motion.parenting.layer_limbs import Turns, find_turns, place_layer
from app.motion.tracing.point_trails import PointTrails
from engine.arrays import Complexes
from engine.geometry import Similarity

# Frames per job, about a millisecond each, and frames looked up per job, so that the worker soon
# takes more urgent jobs.
BATCH, MAX_SEARCHED = 60, 5_000


class ParentTransforms:
    """The transforms of a document's attached layers at any time.

    A parent moves a layer rigidly about its anchor. The distortion of the layer does not change,
    and the joint never opens. `siblings` have cached data of the outlines by layer id. Values of
    earlier transforms that are still valid are reused. Raises an `EngineError` if a joint or an
    anchor lies outside its layer.

    `points` are the joint points of each layer: its own anchor, and points of its children.
    `tracked` has these points over time. `is_whole` holds once all frames are computed.
    """

    def __init__(
        self,
        document: Document,
        siblings: Mapping[int, PoseSampler] | None = None,
        earlier: "ParentTransforms | None" = None,
    ) -> None:
        self.document = document
        self.points = _points(document)
        self.is_whole = False
        known = {} if earlier is None else earlier.tracked
        siblings = siblings or {}
        self.tracked: dict[int, PointTrails] = {
            layer: PointTrails(
                clip_of(document, layer),
                np.array(points),
                siblings.get(layer),
                known.get(layer),
                partial(self.parent_transform, layer),
            )
            for layer, points in self.points.items()
            if points
        }
        self._siblings = siblings
        self._animations: dict[int, Animation] = {}
        self._placements: dict[tuple[int, float, bool], Similarity] = {}
        self._turns: dict[tuple[int, float, bool], Turns] = {}
        self._kept: dict[tuple[int, Attachment, int], Similarity] = {}
        self._ahead = self._through()

    @property
    def computed_count(self) -> int:
        """Number of computed frames of layers; cached ones do not count."""
        return sum(each.worked_out for each in self.tracked.values())

    def placement(
        self,
        layer: int,
        frame: float,
        poses: Mapping[int, Pose] | None = None,
        *,
        before: bool = False,
    ) -> Similarity:
        """Return the transform of a layer at a frame.

        `poses` are shown in place of the layers' own, by layer id. With `before`, the attachments
        just before the frame are used.
        """
        if poses:
            return self._compute(layer, frame, poses, before=before)
        known = layer, frame, before
        if known not in self._placements:
            self._placements[known] = self._compute(layer, frame, {}, before=before)
        return self._placements[known]

    def _compute(
        self, layer: int, frame: float, poses: Mapping[int, Pose], *, before: bool
    ) -> Similarity:
        hinge = partial(self._joint, frame=frame, poses=poses)
        kept = partial(self.kept_transform, frame=frame)
        links = parent_links(self.document, layer, frame, before=before)
        # All layers with the same root have the same rotations by IK targets.
        known = links[-1].layer.id, frame, before
        turns = None if poses else self._turns.get(known)
        if turns is None:
            turns = find_turns(self.document, layer, frame, hinge, kept, before=before)
        if not poses:
            self._turns[known] = turns
        return compose_chain(turn_links(links, turns), hinge, kept)

    def kept_transform(self, layer: Layer, joint: Attachment, frame: float) -> Similarity:
        """Return the transform of a layer by an attachment with `keep_world_transform`.

        The layer's own transform is not in it. With `blends_to_next`, it eases to the transform
        that the next attachment defines.
        """
        begun = self._keep(layer, joint, joint.kept_from, before=True)
        at = self.document.loop_frame(frame)
        until = (
            self._blends_until(layer, joint) if joint.blends_to_next and at > joint.frame else None
        )
        if until is None:
            return begun
        share = min((at - joint.frame) / (until - joint.frame), 1.0)
        wanted = self._keep(layer, joint, self._in_scene(layer, until), before=False)
        return blend_transforms(layer, joint, begun, wanted, share * share * (3 - 2 * share))

    def _blends_until(self, layer: Layer, joint: Attachment) -> int | None:
        """Return the first frame of the next attachment; None if that depends on this one.

        The next attachment depends on this one if it keeps the transform of that time. It also does
        if its parent is a descendant at some frame.
        """
        joints = self.document.attachments_of(layer)
        after = next((each for each in joints if each.frame > joint.frame), None)
        if after is None or (after.keep_world_transform and after.kept_from > joint.kept_from):
            return None
        if after.parent is not None:
            parent = self.document.layer(after.parent)
            if layer in (parent, *self.document.all_ancestors(parent.id)):
                return None
        return after.frame

    def _in_scene(self, layer: Layer, until: int) -> int:
        """Return the frame of a repeat's start, or an earlier one within the document's frames.

        Earlier repeats have the same state.
        """
        cycle, last = layer.cycle_at(until), self.document.frames.last
        if cycle is None or until <= last:
            return until
        return until - cycle.period * -(-(until - last) // cycle.period)

    def _keep(self, layer: Layer, joint: Attachment, frame: int, *, before: bool) -> Similarity:
        """Return the transform that an attachment keeps from just before a frame, or at it."""
        known = layer.id, joint, frame
        if known not in self._kept:
            self._kept[known] = self._found(layer, joint, frame, before=before)
        return self._kept[known]

    def _found(self, layer: Layer, joint: Attachment, frame: int, *, before: bool) -> Similarity:
        hinge = partial(self._seen_from, layer.id, frame=frame)
        kept = partial(self.kept_transform, frame=frame)
        document, own = self.document, hinge(layer, require_anchor(layer))
        here = place_layer(document, layer.id, frame, hinge, kept, before=before)
        if joint.applies_transform:
            turns = find_turns(document, layer.id, frame, hinge, kept, before=before)
            links = parent_links(document, layer.id, frame, before=before)
            link = turn_links(links, turns)[0]
            here = here.compose(link.transform.about(own.position).inverse)
        if joint.parent is None:
            by = parent_links(document, layer.id, frame, before=True)[-1].scene_motion
            return here if before else by.inverse.compose(here)
        there = place_layer(document, joint.parent, frame, hinge, kept, before=not before)
        at = hinge(document.layer(joint.parent), joint.parent_point)
        turn = there.factor * at.rotation if joint.inherits_rotation else 1.0
        away = here.factor * own.position + here.shift - (there.factor * at.position + there.shift)
        return Similarity(complex(here.factor / turn), complex(away / turn))

    def joint_placement(self, layer: int, frame: float, pivot: complex) -> Similarity:
        """Return the placement of a layer at a frame without its own transform about a pivot."""
        hinge = partial(self._joint, frame=frame, poses={})
        kept = partial(self.kept_transform, frame=frame)
        document = self.document
        own = layer_value_at(document, document.layer(layer), TRANSFORM, frame) or UNMOVED
        turn = find_turns(document, layer, frame, hinge, kept).get(layer, 0.0)
        own = replace(own, turn=own.turn + turn)
        return self.placement(layer, frame).compose(own.about(pivot).inverse)

    def parent_transform(self, layer: int, frame: float) -> Similarity:
        """Return the transform of a layer by its parents, without its own corrections.

        Corrections neither move the anchor nor rotate the layer there.
        """
        hinge = partial(self._seen_from, layer, frame=frame)
        kept = partial(self.kept_transform, frame=frame)
        return place_layer(self.document, layer, frame, hinge, kept)

    def _seen_from(self, layer: int, each: Layer, place: complex, frame: float) -> PivotFrame:
        """Return position and rotation of a point for the computation of a dependent layer.

        Corrections that may depend on the layer in turn are left out. They belong to the layer
        itself, or to its descendants at other frames.
        """
        others = (each, *self.document.all_ancestors(each.id))
        if all(other.id != layer for other in others):
            return self._joint(each, place, frame, {})
        index = self.points[each.id].index(place)
        found = self.tracked[each.id].base_at(frame)
        return pivot_frame_at(found.positions[index], found.fz[index])

    def animation(self, layer: int, points: Complexes) -> Animation:
        """Return the motion of points (m,) of a layer; its springs and pins are solved once."""
        if layer in self._animations:
            return self._animations[layer].at_points(points)
        carried = partial(self.parent_transform, layer)
        made = layer_animation(self.document, layer, points, self._siblings, carried)
        return self._animations.setdefault(layer, made)

    def advance(self) -> "ParentTransforms":
        """Compute some frames in advance."""
        end = self.computed_count + BATCH
        for looked_at, (frame, tracked) in enumerate(self._ahead, 1):
            tracked.at(frame)
            if self.computed_count >= end or looked_at == MAX_SEARCHED:
                return self
        self.is_whole = True
        return self

    def _through(self) -> Iterator[tuple[int, PointTrails]]:
        """Yield all frames layer by layer, since each layer's preparation takes much memory."""
        frames = self.document.frames
        for tracked in self.tracked.values():
            for frame in range(frames.first, frames.last + 1):
                yield frame, tracked
            tracked.release_intermediates()

    def _joint(
        self, layer: Layer, place: complex, frame: float, poses: Mapping[int, Pose]
    ) -> PivotFrame:
        if layer.id in poses:
            return _pivot_frame_of(layer, poses[layer.id], place)
        index = self.points[layer.id].index(place)
        moved = self.tracked[layer.id].at(frame)
        return pivot_frame_at(moved.positions[index], moved.fz[index])


def find_parent_motion(
    document: Document, layer: int, siblings: Mapping[int, PoseSampler] | None = None
) -> ParentMotion | None:
    """Return the function from frame to the layer's transform; None if it never moves."""
    own = document.layer(layer)
    if not (own.has_parent or own.keys_of(TRANSFORM) or limb_ends(document, layer)):
        return None
    return partial(ParentTransforms(document, siblings).parent_transform, layer)


def layer_animation(
    document: Document,
    identity: int,
    points: Complexes,
    siblings: Mapping[int, PoseSampler],
    carried: ParentMotion | None,
) -> Animation:
    """Return the motion of points (m,) of a layer that may be attached."""
    layer = document.layer(identity)
    sampler = PoseSampler(layer, points=points, sibling=siblings.get(identity))
    return Animation(clip_of(document, identity), sampler=sampler, carried=carried)


def _points(document: Document) -> dict[int, list[complex]]:
    """Return the joint points of each layer."""
    points: dict[int, list[complex]] = {layer.id: [] for layer in document.layers}
    for layer in document.layers:
        if layer.attachments:
            points[layer.id].append(require_anchor(layer))
        for joint in layer.attachments:
            if joint.parent is not None:
                points[joint.parent].append(joint.parent_point)
    return points


def _pivot_frame_of(layer: Layer, pose: Pose, place: complex) -> PivotFrame:
    f, at = layer.map_of(pose), np.array([place])
    return pivot_frame_at(f(at)[0], f.derivatives(at)[0][0])

"""Attachments that keep a layer in place."""

import numpy as np

from app.document import TRANSFORM, Attachment, Layer, rest_pose
from app.errors import LissomError
from app.motion.parenting.chain import PivotFrame, pivot_frame_at
from app.motion.parenting.parent_transforms import ParentTransforms
from app.texts import _
from engine.arrays import Booleans, Complexes
from engine.errors import EngineError
from engine.geometry import contains, deepest_point, diameter
from engine.interpolation import Frame

# Newton steps to the point of a parent at a place; each step squares the error.
MAX_STEPS = 20
NEWTON_TOLERANCE = 1e-12  # fraction of the layer's size
SAME_SCALE = 1e-9
MAX_STARTS = 2_000  # largest number of triangles searched for a start


def attach_as_drawn(
    joints: ParentTransforms, child: int, parent: int, *, turns: bool
) -> tuple[complex, Attachment] | None:
    """Return the child's anchor and the attachment that join two layers as they are drawn.

    None if the child has a pose, a transform or a parent of its own, or if the drawings do not
    overlap.
    """
    own, other = joints.document.layer(child), joints.document.layer(parent)
    rest = rest_pose(own.domain, ())
    is_posed = any(
        not (np.array_equal(pose.phi, rest.phi) and np.array_equal(pose.psi, rest.psi))
        for pose in own.poses
    )
    if is_posed or own.tracks or own.attachments or own.keys_of(TRANSFORM):
        return None
    points = np.array([anchor_or_default(own), *_middles(own)])
    common = other.domain.contains(points)
    if not common.any():
        return None
    place = complex(points[_common_index(points, common)])
    return place, Attachment(parent=parent, parent_point=place, inherits_rotation=turns)


def attach_in_place(
    joints: ParentTransforms,
    child: int,
    parent: int,
    frame: float,
    *,
    place: complex | None = None,
    turns: bool,
) -> tuple[complex, Attachment]:
    """Return the child's anchor and the attachment that keep the child in place at a frame.

    The attachment replaces the one in effect at the frame. `joints` are the transforms before it.
    `place` is the joint in the scene, by default at the child's anchor. If the parent is not there
    and no other attachment needs the anchor, it is the centre of the overlap. Outside the parent,
    the child keeps its offset from the nearest point. With `turns`, the child rotates with the
    parent. Raises a `LissomError` if the child is not at that place.
    """
    own, other = joints.document.layer(child), joints.document.layer(parent)
    held = own.attachment_key_at(int(frame))
    here, there = joints.placement(child, frame), joints.placement(parent, frame)
    if place is None:
        others = [joint for joint in own.attachments if joint is not held]
        anchor = anchor_or_default(own) if others else _common_point(joints, own, other, frame)
    else:
        anchor = _source(joints, own, here.apply_inverse(place), frame)
    pivot = _pivot_frame(joints, own, anchor, frame).position
    # From now on the layer's own transform acts about the new joint.
    here = joints.joint_placement(child, frame, pivot)
    place = here.factor * pivot + here.shift
    at, away = _point_near(joints, other, there.apply_inverse(place), frame)
    turn = there.factor * _pivot_frame(joints, other, at, frame).rotation
    scale = abs(turn / here.factor) if turns else 1.0
    return anchor, Attachment(
        parent=parent,
        parent_point=at,
        inherits_rotation=turns,
        # With the parent's current rotation, the child has its current rotation.
        rest_rotation=float(np.angle(turn) - np.angle(here.factor)) if turns else 0.0,
        rest_scale=1.0 if abs(scale - 1) < SAME_SCALE else scale,
        offset=complex(away * there.factor / (turn if turns else 1.0)),
        frame=0 if held is None else held.frame,
    )


def reparent_in_place(
    joints: ParentTransforms, child: int, parent: int, frame: int, *, turns: bool
) -> Attachment:
    """Return the attachment to another parent that keeps the layer in place at a frame.

    The joint is at the parent's point that is nearest to the layer's anchor.
    """
    own, other = joints.document.layer(child), joints.document.layer(parent)
    here, there = joints.placement(child, frame, before=True), joints.placement(parent, frame)
    place = here.apply(
        np.array([_pivot_frame(joints, own, anchor_or_default(own), frame).position])
    )[0]
    at, *_rest = _point_near(joints, other, there.apply_inverse(complex(place)), frame)
    return Attachment(
        parent=parent,
        parent_point=at,
        inherits_rotation=turns,
        frame=frame,
        keep_world_transform=True,
    )


def anchor_or_default(layer: Layer) -> complex:
    if layer.anchor is not None:
        return layer.anchor
    return deepest_point(layer.domain.outline, layer.domain.loops[1:])


def _moved(joints: ParentTransforms, layer: Layer, points: Complexes, frame: float) -> Frame:
    return joints.animation(layer.id, points).frame(frame)


def _pivot_frame(
    joints: ParentTransforms, layer: Layer, place: complex, frame: float
) -> PivotFrame:
    moved = _moved(joints, layer, np.array([place]), frame)
    return pivot_frame_at(moved.positions[0], moved.fz[0])


def _middles(layer: Layer) -> Complexes:
    """Return points all over the undeformed layer."""
    mesh = layer.domain.mesh
    middles: Complexes = mesh.vertices[mesh.triangles].mean(axis=1)
    return middles[:: max(1, len(middles) // MAX_STARTS)]


def _common_point(joints: ParentTransforms, child: Layer, parent: Layer, frame: float) -> complex:
    """Return the child's anchor if the parent covers it, else a point of the overlap if any."""
    anchor = anchor_or_default(child)
    points = np.array([anchor, *_middles(child)])
    here, there = (joints.placement(each.id, frame) for each in (child, parent))
    places = here.apply(_moved(joints, child, points, frame).positions)
    border = there.apply(_moved(joints, parent, parent.domain.outline, frame).positions)
    common = contains(border, places)
    return complex(points[_common_index(places, common)]) if common.any() else anchor


def _common_index(places: Complexes, common: Booleans) -> int:
    """Return the first place if it is common, else the one in the middle of all that are."""
    if common[0]:
        return 0
    middle = places[common].mean()
    return int(np.argmin(np.where(common, np.abs(places - middle), np.inf)))


def _point_near(
    joints: ParentTransforms, layer: Layer, place: complex, frame: float
) -> tuple[complex, complex]:
    """Return the undeformed point of a layer at or nearest to a place.

    Also the offset of the place from that point; 0 on the layer. Both are in the layer's space.
    """
    try:
        return _source(joints, layer, place, frame), 0j
    except LissomError:
        points = _middles(layer)
        moved = _moved(joints, layer, points, frame).positions
        nearest = np.argmin(np.abs(moved - place))
        return complex(points[nearest]), complex(place - moved[nearest])


def _source(joints: ParentTransforms, layer: Layer, place: complex, frame: float) -> complex:
    """Return the undeformed point of a layer at a place in the layer's space."""
    middles = _middles(layer)
    moved = _moved(joints, layer, middles, frame)
    source = complex(middles[np.argmin(np.abs(moved.positions - place))])
    size = diameter(layer.domain.outline)
    for _step in range(MAX_STEPS):
        try:
            at = _moved(joints, layer, np.array([source]), frame)
        except EngineError:
            break  # outside the layer
        away = place - complex(at.positions[0])
        if abs(away) <= NEWTON_TOLERANCE * size:
            return source
        fz, fzbar = complex(at.fz[0]), complex(at.fzbar[0])
        area = abs(fz) ** 2 - abs(fzbar) ** 2
        source += (fz.conjugate() * away - fzbar * away.conjugate()) / area
    raise LissomError(
        _(
            "{layer!r} has no drawing at ({x:.0f}, {y:.0f}); move the anchor onto the drawing."
        ).format(layer=layer.name, x=place.real, y=place.imag)
    )

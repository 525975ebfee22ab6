"""The joint by which a layer comes to hang on another one so that nothing moves."""

import numpy as np

from app.document import Attachment, Layer
from app.errors import LissomError
from app.motion.parenting.chain import PivotFrame, pivot_frame_at
from app.motion.parenting.parent_transforms import ParentTransforms
from engine.arrays import Complexes
from engine.errors import EngineError
from engine.geometry import contains, deepest_point, diameter
from engine.interpolation import Frame

# Newton steps towards the point of a parent that is at a place; each squares the error.
MAX_STEPS = 20
NEWTON_TOLERANCE = 1e-12  # of the layer's size
MAX_STARTS = 2_000  # triangles among which the nearest one is where the search begins


def attach_in_place(
    joints: ParentTransforms,
    child: int,
    parent: int,
    frame: float,
    *,
    place: complex | None = None,
    turns: bool,
) -> tuple[complex, Attachment]:
    """Return the anchor and the joint by which a layer hangs so that nothing moves now.

    Parameters
    ----------
    joints : ParentTransforms
        As they were before.
    child, parent : int
        Ids of layers.
    frame : float
        Where nothing moves. The joint holds as long as the one that holds there now, or always.
    place : complex, optional
        Of the joint, in the scene; by default that of the child's anchor, or, where the parent is
        not there and no joint at another time needs it, the middle of where the two overlap. Where
        the parent is not at the place, the child hangs beside its nearest point.
    turns : bool
        Whether the child turns with the parent.

    Returns
    -------
    anchor : complex
        Of the child.
    joint : Attachment

    Raises
    ------
    LissomError
        If the child is not at that place.
    """
    own, other = joints.document.layer(child), joints.document.layer(parent)
    held = own.attachment_key_at(int(frame))
    here, there = joints.placement(child, frame), joints.placement(parent, frame)
    if place is None:
        others = [joint for joint in own.attachments if joint is not held]
        anchor = anchor_or_default(own) if others else _common_point(joints, own, other, frame)
        place = complex(
            here.apply(np.array([_pivot_frame(joints, own, anchor, frame).position]))[0]
        )
    else:
        anchor = _source(joints, own, here.apply_inverse(place), frame)
    at, away = _point_near(joints, other, there.apply_inverse(place), frame)
    turn = there.factor * _pivot_frame(joints, other, at, frame).rotation
    return anchor, Attachment(
        parent=parent,
        parent_point=at,
        inherits_rotation=turns,
        # With the parent's turn as it is now, the child is turned as it is now.
        rest_rotation=float(np.angle(turn) - np.angle(here.factor)) if turns else 0.0,
        offset=complex(away * there.factor / (turn if turns else 1.0)),
        frame=0 if held is None else held.frame,
    )


def reparent_in_place(
    joints: ParentTransforms, child: int, parent: int, frame: int, *, turns: bool
) -> Attachment:
    """Return the joint by which a layer goes on with another one from where it is at a frame.

    It is at the point of that one which is nearest to the layer's anchor then.
    """
    own, other = joints.document.layer(child), joints.document.layer(parent)
    here, there = joints.placement(child, frame, before=True), joints.placement(parent, frame)
    place = here.apply(
        np.array([_pivot_frame(joints, own, anchor_or_default(own), frame).position])
    )[0]
    at, _ = _point_near(joints, other, there.apply_inverse(complex(place)), frame)
    return Attachment(
        parent=parent,
        parent_point=at,
        inherits_rotation=turns,
        frame=frame,
        keep_world_transform=True,
    )


def anchor_or_default(layer: Layer) -> complex:
    """Return the anchor of a layer, or where it would be."""
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
    """Return points all over a layer at rest."""
    mesh = layer.domain.mesh
    middles: Complexes = mesh.vertices[mesh.triangles].mean(axis=1)
    return middles[:: max(1, len(middles) // MAX_STARTS)]


def _common_point(joints: ParentTransforms, child: Layer, parent: Layer, frame: float) -> complex:
    """Return the child's anchor if it is in the parent, else a point of it that is in both."""
    anchor = anchor_or_default(child)
    points = np.array([anchor, *_middles(child)])
    here, there = (joints.placement(each.id, frame) for each in (child, parent))
    places = here.apply(_moved(joints, child, points, frame).positions)
    border = there.apply(_moved(joints, parent, parent.domain.outline, frame).positions)
    common = contains(border, places)
    if common[0] or not common.any():
        return anchor
    middle = places[common].mean()
    nearest = np.argmin(np.where(common, np.abs(places - middle), np.inf))
    return complex(points[nearest])


def _point_near(
    joints: ParentTransforms, layer: Layer, place: complex, frame: float
) -> tuple[complex, complex]:
    """Return the point of a layer at rest that is at a place, or is nearest to it.

    Also how far the place is from there; 0 where it is on the layer. All in the layer's own
    terms.
    """
    try:
        return _source(joints, layer, place, frame), 0j
    except LissomError:
        points = _middles(layer)
        moved = _moved(joints, layer, points, frame).positions
        nearest = np.argmin(np.abs(moved - place))
        return complex(points[nearest]), complex(place - moved[nearest])


def _source(joints: ParentTransforms, layer: Layer, place: complex, frame: float) -> complex:
    """Return the point of a layer at rest that is at a place, in the layer's own terms."""
    middles = _middles(layer)
    moved = _moved(joints, layer, middles, frame)
    source = complex(middles[np.argmin(np.abs(moved.positions - place))])
    size = diameter(layer.domain.outline)
    for _ in range(MAX_STEPS):
        try:
            at = _moved(joints, layer, np.array([source]), frame)
        except EngineError:
            break  # outside
        away = place - complex(at.positions[0])
        if abs(away) <= NEWTON_TOLERANCE * size:
            return source
        fz, fzbar = complex(at.fz[0]), complex(at.fzbar[0])
        area = abs(fz) ** 2 - abs(fzbar) ** 2
        source += (fz.conjugate() * away - fzbar * away.conjugate()) / area
    raise LissomError(
        f"There is nothing of {layer.name!r} at ({place.real:.0f}, {place.imag:.0f}); put its "
        "anchor on it."
    )

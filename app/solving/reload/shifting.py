"""Layers that move on the canvas as a whole: artwork, handles and poses by the same vector."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.document import IK_TARGET, Attachment, Document, Layer, Pose
from engine.maps import HarmonicMap

NOWHERE: complex = 0j


def shift_layer(layer: Layer, by: complex) -> Layer:
    """Return a layer that is moved on the canvas, with its motion unchanged.

    Joints of child layers on it belong to the children, and stay.
    """
    if not by:
        return layer
    domain = layer.domain.moved(by)

    def moved(pose: Pose) -> Pose:
        # f'(z + by) = f(z) + by: the same coefficients over the moved cage, then a translation.
        f = HarmonicMap(
            cage=domain.cage, phi=pose.phi, psi=pose.psi, holes=domain.holes, logs=pose.logs
        )
        targets = {
            identity: replace(target, position=target.position + by)
            for identity, target in pose.targets.items()
        }
        return replace(pose.with_map(f.moved(1, by)), targets=targets)

    tracks = tuple(
        replace(track, keys=tuple(replace(key, place=key.place + by) for key in track.keys))
        if track.is_scene_space
        else track
        for track in layer.tracks
    )
    targets = (
        replace(key, value=replace(key.value, place=key.value.place + by))
        for key in layer.keys_of(IK_TARGET)
    )
    motions = tuple(motion.shifted(by) for motion in layer.motions)
    return layer.with_keys_of(IK_TARGET, targets).with_poses(
        map(moved, layer.poses),
        corner=layer.corner + by,
        domain=domain,
        handles=tuple(replace(each, position=each.position + by) for each in layer.handles),
        anchor=None if layer.anchor is None else layer.anchor + by,
        mirror=None if layer.mirror is None else layer.mirror + by.real,
        tracks=tracks,
        motions=motions,
    )


def shift_scene(document: Document, by: complex) -> Document:
    """Return a document whose layers, joints and camera are moved on the canvas."""
    if not by:
        return document
    layers = tuple(
        replace(
            shift_layer(layer, by),
            attachments=tuple(
                replace(joint, parent_point=joint.parent_point + by) for joint in layer.attachments
            ),
        )
        for layer in document.layers
    )
    camera = tuple(
        replace(key, value=replace(key.value, centre=key.value.centre + by))
        for key in document.camera
    )
    drawings = tuple(replace(drawing, corner=drawing.corner + by) for drawing in document.drawings)
    return replace(document, layers=layers, camera=camera, drawings=drawings)


def with_moved_joints(
    layer: Layer, shifts: Mapping[int, complex], layers: Mapping[int, Layer]
) -> Layer:
    """Return a layer whose joints follow the shifts of the layer and of its parents.

    A layer that moved on its parent takes the joint along, if the joint is then still on the
    parent's shape; otherwise the joint keeps its place on the parent, with an offset.

    Parameters
    ----------
    shifts : mapping of int to complex
        Shifts of the artwork by layer id.
    layers : mapping of int to Layer
        The layers after the reload, by id.
    """
    own = shifts.get(layer.id, NOWHERE)

    def moved(joint: Attachment) -> Attachment:
        by = NOWHERE if joint.parent is None else shifts.get(joint.parent, NOWHERE)
        if joint.parent is None or (not own and not by):
            return joint
        beside = joint.parent_point + own
        parent = layers.get(joint.parent)
        if own == by or (parent is not None and parent.covers(np.array([beside])).all()):
            return replace(joint, parent_point=beside)
        return replace(joint, parent_point=joint.parent_point + by, offset=joint.offset + own - by)

    joints = tuple(map(moved, layer.attachments))
    return layer if joints == layer.attachments else replace(layer, attachments=joints)

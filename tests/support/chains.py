"""Discs that hang on each other, and where points of them are."""

from dataclasses import replace
from functools import cache

import numpy as np
from documents import CENTRE, disc_document, inside

from app.document import clip_of, layer_commands as layers
from app.document.keyframe import Keyframe
from app.document.layers.attachments import Attachment
from app.document.settings import FrameRange
from app.motion import Animation, ParentTransforms

SIZE = 200.0
VARIANTS = ("nu", "metric", "scaled-eta")


def bent(layer, turn, bend, shift):
    """The key pose of a layer turned by an angle, bent and moved."""
    first = layer.keys[0].pose
    z = layer.domain.cage - CENTRE
    return replace(first, phi=CENTRE + shift + z * np.exp(1j * turn) + bend * z**2)


@cache
def chain(variant="nu", count=3):
    """Discs that hang on each other, each bent otherwise, over 48 frames."""
    document = replace(disc_document(), frames=FrameRange(0, 48))
    rng = np.random.default_rng(4)
    first = document.layers[0]
    for index in range(count):
        layer = replace(first, id=index, name=str(index), variant=variant)
        keys = tuple(
            Keyframe(
                frame=frame,
                pose=bent(layer, rng.normal(), 4e-4 * rng.normal(), complex(*rng.normal(size=2))),
            )
            for frame in (0, 20, 48)
        )
        layer = replace(layer, keys=keys)
        if index == 0:
            document = document.with_layer(layer)
            continue
        document = layers.add_layer(layer)(document)
        joint = Attachment(parent=index - 1, parent_point=inside(rng), rest_rotation=rng.normal())
        document = layers.attach_layer(index, inside(rng), joint)(document)
    return document


@cache
def alone(clip, place):
    """A point of a layer by itself."""
    return Animation(clip, points=np.array([place]))


def exactly(document, layer, place, frame):
    """Where a point of a layer is by itself, and its f_z."""
    moved = alone(clip_of(document, layer), place).frame(frame)
    return moved.positions[0], moved.fz[0]


@cache
def among(clip):
    """Some points of a layer by itself."""
    return Animation(clip, points=np.array([CENTRE, CENTRE + 30j, CENTRE - 50]))


def seen(document, layer, frame, joints=None):
    """Where some points of a layer are in the scene; by its joints where they are known."""
    own = among(clip_of(document, layer)).positions(frame)
    return (joints or ParentTransforms(document)).placement(layer, frame).apply(own)

"""Documents with a row of keys through which the motion passes, and what their clips have ready."""

from dataclasses import replace
from functools import cache

import numpy as np
from animations import still_document, within
from documents import altered
from shapes import regular_polygon

from app.document.keyframe import Keyframe
from app.document.queries.clips import clip_of
from app.document.settings import FrameRange
from app.motion.caches.inbetween_cache import InbetweenCache
from app.motion.meshes.deform_mesh import DeformMesh
from engine.maps import Bounds

TURNS = (1.0, np.exp(0.3j), np.exp(-0.4j), np.exp(0.2j), np.exp(0.5j), np.exp(-0.1j), np.exp(0.1j))


@cache
def drawing():
    """Return a document of the blob within a polygon, and a pose that turns and bends it."""
    circle = regular_polygon(12)
    document = within(still_document(), 60 + 47j + 54 * circle.real + 40j * circle.imag)
    (layer,) = document.layers
    middle = layer.domain.cage.mean()
    z = layer.domain.cage - middle
    return document, replace(layer.keys[0].pose, phi=middle + z * np.exp(0.5j) + 5e-4 * z**2)


def row(count, *, loop=False, **settings):
    """Return a document with keys 10 frames apart, between others of which the motion passes."""
    document, pose = drawing()
    keys = tuple(
        Keyframe(frame=10 * i, pose=replace(pose, phi=turn * pose.phi))
        for i, turn in enumerate(TURNS[:count])
    )
    frames = FrameRange(0, 10 * (count if loop else count - 1))
    settings = {"variant": "nu", "bounds": Bounds(k=0.9, sigma_a=9, sigma_b=0.1)} | settings
    return altered(document, keys=keys, frames=frames, loop=loop, **settings)


def prepared(document, store=None):
    """Return a store that has all in-betweens of a document, and how many were prepared for it."""
    clip = clip_of(document, 0)
    store = store or InbetweenCache(mesh=DeformMesh.coarse(clip.layer.domain))
    lacking = store.missing_segments(clip, 0)
    store.add(store.segments_job(clip, lacking)())
    assert store.has(clip)
    return store, len(lacking)


def jump(animation, frame):
    """Return the change of velocity at a frame, and the velocity, in the widest sense."""
    e = 1e-4

    def velocity(sign):
        p = [animation.positions(frame + sign * s * e) for s in (0, 1, 2)]
        return sign * (-3 * p[0] + 4 * p[1] - p[2]) / (2 * e)

    after, before = velocity(1), velocity(-1)
    return np.abs(after - before).max(), np.abs(after).max()

"""Which way shapes turn between keys, where a part of them turns by more than half a turn."""

from dataclasses import replace

import numpy as np
import pytest
from animations import still_document
from numpy.testing import assert_allclose

from app.document import Bone, Target, clip_of, handle_commands, motion_anchor
from app.motion import Animation, DeformMesh, InbetweenCache, PoseSampler

BAR, DISC = 260.0, 60.0  # length of the stem, and radius of the disc at its end
START, END = 40 + 100j, 340 + 100j
CURL = 4.0  # turn of the disc's middle against the start of the stem, in radians


def ladle(disc: float = DISC):
    """A document of a stem with a disc at its right end."""
    y, x = np.mgrid[:200, :420] + 0.5
    is_stem = (np.abs(y - 100) < 14) & (abs(x - START.real - BAR / 2) < BAR / 2 + 20)
    is_disc = np.abs(x + 1j * y - END) < disc
    picture = np.zeros((200, 420, 4), np.uint8)
    picture[is_stem | is_disc] = (200, 90, 40, 255)
    return still_document(picture)


def curled(layer):
    """Return the drawing's pose curled up to an arc of a circle, which its start touches."""
    pace = 1j * CURL / (END - START).real
    phi = START + (np.exp(pace * (layer.domain.cage - START)) - 1) / pace
    return replace(layer.keys[0].pose, phi=phi)


def turns(sampler, layer, pose, share):
    """Return the arguments of f_z of an in-between at the sampler's points."""
    first = layer.keys[0].pose
    return np.angle(sampler.inbetweens(first, pose, layer.variant).frame(share).fz)


def test_a_shape_turns_the_shorter_way_in_the_mean():
    document = ladle()
    layer = document.layers[0]
    along = START + np.linspace(0, 1, 5) * (END - START)
    sampler = PoseSampler(layer, points=along)
    assert abs(sampler.sites.anchor - END) < DISC / 2  # the disc's own shorter way is back
    middle = turns(sampler, layer, curled(layer), 0.5)
    assert_allclose(middle, 0.5 * CURL * np.linspace(0, 1, 5), atol=0.1)


def test_a_given_anchor_turns_the_shorter_way_itself():
    document = ladle()
    layer = document.layers[0]
    sampler = PoseSampler(replace(layer, anchor=END), points=np.array([END]))
    middle = turns(sampler, layer, curled(layer), 0.5)
    assert_allclose(middle, 0.5 * (CURL - 2 * np.pi), atol=0.05)


@pytest.mark.parametrize("disc", [DISC, 16.0])
def test_bones_turn_about_the_body_that_carries_them(disc):
    """The body is the cap beside the root, of a limb with a disc, and of a limb alone."""
    document = ladle(disc)
    for name, share in (("root", 0.06), ("joint", 0.45), ("end", 0.8)):
        place = START + share * (END - START)
        document = handle_commands.add_handle(0, place, name=name)(document)
    root, joint, end = (each.id for each in document.layers[0].handles)
    layer = replace(document.layers[0], bones=(Bone(ends=(root, joint)), Bone(ends=(joint, end))))
    anchor, pose = motion_anchor(layer), curled(layer)
    assert abs(anchor - START) < 30
    reached = layer.map_of(pose)(np.array([each.position for each in layer.handles]))
    targets = {
        each.id: Target(position=complex(place))
        for each, place in zip(layer.handles, reached, strict=True)
    }
    rest = layer.keys[0]
    keys = (rest, replace(rest, frame=20, pose=replace(pose, targets=targets)))
    document = document.with_layer(replace(layer, keys=keys))
    clip = clip_of(document, 0)
    animation = Animation(clip, points=np.array([anchor]))
    places = np.concatenate([animation.positions(frame) for frame in range(21)])
    assert_allclose(places, anchor, atol=4.0)
    # The window's cache takes the sampler of this anchor.
    cache = InbetweenCache(mesh=DeformMesh.fine(layer.domain))
    cache.set_needed_clips([clip], (), 7)
    cache.add(cache.segments_job(clip, cache.missing_segments(clip, 7))())
    assert cache.sampler is not None
    assert cache.sampler.is_for(layer)
    assert cache.is_exact(clip, 7)


def test_an_anchor_of_its_own_stays():
    layer = replace(ladle().layers[0], anchor=END)
    assert motion_anchor(layer) == END

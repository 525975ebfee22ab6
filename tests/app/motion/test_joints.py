from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from documents import CENTRE, disc_document, inside
from numpy.testing import assert_allclose

from app.document import clip_of
from app.document import layer_commands as layers
from app.document.keyframe import Keyframe
from app.document.layering import Attachment
from app.document.settings import FrameRange
from app.errors import LissomError
from app.motion import HERE, Animation, Joints

SIZE = 200.0
VARIANTS = ("nu", "metric", "scaled-eta")


def bent(figure, turn, bend, shift):
    """The key pose of a figure turned by an angle, bent and moved."""
    first = figure.keys[0].pose
    z = figure.domain.cage - CENTRE
    return replace(first, phi=CENTRE + shift + z * np.exp(1j * turn) + bend * z**2)


@cache
def chain(variant="nu", count=3):
    """Discs that hang on each other, each bent otherwise, over 48 frames."""
    document = replace(disc_document(), frames=FrameRange(0, 48))
    rng = np.random.default_rng(4)
    first = document.figures[0]
    for index in range(count):
        figure = replace(first, id=index, name=str(index), variant=variant)
        keys = tuple(
            Keyframe(
                frame=frame,
                pose=bent(figure, rng.normal(), 4e-4 * rng.normal(), complex(*rng.normal(size=2))),
            )
            for frame in (0, 20, 48)
        )
        figure = replace(figure, keys=keys)
        if index == 0:
            document = document.with_figure(figure)
            continue
        document = layers.add_figure(figure)(document)
        joint = Attachment(to=index - 1, at=inside(rng), rest=rng.normal())
        document = layers.attach(index, inside(rng), joint)(document)
    return document


@cache
def alone(document, figure, place):
    """A point of a figure by itself."""
    return Animation(clip_of(document, figure), points=np.array([place]))


def exactly(document, figure, place, frame):
    """Where a point of a figure is by itself, and its f_z."""
    moved = alone(document, figure, place).frame(frame)
    return moved.positions[0], moved.fz[0]


def seen(document, figure, frame):
    """Where some points of a figure are in the scene."""
    points = np.array([CENTRE, CENTRE + 30j, CENTRE - 50])
    own = Animation(clip_of(document, figure), points=points).positions(frame)
    return Joints(document).placement(figure, frame).on(own)


@pytest.mark.parametrize("variant", VARIANTS)
def test_a_joint_stays_closed_and_turns_with_the_parent(variant):
    document = chain(variant)
    joints = Joints(document)
    rng = np.random.default_rng(2)
    times = rng.uniform(0, 48, 200 if variant == "nu" else 5)
    for frame in (*times, 0, 20, 48):
        for child in (1, 2):
            figure = document.figure(child)
            own, carrier = (joints.placement(i, frame) for i in (child, child - 1))
            anchor, _ = exactly(document, child, figure.anchor, frame)
            at, fz = exactly(document, child - 1, figure.attachment.at, frame)
            place = carrier.on(np.array([at]))[0]
            assert abs(own.on(np.array([anchor]))[0] - place) < 1e-9 * SIZE
            turned = carrier.factor * fz / abs(fz) * np.exp(-1j * figure.attachment.rest)
            assert abs(own.factor - turned) < 1e-9
            assert abs(abs(own.factor) - 1) < 1e-12


def test_what_hangs_on_nothing_is_where_it_is():
    joints = Joints(chain())
    assert joints.placement(0, 17.5) is HERE
    places = np.array([1 + 2j])
    assert HERE.on(places) is places


def test_what_does_not_turn_only_moves():
    document = chain()
    figure = document.figure(1)
    still = replace(figure.attachment, turns=False)
    document = layers.attach(1, figure.anchor, still)(document)
    assert Joints(document).placement(1, 30.0).factor == 1


def test_a_pose_that_is_shown_takes_the_place_of_the_key_s():
    document = chain()
    figure, joint = document.figure(0), document.figure(1).attachment
    pose = bent(figure, 1.0, 2e-4, 5)
    posed = document.with_figure(
        replace(figure, keys=(replace(figure.keys[0], pose=pose), *figure.keys[1:]))
    )
    shown = Joints(document).placement(1, 0, {0: pose})
    keyed = Joints(posed).placement(1, 0)
    assert_allclose([*shown], [*keyed], rtol=0, atol=1e-9)
    f = figure.map_of(pose)
    own, _ = exactly(document, 1, document.figure(1).anchor, 0)
    assert_allclose(shown.on(own), f(np.array([joint.at]))[0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("frame", [0, 11.5, 20])
@pytest.mark.parametrize("turns", [True, False])
def test_attaching_moves_nothing_at_the_present_frame(frame, turns):
    document = chain()
    loose = layers.detach(2, 1, 0)(document)
    before = Joints(loose)
    held, _ = exactly(loose, 2, CENTRE, frame)
    place = complex(before.placement(2, frame).on(np.array([held]))[0])
    anchor, joint = before.hang(2, 0, frame, place=place, turns=turns)
    assert abs(anchor - CENTRE) < 1e-8
    hung = layers.attach(2, anchor, joint)(loose)
    assert_allclose(seen(hung, 2, frame), seen(loose, 2, frame), rtol=0, atol=1e-8)
    by_anchor = before.hang(2, 0, frame, turns=turns)
    assert abs(by_anchor[0] - document.figure(2).anchor) < 1e-12


def test_detaching_moves_nothing_at_the_present_frame():
    document, frame = chain(), 20
    before = Joints(document).placement(2, frame)
    loose = layers.detach(2, before.factor, before.shift)(document)
    assert_allclose(seen(loose, 2, frame), seen(document, 2, frame), rtol=0, atol=1e-9)


def test_without_a_common_anchor_layers_are_joined_where_they_overlap():
    document = layers.detach(2, 1, 0)(chain())
    figure = document.figure(2)
    apart = replace(figure, anchor=CENTRE - 80)
    keys = tuple(replace(k, pose=bent(figure, 0, 0, 130)) for k in figure.keys)
    document = document.with_figure(replace(apart, keys=keys))
    anchor, joint = Joints(document).hang(2, 0, 0, turns=True)
    assert anchor.real < CENTRE.real
    hung = layers.attach(2, anchor, joint)(document)
    assert_allclose(seen(hung, 2, 0), seen(document, 2, 0), rtol=0, atol=1e-8)


def test_a_joint_must_be_on_both_figures():
    document = layers.detach(2, 1, 0)(chain())
    with pytest.raises(LissomError, match=r"nothing of '2' at \(5000, 0\)"):
        Joints(document).hang(2, 0, 0, place=5000 + 0j, turns=True)

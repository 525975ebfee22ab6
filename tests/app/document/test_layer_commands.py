from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, disc_document, inside
from messages import says
from numpy.testing import assert_allclose

from app.document import (
    DEPTH,
    VISIBILITY,
    Channel,
    channel_commands as channels,
    handle_commands as handles,
    layer_commands as layers,
    scene_commands as scenes,
)
from app.document.commands.keys.retime import KEYS_COLLIDE
from app.document.commands.layers.layer_commands import LAST_LAYER
from app.document.layer import NO_KEY
from app.document.layers.attachments import Attachment
from app.document.model import NO_LAYER, PARENT_CIRCLE
from app.document.queries.clips import clip_of
from app.document.queries.layers.depth import depth_points_at
from app.document.queries.layers.visibility import is_visible
from app.errors import LissomError

SHOWN = Channel(VISIBILITY, 0)


def scene(*names):
    """A document with a layer for each name, from back to front, with the ids 0, 1, 2 …"""
    document = disc_document()
    document = layers.rename_layer(0, names[0])(document)
    for name in names[1:]:
        layer = replace(
            document.layers[0], id=layers.next_layer_id(document), name=name, attachments=()
        )
        document = layers.add_layer(layer)(document)
    return document


def order(document):
    return [layer.name for layer in document.layers]


def test_layers_are_added_moved_duplicated_and_deleted():
    document = scene("body", "arm", "head")
    assert order(document) == ["body", "arm", "head"]
    assert order(layers.move_layer(2, 0)(document)) == ["head", "body", "arm"]
    assert layers.move_layer(1, 1)(document) is document
    copied = layers.duplicate_layer(1)(document)
    assert order(copied) == ["body", "arm", "arm copy", "head"]
    assert copied.layers[2].id == 3
    assert order(layers.duplicate_layer(1)(copied))[2] == "arm copy 2"
    assert order(layers.remove_layer(1)(document)) == ["body", "head"]
    with pytest.raises(LissomError, match=says(LAST_LAYER)):
        layers.remove_layer(0)(disc_document())
    with pytest.raises(LissomError, match="a layer cannot be number 4"):
        layers.move_layer(1, 3)(document)


def test_the_canvas_stays_whatever_lies_behind():
    document = scene("body", "arm")
    assert layers.move_layer(1, 0)(document).canvas == (200, 200)
    assert layers.remove_layer(0)(document).canvas == (200, 200)
    wide = replace(document.layers[0], id=7, name="wide", corner=-50j)
    assert layers.add_layer(wide, 0)(document).size == (200, 200)


def test_two_layers_have_two_names():
    document = scene("body", "arm")
    with pytest.raises(LissomError, match="Two layers have the name 'body'"):
        layers.rename_layer(1, "body ")(document)
    assert layers.rename_layer(1, "arm")(document) is document


def test_layer_is_never_its_own_ancestor_and_parents_may_go():
    document = scene("body", "arm", "hand")
    joint = Attachment(parent=0, parent_point=CENTRE)
    document = layers.attach_layer(1, CENTRE, joint)(document)
    document = layers.attach_layer(2, CENTRE, Attachment(parent=1, parent_point=CENTRE))(document)
    assert [layer.name for layer in document.parent_chain(2, 0)] == ["hand", "arm", "body"]
    for child, parent in ((0, 2), (0, 1), (1, 1)):
        with pytest.raises(LissomError, match=says(PARENT_CIRCLE)):
            layers.attach_layer(child, CENTRE, Attachment(parent=parent, parent_point=CENTRE))(
                document
            )
    loose = layers.remove_layer(1)(document)
    assert loose.layer(2).attachments == ()
    with pytest.raises(LissomError, match=says(NO_LAYER, identity=9)):
        layers.attach_layer(1, CENTRE, Attachment(parent=9, parent_point=CENTRE))(document)


def test_detached_poses_are_turned_and_moved_and_as_distorted_as_before():
    document = handles.add_handle(0, CENTRE)(scene("body", "arm"))
    document = handles.add_handle(1, CENTRE + 20)(document)
    document = layers.attach_layer(1, CENTRE, Attachment(parent=0, parent_point=CENTRE))(document)
    factor, shift = np.exp(0.4j), 3 - 2j
    loose = layers.detach_layer(1, factor, shift)(document).layer(1)
    before = document.layer(1)
    assert loose.attachments == ()
    points = np.array([CENTRE, CENTRE + 30j])
    old, new = (layer.map_of(layer.keys[0].pose) for layer in (before, loose))
    assert_allclose(new(points), factor * old(points) + shift, rtol=0, atol=1e-11)
    assert_allclose(np.abs(new.derivatives(points)), np.abs(old.derivatives(points)), atol=1e-12)
    (target,) = loose.keys[0].pose.targets.values()
    assert_allclose(target.position, factor * (CENTRE + 20) + shift)
    assert layers.detach_layer(0, factor, shift)(document) is document


def test_a_layer_is_seen_as_its_switches_say():
    document = layers.key_visibility(0, 12, visible=False)(disc_document())
    assert document.layers[0].keys_of(VISIBILITY) == (
        VISIBILITY.key(0, value=True),
        VISIBILITY.key(12, value=False),
    )
    document = layers.key_visibility(0, 20, visible=True)(document)
    seen = [is_visible(document, document.layers[0], frame) for frame in (0, 11.9, 12, 19, 20, 50)]
    assert seen == [True, True, False, False, True, True]
    hidden = layers.set_hidden(0, hidden=True)(document)
    assert not is_visible(hidden, hidden.layers[0], 0)
    left = channels.delete_keys({SHOWN: {12}})(document)
    assert left.layers[0].keys_of(VISIBILITY) == (
        VISIBILITY.key(0, value=True),
        VISIBILITY.key(20, value=True),
    )
    fresh = disc_document()
    assert is_visible(fresh, fresh.layers[0], 5)


def test_what_is_seen_when_moves_and_is_stretched_with_all_time():
    document = layers.key_visibility(0, 12, visible=False)(disc_document())
    document = layers.key_visibility(0, 20, visible=True)(document)

    def frames(document):
        return [switch.frame for switch in document.layers[0].keys_of(VISIBILITY)]

    assert frames(channels.move_keys({SHOWN: {12}}, 3)(document)) == [0, 15, 20]
    passed = channels.move_keys({SHOWN: {12}}, 18)(document)
    assert frames(passed) == [0, 20, 30]
    assert [switch.value for switch in passed.layers[0].keys_of(VISIBILITY)] == [True, True, False]
    assert channels.move_keys({SHOWN: {12}}, 0)(document) is document
    with pytest.raises(LissomError, match=says(NO_KEY, frame=13)):
        channels.move_keys({SHOWN: {13}}, 1)(document)
    with pytest.raises(LissomError, match=says(KEYS_COLLIDE, frame=20)):
        channels.move_keys({SHOWN: {12}}, 8)(document)
    assert frames(scenes.scale_time(2.0)(document)) == [0, 24, 40]


def test_depth_holds_from_a_key_on():
    rng = np.random.default_rng(1)
    document = handles.add_handle(0, inside(rng), name="nose")(disc_document())
    document = handles.add_handle(0, inside(rng), name="tail")(document)
    layer = document.layers[0]
    pose = layer.keys[0].pose
    keys = tuple(replace(layer.keys[0], frame=frame, pose=pose) for frame in (0, 10, 20))
    document = document.with_layer(replace(layer, keys=keys))
    document = layers.set_depth(0, 0, -0.5, 30.0)(document)
    document = channels.set_key(Channel(DEPTH, 0, 0), 10, 1.0)(document)
    document = channels.set_key(Channel(DEPTH, 0, 1), 20, 0.25)(document)

    def depths(frame, *, loop=False):
        clip = replace(clip_of(document, 0), loop=loop)
        return [(front.place, front.depth) for front in depth_points_at(clip, frame)]

    nose, tail = (handle.position for handle in document.layers[0].handles)
    assert depths(0) == depths(9.5) == [(nose, -0.5)]
    assert depths(10) == [(nose, 1.0)]
    assert depths(30) == [(nose, 1.0), (tail, 0.25)]
    fronts = depth_points_at(clip_of(document, 0), 30)
    assert fronts[0].extent == 30.0
    assert fronts[1].extent == pytest.approx(0.15 * 180)
    # In a loop, the last keys hold until the first ones.
    assert depths(48 + 9, loop=True) == depths(9, loop=True) == depths(30)
    assert depths(48 + 10, loop=True) == [(nose, 1.0), (tail, 0.25)]
    gone = handles.remove_handles(0, {0})(document)
    assert list(gone.layers[0].channels) == [(DEPTH.name, 1)]
    assert (
        channels.delete_keys({Channel(DEPTH, 0, 0): {10}})(document).layers[0].keys_of(DEPTH, 0)
        == ()
    )
    with pytest.raises(LissomError, match=r"from −1 \(behind\) to 1"):
        layers.set_depth(0, 0, 1.5, None)(document)

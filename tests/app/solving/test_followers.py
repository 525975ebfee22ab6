"""Handles that follow by springs: poses are not held by them, unless they are pulled at."""

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest
from animations import bar_document, bar_picture, still_document
from numpy.testing import assert_allclose
from sessions import session_of, settle

from app.document import Attachment, FrameRange, Spring, Target, Track, TrackKey
from app.document.commands import (
    handle_commands,
)
from app.document.commands.keys import (
    track_commands,
)
from app.document.commands.layers import layer_commands
from app.editor.actions.posing.pose_drag import drag_handles, nudge_handles, release_drag
from app.solving import flip_poses, pose_document
from app.solving.drag.drag_solver import DragSolver
from app.solving.drag.rig import Rig
from app.solving.resolve_keys import KeyResolver, step_resolver
from app.solving.script.pose_script import parse_pose_script
from engine.deform import BoundedPull
from engine.maps import Bounds

NAMES = {"end": 210, "middle": 120, "start": 30}
END, MIDDLE, START = range(3)
SPRING = Spring(handle=MIDDLE, frequency=2.0, damping=0.3)
# The end is led so far aside that the middle, were it held, would stay far behind.
ASIDE = MappingProxyType({END: 210 + 90j, START: 30 + 40j})


@pytest.fixture(scope="module")
def bar():
    """A bar with three handles, the middle one of which follows."""
    document = bar_document()
    for name, x in NAMES.items():
        document = handle_commands.add_handle(0, complex(x, 40), name=name)(document)
    return track_commands.put_spring(0, SPRING)(document)


def dragged(layer, targets=MappingProxyType({}), pulled=()):
    """Return the pose to which a drag of the drawing leads."""
    pose = layer.keys[0].pose
    wanted = {i: Target(position=ASIDE.get(i, h.position)) for i, h in enumerate(layer.handles)}
    wanted |= targets
    drag = DragSolver.begin(Rig.of(layer), pose).step_towards(wanted, 600, (), pulled)
    assert drag.is_over
    return drag.make_pose(wanted)


def places(layer, pose):
    at = np.array([handle.position for handle in layer.handles])
    return layer.map_of(pose)(at)


def without_middle(document):
    """Return the layer that has no handle in its middle at all."""
    return handle_commands.remove_handles(0, {MIDDLE})(document).layers[0]


def test_what_follows_goes_where_the_body_carries_it(bar):
    layer = bar.layers[0]
    pose = dragged(layer)
    place = places(layer, pose)[MIDDLE]
    assert abs(place - layer.handle(MIDDLE).position) > 20
    assert_allclose(pose.targets[MIDDLE].position, place, rtol=0, atol=1e-9)
    # It is the very pose that there is without the handle.
    free = without_middle(bar)
    targets = {i: Target(position=place) for i, place in ASIDE.items()}
    alone = (
        DragSolver.begin(Rig.of(free), free.keys[0].pose)
        .step_towards(targets, 600)
        .make_pose(targets)
    )
    assert np.array_equal(pose.phi, alone.phi)
    assert pose.targets[END] == targets[END]


def test_what_has_a_track_of_its_own_or_a_spring_that_is_off_is_held(bar):
    tracked = track_commands.put_track(
        0, Track(handles=(MIDDLE,), keys=(TrackKey(frame=0, place=0j),))
    )(bar)
    off = track_commands.put_spring(0, replace(SPRING, enabled=False))(bar)
    for document in (tracked, off):
        layer = document.layers[0]
        assert layer.sprung_handles == frozenset()
        pose = dragged(layer)
        assert abs(places(layer, pose)[MIDDLE] - layer.handle(MIDDLE).position) < 2
        assert pose.targets[MIDDLE].position == layer.handle(MIDDLE).position
    switched_off = track_commands.enable_track(0, MIDDLE, enabled=False)(tracked)
    assert switched_off.layers[0].sprung_handles == {MIDDLE}


def test_a_person_who_pulls_at_it_does_pull(bar):
    layer, to = bar.layers[0], 120 + 58j
    pulled = {MIDDLE}
    pose = dragged(layer, {MIDDLE: Target(position=to)}, pulled)
    assert abs(places(layer, pose)[MIDDLE] - to) < 1
    assert pose.targets[MIDDLE].position == to
    # It stays as the hand left it, and is let go by the next pull elsewhere.
    hand = BoundedPull(frozenset(pulled))
    drag = DragSolver.begin(Rig.of(layer), pose).step_towards(pose.targets, 600, (), pulled)
    assert drag.release(pose.targets, (hand,))[1].keys() == pulled
    after = drag.step_towards(pose.targets, 600)
    assert abs(places(layer, after.make_pose(pose.targets))[MIDDLE] - to) > 5
    assert drag.rig.deformer.handles is not after.rig.deformer.handles


def test_what_sits_on_a_joint_is_held_by_it(bar):
    document = layer_commands.duplicate_layer(0)(bar)
    (body, _) = document.layers
    at = body.handle(MIDDLE).position
    attached = layer_commands.attach_layer(0, at, Attachment(parent=1, parent_point=at))(
        document
    ).layers[0]
    assert (body.sprung_handles, attached.sprung_handles) == ({MIDDLE}, frozenset())
    assert Rig.of(attached).pins == ()
    elsewhere = layer_commands.attach_layer(0, at + 20, Attachment(parent=1, parent_point=at))(
        document
    ).layers[0]
    assert elsewhere.sprung_handles == {MIDDLE}


def test_all_handles_may_follow(bar):
    layer = bar.layers[0]
    springs = tuple(replace(SPRING, handle=handle.id) for handle in layer.handles)
    layer = replace(layer, springs=springs)
    assert np.array_equal(dragged(layer).phi, layer.keys[0].pose.phi)


def test_poses_that_are_solved_again_are_not_held_by_it_either(bar):
    layer = bar.layers[0]
    pose = dragged(layer)
    # Where it was wanted when it did not follow yet does not count.
    stale = replace(pose, targets={**pose.targets, MIDDLE: Target(position=120 + 40j)})
    posed = layer.with_poses([stale])
    resolver = KeyResolver(before=posed, bounds=Bounds(k=0.45, sigma_a=1.9, sigma_b=0.55))
    while not resolver.is_over:
        resolver = step_resolver(resolver, np.zeros((1, 1, 4), np.uint8))
    (again,) = resolver.poses
    (flipped,) = flip_poses(Rig.of(posed), [stale], 120.0)
    for solved in (again, flipped):
        place = places(layer, solved)[MIDDLE]
        assert_allclose(solved.targets[MIDDLE].position, place, rtol=0, atol=1e-9)
        assert abs(place - 120 - 40j) > 20


SCRIPT = {
    "schema": 1,
    "loop": True,
    "handles": {name: [x, 40] for name, x in NAMES.items()},
    "keys": [
        {"frame": 0, "targets": {"end": [210, 40]}},
        {"frame": 8, "targets": {"end": [210, 90], "middle": [120, 40]}},
        {"frame": 16, "targets": {"end": [210, 40]}},
    ],
    "springs": [{"handle": "middle", "preset": "tail"}],
}


def test_keys_of_a_script_do_not_hold_what_follows_and_say_so():
    document, notices = pose_document(
        still_document(bar_picture()), parse_pose_script(SCRIPT), lambda _: None
    )
    (layer,) = document.layers
    first, second, last = layer.keys
    for key in layer.keys:
        assert_allclose(
            key.pose.targets[MIDDLE].position, places(layer, key.pose)[MIDDLE], rtol=0, atol=1e-9
        )
    assert abs(second.pose.targets[MIDDLE].position - 120 - 40j) > 10
    (notice,) = notices
    assert notice.startswith("frame 8: 'middle' has a spring, which ignores targets of keys")
    # Where it is carried to on the way back does not keep a loop from closing.
    assert last.pose is first.pose


def test_springs_are_carried_by_drags_and_pose_when_dragged(bar, tmp_path):
    few = replace(bar, frames=FrameRange(0, 4))  # in each of which the spring is worked out
    session = session_of(few, tmp_path, bar_picture())
    project = session.project

    def drag(identity, way):
        place = complex(project.layer_runtime.shown.handle_positions[identity])
        hand = BoundedPull(frozenset({identity}))
        drag_handles(session, {identity: Target(position=place + way)}, hand=hand)
        release_drag(session)
        settle(session)
        return places(project.layer, project.layer.keys[0].pose)

    carried = drag(END, 24j)
    assert abs(carried[MIDDLE] - 120 - 40j) > 5
    pose = project.layer.keys[0].pose
    assert_allclose(pose.targets[MIDDLE].position, carried[MIDDLE], rtol=0, atol=1e-9)
    # At once once more, before the first drag has come to rest.
    drag_handles(session, {END: Target(position=210 + 80j)})
    release_drag(session)
    assert project.drag is not None
    again = drag(END, 8j)
    assert abs(again[MIDDLE] - carried[MIDDLE]) > 1
    bent = drag(MIDDLE, 8j)
    assert abs(bent[MIDDLE] - again[MIDDLE] - 8j) < 2
    # So do the arrow keys.
    project.selection.handles = frozenset({MIDDLE})
    nudge_handles(session, 5j)
    settle(session)
    nudged = places(project.layer, project.layer.keys[0].pose)
    assert abs(nudged[MIDDLE] - bent[MIDDLE] - 5j) < 2

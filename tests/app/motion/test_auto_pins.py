"""Handles that stay between keys that have them at one place, and what moves around them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from still_poses import DRAWN, MOVES, animate, animated, posed, with_layer

from app.document import (
    HOLD,
    Attachment,
    Spring,
    TangentMode,
    Target,
    clip_of,
    pinned_handles,
)
from app.motion import Animation, DeformMesh, InbetweenCache, ParentTransforms
from app.motion.inbetweens import animation, pose_sampler
from app.motion.inbetweens.content_cache import ContentCache
from app.motion.inbetweens.frame_corrector import FrameCorrector
from app.motion.inbetweens.segment_keys import segment_key
from engine.interpolation import BLENDS


def drift(document):
    """Return how far still handles are at most from the way between the places that they reach."""
    animation, worst = animated(document), 0.0
    clip, still = clip_of(document, 0), pinned_handles(clip_of(document, 0))
    keys = clip.keys
    for number, which in enumerate(still):
        one, other = keys[number], keys[(number + 1) % len(keys)]
        ends = [animation.positions(key.frame)[: len(which)] for key in (one, other)]
        for share in (0.2, 0.5, 0.9):
            places = animation.positions(one.frame + share * DRAWN)[: len(which)]
            goal = ends[0] + share**2 * (3 - 2 * share) * (ends[1] - ends[0])
            worst = max(worst, np.abs(places - goal)[which].max(initial=0.0))
    return worst


def velocities(animation, frame):
    """Return the velocity of all points right before a frame and right after it."""
    e, found = 1e-3, []
    for sign in (-1, 1):
        p = [animation.positions(frame + sign * s * e) for s in (1e-3, 1, 2)]
        found.append(sign * (-3 * p[0] + 4 * p[1] - p[2]) / (2 * e))
    return found


@pytest.mark.parametrize(("loop", "variant"), [(False, "metric"), (True, "nu")])
def test_handles_stay_when_two_keys_have_them_at_one_place(loop, variant):
    document = posed(loop=loop, variant=variant)
    assert drift(document) < 0.05
    still = pinned_handles(clip_of(document, 0))
    assert still.shape == (4 if loop else 3, 4)
    assert_array_equal(still[0], [True, True, True, False])


def test_motion_is_the_closed_form_without_auto_pins():
    document = with_layer(posed(), has_auto_pins=False)
    animation = animate(document)
    assert not any(animation.base.inbetweens(number).corrections for number in range(3))
    wandering = [animation.positions(float(t))[:3] for t in range(DRAWN + 1)]
    assert np.abs(np.diff(wandering, axis=0)).max() > 0.02


def test_a_segment_is_solved_once_at_vertices_and_handles(monkeypatch):
    monkeypatch.setattr(pose_sampler, "SAMPLED", ContentCache(2**26))
    document = posed(variant="metric")
    clip = clip_of(document, 0)
    blend, called = BLENDS[clip.layer.variant], []
    for name in ("on_boundary", "tangent"):
        own = getattr(blend, name)

        def counted(*given, own=own, name=name):
            called.append(name)
            return own(*given)

        monkeypatch.setattr(blend, name, counted)
    animation = animate(document)
    assert all(animation.base.inbetweens(number).corrections for number in range(3))
    assert called.count("on_boundary") == 3
    assert called.count("tangent") == 2


@pytest.mark.parametrize("loop", [False, True])
def test_keys_stay_and_are_passed_smoothly_when_corrected(loop):
    document = posed(loop=loop)
    animation = animated(document)
    for number, key in enumerate(document.layers[0].keys):
        places = animation.positions(float(key.frame))
        assert_array_equal(places, animation.sampler.samples(key.pose).positions)
        near = animation.positions(key.frame + 1e-6)
        assert np.abs(near - places).max() < 1e-4
        if not loop and number in (0, len(MOVES) - 1):
            continue
        before, after = velocities(animation, key.frame)
        assert np.abs(before - after).max() < 0.02


def test_corrected_motion_does_not_jolt():
    times = np.arange(0, 30.01, 0.5)
    both = (animated(posed()), animate(with_layer(posed(), has_auto_pins=False)))
    moved = [np.array([animation.positions(t) for t in times]) for animation in both]
    jolts = [np.abs(np.diff(places, 2, axis=0)).max() for places in moved]
    assert jolts[0] <= 2 * jolts[1]


def test_free_handle_gives_way_beside_a_pinned_one():
    document = posed()
    layer = document.layers[0]
    top = layer.handles[-1]
    # A counterpart of the top, pinned in every segment at the place to which the poses bring it.
    counterpart = replace(top, id=top.id + 1, name="counterpart", position=top.position + 0.02)
    keys = tuple(
        replace(
            key,
            pose=replace(
                key.pose,
                targets={**key.pose.targets, counterpart.id: Target(position=counterpart.position)},
            ),
        )
        for key in layer.keys
    )
    doubled = with_layer(
        document, handles=(*layer.handles, counterpart), keys=keys, next_handle=counterpart.id + 1
    )
    assert pinned_handles(clip_of(doubled, 0))[:, -2:].tolist() == [[False, True]] * 3
    animation = animate(doubled)
    places = np.array([animation.positions(t) for t in np.arange(0, 30.01, 0.5)])
    assert np.abs(places[:, 3] - places[:, 4]).max() < 0.1
    assert drift(doubled) < 0.05
    assert np.abs(np.diff(places, 2, axis=0)).max() < 1.0


def test_corrected_frames_are_the_same_in_any_order():
    frames = [3.0, 27.0, 14.0, 8.25]
    one, other = animated(posed()), animate(posed())
    found = {frame: one.positions(frame) for frame in frames}
    for frame in reversed(frames):
        assert_array_equal(other.positions(frame), found[frame])


def test_limits_are_kept_between_samples():
    document = posed()
    layer = document.layers[0]
    boundary = animated(document).sampler.sites.boundary
    ends = boundary.points[boundary.next_samples]
    dense = np.concatenate([boundary.points * (1 - s) + ends * s for s in np.linspace(0, 0.9, 10)])
    animation = animate(document, dense)
    for frame in (2, 5, 8, 14, 18, 22, 27):
        moved = animation.frame(float(frame))
        a, b = np.abs(moved.fz), np.abs(moved.fzbar)
        assert (b / a).max() <= layer.bounds.k
        assert (a + b).max() <= layer.bounds.sigma_a
        assert (a - b).min() >= layer.bounds.sigma_b


def test_a_handle_that_is_free_or_follows_is_not_still():
    document = posed()
    layer = document.layers[0]
    left, middle = layer.handles[:2]
    free = replace(left, is_unpinned=True)
    changed = with_layer(
        document,
        handles=(free, *layer.handles[1:]),
        springs=(Spring(handle=middle.id, frequency=2, damping=0.3),),
    )
    assert_array_equal(pinned_handles(clip_of(changed, 0))[0], [False, False, True, False])
    alone = with_layer(
        document,
        handles=(left, *(replace(each, is_unpinned=True) for each in layer.handles[1:])),
    )
    assert drift(alone) < 1e-3


def test_a_handle_that_is_locked_goes_evenly_between_the_places_that_it_reaches():
    document = posed()
    layer = document.layers[0]
    *others, top = layer.handles
    locked = with_layer(document, handles=(*others, replace(top, locked=True)))
    assert pinned_handles(clip_of(locked, 0)).all(axis=0).tolist() == [True, True, False, True]
    assert drift(locked) < 0.05


@pytest.mark.parametrize("change", [{"easing": HOLD}, {"revolutions": 1}])
def test_a_hold_and_a_whole_turn_are_left_as_they_are(change):
    document = posed()
    first, *rest = document.layers[0].keys
    changed = with_layer(document, keys=(replace(first, **change), *rest))
    assert not pinned_handles(clip_of(changed, 0))[0].any()
    animation = animate(changed)
    assert np.isfinite(animation.positions(5.0)).all()


@pytest.mark.parametrize("passing", [TangentMode.STOP, TangentMode.CORNER])
def test_keys_that_are_not_passed_through_keep_their_handles_too(passing):
    document = posed()
    keys = tuple(replace(key, tangent_mode=passing) for key in document.layers[0].keys)
    assert drift(with_layer(document, keys=keys)) < 0.05


def test_attached_layer_is_corrected_about_its_joint_alone():
    document = posed()
    layer = document.layers[0]
    child = replace(
        layer,
        id=1,
        name="child",
        anchor=30 + 40j,
        attachments=(Attachment(parent=0, parent_point=90 + 45j),),
    )
    scene = replace(document, layers=(layer, child))
    unpinned = replace(document, layers=(layer, replace(child, has_auto_pins=False)))
    joints = ParentTransforms(scene)
    handles = np.array([handle.position for handle in child.handles])
    points = np.append(handles, child.anchor)
    animation = Animation(clip_of(scene, 1), points=points)
    below = Animation(clip_of(scene, 0), points=np.array([90 + 45j]))
    for frame in (0.0, 4.0, 13.5, 26.0):
        own = animation.positions(frame)
        loose = Animation(clip_of(unpinned, 1), points=points)
        assert own[-1] == pytest.approx(loose.positions(frame)[-1], abs=1e-7)
        attached = joints.placement(1, frame).apply(own)[-1]
        assert attached == pytest.approx(below.positions(frame)[0], abs=1e-6)
    # In its parent's frame its handles stay.
    ends = [animation.positions(frame)[:3] for frame in (0.0, 10.0)]
    assert_allclose(ends[0], ends[1], atol=0.6)
    for frame in (2.0, 5.0, 8.0):
        assert np.abs(animation.positions(frame)[:3] - ends[0]).max() < 0.6


def test_single_frame_has_the_pins_of_its_segment():
    document = posed(variant="metric")
    clip = clip_of(document, 0)
    store = InbetweenCache(mesh=DeformMesh.coarse(clip.layer.domain))
    store.add(store.segments_job(clip, [1])())
    frame = clip.keys[0].frame + 4
    update = store.frame_job(clip, frame)()
    (single,) = [each.single_frame for each in update.segments.values()]
    assert store.sampler.known.find_pins(segment_key(clip, 0)) is None, "no series was solved"
    store.add(store.segments_job(clip, [0])())
    whole = store.segment(clip, 0).inbetweens
    assert np.abs(whole.frame(single.weight).positions - single.positions).max() < 0.02
    assert whole.corrections


def test_motion_at_other_points_shares_the_corrections_of_a_layer(monkeypatch):
    free = posed().layers[0].handles[-1]
    spring = Spring(handle=free.id, frequency=2, damping=0.3)
    document = with_layer(posed(), springs=(spring,))
    made = []

    class Counted(FrameCorrector):
        def __init__(self, *given):
            made.append(given)
            super().__init__(*given)

    monkeypatch.setattr(animation, "FrameCorrector", Counted)
    layer = document.layers[0]
    joints, points = ParentTransforms(document), np.array([h.position for h in layer.handles])
    together = joints.animation(layer.id, points).frame(5.5)
    alone = [joints.animation(layer.id, points[i : i + 1]).frame(5.5) for i in range(len(points))]
    assert len(made) == 1
    assert_allclose([each.positions[0] for each in alone], together.positions, atol=1e-9)
    assert_allclose([each.fz[0] for each in alone], together.fz, atol=1e-6)

"""Tracks and springs: handles that go their own ways over the motion of their layer."""

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
from animations import still_document, within
from numpy.testing import assert_allclose, assert_array_equal
from shapes import regular_polygon
from still_poses import CORNERS, PLACES, animate, animated, posed, with_layer

from app.document import (
    RUBBERY,
    Attachment,
    Cycle,
    DistortionRange,
    FrameRange,
    Spring,
    Track,
    TrackKey,
    clip_of,
    handle_commands,
    segment_time_at,
    spring_root,
    track_at,
)
from app.motion import (
    Animation,
    DeformMesh,
    Evaluator,
    InbetweenCache,
    LayerStages,
    ParentTransforms,
    bounding_box,
    evaluate_layer,
    find_parent_motion,
    measure_extent,
    reuse_corrections,
    trace_paths,
)
from app.motion.caches.corrected_frames import CorrectedFrames
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.spring_offsets import MAX_SPRING_OFFSET, PIECE, SpringOffsets
from app.reports import Verdict, certify_clip, corrected_frames
from app.reports.acting_frames import acting_frames
from app.rigging import simulate_spring, turn_arm
from engine.geometry import IDENTITY_MOTION, diameter
from engine.maps import Boundary

IDS = {name: number for number, name in enumerate(PLACES)}
SHORT = 4  # frames between two keys, and
FEW = 3  # keys: where all frames are solved
WAVE = ((5, 0), (10, 8 + 4j), (15, -6j), (20, 4j), (25, 0))


def track(name="right", keys=WAVE, **settings):
    own = tuple(TrackKey(frame=frame, place=complex(place)) for frame, place in keys)
    return Track(handles=(IDS[name],), keys=own, **settings)


def tracked(*tracks, loop=False, **changes):
    return with_layer(posed(loop=loop), tracks=tracks, **changes)


def pulled(target, variant="nu", **changes):
    """A short document whose right handle is wanted elsewhere in its frame 3."""
    away = track(keys=((1, 0), (3, target), (5, 0)))
    return with_layer(posed(FEW, drawn=SHORT, variant=variant), tracks=(away,), **changes)


def reversed_in_time(keys):
    frames, poses = [key.frame for key in keys], [key.pose for key in reversed(keys)]
    return [replace(key, frame=f, pose=p) for key, f, p in zip(keys, frames, poses, strict=True)]


def test_tracked_handles_go_beside_the_pose_by_their_keys():
    wave = track()
    document = tracked(wave)
    animation, clip = animated(document), clip_of(document, 0)
    for frame in (5.0, 7.3, 12.5, 19.0):
        still, moved = animation.base.frame(frame), animation.frame(frame)
        offset = track_at(wave, clip, frame).place
        turn = still.fz[IDS["right"]] / abs(still.fz[IDS["right"]])
        assert abs(moved.positions[2] - still.positions[2] - offset * turn) < 0.1
        # Those that stay do so beside it.
        assert np.abs(moved.positions[:2] - still.positions[:2]).max() < 0.1


def test_track_changes_nothing_outside_its_keys():
    one, other = animated(tracked(track())), animated(posed())
    for frame in (0.0, 4.999, 25.001, 29.0):
        assert_array_equal(one.positions(frame), other.positions(frame))
    # And where it wants what is there.
    assert_array_equal(one.positions(5.0), other.positions(5.0))
    near = one.positions(5.001) - other.positions(5.001)
    assert np.abs(near).max() < 0.01
    off = animate(tracked(replace(track(), enabled=False)))
    assert_array_equal(off.positions(12.0), other.positions(12.0))


def test_a_planted_handle_stays_in_the_picture():
    place = PLACES["right"] + 3 - 2j
    planted = track(keys=((4, place), (26, place)), is_scene_space=True)
    animation = animate(tracked(planted, has_auto_pins=False))
    for frame in (4.0, 11.0, 18.5, 26.0):
        assert abs(animation.positions(frame)[2] - place) < 0.1


def planted_child():
    """A layer that is attached to a moving one, with a handle that stays in the scene; "
    "and where."""
    document = posed(FEW, drawn=SHORT)
    place = PLACES["top"] + 2j
    child = replace(
        document.layers[0],
        id=1,
        name="child",
        anchor=60 + 45j,
        attachments=(Attachment(parent=0, parent_point=60 + 45j),),
        bounds=RUBBERY.bounds,
        tracks=(track("top", ((0, place), (8, place)), is_scene_space=True),),
    )
    parent = with_layer(document, has_auto_pins=False).layers[0]
    return replace(document, layers=(parent, child)), place


def test_planted_handle_stays_in_the_scene_when_attached():
    scene, place = planted_child()
    child = scene.layers[1]
    joints = ParentTransforms(scene)
    handles = np.array([handle.position for handle in child.handles])
    attached = Animation(clip_of(scene, 1), points=np.append(handles, child.anchor))
    attached.carried = lambda frame: joints.parent_transform(1, frame)
    below = Animation(clip_of(scene, 0), points=np.array([60 + 45j]))
    for frame in (0.0, 2.4, 5.8):
        placed = joints.placement(1, frame).apply(attached.positions(frame))
        assert abs(placed[IDS["top"]] - place) < 0.1
        assert placed[-1] == pytest.approx(below.positions(frame)[0], abs=1e-6)


def test_a_group_moves_together_and_a_handle_turns_where_that_is_asked():
    both = replace(track(), handles=(IDS["right"], IDS["top"]))
    animation = animate(tracked(both, has_auto_pins=False))
    moved = animation.positions(15.0) - animation.base.frame(15.0).positions
    assert abs(moved[IDS["top"]] - moved[IDS["right"]]) < 0.05
    keys = tuple(replace(key, place=0j, turn=0.3) for key in track().keys)
    turning = replace(track(keys=WAVE), keys=keys, keys_rotation=True)
    animation = animate(tracked(turning))
    turned = animation.frame(12.0).fz[2] / animation.base.frame(12.0).fz[2]
    assert np.angle(turned) == pytest.approx(0.3, abs=0.02)


def test_a_still_handle_beside_one_that_goes_gives_way():
    document = posed()
    beside = handle_commands.add_handle(0, PLACES["right"] - 1.5, name="beside")(document)
    animation = animate(with_layer(beside, tracks=(track(),)))
    still = animation.base.frame(10.0)
    turn = still.fz[IDS["right"]] / abs(still.fz[IDS["right"]])
    moved = animation.positions(10.0) - still.positions
    assert abs(moved[IDS["right"]] - (8 + 4j) * turn) < 0.3
    assert abs(moved[len(PLACES)] - (8 + 4j) * turn) < 1.0


def test_second_track_begins_without_a_jump():
    first, second = track(), track("top", ((14, 0), (18, 5), (22, 0)))
    one, both = animated(tracked(first)), animate(tracked(first, second))
    assert np.abs(both.positions(13.999) - both.positions(14.001)).max() < 0.02
    assert_allclose(both.positions(16.0)[2], one.positions(16.0)[2], atol=0.1)


def test_tracks_come_round_in_a_loop_with_their_delay():
    late = track(keys=((0, 0), (20, 8j), (40, 0)), delay=15)
    document = tracked(late, loop=True)
    animation = animate(document)
    first, last = animation.positions(0.0), animation.positions(40.0)
    assert_array_equal(first, last)
    assert np.abs(animation.positions(39.999) - animation.positions(0.001)).max() < 0.02


@pytest.mark.parametrize(("variant", "target"), [("nu", 300 + 200j), ("scaled-eta", 8j)])
def test_corrected_frames_are_proven_in_closed_variants(variant, target):
    document = pulled(target)
    report = certify_clip(clip_of(document, 0), variant)
    corrected = report.corrected
    assert corrected.frames == corrected.proven == 3
    assert report.corrected_verdict is Verdict.PROVEN
    clip = clip_of(document, 0)
    outline = clip.layer.domain.outline
    between = outline + np.linspace(0, 1, 40)[:, None] * (np.roll(outline, -1) - outline)
    animation = Animation(clip, variant, points=between.ravel())
    shown = animation.frame(3)
    found = DistortionRange.measured(shown.fz, shown.fzbar)
    assert found.beyond(corrected.reached) == DistortionRange(0, 0, 0)


def test_repeats_of_a_track_are_proven_once_however_many():
    cycles = (Cycle(first=0, last=10),)
    document = pulled(8j, keys=posed(1).layers[0].keys, cycles=cycles)
    clip = clip_of(replace(document, frames=FrameRange(0, 999_999)), 0)
    frames, counts = acting_frames(clip)
    assert_array_equal(frames, range(1, 6))
    assert_array_equal(counts, 100_000)
    report = certify_clip(clip)
    assert report.verdict is Verdict.PROVEN
    assert report.corrected.frames == report.corrected.proven == 300_000


@pytest.mark.parametrize("loop", [False, True])
def test_acting_frames_are_those_of_the_tracks(loop):
    late = track(keys=((2, 0), (6, 8j), (9, 0)), delay=7)
    cycle = Cycle(first=0, last=11, until=20)
    for cycles in ((), (cycle,)):
        document = tracked(late, track("top", ((22, 0), (24, 3))), loop=loop, cycles=cycles)
        clip = clip_of(document, 0)
        shown = {
            frame: (
                segment_time_at(clip, frame),
                *(track_at(each, clip, frame) for each in clip.layer.tracks),
            )
            for frame in range(clip.frames.first, clip.frames.last + 1)
        }
        acting = {frame: places for frame, places in shown.items() if any(places[1:])}
        frames, counts = acting_frames(clip)
        assert {acting[frame] for frame in frames.tolist()} == set(acting.values())
        assert counts.sum() == len(acting)


def test_certify_looks_at_few_of_very_many_frames(monkeypatch):
    monkeypatch.setattr(corrected_frames, "MOST_LOOKED_AT", 4)
    monkeypatch.setattr(corrected_frames, "SPREAD", 3)
    corrected = (report := certify_clip(clip_of(pulled(8j), 0))).corrected
    assert (corrected.looked_at, corrected.left_out) == (3, 2)
    assert corrected.proven == corrected.frames
    assert report.corrected_verdict is report.verdict is Verdict.MEASURED


def test_track_out_of_reach_keeps_limits_and_reports_its_error():
    document = pulled(300 + 200j, "metric", has_auto_pins=False)
    report = certify_clip(clip_of(document, 0))
    assert report.verdict is Verdict.PROVEN
    assert report.corrected.excess.k == report.corrected.excess.sigma_a == 0
    (short,) = report.corrected.short
    assert short.handle == "right"
    assert 1 < short.first < 3 < short.last < 5
    assert short.lag > 50


def test_a_smaller_reach_moves_less_of_the_drawing():
    moved = []
    for reach in (1.0, 0.2):
        animation = animate(tracked(track(reach=reach), has_auto_pins=False))
        moved.append(np.abs(animation.positions(10.0) - animation.base.frame(10.0).positions))
    assert moved[1].mean() < moved[0].mean()
    assert abs(moved[1][2] - moved[0][2]) < 0.1


def springy(*, loop=False, **settings):
    spring = Spring(handle=IDS["top"], **({"frequency": 7.5, "damping": 0.2} | settings))
    return with_layer(posed(loop=loop, drawn=SHORT), springs=(spring,))


def test_spring_swings_about_its_place_and_closes_a_loop():
    document = springy(loop=True)
    animation = animate(document)
    swung = [
        animation.positions(t)[IDS["top"]] - animation.base.frame(t).positions[IDS["top"]]
        for t in range(0, 16, 4)
    ]
    assert np.abs(swung).max() > 0.5
    assert_allclose(animation.positions(0.0), animation.positions(16.0), rtol=0, atol=1e-10)
    before, after = animation.positions(16 - 1e-4), animation.positions(1e-4)
    assert np.abs(before - after).max() < 0.01


def test_spring_moves_nothing_without_strength_or_under_a_track():
    still = animate(springy(strength=0.0))
    assert_array_equal(still.positions(5.2), still.base.frame(5.2).positions)
    wave = (track("top", ((0, 0), (4, 6j), (12, 0))),)
    sprung = springy()
    alone, both = (
        animate(with_layer(sprung, tracks=wave, springs=each))
        for each in ((), sprung.layers[0].springs)
    )
    # What follows is not still, so that the motion under the track is another one.
    offset = {
        each: each.positions(4.8)[3] - each.base.frame(4.8).positions[3] for each in (alone, both)
    }
    sizes = [abs(each) for each in offset.values()]
    assert sizes[0] == pytest.approx(sizes[1], abs=0.1)


def arms(frames, **settings):
    """Return arms from the root to the handle that swings: in the base motion, and shown."""
    document = springy(**settings)
    animation, root = (
        animate(document),
        spring_root(document.layers[0], document.layers[0].springs[0]),
    )
    both = [(animation.base.frame(frame).positions, animation.positions(frame)) for frame in frames]
    tip, foot = np.array([[each[[IDS["top"], root]] for each in pair] for pair in both]).T
    return tip - foot  # (2, frames)


@pytest.mark.parametrize("loop", [False, True])
def test_spring_keeps_its_distance_to_its_root(loop):
    base, shown = arms((2, 4.3, 9), loop=loop, frequency=3.0)
    assert_allclose(np.abs(shown), np.abs(base), rtol=0, atol=0.05)
    assert np.abs(np.angle(shown / base)).max() > 0.1


def test_spring_grows_longer_by_its_stretch():
    longer = [
        np.abs(np.subtract(*np.abs(arms((2, 4.3), frequency=3.0, stretch=stretch)))).max()
        for stretch in (0.5, 1.0)
    ]
    assert longer[1] > longer[0] > 0.3


def test_spring_swings_about_the_handle_that_it_has_as_root():
    for name in ("left", "right"):
        base, shown = arms((4, 7), root=IDS[name], frequency=3.0)
        assert_allclose(np.abs(shown), np.abs(base), rtol=0, atol=0.05)
        assert np.abs(np.angle(shown / base)).max() > 0.02


def test_slow_spring_shows_a_frame_alike_however_it_is_reached():
    document = springy(frequency=1.0, damping=0.2)
    document = replace(document, frames=FrameRange(0, 200))
    points = np.array(list(PLACES.values()))
    through = animate(document, points)
    shown = [through.positions(frame) for frame in range(0, 120, 3)]
    for number in (3, 11, 34):
        alone = animate(document, points).positions(3 * number)
        assert_allclose(alone, shown[number], rtol=0, atol=1e-6)


@pytest.mark.parametrize("turn", [0.0, 0.15])
def test_what_swings_goes_along_where_a_track_moves_its_root(turn):
    """The arm keeps its length, and turns where the track turns the shape at its root."""
    keys = tuple(
        TrackKey(frame=frame, place=place, turn=share * turn)
        for frame, place, share in ((0, 0j, 0), (6, 5 - 4j, 1), (12, 0j, 0))
    )
    moves = Track(handles=(IDS["middle"],), keys=keys, keys_rotation=True)
    document = springy(root=IDS["middle"])
    frames, seen = (3, 6, 8), []
    for tracks in ((), (moves,)):
        animation = animate(with_layer(document, tracks=tracks, bounds=RUBBERY.bounds))
        places = np.array([animation.positions(frame) for frame in frames])
        seen.append(places[:, IDS["top"]] - places[:, IDS["middle"]])
    turns = [track_at(moves, clip_of(document, 0), frame).turn for frame in frames]
    assert_allclose(seen[1], seen[0] * np.exp(1j * np.array(turns)), rtol=0, atol=0.2)


@pytest.mark.parametrize("stretch", [0.0, 1.0])
@pytest.mark.parametrize("loop", [False, True])
def test_pieces_of_a_swing_are_those_of_the_whole(loop, stretch):
    document = springy(loop=loop, damping=0.2, lag=2.5, stretch=stretch)
    clip = clip_of(replace(document, frames=FrameRange(0, 300)), 0)
    (spring,) = clip.layer.springs
    places = np.cumsum(np.random.default_rng(0).normal(0, 20, (301, 4, 2)) @ [1, 1j], axis=0)
    places[40:100] = places[40]  # where the swing fades
    places[-1] = places[0]
    swings = SpringOffsets(clip, lambda _: IDENTITY_MOTION)
    assert PIECE < swings.run_up < 300 - 2 * PIECE
    settings = {"frequency": spring.frequency, "damping": spring.damping, "lag": spring.lag}
    limit = MAX_SPRING_OFFSET * diameter(clip.layer.domain.outline)
    root = places[:, spring_root(clip.layer, spring)]
    roots = None if stretch else root
    whole = simulate_spring(
        places[:, IDS["top"]], clip.fps, limit=limit, loop=loop, roots=roots, **settings
    )
    for frame in (299.5, 150, 63.9, 64, 0.5, 98, 299, *range(0, 301, 7)):
        here = places[int(frame)]
        found = swings.offset(spring, frame, here, lambda at: places[at])
        arm, at = here[IDS["top"]] - root[int(frame)], complex(whole.at(frame))
        assert abs(found - (at if stretch else turn_arm(arm, at.real))) < 1e-9


@pytest.mark.parametrize("damping", [0.0, 0.2])
def test_spring_is_worked_out_around_the_frame_it_is_asked_for(damping):
    document = springy(damping=damping)
    clip = clip_of(replace(document, frames=FrameRange(0, 999_999), loop=damping > 0), 0)
    (spring,) = clip.layer.springs
    asked = []

    def at(frame):
        asked.append(frame)
        return np.full(4, np.exp(1j * frame))

    swings = SpringOffsets(clip, lambda _: IDENTITY_MOTION)
    for frame in (3, *[500_000] * (damping > 0)):
        swings.offset(spring, frame, at(frame), at)
    assert len(asked) < 1_000


def test_spring_acts_until_it_has_settled():
    document = replace(springy(damping=1.0), frames=FrameRange(0, 999_999))
    clip = clip_of(document, 0)
    frames, _ = acting_frames(clip)
    assert frames[0] == 0
    assert 3 * SHORT < frames[-1] < 50
    swings = SpringOffsets(clip, None)
    (spring,) = clip.layer.springs
    animation = animate(document)

    def base(frame):
        return animation.base.frame(frame).positions

    offsets = [swings.offset(spring, frame, base(frame), base) for frame in range(3 * SHORT, 60)]
    assert offsets[0]
    assert not any(offsets[frames[-1] - 3 * SHORT :])
    assert len(acting_frames(clip, is_carried=True)[0]) == 1_000_000


def test_attached_spring_swings_with_its_parent():
    document = posed(FEW, drawn=SHORT)
    spring = Spring(handle=IDS["top"], frequency=5.0, damping=0.2)
    child = replace(
        document.layers[0],
        id=1,
        name="child",
        keys=document.layers[0].keys[:1],
        anchor=30 + 40j,
        attachments=(Attachment(parent=0, parent_point=90 + 45j),),
        springs=(spring,),
    )
    scene = replace(document, layers=(document.layers[0], child))
    points = np.array([handle.position for handle in child.handles])
    alone = Animation(clip_of(scene, 1), points=points)
    assert_array_equal(alone.positions(5.0), alone.base.frame(5.0).positions)
    joints = ParentTransforms(scene)
    joints.tracked[1].at(5.0)
    attached = Animation(
        clip_of(scene, 1), points=points, carried=lambda frame: joints.parent_transform(1, frame)
    )
    swung = attached.positions(5.0) - attached.base.frame(5.0).positions
    assert abs(swung[IDS["top"]]) > 0.1
    # What was found for another motion of its parent does not stay.
    moved = with_layer(scene, keys=tuple(reversed_in_time(scene.layers[0].keys)))
    window = reuse_corrections(scene, 1, None)
    assert reuse_corrections(scene, 1, window) is window
    assert reuse_corrections(moved, 1, window) is not window
    later = ParentTransforms(moved, earlier=joints)
    assert_allclose(
        later.tracked[1].at(5.0).positions,
        ParentTransforms(moved).tracked[1].at(5.0).positions,
        atol=1e-9,
    )
    # Paths and reports are of what is shown.
    paths = trace_paths(clip_of(scene, 1), carried=find_parent_motion(scene, 1))
    assert_allclose(paths.positions[5], attached.positions(5.0), atol=1e-9)
    assert certify_clip(clip_of(scene, 1)).corrected.frames == 0
    assert certify_clip(clip_of(scene, 1), None, find_parent_motion(scene, 1)).corrected.frames > 4


def test_the_frames_of_a_window_are_those_of_an_export():
    document = tracked(track())
    clip = clip_of(document, 0)
    animation, frames = animate(document), CorrectedFrames(clip)
    siblings = {0: animation.sampler}
    assert not frames.is_exact(clip, 12)
    frames.take(frames.missing(document, 12, siblings)())
    assert frames.is_exact(clip, 12)
    assert not frames.is_whole
    while (work := frames.missing(document, 12, siblings)) is not None:
        frames.rest()
        assert frames.is_begun
        frames.take(work())
    assert frames.is_whole
    # What is found is kept without what it was found with, which goes at once.
    begun = weakref.ref(frames._corrections)
    gc.disable()
    try:
        frames.rest()
        assert begun() is None
    finally:
        gc.enable()
    assert not frames.is_begun
    exact = animation.corrections.correction_at(12.0)
    assert_array_equal(frames.at(clip, 12).series.h, exact.series.h)
    # Until the frames of a changed clip are there, those of before stand in.
    changed = with_layer(document, tracks=(track(keys=((5, 0), (12, 4j), (20, 0))),))
    later = CorrectedFrames(clip_of(changed, 0), frames)
    assert later.at(clip_of(changed, 0), 12) is frames.at(clip, 12)
    assert not later.is_exact(clip_of(changed, 0), 12)
    assert later.at(clip, 12) is None


def test_no_places_are_asked_for_without_handles():
    document = within(still_document(), 60 + 47j + 40 * regular_polygon(CORNERS))
    frames = CorrectedFrames(clip_of(document, 0))
    assert frames.missing_ground(document, 0, {}) is None
    with_handle = handle_commands.add_handle(0, PLACES["left"])(document)
    assert CorrectedFrames(clip_of(with_handle, 0)).missing_ground(with_handle, 0, {}) is not None


def test_extent_and_exports_are_of_the_shown_frames():
    document = pulled(14 - 6j)
    clip, layer = clip_of(document, 0), document.layers[0]
    store = InbetweenCache(mesh=DeformMesh.coarse(layer.domain))
    store.add(store.segments_job(clip, store.missing_segments(clip, 0))())
    frames = reuse_corrections(document, 0, None)
    while (work := frames.missing(document, 0, {0: store.sampler})) is not None:
        frames.take(work())
    animation = Animation(clip)
    places = [animation.positions(float(frame)) for frame in range(9)]
    exact = Evaluator.exact(document).evaluate(document, 3.0).layers[0]
    assert_allclose(exact.scene_positions, places[3], rtol=0, atol=1e-9)
    stages = LayerStages(layer_id=0, store=store, corrected=frames)
    found = measure_extent(document, Evaluator(layers={0: stages}))
    # On the screen positions have single precision.
    assert_allclose(found, bounding_box(np.concatenate(places)), rtol=0, atol=1e-2)
    stages = LayerStages(layer_id=0, store=store)
    bare = measure_extent(document, Evaluator(layers={0: stages}))
    assert found.upper.real - bare.upper.real > 5
    shown = store.vertices(clip, 3, correction=frames.at(clip, 3)).positions
    assert_allclose(shown, places[3], rtol=0, atol=1e-2)


def test_an_evaluator_evaluates_each_document_with_its_own_tracks():
    evaluator = None
    for offset in (14 - 6j, -9 + 4j, 14 - 6j):
        document = pulled(offset)
        evaluator = evaluator or Evaluator.exact(document)
        found = evaluator.evaluate(document, 3.0).layers[0].scene_positions
        own = Animation(clip_of(document, 0)).positions(3.0)
        assert_allclose(found, own, rtol=0, atol=1e-9)


def test_corrections_are_solved_anew_for_another_anchor_and_another_method():
    """At a key, where nothing but the pose says what the in-betweens are."""
    away = track("right", ((0, 14 - 6j), (2 * SHORT, 14 - 6j)), is_scene_space=False)
    free = tracked(away, keys=posed(FEW, drawn=SHORT).layers[0].keys)
    points = np.append([handle.position for handle in free.layers[0].handles], 60 + 45j)
    sampler = animate(free, points).sampler
    joint = Attachment(parent=1, parent_point=60 + 45j)
    changes = (
        {},
        {"anchor": 60 + 45j},
        {"anchor": 60 + 45j, "attachments": (joint,)},
        {"variant": "eta"},
        {"variant": "metric"},
    )
    for change in changes:
        parent = replace(free.layers[0], id=1, name="parent", tracks=())
        layer = replace(free.layers[0], **change)
        clip = clip_of(replace(free, layers=(layer, parent)), 0)
        sharing = PoseSampler(layer, points=points, sibling=sampler)
        shared = Animation(clip, sampler=sharing, points=sharing.sites.points)
        for frame in (0.0, float(SHORT)):
            fresh = Animation(clip, points=points)
            assert_allclose(shared.positions(frame), fresh.positions(frame), rtol=0, atol=1e-9)
            if layer.attachments:
                kept = shared.base.frame(frame).positions[-1]
                assert shared.positions(frame)[-1] == pytest.approx(kept, abs=1e-6)


def test_frames_of_an_earlier_anchor_are_corrected_along_their_own_paths():
    first = pulled(14 - 6j, has_auto_pins=False)
    clip, layer = clip_of(first, 0), first.layers[0]
    moved = clip_of(with_layer(first, anchor=30 + 45j), 0)
    store = InbetweenCache(mesh=DeformMesh.coarse(layer.domain))
    for each in (clip, moved):
        store.set_needed_clips([each], [clip], 0)
        store.add(store.segments_job(each, store.missing_segments(each, 0))())
    assert store.sampler.is_for(moved.layer)
    animation = Animation(clip)
    correction = animation.corrections.correction_at(3.0)
    shown = store.vertices(clip, 3, correction=correction).positions
    assert_allclose(shown, animation.positions(3.0), rtol=0, atol=1e-2)


def test_corrections_of_a_window_are_for_the_present_anchor():
    first = pulled(14 - 6j)
    sampler = animate(first).sampler
    moved = with_layer(first, anchor=30 + 45j)
    clip, frames = clip_of(moved, 0), CorrectedFrames(clip_of(moved, 0))
    frames.take(frames.missing_here(moved, 3, {0: sampler})())
    exact = Animation(clip).corrections.correction_at(3.0)
    assert_allclose(frames.at(clip, 3).series.shifts, exact.series.shifts, rtol=0, atol=1e-9)


def test_nothing_of_an_earlier_outline_serves_another_one():
    first = pulled(14 - 6j)
    clip, layer = clip_of(first, 0), first.layers[0]
    sampler = animate(first).sampler
    moved = within(still_document(), layer.domain.outline + 1j).layers[0]
    domain = moved.domain
    other = PoseSampler(moved, points=domain.outline, sibling=sampler)
    assert not sampler.is_for(moved)
    assert other.known is not sampler.known
    assert other.sites.boundary.span.equals(Boundary.sample(domain).span)
    # Its corrections are of other functions, too.
    frames = CorrectedFrames(clip)
    frames.take(frames.missing_here(first, 3, {0: sampler})())
    assert frames.at(clip, 3) is not None
    rebuilt = clip_of(with_layer(first, domain=domain), 0)
    assert CorrectedFrames(rebuilt, frames).at(rebuilt, 3) is None
    pose, mesh = rebuilt.keys[0].pose, DeformMesh.coarse(domain)
    shown = evaluate_layer(rebuilt, 3, pose, [InbetweenCache(mesh=mesh)], None, frames)
    assert shown.correction is None


def test_planted_track_is_solved_anew_when_the_parent_changes():
    scene, place = planted_child()
    parent, child = scene.layers
    points = np.array([handle.position for handle in child.handles])
    before = trace_paths(clip_of(scene, 1), carried=find_parent_motion(scene, 1))
    joints = ParentTransforms(scene)
    assert joints.tracked[1].at(6.0) is joints.tracked[1].at(6.0)
    # The child is the same, but its parent is not.
    moved = replace(parent, keys=(parent.keys[0], replace(parent.keys[1], frame=5)))
    changed = replace(scene, layers=(moved, child))
    later = ParentTransforms(changed, earlier=joints)
    paths = trace_paths(clip_of(changed, 1), before, carried=find_parent_motion(changed, 1))
    fresh = Animation(clip_of(changed, 1), points=points, carried=find_parent_motion(changed, 1))
    for frame in (2, 6):
        expected = fresh.positions(float(frame))
        assert_allclose(paths.positions[frame], expected, rtol=0, atol=1e-6)
        assert abs(later.placement(1, frame).apply(expected)[IDS["top"]] - place) < 0.1
    assert np.abs(paths.positions[6] - before.positions[6]).max() > 0.5


def test_what_one_outline_knows_is_changed_by_one_thread_at_a_time(monkeypatch):
    monkeypatch.setattr("app.motion.inbetweens.frame_corrector.KEPT", 1)
    animation = animate(tracked(track(), has_auto_pins=False))
    outline = animation.sampler.known

    class Guarded(dict):
        def __iter__(self):
            assert outline.guard.locked()
            return super().__iter__()

        def __setitem__(self, key, value):
            assert outline.guard.locked()
            super().__setitem__(key, value)

        def __delitem__(self, key):
            assert outline.guard.locked()
            super().__delitem__(key)

    outline.corrections = Guarded()
    for frame in (8.0, 9.0):
        assert animation.corrections.correction_at(frame).steps > 0
    assert len(outline.corrections) == 1

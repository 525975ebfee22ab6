"""Pose sliders in the motion of layers: exact poses, pins, limits, tracks on top, certificates."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from slid_poses import NOD, slid, slider
from still_poses import animate, dragged, drawing, posed, with_layer

from app.document import (
    Keyframe,
    Track,
    TrackKey,
    Variant,
    clip_of,
    rest_pose,
    segment_keys,
)
from app.motion import Animation, DeformMesh, InbetweenCache, evaluate_layer, trace_paths
from app.motion.caches.corrected_frames import CorrectedFrames
from app.motion.inbetweens.frame_corrector import have_same_base_frames
from app.reports import Verdict, certify_clip
from app.solving import Rig, fit_shown_pose
from engine.maps import Bounds

PINNED = {"left", "middle", "right"}
TOP = 3


def positions(document, frame):
    return animate(document).frame(frame).positions


def image(document, number):
    layer = document.layers[0]
    points = np.append([each.position for each in layer.handles], layer.domain.outline)
    return layer.map_of(dragged(number))(points) if number else points


@pytest.mark.parametrize("variant", [Variant.METRIC, Variant.NU])
def test_slider_shows_its_poses_exactly(variant):
    document = slid(-1, 0, 1, variant=variant)
    for frame, number in ((0, 2), (10, 0), (20, 1)):
        expected = image(document, number)
        assert_allclose(positions(document, frame), expected, rtol=0, atol=1e-9)


def test_slider_holds_handles_that_its_poses_do_not_move():
    document = slid(-1, 1, 1.3)
    handles = document.layers[0].handles
    held = [number for number, handle in enumerate(handles) if handle.name in PINNED]
    rest = np.array([handle.position for handle in handles])
    for frame in (0, 3, 7, 14, 20):
        found = positions(document, frame)[: len(rest)]
        # The poses themselves miss their targets by up to 0.054 px.
        assert_allclose(found[held], rest[held], rtol=0, atol=0.1)
    assert abs(found[TOP] - rest[TOP]) > 5


def test_slider_lets_free_handles_follow_the_shape():
    document = slid(-1, 1)
    free = tuple(replace(handle, is_unpinned=True) for handle in document.layers[0].handles)
    loose = with_layer(document, handles=free)
    assert np.abs(positions(loose, 3) - positions(document, 3)).max() > 0.01


def test_sliders_add_to_the_motion_of_keys():
    keys = (Keyframe(frame=0, pose=dragged(0)), Keyframe(frame=20, pose=dragged(3)))
    document = slid(0, 0, 1, document=with_layer(posed(3), keys=keys))
    plain = with_layer(document, sliders=(), channels={})
    assert_allclose(positions(document, 7), positions(plain, 7), rtol=0, atol=1e-9)
    top = positions(document, 20)[TOP] - positions(plain, 20)[TOP]
    assert 0.3 < abs(top) / abs(12 + 6j) < 2


def test_slider_frames_keep_tight_limits():
    document = slid(-1.3, 1.3, bounds=Bounds(k=0.1, sigma_a=1.1, sigma_b=0.9))
    motion = animate(document)
    frames = [motion.frame(frame) for frame in (0, 3, 10)]
    assert max(frame.k.max() for frame in frames) < 0.1003
    assert max(frame.sigma_a.max() for frame in frames) < 1.1033
    assert min(frame.sigma_b.min() for frame in frames) > 0.8973
    assert motion.base.sliders.solved_at(0).solution.curbed > 0


def test_tracks_act_on_top_of_sliders():
    document = slid(-1, 1)
    keys = tuple(TrackKey(frame=f, place=place) for f, place in ((0, 0j), (5, 4 + 2j), (10, 0j)))
    tracked = with_layer(document, tracks=(Track(handles=(0,), keys=keys),))
    moved = positions(tracked, 5)[0] - positions(document, 5)[0]
    assert abs(moved) == pytest.approx(abs(4 + 2j), abs=0.05)
    assert not have_same_base_frames(clip_of(document, 0), clip_of(slid(0, 1), 0))


def test_motion_paths_follow_sliders():
    document = slid(-1, 1)
    paths = trace_paths(clip_of(document, 0))
    assert_allclose(paths.positions[10], positions(document, 10)[:4], rtol=0, atol=1e-9)
    assert abs(paths.positions[10][TOP] - paths.positions[0][TOP]) > 10


def test_certificates_measure_frames_with_sliders():
    report = certify_clip(clip_of(slid(-1, 1), 0))
    assert report.verdict is Verdict.MEASURED
    assert report.corrected.slid == report.corrected.frames > 8
    assert report.corrected.proven == 0
    assert certify_clip(clip_of(slid(0, 0), 0)).verdict is Verdict.PROVEN


def test_drags_begin_without_sliders():
    document = slid(1, 1)
    layer = document.layers[0]
    pose = fit_shown_pose(Rig.of(layer), clip_of(document, 0), 5)
    assert_allclose(pose.phi, rest_pose(layer.domain, layer.handles).phi, rtol=0, atol=1e-9)


def test_pad_blends_poses_of_a_grid():
    corners = ((0, None), (1, "up"), (1j, "down"), (1 + 1j, "up"))
    pad = slider(*corners)
    document = slid(1j, 0.5 + 0.5j, slider=pad)
    assert_allclose(positions(document, 0), image(document, 2), rtol=0, atol=1e-9)
    assert len(animate(document).base.sliders.solved_at(10).solution.weights) == 3


def test_drawing_is_unchanged_without_sliders():
    assert clip_of(drawing(), 0).sliders == ()
    off = slid(1, 1, slider=replace(NOD, enabled=False))
    assert_allclose(positions(off, 5), image(off, 0), rtol=0, atol=1e-9)


def store_of(document):
    """Return a cache of the layer's in-betweens, as a window has it."""
    clip = clip_of(document, 0)
    store = InbetweenCache(mesh=DeformMesh.fine(clip.layer.domain))
    store.add(store.segments_job(clip, range(len(segment_keys(clip))))())
    return store


def shown(document, frame, store, corrected, *, waits=True):
    clip = clip_of(document, 0)
    job = corrected.missing_here(document, frame, {0: store.sampler})
    if waits and job is not None:
        corrected.take(job(), is_newest=True)
    return evaluate_layer(clip, frame, None, [store], None, corrected)


@pytest.mark.parametrize("frame", [0, 4, 10])
def test_window_shows_sliders_as_exports_do(frame):
    keys = (Keyframe(frame=0, pose=dragged(0)), Keyframe(frame=20, pose=dragged(3)))
    document = slid(-1.3, 1, document=with_layer(posed(3), keys=keys))
    found = shown(document, frame, store_of(document), CorrectedFrames(clip_of(document, 0)))
    assert found.is_current
    exact = Animation(clip_of(document, 0)).positions(frame)
    assert_allclose(found.positions, exact, rtol=0, atol=1e-3)


def test_window_shows_earlier_values_until_a_dragged_slider_is_solved():
    before, after, last = slid(-1, 1), slid(-1, 0.5), slid(-1, 0.4)
    store, corrected = store_of(before), CorrectedFrames(clip_of(before, 0))
    first = shown(before, 10, store, corrected)
    corrected = CorrectedFrames(clip_of(after, 0), corrected)
    job = corrected.missing_here(after, 10, {0: store.sampler})
    waiting = shown(after, 10, store, corrected, waits=False)
    assert not waiting.is_current
    assert_allclose(waiting.positions, first.positions, rtol=0, atol=1e-3)
    corrected = CorrectedFrames(clip_of(last, 0), corrected)
    corrected.take(job(), is_newest=True)  # which comes after the next move of the hand
    late = shown(last, 10, store, corrected, waits=False)
    assert not late.is_current
    exact = Animation(clip_of(after, 0)).positions(10)
    assert_allclose(late.positions, exact, rtol=0, atol=1e-3)


def test_sliders_keep_the_limits_of_stiff_parts():
    outline = drawing().layers[0].domain.outline
    stiffness = np.where(outline.imag > 60, 30.0, 1.0)
    document = slid(-1.3, 1.3)
    plain, stiff = animate(document), animate(with_layer(document, stiffness=stiffness))
    top = outline.imag > 75

    def reached(motion):
        return motion.frame(10).k[4:][top].max()

    assert reached(plain) > 0.15
    assert reached(stiff) < 0.5 / np.sqrt(30) * 1.003

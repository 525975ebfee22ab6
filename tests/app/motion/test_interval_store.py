"""What a store of in-betweens has, what it lacks, what it keeps, and what it shows of all that."""

from dataclasses import replace

import numpy as np
import pytest
from documents import altered
from key_rows import row
from numpy.testing import assert_allclose
from projects import project_of
from sessions import run_update_steps, session_of, settle

from app.document import shape_commands
from app.document.channels.tangent_mode import TangentMode
from app.document.commands.keys import (
    channel_commands,
)
from app.document.history.undo_history import History
from app.document.queries.channel_values.channel_keys import pose_channel
from app.document.queries.clips import clip_of
from app.document.settings import FrameRange
from app.editor.actions import editing, viewing
from app.editor.actions.updates.stage_jobs import STREAMING, due_jobs
from app.editor.parts.settings import SessionSettings
from app.editor.session import Session
from app.editor.work.jobs import Jobs
from app.motion import (
    CachedSegment,
    CacheUpdate,
    DeformMesh,
    InbetweenCache,
    MemoryBudget,
    StreamedVertices,
    VertexArray,
    evaluate_layer,
)
from app.motion.caches.inbetween_jobs import SeriesBuild, segment_key
from engine import streaming
from engine.variant import Variant

FRAME = 13  # in the second of three intervals


@pytest.fixture(scope="module")
def document():
    return row(4)


@pytest.fixture(scope="module")
def clip(document):
    return clip_of(document, 0)


@pytest.fixture(scope="module")
def found(clip):
    """All in-betweens of the clip."""
    store = InbetweenCache(mesh=DeformMesh.fine(clip.layer.domain))
    return store.mesh, store.segments_job(clip, [0, 1, 2])()


@pytest.fixture
def prepared(found):
    mesh, intervals = found
    store = InbetweenCache(mesh=mesh)
    store.add(intervals)
    return store


def prepare(store, clip, *wanted):
    """Let a store have some of a clip's in-betweens, or all; return how many were prepared."""
    lacking = [
        number for number in store.missing_segments(clip, 0) if number in (wanted or range(99))
    ]
    store.add(store.segments_job(clip, lacking)())
    return len(lacking)


def variant_of(clip, variant):
    return replace(clip, layer=replace(clip.layer, variant=Variant(variant)))


def posed(clip, frame):
    """Return the clip with another pose at a key."""
    pose = clip.layer.key(frame).pose
    keys = tuple(
        replace(key, pose=replace(pose, phi=1.01 * pose.phi)) if key.frame == frame else key
        for key in clip.keys
    )
    return replace(clip, layer=replace(clip.layer, keys=keys))


def finished(build: SeriesBuild) -> SeriesBuild:
    while build.series is None:
        assert build.advance() is build
    return build


def stream(store, clip, frame, *, heat=False):
    """Build all that is wanted, and return the order of the intervals."""
    numbers = {segment_key(clip, interval): interval for interval in range(3)}
    order = []
    store.set_needed_clips([clip], [], frame)
    while build := store.next_build(clip, frame, heat=heat):
        order.append((numbers[build.segment_key], build.distortions))
        store.add_build(finished(build))
        assert store.nbytes <= store.memory.budget.limit
        assert len(order) < 20
    return order


def streamed(store, clip):
    return [store.segment(clip, i).series is not None for i in range(3)]


# By their content.


def test_what_was_made_once_is_found_wherever_it_comes_again(clip, prepared):
    halves = [variant_of(clip, variant) for variant in ("eta", "nu")]
    assert prepare(prepared, halves[0]) == 3
    # The same variant again, as another layer of another document.
    assert prepared.missing_segments(halves[1], 0) == []
    assert prepared.has(clip)
    assert prepared.prepared(halves[1]) == prepared.prepared(clip)
    # One key's pose is another, and then the old one again.
    changed = posed(clip, 30)
    assert prepare(prepared, changed) == 2
    assert prepared.missing_segments(clip, 0) == []


def test_a_copied_key_costs_nothing(document):
    every = document.layers[0].key_frames
    corners = channel_commands.set_tangent_mode({pose_channel(0): every}, TangentMode.CORNER)(
        document
    )
    clip = clip_of(corners, 0)
    store = InbetweenCache(mesh=DeformMesh.fine(clip.layer.domain))
    assert prepare(store, clip) == 3
    longer = replace(corners, frames=FrameRange(0, 60))
    copied = clip_of(channel_commands.copy_keys({pose_channel(0): {0, 10}}, 40)(longer), 0)
    # From the last key to the first of the copies is new; between the two it is not.
    assert store.missing_segments(copied, 0) == [3]


def test_another_method_of_the_split_view_finds_the_layers_own(document, tmp_path):
    session = session_of(document, tmp_path, prepares_ahead=True)
    project, store = session.project, session.project.layer_runtime.store
    viewing.compare_with_method(session, Variant.ETA)
    settle(session)
    comparison = project.layer_runtime.comparison
    other = store.prepared(comparison.clip(project.document))
    assert other is not None
    assert comparison.shown.is_current
    # The layer takes the method that it was compared with.
    editing.edit_layer(session, shape_commands.set_variant, "eta")
    assert store.prepared(project.clip) == other


def test_undo_and_redo_find_what_was_made(document, tmp_path):
    session = session_of(document, tmp_path, prepares_ahead=True)
    project, store = session.project, session.project.layer_runtime.store
    made = [store.prepared(project.clip)]
    for variant in ("eta", "nu", "eta"):
        editing.edit_layer(session, shape_commands.set_variant, variant)
        settle(session)
        made.append(store.prepared(project.clip))
    assert made[0] == made[2]
    assert made[1] == made[3]
    for expected in (made[2], made[1], made[0]):
        editing.undo(session)
        assert store.prepared(project.clip) == expected


# What comes late, and what fails.


def test_a_result_that_nobody_waits_for_any_more_is_used_when_its_keys_come_again(clip, prepared):
    store = InbetweenCache(mesh=prepared.mesh)
    store.set_needed_clips([clip], [], 0)
    late = store.segments_job(clip, [0])
    store.set_needed_clips([variant_of(clip, "eta")], [clip], 0)
    store.add(late())
    assert not store.has(clip)
    store.set_needed_clips([clip], [], 0)
    assert store.missing_segments(clip, 0) == [1, 2]
    # So are series.
    build = finished(prepared.next_build(clip, 0, heat=False))
    prepared.set_needed_clips([variant_of(clip, "eta")], [clip], 0)
    prepared.add_build(build)
    assert streamed(prepared, clip) == [True, False, False]


def test_a_series_in_the_making_is_not_gone_on_with_for_other_keys(clip, prepared):
    build = prepared.next_build(clip, 0, heat=False)
    prepared.add_build(build)
    assert prepared.next_build(clip, 0, heat=False) is build
    prepared.add_build(build)
    # Nothing is built for a clip whose in-betweens are not there yet.
    other = variant_of(clip, "eta")
    assert prepared.next_build(other, 0, heat=False) is None
    prepare(prepared, other)
    assert prepared.next_build(other, 0, heat=False).segment_key == segment_key(other, 0)


def test_a_failure_is_known_of_the_same_keys_as_long_as_they_are_there(clip, prepared):
    prepared.set_needed_clips([clip], [], 0)
    prepared.mark_failed("in-betweens", clip)
    assert prepared.has_failed(replace(clip, layer=replace(clip.layer)))
    assert not prepared.has_failed(clip, "series")
    other = variant_of(clip, "eta")
    assert not prepared.has_failed(other)
    prepared.set_needed_clips([other], [clip], 0)
    prepared.set_needed_clips([clip], [other], 0)
    assert not prepared.has_failed(clip)


# One meaning of being there.


@pytest.mark.parametrize("variant", ["metric", "nu"])
def test_only_exact_in_betweens_are_shown_as_current(variant):
    clip = clip_of(row(4, variant=variant), 0)
    store = InbetweenCache(mesh=DeformMesh.fine(clip.layer.domain))
    frames = (0, 4, 10, 13, 17, 25, 30)

    def exact():
        exact = [frame for frame in frames if store.is_exact(clip, frame)]
        shown = [evaluate_layer(clip, frame, None, [store], None) for frame in frames]
        assert exact == [each.frame for each in shown if each.is_current]
        assert exact == [frame for frame in frames if store.positions(clip, frame) is not None]
        return exact

    keys = [0, 10, 30]
    assert exact() == keys
    # Before the first in-betweens, a frame alone would not come sooner.
    assert store.frame_job(clip, FRAME) is None
    prepare(store, clip, 0)
    assert exact() == [0, 4, 10, 30]
    store.add(store.frame_job(clip, FRAME)())
    alone = [0, 4, 10, 13, 30] if variant == "metric" else [0, 4, 10, 13, 17, 30]
    assert exact() == alone
    assert store.frame_job(clip, FRAME) is None
    one = store.positions(clip, FRAME)
    prepare(store, clip)
    assert exact() == list(frames)
    whole = store.prepared(clip)[1].frame(0.3).positions
    size = np.ptp(clip.layer.domain.mesh.vertices.real)
    assert_allclose(one, whole, rtol=0, atol=1e-9 * size)
    stream(store, clip, FRAME)
    assert exact() == list(frames)
    # Of another domain nothing is.
    other = replace(clip, layer=replace(clip.layer, domain=replace(clip.layer.domain)))
    assert not store.has(other)
    assert not store.is_exact(other, 0)
    assert store.positions(other, 0) is None


# Within a budget.


def test_what_nothing_present_needs_makes_room_and_the_oldest_first(clip, prepared):
    others = [variant_of(clip, variant) for variant in ("eta", "linear")]
    for other in others:
        prepared.set_needed_clips([other], [], 0)
        prepare(prepared, other)
    size = prepared.nbytes
    prepared.set_needed_clips([clip], [], 0)
    assert all(map(prepared.has, (clip, *others)))
    # Room for the present one, and not quite for both of the others.
    own = sum(sum(prepared.segment(clip, i).sizes) for i in range(3))
    spare = size - own
    prepared.memory.budget.spare = spare - 1
    prepared.set_needed_clips([clip], [others[0]], 0)
    prepared.set_needed_clips([clip], [], 0)
    assert prepared.has(clip)
    assert not prepared.has(others[1]), "wanted before the other one"
    assert prepared.has(others[0])
    prepared.memory.budget.limit = own
    prepared.set_needed_clips([clip], [others[0]], 0)
    assert prepared.has(clip)
    assert not prepared.has(others[0]), "to which undo leads, if there is room"
    assert prepared.nbytes <= own


def test_caches_share_a_budget_and_what_nobody_needs_goes_first(clip, prepared):
    other = InbetweenCache(mesh=prepared.mesh, budget=prepared.memory.budget)
    prepare(other, clip)
    prepared.set_needed_clips([clip], [], 0)
    budget = prepared.memory.budget
    assert budget.nbytes == prepared.nbytes + other.nbytes
    budget.limit = prepared.nbytes
    assert not prepared.has_room()
    other.add(CacheUpdate(sampler=None, segments={}))
    assert prepared.has(clip)
    assert not other.has(clip)


def test_memory_is_bounded_and_the_farthest_series_makes_room(clip, prepared, monkeypatch):
    monkeypatch.setattr("app.motion.caches.inbetween_cache.EXPECTED", 1)
    prepared.set_needed_clips([clip], [], 0)
    base = prepared.nbytes
    stream(prepared, clip, 0)
    sizes = [prepared.segment(clip, i).series.nbytes for i in range(3)]
    prepared.memory.budget.limit = base + sizes[1] + max(sizes[0], sizes[2])
    prepared.add(CacheUpdate(sampler=None, segments={}))
    assert streamed(prepared, clip) == [True, True, False]
    assert stream(prepared, clip, 0) == []
    assert prepared.nbytes <= prepared.memory.budget.limit
    # The playhead moves on to the last interval.
    stream(prepared, clip, 25)
    assert streamed(prepared, clip) == [False, True, True]
    assert prepared.has(clip)
    assert prepared.nbytes <= prepared.memory.budget.limit


def test_at_rest_series_alone_show_all_of_what_nobody_edits(clip, prepared):
    prepared.set_needed_clips([clip], [], 0)
    extension = prepared.sampler.extension.nbytes
    assert prepared.releasable_bytes(clip) > extension > 0
    stream(prepared, clip, 0)
    assert all(prepared.segment(clip, number).is_streamed for number in range(3))
    frames = (0.5, 4, 9.9, 13, 21.7, 30)
    before = [prepared.positions(clip, frame) for frame in frames]
    size = prepared.nbytes
    assert prepared.releasable_bytes(clip) > extension
    prepared.release_intermediates()
    assert prepared.releasable_bytes(clip) == 0
    assert prepared.nbytes < size / 2
    assert prepared.mesh.coordinates_bytes == 0
    for frame, places in zip(frames, before, strict=True):
        # Keys, too, are shown by their series.
        assert isinstance(prepared.vertices(clip, frame), StreamedVertices)
        np.testing.assert_allclose(prepared.positions(clip, frame), places, rtol=0, atol=1e-4)
        assert prepared.is_exact(clip, frame)
    assert prepared.has(clip)
    assert prepared.velocity_shares(clip).keys() == {10, 20}
    assert prepared.missing_segments(clip, 0, is_edited=False) == []
    assert prepared.next_build(clip, 0, heat=True) is None
    # What is edited is measured, and made of its in-betweens: they are made again.
    assert prepared.prepared(clip) is None
    assert prepared.missing_segments(clip, 0) == [0, 1, 2]
    prepare(prepared, clip)
    assert len(prepared.prepared(clip)) == 3
    assert all(prepared.segment(clip, number).is_streamed for number in range(3))


def test_what_no_series_has_all_of_stays_prepared_at_rest(clip, prepared):
    prepared.set_needed_clips([clip], [], 0)
    stream(prepared, clip, 0)
    pair = segment_key(clip, 1)
    known = prepared.segment(clip, 1)
    holed = replace(known.series, pieces=known.series.pieces[1:])
    prepared.add(CacheUpdate(None, {pair: CachedSegment(known.poses, series=holed)}))
    prepared.release_intermediates()
    assert prepared.segment(clip, 1).inbetweens is not None
    assert prepared.segment(clip, 0).inbetweens is None
    assert prepared.has(clip)
    assert np.isfinite(prepared.positions(clip, 11)).all()


@pytest.mark.parametrize("frame", [0, 25])
def test_what_did_not_fit_is_not_built_over_and_over(clip, found, monkeypatch, frame):
    monkeypatch.setattr("app.motion.caches.inbetween_cache.EXPECTED", 1)
    mesh, intervals = found
    everything = InbetweenCache(mesh=mesh)
    everything.add(intervals)
    base = everything.nbytes
    stream(everything, clip, 0)
    sizes = [everything.segment(clip, i).series.nbytes for i in range(3)]
    # There is room for the nearest one, and not quite for the next.
    store = InbetweenCache(
        mesh=mesh, budget=MemoryBudget(base + sizes[1] + sizes[2 if frame else 0] - 1)
    )
    store.set_needed_clips([clip], [], frame)
    store.add(intervals)
    order = stream(store, clip, frame)
    assert len(order) == len(set(order))
    assert streamed(store, clip)[2 if frame else 0]


def test_full_detail_is_prepared_as_far_as_there_is_room(clip, found):
    mesh, _ = found
    store = InbetweenCache(mesh=mesh)
    store.set_needed_clips([clip], [], 0)
    prepare(store, clip, 0)
    one = store.nbytes
    store.memory.budget.limit = 2 * one
    assert store.has_room()
    store.memory.budget.limit = 2 * one - 1
    assert not store.has_room()
    assert InbetweenCache(mesh=mesh, budget=MemoryBudget(1)).has_room(), (
        "nothing is known of their size"
    )


# Series.


def test_what_a_series_leaves_out_is_shown_by_the_direct_path(clip, prepared):
    stream(prepared, clip, FRAME, heat=True)
    known = prepared.segment(clip, 1)
    partly = InbetweenCache(mesh=prepared.mesh)

    def take(**series):
        partly.add(
            CacheUpdate(sampler=None, segments={segment_key(clip, 1): known._replace(**series)})
        )

    none = replace(known.distortions, pieces=())
    take(distortions=none)
    assert partly.vertices(clip, FRAME).derivatives is None
    take(series=replace(known.series, pieces=()), distortions=none)
    shown = partly.vertices(clip, FRAME)
    assert isinstance(shown, VertexArray)
    exact = known.inbetweens.frame(0.3).positions
    assert_allclose(shown.positions, exact, rtol=0, atol=1e-12)


def test_the_nearest_interval_is_built_first(clip, prepared):
    assert isinstance(prepared.vertices(clip, FRAME), VertexArray)
    frames = (3, 13, 13.5, 29)
    direct = [prepared.positions(clip, frame) for frame in frames]
    order = stream(prepared, clip, FRAME)
    assert order == [(1, False), (2, False), (0, False)]
    size = np.ptp(clip.layer.domain.mesh.vertices.real)
    for frame, expected in zip(frames, direct, strict=True):
        vertices = prepared.vertices(clip, frame)
        assert isinstance(vertices, StreamedVertices)
        assert_allclose(vertices.positions, expected, rtol=0, atol=2e-6 * size)
        assert vertices.derivatives is None
    prepared.mesh.prepared(clip, 20)
    assert isinstance(prepared.vertices(clip, 20), VertexArray)  # a key itself


def test_distortions_are_built_while_they_are_shown(clip, prepared):
    order = stream(prepared, clip, 0, heat=True)
    assert order == [(i, distortions) for i in range(3) for distortions in (False, True)]
    fz, fzbar = prepared.vertices(clip, 4).derivatives
    exact = prepared.prepared(clip)[0].frame(0.4)
    assert_allclose(fz, exact.fz, rtol=0, atol=1e-4)
    assert_allclose(fzbar, exact.fzbar, rtol=0, atol=1e-4)


def test_a_session_streams_what_it_plays_and_stops_while_a_hand_pulls(document, clip, tmp_path):
    session = session_of(document, tmp_path, prepares_ahead=True)
    project, store = session.project, session.project.layer_runtime.store
    assert streamed(store, clip) == [True] * 3
    project.timeline.playhead = project.timeline.playhead.seek(13, 0.0)
    settle(session)
    assert isinstance(project.layer_runtime.shown.vertices, StreamedVertices)
    assert store.build is None
    # Another key's pose: its two intervals are built anew, but not while it is being pulled.
    key = clip.layer.keys[1]
    moved = replace(key, pose=replace(key.pose, phi=key.pose.phi + 1))
    edited = altered(document, keys=(clip.layer.keys[0], moved, *clip.layer.keys[2:]))
    project.history = History(edited, saved=True)
    settle(session)
    assert streamed(store, clip_of(edited, 0)) == [True] * 3
    project.layer_runtime.store = InbetweenCache(mesh=store.mesh)
    prepare(project.layer_runtime.store, clip)
    project.history = History(document, saved=True)
    project.history.hold(object())
    assert not list(due_jobs(session, project))


def test_where_much_is_prepared_layers_that_nobody_edits_come_one_after_the_other(
    document, tmp_path, monkeypatch
):
    monkeypatch.setattr("app.editor.project.MOST_RELEASABLE_BYTES", 0)
    (layer,) = document.layers
    layers = tuple(replace(layer, id=number, name=f"{number}") for number in range(3))
    document = replace(document, layers=layers)
    session = session_of(document, tmp_path, prepares_ahead=True)
    for clip, runtime in zip(
        [clip_of(document, number) for number in range(3)],
        session.project.runtimes.layers.values(),
        strict=True,
    ):
        assert streamed(runtime.store, clip) == [True] * 3
        # What is edited keeps what it is made from, and all others let go of it.
        is_edited = runtime is session.project.layer_runtime
        assert (runtime.store.prepared(clip) is not None) == is_edited


def test_a_series_that_failed_once_is_built_anew_when_the_document_changes(
    document, clip, tmp_path, monkeypatch
):
    project = project_of(document, np.zeros((90, 120, 4), np.uint8), "blob")
    session = Session(
        clock=lambda: 0.0, jobs=Jobs(), project=project, settings=SessionSettings(folder=tmp_path)
    )
    asked = []

    def settle():
        for _ in range(1_000):
            run_update_steps(session)
            if not session.jobs.kinds:
                return
            asked.extend(session.jobs.kinds)
            assert session.jobs.wait_until_idle()
            session.jobs.deliver()
        raise AssertionError(f"there is no end of {session.jobs.kinds}")

    def broken(_):
        yield
        raise ZeroDivisionError("a bug")

    with monkeypatch.context() as patch:
        patch.setattr("app.motion.caches.inbetween_jobs.build_series", broken)
        settle()
        settle()
    store = project.layer_runtime.store
    assert asked.count(STREAMING) == 1
    assert [toast.text for toast in session.notices.toasts] == ["Playback cannot be made smooth."]
    assert streamed(store, clip) == [False] * 3
    assert store.has_failed(clip, "series")
    # The other intervals are as they were.
    *others, last = clip.layer.keys
    moved = replace(last, pose=replace(last.pose, phi=last.pose.phi + 1))
    edited = altered(document, keys=(*others, moved))
    project.history = History(edited, saved=True)
    settle()
    assert streamed(store, clip_of(edited, 0)) == [True] * 3


def test_the_worker_takes_few_steps_at_once(clip, prepared, monkeypatch):
    monkeypatch.setattr(
        "app.motion.caches.inbetween_jobs.BATCH", 3 * len(clip.layer.domain.mesh.vertices)
    )
    build = prepared.next_build(clip, 0, heat=False)
    batches = 0
    while build.series is None:
        build.advance()
        batches += 1
    assert batches > 3
    known: CachedSegment = prepared.segment(clip, 0)
    whole = streaming.finish(
        streaming.build_series(streaming.Positions.of(known.inbetweens, known.sites))
    )
    assert_allclose(build.series.values(0.3), whole.values(0.3), rtol=0, atol=0)

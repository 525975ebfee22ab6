"""Which series are built next, in which batches, and which of them are dropped."""

from dataclasses import replace

import numpy as np
import pytest
from animations import moving_document
from documents import altered
from numpy.testing import assert_allclose
from projects import project_of
from sessions import session_of, settle

from app.document.history import History
from app.document.keyframe import Keyframe
from app.document.queries.timeline import clip_of
from app.document.settings import FrameRange
from app.editor.actions.upkeep import STREAMING, maintain, missing
from app.editor.jobs import Jobs
from app.editor.project import PoseInProgress
from app.editor.session import Session
from app.motion.posable_mesh import PosableMesh
from app.motion.prepared import Motion, pair_of, prepare_motion
from app.motion.series_queue import Build, memory, next_build, with_series
from app.motion.vertices import Placed, Streamed
from engine import streaming

FRAME = 13  # in the second of three intervals


def three_intervals():
    document = moving_document(10)
    last = document.figures[0].keys[-1]
    turns = (1.0, np.exp(0.3j), np.exp(-0.4j), np.exp(0.2j))
    keys = tuple(
        Keyframe(frame=10 * i, pose=replace(last.pose, phi=turn * last.pose.phi))
        for i, turn in enumerate(turns)
    )
    return altered(document, keys=keys, frames=FrameRange(0, 30), variant="nu")


@pytest.fixture(scope="module")
def document():
    return three_intervals()


@pytest.fixture(scope="module")
def clip(document):
    return clip_of(document, 0)


@pytest.fixture(scope="module")
def prepared(clip):
    return prepare_motion(clip, Motion.at_rest(clip, PosableMesh.fine(clip.figure.domain)))


def finished(build: Build) -> Build:
    while build.series is None:
        assert build.advance() is build
    return build


def stream(motion, clip, frame, **options):
    """Build all that is wanted, and return the motion and the order of the intervals."""
    numbers = {pair_of(clip, interval): interval for interval in range(3)}
    order = []
    budget = {key: value for key, value in options.items() if key == "budget"}
    while build := next_build(motion, clip, frame, **options):
        order.append((numbers[build.pair], build.distortions))
        motion = with_series(motion, finished(build), clip, frame, **budget)
        assert len(order) < 20
    return motion, order


def streamed(motion, clip):
    return [motion.ready[pair_of(clip, i)].series is not None for i in range(3)]


def test_what_a_series_leaves_out_is_shown_by_the_direct_path(clip, prepared):
    motion, _ = stream(prepared, clip, FRAME, heat=True)
    pair = pair_of(clip, 1)
    without = {
        name: replace(getattr(motion.ready[pair], name), pieces=())
        for name in ("series", "distortions")
    }
    partly = replace(motion, ready={pair: motion.ready[pair]._replace(**without)})
    shown = partly.vertices(clip, FRAME)
    assert isinstance(shown, Placed)
    assert_allclose(shown.positions, prepared.vertices(clip, FRAME).positions, rtol=0, atol=0)
    only_places = motion.ready[pair]._replace(distortions=without["distortions"])
    assert replace(motion, ready={pair: only_places}).vertices(clip, FRAME).derivatives is None


def test_the_nearest_interval_is_built_first(clip, prepared):
    motion, order = stream(prepared, clip, FRAME, heat=False)
    assert order == [(1, False), (2, False), (0, False)]
    assert isinstance(prepared.vertices(clip, FRAME), Placed)
    size = np.ptp(clip.figure.domain.mesh.vertices.real)
    for frame in (3, 13, 13.5, 29):
        vertices = motion.vertices(clip, frame)
        assert isinstance(vertices, Streamed)
        expected = prepared.vertices(clip, frame).positions
        assert_allclose(vertices.positions, expected, rtol=0, atol=2e-6 * size)
        assert vertices.derivatives is None
    assert isinstance(motion.vertices(clip, 20), Placed)  # a key itself


def test_distortions_are_built_while_they_are_shown(clip, prepared):
    motion, order = stream(prepared, clip, 0, heat=True)
    assert order == [(i, distortions) for i in range(3) for distortions in (False, True)]
    fz, fzbar = motion.vertices(clip, 4).derivatives
    exact = prepared.inbetweens(clip, 0).frame(0.4)
    assert_allclose(fz, exact.fz, rtol=0, atol=1e-4)
    assert_allclose(fzbar, exact.fzbar, rtol=0, atol=1e-4)


def test_memory_is_bounded_and_the_farthest_interval_makes_room(clip, prepared, monkeypatch):
    monkeypatch.setattr("app.motion.series_queue.EXPECTED", 1)
    everything, _ = stream(prepared, clip, 0, heat=False)
    sizes = [everything.ready[pair_of(clip, i)].series.nbytes for i in range(3)]
    budget = sizes[1] + max(sizes[0], sizes[2])
    motion, order = stream(prepared, clip, 0, heat=False, budget=budget)
    assert [interval for interval, _ in order[:2]] == [0, 1]
    assert memory(motion.ready.values()) <= budget
    assert streamed(motion, clip) == [True, True, False]
    # The playhead moves on to the last interval.
    moved, _ = stream(motion, clip, 25, heat=False, budget=budget)
    assert streamed(moved, clip) == [False, True, True]
    assert memory(moved.ready.values()) <= budget


def test_what_did_not_fit_is_not_built_over_and_over(clip, prepared, monkeypatch):
    monkeypatch.setattr("app.motion.series_queue.EXPECTED", 1)
    everything, _ = stream(prepared, clip, 0, heat=False)
    sizes = [everything.ready[pair_of(clip, i)].series.nbytes for i in range(3)]
    for frame in (0, 25):
        # There is room for the nearest one, and not quite for the next.
        budget = sizes[1] + (sizes[2] if frame else sizes[0]) - 1
        motion, order = stream(prepared, clip, frame, heat=False, budget=budget)
        assert len(order) == len(set(order))
        assert memory(motion.ready.values()) <= budget
        assert streamed(motion, clip)[2 if frame else 0]


def test_a_series_of_other_keys_is_not_kept(document, clip, prepared):
    build = finished(next_build(prepared, clip, 0, heat=False))
    other = prepare_motion(clip_of(altered(document, variant="eta"), 0), prepared)
    assert with_series(other, build, clip, 0) is other
    assert not build.is_of(other)
    assert not build.is_of(None)
    sketch = replace(prepared, mesh=PosableMesh.fine(clip.figure.domain))
    assert with_series(sketch, build, clip, 0) is sketch
    # Nothing is built for a clip that the motion does not know yet.
    assert next_build(prepared, clip_of(altered(document, variant="eta"), 0), 0, heat=False) is None
    still = Motion.at_rest(clip, prepared.mesh)
    assert next_build(still, clip, 0, heat=False) is None


def test_a_session_streams_what_it_plays_and_stops_while_a_hand_pulls(document, clip, tmp_path):
    session = session_of(document, tmp_path)
    project = session.project
    assert streamed(project.puppet.coarse.value, clip) == [True] * 3
    project.playhead = project.playhead.seek(13, 0.0)
    settle(session)
    assert isinstance(project.puppet.shown.vertices, Streamed)
    assert project.puppet.build.value is None
    # Another key's pose: its two intervals are built anew, but not while it is being pulled.
    key = clip.figure.keys[1]
    moved = replace(key, pose=replace(key.pose, phi=key.pose.phi + 1))
    edited = altered(document, keys=(clip.figure.keys[0], moved, *clip.figure.keys[2:]))
    project.history = History(edited, saved=True)
    settle(session)
    assert streamed(project.puppet.coarse.value, clip_of(edited, 0)) == [True] * 3
    project.puppet.coarse.value = prepare_motion(
        clip, Motion.at_rest(clip, project.puppet.coarse.value.mesh)
    )
    project.history = History(document, saved=True)
    project.pull = PoseInProgress(frame=13, targets={}, start=None, gesture=object())
    assert not list(missing(session, project))


def test_a_series_that_failed_once_is_built_anew_when_the_document_changes(
    document, clip, tmp_path, monkeypatch
):
    project = project_of(document, np.zeros((90, 120, 4), np.uint8), "blob")
    session = Session(clock=lambda: 0.0, jobs=Jobs(), folder=tmp_path, project=project)
    asked = []

    def settle():
        for _ in range(1_000):
            maintain(session)
            if not session.jobs.kinds:
                return
            asked.extend(session.jobs.kinds)
            assert session.jobs.settle()
            session.jobs.deliver()
        raise AssertionError(f"there is no end of {session.jobs.kinds}")

    def broken(_):
        yield
        raise ZeroDivisionError("a bug")

    with monkeypatch.context() as patch:
        patch.setattr("app.motion.series_queue.build_series", broken)
        settle()
        settle()
    assert asked.count(STREAMING) == 1
    assert [toast.text for toast in session.toasts] == ["Playback cannot be made smooth."]
    assert streamed(project.puppet.coarse.value, clip) == [False] * 3
    assert project.puppet.build.has_failed(clip)
    # The other intervals are as they were: what was in the making is theirs, and no more of use.
    keys = clip.figure.keys
    moved = replace(keys[-1], pose=replace(keys[-1].pose, phi=keys[-1].pose.phi + 1))
    edited = altered(document, keys=(*keys[:-1], moved))
    project.history = History(edited, saved=True)
    settle()
    assert streamed(project.puppet.coarse.value, clip_of(edited, 0)) == [True] * 3


def test_the_worker_takes_few_steps_at_once(clip, prepared, monkeypatch):
    monkeypatch.setattr("app.motion.series_queue.BATCH", 3 * len(clip.figure.domain.mesh.vertices))
    build = next_build(prepared, clip, 0, heat=False)
    batches = 0
    while build.series is None:
        build.advance()
        batches += 1
    assert batches > 3
    whole = streaming.finish(
        streaming.build_series(
            streaming.Positions.of(prepared.inbetweens(clip, 0), prepared.sampler.sites)
        )
    )
    assert_allclose(build.series.values(0.3), whole.values(0.3), rtol=0, atol=0)

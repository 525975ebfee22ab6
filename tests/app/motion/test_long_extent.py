from dataclasses import replace

import numpy as np
import pytest
from documents import altered, disc_document
from numpy.testing import assert_allclose

from app.document import (
    LINEAR,
    TRANSFORM,
    Attachment,
    FrameRange,
    Handle,
    Keyframe,
    Spring,
    Target,
    Transform,
)
from app.document.channels.cycles import Cycle
from app.motion.extents import long_extent
from app.motion.extents.long_extent import MOST_MEASURED, farthest_reach

LAST = 999_999
LONG = FrameRange(0, LAST)


def keyed(*frames, cycles=()):
    document = disc_document()
    pose = document.layers[0].keys[0].pose
    keys = tuple(Keyframe(frame=frame, pose=pose, easing=LINEAR) for frame in frames)
    return altered(replace(document, frames=LONG), keys=keys, cycles=cycles)


class Reaching:
    """Says how far a layer reaches in a frame, the same each way, and counts the frames."""

    def __init__(self, how):
        self.how, self.seen = how, set()

    def __call__(self, frame):
        self.seen.add(frame)
        return np.full((1, 4), self.how(frame))


def reach(document, how):
    measure = Reaching(how)
    found = farthest_reach(document, LONG, measure)
    assert len(measure.seen) <= 3 * MOST_MEASURED
    return found


def test_the_spike_of_a_single_frame_is_within():
    document = keyed(0, 777_776, 777_777, 777_778, LAST)
    found = reach(document, lambda frame: 1000.0 if frame == 777_777 else 10.0)
    assert_allclose(found, np.full(4, 1000.0), rtol=0, atol=0)


@pytest.mark.parametrize("top", [123_456, 500_000, 876_543])
@pytest.mark.parametrize("width", [30.0, 3e4, 3e5])
def test_an_arc_between_two_keys_is_within(top, width):
    # As fast as an easing lets it: from one pose to the other around `top`, on a wide arc.
    def arc(frame):
        angle = np.pi / 2 * (1 + np.tanh((frame - top) / width))
        return 100.0 * np.sin(angle) - 10.0 * np.cos(angle)

    (found, *_) = reach(keyed(0, LAST), arc)
    highest = arc(np.linspace(top - 3 * width, top + 3 * width, 100_001)).max()
    assert highest * 0.996 <= found <= highest * 1.1


def test_a_walk_of_many_rounds_is_within():
    step = [0.0, 3.0, 9.0, 40.0, 9.0, 3.0, 1.0, 0.0]
    document = keyed(0, 4, cycles=(Cycle(first=0, last=len(step)),))
    (found, *_) = reach(document, lambda frame: 1e-3 * frame + step[frame % len(step)])
    highest = max(1e-3 * frame + step[frame % len(step)] for frame in range(LAST - 8, LAST + 1))
    assert highest * 0.996 <= found <= highest * 1.1


def test_what_is_not_measured_counts_as_far_as_it_may_reach(monkeypatch):
    monkeypatch.setattr(long_extent, "MOST_MEASURED", 20)
    rng = np.random.default_rng(3)
    peaks = rng.uniform(0, 100, 2000)
    document = keyed(0, LAST)
    measure = Reaching(lambda frame: peaks[frame % len(peaks)])
    found = farthest_reach(document, LONG, measure)
    assert len(measure.seen) < 60
    assert (found >= peaks.max()).all()


def test_few_frames_are_all_measured():
    measure = Reaching(lambda frame: float(frame == 5))
    document = keyed(0)
    assert (farthest_reach(document, FrameRange(0, MOST_MEASURED - 1), measure) == 1).all()
    assert len(measure.seen) == MOST_MEASURED


def test_a_spike_that_a_cycle_brings_again_is_within():
    period, spike = 60_000, 31_234
    document = keyed(0, spike - 1, spike, spike + 1, cycles=(Cycle(first=0, last=period),))
    (layer,) = document.layers
    # Another layer's keys part its rounds, and each spike lies farther than the one before.
    other = replace(layer, id=1, name="other", cycles=())
    keys = [replace(other.keys[0], frame=frame) for frame in range(0, LAST, 90_000)]
    document = replace(document, layers=(layer, replace(other, keys=tuple(keys))))
    (found, *_) = reach(document, lambda at: 1e-3 * at + 1000.0 * (at % period == spike))
    assert found >= 1e-3 * (15 * period + spike) + 1000.0


def test_a_spring_that_swings_with_what_carries_it_is_within():
    document, kicked = keyed(0), 500_000
    (layer,) = document.layers
    anchor = complex(layer.domain.mesh.vertices[0])
    handle = Handle(id=0, name="tip", position=anchor)
    pose = replace(layer.keys[0].pose, targets={0: Target(position=anchor)})
    keys = (replace(layer.keys[0], pose=pose),)
    spring = Spring(handle=0, frequency=2.0, damping=0.1)
    moves = [TRANSFORM.key(at, Transform()) for at in (0, kicked, LAST)]
    parent = replace(layer, id=1, name="parent").with_keys_of(TRANSFORM, moves)
    child = replace(
        layer,
        handles=(handle,),
        next_handle=1,
        keys=keys,
        anchor=anchor,
        attachments=(Attachment(parent=1, parent_point=anchor),),
        springs=(spring,),
    )
    (found, *_) = reach(
        replace(document, layers=(child, parent)),
        lambda at: 1000.0 if at == kicked + 7 else 10.0,
    )
    assert found >= 1000.0

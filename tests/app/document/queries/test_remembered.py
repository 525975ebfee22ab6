import gc
import sys
import threading
import weakref
from dataclasses import replace

from documents import disc_document, random_pose
from numpy import random

from app.document import clip_of, measure_target_errors, pose_segments
from app.document.commands.keys import (
    key_commands,
)
from app.document.queries.memo import MOST, memoized_on
from app.document.settings import FrameRange


def clips_of_layers(count):
    """Return clips of as many layers with two keys each."""
    document = disc_document()
    pose = random_pose(random.default_rng(0), document)
    document = key_commands.insert_key(0, 24, pose)(document)
    named = [replace(document.layers[0], name=f"layer {number}") for number in range(count)]
    return [clip_of(document.with_layer(layer), 0) for layer in named]


def test_what_is_known_of_twenty_layers_is_not_found_out_again_in_each_frame():
    clips = clips_of_layers(20)
    first = [
        (pose_segments(clip), measure_target_errors(clip.layer, clip.keys[-1].pose))
        for clip in clips
    ]
    for clip, (ways, errors) in zip(clips, first, strict=True):
        assert pose_segments(clip) is ways
        assert pose_segments(replace(clip)) is ways
        assert measure_target_errors(clip.layer, clip.keys[-1].pose) is errors


def test_what_is_known_of_a_layer_goes_with_it():
    (clip,) = clips_of_layers(1)
    pose_segments(clip)
    measure_target_errors(clip.layer, clip.keys[0].pose)
    layer = weakref.ref(clip.layer)
    del clip
    gc.collect()
    assert layer() is None


def test_threads_that_ask_at_once_are_all_answered():
    """Also while others make room for new answers; with so many of them that they do."""
    layer, failures = disc_document().layers[0], []
    ask = memoized_on(lambda _, frames: frames.last + 1)

    def go(step):
        try:
            for number in range(10_000):
                last = number * step % (4 * MOST + 1)
                assert ask(layer, FrameRange(0, last)) == last + 1
        except (AssertionError, KeyError) as error:
            failures.append(error)

    threads = [threading.Thread(target=go, args=(step,)) for step in (3, 5, 7, 11)]
    usual = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(usual)
    assert not failures

"""Pose sliders: their values, weights, keys and commands."""

from dataclasses import replace

import numpy as np
import pytest
from documents import altered, disc_document, random_pose
from messages import says
from numpy.testing import assert_allclose

from app.document import (
    SLIDER,
    Channel,
    LibraryPose,
    Slider,
    SliderPose,
    channel_commands,
    channels_of,
    clip_of,
    describe_channel,
    pose_commands,
    slider_commands,
    slider_value_at,
    slider_weights_at,
    value_at,
)
from app.errors import LissomError
from app.storage import load_project, save_project

NAMES = ("left", None, "right")
TURN = Slider(
    name="turn",
    poses=tuple(
        SliderPose(at=complex(at), pose=name) for at, name in zip((-1, 0, 1), NAMES, strict=True)
    ),
)
PAD = Slider(
    name="look",
    poses=tuple(
        SliderPose(at=complex(x, y), pose=None if x == y else "left")
        for y in (0, 1)
        for x in (0, 1)
    ),
)
CHANNEL = Channel(SLIDER, 0, "turn")


def document_with(*sliders):
    rng, document = np.random.default_rng(1), disc_document()
    library = tuple(LibraryPose(name=n, pose=random_pose(rng, document)) for n in NAMES if n)
    return altered(document, library=library, sliders=sliders)


def keyed(*keys, sliders=(TURN,)):
    document = document_with(*sliders)
    for frame, value in keys:
        document = channel_commands.set_key(CHANNEL, frame, complex(value))(document)
    return document


@pytest.mark.parametrize("slider", [TURN, PAD])
def test_slider_weights_are_exact_at_poses_and_sum_to_1(slider):
    weights = [slider.weights(each.at) for each in slider.poses]
    assert_allclose(weights, np.eye(len(weights)), rtol=0, atol=1e-15)
    for value in (0.3 + 0.2j, -1.2, 1.25 - 0.3j, 9 + 9j):
        assert_allclose(slider.weights(value).sum(), 1.0, rtol=0, atol=1e-12)


def test_slider_weights_have_continuous_slopes_at_poses():
    for at in (-1, 0, 1):
        low, middle, high = (TURN.weights(at + 1e-5 * step) for step in (-1, 0, 1))
        assert_allclose(middle - low, high - middle, rtol=0, atol=1e-9)


def test_slider_values_stop_30_percent_beyond_the_outer_poses():
    assert TURN.clamp(5) == 1.6
    assert TURN.clamp(-5) == -1.6
    assert PAD.clamp(-5 + 5j) == pytest.approx(-0.3 + 1.3j)


def test_slider_channel_gives_its_value_with_easing_and_delay():
    document = keyed((0, -1), (20, 1))
    (channel,) = clip_of(document, 0).sliders
    found = [slider_value_at(clip_of(document, 0), channel, frame) for frame in (0, 10, 20, 30)]
    assert_allclose(found, [-1, 0, 1, 1], rtol=0, atol=1e-12)
    assert value_at(document, CHANNEL, 10) == pytest.approx(0)
    late = slider_commands.change_slider(0, "turn", replace(TURN, delay=10))(document)
    assert slider_weights_at(clip_of(late, 0), 20) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert describe_channel(document, CHANNEL) == "turn of 'layer'"
    assert CHANNEL in set(channels_of(document.layers[0]))


def test_slider_repeats_in_a_loop():
    document = replace(keyed((0, -1), (20, 1), (40, -1)), loop=True)
    clip = clip_of(document, 0)
    assert clip.frames.last == 48
    assert slider_weights_at(clip, 10) == pytest.approx(slider_weights_at(clip, 58))


@pytest.mark.parametrize("loop", [False, True])
def test_slider_with_a_spring_swings_about_its_value(loop):
    springy = replace(TURN, spring=(2.0, 0.2))
    document = replace(keyed((0, -1), (6, 1), sliders=(springy,)), loop=loop)
    clip, plain = clip_of(document, 0), clip_of(replace(keyed((0, -1), (6, 1)), loop=loop), 0)
    (swung,), (still,) = clip.sliders, plain.sliders
    found = [slider_value_at(clip, swung, frame).real for frame in range(49)]
    driving = [slider_value_at(plain, still, frame).real for frame in range(49)]
    assert max(found) > 1.1
    assert found[4] < driving[4] - 0.05
    if loop:
        assert found[0] == pytest.approx(found[-1])
    else:
        assert abs(found[-1] - driving[-1]) < 0.1


def test_slider_without_keys_has_its_own_value():
    document = document_with(replace(TURN, value=1 + 0j))
    assert slider_weights_at(clip_of(document, 0), 7) == (0.0, 1.0)
    assert value_at(document, CHANNEL, 7) == 1


def test_slider_drives_the_slider_of_another_layer():
    document = keyed((0, -1), (20, 1))
    follower = replace(document.layers[0], id=1, name="hair", channels={})
    follower = replace(follower, sliders=(replace(TURN, driver=0, delay=5),))
    document = replace(document, layers=(document.layers[0], follower))
    own = clip_of(document, 0)
    assert slider_weights_at(clip_of(document, 1), 15) == slider_weights_at(own, 10)
    changed = channel_commands.set_key(CHANNEL, 10, 1 + 0j)(document)
    assert clip_of(changed, 1) != clip_of(document, 1)
    alone = slider_commands.delete_slider(0, "turn")(document)
    assert slider_weights_at(clip_of(alone, 1), 15) == (0.0, 0.0)


def test_slider_commands_undo_and_keep_keys():
    document = keyed((0, -1), (20, 1))
    renamed = slider_commands.change_slider(0, "turn", replace(TURN, name="head"))(document)
    assert renamed.layers[0].keys_of(SLIDER, "head") == document.layers[0].keys_of(SLIDER, "turn")
    gone = slider_commands.delete_slider(0, "turn")(document)
    assert (gone.layers[0].sliders, dict(gone.layers[0].channels)) == ((), {})
    assert gone.layers[0].library == document.layers[0].library


def test_slider_poses_are_set_in_the_library():
    document = document_with(TURN)
    pose = random_pose(np.random.default_rng(2), document)
    changed = slider_commands.set_slider_pose(0, "turn", 1 + 0j, pose)(document).layers[0]
    assert changed.library_pose("right").pose is pose
    added = slider_commands.set_slider_pose(0, "turn", 0.5 + 0j, pose)(document).layers[0]
    assert [each.at for each in added.slider("turn").poses] == [-1, 0, 0.5, 1]
    assert added.library_pose("turn 1").pose is pose


def test_library_poses_of_sliders_are_renamed_and_not_deleted():
    document = document_with(TURN)
    renamed = pose_commands.rename_pose(0, "left", "far left")(document)
    assert renamed.layers[0].slider("turn").poses[0].pose == "far left"
    with pytest.raises(LissomError, match="The slider 'turn' uses the pose 'left'"):
        pose_commands.delete_pose(0, "left")(document)


def test_sliders_come_back_from_a_file(tmp_path):
    document = keyed(
        (0, -1),
        (20, 1),
        sliders=(replace(TURN, spring=(2.0, 0.2)), replace(PAD, value=0.5 + 1j, delay=3)),
    )
    save_project(tmp_path / "sliders.lissom", document)
    layer = load_project(tmp_path / "sliders.lissom").layers[0]
    assert layer.sliders == document.layers[0].sliders
    assert layer.channels == document.layers[0].channels


def poses_at(*places):
    return tuple(SliderPose(at=complex(at), pose=None) for at in places)


BAD = {
    "no poses": ({"poses": ()}, "The slider 'turn' needs at least two poses, not 0."),
    "one pose": ({"poses": poses_at(0)}, "needs at least two poses, not 1."),
    "nine poses": ({"poses": poses_at(*range(9))}, "at most 8 poses in a row, not 9."),
    "one place": ({"poses": poses_at(0, 1, 1)}, "'turn' has two poses at 1; move or delete"),
    "nowhere": ({"poses": poses_at(0, np.nan)}, "a value must be at most 1,000,000, not nan"),
    "a hole": ({"poses": poses_at(0, 1, 1j)}, "no pose at (1, 1); its poses must fill a grid"),
    "no name": ({"name": " "}, "A slider needs a name."),
    "late": ({"delay": -1}, "delay of a slider must be from 0 to 999,999 frames, not -1."),
    "still": ({"spring": (2.0, 0.0)}, "The spring of the slider 'turn' needs a damping above 0."),
    "no swing": ({"spring": (0.0, 0.5)}, "The frequency of a spring must be above 0"),
    "turns": ({"poses": (SliderPose(at=0j, pose=None, turns=99), *poses_at(1))}, "at most 20"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_sliders_are_refused_by_their_names(case):
    changes, message = BAD[case]
    with pytest.raises(LissomError, match=says(message)):
        replace(TURN, **changes)


def test_layer_refuses_bad_sliders_and_values():
    with pytest.raises(LissomError, match="Two sliders have the name 'turn'"):
        document_with(TURN, TURN)
    lost = replace(TURN, poses=(SliderPose(at=0j, pose="lost"), *poses_at(1)))
    with pytest.raises(LissomError, match="The slider 'turn' has the pose 'lost', which is not"):
        document_with(lost)
    with pytest.raises(LissomError, match="value of a slider must be at most"):
        keyed((0, np.nan))

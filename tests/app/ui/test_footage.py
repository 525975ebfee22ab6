"""Footage in the window: added, shown in time, decoded ahead within limits, found again."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from footage_files import STEP, number_of, numbered_picture, write_numbered, write_video
from PIL import Image

from app.document import FOOTAGE_TIME, Channel, FootageTime, FrameRange, scene_commands
from app.editor.actions import editing, playback
from app.editor.actions.project_files import saving
from app.editor.actions.timing.channel_keys import insert_channel_key, set_channel_value
from app.editor.actions.updates.footage_jobs import DECODING
from app.editor.layering import footage
from app.editor.layering.deform_groups import bend_layers_as_one
from app.editor.layering.pictures import drop_files, replace_picture
from app.storage import copy_footage, load_project, open_footage

COUNT = 20


@pytest.fixture
def project(window, bent):
    window.act(editing.edit_document, scene_commands.set_frames(FrameRange(0, 40)))
    return bent


@pytest.fixture
def moving(window, project, tmp_path):
    """The bar with 20 numbered pictures in front, from frame 0 on."""
    window.session.settings.prepares_ahead = True
    playback.scrub(window.session, 0)
    window.act(footage.add_footage, write_numbered(tmp_path / "walk", range(COUNT)))
    window.settle()
    return project.document.layers[-1]


def notices(window):
    return [toast.text for toast in window.session.notices.toasts]


def shown(project, layer):
    """Return the number of the picture that the window shows of a layer."""
    pixels = project.footage_picture(project.document.layer(layer.id))
    return None if pixels is None else number_of(pixels)


def test_added_footage_shows_its_frame_wherever_the_playhead_goes(window, project, moving):
    assert moving.still
    assert moving.name == "walk"
    assert moving.keys_of(FOOTAGE_TIME) == (FOOTAGE_TIME.key(0, FootageTime()),)
    for frame in (5, 19, 3, 40, 0):
        playback.scrub(window.session, frame)
        window.frames(2)
        assert shown(project, moving) == min(frame, COUNT - 1)
    editing.undo(window.session)
    window.settle()
    assert moving.id not in [layer.id for layer in project.document.layers]


@pytest.mark.parametrize("frame", [0, 1, 9, 19])
@pytest.mark.usefixtures("moving")
def test_the_window_draws_the_frame(window, project, frame):
    playback.scrub(window.session, frame)
    window.settle()
    middle = window.point(complex(*project.document.canvas) / 2 + 3 + 4j)
    pixel = window.picture().getpixel((round(middle.x), round(middle.y)))
    assert abs(pixel[0] - STEP * frame) <= 2


def test_scrubbing_decodes_each_picture_once(window, project, moving):
    decoder = project.footage.decoder
    before = decoder.count
    for frame in [*range(41), *range(40, -1, -3)]:
        playback.scrub(window.session, frame)
        window.frames()
        assert shown(project, moving) == min(frame, COUNT - 1)
    window.settle()
    assert decoder.count == before


def test_a_picture_that_is_not_ready_comes_before_all_others(window, project, tmp_path):
    first = write_numbered(tmp_path / "walk", range(COUNT))
    window.session.settings.prepares_ahead = True
    playback.scrub(window.session, 0)
    before = project.footage.decoder.count
    with window.session.jobs.held(DECODING):
        window.act(footage.add_footage, first)
        window.until(lambda: len(project.document.layers) > 1)
        playback.scrub(window.session, 17)
        window.frames(2)
        layer = project.document.layers[-1]
        assert shown(project, layer) is None
    window.until(lambda: shown(project, layer) == 17)
    # The first job was for the place where the playhead had been.
    assert project.footage.decoder.count - before <= 2 + 4


def test_memory_is_bounded_and_the_needed_pictures_stay(window, project, tmp_path):
    random = np.random.default_rng(1)
    for number in range(30):
        # Noise cannot be packed.
        pixels = random.integers(0, 256, (24, 32, 4), dtype=np.uint8)
        Image.fromarray(pixels).save(tmp_path / f"a{number:02}.png")
    cache = project.footage
    cache.budget = 40_000
    window.session.settings.prepares_ahead = True
    playback.scrub(window.session, 0)
    window.act(footage.add_footage, tmp_path / "a00.png")
    window.settle()
    moving = project.document.layers[-1].footage
    for frame in (0, 29, 12):
        playback.scrub(window.session, frame)
        window.settle()
        assert 0 < cache.nbytes <= cache.budget
        assert not cache.lacks(moving, frame, 1)
        assert cache.nbytes == sum(each.nbytes for each in cache._packed[moving].values())


def test_video_is_decoded_from_its_key_pictures(window, project, tmp_path):
    window.session.settings.prepares_ahead = True
    playback.scrub(window.session, 0)
    before = project.footage.decoder.count
    window.act(drop_files, [write_video(tmp_path / "walk.mp4", COUNT, group=6)])
    window.settle()
    layer = project.document.layers[-1]
    assert layer.footage.fps == 24
    for frame in (19, 2, 11):
        playback.scrub(window.session, frame)
        window.frames()
        assert shown(project, layer) == frame
    # Pictures between a key picture and the one that is needed are decoded on the way.
    assert project.footage.decoder.count - before <= 2 * COUNT


def test_a_new_key_changes_nothing_until_its_values_change(window, project, moving):
    channel = Channel(FOOTAGE_TIME, moving.id)
    playback.scrub(window.session, 10)
    window.act(insert_channel_key, channel)
    keys = project.document.layer(moving.id).keys_of(FOOTAGE_TIME)
    assert [(key.frame, key.value.start) for key in keys] == [(0, 0), (10, 10)]
    window.act(set_channel_value, channel, replace(keys[1].value, speed=-2.0))
    seen = []
    for frame in range(8, 16):
        playback.scrub(window.session, frame)
        window.settle()
        seen.append(shown(project, moving))
    assert seen == [8, 9, 10, 8, 6, 4, 2, 0]
    assert all(before != after for before, after in pairwise(seen))


def test_reference_is_dimmed_locked_and_not_exported(window, project, tmp_path):
    first = write_numbered(tmp_path / "walk", range(3))
    footage.add_footage(window.session, first, is_reference=True)
    window.settle()
    layer = project.document.layers[-1]
    assert (layer.reference, layer.locked, layer.opacity) == (True, True, 0.5)
    assert layer not in project.document.exported_layers


def test_missing_footage_is_named_and_found_again(window, project, moving, tmp_path):
    (tmp_path / "walk").rename(tmp_path / "elsewhere")
    project.footage.forget(moving.footage)
    window.settle()
    (text,) = [text for text in notices(window) if "missing" in text]
    assert "walk_000.png" in text
    assert str(project.footage.errors[moving.footage]) in text
    window.act(footage.replace_footage, moving.id, tmp_path / "elsewhere" / "walk_004.png")
    window.settle()
    found = project.document.layer(moving.id)
    assert found.footage.folder == str(tmp_path / "elsewhere")
    assert found.keys_of(FOOTAGE_TIME) == moving.keys_of(FOOTAGE_TIME)
    playback.scrub(window.session, 6)
    window.settle()
    assert shown(project, moving) == 6


def test_reload_shows_the_new_picture(window, project, moving, tmp_path):
    playback.scrub(window.session, 3)
    window.settle()
    numbered_picture(15).save(tmp_path / "walk" / "walk_003.png")
    numbered_picture(COUNT).save(tmp_path / "walk" / f"walk_{COUNT:03}.png")
    window.act(footage.reload_footage, moving.id)
    window.settle()
    assert shown(project, moving) == 15
    assert project.document.layer(moving.id).footage.picture_count == COUNT + 1


def test_footage_of_another_size_is_refused(window, project, moving, tmp_path):
    other = write_numbered(tmp_path / "wide", range(2), size=(40, 24))
    window.act(footage.replace_footage, moving.id, other)
    window.settle()
    assert project.document.layer(moving.id).footage == moving.footage
    assert any("40 × 24 pixels" in text for text in notices(window))


def test_a_picture_replaces_footage(window, project, moving, tmp_path):
    numbered_picture(7).save(tmp_path / "cat.png")
    window.act(replace_picture, moving.id, tmp_path / "cat.png")
    window.settle()
    layer = project.document.layer(moving.id)
    assert layer.footage is None
    assert layer.keys_of(FOOTAGE_TIME) == ()


def test_dropped_numbered_pictures_may_become_footage(window, project, tmp_path):
    first = write_numbered(tmp_path / "walk", range(4))
    window.act(drop_files, [first, first.with_name("walk_001.png")])
    answers = dict(window.session.dialogs.current.answers)
    answers["Footage"].apply(window.session)
    window.settle()
    assert project.document.layers[-1].footage.picture_count == 4


def test_opened_video_is_a_scene_of_its_length(window, tmp_path):
    project = window.open(write_video(tmp_path / "walk.mp4", 12))
    assert project.document.frames == FrameRange(0, 11)
    assert project.document.fps == 24


def test_collected_footage_makes_the_project_complete(window, project, moving, tmp_path):
    home = tmp_path / "home"
    home.mkdir()
    saving.write_project(window.session, home / "bar.lissom", None)
    window.settle()
    window.act(footage.collect_footage)
    window.settle()
    layer = project.document.layer(moving.id)
    assert layer.footage.folder == str(home / "bar footage" / "walk_000")
    saving.write_project(window.session, home / "bar.lissom", None)
    window.settle()
    (tmp_path / "walk").rename(tmp_path / "gone")
    moved = home.rename(tmp_path / "moved")
    opened = load_project(moved / "bar.lissom").layers[-1].footage
    with open_footage(opened) as reader:
        assert number_of(reader.read(11)) == 11
    # Copies that are there already are used again.
    assert copy_footage(opened, moved / "bar footage") == opened


def test_a_damaged_picture_is_named_and_leaves_the_others(window, project, moving, tmp_path):
    (tmp_path / "walk" / "walk_003.png").write_bytes(b"no picture")
    project.footage.forget(moving.footage)
    window.settle()
    assert any("walk_003.png" in text for text in notices(window))
    assert moving.footage not in project.footage.errors
    for frame in (2, 4, 19):
        playback.scrub(window.session, frame)
        window.settle()
        assert shown(project, moving) == frame


def test_a_member_of_a_deform_group_shows_footage(window, project, moving):
    assert project.document.layer(moving.id).still
    members = [layer.id for layer in project.document.layers]
    window.act(bend_layers_as_one, *members)
    window.settle()
    layer = project.document.layer(moving.id)
    assert layer.deform_group is not None
    assert layer.footage == moving.footage
    playback.scrub(window.session, 7)
    window.settle()
    assert shown(project, layer) == 7


def test_dropped_folder_of_numbered_pictures_becomes_footage(window, project, tmp_path):
    first = write_numbered(tmp_path / "walk", range(4))
    window.act(drop_files, [first.parent])
    window.settle()
    assert project.document.layers[-1].footage.picture_count == 4
    (tmp_path / "empty").mkdir()
    window.act(drop_files, [tmp_path / "empty"])
    window.settle()
    assert any("is a folder" in text for text in notices(window))

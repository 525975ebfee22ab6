"""Sounds in the window: added, moved, cut, heard, and leading the picture."""

from dataclasses import replace

import numpy as np
import pytest
from harness import FRAME
from imgui_bundle import ImVec2
from sound_devices import PERIOD, HandDevice
from sound_files import sine, sound, wav

from app.document import (
    VOLUME,
    Channel,
    FrameRange,
    layer_commands,
    scene_commands,
    sound_commands,
    switch_group_commands,
)
from app.editor.actions import editing, playback, viewing
from app.editor.actions.timing import keys, mouths, sounds
from app.editor.layering.pictures import drop_files
from app.errors import LissomError
from app.sound import SoundMix, SoundPlayer
from app.sound.player import LOST

LAST = 96
TALK = wav(sine(2.0))


@pytest.fixture
def device(window):
    device = HandDevice()
    window.session.player = SoundPlayer(window.clock, lambda: device)
    return device


@pytest.fixture
def project(window, bent):
    window.act(editing.edit_document, scene_commands.set_frames(FrameRange(0, LAST)))
    return bent


@pytest.fixture
def spoken(window, project):
    """The bar with a sound of two seconds from frame 12 on."""
    talk = sound(TALK, start=12)
    window.act(editing.edit_document, sound_commands.add_sound(talk))
    window.settle()
    return project


def turn(window, device, seconds):
    """Let window and device go on together."""
    for _ in range(round(seconds / FRAME)):
        device.turn(FRAME)
        window.frames()


def now(window, project):
    return playback.current_frame(window.session, project)


def notices(window):
    return [toast.text for toast in window.session.notices.toasts]


def test_dropped_sound_begins_at_the_playhead(window, project, tmp_path):
    path = tmp_path / "hello.wav"
    path.write_bytes(TALK)
    playback.scrub(window.session, 7)
    window.act(drop_files, [path])
    window.settle()
    (talk,) = project.document.sounds
    assert (talk.name, talk.start, talk.length) == ("hello", 7, 2)
    assert talk.file.data == TALK
    assert notices(window) == ["Added hello.wav: 2.0 s. The project keeps its 192 KB."]
    assert talk.file.sha256 in project.measured.waveforms
    editing.undo(window.session)
    assert project.document.sounds == ()


def test_what_is_no_sound_is_refused_and_nothing_changes(window, project, tmp_path):
    path, before = tmp_path / "diary.wav", project.document
    path.write_text("Dear diary")
    window.act(sounds.add_sounds, [path])
    window.settle()
    (notice,) = notices(window)
    assert notice.startswith("diary.wav cannot be added: diary.wav is not a sound.")
    assert project.document is before


class Lane:
    """The lane of the sound under the robot's pointer."""

    def __init__(self, robot):
        self.robot = robot
        robot.set_ref("###Timeline")
        self.step = None

    def drag(self, part, by, *, per_frame):
        name = f"**/sound talk/{part}"
        at = self.robot.item_info(name).rect_full.get_center()
        self.robot.mouse_move(name)
        self.robot.mouse_down(0)
        for each in (by / 2, by):
            self.robot.mouse_move_to_pos(ImVec2(at.x + each * per_frame, at.y))
            self.robot.yield_(2)
        self.robot.mouse_up(0)

    @property
    def width(self):
        left = self.robot.item_info("**/sound talk/begin").rect_full
        right = self.robot.item_info("**/sound talk/end").rect_full
        return right.max.x - left.min.x


def test_sound_is_dragged_and_cut_in_whole_frames(window, spoken):
    before = spoken.document

    def play(robot):
        lane = Lane(robot)
        per_frame = lane.width / 48
        lane.drag("whole", 6, per_frame=per_frame)
        (talk,) = spoken.document.sounds
        assert (talk.start, talk.skip, talk.length) == (18, 0, 2)
        lane.drag("begin", 12, per_frame=per_frame)
        (talk,) = spoken.document.sounds
        assert (talk.start, talk.skip, talk.length) == (30, 0.5, 1.5)
        lane.drag("end", -12, per_frame=per_frame)
        (talk,) = spoken.document.sounds
        assert (talk.start, talk.skip, talk.length) == (30, 0.5, 1.0)
        # Beyond the file there is nothing to be heard.
        lane.drag("end", 90, per_frame=per_frame)
        assert spoken.document.sounds[0].length == 1.5

    window.run(play)
    for _ in range(4):
        editing.undo(window.session)
    assert spoken.document is before


def test_sound_leads_the_picture_whatever_the_devices_clock(window, spoken):
    device = HandDevice(pace=1.01)
    window.session.player = SoundPlayer(window.clock, lambda: device)
    playback.scrub(window.session, 12)
    playback.toggle_play(window.session)
    for _ in range(30):
        turn(window, device, 0.1)
        if spoken.timeline.playhead.since is None:
            break
        # The ear is somewhere within the last period that has begun.
        heard = len(device.heard) * PERIOD / device.rate - device.latency
        least, most = max(heard - PERIOD / device.rate, 0), max(heard, 0)
        assert 24 * (least - FRAME) - 1 < now(window, spoken) - 12 <= 24 * most
    mix = SoundMix(spoken.document, device.rate)
    expected = mix.read(24_000, len(device.samples))
    assert np.array_equal(device.samples[400:], expected[400:])


def test_late_device_holds_the_picture_until_it_goes_on(window, spoken, device):
    playback.toggle_play(window.session)
    turn(window, device, 1.0)
    before = now(window, spoken)
    window.frames(round(0.5 / FRAME))
    assert now(window, spoken) <= before + 3
    turn(window, device, 0.5)
    assert now(window, spoken) > before + 5


def test_loop_of_the_preview_keeps_its_beat(window, spoken, device):
    window.act(keys.toggle_loop)
    window.act(editing.edit_document, scene_commands.set_preview(FrameRange(12, 23)))
    playback.scrub(window.session, 12)
    playback.toggle_play(window.session)
    turn(window, device, 2.3)
    mix = SoundMix(spoken.document, device.rate)
    period = 12 * 2_000
    for each in range(1, 4):
        part = device.samples[each * period + 400 : (each + 1) * period - 400]
        assert np.array_equal(part, mix.read(24_400, len(part)))
    heard = len(device.heard) * PERIOD / device.rate - device.latency
    assert abs(now(window, spoken) - 12 - (heard * 24) % 12) < 2


def test_machine_without_a_device_says_so_once_and_plays(window, spoken):
    def refuse():
        raise LissomError("there is none")

    window.session.player = SoundPlayer(window.clock, refuse)
    for _ in range(2):
        playback.scrub(window.session, 0)
        playback.toggle_play(window.session)
        window.frames(30)
        assert now(window, spoken) >= 11
    text = "Sounds cannot be heard here: there is none. Exports still contain them."
    assert notices(window) == [text]


def test_device_that_is_unplugged_lets_the_picture_go_on(window, spoken, device):
    playback.toggle_play(window.session)
    turn(window, device, 0.2)
    window.frames(round(1.1 * LOST / FRAME))
    assert window.session.player.failure is not None
    before = now(window, spoken)
    window.frames(30)
    assert now(window, spoken) >= before + 11
    assert len(notices(window)) == 1


def test_scrubbing_lets_the_frame_under_the_playhead_be_heard(window, spoken, device):
    def play(robot):
        robot.set_ref("###Timeline")
        robot.mouse_move("**/ruler")
        robot.mouse_down(0)
        at = robot.item_info("**/sound talk/whole").rect_full.get_center()
        robot.mouse_move_to_pos(ImVec2(at.x, robot.item_info("**/ruler").rect_full.get_center().y))
        robot.yield_(2)
        robot.mouse_up(0)

    window.run(play)
    device.turn(0.2)
    frame = now(window, spoken)
    assert 12 < frame < 60
    heard = device.samples[400:2_000]
    mix = SoundMix(spoken.document, device.rate)
    assert np.array_equal(heard, mix.read(mix.sample_at(frame) + 400, 1_600))
    assert not device.samples[4_000:].any()


def test_marker_is_at_the_frame_that_is_heard(window, spoken, device):
    playback.scrub(window.session, 0)
    playback.toggle_play(window.session)
    turn(window, device, 1.2)
    window.act(keys.add_marker_at_playhead)
    heard = len(device.heard) * PERIOD / device.rate - device.latency
    (marker,) = spoken.document.markers
    assert 24 * (heard - PERIOD / device.rate - FRAME) - 1 < marker.frame <= 24 * heard


def test_mute_button_mutes_the_sound(window, spoken):
    def play(robot):
        robot.set_ref("###Timeline")
        robot.item_click("**/lane volume None talk/mute")

    window.run(play)
    assert spoken.document.sounds[0].muted
    window.run(play)
    assert not spoken.document.sounds[0].muted


def test_missing_file_is_found_again(window, spoken, tmp_path):
    talk = spoken.document.sounds[0]
    lost = replace(talk, file=replace(talk.file, data=None))
    window.act(editing.edit_document, sound_commands.delete_sound("talk"))
    window.act(editing.edit_document, sound_commands.add_sound(lost))
    path = tmp_path / "moved.wav"
    path.write_bytes(TALK)
    window.act(sounds.find_sound_file, "talk", path)
    window.settle()
    (found,) = spoken.document.sounds
    assert found.file.data == TALK
    assert notices(window) == []


def test_tab_sets_volume_time_and_name(window, spoken):
    window.act(viewing.show_tab, "Animate")
    window.frames(3)

    def play(robot):
        robot.set_ref("//###Animate")
        robot.item_input_value("**/##start", 24.0)
        robot.item_click("**/key volume")
        robot.item_input_value("**/##from", 0.5)
        robot.item_input_value("**/##name", "hello")

    window.run(play)
    (talk,) = spoken.document.sounds
    assert (talk.name, talk.start, talk.skip, talk.length) == ("hello", 36, 0.5, 1.5)
    assert [key.value for key in talk.keys] == [1.0]
    assert spoken.selection.channel == Channel(VOLUME, part="hello")


@pytest.fixture
def mouthed(window, spoken):
    """The bar with a sound, and a switch of three copies of it."""
    for _ in range(2):
        window.act(editing.edit_layer, layer_commands.duplicate_layer)
    window.settle()
    names = ("closed", "ah", "oh")
    ids = [layer.id for layer in spoken.document.layers]
    for identity, name in zip(ids, names, strict=True):
        window.act(editing.edit_document, layer_commands.rename_layer(identity, name))
    window.act(editing.edit_document, switch_group_commands.create_switch_group("mouth", ids))
    return spoken


def shown_mouths(project):
    document = project.document
    (switch,) = document.switch_groups
    return [(key.frame, document.layer(key.value).name) for key in switch.keys]


def test_cues_become_keys_in_one_step_and_their_table_is_edited(window, mouthed, tmp_path):
    before, path = mouthed.document, tmp_path / "talk.tsv"
    path.write_text("0.00\tX\n0.50\tD\n1.00\tE\n1.50\tX\n")
    window.act(mouths.read_cues, "talk", "mouth", path)
    window.settle()
    # The switch was made with the front layer visible.
    keyed = [(0, "oh"), (12, "closed"), (24, "ah"), (36, "oh"), (48, "closed")]
    assert shown_mouths(mouthed) == keyed
    assert notices(window)[-1] == "4 keys in mouth."
    ah = next(layer.id for layer in mouthed.document.layers if layer.name == "ah")
    window.act(viewing.show_tab, "Animate")
    window.resize((1280, 1000))

    def choose(robot):
        robot.set_ref("//###Animate")
        robot.item_click("//###Animate/talk/##drawing of E")
        robot.item_click("//$FOCUSED/ah")

    window.run(choose)
    window.resize((1280, 800))
    assert shown_mouths(mouthed) == [(0, "oh"), (12, "closed"), (24, "ah"), (48, "closed")]
    assert dict(mouthed.document.sounds[0].mouths.drawings)["E"] == ah
    editing.undo(window.session)
    assert shown_mouths(mouthed) == keyed
    editing.undo(window.session)
    assert mouthed.document is before


def test_wrong_cues_change_nothing(window, mouthed, tmp_path):
    before, path = mouthed.document, tmp_path / "talk.dat"
    path.write_text("Dear diary")
    window.act(mouths.read_cues, "talk", "mouth", path)
    window.settle()
    assert "talk.dat holds no cues" in notices(window)[-1]
    assert mouthed.document is before


def test_switch_opens_with_the_volume(window, mouthed):
    closed = mouthed.document.switch_groups[0].members[0]
    window.act(editing.edit_document, switch_group_commands.choose_at(closed, 0))
    window.act(viewing.show_tab, "Animate")
    window.frames(3)

    def play(robot):
        robot.set_ref("//###Animate")
        robot.item_click("**/###volume")

    window.run(play)
    document = mouthed.document
    assert shown_mouths(mouthed) == [(0, "closed"), (12, "oh")]
    assert {cue.name for cue in document.sounds[0].mouths.cues} <= {"1", "2", "3"}


def test_handle_opens_with_the_volume(window, spoken):
    handle = spoken.layer.handles[1]
    editing.select_handles(window.session, frozenset({handle.id}))
    (target,) = mouths.list_volume_targets(spoken)
    assert target.label == f"Handle {handle.name} of bar"
    window.act(mouths.set_volume_opening, 12j)
    window.act(mouths.open_with_volume, "talk", target)
    window.settle()
    (track,) = spoken.layer.tracks
    assert track.handles == (handle.id,)
    places = [key.place for key in track.keys]
    assert places[0] == places[-1] == 0
    assert max(place.imag for place in places) == pytest.approx(12, abs=0.5)
    first, last = track.keys[0].frame, track.keys[-1].frame
    assert (first, last) == (12, 60)
    # Again, at another place: the keys of before are gone.
    window.act(editing.edit_document, sound_commands.move_sound("talk", 20))
    window.act(mouths.open_with_volume, "talk", target)
    (track,) = spoken.layer.tracks
    assert track.keys[0].frame == 20


def test_export_tab_leaves_the_sounds_out(window, spoken):
    window.act(viewing.show_tab, "Export")
    format_ = replace(spoken.document.export, format="mp4", background="#ffffff")
    window.act(editing.edit_document, scene_commands.set_export(format_))
    window.resize((1280, 1000))

    def play(robot):
        robot.set_ref("//###Export")
        robot.item_click("**/sounds/###none")

    window.run(play)
    window.resize((1280, 800))
    assert not spoken.document.export.sound

"""Handles that a hand carries along tracks, and drags that are recorded."""

from dataclasses import replace

import numpy as np
import pytest
from bars import BENT, HALF, LAST, bend_bar
from harness import FRAME, MOST_FRAMES
from numpy.testing import assert_allclose

from app.document import (
    TRANSFORM,
    Channel,
    Keyframe,
    Playhead,
    Target,
    Transform,
    channel_commands,
    clip_of,
    pose_channel,
    track_at,
    transform_at,
)
from app.document.channels.tracks import Track, TrackKey
from app.document.commands import (
    scene_commands,
)
from app.document.commands.keys import (
    track_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import remove_handles
from app.editor.actions.posing.pose_drag import release_drag, set_targets
from app.editor.actions.timing import tracks
from app.editor.actions.tracking.recording import (
    drag_recorded_handle,
    smooth_recording,
    start_recording,
    stop_recording,
)
from app.editor.actions.tracking.smoothing import fit_recording
from app.editor.actions.tracking.track_space import track_target
from app.editor.actions.updates.correction_jobs import COMPLAINT
from app.editor.work.track_keys import RecordedSample, Recording
from app.motion import Animation
from app.ui.bars.status import describe_pose_limit
from app.ui.viewport.marks import find_off_target
from engine.errors import EngineError

END = 1  # the handle near the right end
EARLIER, LATER = 2, 6  # frames between the keys, before and after half way
NEAR = 0.3  # pixels that a tracked handle may miss
PIXEL = 2.0  # of the picture: where it is pressed and let go, to whole ones of the screen


def place_of(project, handle=END):
    """Return where a handle is shown."""
    index = [each.id for each in project.layer.handles].index(handle)
    return complex(project.layer_runtime.shown.handle_positions[index])


def ground(project, frame, handle=END):
    index = [each.id for each in project.layer.handles].index(handle)
    found = project.layer_runtime.corrected.ground(frame)
    return complex(found.positions[index]), complex(found.rotations[index])


def drag(window, start, end, *, then=lambda robot: robot.mouse_up(0)):
    def act(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        for share in (0.3, 0.6, 1.0):
            robot.mouse_move_to_pos(window.point(start + share * (end - start)))
        then(robot)

    window.run(act)
    window.settle()


def key_end(window):
    """Key the handle at the bent bar's end alone, half way to its key, and choose that row."""
    window.again(bend_bar, LAST)
    playback.scrub(window.session, HALF)
    window.settle()
    tracks.key_handles_at_playhead(window.session, (END,))
    window.settle()


@pytest.fixture
def bent(window):
    """The bent bar, and as much time as a hand takes for a circle."""
    return window.again(bend_bar, BENT)


@pytest.fixture
def brief(window):
    """The same in few frames."""
    return window.again(bend_bar, LAST)


@pytest.fixture
def keyed(window):
    """The same, with the handle at its end keyed alone half way, and its row chosen."""
    return window.again(key_end)


def test_a_drag_keys_the_handle_of_a_chosen_row_alone(window, keyed):
    before, poses, known = keyed.document, keyed.layer.keys, keyed.layer_runtime.corrected.ground(0)
    start, way = place_of(keyed), 20 + 30j
    drag(window, start, start + way)
    (track,) = keyed.layer.tracks
    assert [key.frame for key in track.keys] == [HALF]
    still, turn = ground(keyed, HALF)
    # The offset is in the frame that turns with the shape.
    assert_allclose(track.keys[0].place, (start + way - still) * np.conj(turn), atol=PIXEL)
    assert abs(turn - 1) > 0.05
    assert abs(place_of(keyed) - (start + way)) < PIXEL
    assert keyed.layer.keys == poses, "the pose stays"
    assert keyed.layer_runtime.corrected.ground(0) is known, "and what is known of it"
    assert keyed.layer_runtime.shown.is_current
    keyed.history.undo()
    assert keyed.document is before, "one drag is one step"


def test_a_drag_at_another_frame_inserts_a_key(window, keyed):
    playback.scrub(window.session, LATER)
    window.settle()
    start = place_of(keyed)
    drag(window, start, start - 25j)
    (track,) = keyed.layer.tracks
    assert [key.frame for key in track.keys] == [HALF, LATER]
    assert track.keys[0].place == 0
    assert abs(place_of(keyed) - (start - 25j)) < PIXEL


def test_the_shape_follows_while_the_hand_moves_and_escape_takes_it_back(window, keyed):
    before, start = keyed.document, place_of(keyed)
    seen = []

    def then(robot):
        while not keyed.layer_runtime.shown.is_current:
            window.session.jobs.wait_until_idle()
            robot.yield_()
        seen.append(place_of(keyed))
        robot.key_press(int(window.Key.escape))
        robot.mouse_up(0)

    drag(window, start, start + 40j, then=then)
    assert abs(seen[0] - (start + 40j)) < PIXEL
    assert keyed.document is before
    assert abs(place_of(keyed) - start) < NEAR


def test_a_planted_track_has_places_of_the_picture(window, keyed):
    places = [place_of(keyed)]
    keyed.history.do(track_commands.plant_track(keyed.selection.active, END, places, planted=True))
    window.settle()
    start = place_of(keyed)
    drag(window, start, start + 15 + 10j)
    (track,) = keyed.layer.tracks
    assert_allclose(track.keys[0].place, start + 15 + 10j, atol=PIXEL)


def test_targets_out_of_reach_stay_the_targets(window, keyed):
    start = place_of(keyed)
    goal = start + 1.5 * keyed.document.canvas[0]
    drag(window, start, goal)
    shown = keyed.layer_runtime.shown
    targets = shown.correction.targets
    assert_allclose(targets[END], goal, atol=PIXEL)
    assert abs(place_of(keyed) - goal) > 20
    assert shown.correction.is_limited
    assert describe_pose_limit(window.session).startswith("At its limit · handle 2 is ")
    assert find_off_target(keyed, shown)[END] == targets[END], "a dashed line leads there"


def turn_by(window, project, angle, *, then=lambda robot: robot.mouse_up(0)):
    """Turn the selected handle by its ring."""
    editing.select_handles(window.session, frozenset({END}))
    window.settle()
    centre, arm = place_of(project), 1j * window.ring(project)

    def act(robot):
        robot.mouse_move_to_pos(window.point(centre + arm))
        robot.mouse_down(0)
        for share in (0.3, 0.6, 1.0):
            robot.mouse_move_to_pos(window.point(centre + arm * np.exp(1j * share * angle)))
        then(robot)

    window.run(act)
    window.settle()


def turned(project):
    index = [each.id for each in project.layer.handles].index(END)
    return project.layer_runtime.shown.handle_rotations[index]


def test_the_ring_turns_the_track_of_a_chosen_row_and_not_the_pose(window, keyed):
    keys = tuple(TrackKey(frame=f, place=p) for f, p in ((EARLIER, 0), (HALF, 8j), (LATER, 0)))
    keyed.history.do(
        track_commands.put_track(keyed.selection.active, Track(handles=(END,), keys=keys))
    )
    window.settle()
    before, poses, shown_before = keyed.document, keyed.layer.keys, turned(keyed)
    turn_by(window, keyed, 0.5)
    (track,) = keyed.layer.tracks
    assert keyed.layer.keys == poses, "the pose stays"
    assert track.keys_rotation, "what turned nothing does from now on"
    assert any(toast.topic == "turning" for toast in window.session.notices.toasts)
    assert [(key.frame, key.place) for key in track.keys] == [(EARLIER, 0), (HALF, 8j), (LATER, 0)]
    assert [key.turn for key in track.keys[::2]] == [0, 0]
    still = np.angle(ground(keyed, HALF)[1])
    assert abs(track.keys[1].turn + still - (shown_before + 0.5)) < 0.05
    assert abs(turned(keyed) - (shown_before + 0.5)) < 0.05
    keyed.history.undo()
    assert keyed.document is before, "one drag is one step"


def test_the_ring_inserts_a_key_that_moves_nothing_and_turns_on_from_there(window, keyed):
    keys = tuple(TrackKey(frame=f, place=p, turn=0.3) for f, p in ((EARLIER, 0), (LATER, 8j)))
    track = Track(handles=(END,), keys=keys, keys_rotation=True)
    keyed.history.do(track_commands.put_track(keyed.selection.active, track))
    window.settle()
    at = track_at(track, keyed.clip, HALF)
    turn_by(window, keyed, -0.4)
    (track,) = keyed.layer.tracks
    assert [key.frame for key in track.keys] == [EARLIER, HALF, LATER]
    assert track.keys[1].place == at.place
    # The pointer goes by whole pixels.
    assert abs(track.keys[1].turn - (at.turn - 0.4)) < 0.05
    assert (
        window.session.notices.toasts == [] or window.session.notices.toasts[-1].topic != "turning"
    )


def test_escape_takes_a_turn_of_a_track_back(window, keyed):
    before = keyed.document

    def then(robot):
        robot.key_press(int(window.Key.escape))
        robot.mouse_up(0)

    turn_by(window, keyed, 0.5, then=then)
    assert keyed.document is before
    assert not keyed.pending.changes


def test_the_ring_turns_the_pose_where_no_row_of_a_track_is_chosen(window, keyed):
    keyed.selection.select_channel(None)
    window.settle()
    tracked, poses = keyed.layer.tracks, keyed.layer.keys
    playback.scrub(window.session, LAST)
    window.settle()
    turn_by(window, keyed, 0.4)
    assert keyed.layer.tracks == tracked
    assert keyed.layer.keys != poses


def offset_by(window, project, offset, frames):
    """Give the handle at the end a track with an offset, whose row is not chosen."""
    keys = tuple(TrackKey(frame=frame, place=offset) for frame in frames)
    track = Track(handles=(END,), keys=keys)
    project.history.do(track_commands.put_track(project.selection.active, track))
    project.selection.select_channel(None)
    window.settle()


@pytest.mark.parametrize("auto_key", [True, False])
@pytest.mark.usefixtures("everything")
def test_a_pose_has_what_a_track_adds_on_it_and_not_in_it(window, brief, auto_key):
    window.session.settings.prefer(auto_key=auto_key)
    offset_by(window, brief, 30j, (EARLIER, HALF, LATER))
    playback.scrub(window.session, HALF)
    window.settle()
    still, turn = ground(brief, HALF)
    shown_at, other = place_of(brief), place_of(brief, 0)
    assert abs(shown_at - still - 30j * turn) < NEAR
    seen = []

    def then(robot):
        for _ in range(8):
            seen.append(place_of(brief))
            robot.yield_()
        robot.mouse_up(0)

    drag(window, other, other + 12j, then=then)
    assert max(abs(place - shown_at) for place in seen) < 4, "nothing pops"
    pose = brief.unkeyed_pose or brief.layer.key(HALF).pose
    assert (brief.unkeyed_pose is None) == auto_key
    position = brief.layer.handle(END).position
    own = complex(brief.layer.map_of(pose)(np.array([position]))[0])
    assert abs(own - still) < 6, "the pose is where the body has the handle"
    assert abs(place_of(brief) - shown_at) < 6


def test_a_key_of_a_path_is_dragged_where_it_is_seen(window, keyed):
    playback.scrub(window.session, 0)
    window.settle()
    still, turn = ground(keyed, HALF)
    before, way = keyed.document, 40j
    drag(window, still, still + way)
    (track,) = keyed.layer.tracks
    assert [key.frame for key in track.keys] == [HALF]
    assert_allclose(track.keys[0].place, way * np.conj(turn), atol=PIXEL)
    assert playback.current_frame(window.session, keyed) == HALF
    keyed.history.undo()
    assert keyed.document is before


def record(window, project, ways, *, until=None, handle=END):
    """Press R, take a handle, and drag it along."""
    start = place_of(project, handle)

    def act(robot):
        robot.key_press(int(window.Key.r))
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        for way in ways:
            robot.mouse_move_to_pos(window.point(start + way))
        (until or (lambda robot: robot.mouse_up(0)))(robot)

    window.run(act)
    window.settle()
    return start


CIRCLE = 25 * (np.exp(2j * np.pi * np.arange(25) / 24) - 1)
ARC = CIRCLE[:6]


def test_a_drag_is_recorded_while_it_plays_and_fitted_by_few_keys(window, bent):
    playback.scrub(window.session, 0)
    window.settle()
    before = bent.document
    record(window, bent, CIRCLE)
    take = bent.timeline.recording
    assert take is not None
    assert take.is_over
    assert bent.timeline.playhead.since is None
    assert playback.current_frame(window.session, bent) == 0, "the playhead is where that began"
    (track,) = bent.layer.tracks
    frames = [key.frame for key in track.keys]
    assert frames[0] == 0
    assert frames[-1] == int(take.samples[-1].time + 1e-6) > 10
    assert len(frames) < frames[-1] / 1.5
    # The motion is near what the hand did.
    for sample in take.samples:
        if sample.time == int(sample.time):
            target = track_target(bent, track, int(sample.time))
            assert abs(target - sample.place) < 4
    few = len(frames)
    smooth_recording(window.session, 0.0)
    many = len(bent.layer.tracks[0].keys)
    smooth_recording(window.session, 1.0)
    fewest = len(bent.layer.tracks[0].keys)
    assert many > few >= fewest
    window.run(lambda robot: robot.item_click("**/Keep"))
    assert bent.timeline.recording is None
    assert bent.selected_track == END
    bent.history.undo()
    assert bent.document is before, "one take is one step"


def test_a_recording_is_as_smooth_as_the_hand_was_on_the_screen(window, bent):
    """A picture that is seen at a quarter of the size trembles by four times as many pixels."""
    playback.scrub(window.session, 0)
    window.settle()
    scale = bent.view_on(window.session.display.screen).scale
    record(window, bent, CIRCLE)
    take = bent.timeline.recording
    assert take.scale == scale
    keys = {}
    for factor in (0.1, 1.0, 10.0):
        take.scale = factor * scale
        smooth_recording(window.session, 0.0)
        keys[factor] = len(bent.layer.track_of(END).keys)
    assert keys[0.1] < keys[1.0] <= keys[10.0]


def test_smoothing_is_even_over_its_range():
    """A hand that trembles and is read at 20 Hz, for a hundred frames."""
    times = np.arange(100.0)
    way = 120 * np.exp(2j * np.pi * times / 40) + 40 * np.exp(2j * np.pi * times / 11)
    read = np.floor(times * 20 / 24) * 24 / 20
    values = (np.interp(read, times, way.real) + 1j * np.interp(read, times, way.imag)).tolist()
    samples = [RecordedSample(time, value) for time, value in zip(times, values, strict=True)]
    take = Recording(
        layer=0,
        handle=0,
        gesture=object(),
        playhead=Playhead(),
        last=100,
        speed=1.0,
        place=0j,
        scale=1.0,
        smoothing=0.0,
        samples=samples,
    )
    counts = []
    for share in np.linspace(0, 1, 6):
        take.smoothing = share
        counts.append(len(fit_recording(take, values, 100)))
    assert counts[0] > 45
    assert counts[-1] <= 10
    falls = np.array(counts[1:]) / counts[:-1]
    assert (falls < 0.85).all(), counts
    assert (falls > 0.45).all(), counts


def test_a_take_is_done_again_or_given_up(window, brief):
    playback.scrub(window.session, 0)
    window.settle()
    before = brief.document
    record(window, brief, ARC)
    assert brief.layer.tracks
    window.run(lambda robot: robot.item_click("**/Record again"))
    assert brief.document is before
    assert window.session.tools.mode == "record"
    window.run(lambda robot: robot.key_press(int(window.Key.escape)))
    assert window.session.tools.mode != "record"
    record(window, brief, ARC)
    assert brief.layer.tracks
    window.run(lambda robot: robot.key_press(int(window.Key.escape)))
    assert brief.document is before


def test_escape_ends_a_recording_and_takes_it_back(window, brief):
    playback.scrub(window.session, 0)
    window.settle()
    before = brief.document

    def until(robot):
        robot.key_press(int(window.Key.escape))
        robot.mouse_up(0)

    record(window, brief, ARC, until=until)
    assert brief.document is before
    assert brief.timeline.recording is None
    assert brief.timeline.playhead.since is None
    assert playback.current_frame(window.session, brief) == 0


def test_the_end_of_the_range_ends_a_recording_and_other_keys_stay(window, brief):
    offset_by(window, brief, 10j, (1, LATER))
    last = brief.document.frames.last
    playback.scrub(window.session, last - 4)
    window.settle()
    taken = [key for key in brief.layer.tracks[0].keys if key.frame == 1]
    record(window, brief, CIRCLE)
    assert brief.timeline.recording.is_over
    (track,) = brief.layer.tracks
    frames = [key.frame for key in track.keys]
    assert track.keys[0] == taken[0]
    assert frames[-1] == last
    assert window.session.tools.active_tool is None
    assert brief.timeline.playhead.speed == 1.0


def test_in_a_loop_a_recording_goes_on_over_the_seam_at_most_once_round(window, brief):
    brief.history.do(scene_commands.set_loop(loop=True))
    playback.scrub(window.session, 5)
    window.settle()
    record(window, brief, CIRCLE)
    take = brief.timeline.recording
    assert take.is_over
    assert take.samples[-1].time == 5 + LAST
    (track,) = brief.layer.tracks
    frames = [key.frame for key in track.keys]
    assert frames[0] == 0
    assert frames[-1] == LAST
    assert abs(track.keys[0].place - track.keys[-1].place) < 1e-9, "it comes round"


@pytest.mark.parametrize("is_over", [False, True])
def test_deleting_a_handle_ends_its_recording(window, brief, is_over):
    session, place = window.session, complex(brief.layer_runtime.shown.handle_positions[-1])
    with session.jobs.held():
        start_recording(session, END, place, gesture=object())
        window.clock.now += 0.2
        window.frames(3)
        if is_over:
            stop_recording(session)
        window.act(remove_handles, frozenset({END}))
        window.frames(2)
        assert brief.timeline.recording is None
        assert END not in [handle.id for handle in brief.layer.handles]
        assert not [toast for toast in session.notices.toasts if toast.details]


def test_a_click_records_nothing(window, brief):
    before = brief.document
    record(window, brief, [])
    assert brief.document is before
    assert brief.timeline.recording is None
    assert brief.timeline.playhead.since is None


HOP = 30j  # by how much the body goes up


def hop_by_keys(project):
    """Let the whole body hop by the keys of its poses."""
    layer = project.layer
    rest = layer.keys[0].pose
    targets = {i: replace(each, position=each.position + HOP) for i, each in rest.targets.items()}
    up = replace(rest, phi=rest.phi + HOP, targets=targets)
    keys = tuple(
        Keyframe(frame=frame, pose=pose) for frame, pose in ((0, rest), (HALF, up), (LAST, rest))
    )
    project.history.do(channel_commands.insert_keys({pose_channel(layer.id): keys}))


def hop_as_a_layer(project):
    """Let the layer hop, as it is."""
    for frame, shift in ((0, 0j), (HALF, HOP), (LAST, 0j)):
        project.history.do(
            channel_commands.set_key(
                Channel(TRANSFORM, project.selection.active), frame, Transform(shift, 0.0)
            )
        )


def in_scene(window, project, frames):
    """Return where the handle at the end is shown in the scene at some frames."""
    seen = []
    for frame in frames:
        playback.scrub(window.session, frame)
        window.settle()
        seen.append(
            complex(project.layer_runtime.shown.placement.apply(np.array([place_of(project)]))[0])
        )
    return np.array(seen)


@pytest.mark.parametrize("hop", [hop_by_keys, hop_as_a_layer])
def test_a_still_pointer_over_a_hopping_body_records_a_still_handle(window, brief, hop):
    hop(brief)
    playback.scrub(window.session, 0)
    window.settle()
    (start,) = in_scene(window, brief, [0])

    def until(robot):
        while brief.timeline.recording is None or brief.timeline.recording.samples[-1:] < [
            (LATER,)
        ]:
            window.session.jobs.wait_until_idle()
            robot.yield_()
        robot.mouse_up(0)

    record(window, brief, [], until=until)
    smooth_recording(window.session, 0.0)
    assert brief.layer.track_of(END).keys[-1].frame == LATER
    places = in_scene(window, brief, range(1, LATER))
    assert np.abs(places - start).max() < 2
    assert abs(places[HALF - 1] - start) < 1


@pytest.mark.parametrize("hop", [hop_by_keys, hop_as_a_layer])
def test_a_pointer_that_goes_with_the_body_changes_no_shape(window, brief, hop):
    hop(brief)
    playback.scrub(window.session, 0)
    window.settle()
    session, document = window.session, brief.document
    point = np.array([brief.layer.handle(END).position])
    body = Animation(clip_of(document, brief.selection.active), points=point)

    def place():
        """Return where in the scene the body has the handle, when the next picture is drawn."""
        frame = min((session.clock() + FRAME - begun) * document.fps, LAST)
        placement = transform_at(document, document.layers[0], frame)
        return complex(placement.apply(body.positions(frame))[0])

    begun = session.clock()
    start_recording(session, END, place(), gesture=object())
    while not brief.timeline.recording.is_over:
        drag_recorded_handle(session, place())
        window.frames()
    window.settle()
    smooth_recording(session, 0.0)
    (track,) = brief.layer.tracks
    # The first key is before the first sample.
    places = [key.place for key in track.keys[1:]]
    assert np.abs(places).max() < 1.0, "it speeds up between frames"


def test_passes_add_up_and_undo_takes_back_the_last(window, brief):
    playback.scrub(window.session, 0)
    window.settle()
    record(window, brief, ARC)
    (first,) = brief.layer.tracks
    # Without a word the first one is kept.
    record(window, brief, ARC / 5, handle=0)
    assert {track.handles for track in brief.layer.tracks} == {(END,), (0,)}
    assert brief.layer.track_of(END) == first
    assert brief.timeline.recording is not None
    editing.undo(window.session)
    window.settle()
    assert brief.layer.tracks == (first,)
    assert brief.timeline.recording is None, "there is nothing to be kept"


def test_a_planted_track_is_recorded_in_places_of_the_picture(window, brief):
    playback.scrub(window.session, 0)
    window.settle()
    planted = Track(
        handles=(END,), is_scene_space=True, keys=(TrackKey(frame=0, place=place_of(brief)),)
    )
    brief.history.do(track_commands.put_track(brief.selection.active, planted))
    window.settle()
    record(window, brief, ARC)
    (track,) = brief.layer.tracks
    assert track.is_scene_space
    places = {sample.time: sample.place for sample in brief.timeline.recording.samples}
    for key in track.keys:
        time = min(places, key=lambda time: abs(time - key.frame))
        assert abs(key.place - places[time]) < 5


def test_a_late_track_says_why_it_has_no_key_there(window, keyed):
    keyed.history.do(track_commands.set_delay(keyed.selection.active, END, LATER))
    window.settle()
    before, start = keyed.document, place_of(keyed)
    drag(window, start, start + 30j)
    assert keyed.document is before
    assert [toast.text for toast in window.session.notices.toasts if toast.topic == "late"] == [
        f"The track is delayed by {LATER} frames, so none of its keys can act at frame {HALF}."
    ]


def test_a_hand_sees_its_track_while_a_pose_elsewhere_waits_for_what_is_shown(window, keyed):
    start, track = place_of(keyed), keyed.selected_track
    playback.scrub(window.session, LAST)
    keyed.selection.select_channel(None)
    place = complex(keyed.layer.key(LAST).pose.targets[END].position)
    set_targets(window.session, {END: Target(position=place - 15j)})
    release_drag(window.session)
    playback.scrub(window.session, HALF)
    keyed.selection.select_track(keyed.layer, track)
    assert not keyed.drag.is_at_rest

    def then(robot):
        for _ in range(MOST_FRAMES):
            if keyed.layer_runtime.shown.is_current:
                break
            window.session.jobs.wait_until_idle()
            robot.yield_()
        seen.append(keyed.layer_runtime.shown.is_current)
        robot.mouse_up(0)

    seen = []
    drag(window, start, start + 10j, then=then)
    assert seen == [True]
    assert not keyed.pending.changes


def test_a_pose_elsewhere_comes_to_rest_where_frames_cannot_be_corrected(
    window, keyed, monkeypatch
):
    def broken(*_):
        raise EngineError("no way")

    monkeypatch.setattr("app.motion.caches.corrected_frames._find", broken)
    keyed.selection.select_channel(None)
    playback.scrub(window.session, LAST)
    place = complex(keyed.layer.key(LAST).pose.targets[END].position)
    set_targets(window.session, {END: Target(position=place - 15j)})
    release_drag(window.session)
    playback.scrub(window.session, EARLIER)
    window.settle()
    assert not keyed.pending.changes
    assert any(COMPLAINT in toast.text for toast in window.session.notices.toasts)

from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, differences, disc_document, full_document, random_command
from hypothesis import given, settings, strategies as st

from app.document.commands import (
    handle_commands,
    scene_commands,
    shape_commands,
)
from app.document.commands.command import Command
from app.document.commands.layers import layer_commands
from app.document.history.undo_history import History
from app.document.history.undo_step import PreviewPose, bytes_only_in
from app.errors import LissomError
from app.storage.scenes.layers import make_still_layer

seeds = st.lists(st.integers(0, 2**32 - 1), max_size=25)


def set_fps(fps):
    return scene_commands.set_fps(fps)


def do_at_random(history, seed):
    """Run a random command; tell whether it was possible and changed something."""
    before = history.document
    command = random_command(np.random.default_rng(seed), before)
    try:
        history.do(command)
    except LissomError:
        assert history.document is before
    return history.document is not before


@settings(max_examples=60)
@given(seeds, st.booleans())
def test_undo_and_redo_give_back_the_very_same_documents(seeds, is_full):
    first = full_document() if is_full else disc_document()
    history = History(first, saved=True)
    documents = [first] + [history.document for seed in seeds if do_at_random(history, seed)]
    for document in reversed(documents):
        assert history.document is document
        history.undo()
    assert history.document is first
    assert history.undo_label is None
    for document in documents:
        assert history.document is document
        history.redo()
    assert history.redo_label is None


def test_the_documents_that_undo_and_redo_lead_to():
    first = disc_document()
    history = History(first, saved=True)
    assert history.nearby == (first,)
    history.do(set_fps(30))
    second = history.document
    assert history.nearby == (first, second)
    history.do(set_fps(40))
    third = history.document
    history.undo()
    assert history.nearby == (first, second, third)


@settings(max_examples=40)
@given(seeds)
def test_commands_leave_the_document_before_them_as_it_was(seeds):
    history = History(disc_document(), saved=True)
    for seed in seeds:
        before = history.document
        copies = [key.pose.phi.tobytes() for key in before.layers[0].keys]
        do_at_random(history, seed)
        assert [key.pose.phi.tobytes() for key in before.layers[0].keys] == copies
    while history.undo_label:
        history.undo()
    assert not differences(history.document, disc_document())


def test_a_command_after_undo_forgets_what_was_undone():
    history = History(disc_document(), saved=False)
    for fps in (10, 11, 12):
        history.do(set_fps(fps))
    history.undo()
    history.undo()
    assert (history.undo_label, history.redo_label) == ("Set frames per second",) * 2
    history.do(handle_commands.add_handle(0, CENTRE))
    assert (history.undo_label, history.redo_label) == ("Add handle", None)
    assert history.document.fps == 10
    history.undo()
    history.undo()
    history.undo()
    assert history.document.fps == 24


def test_a_gesture_is_one_step():
    history = History(disc_document(), saved=False)
    drag = object()
    history.do(set_fps(10))
    for fps in (11, 12, 13):
        history.do(set_fps(fps), gesture=drag)
    history.do(set_fps(14), gesture=object())
    history.undo()
    assert history.document.fps == 13
    history.undo()
    assert history.document.fps == 10
    history.redo()
    assert history.document.fps == 13


def test_a_gesture_back_to_where_it_began_is_no_step():
    first = disc_document()
    history, drag = History(first, saved=True), object()
    history.do(set_fps(10), gesture=object())
    before = history.document
    history.do(set_fps(11), gesture=drag)
    history.do(Command("Set frames per second", lambda _: before), gesture=drag)
    assert history.document is before
    assert history.redo_label is None
    history.do(set_fps(12), gesture=drag)
    history.undo()
    assert history.document is before
    history.undo()
    assert history.document is first


def test_a_gesture_that_is_taken_back_leaves_no_trace():
    history = History(disc_document(), saved=True)
    for fps in (10, 11, 12):
        history.do(set_fps(fps))
    history.undo()
    history.undo()
    before, drag = history.document, object()
    for fps in (20, 21):
        history.do(set_fps(fps), gesture=drag)
    assert history.redo_label is None
    history.revert(object())
    history.revert(None)
    assert history.document.fps == 21
    history.revert(drag)
    assert history.document is before
    history.revert(drag)
    assert history.document is before
    seen = []
    while history.redo_label:
        history.redo()
        seen.append(history.document.fps)
    assert seen == [11, 12]
    # Over by another step: it is that step's to undo.
    history.do(set_fps(30), gesture=drag)
    history.do(set_fps(31))
    history.revert(drag)
    assert history.document.fps == 31


def test_a_pose_that_no_key_holds_is_undone_and_redone_like_all_else():
    first = disc_document()
    pose = first.layers[0].keys[0].pose
    history = History(first, saved=True)
    poses = [PreviewPose(layer=0, frame=5, pose=pose) for _ in range(3)]
    history.set_preview_pose(poses[0])
    history.do(set_fps(10))
    drag = object()
    for unkeyed in poses[1:]:
        history.set_preview_pose(unkeyed, gesture=drag)
    assert (history.undo_label, history.preview_pose) == ("Pose", poses[2])
    assert history.document.fps == 10
    history.undo()
    assert history.preview_pose is poses[0]
    history.undo()
    assert (history.document, history.preview_pose) == (first, poses[0])
    assert history.is_saved
    history.undo()
    assert history.preview_pose is None
    for unkeyed in (poses[0], poses[0], poses[2]):
        history.redo()
        assert history.preview_pose is unkeyed
    history.set_preview_pose(None, gesture=drag)
    assert history.preview_pose is None


def test_anything_between_ends_a_gesture():
    history = History(disc_document(), saved=False)
    drag = object()
    for fps in (10, 11):
        history.do(set_fps(fps), gesture=drag)
    history.undo()
    history.redo()
    history.do(set_fps(12), gesture=drag)
    history.do(set_fps(13))
    history.do(set_fps(14), gesture=drag)
    seen = []
    while history.undo_label:
        seen.append(history.document.fps)
        history.undo()
    assert seen == [14, 13, 12, 11]


def test_a_command_that_changes_nothing_or_fails_is_no_step():
    history = History(disc_document(), saved=True)
    history.do(set_fps(24))
    with pytest.raises(LissomError):
        history.do(set_fps(-1))
    assert history.undo_label is None
    history.do(set_fps(10))
    history.undo()
    history.do(set_fps(24))
    with pytest.raises(LissomError):
        history.do(set_fps(-1))
    assert history.redo_label == "Set frames per second"
    assert history.is_saved


def test_what_is_saved_follows_undo():
    history = History(disc_document(), saved=False)
    assert not history.is_saved
    history.do(set_fps(10))
    history.mark_saved(history.document)
    assert history.is_saved
    history.do(set_fps(11))
    assert not history.is_saved
    history.undo()
    assert history.is_saved
    # A save that ends while the person has gone on.
    older = history.document
    history.do(set_fps(12))
    history.mark_saved(older)
    assert not history.is_saved
    history.do(set_fps(10))
    assert not history.is_saved


@pytest.mark.parametrize("count", [5, 10, 11, 12, 95, 100])
def test_memory_is_bounded_by_forgetting_the_oldest_steps(count):
    # A step that shares all its arrays counts 2,000 bytes.
    history = History(disc_document(), saved=False, memory=20_000)
    for fps in range(30, 30 + count):
        history.do(set_fps(fps))
    newest, steps = history.document, 0
    while history.undo_label:
        history.undo()
        steps += 1
    assert steps == min(count, 10)
    for _ in range(steps):
        history.redo()
    assert history.document is newest


def test_one_step_is_kept_however_large():
    history = History(disc_document(), saved=False, memory=0)
    for fps in (30, 31, 32):
        history.do(set_fps(fps))
    history.undo()
    assert history.document.fps == 31
    assert history.undo_label is None


def test_arrays_that_are_shared_are_counted_once():
    history = History(full_document(), saved=False, memory=4_000_000)
    domain = history.document.layers[0].domain
    large = type(domain)(
        outline=domain.outline,
        cage=domain.cage,
        mesh=type(domain.mesh)(
            vertices=np.resize(domain.mesh.vertices, 100_000), triangles=domain.mesh.triangles
        ),
    )
    poses = history.document.layers[0].poses
    meshing = history.document.layers[0].meshing
    history.do(shape_commands.replace_domain(0, large, meshing, poses))
    for fps in range(30, 430):
        history.do(set_fps(fps))
    history.do(shape_commands.replace_domain(0, domain, meshing, poses))
    # 1.6 MB of one mesh, and 400 times next to nothing.
    for _ in range(402):
        history.undo()
    assert history.undo_label is None
    assert history.document.layers[0].domain is domain


def test_thousands_of_steps_can_be_undone():
    first = disc_document()
    history = History(first, saved=False)
    for step in range(2_000):
        history.do(Command("Step", set_fps(25 + step % 7).change))
    while history.undo_label:
        history.undo()
    assert history.document is first


def test_what_completes_a_step_is_undone_with_it():
    history = History(disc_document(), saved=True)
    first = history.document
    pose = PreviewPose(layer=0, frame=3, pose=first.layers[0].keys[0].pose)
    history.do(set_fps(10))
    history.do(set_fps(20))
    later = history.document
    history.undo()
    history.extend_step(scene_commands.set_loop(loop=True))
    completed = history.document
    assert (completed.fps, completed.loop) == (10, True)
    assert history.undo_label == "Set frames per second"
    history.redo()
    assert history.document is later  # it was made before, and stays as it was
    history.undo()
    assert history.document is completed
    history.undo()
    assert history.document is first
    # A pose that no key holds is over the domain of before.
    history.set_preview_pose(pose)
    history.extend_step(scene_commands.set_loop(loop=True))
    assert history.preview_pose is None
    # What changes nothing completes nothing.
    same = history.document
    history.extend_step(scene_commands.set_loop(loop=True))
    assert history.document is same


def moved(pose, by):
    """Return a pose that has gone on."""
    return replace(pose, phi=pose.phi + by, psi=pose.psi.copy())


def held(history):
    """Return the bytes that history counts, anew."""
    pairs = zip(history._steps, history._steps[1:], strict=False)
    return [*(bytes_only_in(old, new) for old, new in pairs), 0]


@pytest.mark.parametrize("change", ["do", "pose", "extend", "undo"])
def test_open_step_is_finished_before_any_other_change(change):
    history, finished, drag = History(full_document(), saved=True), [], object()
    history.do(set_fps(31))
    history.do(set_fps(32))
    history.undo()

    def finish():
        finished.append(history.document.fps)
        history.do(set_fps(33), gesture=drag)

    history.begin(drag, "Drag", finish)
    assert (history.undo_label, history.redo_label) == ("Drag", None)
    history.do(set_fps(30), gesture=drag)
    layer = history.document.layers[0]
    pose = PreviewPose(layer=layer.id, frame=1, pose=layer.keys[0].pose)
    {
        "do": lambda: history.do(set_fps(34)),
        "pose": lambda: history.set_preview_pose(pose),
        "extend": lambda: history.extend_step(set_fps(34)),
        "undo": history.undo,
    }[change]()
    assert finished == [30]
    assert not history.is_unfinished
    assert history.document.fps == {"do": 34, "pose": 33, "extend": 34, "undo": 31}[change]


def test_command_that_changes_nothing_ends_no_drag():
    history, drag = History(disc_document(), saved=True), object()
    history.preview(set_fps(30), drag)
    history.do(set_fps(30))
    assert history.is_held
    history.preview(set_fps(31), drag)
    assert history.document.fps == 31


def test_step_without_a_final_form_is_dropped():
    history, drag = History(disc_document(), saved=True), object()
    history.begin(drag, "Drag", lambda: history.revert(drag))
    history.do(set_fps(30), gesture=drag)
    history.do(scene_commands.set_loop(loop=True))
    assert (history.document.fps, history.document.loop) == (24, True)
    history.undo()
    assert history.undo_label is None


ENDINGS = {
    "cancel": (History.cancel, 24),
    "command": (lambda history: history.do(scene_commands.set_loop(loop=True)), 30),
    "interrupt": (History.interrupt, 30),
}


@pytest.mark.parametrize("name", ENDINGS)
def test_hand_moves_nothing_after_its_drag_has_ended(name):
    end, fps = ENDINGS[name]
    history, drag = History(disc_document(), saved=True), object()
    history.preview(set_fps(30), drag)
    assert history.is_held
    end(history)
    history.preview(set_fps(31), drag)
    assert history.has_ended(drag)
    assert not history.is_held
    assert history.document.fps == fps


def test_redo_is_possible_after_a_cancelled_drag():
    history, drag = History(disc_document(), saved=True), object()
    history.do(set_fps(30))
    history.undo()
    history.preview(set_fps(31), drag)
    history.redo()
    assert history.document.fps == 31
    history.cancel()
    history.redo()
    assert history.document.fps == 30


def test_released_drag_is_one_step():
    history, drag = History(disc_document(), saved=True), object()
    for fps in (30, 31, 32):
        history.preview(set_fps(fps), drag)
    assert (history.committed.fps, history.document.fps) == (24, 32)
    history.release(drag)
    assert not history.is_unfinished
    history.undo()
    assert (history.document.fps, history.undo_label) == (24, None)
    history.redo()
    assert history.document.fps == 32


@pytest.mark.parametrize("change", ["another domain", "no layer"])
def test_pose_outside_keys_is_let_go_with_its_domain(change):
    history = History(full_document(), saved=True)
    history.do(layer_commands.duplicate_layer(0))
    layer = history.document.layers[0]
    history.set_preview_pose(PreviewPose(layer=layer.id, frame=1, pose=layer.keys[0].pose))
    if change == "another domain":
        other = replace(make_still_layer(layer), id=layer.id)
        history.do(layer_commands.replace_layer(layer.id, other))
    else:
        history.do(layer_commands.remove_layer(layer.id))
    assert history.preview_pose is None
    history.undo()
    assert history.preview_pose is not None


def test_pose_outside_keys_has_a_target_for_each_handle():
    first = full_document()
    history, layer = History(first, saved=True), first.layers[0]
    pose = moved(layer.keys[0].pose, 1)
    history.set_preview_pose(PreviewPose(layer=layer.id, frame=5, pose=pose))
    kept, gone = layer.handles[:2]
    history.do(handle_commands.remove_handles(layer.id, {gone.id}))
    assert history.preview_pose.pose.targets.keys() == pose.targets.keys() - {gone.id}
    assert history.preview_pose.pose.targets[kept.id] == pose.targets[kept.id]
    place = complex(layer.domain.mesh.vertices[0])
    history.do(handle_commands.move_handle(layer.id, kept.id, place))
    (here,) = layer.map_of(pose)(np.array([place]))
    assert history.preview_pose.pose.targets[kept.id].position == here
    history.undo()
    history.undo()
    assert history.preview_pose.pose is pose

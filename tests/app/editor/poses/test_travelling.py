"""Poses and keys that go to other layers, by the names of layers and of their handles."""

from dataclasses import replace

import numpy as np
import pytest
from invariants import check_invariants
from sessions import go, run_update_steps, session_of, settle
from walkers import AXIS, FAR, leg, walker

from app.document import (
    DEPTH,
    PAIRS,
    PRESETS,
    TRACK,
    Channel,
    Document,
    TangentMode,
    Target,
    channel_commands,
    handle_commands,
    key_commands,
    layer_commands,
    pose_channel,
    stiffness_commands,
    track_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.layer_setup import handle_editing, stiffness_editing
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.layering.layer_list import rename_layer
from app.editor.layering.layer_selection import select_layers, set_active_layer
from app.editor.layering.pictures import make_still
from app.editor.parts.clipboard import CopiedKeys
from app.editor.poses import copying, library, paste_destinations, pasting, pasting_targets
from app.editor.poses.paste_destinations import NOTHING_COPIED
from app.editor.poses.pasting import NOT_PASTED

SWAPPED, FLIPPED, PLAIN = "swapped", "flipped", "as it is"


def walking(folder, document):
    """A session of somebody whose first layer in front is bent at frame 0."""
    first = Document(layers=document.layers[:1], size=document.size)
    height, width = document.size[1], document.size[0]
    session = session_of(first, folder, np.zeros((height, width, 4), np.uint8))
    for layer in document.layers[1:]:
        editing.edit_document(session, layer_commands.add_layer(layer))
    settle(session)
    (near,) = (each.id for each in document.layers if each.id == 0)
    set_active_layer(session, near)
    return session


def pull(session, name, **ways):
    """Pull handles of a layer, which is chosen then, at the present frame."""
    set_active_layer(session, identity(session, name))
    ids = {handle.name: handle.id for handle in session.project.layer.handles}
    settle(session)
    for handle, way in ways.items():
        editing.select_handles(session, frozenset({ids[handle]}))
        nudge_handles(session, way)
        settle(session)
    editing.select_handles(session, frozenset())


def identity(session, name):
    return next(each.id for each in session.project.document.layers if each.name == name)


def layer(session, name):
    return session.project.document.layer(identity(session, name))


def ways(session, name, frame):
    """Return how far a key has taken a layer's handles, by their names."""
    one = layer(session, name)
    targets = one.key(frame).pose.targets
    return {each.name: targets[each.id].position - each.position for each in one.handles}


@pytest.fixture(scope="module")
def raised(tmp_path_factory):
    """Near leg raised at frame 0; the far leg, which is drawn elsewhere, and the body at rest."""
    session = walking(tmp_path_factory.mktemp("raised"), walker())
    pull(session, "near leg", knee=18 + 8j, foot=-20 + 30j)
    return session.project.document


@pytest.fixture
def session(raised, tmp_path):
    return walking(tmp_path, raised)


def near_and_far(session, frame):
    return ways(session, "near leg", frame), ways(session, "far leg", frame)


def close(one, other):
    assert one.keys() == other.keys()
    for name, way in one.items():
        assert way == pytest.approx(other[name], abs=1e-6), name


def test_a_pose_is_pasted_onto_another_layer_as_one_step(session):
    project = session.project
    copying.copy_pose_or_keys(session)
    set_active_layer(session, identity(session, "far leg"))
    before = project.document
    go(session, 12)
    pasting.paste_copied(session)
    settle(session)
    check_invariants(session)
    close(ways(session, "far leg", 12), ways(session, "near leg", 0))
    assert layer(session, "far leg").key(12).pose.certificate.is_certified
    assert project.selection.frames == {12}
    assert layer(session, "near leg").key_frames == {0}
    editing.undo(session)
    assert project.document is before


def test_keys_take_their_ways_passings_turns_and_fronts_along(session):
    near, knee = identity(session, "near leg"), 1
    editing.edit_document(
        session, key_commands.insert_key(near, 8, layer(session, "near leg").keys[0].pose)
    )
    editing.edit_document(
        session, channel_commands.set_easing({pose_channel(near): {0}}, PRESETS["in-out"])
    )
    editing.edit_document(
        session, channel_commands.set_tangent_mode({pose_channel(near): {8}}, TangentMode.STOP)
    )
    editing.edit_document(session, key_commands.set_revolutions(near, {0}, 1))
    editing.edit_document(session, channel_commands.set_key(Channel(DEPTH, near, knee), 0, 0.5))
    chosen = {pose_channel(near): frozenset({0, 8}), Channel(DEPTH, near, knee): frozenset({0})}
    editing.select_channel_keys(session, chosen)
    copying.copy_keys(session)
    set_active_layer(session, identity(session, "far leg"))
    go(session, 12)
    pasting.paste_copied(session)
    settle(session)
    far = layer(session, "far leg")
    assert far.key_frames == {0, 12, 20}
    one, other = far.key(12), far.key(20)
    assert (one.easing, one.revolutions) == (PRESETS["in-out"], 1)
    assert far.keys_of(DEPTH, knee) == (DEPTH.key(12, 0.5),)
    assert other.tangent_mode is TangentMode.STOP
    close(ways(session, "far leg", 20), ways(session, "near leg", 8))


def test_the_step_of_all_layers_is_pasted_swapped_and_nothing_is_mirrored(session):
    project = session.project
    set_active_layer(session, identity(session, "body"))
    copying.copy_all_poses(session)
    settle(session)
    before = project.document
    go(session, 12)
    assert pasting.paste_disabled_reason(session, project, SWAPPED) is None
    pasting.paste_copied(session, SWAPPED)
    settle(session)
    near, far = near_and_far(session, 12)
    first_near, first_far = near_and_far(session, 0)
    close(far, first_near)
    close(near, first_far)
    body = layer(session, "body")
    assert body.key(12).pose.phi is body.key(0).pose.phi
    assert project.selection.keys == {pose_channel(each): {12} for each in (0, 1, 2)}
    editing.undo(session)
    assert project.document is before
    # Once more is the step itself again.
    editing.redo(session)
    copying.copy_all_poses(session)
    go(session, 24)
    pasting.paste_copied(session, SWAPPED)
    settle(session)
    for name in ("near leg", "far leg"):
        close(ways(session, name, 24), ways(session, name, 0))
    # Poses bring no way to the next key.
    near = identity(session, "near leg")
    editing.edit_document(
        session, channel_commands.set_easing({pose_channel(near): {12}}, PRESETS["in"])
    )
    go(session, 12)
    pasting.paste_copied(session)
    settle(session)
    assert layer(session, "near leg").key(12).easing == PRESETS["in"]


def test_left_and_right_layers_exchange_mirrored_when_flipped(tmp_path):
    mirrored = leg("leg.R", 2, mirrored=True)
    document = Document(layers=(mirrored, leg("leg.L", 0)), size=(240, 200))
    session = walking(tmp_path, document)
    pull(session, "leg.L", knee=18 + 8j, foot=-20 + 30j)
    editing.edit_document(session, key_commands.set_revolutions(0, {0}, 2))
    chosen = {pose_channel(each): frozenset({0}) for each in (0, 2)}
    editing.select_channel_keys(session, chosen)
    copying.copy_keys(session)
    go(session, 12)
    pasting.paste_copied(session, FLIPPED)
    settle(session)
    assert layer(session, "leg.R").key(12).revolutions == -2
    was = ways(session, "leg.L", 0)
    close(ways(session, "leg.R", 12), {name: -way.conjugate() for name, way in was.items()})
    close(ways(session, "leg.L", 12), dict.fromkeys(was, 0j))
    assert mirrored.axis > AXIS


def test_one_layer_gives_its_pose_to_its_partner_where_sides_exchange(session):
    project = session.project
    copying.copy_pose_or_keys(session)
    go(session, 12)
    (landing,) = paste_destinations.find_paste_destinations(session, project, SWAPPED)
    assert landing.layer.name == "far leg"
    pasting.paste_copied(session, SWAPPED)
    settle(session)
    close(ways(session, "far leg", 12), ways(session, "near leg", 0))
    assert layer(session, "near leg").key_frames == {0}


def test_words_for_sides_are_edited_and_whole_names_are_partners(session):
    project = session.project
    for name, to in (("near leg", "Spielbein"), ("far leg", "Standbein")):
        rename_layer(session, identity(session, name), to)
    copying.copy_all_poses(session)
    go(session, 12)
    assert "Nothing was swapped" in pasting.paste_disabled_reason(session, project, SWAPPED)
    before = project.document
    pasting.paste_copied(session, SWAPPED)
    settle(session)
    assert project.document is before
    pasting.set_mirror_names(session, "L/R, Spielbein/Standbein")
    assert pasting.paste_disabled_reason(session, project, SWAPPED) is None
    pasting.paste_copied(session, SWAPPED)
    settle(session)
    close(ways(session, "Standbein", 12), ways(session, "Spielbein", 0))
    assert project.document.pairs == (("L", "R"), ("Spielbein", "Standbein"))


def test_a_handle_whose_partner_takes_over_from_it_takes_nothing_over_from_itself():
    one, both = (
        replace(leg("leg", 0), handles=tuple(replace(h, name=n) for h, n in named))
        for named in (
            zip(leg("leg", 0).handles, ("hand.L", "knee", "foot"), strict=True),
            zip(leg("leg", 0).handles, ("hand.L", "hand.R", "foot"), strict=True),
        )
    )
    left, right, foot = (handle.id for handle in both.handles)
    assert paste_destinations.match_handles(one, both, PAIRS, SWAPPED) == {right: left, foot: foot}
    other = replace(one, id=7)
    assert paste_destinations.match_handles(other, both, PAIRS, PLAIN) == {left: left, foot: foot}
    assert paste_destinations.match_handles(both, one, PAIRS, SWAPPED) == {left: right, foot: foot}


def test_why_nothing_can_be_pasted_is_said(session):
    project = session.project
    assert pasting.paste_disabled_reason(session, project, PLAIN) == NOTHING_COPIED
    copying.copy_pose_or_keys(session)
    set_active_layer(session, identity(session, "body"))
    before = project.document
    assert pasting.paste_disabled_reason(session, project, PLAIN) == (
        "“body” has no handle called hip, knee or foot."
    )
    for way in (PLAIN, SWAPPED, FLIPPED):
        pasting.paste_copied(session, way)
    settle(session)
    assert project.document is before
    make_still(session, identity(session, "body"))
    settle(session)
    assert "still picture" in pasting.paste_disabled_reason(session, project, PLAIN)


def test_paste_reports_layers_without_a_common_name(session):
    far = identity(session, "far leg")
    for handle in layer(session, "far leg").handles:
        command = handle_commands.rename_handle(far, handle.id, f"point {handle.id}")
        editing.edit_document(session, command)
    copying.copy_all_poses(session)
    go(session, 12)
    # What remains are layers that only take back their own.
    assert pasting.paste_disabled_reason(session, session.project, SWAPPED) != ""
    pasting.paste_copied(session, FLIPPED)
    settle(session)
    assert layer(session, "body").key_frames == {0, 12}
    assert layer(session, "far leg").key_frames == {0}
    texts = [toast.text for toast in session.notices.toasts]
    assert "“far leg” has no handle called hip, knee or foot." in texts


def test_handles_that_are_not_copied_stay_where_the_motion_has_them(session):
    far = identity(session, "far leg")
    editing.edit_document(
        session, handle_commands.add_handle(far, 74 + 120j + FAR.shift, name="shin")
    )
    settle(session)
    go(session, 24)
    pull(session, "far leg", shin=10 + 6j)
    set_active_layer(session, identity(session, "near leg"))
    go(session, 0)
    copying.copy_pose_or_keys(session)
    set_active_layer(session, far)
    go(session, 12)
    shown = session.project.layer_runtime.shown
    names = [handle.name for handle in shown.clip.layer.handles]
    here = complex(shown.handle_positions[names.index("shin")])
    pasting.paste_copied(session)
    settle(session)
    shin = next(each for each in layer(session, "far leg").handles if each.name == "shin")
    target = layer(session, "far leg").key(12).pose.targets[shin.id].position
    assert target == pytest.approx(here, abs=0.5)
    close(
        {k: w for k, w in ways(session, "far leg", 12).items() if k != "shin"},
        ways(session, "near leg", 0),
    )


def test_selected_handles_alone_take_over_from_another_layer(session):
    copying.copy_pose_or_keys(session)
    set_active_layer(session, identity(session, "far leg"))
    go(session, 0)
    foot = next(each.id for each in session.project.layer.handles if each.name == "foot")
    editing.select_handles(session, frozenset({foot}))
    pasting_targets.paste_on_selected(session)
    settle(session)
    now, was = ways(session, "far leg", 0), ways(session, "near leg", 0)
    assert now["foot"] == pytest.approx(was["foot"], abs=1e-6)
    assert now["knee"] != pytest.approx(was["knee"], abs=1)


def test_a_copy_has_the_pose_at_rest_at_once(session):
    editing.select_handles(session, frozenset({2}))
    nudge_handles(session, 13 + 3j)
    drag = session.project.drag
    while drag.preview is None:
        run_update_steps(session)
        assert session.jobs.wait_until_idle()
        session.jobs.deliver()
    assert not drag.is_at_rest
    copying.copy_pose_or_keys(session)
    set_active_layer(session, identity(session, "far leg"))
    pasting.paste_copied(session)
    settle(session)
    close(ways(session, "far leg", 0), ways(session, "near leg", 0))


def test_paste_reports_a_layer_that_changes_meanwhile(session):
    copying.copy_pose_or_keys(session)
    set_active_layer(session, identity(session, "far leg"))
    pasting.paste_copied(session)
    editing.edit_layer(session, handle_commands.remove_handles, {0})
    before = session.project.document
    settle(session)
    assert session.project.document is before
    assert NOT_PASTED in session.notices.toasts[-1].text


def test_poses_of_a_library_are_offered_to_layers_with_the_same_names(session):
    project = session.project
    library.save_pose_to_library(session)
    settle(session)
    near = identity(session, "near leg")
    set_active_layer(session, identity(session, "body"))
    assert library.list_library_poses(project) == []
    set_active_layer(session, identity(session, "far leg"))
    ((owner, kept),) = library.list_library_poses(project)
    assert (owner.id, kept.name) == (near, "Pose 1")
    library.apply_library_pose_at(session, kept.name, 12, near)
    settle(session)
    close(ways(session, "far leg", 12), ways(session, "near leg", 0))
    assert playback.current_frame(session, project) == 12
    assert project.history.undo_label == "Use pose"
    go(session, 0)
    library.blend_library_pose(session, kept.name, 0.5, near)
    settle(session)
    library.end_pose_blend(session)
    settle(session)
    half = {name: way / 2 for name, way in ways(session, "near leg", 0).items()}
    close(ways(session, "far leg", 0), half)


def test_keys_of_several_layers_come_back_by_name_in_another_project(session, tmp_path):
    copying.copy_all_poses(session)
    other = walking(tmp_path, walker())
    other.clipboard.poses = session.clipboard.poses
    go(other, 6)
    pasting.paste_copied(other)
    settle(other)
    close(ways(other, "near leg", 6), ways(session, "near leg", 0))
    (one,) = [each for each in session.clipboard.poses if each.layer.name == "near leg"]
    other.clipboard.poses = (
        replace(one, layer=replace(one.layer, name="nobody")),
        *other.clipboard.poses[1:],
    )


def test_handles_of_one_layer_are_swapped_within_it(tmp_path):
    document = walker()
    body = next(each for each in document.layers if each.name == "body")
    for name, place in (("near hand", 60 + 160j), ("far hand", 140 + 160j)):
        scene = handle_commands.add_handle(1, place, name=name)(Document(layers=(body,)))
        (body,) = scene.layers
    session = session_of(Document(layers=(body,)), tmp_path, np.zeros((200, 240, 4), np.uint8))
    pull(session, "body", **{"near hand": 6 + 10j})
    copying.copy_pose_or_keys(session)
    go(session, 12)
    pasting.paste_copied(session, SWAPPED)
    settle(session)
    now = ways(session, "body", 12)
    # All of it has turned by an eighth by the pull, which takes the hands along, 80 pixels apart.
    assert now["far hand"] == pytest.approx(6 + 10j, abs=8)
    assert now["near hand"] == pytest.approx(0, abs=8)
    assert now["chest"] == pytest.approx(0, abs=1e-6)


def test_what_is_turned_as_a_whole_stays_turned_where_its_sides_are_swapped():
    document = walker()
    body = next(each for each in document.layers if each.name == "body")
    for name, place in (("near hand", 60 + 160j), ("far hand", 140 + 160j)):
        scene = handle_commands.add_handle(1, place, name=name)(Document(layers=(body,)))
        (body,) = scene.layers
    turn, key = np.exp(0.7j), body.keys[0]
    targets = {each.id: Target(position=turn * each.position) for each in body.handles}
    pose = replace(key.pose, targets=targets, phi=turn * body.domain.cage)
    copied = CopiedKeys(body, (replace(key, pose=pose),))
    landing = paste_destinations.find_paste_destination(scene, copied, body, SWAPPED)
    target = landing.pose_transfer(SWAPPED).transfer_targets(body, pose)
    for handle in body.handles:
        assert target[handle.id].position == pytest.approx(targets[handle.id].position, abs=1e-9)


@pytest.mark.parametrize(("way", "mirrors"), [(SWAPPED, False), (FLIPPED, True)])
def test_keys_of_tracks_go_to_the_handles_of_the_partner(session, way, mirrors):
    near, far = identity(session, "near leg"), identity(session, "far leg")
    foot = 2
    for frame, place in ((0, 4 + 2j), (6, -3 + 5j)):
        command = track_commands.put_track_key(near, foot, frame, place, velocity=1 + 2j)
        editing.edit_document(session, command)
    settle(session)
    editing.select_channel_keys(session, {Channel(TRACK, near, foot): frozenset({0, 6})})
    copying.copy_keys(session)
    go(session, 12)
    before = session.project.document
    pasting.paste_copied(session, way)
    settle(session)
    track = layer(session, "far leg").track_of(foot)
    assert [key.frame for key in track.keys] == [12, 18]
    for key, place in zip(track.keys, (4 + 2j, -3 + 5j), strict=True):
        ways = [place, 1 + 2j]
        wanted = [-each.conjugate() for each in ways] if mirrors else ways
        # The mirror at which an oblique leg takes over is oblique; it turns no length into another.
        assert abs(key.place) == pytest.approx(abs(wanted[0]))
        if not mirrors:
            assert [key.place, key.velocity] == pytest.approx(wanted)
    assert session.project.selection.keys == {Channel(TRACK, far, foot): {12, 18}}
    editing.undo(session)
    assert session.project.document is before


def test_the_poses_of_chosen_layers_are_copied_and_one_is_pasted_onto_all_of_them(session):
    near, far, body = (identity(session, name) for name in ("near leg", "far leg", "body"))
    select_layers(session, near, far)
    copying.copy_pose_or_keys(session)
    settle(session)
    assert {each.layer.id for each in session.clipboard.poses} == {near, far}
    set_active_layer(session, near)
    copying.copy_pose_or_keys(session)
    go(session, 12)
    select_layers(session, near, far, body)
    before = session.project.document
    pasting.paste_copied(session)
    settle(session)
    close(ways(session, "far leg", 12), ways(session, "near leg", 0))
    close(ways(session, "near leg", 12), ways(session, "near leg", 0))
    assert layer(session, "body").key_frames == {0}
    assert any("“body” has no handle" in toast.text for toast in session.notices.toasts)
    editing.undo(session)
    assert session.project.document is before


def test_pairs_of_the_document_tell_partners_of_handles_too(session):
    names = ("hip", "Spielknie", "Standknie")
    for handle, name in enumerate(names):
        editing.edit_layer(session, handle_commands.rename_handle, handle, name)
    pasting.set_mirror_names(session, "L/R, Spielknie/Standknie")
    editing.select_handles(session, frozenset({1}))
    handle_editing.select_mirrored(session)
    assert session.project.selection.handles == {2}
    editing.edit_document(session, track_commands.put_track_key(0, 1, 0, 4 + 2j))
    pairs = session.project.document.pairs
    editing.edit_layer(session, track_commands.mirror_track, 1, pairs)
    assert session.project.layer.track_of(2).keys[0].place == -4 + 2j
    editing.edit_layer(session, stiffness_commands.add_bone, (0, 1), 5.0)
    stiffness_editing.mirror_stiffness(session)
    assert [bone.ends for bone in session.project.layer.bones] == [(0, 1), (0, 2)]

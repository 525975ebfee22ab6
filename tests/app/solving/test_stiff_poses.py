"""Poses of layers that are stiff in places."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from animations import bar_picture, still_document
from messages import says

from app.cut_out import CutLine, CutOut
from app.document import (
    Meshing,
    Target,
    handle_commands,
    measure_target_errors,
    stiff_outline,
    stiffness_commands,
)
from app.errors import LissomError
from app.solving import pose_document
from app.solving.drag.drag_solver import DragSolver
from app.solving.drag.rig import Rig
from app.solving.reload.replace_picture import start_picture_replacement
from app.solving.resolve_keys import KeyResolver, step_resolver
from app.solving.script.pose_script import parse_pose_script
from app.storage.json_values import LACKS_FIELD, NOT_LIST, NOT_NUMBER, NOT_OBJECT, NOT_POINT

BAR = bar_picture(480)
PLACES = (30 + 40j, 240 + 40j, 450 + 40j)


@cache
def drawn():
    """The bar as it was opened."""
    return still_document(BAR)


@cache
def bar(amount=40.0):
    """A bar with handles at its ends and in the middle, and a bone in its left half."""
    document = drawn()
    for place in PLACES:
        document = handle_commands.add_handle(0, place)(document)
    if amount is not None:
        document = stiffness_commands.add_bone(0, (0, 1), amount)(document)
    return document.layers[0]


def targets_of(*places):
    return {number: Target(position=place) for number, place in enumerate(places)}


def pulled(layer, start, targets, steps=300):
    drag = DragSolver.begin(Rig.of(layer), start).step_towards(targets, steps)
    assert drag.state.certificate.is_certified
    return drag.make_pose(targets)


def bent_in(layer, pose, left, right):
    """Return the largest k at the outline between two places."""
    outline = layer.domain.outline
    outline = (
        outline[:, None] + np.linspace(0, 1, 20) * (np.roll(outline, -1) - outline)[:, None]
    ).ravel()
    points = outline[(outline.real > left) & (outline.real < right)]
    fz, fzbar = layer.map_of(pose).derivatives(points)
    return float((np.abs(fzbar) / np.abs(fz)).max())


UP = targets_of(60 + 100j, 240 + 40j, 420 + 100j)


def test_a_bone_keeps_its_limb_straight_and_within_its_own_limits():
    usual, boned = bar(None), bar()
    before = pulled(usual, usual.keys[0].pose, UP)
    after = pulled(boned, boned.keys[0].pose, UP)
    assert bent_in(boned, after, 110, 160) < 0.6 * bent_in(usual, before, 110, 160)
    assert bent_in(boned, after, 110, 160) <= boned.bounds.k / np.sqrt(40)
    assert max(boned.target_errors(after).values()) < 1


def test_what_is_stiff_is_known_to_rigs_and_taken_from_earlier_ones():
    usual, boned = bar(None), bar()
    first = Rig.of(usual)
    assert first.deformer.bounds is usual.bounds
    stiff = Rig.of(replace(usual, bones=boned.bones), first)
    assert stiff.deformer.boundary.points is first.deformer.boundary.points
    assert stiff.deformer.boundary.stiffness.max() == pytest.approx(40)
    assert stiff.deformer.handles.around.max() > 5
    assert Rig.of(replace(stiff.layer, name="other"), stiff).deformer.handles is (
        stiff.deformer.handles
    )
    back = Rig.of(usual, stiff)
    assert (back.deformer.boundary.stiffness == 1).all()
    moved = handle_commands.move_handle(0, 1, 200 + 40j)
    longer = moved(still_with(stiff.layer)).layers[0]
    assert not np.array_equal(
        Rig.of(longer, stiff).deformer.boundary.stiffness, stiff.deformer.boundary.stiffness
    )


def still_with(layer):
    return drawn().with_layer(layer)


def test_a_pose_of_before_stays_and_begins_a_drag_though_it_is_beyond_new_limits():
    usual, boned = bar(None), bar(100.0)
    before = pulled(usual, usual.keys[0].pose, UP)
    layer = boned.with_poses([before])
    assert layer.keys[0].pose.phi is before.phi
    assert layer.is_proven(before)
    drag = DragSolver.begin(Rig.of(layer), before)
    assert np.array_equal(drag.state.map.phi, before.phi)
    assert drag.state.certificate.is_certified
    assert drag.step_towards(UP, 200).state.certificate.is_certified


def test_bone_keeps_its_length_when_its_end_is_pulled():
    boned = bar(100.0)
    far = targets_of(30 + 40j, 330 + 40j, 540 + 40j)
    pose = pulled(boned, boned.keys[0].pose, far)
    # The end of the bone stays on its circle, and the rest stretches to its limits.
    assert abs(pose.targets[1].position - 240 - 40j) < 2
    assert not measure_target_errors(boned, pose).errors


SCRIPT = {
    "schema": 1,
    "handles": {"start": [30, 40], "elbow": [240, 40], "end": [450, 40]},
    "keys": [{"frame": 0}, {"frame": 8, "targets": {"end": [400, 110]}}],
    "stiff": [
        {"around": [450, 40], "radius": 60, "amount": 10},
        {"from": "start", "to": "elbow", "amount": 30},
    ],
}


def test_script_stiffens_what_it_says():
    document, notices = pose_document(drawn(), parse_pose_script(SCRIPT), lambda _: None)
    (layer,) = document.layers
    assert notices == ()
    assert layer.bones[0].ends == (0, 1)
    assert layer.bones[0].stiffness == 30
    assert layer.stiffness[np.argmax(layer.domain.outline.real)] > 5
    plain = {name: value for name, value in SCRIPT.items() if name != "stiff"}
    usual, _ = pose_document(drawn(), parse_pose_script(plain), lambda _: None)
    stiff, soft = layer.keys[1].pose, usual.layers[0].keys[1].pose
    assert bent_in(layer, stiff, 110, 160) < 0.5 * bent_in(layer, soft, 110, 160)
    nowhere = {**SCRIPT, "stiff": [{"around": [240, 400], "radius": 6, "amount": 10}]}
    _, notices = pose_document(drawn(), parse_pose_script(nowhere), lambda _: None)
    assert notices == (
        "no outline lies within 6 px of (240, 400), so nothing becomes stiff or soft there",
    )


@pytest.mark.parametrize(
    ("stiff", "message"),
    [
        ({}, says(NOT_LIST, where="stiff")),
        ([7], says(NOT_OBJECT, where="stiff[0]")),
        ([{"from": "start", "to": "knee", "amount": 3}], r"stiff\[0\] names the handle 'knee'"),
        ([{"from": "start", "to": "start", "amount": 3}], "connects 'start' to itself"),
        ([{"from": "start", "to": "end"}], says(LACKS_FIELD, name="amount")),
        ([{"from": "start", "amount": 2}], says(LACKS_FIELD, name="to")),
        ([{"from": "start", "to": "end", "amount": 101}], "from 1/30 to 100, not 101"),
        (
            [{"from": "start", "to": "end", "amount": "hard"}],
            says(NOT_NUMBER, where="stiff[0].amount"),
        ),
        ([{"from": "start", "to": "end", "amount": 2, "radius": 3}], "unknown field 'radius'"),
        ([{"around": [1, 2], "radius": 0, "amount": 2}], r"stiff\[0\]\.radius must be above 0"),
        ([{"around": [1], "radius": 9, "amount": 2}], says(NOT_POINT, where="stiff[0].around")),
        ([{"around": [1, 2], "radius": 9, "amount": 0.03}], r"from 1/30 to 100, not 0\.03"),
    ],
)
def test_other_stiff_parts_are_refused(stiff, message):
    with pytest.raises(LissomError, match=message):
        parse_pose_script({**SCRIPT, "stiff": stiff})


def test_script_names_a_bone_that_leaves_the_drawing():
    picture = BAR.copy()
    picture[20:45, 200:280] = 0
    script = {**SCRIPT, "handles": {"start": [30, 50], "elbow": [240, 26], "end": [450, 50]}}
    script["stiff"] = [{"from": "start", "to": "end", "amount": 3}]
    with pytest.raises(LissomError, match="bone from 'start' to 'end': The bone leaves"):
        pose_document(still_document(picture), parse_pose_script(script), lambda _: None)
    script["stiff"] = 2 * [{"from": "start", "to": "elbow", "amount": 3}]
    with pytest.raises(LissomError, match="A bone from 'start' to 'elbow' already exists"):
        pose_document(drawn(), parse_pose_script(script), lambda _: None)


def stiffness_near(layer, *places):
    points, stiffness = stiff_outline(layer)
    return [float(stiffness[np.abs(points - place).argmin()]) for place in places]


@pytest.mark.parametrize("detail", ["coarse", "fine"])
def test_what_is_stiff_stays_in_its_place_on_another_domain_and_beside_a_cut(detail):
    document = stiffness_commands.paint_stiffness(0, [450 + 40j], radius=70, amount=20.0)(
        still_with(bar())
    )
    layer = document.layers[0]
    slit = CutLine(points=np.array([330 + 0j, 331 + 45j]))
    for cut_out in (layer.cut_out, CutOut(cut_lines=(slit,))):
        before = replace(layer, cut_out=cut_out)
        meshing = Meshing(detail=detail, triangles=1_000)
        resolver = KeyResolver(before=before, bounds=before.bounds, meshing=meshing)
        while not resolver.is_over:
            resolver = step_resolver(resolver, BAR)
        after = resolver.command(document.with_layer(before)).layers[0]
        assert after.domain is not before.domain
        assert after.bones == before.bones
        places = (130 + 20j, 130 + 60j, 240 + 20j, 460 + 40j, 330 + 60j)
        old, new = (stiffness_near(each, *places) for each in (before, after))
        assert np.abs(np.log(new) - np.log(old)).max() < 0.25
        assert old[0] == pytest.approx(40)


def test_another_picture_takes_over_what_is_stiff():
    document = stiffness_commands.paint_stiffness(0, [450 + 40j], radius=70, amount=20.0)(
        still_with(bar())
    )
    larger = np.zeros((80, 500, 4), np.uint8)
    larger[16:64, 20:480] = 255
    made = still_document(larger).layers[0]
    resolver = start_picture_replacement(document.layers[0], made, -10 + 0j)
    while not resolver.is_over:
        resolver = step_resolver(resolver, larger)
    after = resolver.command(document).layers[0]
    assert after.stiffness.max() > 5
    assert stiffness_near(after, 240 + 15j)[0] < 1.1
    assert after.bones == document.layers[0].bones

"""Feet and hands: rigid parts at the ends of limbs, with an angle."""

from functools import cache

import numpy as np
import pytest
from animations import still_document

from app.document import clip_of, find_limbs
from app.motion import Animation
from app.solving import pose_document
from app.solving.script.pose_script import parse_pose_script
from engine.domain.material.end_parts import find_end_part

HANDLES = {"head": [200, 350], "hip": [200, 250], "knee": [206, 150], "foot": [200, 52]}
ARM = {"shoulder": [225, 300], "elbow": [285, 302], "hand": [345, 300]}
LEG = ["hip", "knee", "foot"]
HIPS_DOWN = {"frame": 12, "targets": {"hip": [215, 225]}}
SOLE = np.linspace(186, 272, 40) + 12.5j  # just inside the outline
THOUSANDTH = 0.4  # of the picture's size


@cache
def figure():
    """A trunk with a leg that ends in a foot, and an arm that ends in a hand; 400 by 400 pixels."""
    picture = np.zeros((400, 400, 4), np.uint8)
    for left, right, bottom, top in (
        (150, 250, 220, 380),  # trunk
        (185, 215, 30, 230),  # leg
        (185, 275, 14, 46),  # foot
        (240, 355, 288, 314),  # arm
        (345, 390, 275, 325),  # hand
    ):
        picture[400 - top : 400 - bottom, left:right] = (200, 120, 60, 255)
    return still_document(picture, triangles=2_000)


def posed(*keys, handles=HANDLES, bones=(LEG,)):
    script = {"schema": 1, "handles": handles, "bones": list(bones), "keys": list(keys)}
    document, notices = pose_document(figure(), parse_pose_script(script), lambda _: None)
    assert notices == ()
    return document, document.layers[0]


def placed(layer, key=-1):
    """Return the places and angles of the limbs in a key."""
    limbs = find_limbs(layer)
    return limbs.locate(layer.map_of(layer.keys[key].pose)(limbs.points))


def frames(document, points, times):
    clip = clip_of(document, document.layers[0].id)
    base = Animation(clip, points=points).base
    return np.array([base.frame(time).positions for time in times])


def turns(points, places):
    """Return the rotations of points, and how far they are off their rigid motion."""
    rest = points - points.mean()
    local = places - places.mean(axis=1)[:, None]
    products = local @ rest.conj()
    misfit = np.abs(local - (products / np.abs(products))[:, None] * rest)
    return np.angle(products), misfit.max()


def test_a_foot_begins_at_its_ankle():
    loops = figure().layers[0].domain.loops
    part = find_end_part(loops, 206 + 150j, 200 + 52j)
    assert part.neck > 0.9
    assert part.points.imag.max() < 51
    assert part.points.real.max() > 270
    # A tip, most of a leg, and a part with a handle of its own are no rigid parts.
    assert find_end_part(loops, 200 + 52j, 262 + 30j) is None
    assert find_end_part(loops, 200 + 250j, 204 + 200j) is None
    assert find_end_part(loops, 206 + 150j, 200 + 52j, [260 + 30j]) is None


def test_a_hoof_is_a_rigid_end_and_a_round_tip_is_none():
    round_tip = 20 * np.exp(1j * np.linspace(np.pi, 2 * np.pi, 33)) + 20j
    hoof = np.array([-22, -24j, 24 - 24j]) + 20j
    for end, is_rigid in ((round_tip, False), (hoof, True)):
        loop = np.concatenate([end, [20 + 220j, -20 + 220j]])
        assert (find_end_part([loop], 120j, 20j) is not None) == is_rigid


def test_a_foot_of_a_short_thick_leg_is_a_rigid_end():
    leg = np.array([-45, 45, 45 + 260j, -45 + 260j]) + 0j
    assert find_end_part([leg], 167j, 83j) is not None


def test_a_planted_sole_neither_rolls_nor_slides():
    document, layer = posed({"frame": 0}, HIPS_DOWN)
    assert placed(layer).angles == pytest.approx({3: 0.0}, abs=1e-3)
    assert layer.keys[1].pose.targets[3].rotation is None
    soles = frames(document, SOLE, np.linspace(0, 12, 13))
    assert np.abs(soles - SOLE).max() < 0.3 * THOUSANDTH


def test_a_dragged_foot_turns_with_its_shin_unless_it_has_an_angle():
    free = {"frame": 12, "targets": {"foot": [240, 110]}}
    _, layer = posed({"frame": 0}, free)
    at, rest = placed(layer), HANDLES
    shin = (at.places[3] - at.places[2]) / complex(rest["foot"][0] - rest["knee"][0], -98)
    assert at.angles[3] == pytest.approx(np.angle(shin), abs=0.02)
    assert abs(at.places[3] - 240 - 110j) < 1 * THOUSANDTH
    _, layer = posed({"frame": 0}, {**free, "angle": {"foot": 0}})
    assert placed(layer).angles[3] == pytest.approx(0.0, abs=5e-3)
    # The angle stays in later keys, and turns with the shin that a dragged knee turns.
    kept = {"frame": 24, "targets": {"foot": [225, 90]}}
    _, layer = posed({"frame": 0}, {**free, "angle": {"foot": 10}}, kept)
    assert np.degrees(placed(layer).angles[3]) == pytest.approx(10, abs=0.5)
    knee = {"frame": 24, "targets": {"knee": [220, 152]}}
    _, layer = posed({"frame": 0}, {"frame": 12, "angle": {"foot": 10}}, knee)
    turned = layer.keys[2].pose.targets[3].rotation
    assert np.degrees(turned) == pytest.approx(10 + 8, abs=2)
    assert placed(layer).angles[3] == pytest.approx(turned, abs=0.01)


def test_a_foot_with_angles_turns_evenly_as_a_rigid_part():
    first = {"frame": 0, "targets": {"foot": [230, 90]}, "angle": {"foot": -20}}
    second = {"frame": 12, "targets": {"foot": [250, 112]}, "angle": {"foot": 25}}
    document, _ = posed(first, second)
    angles, misfit = turns(SOLE, frames(document, SOLE, np.linspace(0, 12, 7)))
    assert np.degrees(angles) == pytest.approx(np.linspace(-20, 25, 7), abs=1)
    assert misfit < 1 * THOUSANDTH


def test_a_hand_stays_where_it_is_while_its_shoulder_is_carried():
    handles = {**HANDLES, **ARM}
    arm = ["shoulder", "elbow", "hand"]
    document, layer = posed({"frame": 0}, HIPS_DOWN, handles=handles, bones=(LEG, arm))
    at = placed(layer)
    assert abs(at.places[6] - 345 - 300j) < 1 * THOUSANDTH
    assert at.angles[6] == pytest.approx(0.0, abs=5e-3)
    palm = np.array([370, 385, 385, 370]) + 1j * np.array([280, 280, 320, 320])
    assert np.abs(frames(document, palm, [0, 6, 12]) - palm).max() < 0.8 * THOUSANDTH

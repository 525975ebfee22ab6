"""Handles that mirror each other by their names."""

import numpy as np
import pytest

from app.document import Handle
from app.document.body.pairs import mirrored_name, pairs_by_name, partners_of

SIDES = [
    ("hand.L", "hand.R"),
    ("hand_l", "hand_r"),
    ("hand-L", "hand-R"),
    ("L_hand", "R_hand"),
    ("hand L", "hand R"),
    ("l", "r"),
    ("arm.L.001", "arm.R.001"),
    ("left hand", "right hand"),
    ("Left hand", "Right hand"),
    ("LEFT HAND", "RIGHT HAND"),
    ("handLeft", "handRight"),
    ("leftHand", "rightHand"),
    ("hand (left)", "hand (right)"),
    ("hand_left2", "hand_right2"),
    ("right wing.L", "right wing.R"),
]


@pytest.mark.parametrize(("one", "other"), SIDES)
def test_a_side_is_told_by_a_letter_or_a_word_of_its_own(one, other):
    assert mirrored_name(one) == other
    assert mirrored_name(other) == one


@pytest.mark.parametrize(
    "name", ["bright", "cleft lip", "handle 1", "tail", "Lroll", "upright", "x.1"]
)
def test_other_words_tell_of_no_side(name):
    assert mirrored_name(name) is None


def test_only_handles_that_are_both_there_are_a_pair():
    names = ("ear.L", "nose", "ear.R", "paw_l", "left eye", "right eye")
    handles = [Handle(id=10 + i, name=name, position=complex(i)) for i, name in enumerate(names)]
    assert pairs_by_name(handles) == {10: 12, 12: 10, 14: 15, 15: 14}


def test_handles_that_names_do_not_pair_are_paired_by_their_places():
    places = {
        "ear.L": 30 + 90j,
        "ear.R": 75 + 85j,  # where "c" would be the partner by place
        "a": 20 + 10j,
        "b": 81 + 9j,
        "c": 70 + 90j,
        "tail": 51 + 0j,
        "alone": 30 + 50j,
    }
    numbered = enumerate(places.items(), 1)
    handles = [Handle(id=i, name=name, position=place) for i, (name, place) in numbered]
    outline = np.array([0, 100, 100 + 100j, 100j])
    assert partners_of(handles, 50.0, outline) == {1: 2, 2: 1, 3: 4, 4: 3, 6: 6}
    assert partners_of(handles[2:4], 20.0, outline) == {3: 3}
    assert partners_of([], 50.0, outline) == {}

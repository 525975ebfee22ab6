"""Handles that mirror each other by their names."""

import numpy as np
import pytest
from messages import says

from app.document import Handle
from app.document.rig.mirror_names import (
    NO_PAIR,
    format_pairs,
    mirrored_handles,
    mirrored_handles_by_name,
    mirrored_name,
    parse_pairs,
)
from app.errors import LissomError

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
def test_a_side_is_reported_by_a_letter_or_a_word_of_its_own(one, other):
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
    assert mirrored_handles_by_name(handles) == {10: 12, 12: 10, 14: 15, 15: 14}


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
    assert mirrored_handles(handles, 50.0, outline) == {1: 2, 2: 1, 3: 4, 4: 3, 6: 6}
    assert mirrored_handles(handles[2:4], 20.0, outline) == {3: 3}
    assert mirrored_handles([], 50.0, outline) == {}


@pytest.mark.parametrize(
    ("one", "other"),
    [("near leg", "far leg"), ("Near leg", "Far leg"), ("legNear", "legFar"), ("NEAR 2", "FAR 2")],
)
def test_near_and_far_are_sides_too(one, other):
    assert mirrored_name(one) == other
    assert mirrored_name(other) == one


@pytest.mark.parametrize("name", ["nearly there", "linear", "farm", "afar"])
def test_near_and_far_are_words_of_their_own(name):
    assert mirrored_name(name) is None


PAIRS = (("vorn", "hinten"), ("Bein 1", "Bein 2"), ("L", "R"))


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Bein vorn", "Bein hinten"),
        ("Bein 1", "Bein 2"),
        ("Bein 1 vorn", "Bein 1 hinten"),  # of several words the last one counts
        ("hand.L", "hand.R"),
    ],
)
def test_words_and_whole_names_are_chosen(one, other):
    assert mirrored_name(one, PAIRS) == other
    assert mirrored_name(other, PAIRS) == one


def test_no_other_words_count_then_and_numbers_are_whole():
    for name in ("near leg", "left hand", "Bein 12", "vornehm"):
        assert mirrored_name(name, PAIRS) is None


def test_a_whole_name_comes_before_its_words():
    assert mirrored_name("left leg", (("left", "right"), ("left leg", "peg"))) == "peg"


@pytest.mark.parametrize("text", ["L/R, left/right, near/far", "a/b", " near / far ,, L/R ", ""])
def test_pairs_are_read_as_they_are_written(text):
    pairs = parse_pairs(text)
    assert parse_pairs(format_pairs(pairs)) == pairs
    assert len(pairs) == text.count("/")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("near", says(NO_PAIR, words="near")),
        ("near/far/middle", says(NO_PAIR)),
        ("near/far, far/away", "“far” is in two pairs"),
        ("near/near", "“near” is in two pairs"),
        ("/far", "must have two words"),
    ],
)
def test_what_is_no_pair_is_reported(text, words):
    with pytest.raises(LissomError, match=words):
        parse_pairs(text)

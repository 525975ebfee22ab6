"""About which handle springs swing."""

from dataclasses import replace

import numpy as np
import pytest
from animations import still_document, within

from app.document import Bone, Spring, handle_commands, spring_root

# A drawing like a U, and its handles: the tips of its arms are far from each other along it.
CORNERS = np.array(
    [10 + 10j, 110 + 10j, 110 + 80j, 70 + 80j, 70 + 30j, 50 + 30j, 50 + 80j, 10 + 80j]
)
PLACES = {"tip": 40 + 75j, "across": 80 + 75j, "foot": 30 + 20j, "heel": 90 + 20j}
TIP, ACROSS, FOOT, HEEL = range(4)


@pytest.fixture(scope="module")
def drawn():
    document = within(still_document(), CORNERS)
    for name, place in PLACES.items():
        document = handle_commands.add_handle(0, place, name=name)(document)
    return document.layers[0]


def spring(handle, **settings):
    return Spring(handle=handle, frequency=2.0, damping=0.2, **settings)


def swinging(layer, *springs, **changes):
    return replace(layer, springs=springs, **changes)


def test_a_root_is_nearest_along_the_drawing_and_not_across_a_gap(drawn):
    assert spring_root(swinging(drawn, spring(TIP)), spring(TIP)) == FOOT
    assert spring_root(swinging(drawn, spring(ACROSS)), spring(ACROSS)) == HEEL


def test_a_bone_leads_to_the_root(drawn):
    boned = swinging(drawn, spring(TIP), bones=(Bone(ends=(HEEL, TIP)),))
    assert spring_root(boned, spring(TIP)) == HEEL


def test_what_follows_itself_is_no_root_unless_it_is_off(drawn):
    foot = spring(FOOT)
    assert spring_root(swinging(drawn, spring(TIP), foot), spring(TIP)) == HEEL
    off = replace(foot, enabled=False)
    assert spring_root(swinging(drawn, spring(TIP), off), spring(TIP)) == FOOT


def test_a_root_that_follows_hands_on_its_own_root(drawn):
    tip = spring(TIP, root=FOOT)
    assert spring_root(swinging(drawn, tip), tip) == FOOT
    assert spring_root(swinging(drawn, tip, spring(FOOT, root=ACROSS)), tip) == ACROSS
    # In a circle nothing holds.
    around = swinging(drawn, tip, spring(FOOT, root=TIP))
    assert spring_root(around, tip) == HEEL


def test_without_a_handle_that_is_held_there_is_no_root(drawn):
    springs = [spring(handle) for handle in range(4)]
    assert spring_root(swinging(drawn, *springs), springs[0]) is None

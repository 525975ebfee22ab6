"""Layers that take turns: of each choice exactly one is seen, whatever is done to it."""

from dataclasses import replace

import numpy as np
import pytest
from documents import disc_document, disc_domain, random_command
from messages import says

from app.document import SWITCH, VISIBILITY, Channel, channel_commands as channels
from app.document.channels.cycles import Cycle
from app.document.commands import (
    scene_commands,
)
from app.document.commands.keys import (
    cycle_commands,
)
from app.document.commands.keys.retime import KEYS_COLLIDE
from app.document.commands.layers import (
    group_commands as groups,
    layer_commands,
    switch_group_commands as choices,
)
from app.document.layer import NO_KEY
from app.document.layers.switch_group import SwitchGroup
from app.document.model import NO_LAYER
from app.document.queries.layers.layer_tree import layer_tree
from app.document.queries.layers.switch_suggestions import (
    find_switch_members,
    suggest_switch_groups,
)
from app.document.queries.layers.visibility import is_visible
from app.document.settings import FrameRange
from app.errors import LissomError

MOUTH = Channel(SWITCH, part="mouth")

FRAMES = range(49)


@pytest.fixture
def mouths():
    """Three layers, of which the second is hidden."""
    document = disc_document()
    for name in ("ah", "oh"):
        layer = replace(
            document.layers[0],
            id=layer_commands.next_layer_id(document),
            name=name,
            domain=disc_domain(),
        )
        document = layer_commands.add_layer(layer)(document)
    return layer_commands.set_hidden(1, hidden=True)(document)


def seen(document, frames=FRAMES):
    """The ids of the layers that are seen, at each frame."""
    return [
        [each.id for each in document.layers if is_visible(document, each, frame)]
        for frame in frames
    ]


def test_exactly_one_is_seen_whatever_is_hidden(mouths):
    document = choices.create_switch_group("mouth", (0, 1, 2))(mouths)
    assert [layer.hidden for layer in document.layers] == [False] * 3
    # The one in front of those that were seen.
    assert seen(document) == [[2]] * 49
    document = choices.choose_at(1, 8)(document)
    assert seen(document, (0, 7.9, 8, 40)) == [[2], [2], [1], [1]]
    document = choices.choose_at(0, 12)(document)
    assert seen(document, (8, 12)) == [[1], [0]]
    hidden = layer_commands.set_hidden(0, hidden=True)(document)
    assert seen(hidden) == seen(document)
    assert [layer.id for layer in hidden.exported_layers] == [0, 1, 2]
    assert choices.choose_at(0, 20)(document) is document
    back = channels.delete_keys({MOUTH: {8}})(document)
    assert seen(back, (8, 11, 12)) == [[2], [2], [0]]
    moved = channels.move_keys({MOUTH: {8}}, 2)(document)
    assert seen(moved, (8, 10, 12)) == [[2], [1], [0]]
    with pytest.raises(LissomError, match=says(KEYS_COLLIDE, frame=12)):
        channels.move_keys({MOUTH: {8}}, 4)(document)


def test_what_took_turns_by_switches_still_does(mouths):
    document = layer_commands.set_hidden(1, hidden=False)(mouths)
    for identity, frames in ((0, (0, 10)), (1, (10, 20)), (2, (20, 48))):
        switches = tuple(
            VISIBILITY.key(frame, frames[0] <= frame < frames[1]) for frame in (0, 10, 20)
        )
        document = document.with_layer(
            replace(document.layer(identity), channels={(VISIBILITY.name, None): switches})
        )
    formed = choices.create_switch_group("mouth", (0, 1, 2))(document)
    assert seen(formed) == seen(document)
    assert formed.switch_groups[0].keys == (SWITCH.key(0, 0), SWITCH.key(10, 1), SWITCH.key(20, 2))
    apart = choices.delete_switch_group("mouth")(formed)
    assert apart.switch_groups == ()
    assert seen(apart) == seen(document)


def test_a_layer_that_leaves_is_seen_when_it_was(mouths):
    document = choices.create_switch_group("mouth", (0, 1, 2))(mouths)
    document = choices.choose_at(1, 8)(document)
    left = choices.remove_from_switch_group(1)(document)
    assert left.switch_groups[0].members == (0, 2)
    assert seen(left, (0, 8)) == [[2], [1, 2]]
    # A choice of one is none, and what remains is seen as before.
    alone = choices.remove_from_switch_group(0)(left)
    assert alone.switch_groups == ()
    assert seen(alone) == seen(left)
    gone = layer_commands.remove_layer(2)(left)
    assert gone.switch_groups == ()
    assert seen(gone) == [[layer for layer in now if layer != 2] for now in seen(left)]


def test_copies_take_turns_with_what_they_were_copied_from(mouths):
    document = choices.create_switch_group("mouth", (0, 1))(mouths)
    document = layer_commands.duplicate_layer(1)(document)
    assert document.switch_groups[0].members == (0, 1, 3)
    assert all(len(now) == 2 for now in seen(document))  # with the layer that is in no choice


def test_time_that_is_scaled_takes_turns_along(mouths):
    document = choices.create_switch_group("mouth", (0, 1))(mouths)
    document = choices.choose_at(1, 10)(document)
    scaled = scene_commands.scale_time(2.0)(document)
    assert scaled.switch_groups[0].keys[-1] == SWITCH.key(20, 1)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            choices.create_switch_group("eyes", (1, 2)),
            "'ah' is in two switches, 'mouth' and 'eyes'",
        ),
        (choices.create_switch_group("mouth", (2, 3)), says(NO_LAYER, identity=3)),
        (choices.create_switch_group("mouth", (2, 2)), "lists 2 twice"),
        (choices.create_switch_group(" ", (2, 1)), "needs a name"),
        (choices.create_switch_group("eyes", (2,)), "at least two layers"),
        (
            layer_commands.key_visibility(1, 5, visible=True),
            "has visibility keys and is in the switch",
        ),
        (choices.choose_at(2, 5), "'oh' is in no switch"),
        (choices.delete_switch_group("nose"), "no switch 'nose'"),
        (channels.move_keys({MOUTH: {7}}, 2), says(NO_KEY, frame=7)),
    ],
)
def test_what_cannot_be_chosen_is_refused(mouths, make, words):
    document = choices.create_switch_group("mouth", (0, 1))(mouths)
    with pytest.raises(LissomError, match=words):
        make(document)


def test_turns_are_in_order_and_of_the_choice():
    with pytest.raises(LissomError, match="at frames 8 and 4 are out of order"):
        SwitchGroup(name="mouth", members=(0, 1), keys=(SWITCH.key(8, 0), SWITCH.key(4, 1)))
    with pytest.raises(LissomError, match="At frame 8 the switch 'mouth' shows a layer"):
        SwitchGroup(name="mouth", members=(0, 1), keys=(SWITCH.key(8, 2),))


def test_one_layer_of_a_switch_is_visible_after_any_commands():
    rng = np.random.default_rng(5)
    document, formed = disc_document(), 0
    for _ in range(500):
        try:
            document = random_command(rng, document)(document)
        except LissomError:
            continue
        formed += bool(document.switch_groups)
        for choice in document.switch_groups:
            for frame in (0, 10, 25.5, 48):
                now = [i for i in choice.members if is_visible(document, document.layer(i), frame)]
                assert now == [choice.member_at(frame)]
    assert formed > 50


def test_what_was_hidden_is_shown_from_a_frame_on(mouths):
    document = layer_commands.key_visibility(1, 12, visible=True)(mouths)
    assert [1 in now for now in seen(document, (0, 11, 12, 30))] == [False, False, True, True]


def test_what_a_group_hides_comes_to_be_seen_alone(mouths):
    document = groups.group_layers((0, 2), "face/mouth")(mouths)
    document = groups.set_group_hidden("face", hidden=True)(document)
    assert seen(document, (0, 40)) == [[], []]
    shown = layer_commands.key_visibility(2, 10, visible=True)(document)
    assert seen(shown, (0, 9, 10, 40)) == [[], [], [2], [2]]
    chosen = choices.create_switch_group("mouth", (1, 2))(document)
    assert seen(chosen, (0, 40)) == [[1], [1]]
    # A group that is hidden later hides what takes turns, too.
    chosen = choices.choose_at(2, 10)(chosen)
    hidden = groups.set_group_hidden("face", hidden=True)(chosen)
    assert seen(hidden, (0, 10)) == [[1], []]


@pytest.mark.parametrize(
    ("group", "hidden", "offered"),
    [
        ("face/Mouth shapes", (), True),
        ("visemes", (1,), True),
        ("mouthpiece", (), False),
        ("left hand", (1,), True),
        ("hands", (), False),
        ("arm", (1,), False),
    ],
)
def test_groups_that_are_named_like_mouths_are_offered_as_choices(mouths, group, hidden, offered):
    document = layer_commands.set_hidden(1, hidden=False)(mouths)
    for identity in hidden:
        document = layer_commands.set_hidden(identity, hidden=True)(document)
    document = groups.group_layers((1, 2), group)(document)
    assert [layers for _, layers in suggest_switch_groups(document)] == [(1, 2)] * offered
    chosen = choices.create_switch_group("mouth", (1, 2))(document)
    assert suggest_switch_groups(chosen) == ()


@pytest.mark.parametrize(
    ("names", "hidden", "group", "offered"),
    [
        (("mouth/ah", "mouth/oh"), (), "", ["mouth"]),
        (("Mouth left / ah", "Mouth left/ oh"), (), "", ["Mouth left"]),
        (("mouth/ah", "mouth/oh"), (), "head", ["head/mouth"]),
        (("face/lips/ah", "face/lips/oh"), (), "", ["face/lips"]),
        (("ah", "mouth/oh"), (), "", []),
        (("mouth/ah", "nose/oh"), (), "", []),
        (("eyes/open", "eyes/shut"), (), "", []),
        (("eyes/open", "eyes/shut"), (2,), "", ["eyes"]),
        # Of a group in which one's name was taken elsewhere.
        (("mouth/ah", "oh"), (), "mouth", ["mouth"]),
        (("mouth/", "/oh"), (), "", []),
    ],
)
def test_layers_named_as_in_a_group_are_offered_as_a_choice(mouths, names, hidden, group, offered):
    document = layer_commands.set_hidden(1, hidden=False)(mouths)
    for identity, name in zip((1, 2), names, strict=True):
        document = layer_commands.rename_layer(identity, name)(document)
    for identity in hidden:
        document = layer_commands.set_hidden(identity, hidden=True)(document)
    document = groups.group_layers((1, 2), group)(document)
    assert suggest_switch_groups(document) == tuple((path, (1, 2)) for path in offered)
    # What is painted onto one of them takes no turns with it.
    painted = layer_commands.set_clipped(2, clipped=True)(document)
    assert suggest_switch_groups(painted) == ()


@pytest.fixture
def moods(mouths):
    """A mouth of two groups: laughing with two layers that switch, and a sad layer with teeth."""
    document = layer_commands.duplicate_layer(0)(mouths)
    document = groups.group_layers((0, 1), "mouth/laugh")(document)
    document = groups.group_layers((2, 3), "mouth/sad")(document)
    document = layer_commands.set_hidden(1, hidden=False)(document)
    document = choices.create_switch_group("laugh", (0, 1))(document)
    document = choices.create_switch_group("mouth", ("mouth/laugh", "mouth/sad"))(document)
    document = choices.choose_at("mouth/laugh", 0)(document)
    return choices.choose_at(0, 0)(document)


def shown(document, frame):
    return {each.id for each in document.layers if is_visible(document, each, frame)}


def test_a_group_switches_as_one_and_its_layers_keep_their_own_time(moods):
    document = choices.choose_at("mouth/sad", 10)(moods)
    document = choices.choose_at(1, 4)(document)
    document = layer_commands.key_visibility(3, 16, visible=False)(document)
    document = choices.choose_at("mouth/laugh", 20)(document)
    assert [shown(document, frame) for frame in (0, 4, 10, 16, 20)] == [
        {0}, {1}, {2, 3}, {2}, {1}
    ]  # fmt: skip
    assert {each.id for each in document.exported_layers} == {0, 1, 2, 3}
    # A hidden group is shown when its switch chooses it.
    hidden = groups.set_group_hidden("mouth/sad", hidden=True)(document)
    assert shown(hidden, 10) == {2, 3}


def test_switches_of_groups_follow_renamed_moved_dissolved_and_deleted_groups(moods):
    document = choices.choose_at("mouth/sad", 10)(moods)
    renamed = groups.rename_group("mouth", "lips")(document)
    switch = renamed.switch_group("mouth")
    assert switch.members == ("lips/laugh", "lips/sad")
    assert [key.value for key in switch.keys] == ["lips/laugh", "lips/sad"]
    assert shown(renamed, 12) == {2, 3}
    # Whoever leaves the switch keeps its visibility, but for layers that still switch.
    free = choices.remove_from_switch_group("mouth/sad")(document)
    assert [each.name for each in free.switch_groups] == ["laugh"]
    assert shown(free, 12) == {0, 2, 3}
    assert shown(free, 2) == {0}
    dissolved = groups.ungroup_layers("mouth/sad")(document)
    assert [each.name for each in dissolved.switch_groups] == ["laugh"]
    gone = layer_commands.remove_layer(3)(layer_commands.remove_layer(2)(document))
    assert [each.name for each in gone.switch_groups] == ["laugh"]
    assert shown(gone, 12) == {0}


def test_a_switch_of_groups_repeats_with_the_cycle_of_their_moving_layers(moods):
    cycle = Cycle(first=0, last=12)
    document = choices.choose_at("mouth/sad", 6)(moods)
    for identity in (0, 1, 2, 3):
        document = document.with_layer(replace(document.layer(identity), cycles=(cycle,)))
    assert [shown(document, frame) for frame in (2, 8, 14, 20)] == [{0}, {2, 3}, {0}, {2, 3}]
    # A still layer in a group needs no cycle of its own; a moving one does.
    still = document.with_layer(replace(document.layer(3), cycles=(), still=True))
    assert shown(still, 14) == {0}
    other = document.with_layer(replace(document.layer(3), cycles=()))
    assert shown(other, 14) == {2, 3}
    baked = cycle_commands.bake_cycle(2, 0, 48)(document)
    assert [shown(baked, frame) for frame in (2, 8, 14, 20)] == [{0}, {2, 3}, {0}, {2, 3}]


def test_members_of_a_switch_are_neither_nested_nor_in_two_switches(moods):
    with pytest.raises(LissomError, match="and also"):
        choices.create_switch_group("both", ("mouth", 2))(moods)
    with pytest.raises(LissomError, match="in two switches"):
        choices.create_switch_group("again", ("mouth/sad", 0))(moods)
    with pytest.raises(LissomError, match="no group"):
        choices.create_switch_group("other", ("nose", "ear"))(moods)


def test_subgroups_are_offered_as_members_and_chosen_layers_stand_for_whole_groups(moods):
    bare = replace(moods, switch_groups=())
    assert suggest_switch_groups(bare) == (("mouth", ("mouth/laugh", "mouth/sad")),)
    assert suggest_switch_groups(moods) == ()
    assert find_switch_members(bare, (0, 1, 2, 3)) == ("mouth/laugh", "mouth/sad")
    assert set(find_switch_members(bare, (2, 3))) == {2, 3}
    assert find_switch_members(bare, (0, 2, 3)) == (0, "mouth/sad")


def test_the_tree_lists_groups_of_a_switch_with_their_layers(moods):
    rows = layer_tree(moods, toggled={"choice mouth", "choice laugh"})
    assert [(row.name, row.depth, row.member) for row in rows] == [
        ("mouth", 0, "mouth"),
        ("mouth", 1, None),
        ("sad", 2, "mouth/sad"),
        *[(moods.layer(each).name, 3, each) for each in rows[2].layers],
        ("laugh", 2, "mouth/laugh"),
        ("laugh", 3, None),
        *[(moods.layer(each).name, 4, each) for each in rows[-3].layers],
    ]


def turning(document, *, cycle, turns, of=(0, 1, 2)):
    """Three layers that take turns, of which some have a cycle."""
    document = choices.create_switch_group("mouth", (0, 1, 2))(document)
    for identity in of:
        document = document.with_layer(replace(document.layer(identity), cycles=(cycle,)))
    choice = replace(document.switch_groups[0], keys=tuple(SWITCH.key(*turn) for turn in turns))
    return replace(document, switch_groups=(choice,), frames=FrameRange(0, 100))


TURNS = ((0, 0), (4, 1), (9, 2))


def one_of(document, frame):
    """The layer of three that is seen at a frame."""
    (found,) = (each.id for each in document.layers if is_visible(document, each, frame))
    return found


def test_turns_repeat_with_the_cycle_of_all_layers(mouths):
    document = turning(mouths, cycle=Cycle(first=0, last=12, until=36), turns=TURNS)
    once = [0] * 4 + [1] * 5 + [2] * 3
    # After the last repeat the first one of the stretch is seen.
    assert [one_of(document, frame) for frame in range(41)] == [*once * 3, *[0] * 5]
    assert one_of(document, 28.5) == 1
    # The one at its beginning may be said at its end, too.
    again = turning(mouths, cycle=Cycle(first=0, last=12), turns=(*TURNS, (12, 0)))
    assert [one_of(again, frame) for frame in range(100)] == (once * 9)[:100]
    # With another end, with turns in the repeats, or where a layer goes on otherwise, they do not.
    for turns, of, expected in (
        ((*TURNS, (12, 1)), (0, 1, 2), 1),
        ((*TURNS, (30, 1)), (0, 1, 2), 2),
        (TURNS, (0, 2), 2),
    ):
        own = turning(mouths, cycle=Cycle(first=0, last=12), turns=turns, of=of)
        assert one_of(own, 14) == expected


def test_what_is_chosen_in_a_repeat_is_chosen_in_all(mouths):
    document = turning(mouths, cycle=Cycle(first=0, last=12), turns=TURNS)
    changed = choices.choose_at(1, 30)(document)
    assert changed is document
    changed = choices.choose_at(0, 30)(document)
    assert [one_of(changed, frame) for frame in (5, 6, 17, 18, 29, 30, 33)] == [1, 0, 1, 0, 1, 0, 2]


@pytest.mark.parametrize("until", [None, 36])
def test_turns_made_into_keys_are_seen_as_before(mouths, until):
    document = turning(mouths, cycle=Cycle(first=0, last=12, until=until), turns=TURNS)
    keyed = document
    for identity in (0, 1, 2):
        keyed = cycle_commands.bake_cycle(identity, 0, 100)(keyed)
        assert seen(keyed, range(101)) == seen(document, range(101))
    stopped = document
    for identity in (0, 1, 2):
        stopped = cycle_commands.delete_cycle(identity, 0)(stopped)
        assert [one_of(stopped, frame) for frame in (0, 4, 9, 11, 12, 50)] == [0, 1, 2, 2, 0, 0]

"""Layers as a tree: groups and choices, and what is in them."""

from dataclasses import replace

import pytest
from documents import disc_document, disc_domain

from app.document.commands.layers import (
    group_commands as groups,
    layer_commands as layers,
    switch_group_commands as choices,
)
from app.document.queries.layers.layer_tree import layer_tree


@pytest.fixture
def document():
    """Six layers, from 0 behind all others to 5 in front."""
    document = disc_document()
    for number in range(1, 6):
        layer = replace(
            document.layers[0],
            id=layers.next_layer_id(document),
            name=f"layer {number}",
            domain=disc_domain(),
        )
        document = layers.add_layer(layer)(document)
    return document


def listed(document, *toggled, kept=()):
    return [
        "  " * row.depth + row.name + ("" if row.is_open else " +")
        for row in layer_tree(document, toggled, kept)
    ]


def test_without_groups_and_choices_it_is_the_order_of_painting(document):
    assert listed(document) == ["layer 5", "layer 4", "layer 3", "layer 2", "layer 1", "layer"]
    assert all(row.layers == (row.layer.id,) for row in layer_tree(document))


def test_groups_hold_what_is_in_them(document):
    document = groups.group_layers((1, 2), "body/legs")(document)
    document = groups.group_layers((3,), "body")(document)
    assert listed(document) == [
        "layer 5",
        "layer 4",
        "body",
        "  layer 3",
        "  legs",
        "    layer 2",
        "    layer 1",
        "layer",
    ]
    rows = {row.name: row for row in layer_tree(document)}
    assert rows["body"].layers == (3, 2, 1)
    assert rows["legs"].layers == (2, 1)
    assert listed(document, "group body") == ["layer 5", "layer 4", "body +", "layer"]
    # What is posed is listed all the same.
    assert listed(document, "group body", kept={1}) == [
        "layer 5",
        "layer 4",
        "body +",
        "    layer 1",
        "layer",
    ]


def test_layers_that_take_turns_are_one_row_where_the_foremost_is(document):
    document = choices.create_switch_group("mouth", (1, 4))(document)
    assert listed(document) == ["layer 5", "mouth +", "layer 3", "layer 2", "layer"]
    assert listed(document, "choice mouth") == [
        "layer 5",
        "mouth",
        "  layer 4",
        "  layer 1",
        "layer 3",
        "layer 2",
        "layer",
    ]


def test_a_choice_in_a_group(document):
    document = groups.group_layers((3, 4), "face")(document)
    document = choices.create_switch_group("mouth", (2, 4))(document)
    assert listed(document, "choice mouth") == [
        "layer 5",
        "face",
        "  mouth",
        "    layer 4",
        "    layer 2",
        "  layer 3",
        "layer 1",
        "layer",
    ]


def test_a_group_that_others_lie_amid_has_a_row_for_each_run(document):
    document = groups.group_layers((1, 2, 3), "arm")(document)
    document = layers.move_layer(5, 2)(document)
    rows = [row for row in layer_tree(document) if row.group]
    assert len({row.key for row in rows}) == len(rows)
    assert sorted(layer for row in rows for layer in row.layers) == sorted(
        each.id for each in document.layers if each.group == "arm"
    )

"""Effects of layers in the compositing: which parts they change, and at which frames."""

import pytest
from documents import disc_document

from app.document import (
    TINT,
    Channel,
    CompositeGroup,
    channel_commands,
    composite_layers,
    layer_commands,
)
from app.errors import LissomError

RED = (1.0, 0.0, 0.0)
WHITE = (1.0, 1.0, 1.0)


def set_tint(document, colour, frame=0, layer=0):
    return channel_commands.set_key(Channel(TINT, layer), frame, colour)(document)


def composited(document, frame=0):
    return composite_layers(document, {each.id: each.id for each in document.layers}, frame)


def test_tint_is_passed_to_the_compositing_unless_it_is_white():
    document = set_tint(set_tint(disc_document(), RED), WHITE, frame=10)
    (tinted,) = composited(document)
    assert (tinted.parts, tinted.effects) == ((0,), {"layer_tint": RED})
    (halfway,) = composited(document, 5)
    assert halfway.effects["layer_tint"] == pytest.approx((1.0, 0.5, 0.5))
    assert composited(document, 10) == (0,)


def test_tint_of_a_base_leaves_what_is_clipped_to_it():
    document = layer_commands.duplicate_layer(0)(disc_document())
    document = layer_commands.set_clipped(1, clipped=True)(set_tint(document, RED))
    (stack,) = composited(document)
    base, cut = stack.parts
    assert base == CompositeGroup((0,), effects={"layer_tint": RED})
    assert (cut.parts, cut.clipped, dict(cut.effects)) == ((1,), True, {})
    assert dict(stack.effects) == {}


@pytest.mark.parametrize("colour", [(2.0, 0.0, 0.0), (0.5, 0.5), ()])
def test_colour_is_refused_that_is_not_three_levels(colour):
    with pytest.raises(LissomError, match="A colour must be three numbers from 0 to 1"):
        set_tint(disc_document(), colour)

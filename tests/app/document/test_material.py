"""Painted stiffness and bones in the document."""

from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, RADIUS, disc_document, disc_domain
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from app.document import (
    Bone,
    Meshing,
    brushed_stiffness,
    handle_commands,
    layer_commands,
    shape_commands,
    stiff_outline,
    stiffness_commands,
    with_stiffness,
)
from app.document.layer import NO_HANDLE
from app.errors import LissomError
from engine.domain.material.limb import BONE_STAYS
from engine.errors import EngineError
from engine.maps import Boundary, HarmonicMap
from engine.maps.stiffness import STIFFNESS_SHAPE

LEFT, RIGHT = CENTRE - 70, CENTRE + 70


def boned():
    """A disc with handles on its left, right and top, and a bone from left to right."""
    document = disc_document()
    for name, place in (("hand.L", LEFT), ("hand.R", RIGHT), ("top", CENTRE + 60j)):
        document = handle_commands.add_handle(0, place, name=name)(document)
    return stiffness_commands.add_bone(0, (0, 1), 20.0)(document)


def boundary_of(layer):
    domain = layer.domain
    return with_stiffness(layer, Boundary.sample(domain))


def test_a_stroke_is_painted_on_the_outline_it_reaches_and_cleared():
    document = disc_document()
    (layer,) = document.layers
    painted, reached = brushed_stiffness(layer, [CENTRE], radius=40, amount=9.0)
    assert (painted, reached) == (None, False)
    assert (
        stiffness_commands.paint_stiffness(0, [CENTRE], radius=40, amount=9.0)(document) is document
    )
    stiff = stiffness_commands.paint_stiffness(0, [RIGHT], radius=50, amount=9.0)(document)
    (layer,) = stiff.layers
    assert layer.keys is document.layers[0].keys
    assert not layer.stiffness.flags.writeable
    assert layer.stiffness[0] > 5
    assert layer.stiffness[len(layer.stiffness) // 2] == 1
    boundary = boundary_of(layer)
    assert boundary.stiffness[0] == pytest.approx(layer.stiffness[0])
    # Painted over as much with the usual one, nothing is left.
    soft = stiffness_commands.paint_stiffness(0, [RIGHT], radius=50, amount=1.0, softness=0.0)(
        stiff
    )
    again = stiffness_commands.paint_stiffness(0, [RIGHT], radius=90, amount=1.0, softness=0.0)(
        soft
    )
    assert again.layers[0].stiffness is None
    assert stiffness_commands.clear_stiffness(0)(stiff).layers[0].stiffness is None
    assert stiffness_commands.clear_stiffness(0)(document) is document


def test_bones_come_and_go_with_their_handles_and_their_names_do_not_matter():
    document = boned()
    assert document.layers[0].bones == (Bone(ends=(0, 1), stiffness=20.0),)
    changed = stiffness_commands.set_bone_stiffness(0, (1, 0), 50.0)(document)
    assert changed.layers[0].bones[0].stiffness == 50
    assert stiffness_commands.set_bone_stiffness(0, (1, 0), 50.0)(changed) is changed
    hidden = stiffness_commands.set_bones_visible(0, shown=False)(document)
    assert not hidden.layers[0].bones[0].is_shown
    assert_array_equal(
        boundary_of(hidden.layers[0]).stiffness, boundary_of(document.layers[0]).stiffness
    )
    assert stiffness_commands.set_bones_visible(0, shown=True)(document) is document
    renamed = handle_commands.rename_handle(0, 0, "paw")(document)
    assert renamed.layers[0].bones == document.layers[0].bones
    assert handle_commands.remove_handles(0, {1})(document).layers[0].bones == ()
    assert handle_commands.remove_handles(0, {2})(document).layers[0].bones
    assert stiffness_commands.remove_bone(0, (1, 0))(document).layers[0].bones == ()
    copied = layer_commands.duplicate_layer(0)(document)
    assert copied.layers[1].bones == document.layers[0].bones


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (
            stiffness_commands.add_bone(0, (1, 0)),
            "A bone from 'hand.R' to 'hand.L' already exists",
        ),
        (stiffness_commands.add_bone(0, (0, 0)), "connect two different handles"),
        (stiffness_commands.add_bone(0, (0, 9)), says(NO_HANDLE, identity=9)),
        (stiffness_commands.add_bone(0, (0, 2), 101.0), "from 1/30 to 100, not 101"),
        (stiffness_commands.add_bone(0, (0, 2), float("nan")), "from 1/30 to 100, not nan"),
        (stiffness_commands.remove_bone(0, (0, 2)), "There is no bone from 'hand.L' to 'top'"),
        (stiffness_commands.set_bone_stiffness(0, (1, 2), 3.0), "There is no bone"),
        (stiffness_commands.set_bone_stiffness(0, (0, 1), 0.0), "from 1/30 to 100, not 0"),
        (
            stiffness_commands.paint_stiffness(0, [CENTRE], radius=-1, amount=2.0),
            "radius of a brush must be above",
        ),
        (
            stiffness_commands.paint_stiffness(0, [CENTRE], radius=9, amount=0.01),
            "from 1/30 to 100",
        ),
    ],
)
def test_what_is_not_possible_says_why(command, message):
    with pytest.raises(LissomError, match=message):
        command(boned())


def test_a_bone_that_would_leave_the_drawing_is_refused_and_one_that_came_to_does_nothing():
    document = disc_document()
    points = CENTRE + RADIUS * np.exp(2j * np.pi * np.arange(24) / 24)
    points[5:8] = CENTRE + 5 * np.exp(2j * np.pi * np.arange(5, 8) / 24)
    domain = replace(disc_domain(24), outline=points)
    (layer,) = document.layers
    rest = layer.keys[0].pose.with_map(_identity(domain))
    notched = shape_commands.replace_domain(0, domain, Meshing(), [rest])(document)
    for place in (CENTRE + 60 * np.exp(1.05j), CENTRE + 60 * np.exp(2.1j)):
        notched = handle_commands.add_handle(0, complex(place))(notched)
    with pytest.raises(EngineError, match=says(BONE_STAYS)):
        stiffness_commands.add_bone(0, (0, 1))(notched)
    whole = handle_commands.add_handle(0, CENTRE + 60 * np.exp(1.05j))(document)
    whole = handle_commands.add_handle(0, CENTRE + 60 * np.exp(2.1j))(whole)
    whole = stiffness_commands.add_bone(0, (0, 1))(whole)
    assert boundary_of(whole.layers[0]).stiffness.max() > 9
    rest = whole.layers[0].keys[0].pose.with_map(_identity(domain))
    cut = shape_commands.replace_domain(0, domain, Meshing(), [rest])(whole)
    assert (boundary_of(cut.layers[0]).stiffness == 1).all()


def _identity(domain):
    return HarmonicMap.identity(domain.cage, domain.holes)


def test_the_larger_of_what_is_painted_and_of_bones_counts():
    document = boned()
    (layer,) = document.layers
    bone = boundary_of(layer).stiffness
    for amount, wanted in ((5.0, np.maximum(5.0, bone)), (0.2, np.where(bone > 1, bone, 0.2))):
        painted = replace(layer, stiffness=np.full(12, amount))
        assert_allclose(boundary_of(painted).stiffness, wanted)
    soft = replace(layer.bones[0], stiffness=0.1)
    assert_allclose(boundary_of(replace(layer, bones=(soft,))).stiffness.min(), 0.1)
    points, stiffness = stiff_outline(layer)
    assert points[0] == layer.domain.outline[0]
    assert stiffness.max() == pytest.approx(20)


def test_material_stays_in_its_place_on_another_domain():
    document = stiffness_commands.paint_stiffness(0, [RIGHT], radius=60, amount=30.0)(boned())
    (before,) = document.layers
    domain = disc_domain(40)
    rest = before.keys[0].pose.with_map(_identity(domain))
    (after,) = shape_commands.replace_domain(0, domain, Meshing(), [rest])(document).layers
    assert len(after.stiffness) == 40
    old, new = boundary_of(before), boundary_of(after)
    assert after.bones == before.bones
    assert new.stiffness[0] == pytest.approx(old.stiffness[0], rel=0.05)
    assert new.stiffness[np.argmin(new.points.real)] == pytest.approx(1, abs=0.2)
    assert_array_equal(
        stiffness_commands.clear_stiffness(0)(document).layers[0].bones, before.bones
    )


def test_material_is_mirrored_as_handles_are():
    document = stiffness_commands.paint_stiffness(0, [RIGHT], radius=60, amount=30.0)(boned())
    document = stiffness_commands.remove_bone(0, (0, 1))(document)
    document = stiffness_commands.add_bone(0, (2, 0), 40.0)(document)
    mirrored = stiffness_commands.mirror_stiffness(0)(document)
    (layer,) = mirrored.layers
    assert [bone.ends for bone in layer.bones] == [(2, 0), (2, 1)]
    assert layer.bones[1].stiffness == 40
    outline, stiffness = layer.domain.outline, layer.stiffness
    opposite = np.abs(outline[:, None] - (2 * layer.axis - outline.conj())).argmin(axis=0)
    assert_allclose(stiffness, stiffness[opposite], rtol=1e-9)
    assert stiffness.max() == document.layers[0].stiffness.max()
    assert stiffness_commands.mirror_stiffness(0)(mirrored) is mirrored


def test_a_layer_refuses_material_that_does_not_fit():
    (layer,) = boned().layers
    with pytest.raises(EngineError, match=says(STIFFNESS_SHAPE, count=12)):
        replace(layer, stiffness=np.ones(3))
    with pytest.raises(LissomError, match="bone ends at handle 7, which does not exist"):
        replace(layer, bones=(Bone(ends=(0, 7)),))
    with pytest.raises(LissomError, match="Two bones connect handles"):
        replace(layer, bones=(*layer.bones, Bone(ends=(1, 0))))

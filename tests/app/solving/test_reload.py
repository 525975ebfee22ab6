"""A drawing's changed file under the rig of its layers."""

from dataclasses import replace

import numpy as np
import pytest
from layered import openraster
from PIL import Image, ImageDraw

from app.cut_out import CutOut, Mask
from app.document import (
    Attachment,
    FileLayer,
    SwitchGroup,
    handle_commands,
    key_commands,
    layer_commands,
)
from app.document.keyframe import Target
from app.document.layers.drawing_files import LayerOrigin
from app.document.settings import Meshing
from app.errors import LissomError
from app.solving.reload.alignment import PlacedPicture, align_pictures
from app.solving.reload.apply import start_reload, step_reload
from app.solving.reload.margin import extend_under, has_margin_of
from app.solving.reload.matching import match_layers
from app.solving.reload.pictures import move_cut_out
from app.solving.reload.plan import Change, find_drawing, plan_reload
from app.solving.reload.shifting import shift_layer
from app.solving.reload.table import reload_lines
from app.storage.pictures.picture import decode_picture
from app.storage.project_file import load_project, save_project
from app.storage.scenes.drawings import open_layered, open_picture, read_drawing

SIZE = (300, 260)
MESHING = Meshing(triangles=1_000, detail="coarse")


def limb(width, height, seed, *, boot=False):
    """Return a rounded bar with lines of its own on it."""
    image = Image.new("RGBA", (width, height))
    draw = ImageDraw.Draw(image)
    draw.rounded_rectangle((1, 1, width - 2, height - 2), 9, fill=(200, 90 + seed, 60, 255))
    for x, y in np.random.default_rng(seed).integers(0, [width, height], (9, 2)).tolist():
        draw.line((x, y, x + 7, y + 8), fill=(20, 10, 10, 255), width=2)
    if boot:
        draw.rectangle((1, height - 18, width - 2, height - 2), fill=(20, 20, 90, 255))
    return image


def layers():
    """Return layers from the front: name, picture, left, top, group, attributes."""
    return [
        ["open", limb(40, 20, 1), 60, 10, "mouth", 'visibility="hidden"'],
        ["shut", limb(40, 12, 2), 60, 14, "mouth", ""],
        ["arm", limb(30, 120, 3), 130, 60, "limbs", ""],
        ["leg", limb(36, 110, 4), 80, 140, "limbs", ""],
        ["body", limb(90, 110, 5), 50, 40, "", ""],
    ]


def write(path, stack, size=SIZE):
    text, group = "", ""
    for index, (name, _picture, left, top, own, more) in enumerate(stack):
        if own != group:
            text += ("</stack>" if group else "") + (f'<stack name="{own}">' if own else "")
            group = own
        text += f'<layer name="{name}" src="data/{index}.png" x="{left}" y="{top}" {more}/>'
    text += "</stack>" if group else ""
    path.write_bytes(openraster(size, text, [each[1] for each in stack]))


@pytest.fixture(scope="module")
def rigged(tmp_path_factory):
    """A leg with a raised foot that hangs on the body, and a switch of two mouths."""
    path = tmp_path_factory.mktemp("reload") / "man.ora"
    write(path, layers())
    opened = open_layered(path, MESHING)
    document = opened.document
    leg = by_name(document, "leg")
    hip, foot = 98 + 105j, 98 + 20j
    document = document.with_layer(replace(leg, anchor=hip))
    for place in (hip, foot):
        document = handle_commands.add_handle(leg.id, place)(document)
    leg = document.layer(leg.id)
    pose = leg.keys[0].pose
    turned = pose.with_map(leg.map_of(pose).moved(np.exp(0.3j), hip * (1 - np.exp(0.3j))))
    targets = {
        each.id: Target(position=hip + np.exp(0.3j) * (each.position - hip)) for each in leg.handles
    }
    document = key_commands.insert_key(leg.id, 10, replace(turned, targets=targets))(document)
    joint = Attachment(parent=by_name(document, "body").id, parent_point=98 + 112j)
    document = layer_commands.attach_layer(leg.id, hip, joint)(document)
    mouths = tuple(by_name(document, name).id for name in ("shut", "open"))
    return replace(document, switch_groups=(SwitchGroup(name="mouth", members=mouths),))


def by_name(document, name):
    return next(layer for layer in document.layers if layer.name == name)


def planned(document, path, **how):
    drawing = find_drawing(document, path.name)
    pictures = {each.id: decode_picture(each.picture.data, each.name) for each in document.layers}
    changed = read_drawing(path, is_merged=drawing.is_merged)
    return plan_reload(document, drawing, changed, pictures, **how)


def reloaded(document, tmp_path, stack, size=SIZE, **how):
    path = tmp_path / "man.ora"
    write(path, stack, size)
    plan = planned(document, path, **how)
    reloading = start_reload(plan)
    while not reloading.is_over:
        reloading = step_reload(reloading)
    after = reloading.command(document)
    save_project(tmp_path / "after.lissom", after)
    again = load_project(tmp_path / "after.lissom")
    assert again.drawings == after.drawings
    assert [each.origin for each in again.layers] == [each.origin for each in after.layers]
    return plan, after, reloading


def changes(plan):
    return {each.name: each.change for each in plan.changes if each.change is not Change.SAME}


def test_the_same_file_changes_nothing(rigged, tmp_path):
    plan, after, _ = reloaded(rigged, tmp_path, layers())
    assert plan.is_empty
    assert after.layers == rigged.layers


def test_a_redrawn_layer_keeps_handles_keys_and_joint(rigged, tmp_path):
    stack = layers()
    wide = Image.new("RGBA", (70, 118))
    wide.paste(limb(36, 110, 4, boot=True))
    ImageDraw.Draw(wide).ellipse((2, 90, 68, 116), fill=(20, 20, 90, 255))
    stack[3][1] = wide
    plan, after, reloading = reloaded(rigged, tmp_path, stack)
    assert changes(plan) == {"leg": Change.REDRAWN}
    assert not reloading.all_notices
    before, leg = by_name(rigged, "leg"), by_name(after, "leg")
    assert leg.picture.size == (70, 118)
    assert (leg.handles, leg.anchor) == (before.handles, before.anchor)
    assert leg.attachments == before.attachments
    for key, old in zip(leg.keys, before.keys, strict=True):
        assert key.pose.certificate.is_certified
        assert key.pose.targets == old.pose.targets
        assert max(leg.target_errors(key.pose).values()) < 1
    others = [each for each in after.layers if each is not leg]
    assert all(each in rigged.layers for each in others)


def test_a_redrawn_layer_of_the_same_shape_is_not_solved_again(rigged, tmp_path):
    stack = layers()
    stack[3][1] = limb(36, 110, 4, boot=True)
    pixels = np.array(stack[3][1])
    pixels[..., 3] = np.array(layers()[3][1])[..., 3]
    stack[3][1] = Image.fromarray(pixels)
    plan, after, reloading = reloaded(rigged, tmp_path, stack)
    assert changes(plan) == {"leg": Change.REDRAWN}
    assert not reloading.resolvers
    before, leg = by_name(rigged, "leg"), by_name(after, "leg")
    assert leg.domain is before.domain
    assert leg.keys == before.keys
    assert leg.picture is not before.picture


def test_a_moved_layer_moves_with_its_motion(rigged, tmp_path):
    stack = layers()
    stack[3][2:4] = [86, 136]
    plan, after, _ = reloaded(rigged, tmp_path, stack)
    assert changes(plan) == {"leg": Change.MOVED}
    before, leg = by_name(rigged, "leg"), by_name(after, "leg")
    by = 6 + 4j
    points = np.array([90 + 50j, 100 + 80j])
    for key, old in zip(leg.keys, before.keys, strict=True):
        moved = leg.map_of(key.pose)(points + by) - before.map_of(old.pose)(points)
        np.testing.assert_allclose(moved, by, rtol=0, atol=1e-9)
    assert leg.anchor == before.anchor + by
    # The joint comes along on the body.
    assert leg.attachments[0].parent_point == 104 + 116j
    # A body that moves takes the joint of its leg along, and the leg stays as it is drawn.
    stack = layers()
    stack[4][2] = 70
    _, after, _ = reloaded(rigged, tmp_path, stack)
    (joint,) = by_name(after, "leg").attachments
    assert joint.parent_point + joint.offset == 98 + 112j


def test_a_trimmed_margin_is_no_change(rigged, tmp_path):
    stack = layers()
    wide = Image.new("RGBA", (80, 200))
    wide.paste(stack[2][1], (20, 50))
    stack[2] = ["arm", wide, 110, 10, "limbs", ""]
    plan, after, _ = reloaded(rigged, tmp_path, stack)
    assert changes(plan) == {}
    assert by_name(after, "arm") is by_name(rigged, "arm")


def test_names_groups_order_new_and_missing_layers_follow_the_file(rigged, tmp_path):
    stack = layers()
    hat = ["hat", limb(60, 20, 9), 60, 0, "arms and legs", 'opacity="0.5"']
    stack[2][0], stack[2][4] = "left arm", "arms and legs"
    stack[3][4], stack[3][5] = "arms and legs", 'visibility="hidden"'
    # The leg comes in front of the arm, and one mouth is gone.
    stack = [stack[1], stack[3], hat, stack[2], stack[4]]
    plan, after, reloading = reloaded(rigged, tmp_path, stack)
    assert changes(plan) == {"hat": Change.NEW, "open": Change.GONE}
    names = [(each.name, each.group) for each in after.layers]
    assert names == [
        ("body", ""),
        ("left arm", "arms and legs"),
        ("hat", "arms and legs"),
        ("leg", "arms and legs"),
        ("shut", "mouth"),
        ("open", "mouth"),
    ]
    assert by_name(after, "leg").hidden
    assert by_name(after, "hat").opacity == pytest.approx(0.5)
    # A switch decides about its layer, which stays with a word.
    assert by_name(after, "open").name == "open"
    assert after.switch_groups == rigged.switch_groups
    assert "open" in reloading.all_notices[-1]
    # Nothing is new or gone when the same file comes again, and what came back is as it was.
    write(tmp_path / "man.ora", stack)
    assert planned(after, tmp_path / "man.ora").is_empty
    _, back, _ = reloaded(after, tmp_path, layers())
    assert {each.name for each in back.layers} == {"open", "shut", "arm", "leg", "body", "hat"}
    assert by_name(back, "hat").hidden
    assert not by_name(back, "leg").hidden


def test_changes_in_the_project_win_and_deleted_layers_stay_deleted(rigged, tmp_path):
    arm = by_name(rigged, "arm")
    document = layer_commands.set_opacity(arm.id, 0.3)(rigged)
    document = layer_commands.rename_layer(arm.id, "wing")(document)
    document = layer_commands.remove_layer(by_name(rigged, "shut").id)(document)
    stack = layers()
    stack[2][0], stack[2][5] = "left arm", 'opacity="0.8"'
    plan, after, _ = reloaded(document, tmp_path, stack)
    assert changes(plan) == {}
    assert by_name(after, "wing").opacity == pytest.approx(0.3)
    assert len(after.layers) == 4


@pytest.mark.parametrize("kept", [(20, 30, 300, 260), (0, 0, 240, 250), (-30, -10, 340, 300)])
def test_another_canvas_moves_the_scene_with_it(rigged, tmp_path, kept):
    left, top, right, bottom = kept
    stack = [[n, p, x - left, y - top, g, m] for n, p, x, y, g, m in layers()]
    size = (right - left, bottom - top)
    plan, after, _ = reloaded(rigged, tmp_path, stack, size)
    assert changes(plan) == {}
    assert after.canvas == size
    by = plan.scene_shift
    assert by == -left + 1j * (bottom - SIZE[1])
    for layer, old in zip(after.layers, rigged.layers, strict=True):
        assert layer.corner == old.corner + by
    (joint,) = by_name(after, "leg").attachments
    assert joint.parent_point == 98 + 112j + by


def test_one_layer_is_reloaded_and_the_others_are_compared_later(rigged, tmp_path):
    stack = layers()
    stack[3][1], stack[2][1] = limb(36, 110, 40), limb(30, 120, 30)
    leg = by_name(rigged, "leg")
    plan, after, _ = reloaded(rigged, tmp_path, stack, only=[leg.id])
    assert changes(plan) == {"leg": Change.REDRAWN}
    assert by_name(after, "arm") is by_name(rigged, "arm")
    assert changes(planned(after, tmp_path / "man.ora")) == {"arm": Change.REDRAWN}


def test_a_project_without_notes_of_its_file_is_reloaded_by_names(rigged, tmp_path):
    document = replace(
        rigged, drawings=(), layers=tuple(replace(each, origin=None) for each in rigged.layers)
    )
    stack = layers()
    stack[3][1] = limb(36, 110, 40)
    plan, after, _ = reloaded(document, tmp_path, stack)
    assert changes(plan) == {"leg": Change.REDRAWN}
    assert all(each.origin is not None for each in after.layers)
    assert after.drawings[0].name == "man.ora"


def test_another_drawing_is_refused_and_a_layer_without_a_shape_stays(rigged, tmp_path):
    path = tmp_path / "man.ora"
    write(
        path, [["tree", limb(50, 50, 77), 0, 0, "", ""], ["bush", limb(20, 50, 78), 90, 0, "", ""]]
    )
    with pytest.raises(LissomError, match=r"none of the layers of man\.ora"):
        planned(rigged, path)
    stack = layers()
    dot = Image.new("RGBA", (36, 110))
    dot.putpixel((18, 50), (9, 9, 9, 255))
    stack[3][1] = dot
    _, after, reloading = reloaded(rigged, tmp_path, stack)
    assert by_name(after, "leg") is not None
    assert by_name(after, "leg").picture is by_name(rigged, "leg").picture
    assert "leg: kept as it was" in reloading.all_notices[0]


def test_a_scaled_drawing_is_refused(rigged, tmp_path):
    path = tmp_path / "man.ora"
    twice = [
        [name, picture.resize((2 * picture.width, 2 * picture.height)), 2 * left, 2 * top, *rest]
        for name, picture, left, top, *rest in layers()
    ]
    write(path, twice, (2 * SIZE[0], 2 * SIZE[1]))
    with pytest.raises(LissomError, match=r"scaled to 200%.*300 × 260"):
        planned(rigged, path)


def test_the_table_has_a_line_for_each_layer(rigged, tmp_path):
    stack = layers()
    stack[3][2] = 84
    stack[2][0] = "left arm"
    plan, _, _ = reloaded(rigged, tmp_path, stack)
    lines = list(reload_lines(plan))
    assert len(lines) == 5
    assert "moved  leg   by +4, +0 pixels" in lines
    assert "same   arm   renamed to left arm" in lines


def test_a_picture_that_was_extended_keeps_artwork_and_handles(tmp_path):
    path = tmp_path / "arm.png"
    arm = limb(60, 160, 6)
    arm.save(path)
    document = open_picture(path, MESHING).document
    document = handle_commands.add_handle(0, 30 + 20j)(document)
    wide = Image.new("RGBA", (100, 190))
    wide.paste(arm, (0, 30))
    ImageDraw.Draw(wide).rectangle((40, 60, 96, 80), fill=(5, 5, 90, 255))
    wide.save(path)
    reloading = start_reload(planned(document, path))
    while not reloading.is_over:
        reloading = step_reload(reloading)
    after = reloading.command(document)
    (layer,) = after.layers
    assert after.canvas == (100, 190)
    assert layer.corner == 0
    assert layer.handles == document.layers[0].handles


def file_layers(*names):
    return [FileLayer(name=name, number=number) for name, number in names]


def test_layers_match_by_id_then_path_then_name_then_pixels():
    def never(_one, _other):
        return False

    before = file_layers(("a", 1), ("b", 2), ("c", 0), ("d", 0))
    # Both were renamed, and the ids say which is which.
    now = file_layers(("d", 0), ("c2", 0), ("x", 2), ("y", 1))
    assert match_layers(before, now, never) == {0: 3, 1: 2, 3: 0}
    # Another program numbers layers anew: names count.
    now = file_layers(("b", 1), ("a", 2))
    assert match_layers(before[:2], now, never) == {0: 1, 1: 0}
    # Most ids are right, so that a redrawn layer may leave its name to another one.
    three = file_layers(("a", 1), ("leg", 2), ("leg", 3))
    now = file_layers(("leg", 3), ("a", 1), ("left leg", 2))
    assert match_layers(three, now, never) == {0: 1, 1: 2, 2: 0}
    now = file_layers(("b", 1), ("a", 2))
    # Names that were swapped on the same pixels are new names.
    assert match_layers(before[:2], now, lambda one, other: one == other) == {0: 0, 1: 1}
    # Of three layers of one name, one was deleted: only equal pixels tell which.
    before = file_layers(("leg", 0), ("leg", 0), ("leg", 0))
    now = file_layers(("leg", 0), ("leg", 0))
    assert match_layers(before, now, lambda one, other: one == other + 1) == {1: 0, 2: 1}
    assert match_layers(before, now, never) == {}


@pytest.mark.parametrize("box", [(0, 40, 60, 160), (25, 0, 60, 160), (-30, -10, 120, 170)])
def test_a_cropped_or_extended_picture_coincides_with_the_earlier_one(box):
    arm = limb(60, 160, 7)
    cropped = np.asarray(arm.crop(box))
    found = align_pictures(PlacedPicture(np.asarray(arm), 100 + 50j), cropped)
    assert found is not None
    assert found.corner == 100 + box[0] + 1j * (50 + 160 - box[3])
    assert found.agreement > 0.9


def test_a_shifted_layer_is_the_same_motion_elsewhere(rigged):
    leg = by_name(rigged, "leg")
    back = shift_layer(shift_layer(leg, 7 - 3j), -7 + 3j)
    for key, old in zip(back.keys, leg.keys, strict=True):
        np.testing.assert_allclose(key.pose.phi, old.pose.phi, rtol=0, atol=1e-9)
    assert shift_layer(leg, 0j) is leg


def test_a_cut_out_by_hand_moves_with_the_artwork():
    kept = np.zeros((20, 10), bool)
    kept[5:10, 2:6] = True
    moved = move_cut_out(CutOut(mask=Mask.of(kept)), 3 + 4j, (16, 30))
    # Three pixels further right; 20 rows of 30, the lowest four below.
    np.testing.assert_array_equal(moved.mask.kept[6:26, 3:13], kept)
    assert moved.mask.kept[:6].all()


def test_a_layer_without_its_drawing_has_no_file():
    layer = FileLayer(name="a")
    assert layer.path == ("", "a")
    assert LayerOrigin(drawing=1, index=0) != LayerOrigin(drawing=1, index=1)


def halves():
    """Two halves of a disc that meet at a whole pixel, with a soft edge around."""
    y, x = np.mgrid[:60, :60]
    disc = np.zeros((60, 60, 4), np.uint8)
    disc[...] = (200, 60, 30, 0)
    disc[..., 3] = np.clip(255 * (28 - np.hypot(x - 29.5, y - 29.5)), 0, 255)
    return PlacedPicture(disc[:, :30], 10 + 5j), PlacedPicture(disc[:, 30:], 40 + 5j)


def test_a_margin_lies_under_the_neighbour_only():
    behind, front = halves()
    grown = extend_under(behind, front)
    assert grown.corner == 9 + 4j
    assert grown.size == (32, 62)
    # All of it is one column under the neighbour, in the colour beside it.
    np.testing.assert_array_equal(grown.rgba[1:-1, 1:31], behind.rgba)
    column = grown.rgba[:, 31]
    assert (column[..., 3] > 0).sum() >= 55
    assert (column[column[..., 3] > 0, :3] == (200, 60, 30)).all()
    assert not grown.rgba[:, 0, 3].any()
    assert extend_under(behind, PlacedPicture(front.rgba, 200 + 5j)) is None


def test_a_margin_is_no_change_of_the_file():
    behind, front = halves()
    grown = extend_under(behind, front)
    assert has_margin_of(grown, behind)
    assert not has_margin_of(grown, PlacedPicture(behind.rgba, behind.corner + 1))
    painted = behind.rgba.copy()
    painted[20:24, 10:14, :3] = 0
    assert not has_margin_of(grown, PlacedPicture(painted, behind.corner))
    assert not has_margin_of(PlacedPicture(painted, behind.corner), behind)
    # Without a margin a picture is itself.
    assert has_margin_of(behind, behind)

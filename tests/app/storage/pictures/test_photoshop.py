"""Photoshop files as other programs write them: groups, masks, clipping, modes, texts."""

import contextlib
import io
import struct
from dataclasses import replace

import numpy as np
import pytest
from layered import blob
from messages import says
from numpy.testing import assert_allclose, assert_array_equal
from photoshop_files import (
    MULTIPLY,
    NORMAL,
    OFF,
    SCREEN,
    VIVID_LIGHT,
    Drawn,
    Folder,
    Mask,
    descriptor,
    effects_block,
    fill_block,
    old_effects_block,
    overlay,
    path_block,
    photoshop_file,
)
from psd_tools import PSDImage

from app.document.layers.groups import BLENDS, Group
from app.errors import ImportLog, LissomError
from app.storage.pictures.layer_names import GROUPS_DEEP
from app.storage.pictures.layered import MOST_LAYERS
from app.storage.pictures.photoshop import (
    CLEAR_INDEX,
    DAMAGED,
    MERGED_ALONE,
    MOST_RECORDS,
    read_photoshop,
)
from app.storage.pictures.photoshop_paint import DRAWN_WITHOUT, NO_PIXELS, NOT_PAINTED

SIZE = (100, 120)
FULL = np.full((20, 30, 4), 255, np.uint8)
HALF = np.full((20, 15), 255, np.uint8)
EMPTY = np.zeros((0, 0, 4), np.uint8)


def read(*layers):
    return read_photoshop(photoshop_file(SIZE, layers))


def drawn(name, **more):
    return Drawn(name=name, pixels=FULL, left=10, top=20, **more)


def on_canvas(layer):
    """The pixels of a layer where they are on the canvas."""
    width, height = layer.picture.size
    canvas = np.zeros((SIZE[1], SIZE[0], 4), np.uint8)
    left, bottom = int(layer.corner.real), int(layer.corner.imag)
    canvas[SIZE[1] - bottom - height : SIZE[1] - bottom, left : left + width] = layer.picture.rgba
    return canvas


def test_groups_keep_what_they_do():
    found = read(
        drawn("sky"),
        Folder(
            name="limbs",
            opacity=51,
            layers=[
                drawn("arm"),
                Folder(name="far/left", layers=[drawn("arm")], blend=NORMAL, hidden=True),
            ],
        ),
        Folder(name="nothing", layers=[Folder(name="at all", layers=[])]),
        Folder(name="limbs", layers=[drawn("leg", opacity=51)], blend=SCREEN),
    )
    assert [(layer.name, layer.group) for layer in found.layers] == [
        ("sky", ""),
        ("limbs/arm", "limbs"),
        ("limbs/far-left/arm", "limbs/far-left"),
        ("leg", "limbs 2"),
    ]
    assert found.groups == (
        Group(name="limbs", opacity=0.2),
        Group(name="limbs/far-left", blend="normal", hidden=True),
        Group(name="limbs 2", blend="screen"),
    )
    assert found.layers[-1].opacity == 0.2
    assert found.summary == ImportLog(notes=("at all: left out, because it is empty",))


def test_clipping_layers_are_clipped_by_what_is_below_them_in_their_group():
    found = read(
        drawn("lone", clipped=True),
        drawn("arm"),
        drawn("shade", clipped=True, blend=MULTIPLY),
        Folder(name="limbs", layers=[drawn("first", clipped=True), drawn("leg")], clipped=True),
        drawn("over the group", clipped=True),
    )
    clipped = {layer.name: layer.clipped for layer in found.layers}
    # What nothing clips, `composed` paints whole.
    assert clipped == {
        "lone": True,
        "arm": False,
        "shade": True,
        "first": True,
        "leg": False,
        "over the group": True,
    }
    assert found.groups == (Group(name="limbs", clipped=True),)
    assert not found.summary


def test_what_an_empty_layer_clips_is_nowhere_and_what_an_adjustment_does_is_everywhere():
    curves = (b"curv", bytes(4))
    found = read(
        drawn("arm"),
        Drawn(name="levels", pixels=EMPTY, blocks=(curves,)),
        drawn("light", clipped=True),
        Drawn(name="blank", pixels=np.zeros((4, 4, 4), np.uint8)),
        drawn("gone", clipped=True),
        Drawn(name="hollow", pixels=EMPTY),
        drawn("gone too", clipped=True),
        drawn("leg"),
        drawn("shade", clipped=True),
    )
    assert {layer.name: layer.clipped for layer in found.layers} == {
        "arm": False,
        "light": False,
        "leg": False,
        "shade": True,
    }
    assert found.summary.warnings == ("levels: left out, because it is an adjustment layer",)
    assert found.summary.notes == (
        "blank, hollow: left out, because it is empty",
        "gone: left out, because the empty layer blank clips it",
        "gone too: left out, because the empty layer hollow clips it",
    )


def test_what_an_empty_group_clips_is_nowhere_too():
    blank = Drawn(name="blank", pixels=np.zeros((4, 4, 4), np.uint8))
    found = read(
        drawn("arm"),
        Folder(name="hollow", layers=[]),
        drawn("gone", clipped=True),
        Folder(name="limbs", layers=[blank]),
        Folder(name="shades", layers=[drawn("gone too")], clipped=True),
        Folder(name="others", layers=[blank, drawn("leg")]),
        Folder(name="lights", layers=[drawn("light")], clipped=True),
    )
    assert [layer.name for layer in found.layers] == ["arm", "leg", "light"]
    assert found.summary.notes == (
        "hollow, blank, blank: left out, because it is empty",
        "gone: left out, because the empty group hollow clips it",
        "gone too: left out, because the empty group limbs clips it",
    )


def test_a_group_whose_mask_lets_its_layers_shine_through_each_other_is_reported():
    def grouped(mask, *layers):
        return read(Folder(name="limbs", layers=layers, mask=mask))

    half = Mask(pixels=HALF // 2, left=10, top=20)
    notices = ("limbs: its mask makes it half transparent, so its layers shine through each other",)
    assert grouped(half, drawn("arm"), drawn("hand"), drawn("hat")).summary.warnings == notices
    aside = Drawn(name="aside", pixels=FULL, left=-5, top=50)
    assert not grouped(half, drawn("arm"), aside).summary.warnings
    sharp = Mask(pixels=HALF, left=10, top=20)
    assert not grouped(sharp, drawn("arm"), drawn("hand")).summary.warnings
    # What is clipped is cut once, by what clips it.
    clipped = grouped(half, drawn("arm"), drawn("shade", clipped=True))
    assert not clipped.summary.warnings
    arm, shade = clipped.layers
    assert on_canvas(arm)[30, 20, 3] == 127
    assert on_canvas(shade)[30, 20, 3] == 255


@pytest.mark.parametrize(
    "mask",
    [
        Mask(pixels=HALF, left=10, top=20),
        Mask(pixels=0 * HALF, outside=255),  # beside the layer
        Mask(pixels=HALF // 3, left=30, top=10),
        Mask(pixels=np.arange(40_000).reshape(200, 200).astype(np.uint8), left=-50, top=-60),
        Mask(pixels=0 * HALF, disabled=True),
        Mask(pixels=HALF, left=12, top=25, density=51),
        Mask(pixels=np.zeros((0, 0), np.uint8), outside=102),
    ],
)
def test_masks_are_taken_into_the_pixels_of_layers_and_groups(mask):
    (own,) = read(drawn("arm", mask=mask)).layers
    around = np.full((400, 400), mask.outside)
    height, width = mask.pixels.shape
    around[100 + mask.top :, 100 + mask.left :][:height, :width] = mask.pixels
    wanted = around[120:140, 110:140]
    if mask.density is not None:
        wanted = 255 - (255 - wanted) * mask.density / 255
    if mask.disabled:
        wanted = np.full((20, 30), 255)
    found = on_canvas(own)
    assert_allclose(found[20:40, 10:40, 3], wanted, rtol=0, atol=0.5)
    assert (found[found[..., 3] > 0][:, :3] == 255).all()
    found[20:40, 10:40] = 0
    assert not found.any()
    grouped = read(Folder(name="limbs", layers=[drawn("arm")], mask=mask))
    assert_array_equal(grouped.layers[0].picture.rgba, own.picture.rgba)
    notices = ("limbs: the mask of the group is applied to each of its layers",)
    assert grouped.summary.notes == (() if mask.disabled else notices)


def test_feathered_mask_is_soft_at_each_of_its_edges():
    edge = Mask(pixels=HALF, left=10, top=20, feather=2.0)
    (soft,) = read(drawn("arm", mask=edge)).layers
    levels = on_canvas(soft)[30, 10:40, 3].astype(int)
    # The mask is clear beside the layer, too.
    assert_array_equal(levels[:15], levels[14::-1])
    assert (np.diff(levels[8:]) <= 0).all()
    assert abs(levels[14] - 128) < 40
    assert (levels[[7, -1]] == (255, 0)).all()


RED = (255, 0, 0)
QUARTER = (0.1, 0.25, 0.5, 0.75)  # of 100 by 120 pixels: columns 10 to 50, rows 30 to 90


def shape(name="shape", *, boxes=(QUARTER,), colour=RED, **more):
    blocks = (fill_block(colour), path_block(*boxes))
    return Drawn(name=name, pixels=EMPTY, blocks=blocks, is_described=True, **more)


def test_shape_without_pixels_is_drawn_from_path_and_colour():
    empty = Mask(pixels=HALF, left=10, top=20)  # described, too
    (found,) = read(shape(colour=(12, 200, 34), opacity=51, mask=empty)).layers
    canvas = on_canvas(found)
    wanted = np.zeros_like(canvas)
    wanted[30:90, 10:50] = (12, 200, 34, 255)
    assert_array_equal(canvas[..., 3], wanted[..., 3])
    assert_array_equal(canvas[30:90, 10:50], wanted[30:90, 10:50])
    assert found.opacity == 0.2


def test_shape_has_soft_edges_and_holes_and_ends_near_the_canvas():
    (found,) = read(shape(boxes=(QUARTER, (0.2, 0.4, 0.4025, 0.6)))).layers
    hole = on_canvas(found)[60, 19:42, 3]
    assert_array_equal(hole, [255, *[0] * 20, 191, 255])
    (large,) = read(shape(boxes=((-90, -90, 90, 90),))).layers
    assert large.picture.size == (2 * SIZE[0], 2 * SIZE[1])


def test_fill_layer_covers_the_canvas_within_its_masks():
    fill = Drawn(name="sky", pixels=EMPTY, blocks=(fill_block(RED),))
    (found,) = read(fill).layers
    assert (on_canvas(found) == (*RED, 255)).all()
    masked = replace(fill, mask=Mask(pixels=HALF, left=10, top=20))
    (found,) = read(masked).layers
    assert on_canvas(found)[..., 3].sum() == 255 * HALF.size


def test_shape_of_no_single_colour_is_reported():
    gradient = (b"GdFl", struct.pack(">I", 16) + descriptor(b"null", {}))
    book = fill_block(RED, b"BkCl")
    found = read(
        drawn("arm"),
        Drawn(name="g", pixels=EMPTY, blocks=(gradient, path_block(QUARTER)), is_described=True),
        Drawn(name="b", pixels=EMPTY, blocks=(book,)),
    )
    assert [layer.name for layer in found.layers] == ["arm"]
    assert found.summary.warnings == (f"g, b: {NOT_PAINTED}",)


@pytest.mark.parametrize("in_group", [False, True])
@pytest.mark.parametrize(
    ("mask", "flags"),
    [
        (None, 0),
        (None, 1),
        (None, 4),
        (Mask(pixels=np.full((0, 0), 0, np.uint8), outside=255, path_density=51), 0),
        (Mask(pixels=HALF, left=10, top=20), 0),
    ],
)
def test_path_masks_cut_layers_and_groups(mask, flags, in_group):
    pixels = np.full((SIZE[1], SIZE[0], 4), 255, np.uint8)
    block = path_block(QUARTER, flags=flags)
    layer = Drawn(name="arm", pixels=pixels)
    if in_group:
        (found,) = read(Folder(name="limbs", layers=[layer], mask=mask, blocks=(block,))).layers
    else:
        (found,) = read(replace(layer, mask=mask, blocks=(block,))).layers
    inside, outside = {0: (255, 0), 1: (0, 255), 4: (255, 255)}[flags]
    wanted = np.full(pixels.shape[:2], outside)
    wanted[30:90, 10:50] = inside
    if mask is not None and mask.path_density is not None:
        wanted = 255 - (255 - wanted) * mask.path_density // 255
    elif mask is not None:
        # Both masks cut.
        wanted[:20], wanted[40:], wanted[:, 25:] = 0, 0, 0
    assert_array_equal(on_canvas(found)[..., 3], wanted)


def test_path_mask_that_is_stored_as_pixels_cuts_once():
    half = Mask(pixels=HALF // 2, left=10, top=20, is_path=True, path_density=51)
    found = read(drawn("arm", mask=half, blocks=(path_block(QUARTER),)))
    alpha = on_canvas(found.layers[0])[20:40, 10:40, 3]
    assert_array_equal(alpha[:, :15], round(255 - 0.2 * (255 - 127)))
    assert_array_equal(alpha[:, 15:], 255 - 51)


def test_feathered_path_mask_is_soft():
    pixels = np.full((SIZE[1], SIZE[0], 4), 255, np.uint8)
    mask = Mask(pixels=HALF[:0, :0], outside=255, path_feather=3.0)
    found = read(Drawn(name="arm", pixels=pixels, mask=mask, blocks=(path_block(QUARTER),)))
    levels = on_canvas(found.layers[0])[60, :30, 3].astype(int)
    assert (np.diff(levels) >= 0).all()
    assert abs(levels[9:11].mean() - 128) < 2
    assert (levels[[0, -1]] == (0, 255)).all()


@pytest.mark.parametrize("key", [b"lfx2", b"lmfx", b"lfxs"])
def test_effects_of_every_version_are_reported_once(key):
    block = effects_block((b"DrSh", {}), (b"FrFX", {}), (b"IrGl", {b"enab": OFF}), key=key)
    found = read(drawn("arm", blocks=(block,)))
    assert found.summary.warnings == (says_effects("arm", "drop shadow, stroke"),)


def says_effects(name, effects):
    return f"{name}: {DRAWN_WITHOUT.format(effects=effects)}"


def test_old_effects_and_effects_of_groups_are_reported():
    old = old_effects_block(b"sofi")
    assert read(drawn("arm", blocks=(old,))).summary.warnings == (
        says_effects("arm", "colour overlay"),
    )
    block = effects_block(overlay(RED))
    group = Folder(name="limbs", layers=[drawn("arm")], blocks=(block,))
    assert read(group).summary.warnings == (says_effects("limbs", "colour overlay"),)
    # Newer effects stand in the place of the old ones.
    assert not read(drawn("arm", blocks=(old, block))).summary.warnings


@pytest.mark.parametrize("fill", [255, 51])
def test_colour_overlay_is_drawn(fill):
    blocks = (effects_block(overlay(RED, 50)), (b"iOpa", bytes([fill, 0, 0, 0])))
    found = read(drawn("arm", blocks=blocks))
    assert not found.summary.warnings
    (arm,) = found.layers
    # White at the fill's opacity, then red over it at 50 %.
    alpha = 0.5 + 0.5 * fill / 255
    weight = 0.5 / alpha
    assert arm.opacity == pytest.approx(alpha)
    wanted = 255 - weight * np.array([0, 255, 255])
    assert_allclose(arm.picture.rgba[3, 3, :3], wanted, rtol=0, atol=1)
    multiplied = read(drawn("arm", blocks=(effects_block(overlay(RED, 50, b"Mltp")),)))
    assert multiplied.summary.warnings == (says_effects("arm", "colour overlay"),)


def test_placed_picture_without_pixels_is_reported():
    placed = Drawn(name="prop", pixels=EMPTY, blocks=((b"SoLd", bytes(8)),))
    assert read(drawn("arm"), placed).summary.warnings == (f"prop: {NO_PIXELS}",)


def test_old_adjustments_are_called_so():
    brightness = Drawn(name="light", pixels=EMPTY, blocks=((b"brit", bytes(8)),))
    found = read(drawn("arm"), brightness)
    assert found.summary.warnings == ("light: left out, because it is an adjustment layer",)
    assert not found.summary.notes


def test_all_supported_blend_modes_are_read():
    # By the order of the modes in the program's table.
    keys = (
        *(b"norm", b"dark", b"mul ", b"idiv", b"lbrn", b"lite", b"scrn", b"div ", b"lddg", b"over"),
        *(b"sLit", b"hLit", b"diff", b"smud", b"fsub", b"hue ", b"sat ", b"colr", b"lum "),
    )
    found = read(*(drawn(f"{number}", blend=key) for number, key in enumerate(keys)))
    assert tuple(layer.blend for layer in found.layers) == BLENDS
    assert not found.summary


def test_what_is_not_taken_over_is_reported_once_with_all_names():
    found = read(
        drawn("a", blend=VIVID_LIGHT),
        Folder(name="limbs", layers=[drawn("b", blend=VIVID_LIGHT)], blend=VIVID_LIGHT),
        Drawn(name="paint", pixels=EMPTY, blocks=((b"SoCo", bytes(4)),)),
        drawn("hole", blocks=((b"knko", bytes([2, 0, 0, 0])),)),
        drawn("bright", ranges=(50, 0, 255, 255)),
    )
    assert found.summary.warnings == (
        "limbs, a, b: drawn normally, not in the mode 'vivid light'",
        f"paint: {NOT_PAINTED}",
        "hole: drawn over the layers behind; its knockout is ignored",
        "bright: drawn at all brightnesses; its “Blend If” setting is ignored",
    )


def test_forty_layers_and_one_pixel():
    dot = Drawn(name="dot", pixels=FULL[:1, :1], left=99, top=119)
    found = read(*(drawn("arm") for _ in range(40)), dot)
    assert len({layer.name for layer in found.layers}) == 41
    # With the margin of an opaque layer.
    assert found.layers[-1].corner == 98 - 1j


def flat_file(mode, depth, planes, *, version=1, palette=b"", resources=b""):
    """A file without layers, of one colour, by the bytes of each of its channels."""
    length = struct.pack(">I" if version == 1 else ">Q", 0)
    header = struct.pack(">H6xHIIHH", version, len(planes), 12, 16, depth, mode)
    sections = struct.pack(">I", len(palette)) + palette
    sections += struct.pack(">I", len(resources)) + resources + length
    return b"8BPS" + header + sections + bytes(2) + b"".join(plane * 12 * 16 for plane in planes)


WHITE_LAB = [b"\xff", b"\x80", b"\x80"]


@pytest.mark.parametrize("version", [1, 2])
@pytest.mark.parametrize(
    ("mode", "depth", "planes", "palette", "colour"),
    [
        (1, 8, [b"\xc8"], b"", (200, 200, 200)),
        (2, 8, [b"\x07"], bytes(range(256)) * 3, (7, 7, 7)),
        (3, 8, [b"\xc8", b"\x64", b"\x32"], b"", (200, 100, 50)),
        (3, 16, [b"\xc8\0", b"\x64\0", b"\x32\0"], b"", (200, 100, 50)),
        (4, 8, [b"\0", b"\xff", b"\xff", b"\xff"], b"", (0, 255, 255)),
        (7, 8, [b"\xc8", b"\x64"], b"", (200, 200, 200)),
        (8, 8, [b"\x09"], bytes(50), (9, 9, 9)),
        (9, 8, WHITE_LAB, b"", (255, 255, 255)),
    ],
)
def test_flat_files_of_each_mode_open(version, mode, depth, planes, palette, colour):
    read = read_photoshop(flat_file(mode, depth, planes, version=version, palette=palette))
    (layer,) = read.layers
    assert layer.picture.size == (16, 12)
    assert_allclose(layer.picture.rgba[5, 5], (*colour, 255), rtol=0, atol=1)
    assert not read.summary


def test_transparent_colour_of_a_palette_is_clear():
    number = struct.pack(">4sHHIH", b"8BIM", CLEAR_INDEX, 0, 2, 7)
    data = flat_file(2, 8, [b"\x07"], palette=bytes(range(256)) * 3, resources=number)
    (layer,) = read_photoshop(data[:-1] + b"\x09").layers
    assert tuple(layer.picture.rgba[-1, -1]) == (9, 9, 9, 255)
    assert not layer.picture.rgba[:-1, :, 3].any()


def test_inks_keep_their_transparency():
    drawing = PSDImage.new("CMYK", SIZE)
    drawing.create_pixel_layer(blob(40, 30), name="arm", top=5, left=9)
    file = io.BytesIO()
    drawing.save(file)
    (arm,) = read_photoshop(file.getvalue()).layers
    assert_array_equal(arm.picture.rgba[..., 3], np.asarray(blob(40, 30))[..., 3])


def test_padded_channels_are_read():
    layer = drawn("arm")
    plain = photoshop_file(SIZE, [layer])
    for padding in range(4):
        (found,) = read_photoshop(photoshop_file(SIZE, [layer], padding=padding)).layers
        assert_array_equal(found.picture.rgba, read_photoshop(plain).layers[0].picture.rgba)
    with pytest.raises(LissomError, match="rows have the wrong length"):
        read_photoshop(photoshop_file(SIZE, [layer], padding=4))


def test_file_whose_layers_are_not_drawn_opens_as_its_merged_picture():
    curves = Drawn(name="levels", pixels=EMPTY, blocks=((b"curv", bytes(4)),))
    read_merged = read(curves)
    (layer,) = read_merged.layers
    assert layer.picture.size == SIZE
    assert f"{layer.name}: {MERGED_ALONE}" in read_merged.summary.warnings


def test_groups_have_an_end():
    inner = drawn("arm")
    for depth in range(51):
        inner = Folder(name=str(depth), layers=[inner])
    with pytest.raises(LissomError, match=says(GROUPS_DEEP, most=50)):
        read(inner)


def varied(content, rng):
    """Return a file that was cut, or of which bytes are other ones, or gone."""
    changed = bytearray(content)
    match rng.integers(3):
        case 0:
            del changed[rng.integers(len(changed)) :]
        case 1:
            for place in rng.integers(len(changed), size=rng.integers(1, 9)):
                changed[place] = rng.integers(256)
        case _:
            start = rng.integers(len(changed))
            del changed[start : start + rng.integers(1, 50)]
    return bytes(changed)


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 6))]
)
def test_damaged_files_are_refused_without_a_librarys_words(seed, capfd):
    mask = Mask(pixels=np.full((4, 4), 99, np.uint8))
    layer = Drawn(name="a", pixels=np.full((8, 9, 4), 200, np.uint8), mask=mask)
    whole = photoshop_file((20, 20), [layer, Folder(name="g", layers=[layer])])
    rng = np.random.default_rng(seed)
    for _ in range(100):
        with contextlib.suppress(LissomError):
            read_photoshop(varied(whole, rng))
    with pytest.raises(LissomError, match=f"^{DAMAGED}$"):
        read_photoshop(whole.replace(b"8BIM", b"8BXX"))
    assert capfd.readouterr() == ("", "")


def test_a_thousand_layers_in_groups_are_read():
    dot = Drawn(name="a", pixels=FULL[:2, :2])
    groups = [Folder(name="g", layers=[dot, dot]) for _ in range(MOST_LAYERS // 2)]
    assert len(read(*groups).layers) == MOST_LAYERS


@pytest.mark.parametrize("in_block", [False, True])
def test_more_layers_than_there_is_time_for_are_refused_at_once(in_block):
    layer = Drawn(name="a", pixels=np.full((1, 1, 4), 200, np.uint8))
    few = read_photoshop(photoshop_file((9, 9), [layer] * 2, in_block=in_block))
    assert len(few.layers) == 2
    with pytest.raises(LissomError, match=f"at most {MOST_RECORDS:,}"):
        read_photoshop(photoshop_file((9, 9), [layer] * (MOST_RECORDS + 1), in_block=in_block))

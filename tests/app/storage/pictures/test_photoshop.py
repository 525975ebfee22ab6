"""Photoshop files as other programs write them: groups, masks, clipping, modes, texts."""

import contextlib

import numpy as np
import pytest
from messages import says
from numpy.testing import assert_allclose, assert_array_equal
from photoshop_files import (
    MULTIPLY,
    NORMAL,
    SCREEN,
    VIVID_LIGHT,
    Drawn,
    Folder,
    Mask,
    photoshop_file,
)

from app.document.layers.groups import BLENDS, Group
from app.errors import ImportLog, LissomError
from app.storage.pictures.layered import GROUPS_DEEP
from app.storage.pictures.photoshop import DAMAGED, MOST_RECORDS, read_photoshop

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
    found[20:40, 10:40] = 0
    assert not found.any()
    assert (own.picture.rgba[..., :3] == 255).all()
    grouped = read(Folder(name="limbs", layers=[drawn("arm")], mask=mask))
    assert_array_equal(grouped.layers[0].picture.rgba, own.picture.rgba)
    notices = ("limbs: the mask of the group is applied to each of its layers",)
    assert grouped.summary.notes == (() if mask.disabled else notices)


def test_a_feathered_mask_is_soft():
    edge = Mask(pixels=HALF, left=10, top=20, feather=2.0)
    (soft,) = read(drawn("arm", mask=edge)).layers
    levels = on_canvas(soft)[30, 10:40, 3].astype(int)
    assert (np.diff(levels) <= 0).all()
    assert abs(levels[14] - 128) < 40
    assert (levels[[0, -1]] == (255, 0)).all()


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
        "paint: left out, because it is a fill layer",
        "hole: drawn over the layers behind; its knockout is ignored",
        "bright: drawn at all brightnesses; its “Blend If” setting is ignored",
    )


def test_forty_layers_and_one_pixel():
    dot = Drawn(name="dot", pixels=FULL[:1, :1], left=99, top=119)
    found = read(*(drawn("arm") for _ in range(40)), dot)
    assert len({layer.name for layer in found.layers}) == 41
    assert found.layers[-1].corner == 99


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


@pytest.mark.parametrize("in_block", [False, True])
def test_more_layers_than_there_is_time_for_are_refused_at_once(in_block):
    layer = Drawn(name="a", pixels=np.full((1, 1, 4), 200, np.uint8))
    few = read_photoshop(photoshop_file((9, 9), [layer] * 2, in_block=in_block))
    assert len(few.layers) == 2
    with pytest.raises(LissomError, match=f"at most {MOST_RECORDS:,}"):
        read_photoshop(photoshop_file((9, 9), [layer] * (MOST_RECORDS + 1), in_block=in_block))

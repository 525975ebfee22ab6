import io
import re
import struct
import zipfile

import numpy as np
import pytest
from layered import blob, openraster
from messages import says
from numpy.testing import assert_array_equal
from PIL import Image
from psd_tools import PSDImage
from psd_tools.constants import BlendMode

from app.document.layers.groups import Group
from app.errors import LissomError
from app.storage.pictures.layer_names import GROUPS_DEEP, LONGEST_NAME, MOST_GROUPS, UniqueNames
from app.storage.pictures.layered import MOST_LAYERS
from app.storage.pictures.openraster import DAMAGED_STACK, read_openraster
from app.storage.pictures.photoshop import read_photoshop

HEAD = '<layer name="head" src="data/0.png" x="10" y="20"/>'
BODY = '<layer name="body" src="data/1.png" x="5" y="40" opacity="0.5" visibility="hidden"/>'


def drawing(stack=HEAD + BODY, size=(100, 120)):
    return openraster(size, stack, [blob(30, 20), blob(50, 60)])


def layers_of(data):
    return {layer.name: layer for layer in read_openraster(data).layers}


def test_layers_come_from_back_to_front_where_they_are_on_the_canvas():
    read = read_openraster(drawing())
    assert read.size == (100, 120)
    assert [layer.name for layer in read.layers] == ["body", "head"]
    body, head = read.layers
    # Rows count from above in the file, and from below here.
    assert head.corner == 10 + 1j * (120 - 20 - 20)
    assert body.corner == 5 + 1j * (120 - 40 - 60)
    assert (head.visible, head.opacity) == (True, 1.0)
    assert (body.visible, body.opacity) == (False, 0.5)
    assert_array_equal(head.picture.rgba, np.asarray(blob(30, 20)))
    assert not read.summary


def test_groups_are_kept_as_they_lie_in_each_other():
    stack = (
        '<stack name="limbs" x="3" y="4" opacity="0.5" isolation="isolate">'
        f'<stack name="left" visibility="hidden">{HEAD}</stack>{HEAD}</stack>{HEAD}'
        f'<stack name="empty"/><stack name="a/b"><stack>{HEAD}</stack></stack>'
        f'<stack name="limbs" composite-op="svg:screen">{BODY}</stack>'
    )
    read = read_openraster(drawing(stack))
    body, inner, front, right, left = read.layers
    assert [layer.group for layer in read.layers] == [
        "limbs 2",
        "a-b/group",
        "",
        "limbs",
        "limbs/left",
    ]
    assert [layer.name for layer in (body, front, right, left)] == [
        "body",
        "head",
        "limbs/head",
        "limbs/left/head",
    ]
    assert inner.name == "a-b/group/head"
    assert right.corner - front.corner == 3 - 4j
    assert left.corner == right.corner
    # What the groups do stays theirs.
    assert (left.opacity, left.visible) == (1.0, True)
    assert read.groups == (
        Group(name="limbs", opacity=0.5, blend="normal"),
        Group(name="limbs/left", hidden=True),
        Group(name="a-b"),
        Group(name="a-b/group"),
        Group(name="limbs 2", blend="screen"),
    )
    assert not read.summary


def test_layers_that_inherit_alpha_are_clipped():
    base, other = HEAD.replace("head", "base"), HEAD.replace("head", "other")
    atop = HEAD.replace("/>", ' composite-op="svg:src-atop"/>')
    kept = HEAD.replace("head", "kept").replace(
        "/>", ' composite-op="svg:multiply" alpha-preserve="true"/>'
    )

    def clipped(stack, *more):
        pictures = (*more, blob(30, 20), blob(50, 60))
        read = read_openraster(openraster((100, 120), stack, pictures))
        return [layer.name for layer in read.layers if layer.clipped], read.summary.warnings

    assert clipped(kept + atop + base) == (["head", "kept"], ())
    assert clipped(atop) == ([], ())
    # All that lies below in the group clips it there.
    notices = ("head: clipped by the layer directly below, not by all layers below in its group",)
    assert clipped(atop + base + other) == (["head"], notices)
    assert clipped(f"<stack>{atop}{base}</stack>{other}") == (["head"], ())
    assert clipped(f"{atop}<stack>{base}{other}</stack>") == (["head"], ())
    assert clipped(f"{atop}{base}<stack>{other}</stack>") == (["head"], notices)
    paper = '<layer name="paper" src="data/0.png"/>'
    whole = Image.new("RGBA", (100, 120), (255, 255, 255, 255))
    assert clipped(atop.replace("0.png", "1.png") + paper, whole) == ([], ())
    low = Image.new("RGBA", (101, 9), (255, 255, 255, 255))
    paper = paper.replace("/>", ' y="111"/>')
    assert clipped(atop.replace("0.png", "1.png") + paper, low) == (["head"], ())


def test_lowest_group_clips_although_it_inherits_alpha():
    atop = HEAD.replace("/>", ' composite-op="svg:src-atop"/>')
    lowest = f'<stack name="base" alpha-preserve="true">{BODY}</stack>'
    read = read_openraster(drawing(atop + lowest))
    assert [group.clipped for group in read.groups] == [False]
    assert [layer.clipped for layer in read.layers] == [False, True]
    read = read_openraster(drawing(lowest + HEAD))
    assert [group.clipped for group in read.groups] == [True]


def test_layers_of_one_name_are_reported_apart():
    assert sorted(layers_of(drawing(HEAD * 3))) == ["head", "head 2", "head 3"]


def test_all_supported_blend_modes_are_read():
    modes = {
        "svg:color-dodge": "color-dodge",
        "svg:luminosity": "luminosity",
        "svg:plus": "linear-dodge",
        "svg:add": "linear-dodge",
        "krita:linear_burn": "linear-burn",
        "krita:exclusion": "exclusion",
    }
    stack = "".join(HEAD.replace("/>", f' composite-op="{mode}"/>') for mode in modes)
    read = read_openraster(openraster((100, 100), stack, [blob(9, 9)] * 2))
    assert [layer.blend for layer in read.layers[::-1]] == list(modes.values())
    assert not read.summary


def test_what_cannot_be_kept_is_reported():
    stack = (
        HEAD.replace("/>", ' composite-op="svg:vivid-light"/>')
        + '<text name="title"/>'
        + '<layer name="nothing" src="data/2.png"/>'
    )
    empty = Image.new("RGBA", (4, 4))
    read = read_openraster(openraster((100, 100), stack, [blob(9, 9), blob(9, 9), empty]))
    assert [layer.name for layer in read.layers] == ["head"]
    assert sorted(read.summary.warnings) == [
        "head: drawn normally, not in the mode 'vivid-light'",
        "title: left out, because Lissom reads only drawn layers",
    ]
    assert read.summary.notes == ("nothing: left out, because it is empty",)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"no zip", "not an OpenRaster file"),
        (openraster((9, 9), HEAD, [blob(9, 9)], mimetype=b"application/zip"), "not an OpenRaster"),
        (drawing(size=(0, 9)), "size of '0' pixels"),
        (drawing(HEAD.replace('x="10"', 'x="nan"')), "x='nan'"),
        (drawing(HEAD.replace("0.png", "7.png")), "lacks data/7.png"),
        (drawing(""), "all of its layers are empty"),
        (drawing("<stack>" * 60 + "</stack>" * 60), says(GROUPS_DEEP, most=50)),
        (drawing("<stack>"), "stack.xml is damaged"),
        (drawing(HEAD * (MOST_LAYERS + 1)), f"at most {MOST_LAYERS:,}. Merge"),
    ],
)
def test_bad_files_are_reported_in_words(data, words):
    with pytest.raises(LissomError, match=words):
        read_openraster(data)


def test_entities_do_not_grow():
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("mimetype", "image/openraster")
        archive.writestr(
            "stack.xml", '<!DOCTYPE image [<!ENTITY a "aaaa">]><image w="9" h="9"><stack/></image>'
        )
    with pytest.raises(LissomError, match="document type"):
        read_openraster(file.getvalue())


def test_a_member_that_would_unpack_to_too_much_is_refused_before_it_is_unpacked():
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("mimetype", "image/openraster")
        archive.writestr("stack.xml", f'<image w="9" h="9"><stack>{HEAD}</stack></image>')
        archive.writestr("data/0.png", bytes(10_000_000))
    with pytest.raises(LissomError, match=r"data/0\.png is too large"):
        read_openraster(file.getvalue())


def photoshop(build):
    drawing = PSDImage.new("RGB", (100, 120))
    build(drawing)
    file = io.BytesIO()
    drawing.save(file)
    return file.getvalue()


def test_layers_of_a_photoshop_file():
    def build(drawing):
        drawing.create_pixel_layer(blob(50, 60), name="body", top=40, left=5)
        head = drawing.create_pixel_layer(blob(30, 20), name="head", top=20, left=10)
        face = drawing.create_group([head], name="face", opacity=128)
        face.blend_mode = BlendMode.NORMAL
        head.visible = False
        head.blend_mode = BlendMode.MULTIPLY

    read = read_photoshop(photoshop(build))
    assert read.size == (100, 120)
    body, head = read.layers
    assert (body.name, body.corner, body.visible, body.opacity) == ("body", 5 + 20j, True, 1.0)
    assert (head.name, head.corner, head.visible) == ("head", 10 + 80j, False)
    assert (head.opacity, head.blend, head.group) == (1.0, "multiply", "face")
    assert read.groups == (Group(name="face", opacity=128 / 255, blend="normal"),)
    assert_array_equal(body.picture.rgba, np.asarray(blob(50, 60)))
    assert not read.summary


def test_a_mask_is_taken_into_the_pixels():
    half = Image.new("L", (30, 20))
    half.paste(255, (0, 0, 15, 20))

    def build(drawing):
        layer = drawing.create_pixel_layer(blob(30, 20), name="head", top=20, left=10)
        layer.update_mask(half)

    (head,) = read_photoshop(photoshop(build)).layers
    alpha = head.picture.rgba[..., 3]
    # psd-tools writes a layer's own alpha as a mask, too; this one took its place.
    assert_array_equal(alpha, np.asarray(half)[:, :16])


def test_a_photoshop_file_without_layers_is_one_layer():
    file = io.BytesIO()
    PSDImage.frompil(blob(30, 20).convert("RGB")).save(file)
    (layer,) = read_photoshop(file.getvalue()).layers
    assert layer.picture.size == (30, 20)


@pytest.mark.parametrize("data", [b"", b"8BPS", b"8BPS" + bytes(200), b"PK no"])
def test_damaged_photoshop_files_are_reported_in_words(data):
    with pytest.raises(LissomError, match="Photoshop"):
        read_photoshop(data)


@pytest.mark.parametrize("mode", ["RGBA", "L"])
def test_one_byte_that_costs_a_photoshop_layer_a_colour_is_reported(mode):
    """All single bytes that say which channels there are, how they are packed, and how long."""
    colours = np.zeros((40, 30, 4), np.uint8)
    colours[...] = (200, 80, 40, 255)
    image = Image.fromarray(colours).convert(mode)
    file = io.BytesIO()
    drawing = PSDImage.new("RGB", (30, 40))
    drawing.create_pixel_layer(image, name="head")
    drawing.save(file)
    whole = file.getvalue()
    (layer,) = PSDImage.open(io.BytesIO(whole))
    places = []
    for info, channel in zip(layer._record.channel_info, layer._channels, strict=True):
        entry = struct.pack(">hI", int(info.id), info.length)
        places += range(whole.index(entry), whole.index(entry) + len(entry))
        begun = whole.index(channel.data) - 2
        places += range(begun, begun + 8)
    before = read_photoshop(whole).layers[0].picture.rgba
    refused = 0
    for place in places:
        for bit in (1, 0x80, 0xFF):
            damaged = bytearray(whole)
            damaged[place] ^= bit
            try:
                read = read_photoshop(bytes(damaged))
            except LissomError:
                refused += 1
                continue
            after = read.layers[0].picture.rgba
            assert ((after == 0).all((0, 1)) <= (before == 0).all((0, 1))).all() or read.summary
    assert refused > len(places)


def test_a_photoshop_file_cut_short_is_reported_in_words():
    whole = photoshop(lambda drawing: drawing.create_pixel_layer(blob(30, 20), name="head"))
    for end in range(4, len(whole), max(1, len(whole) // 40)):
        try:
            read_photoshop(whole[:end])
        except LissomError:
            continue


def test_names_that_are_alike_get_the_next_free_numbers():
    names = UniqueNames()
    given = [names.claim(name) for name in ("a", "a 2", "a", "a", "b", "a 2", "a")]
    assert given == ["a", "a 2", "a 3", "a 4", "b", "a 2 2", "a 5"]
    # Looked for one by one, these would take minutes.
    assert [names.claim("c") for _ in range(100_000)][-1] == "c 100000"


def test_too_many_groups_and_long_names_are_refused():
    with pytest.raises(LissomError, match=f"too many groups; Lissom reads at most {MOST_GROUPS:,}"):
        read_openraster(drawing(HEAD + "<stack/>" * (MOST_GROUPS + 1)))
    for stack in (f'<stack name="{"x" * 5000}">{HEAD}</stack>', HEAD.replace("head", "x" * 5000)):
        with pytest.raises(LissomError, match=f"at most {LONGEST_NAME:,}") as refusal:
            read_openraster(drawing(stack))
        assert len(str(refusal.value)) < 300


def with_stack(content):
    stream = io.BytesIO(drawing())
    with zipfile.ZipFile(stream) as old:
        members = {name: old.read(name) for name in old.namelist()}
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as new:
        for name, data in {**members, "stack.xml": content}.items():
            new.writestr(name, data)
    return stream.getvalue()


STACK = f'<image w="100" h="120"><stack>{HEAD.replace("head", "häd")}</stack></image>'


@pytest.mark.parametrize(
    ("name", "encoding"),
    [("UTF-16", "utf-16"), ("UTF-8", "utf-8-sig"), ("ISO-8859-1", "latin-1")],
)
def test_stacks_in_usual_encodings_are_read(name, encoding):
    stack = f'<?xml version="1.0" encoding="{name}"?>{STACK}'.encode(encoding)
    assert list(layers_of(with_stack(stack))) == ["häd"]


@pytest.mark.parametrize(
    "stack",
    [
        *(
            f'<?xml version="1.0" encoding="{name}"?>{STACK}'.encode()
            for name in ("klingon", "zip")
        ),
        STACK.encode("latin-1"),
        STACK.encode("utf-32"),
        STACK.replace("häd", "&what;").encode(),
        b"",
    ],
)
def test_damaged_stacks_are_refused_in_one_sentence(stack):
    with pytest.raises(LissomError, match=f"^{re.escape(DAMAGED_STACK)}$"):
        read_openraster(with_stack(stack))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_entities_are_refused_in_every_encoding(encoding):
    declared = '<!DOCTYPE image [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]>'
    stack = f'<?xml version="1.0" encoding="{encoding}"?>{declared}{STACK}'.encode(encoding)
    with pytest.raises(LissomError, match="document type"):
        read_openraster(with_stack(stack))

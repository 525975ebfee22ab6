import io
import struct
import warnings
import zlib

import numpy as np
import pytest
from messages import says
from numpy.testing import assert_array_equal
from PIL import Image, ImageCms
from profiles import (
    DISPLAY_P3,
    SRGB,
    decoded,
    encoded,
    grey_profile,
    press_profile,
    rgb_profile,
    to_xyz,
)

from app.errors import LissomError
from app.storage.files.reading import FOLDER_READ, read_file
from app.storage.pictures.picture import (
    DAMAGED_PICTURE,
    NO_PICTURE,
    RARE_PICTURE,
    decode_picture,
    decode_pictures,
)
from app.storage.pictures.programs import PROGRAM_FILE

GREY = np.arange(12, dtype=np.uint8).reshape(3, 4) * 20
RGB = np.stack([GREY, GREY[::-1], 255 - GREY], axis=-1)
ALPHA = np.array([[0, 8, 128, 255]] * 3, dtype=np.uint8)


def encode(image: Image.Image, kind: str, **options: object) -> bytes:
    stream = io.BytesIO()
    image.save(stream, kind, **options)
    return stream.getvalue()


def rgba_of(data: bytes) -> np.ndarray:
    return decode_picture(data, "drawing").rgba


def test_straight_alpha_is_read_as_it_is():
    pixels = np.dstack([RGB, ALPHA])
    picture = decode_picture(encode(Image.fromarray(pixels), "PNG"), "drawing")
    assert_array_equal(picture.rgba, pixels)
    assert picture.size == (4, 3)
    assert picture.suffix == ".png"
    assert picture.notices == ()
    assert not picture.rgba.flags.writeable


def test_grey_with_and_without_alpha():
    opaque = np.full_like(GREY, 255)
    assert_array_equal(
        rgba_of(encode(Image.fromarray(GREY), "PNG")), np.dstack([GREY, GREY, GREY, opaque])
    )
    image = Image.merge("LA", (Image.fromarray(GREY), Image.fromarray(ALPHA)))
    assert_array_equal(rgba_of(encode(image, "PNG")), np.dstack([GREY, GREY, GREY, ALPHA]))


def test_a_palette_with_a_transparent_entry():
    image = Image.fromarray(np.array([[0, 1], [2, 1]], dtype=np.uint8), "P")
    image.putpalette([255, 0, 0, 0, 255, 0, 0, 0, 255])
    pixels = rgba_of(encode(image, "PNG", transparency=1))
    assert_array_equal(pixels[..., 3], [[255, 0], [255, 0]])
    assert_array_equal(pixels[0, 0], [255, 0, 0, 255])


@pytest.mark.parametrize("white", [65535, 4095])
def test_sixteen_bit_greys_keep_their_scale(white):
    # A dark picture stays dark: white is 65535, whatever the largest value is.
    greys = np.linspace(0, white, 12).astype(np.uint16).reshape(3, 4)
    picture = decode_picture(encode(Image.fromarray(greys), "PNG"), "drawing")
    assert_array_equal(picture.rgba[..., 0], np.rint(greys / 257).astype(np.uint8))
    assert any("8 bits" in notice for notice in picture.notices)


@pytest.mark.parametrize(("scale", "white"), [(1.0, 1.0), (200.0, 255.0)])
def test_floating_point_greys(scale, white):
    greys = np.linspace(0, scale, 12, dtype=np.float32).reshape(3, 4)
    pixels = rgba_of(encode(Image.fromarray(greys), "TIFF"))
    assert_array_equal(pixels[..., 0], np.rint(greys / white * 255).astype(np.uint8))


def chunk(name: bytes, content: bytes) -> bytes:
    checksum = struct.pack(">I", zlib.crc32(name + content))
    return struct.pack(">I", len(content)) + name + content + checksum


def png_file(depth: int, kind: int, rows: bytes, size: tuple[int, int], *chunks: bytes) -> bytes:
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", *size, depth, kind, 0, 0, 0))
    content = chunk(b"IDAT", zlib.compress(rows))
    return b"\x89PNG\r\n\x1a\n" + header + b"".join(chunks) + content + chunk(b"IEND", b"")


def deep_png(samples: np.ndarray) -> bytes:
    """A PNG file of 16 bits per channel, which Pillow does not write."""
    height, width, channels = samples.shape
    colours = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    rows = b"".join(b"\0" + row.tobytes() for row in samples.astype(">u2"))
    return png_file(16, colours, rows, (width, height))


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_sixteen_bits_are_reduced_with_a_notice(channels):
    samples = np.random.default_rng(4).integers(0, 65536, (5, 7, channels), np.uint16)
    picture = decode_picture(deep_png(samples), "drawing")
    read = picture.rgba[..., {1: [0], 2: [0, 3], 3: [0, 1, 2], 4: [0, 1, 2, 3]}[channels]]
    assert np.abs(read - samples / 257).max() < 1
    (notice,) = picture.notices
    assert "8 bits" in notice


def test_sixteen_bits_of_other_formats_are_noticed_too():
    samples = np.full((3, 5, 3), 0x80FF, ">u2").tobytes()
    tags = [(256, 3, 5), (257, 3, 3), (258, 3, 16), (259, 3, 1), (262, 3, 2), (273, 4, 122)]
    tags += [(277, 3, 3), (278, 3, 3), (279, 4, len(samples))]
    directory = b"".join(
        struct.pack(">HHI", tag, kind, 1)
        + (struct.pack(">HH", value, 0) if kind == 3 else struct.pack(">I", value))
        for tag, kind, value in tags
    )
    tiff = b"MM\0*" + struct.pack(">IH", 8, len(tags)) + directory + bytes(4)
    for data in (b"P6 5 3 65535\n" + samples, tiff + samples):
        picture = decode_picture(data, "drawing")
        assert abs(int(picture.rgba[1, 1, 0]) - 0x80) <= 1
        assert picture.notices == ("its deep colours were reduced to 8 bits per channel",)
    assert decode_picture(b"P6 5 3 255\n" + samples[:45], "drawing").notices == ()


def srgb_of(colours: np.ndarray) -> np.ndarray:
    """What the definitions of Display P3 and sRGB give."""
    matrix = np.linalg.solve(to_xyz(SRGB), to_xyz(DISPLAY_P3))
    return 255 * encoded(decoded(colours / 255) @ matrix.T)


@pytest.mark.parametrize("mode", ["RGB", "RGBA", "P", "L", "LA"])
def test_the_colours_of_a_profile_become_srgb(mode):
    image = Image.fromarray(np.dstack([RGB, ALPHA])).convert(mode)
    profile = rgb_profile("Display P3", DISPLAY_P3)
    picture = decode_picture(encode(image, "PNG", icc_profile=profile), "drawing")
    plain = np.asarray(image.convert("RGBA"))
    assert np.abs(picture.rgba[..., :3] - srgb_of(plain[..., :3])).max() <= 2
    assert_array_equal(picture.rgba[..., 3], plain[..., 3])
    assert not picture.rgba.flags.writeable
    if mode in {"L", "LA"}:
        # Greys are the same in both.
        assert_array_equal(picture.rgba, plain)
        assert picture.notices == ()
    else:
        assert picture.notices == ("its colours were converted from Display P3 to sRGB",)


@pytest.mark.parametrize(
    "profile",
    [
        rgb_profile("sRGB by definition", SRGB),
        ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes(),
    ],
)
def test_srgb_stays_as_it_is_whatever_its_profile_is_called(profile):
    pixels = np.dstack([RGB, ALPHA])
    data = encode(Image.fromarray(pixels), "PNG", icc_profile=profile)
    picture = decode_picture(data, "drawing")
    assert_array_equal(picture.rgba, pixels)
    assert picture.notices == ()


def test_greys_with_a_profile():
    data = encode(Image.fromarray(GREY), "PNG", icc_profile=grey_profile("Linear", 1.0))
    picture = decode_picture(data, "drawing")
    assert np.abs(picture.rgba[..., 0] - 255 * encoded(GREY / 255)).max() <= 2
    assert picture.notices == ("its colours were converted from Linear to sRGB",)


def test_inks_with_a_profile():
    """L* of the press above: halfway is a grey of about 119, far from the inks' own 191."""
    image = Image.new("CMYK", (8, 8), (255, 255, 0, 0))
    data = encode(image, "TIFF", icc_profile=press_profile("Press"))
    picture = decode_picture(data, "drawing")
    light = ((50 + 16) / 116) ** 3
    assert np.abs(picture.rgba[4, 4, :3] - 255 * encoded(np.array(light))).max() <= 2
    assert picture.notices == ("its colours were converted from Press to sRGB",)


@pytest.mark.parametrize(
    ("profile", "what"),
    [
        (b"no profile", "damaged"),
        (rgb_profile("Torn", DISPLAY_P3)[:200], "damaged"),
        (grey_profile("Greys", 2.2), "another kind of picture"),
        (press_profile("Press"), "another kind of picture"),
    ],
)
def test_a_profile_that_cannot_be_used_is_reported(profile, what):
    picture = decode_picture(encode(Image.fromarray(RGB), "PNG", icc_profile=profile), "drawing")
    assert_array_equal(picture.rgba[..., :3], RGB)
    (notice,) = picture.notices
    assert what in notice


def test_cmyk_becomes_rgb():
    image = Image.fromarray(np.full((8, 8, 3), (200, 40, 90), np.uint8)).convert("CMYK")
    pixels = rgba_of(encode(image, "JPEG", quality=100))
    assert pixels.shape == (8, 8, 4)
    assert np.abs(pixels[4, 4].astype(int) - (200, 40, 90, 255)).max() <= 6


@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_rotation_is_applied(orientation):
    upright = Image.fromarray(np.zeros((8, 16, 3), np.uint8))
    upright.paste((255, 255, 255), (0, 0, 8, 4))
    exif = Image.Exif()
    exif[0x0112] = orientation
    transposed = orientation >= 5
    undo = {
        1: None,
        2: Image.Transpose.FLIP_LEFT_RIGHT,
        3: Image.Transpose.ROTATE_180,
        4: Image.Transpose.FLIP_TOP_BOTTOM,
        5: Image.Transpose.TRANSPOSE,
        6: Image.Transpose.ROTATE_90,
        7: Image.Transpose.TRANSVERSE,
        8: Image.Transpose.ROTATE_270,
    }[orientation]
    stored = upright if undo is None else upright.transpose(undo)
    assert (stored.size == (8, 16)) == transposed
    picture = decode_picture(encode(stored, "JPEG", exif=exif, quality=95), "drawing")
    assert picture.size == (16, 8)
    assert picture.rgba[1, 2, 0] > 240
    assert picture.rgba[6, 12, 0] < 15
    assert bool(picture.notices) == (orientation != 1)


@pytest.mark.parametrize("kind", ["GIF", "WEBP", "PNG"])
def test_the_first_frame_of_an_animation_is_used(kind):
    frames = [Image.new("RGB", (4, 4), colour) for colour in ("red", "green", "blue")]
    options = {"lossless": True} if kind == "WEBP" else {}
    data = encode(frames[0], kind, save_all=True, append_images=frames[1:], **options)
    picture = decode_picture(data, "drawing")
    assert_array_equal(picture.rgba[2, 2], [255, 0, 0, 255])
    assert picture.notices == ("only the first of its 3 frames was used",)


WHOLE = encode(
    Image.fromarray(np.random.default_rng(1).integers(0, 255, (64, 64, 3), np.uint8)), "PNG"
)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is empty"),
        (b"%PDF-1.4 no picture", says(NO_PICTURE)),
        (b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n", says(NO_PICTURE)),
        (b"plain text", says(NO_PICTURE)),
        (WHOLE[: len(WHOLE) // 2], says(DAMAGED_PICTURE)),
        (WHOLE[:2000] + bytes(64) + WHOLE[2064:], says(DAMAGED_PICTURE)),
    ],
)
def test_what_is_no_picture_is_refused(data, message):
    with pytest.raises(LissomError, match=message):
        decode_picture(data, "drawing")


def test_a_damaged_avif_is_refused_wherever_the_damage_is():
    whole = encode(Image.linear_gradient("L").convert("RGB"), "AVIF")
    refused = 0
    for at in range(0, len(whole), len(whole) // 16):
        damaged = whole[:at] + bytes([whole[at] ^ 0xFF]) + whole[at + 1 :]
        try:
            decode_picture(damaged, "drawing")
        except LissomError:
            refused += 1
    assert refused > 4


def test_a_decompression_bomb_is_refused_before_it_is_decoded(monkeypatch):
    data = encode(Image.new("L", (400, 300)), "PNG")
    for most in (100_000, 40_000):  # Pillow's warning, and its error at twice as much
        monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", most)
        with pytest.raises(LissomError, match=f"more than {most:,} pixels"):
            decode_picture(data, "drawing")


def test_missing_files_and_folders(tmp_path):
    with pytest.raises(LissomError, match=r"cannot read .*No such file"):
        read_file(tmp_path / "nothing.png")
    with pytest.raises(LissomError, match=says(FOLDER_READ, path=tmp_path)):
        read_file(tmp_path)


def test_several_pictures_are_decoded_side_by_side(monkeypatch):
    rng = np.random.default_rng(3)
    pixels = [rng.integers(0, 256, (40 + i, 130, 4), dtype=np.uint8) for i in range(12)]
    files = [(encode(Image.fromarray(each), "PNG"), f"{i}.png") for i, each in enumerate(pixels)]
    before = list(warnings.filters)
    for picture, wanted in zip(decode_pictures(files), pixels, strict=True):
        assert_array_equal(picture.rgba, wanted)
    # Each is still refused by its own name, and warnings elsewhere stay as they are.
    files[7] = (files[7][0][:200], "7.png")
    with pytest.raises(LissomError, match=says(DAMAGED_PICTURE, name="7.png")):
        decode_pictures(files)
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 130 * 45)
    with pytest.raises(LissomError, match=r"6\.png has more than 5,850 pixels"):
        decode_pictures(files)
    assert list(warnings.filters) == before


def icon(*entries: tuple[int, int, bytes]) -> bytes:
    """An icon file of pictures, each with its side, bits per pixel, and stored bytes."""
    directory, stored = struct.pack("<HHH", 0, 1, len(entries)), b""
    for side, bits, content in entries:
        at = 6 + 16 * len(entries) + len(stored)
        directory += struct.pack(
            "<BBBBHHII", side % 256, side % 256, 0, 0, 1, bits, len(content), at
        )
        stored += content
    return directory + stored


def bitmap(pixels: np.ndarray, bits: int, *, hidden: np.ndarray | None = None) -> bytes:
    """A bitmap of an icon, with a mask of hidden pixels."""
    height, width, _ = pixels.shape
    header = struct.pack("<IiiHHIIiiII", 40, width, 2 * height, 1, bits, 0, 0, 0, 0, 0, 0)
    colours = pixels[::-1, :, [2, 1, 0, 3][: bits // 8]]
    rows = b"".join(row.tobytes() + bytes(-row.size % 4) for row in colours)
    if hidden is None:
        return header + rows
    mask = np.packbits(hidden[::-1], axis=1)
    return header + rows + np.pad(mask, ((0, 0), (0, -mask.shape[1] % 4))).tobytes()


@pytest.mark.parametrize("bits_are_told", [True, False])
def test_icon_shows_its_largest_picture_with_alpha(bits_are_told):
    pixels = np.random.default_rng(5).integers(1, 256, (40, 40, 4), np.uint8)
    small, hidden = np.full((16, 16, 4), 99, np.uint8), pixels[..., 0] > 128
    told = 32 * bits_are_told

    def read(*entries):
        picture = decode_picture(icon((16, told, bitmap(small, 32)), *entries), "drawing")
        assert picture.suffix == ".ico"
        return picture.rgba

    assert_array_equal(read((40, told, bitmap(pixels, 32, hidden=hidden))), pixels)
    assert_array_equal(read((40, told, encode(Image.fromarray(pixels), "PNG"))), pixels)
    masked = np.dstack([pixels[..., :3], 255 * ~hidden])
    assert_array_equal(read((40, 24, bitmap(pixels, 24, hidden=hidden))), masked)
    # Alpha that is 0 everywhere was never written.
    pixels[..., 3] = 0
    assert_array_equal(read((40, told, bitmap(pixels, 32, hidden=hidden))), masked)
    assert (read((40, told, bitmap(pixels, 32)))[..., 3] == 255).all()
    # Of equal sizes the picture with most colours counts.
    plain = bitmap(small[:1].repeat(40, 0)[:, :1].repeat(40, 1), 24, hidden=~hidden)
    assert_array_equal(read((40, 24, plain), (40, 32, bitmap(masked.astype(np.uint8), 32))), masked)


@pytest.mark.parametrize(
    ("channels", "depth"), [*((1, depth) for depth in (1, 2, 4, 8, 16)), (3, 8), (3, 16)]
)
def test_transparent_colour_is_clear_at_every_depth(channels, depth):
    most = (1 << depth) - 1
    samples = np.random.default_rng(6).integers(0, most + 1, (16, 16, channels))
    # Of 16 bits, neighbours of the colour differ in the lower bits alone.
    samples[:4] = samples[0, 0]
    samples[1] = samples[1] ^ 1
    clear = samples[0, 0]
    bits = (samples.reshape(16, -1, 1) >> np.arange(depth)[::-1]) & 1
    rows = b"".join(b"\0" + np.packbits(row).tobytes() for row in bits)
    transparent = chunk(b"tRNS", struct.pack(f">{channels}H", *clear))
    kind = {1: 0, 3: 2}[channels]
    rgba = rgba_of(png_file(depth, kind, rows, (16, 16), transparent))
    assert_array_equal(rgba[..., 3] == 0, (samples == clear).all(axis=2))
    assert np.abs(rgba[..., :channels] - samples * 255 / most).max() < 1
    opaque = rgba_of(png_file(depth, kind, rows, (16, 16)))
    assert_array_equal(rgba[..., :3], opaque[..., :3])


def test_png_with_a_damaged_harmless_chunk_opens_with_a_notice():
    text = chunk(b"tEXt", b"Comment\0drawn")
    damaged = text[:-1] + bytes([text[-1] ^ 1])
    at = WHOLE.index(b"IDAT") - 4
    picture = decode_picture(WHOLE[:at] + damaged + text + damaged + WHOLE[at:], "drawing")
    assert_array_equal(picture.rgba, rgba_of(WHOLE))
    assert picture.notices == ("damaged parts of the file were ignored (tEXt)",)
    # What follows the last chunk is no part of the picture.
    assert decode_picture(WHOLE + damaged, "drawing").notices == ()
    header = WHOLE[:29] + bytes([WHOLE[29] ^ 1]) + WHOLE[30:]
    with pytest.raises(LissomError, match=f"^{says(RARE_PICTURE, name='drawing', format='PNG')}$"):
        decode_picture(header, "drawing")


def test_float_colours_and_files_of_other_programs_are_refused_with_advice():
    tags = [(256, 3, 4), (257, 3, 3), (258, 3, 32), (259, 3, 1), (262, 3, 2), (273, 4, 146)]
    tags += [(277, 3, 3), (278, 3, 3), (279, 4, 144), (339, 3, 3)]
    directory = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in tags)
    tiff = b"II*\0" + struct.pack("<IH", 8, len(tags)) + directory + bytes(4 + 144)
    with pytest.raises(LissomError, match=says(RARE_PICTURE, name="a.tif", format="TIFF")):
        decode_picture(tiff, "a.tif")
    for name, program in (
        ("a.xcf", "GIMP"),
        ("a.CLIP", "Clip Studio Paint"),
        ("a.ase", "Aseprite"),
    ):
        with pytest.raises(
            LissomError, match=f"^{says(PROGRAM_FILE, name=name, program=program)}$"
        ):
            decode_picture(b"gimp xcf v011\0" + bytes(99), name)

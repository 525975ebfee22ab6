"""Reading a picture file into sRGB pixels with straight alpha."""

import io
import struct
import warnings
import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageFile, ImageOps, UnidentifiedImageError

from app.cut_out import Mask
from app.errors import LissomError
from app.storage.pictures.colour import to_srgb
from app.storage.pictures.parallel import require_memory, run_parallel
from app.storage.pictures.programs import refuse_program_file
from app.storage.pictures.repairs import (
    ICO,
    PNG,
    largest_icon,
    with_clear_colour,
    without_damaged_chunks,
)
from app.texts import N_, _, message_of
from engine.arrays import Booleans, Bytes, Floats, freeze

# PostScript and PDF are excluded on purpose: Pillow would run an interpreter for them.
FORMATS = {
    "PNG": ".png",
    "JPEG": ".jpg",
    "GIF": ".gif",
    "WEBP": ".webp",
    "BMP": ".bmp",
    "TIFF": ".tiff",
    "PPM": ".ppm",
    "TGA": ".tga",
    "ICO": ".ico",
    "AVIF": ".avif",
}
FORMATS_IN_WORDS = N_("PNG, JPEG, GIF, WebP, AVIF, TIFF, BMP, TGA, PPM or ICO")
# Pillow's decoders raise all of these on damaged files.
DECODER_ERRORS = (
    RuntimeError,
    OSError,
    ValueError,
    SyntaxError,
    EOFError,
    LookupError,
    TypeError,
    AttributeError,
    ArithmeticError,
    AssertionError,
    struct.error,
    zlib.error,
)
EXIF_ORIENTATION = 0x0112
SIGNATURE = 16  # bytes at the beginning that tell the format
BAND = 64  # rows of pixels copied at once
OPAQUE = 255
HALF = 128  # levels: lighter mask pixels are kept
NO_PICTURE = N_("{name} is damaged, or not a picture that Lissom reads ({formats})")
DAMAGED_PICTURE = N_("{name} is damaged or cut short")
RARE_PICTURE = N_(
    "{name} is damaged, or a {format} picture of a rare kind; save it again as PNG or OpenRaster"
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Picture:
    """A decoded picture.

    Parameters
    ----------
    rgba : uint8, shape (h, w, 4)
        sRGB with straight alpha, first row on top, rotated by its EXIF orientation.
    suffix : str
        Usual file suffix of its format, such as ".png", whatever the file's own name.
    notices : tuple of str
        Notices about changes of the file's contents.
    """

    rgba: Bytes
    suffix: str = ".png"
    notices: tuple[str, ...] = ()

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.rgba.shape[1], self.rgba.shape[0]

    @property
    def is_opaque(self) -> bool:
        # Row by row: in most drawings the first row decides.
        return all(bool((row[:, 3] == OPAQUE).all()) for row in self.rgba)

    @property
    def is_blank(self) -> bool:
        return not self.rgba[..., 3].any()


def decode_picture(data: bytes, name: str) -> Picture:
    """Decode the bytes of a picture file; errors call the file `name`.

    Raises `LissomError` if the bytes are no picture or damaged, or the picture is unreasonably
    large.
    """
    (picture,) = decode_pictures([(data, name)])
    return picture


def decode_pictures(files: Sequence[tuple[bytes, str]]) -> list[Picture]:
    """Decode several picture files, given as bytes and name for errors."""
    sizes = [stored_size(*file) for file in files]
    try:
        require_memory(sizes)
    except LissomError as error:
        raise LissomError(
            _("{name} is too large: {reason}").format(name=files[0][1], reason=message_of(error))
        ) from error
    with _only_size_warnings():
        return run_parallel(lambda file: _decode(*file), files, sizes)


def decode_mask(data: bytes, name: str) -> Mask:
    """Decode a mask: light opaque pixels are kept."""
    rgba = decode_picture(data, name).rgba
    light: Booleans = rgba[..., :3].sum(axis=2, dtype=np.uint16) >= 3 * HALF
    return Mask.of(light & (rgba[..., 3] >= HALF))


def encode_mask(mask: Mask) -> bytes:
    """Return a mask as a black and white PNG picture."""
    file = io.BytesIO()
    Image.fromarray(mask.kept).save(file, "PNG", optimize=True)
    return file.getvalue()


def stored_size(data: bytes, name: str) -> tuple[int, int]:
    """Return the width and height in pixels from a picture file's header, without decoding it."""
    if not data:
        raise LissomError(_("{name} is empty").format(name=name))
    with _only_size_warnings(), decoding_errors(data, name), open_image(_usable(data)[0]) as image:
        return image.size


@contextmanager
def _only_size_warnings() -> Iterator[None]:
    """Silence all warnings of Pillow except those about too large pictures.

    Warning filters belong to the whole process. Set them around all decoding threads, not within
    each thread.
    """
    with warnings.catch_warnings():
        # Pillow warns at half the size of its error; the warning's size is our limit.
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", Image.DecompressionBombWarning)
        yield


@contextmanager
def decoding_errors(data: bytes, name: str) -> Iterator[None]:
    """Turn Pillow's exceptions into a `LissomError` that names the file."""
    try:
        yield
    except (Image.DecompressionBombWarning, Image.DecompressionBombError) as error:
        raise LissomError(
            _("{name} has more than {most:,} pixels; scale it down first").format(
                name=name, most=Image.MAX_IMAGE_PIXELS or 0
            )
        ) from error
    except UnidentifiedImageError as error:
        raise LissomError(_refusal(data, name)) from error
    except DECODER_ERRORS as error:
        raise LissomError(_(DAMAGED_PICTURE).format(name=name)) from error


def _refusal(data: bytes, name: str) -> str:
    """Return why a file is not read, and what to do."""
    for kind in FORMATS:
        accepts = Image.OPEN[kind][1]
        if accepts and accepts(data[:SIGNATURE]):
            return _(RARE_PICTURE).format(name=name, format=kind)
    no_picture = _(NO_PICTURE).format(name=name, formats=_(FORMATS_IN_WORDS))
    return refuse_program_file(name) or no_picture


def _usable(data: bytes) -> tuple[bytes, tuple[str, ...]]:
    """Return the file that is decoded for a picture file, and notices."""
    if data.startswith(ICO):
        data = largest_icon(data)
    return without_damaged_chunks(data) if data.startswith(PNG) else (data, ())


def open_image(data: bytes) -> ImageFile.ImageFile:
    """Open the bytes of a picture file with Pillow, without decoding its pixels."""
    return Image.open(io.BytesIO(data), formats=tuple(FORMATS))


def _decode(data: bytes, name: str) -> Picture:
    with decoding_errors(data, name):
        usable, notices = _usable(data)
        picture = _decoded(usable)
        suffix = ".ico" if data.startswith(ICO) else picture.suffix
        return replace(picture, suffix=suffix, notices=notices + picture.notices)


def _decoded(data: bytes) -> Picture:
    notices = []
    file = open_image(data)
    suffix = FORMATS[file.format or ""]
    frames = getattr(file, "n_frames", 1)
    if frames > 1:
        notices.append(_("only the first of its {frames} frames was used").format(frames=frames))
    is_deep = _is_deep(file)
    rgba = _load(file)
    profile = file.info.get("icc_profile")
    image, notice = apply_orientation(with_clear_colour(file, data))
    if notice:
        notices.append(notice)
    if image.mode.startswith("I;16") or image.mode in {"I", "F"}:
        image = Image.fromarray(_scale_deep_grey(np.asarray(image), is_float=image.mode == "F"))
        notices.append(_("its deep greys were reduced to 8 bits"))
    elif is_deep:
        notices.append(_("its deep colours were reduced to 8 bits per channel"))
    image, notice = to_srgb(image, profile)
    if notice:
        notices.append(notice)
    rgba = _pixels(image) if rgba is None or image is not file else freeze(rgba)
    return Picture(rgba=rgba, suffix=suffix, notices=tuple(notices))


def _load(file: ImageFile.ImageFile) -> Bytes | None:
    """Decode a picture; return its pixels (h, w, 4) without a second copy if they are RGBA.

    Pictures of some formats are already decoded when they are opened.
    """
    rgba = place = None
    if file.mode == "RGBA" and file.tile:
        rgba = np.zeros((file.height, file.width, 4), dtype=np.uint8)
        file.im = place = Image.frombuffer("RGBA", file.size, rgba, "raw", "RGBA", 0, 1).im
    file.load()
    return rgba if file.im is place else None


def apply_orientation(image: Image.Image) -> tuple[Image.Image, str]:
    """Return a picture rotated by its EXIF orientation, and a notice; empty if unchanged."""
    try:
        if image.getexif().get(EXIF_ORIENTATION, 1) not in range(2, 9):
            return image, ""
        return ImageOps.exif_transpose(image), _("rotated upright, as its camera data says")
    except DECODER_ERRORS:
        return image, _("its camera data is damaged and was ignored")


def _pixels(image: Image.Image) -> Bytes:
    width, height = image.size
    rgba = np.empty((height, width, 4), dtype=np.uint8)
    # Pillow returns pixels in small pieces. Bands stay in the processor's cache, which takes a
    # fifth of the time.
    for top in range(0, height, BAND):
        bottom = min(top + BAND, height)
        rgba[top:bottom] = np.asarray(image.crop((0, top, width, bottom)).convert("RGBA"))
    return freeze(rgba)


def _is_deep(image: ImageFile.ImageFile) -> bool:
    """Return whether an unloaded picture has more than 8 bits per channel.

    Pillow has no mode for deep colours: it drops the lower bits in decoding. Only its name of the
    file's layout ("RGB;16B") or the largest value of a PPM shows the depth.
    """
    for tile in image.tile:
        arguments = tile.args if isinstance(tile.args, tuple) else (tile.args,)
        for argument in arguments:
            if isinstance(argument, str) and ";16" in argument:
                return True
            if image.format == "PPM" and isinstance(argument, int) and argument > 255:
                return True
    return False


def _scale_deep_grey(greys: npt.NDArray[Any], *, is_float: bool) -> Bytes:
    """Map greys of more than 8 bits to 0 … 255.

    Integers are 16 bits wide, whatever their largest value. Floating-point files write white as 1,
    255 or 65535: the smallest of these that holds all values.
    """

    def bands() -> Iterator[Floats]:
        for top in range(0, len(greys), BAND):
            yield np.nan_to_num(greys[top : top + BAND].astype(np.float64))

    largest = max(float(band.max(initial=0.0)) for band in bands())
    white = next((w for w in (1.0, 255.0) if is_float and largest <= w), max(65535.0, largest))
    scaled = [np.rint(np.clip(band / white, 0.0, 1.0) * 255.0).astype(np.uint8) for band in bands()]
    return np.concatenate(scaled)

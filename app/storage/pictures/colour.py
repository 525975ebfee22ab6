"""From the colours of a picture's own profile to sRGB, in which everything here is drawn."""

import io

import numpy as np
from PIL import Image, ImageCms

GREYS = {"1", "L", "LA", "La"}
# What profiles call their colours: the mode that they apply to, and the modes that turn into it
# without a profile.
MODES = {
    "RGB": ("RGB", GREYS | {"P", "PA", "RGB", "RGBA", "RGBX", "RGBa", "YCbCr"}),
    "GRAY": ("L", GREYS),
    "CMYK": ("CMYK", {"CMYK"}),
}
# The profiles that call themselves sRGB differ by as much; a person sees no difference.
SAME = 2  # levels, of 255
LONGEST_NAME = 60


def to_srgb(image: Image.Image, profile: bytes | None) -> tuple[Image.Image, str]:
    """Convert a picture to sRGB, for `PIL.Image.Image.convert("RGBA")`.

    Parameters
    ----------
    image : Image
        Of at most 8 bits per channel.
    profile : bytes, optional
        The ICC profile of its colours; without one they are taken for sRGB.

    Returns
    -------
    Image
        The same one where the profile is sRGB, or cannot be used.
    str
        What happened, in words; empty where no colour changed.

    Notes
    -----
    Relative colorimetric with black point compensation, as editors of pictures do by default: white
    stays white, and colours that sRGB has stay exactly what they are. Others become the nearest.
    """
    if not profile:
        return image, ""
    try:
        source = ImageCms.ImageCmsProfile(io.BytesIO(profile))
        mode, fitting = MODES.get(source.profile.xcolor_space.strip(), ("", set()))
        if image.mode not in fitting:
            return image, "ignored its colour profile, which is of another kind of picture"
        transform = ImageCms.buildTransform(
            source,
            ImageCms.createProfile("sRGB"),
            mode,
            "RGB",
            renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC,
            flags=ImageCms.Flags.BLACKPOINTCOMPENSATION,
        )
    except (OSError, ImageCms.PyCMSError):
        return image, "ignored its colour profile, which is damaged"
    if mode != "CMYK" and _changes_nothing(transform, mode, only_greys=image.mode in GREYS):
        return image, ""
    fit = image if image.mode == mode else image.convert("RGBA").convert(mode)
    converted = transform.apply(fit)
    if image.has_transparency_data:
        converted.putalpha(image.convert("RGBA").getchannel("A"))
    return converted, f"converted its colours from {_name(source)} to sRGB"


def _changes_nothing(transform: ImageCms.ImageCmsTransform, mode: str, *, only_greys: bool) -> bool:
    """Tell whether colours, or only greys, come out as they go in."""
    if only_greys:
        colours = np.arange(256)[:, None].repeat(3, axis=1)
    else:
        colours = np.indices((16, 16, 16)).reshape(3, -1).T * 17
    image = Image.fromarray(colours[None].astype(np.uint8)).convert(mode)
    changed = np.asarray(transform.apply(image), dtype=np.int64)
    return int(np.abs(changed - colours).max()) <= SAME


def _name(profile: ImageCms.ImageCmsProfile) -> str:
    name = " ".join((profile.profile.profile_description or "").split())
    return name[:LONGEST_NAME] or "its own profile"

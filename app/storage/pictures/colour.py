"""Conversion from a picture's colour profile to sRGB, the colour space of the program."""

import io

import numpy as np
from PIL import Image, ImageCms

from app.texts import _

GREYS = {"1", "L", "LA", "La"}
# By the colour space of a profile: the mode of its pixels, and the modes that become this mode
# without a profile.
MODES = {
    "RGB": ("RGB", GREYS | {"P", "PA", "RGB", "RGBA", "RGBX", "RGBa", "YCbCr"}),
    "GRAY": ("L", GREYS),
    "CMYK": ("CMYK", {"CMYK"}),
}
# Profiles named sRGB differ by this much; a person sees no difference.
SAME = 2  # levels, of 255
LONGEST_NAME = 60


def to_srgb(image: Image.Image, profile: bytes | None) -> tuple[Image.Image, str]:
    """Convert a picture to sRGB, for `PIL.Image.Image.convert("RGBA")`.

    Uses relative colorimetric intent with black point compensation, the default of picture editors.
    White stays white, and colours within sRGB keep their values. Other colours become the nearest.

    Parameters
    ----------
    image : Image
        At most 8 bits per channel.
    profile : bytes, optional
        ICC profile. A picture without a profile counts as sRGB.

    Returns
    -------
    Image
        The same object if the profile is sRGB or unusable.
    str
        A notice; empty if no colour changed.
    """
    if not profile:
        return image, ""
    try:
        source = ImageCms.ImageCmsProfile(io.BytesIO(profile))
        mode, fitting = MODES.get(source.profile.xcolor_space.strip(), ("", set()))
        if image.mode not in fitting:
            return image, _("its colour profile is for another kind of picture and was ignored")
        transform = ImageCms.buildTransform(
            source,
            ImageCms.createProfile("sRGB"),
            mode,
            "RGB",
            renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC,
            flags=ImageCms.Flags.BLACKPOINTCOMPENSATION,
        )
    except (OSError, ImageCms.PyCMSError):
        return image, _("its colour profile is damaged and was ignored")
    if mode != "CMYK" and _changes_nothing(transform, mode, only_greys=image.mode in GREYS):
        return image, ""
    fit = image if image.mode == mode else image.convert("RGBA").convert(mode)
    converted = transform.apply(fit)
    if image.has_transparency_data:
        converted.putalpha(image.convert("RGBA").getchannel("A"))
    return converted, _("its colours were converted from {profile} to sRGB").format(
        profile=_name(source)
    )


def _changes_nothing(transform: ImageCms.ImageCmsTransform, mode: str, *, only_greys: bool) -> bool:
    """Return whether the transform keeps all colours, or all greys."""
    if only_greys:
        colours = np.arange(256)[:, None].repeat(3, axis=1)
    else:
        colours = np.indices((16, 16, 16)).reshape(3, -1).T * 17
    image = Image.fromarray(colours[None].astype(np.uint8)).convert(mode)
    changed = np.asarray(transform.apply(image), dtype=np.int64)
    return int(np.abs(changed - colours).max()) <= SAME


def _name(profile: ImageCms.ImageCmsProfile) -> str:
    name = " ".join((profile.profile.profile_description or "").split())
    return name[:LONGEST_NAME] or _("its own profile")

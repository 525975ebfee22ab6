"""From a picture to the mask of its subject."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from engine.arrays import Booleans, Bytes, readonly
from engine.domain.picture.background import BackgroundColour, flood_background
from engine.errors import EngineError

VISIBLE_ALPHA = 8  # of 255: what is fainter may be left out, what is not must be kept
FAINT_GROWTH = 1.10  # fainter pixels are kept if the subject grows by no more than this
OPAQUE_SHARE = 0.998  # visible pixels from which on the picture counts as opaque
SMALLEST_SIDE = 8  # pixels
LEAST_AGREEMENT = 0.80  # of the border with the background's colour
SUBJECT_SHARES = (0.01, 0.97)  # of the picture, between which a removed background is believed


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Subject:
    """The part of a picture that is animated.

    Parameters
    ----------
    mask : bool, shape (h, w)
        True on the subject, first row on top.
    notices : tuple of str
        What had to be done to the picture, in words.
    """

    mask: Booleans
    notices: tuple[str, ...]


def subject_mask(
    rgba: Bytes,
    *,
    tolerance: int = 18,
    background: Literal["auto", "none"] | BackgroundColour = "auto",
    mask: Booleans | None = None,
) -> Subject:
    """Find the subject of a picture: what is not transparent, or stands on a plain background.

    Parameters
    ----------
    rgba : uint8, shape (h, w, 4)
        Straight alpha, first row on top.
    tolerance : int
        Levels, 0 to 255, by which the background of an opaque picture may vary.
    background : {"auto", "none"} or tuple of int
        Whether a background is removed from an opaque picture: where most of its border has one
        colour, never, or what has this colour, be it opaque or not.
    mask : bool, shape (h, w), optional
        True where the picture shows the subject; then nothing is looked for.

    Returns
    -------
    Subject
        Every pixel with alpha ≥ 8 belongs to it, except a removed background.

    Raises
    ------
    EngineError
        If the picture is empty, fully transparent, or its subject is under 8 pixels across; if a
        mask has another size, or a colour levels that are none.
    """
    if rgba.ndim != 3 or rgba.shape[2] != 4 or rgba.dtype != np.uint8:
        raise EngineError(f"A picture must be uint8 (h, w, 4), not {rgba.dtype} {rgba.shape}.")
    if not 0 <= tolerance <= 255:
        raise EngineError(f"The tolerance must be between 0 and 255 levels, not {tolerance}.")
    if rgba.size == 0:
        raise EngineError("The picture has no pixels; give one with a drawing.")
    visible = rgba[..., 3] >= VISIBLE_ALPHA
    count = np.count_nonzero(visible)
    if count == 0:
        raise EngineError("The picture is fully transparent; give one with a visible drawing.")
    notices: tuple[str, ...] = ()
    if mask is not None:
        subject = _masked(rgba[..., 3] > 0, mask)
    elif isinstance(background, tuple):
        subject, notices = _without_colour(rgba, tolerance, background)
    elif count >= OPAQUE_SHARE * visible.size:
        if background == "none":
            subject = visible
        else:
            subject, notices = _without_background(rgba[..., :3], tolerance)
            subject &= visible
    else:
        subject, notices = _without_transparency(rgba[..., 3], visible)
    _require_size(subject)
    return Subject(mask=readonly(subject), notices=notices)


def _masked(visible: Booleans, mask: Booleans) -> Booleans:
    """Return what a mask keeps of a picture."""
    if mask.shape != visible.shape:
        height, width = visible.shape
        raise EngineError(
            f"The mask has {mask.shape[1]} × {mask.shape[0]} pixels and the picture "
            f"{width} × {height}; give a mask of the picture's size."
        )
    subject: Booleans = visible & mask
    if not subject.any():
        raise EngineError("The mask keeps nothing of the picture; make white what is to be kept.")
    return subject


def _without_colour(
    rgba: Bytes, tolerance: int, colour: BackgroundColour
) -> tuple[Booleans, tuple[str, ...]]:
    """Return what is left where a colour has flooded the picture from its border."""
    if not all(0 <= level <= 255 for level in colour):
        raise EngineError(f"The levels of a background's colour are 0 to 255, not {colour}.")
    visible = rgba[..., 3] > 0
    rgb = np.where(visible[..., None], rgba[..., :3], np.array(colour, dtype=np.uint8))
    flooded = flood_background(rgb, tolerance, colour).mask & visible
    name = "#{:02x}{:02x}{:02x}".format(*colour)
    if not flooded.any():
        return visible, (f"no background of the colour {name} at the picture's border",)
    if not (visible & ~flooded).any():
        raise EngineError(
            f"Nothing is left without the background of the colour {name}; lower the tolerance."
        )
    return visible & ~flooded, (f"background removed ({flooded.mean():.0%} of the picture)",)


def _without_transparency(alpha: Bytes, visible: Booleans) -> tuple[Booleans, tuple[str, ...]]:
    """Return all that is not fully transparent; a wide and nearly invisible haze is left out."""
    present = alpha > 0
    faint = int(np.count_nonzero(present) - np.count_nonzero(visible))
    if np.count_nonzero(present) <= FAINT_GROWTH * np.count_nonzero(visible):
        return present, ()
    return visible, (f"{faint:,} nearly invisible pixels (alpha below {VISIBLE_ALPHA}) left out",)


def _without_background(rgb: Bytes, tolerance: int) -> tuple[Booleans, tuple[str, ...]]:
    """Return what stands before a plain background, or the whole picture."""
    background = flood_background(rgb, tolerance)
    share = 1 - float(background.mask.mean())
    least, most = SUBJECT_SHARES
    if background.agreement >= LEAST_AGREEMENT and least <= share <= most:
        return ~background.mask, (f"uniform background removed ({1 - share:.0%} of the picture)",)
    if background.agreement < LEAST_AGREEMENT:
        reason = f"only {background.agreement:.0%} of the border has one colour"
    else:
        reason = f"removing the background would leave {share:.1%} of the picture"
    whole = np.ones(rgb.shape[:2], dtype=np.bool_)
    return whole, (f"opaque picture kept as a whole rectangle: {reason}",)


def _require_size(mask: Booleans) -> None:
    """Raise `EngineError` if the mask spans less than 8 pixels."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    height, width = int(np.ptp(rows)) + 1, int(np.ptp(columns)) + 1
    if max(height, width) < SMALLEST_SIDE:
        raise EngineError(
            f"The subject is only {width} × {height} pixels; give a picture in which it is at "
            f"least {SMALLEST_SIDE} pixels across."
        )

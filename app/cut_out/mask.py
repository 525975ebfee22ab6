"""From a picture to the mask of its subject."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from app.cut_out.background import Background, flood_background
from app.cut_out.cut_out import BackgroundColour, CutOut, Mask, Stroke, paint
from app.cut_out.transparency import VISIBLE_ALPHA, of_alpha, without_transparency
from app.texts import _, ngettext
from engine.arrays import Booleans, Bytes, freeze
from engine.errors import EngineError

OPAQUE_SHARE = 0.998  # share of visible pixels from which the picture counts as opaque
SMALLEST_SIDE = 8  # pixels
LEAST_AGREEMENT = 0.80  # share of the border with the background's colour
SUBJECT_SHARES = (0.01, 0.97)  # of the picture: range in which a background is removed
MOST_ENCLOSED = 0.8  # of the subject: lines on coloured paper enclose more
NOTICED_ENCLOSED = 0.012  # radius of a disc, of the picture's diagonal: larger parts are reported
NO_PICTURE = "A picture must be a uint8 array of shape (h, w, 4), not a {given}."
PICTURE_TYPE = "A picture must be a uint8 array of shape (h, w, 4), not {dtype} of shape {shape}."
TRANSPARENT = "The picture is fully transparent; give one with a visible drawing."
ALL_REMOVED = "The brush removed the whole picture; keep a part of the picture."
SMALL_SUBJECT = (
    "The subject is only {width} × {height} pixels; it must be at least {smallest} pixels "
    "across. Give a larger picture."
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Subject:
    """The animated part of a picture.

    Parameters
    ----------
    mask : bool, shape (h, w)
        True on the subject, first row on top.
    cut : bool
        Whether visible pixels of the picture were removed.
    enclosed : bool, shape (h, w), optional
        True on inner parts with the colour of a removed background, kept or not; None without any.
    opens : bool
        Whether such parts are removed by default.
    toggled_holes : tuple of complex
        The cut-out's points in other holes.
    notices : tuple of str
        Every remedy that was applied, in words.
    """

    mask: Booleans
    cut: bool
    notices: tuple[str, ...]
    enclosed: Booleans | None = None
    opens: bool = False
    toggled_holes: tuple[complex, ...] = ()


def subject_mask(rgba: Bytes, cut_out: CutOut | None = None) -> Subject:
    """Find the subject of a picture: the opaque part, or the part before a plain background.

    Parameters
    ----------
    rgba : uint8, shape (h, w, 4)
        Straight alpha, first row on top.
    cut_out : CutOut, optional
        How the subject is separated from the background; None is `CutOut()`.

    Returns
    -------
    Subject
        It has every pixel with alpha ≥ 8, except a removed background, and pixels removed by hand.

    Raises
    ------
    EngineError
        If the picture is empty, fully transparent, or its subject is under 8 pixels across; if a
        mask has another size.
    """
    cut_out = cut_out or CutOut()
    if not isinstance(rgba, np.ndarray):
        raise EngineError(NO_PICTURE, given=type(rgba).__name__)
    if rgba.ndim != 3 or rgba.shape[2] != 4 or rgba.dtype != np.uint8:
        raise EngineError(PICTURE_TYPE, dtype=rgba.dtype, shape=rgba.shape)
    if rgba.size == 0:
        raise EngineError("The picture has no pixels; give one with a drawing.")
    seen = int(np.count_nonzero(of_alpha(rgba, VISIBLE_ALPHA)))
    if not seen:
        raise EngineError(TRANSPARENT)
    notices: tuple[str, ...] = ()
    background: Background | None = None
    # A mask takes a quarter of a picture's memory: free each one that can be computed again.
    if cut_out.mask is not None:
        subject = _masked(of_alpha(rgba, 1), cut_out.mask)
    elif isinstance(cut_out.background, tuple):
        subject, notices, background = _without_colour(rgba, cut_out.tolerance, cut_out.background)
    elif seen < OPAQUE_SHARE * rgba[..., 3].size:
        subject, notices = without_transparency(rgba)
    elif cut_out.background == "none":
        subject = of_alpha(rgba, VISIBLE_ALPHA)
    else:
        subject, notices, background = _without_background(rgba[..., :3], cut_out.tolerance)
        subject &= of_alpha(rgba, VISIBLE_ALPHA)
    within = _enclosed(subject, background, cut_out)
    del background
    subject, notices = within.subject, notices + within.notices
    if cut_out.strokes:
        subject, notices = _brushed(subject, cut_out.strokes) & of_alpha(rgba, 1), ()
    _require_size(subject)
    area = within.area
    return Subject(
        mask=freeze(subject),
        cut=any(
            bool(((row[:, 3] >= VISIBLE_ALPHA) > kept).any())
            for row, kept in zip(rgba, subject, strict=True)
        ),
        notices=notices,
        enclosed=None if area is None else freeze(area & (subject == within.subject)),
        opens=within.opens,
        toggled_holes=within.toggled_holes,
    )


class _Within(NamedTuple):
    """A subject without the removed enclosed parts, and all enclosed parts."""

    subject: Booleans
    area: Booleans | None
    opens: bool
    toggled_holes: tuple[complex, ...]
    notices: tuple[str, ...]


def _enclosed(subject: Booleans, background: Background | None, cut_out: CutOut) -> _Within:
    """Decide which inner parts of the background's colour are removed with the background."""
    if background is None or not (area := background.enclosed & subject).any():
        return _Within(subject, None, opens=False, toggled_holes=cut_out.toggled_holes, notices=())
    labels, count = ndimage.label(area)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)[1:]
    opens = cut_out.enclosed == "remove" or (
        cut_out.enclosed == "auto"
        and background.is_vivid
        and int(sizes.sum()) <= MOST_ENCLOSED * int(np.count_nonzero(subject))
    )
    opened = np.full(count + 1, opens and cut_out.holes == "keep")
    others = []
    for point in cut_out.toggled_holes:
        row, column = int(np.floor(len(area) - point.imag)), int(np.floor(point.real))
        inside = 0 <= row < area.shape[0] and 0 <= column < area.shape[1]
        number = int(labels[row, column]) if inside else 0
        if number:
            opened[number] = cut_out.holes == "fill" or not opens
        # If holes are filled, only named ones stay open.
        if not number or cut_out.holes == "fill":
            others.append(point)
    opened[0] = False
    seen = sizes >= pi * (NOTICED_ENCLOSED * np.hypot(*area.shape)) ** 2
    notices = []
    if removed := int((seen & opened[1:]).sum()):
        notice = ngettext(
            "{count:,} enclosed part of the background's colour removed too",
            "{count:,} enclosed parts of the background's colour removed too",
            removed,
        )
        notices.append(notice.format(count=removed))
    if kept := int((seen & ~opened[1:]).sum()):
        notice = ngettext(
            "{count:,} enclosed part of the background's colour kept",
            "{count:,} enclosed parts of the background's colour kept",
            kept,
        )
        notices.append(notice.format(count=kept))
    return _Within(subject & ~opened[labels], area, opens, tuple(others), tuple(notices))


def _masked(visible: Booleans, mask: Mask) -> Booleans:
    """Return the visible pixels that a mask keeps."""
    if mask.size != visible.shape[::-1]:
        height, width = visible.shape
        raise EngineError(
            "The mask has {mask_width} × {mask_height} pixels, but the picture has {width} × "
            "{height}; give a mask of the picture's size.",
            mask_width=mask.size[0],
            mask_height=mask.size[1],
            width=width,
            height=height,
        )
    subject: Booleans = visible & mask.kept
    if not subject.any():
        raise EngineError("The mask removes the whole picture; paint the parts to keep white.")
    return subject


def _brushed(subject: Booleans, strokes: Sequence[Stroke]) -> Booleans:
    """Return a mask with strokes drawn over it."""
    kept = subject.copy()
    for stroke in strokes:
        paint(kept, stroke)
    if not kept.any():
        raise EngineError(ALL_REMOVED)
    return kept


def _without_colour(
    rgba: Bytes, tolerance: int, colour: BackgroundColour
) -> tuple[Booleans, tuple[str, ...], Background | None]:
    """Return the pixels outside the flood of a colour from the picture's border."""
    visible = rgba[..., 3] > 0
    rgb = np.where(visible[..., None], rgba[..., :3], np.array(colour, dtype=np.uint8))
    background = flood_background(rgb, tolerance, colour)
    flooded = background.mask & visible
    name = "#{:02x}{:02x}{:02x}".format(*colour)
    if not flooded.any():
        notice = _(
            "the picture's border has no background of colour {colour}; choose another colour"
        )
        return visible, (notice.format(colour=name),), None
    if not (visible & ~flooded).any():
        raise EngineError(
            "Nothing is left after the background of colour {name} is removed; lower the "
            "tolerance.",
            name=name,
        )
    notice = _("background removed ({share:.0%} of the picture)").format(share=flooded.mean())
    return visible & ~flooded, (notice,), background


def _without_background(
    rgb: Bytes, tolerance: int
) -> tuple[Booleans, tuple[str, ...], Background | None]:
    """Return the subject before a plain background, or the whole picture."""
    background = flood_background(rgb, tolerance)
    share = 1 - float(background.mask.mean())
    least, most = SUBJECT_SHARES
    if background.agreement >= LEAST_AGREEMENT and least <= share <= most:
        notice = _("plain background removed ({share:.0%} of the picture)")
        return ~background.mask, (notice.format(share=1 - share),), background
    if background.agreement < LEAST_AGREEMENT:
        share = background.agreement
        notice = _(
            "the opaque picture was kept as a whole rectangle: only {share:.0%} of its border "
            "has one colour"
        )
    else:
        notice = _(
            "the opaque picture was kept as a whole rectangle: without its background only "
            "{share:.1%} of the picture would be left"
        )
    return np.ones(rgb.shape[:2], dtype=np.bool_), (notice.format(share=share),), None


def _require_size(mask: Booleans) -> None:
    """Raise `EngineError` if the mask spans less than 8 pixels."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    height, width = int(np.ptp(rows)) + 1, int(np.ptp(columns)) + 1
    if max(height, width) < SMALLEST_SIDE:
        raise EngineError(SMALL_SUBJECT, width=width, height=height, smallest=SMALLEST_SIDE)

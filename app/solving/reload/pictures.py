"""What changed in a layer's picture: nothing, its place, or its pixels; and its cut-out."""

from dataclasses import dataclass, replace
from hashlib import blake2b

import numpy as np

from app.cut_out import CutOut, Mask, Stroke
from app.solving.reload.alignment import PlacedPicture, agreement_in_place, align_pictures
from engine.arrays import Booleans, Bytes

STAYED = 0.5  # agreement in place above which a redrawn layer did not move
MOVED = 0.8  # agreement elsewhere above which a redrawn layer moved there


@dataclass(frozen=True, slots=True)
class PictureChange:
    """The change of a picture between two versions of its file."""

    is_redrawn: bool
    shift: complex  # of the artwork, in pixels of the canvas


@dataclass(frozen=True, slots=True)
class PlacedMask:
    """The kept pixels of a picture on the canvas; equal to the same pixels in another box."""

    corner: complex
    size: tuple[int, int]
    bits: bytes

    @classmethod
    def of(cls, kept: Booleans, corner: complex) -> "PlacedMask":
        rgba = np.zeros((*kept.shape, 4), dtype=np.uint8)
        rgba[..., 3] = kept
        content = PlacedPicture(rgba, corner).content
        return cls(content.corner, content.size, np.packbits(content.rgba[..., 3]).tobytes())


def picture_digest(rgba: Bytes) -> bytes:
    """Return a digest of what a picture shows, without transparent margins and hidden colours."""
    content = PlacedPicture(rgba, 0j).content.rgba
    shown = content * (content[..., 3:] > 0)
    return blake2b(shown.tobytes(), salt=b"%d" % shown.shape[1]).digest()


def compare_pictures(before: PlacedPicture, now: PlacedPicture) -> PictureChange:
    """Return how a layer's picture changed. A trimmed or extended empty margin is no change."""
    old, new = before.content, now.content
    if old.size == new.size and picture_digest(old.rgba) == picture_digest(new.rgba):
        return PictureChange(is_redrawn=False, shift=new.corner - old.corner)
    if not (old.rgba.size and new.rgba.size) or agreement_in_place(old, new) >= STAYED:
        return PictureChange(is_redrawn=True, shift=0j)
    aligned = align_pictures(old, new.rgba, expected=new.corner)
    if aligned is None or aligned.agreement < MOVED:
        return PictureChange(is_redrawn=True, shift=0j)
    return PictureChange(is_redrawn=True, shift=new.corner - aligned.corner)


def move_cut_out(cut_out: CutOut, by: complex, size: tuple[int, int]) -> CutOut:
    """Return a cut-out for a picture of another size, whose artwork lies elsewhere in the picture.

    Beyond the picture before, a mask keeps all pixels.
    """
    mask = cut_out.mask
    if not by and (mask is None or mask.size == size):
        return cut_out
    return replace(
        cut_out,
        mask=None if mask is None else _moved_mask(mask, by, size),
        strokes=tuple(
            Stroke(points=each.points + by, radius=each.radius, keeps=each.keeps)
            for each in cut_out.strokes
        ),
        toggled_holes=tuple(hole + by for hole in cut_out.toggled_holes),
        cut_lines=tuple(replace(line, points=line.points + by) for line in cut_out.cut_lines),
    )


def _moved_mask(mask: Mask, by: complex, size: tuple[int, int]) -> Mask:
    old = mask.kept
    kept = np.ones((size[1], size[0]), dtype=np.bool_)
    left, top = round(by.real), size[1] - len(old) - round(by.imag)
    inside = old[max(-top, 0) :, max(-left, 0) :]
    target = kept[max(top, 0) :, max(left, 0) :]
    rows, columns = (min(a, b) for a, b in zip(inside.shape, target.shape, strict=True))
    target[:rows, :columns] = inside[:rows, :columns]
    return Mask.of(kept)

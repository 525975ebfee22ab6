"""A margin of a picture under its neighbour, so that nothing shows between them when they turn."""

import numpy as np

from app.solving.reload.alignment import PlacedPicture
from engine.arrays import Bytes, readonly

AROUND = tuple((down, right) for down in (0, 1, 2) for right in (0, 1, 2))


def extend_under(behind: PlacedPicture, front: PlacedPicture) -> PlacedPicture | None:
    """Return a picture that reaches one pixel farther under the picture in front of it.

    Soft edges under the neighbour become as opaque as the pixels beside them. Returns None if the
    pictures do not meet.
    """
    grown = np.pad(behind.rgba, ((1, 1), (1, 1), (0, 0)))
    placed = PlacedPicture(grown, behind.corner - 1 - 1j)
    levels, alpha = _spread(grown)
    changes = (_alpha_under(placed, front) > 0) & (alpha > grown[..., 3])
    if not changes.any():
        return None
    grown[changes, :3], grown[changes, 3] = levels[changes], alpha[changes]
    return PlacedPicture(readonly(grown), placed.corner)


def has_margin_of(picture: PlacedPicture, other: PlacedPicture) -> bool:
    """Return whether a picture is another one with a margin, as of `extend_under`."""
    frame = np.pad(other.rgba, ((1, 1), (1, 1), (0, 0)))
    right, down = PlacedPicture(frame, other.corner - 1 - 1j).offset_of(picture)
    height, width = picture.rgba.shape[:2]
    inside = frame[max(down, 0) : down + height, max(right, 0) : right + width]
    if inside.shape != picture.rgba.shape:
        return False
    levels, alpha = _spread(inside)
    shown, own = picture.rgba * (picture.rgba[..., 3:] > 0), inside * (inside[..., 3:] > 0)
    differs = (shown != own).any(axis=-1)
    margin = np.concatenate([levels, alpha[..., None]], axis=-1)[differs]
    is_added = own[differs][:, 3] < alpha[differs]
    return bool(is_added.all() and (shown[differs] == margin).all())


def _spread(rgba: Bytes) -> tuple[Bytes, Bytes]:
    """Return for each pixel the mean colour (h, w, 3) and the largest alpha (h, w) around it."""
    height, width = rgba.shape[:2]
    padded = np.pad(rgba, ((1, 1), (1, 1), (0, 0))).astype(np.float64)
    near = [padded[down : down + height, right : right + width] for down, right in AROUND]
    weight = sum(each[..., 3] for each in near)
    total = sum(each[..., :3] * each[..., 3:] for each in near)
    levels = np.rint(total / np.maximum(weight, 1)[..., None]).astype(np.uint8)
    alpha = np.maximum.reduce([each[..., 3] for each in near]).astype(np.uint8)
    return levels, alpha


def _alpha_under(behind: PlacedPicture, front: PlacedPicture) -> Bytes:
    """Return the alpha (h, w) of the front picture at the pixels of the picture behind it."""
    alpha = np.zeros(behind.rgba.shape[:2], dtype=np.uint8)
    right, down = behind.offset_of(front)
    part = front.rgba[max(-down, 0) :, max(-right, 0) :, 3]
    target = alpha[max(down, 0) :, max(right, 0) :]
    rows, columns = (min(a, b) for a, b in zip(part.shape, target.shape, strict=True))
    target[:rows, :columns] = part[:rows, :columns]
    return alpha

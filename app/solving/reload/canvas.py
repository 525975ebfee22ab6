"""Where the canvas of a changed file lies on the document's canvas."""

from collections import Counter
from collections.abc import Mapping, Sequence

from app.document import Document, DrawingFile, Layer
from app.errors import LissomError
from app.solving.reload.alignment import PlacedPicture
from app.solving.reload.pictures import compare_pictures
from app.solving.reload.replace_picture import find_new_corner
from app.storage import LayeredPicture, Picture
from app.texts import N_, _

SCALED = N_(
    "{name} was scaled to {scale:.0%}, and handles cannot be scaled with it. Save it again with "
    "{width} × {height} pixels"
)
ALIKE = 0.03  # by which equal ratios of sizes may differ


def find_canvas(
    document: Document,
    drawing: DrawingFile,
    changed: LayeredPicture,
    pictures: Mapping[int, Picture],
    pairs: Sequence[tuple[Layer, int]],
) -> tuple[complex, complex]:
    """Return the corner of the changed file's canvas on the document's, and the scene's shift.

    If the canvas has another size, its place is that at which most unchanged layers stay where they
    are, or else its upper left corner stays. The scene moves if the file's canvas is its own.
    """
    if drawing.size == changed.size:
        return drawing.corner, 0j
    corner = drawing.corner + 1j * (drawing.size[1] - changed.size[1])
    if len(drawing.layers) == len(changed.layers) == 1:
        (layer, _index), *_copies = pairs
        picture = changed.layers[0].picture
        corner = find_new_corner(layer, picture, drawing.size, pictures[layer.id].rgba)
    else:
        votes: Counter[complex] = Counter()
        for layer, index in pairs:
            imported = changed.layers[index]
            change = compare_pictures(
                PlacedPicture(pictures[layer.id].rgba, layer.corner),
                PlacedPicture(imported.picture.rgba, imported.corner),
            )
            if not change.is_redrawn:
                votes[-change.shift] += 1
        if votes:
            corner = votes.most_common(1)[0][0]
        else:
            _refuse_scaled(drawing, changed, pictures, pairs)
    if drawing.size != document.canvas or drawing.corner:
        return corner, 0j
    return 0j, -corner


def _refuse_scaled(
    drawing: DrawingFile,
    changed: LayeredPicture,
    pictures: Mapping[int, Picture],
    pairs: Sequence[tuple[Layer, int]],
) -> None:
    """Refuse a file whose canvas and layers all have another scale: handles would not fit."""
    scale = changed.size[0] / drawing.size[0]
    ratios = [changed.size[1] / drawing.size[1]]
    for layer, index in pairs:
        before = PlacedPicture(pictures[layer.id].rgba, 0j).content.size
        now = PlacedPicture(changed.layers[index].picture.rgba, 0j).content.size
        ratios.append((now[0] + now[1]) / max(before[0] + before[1], 1))
    if abs(scale - 1) > ALIKE and all(abs(ratio / scale - 1) < ALIKE for ratio in ratios):
        raise LissomError(
            _(SCALED).format(
                name=changed.file_name,
                scale=scale,
                width=drawing.size[0],
                height=drawing.size[1],
            )
        )

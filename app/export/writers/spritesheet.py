"""All frames in one PNG, row by row, with their positions in a JSON file beside it.

The JSON has TexturePacker's format ("hash"), with the durations and tags of Aseprite:
https://www.aseprite.org/docs/cli/#sheet
"""

import math
from collections.abc import Sequence
from importlib.metadata import version
from typing import IO, Final, NamedTuple

import numpy as np

from app.errors import LissomError, display_name
from app.export.plan import ExportPlan
from app.export.writers.frame_writer import FrameWriter, frame_duration
from app.export.writers.png import save_png
from app.storage import strict_json
from app.texts import _
from engine.arrays import Bytes

LARGEST: Final = 16_384  # pixels each way: limit of graphics cards; at most a gigabyte
_WIDTHS: Final = np.geomspace(0.7, 2.5, 24)  # shares of the side of a square of the frames' area


class _Cell(NamedTuple):
    """The visible part of a frame, and its upper left corner in the frame."""

    pixels: Bytes
    left: int
    top: int

    @property
    def size(self) -> tuple[int, int]:
        return self.pixels.shape[1], self.pixels.shape[0]


class _SheetLayout(NamedTuple):
    """The size of a sheet, and the upper left corners of its cells."""

    size: tuple[int, int]
    corners: tuple[tuple[int, int], ...]


class SpritesheetWriter(FrameWriter):
    """Collects the frames; writes the sheet and its data at the end.

    Raises `LissomError` if the sheet would be too large.
    """

    def __init__(self, file: IO[bytes], data: IO[bytes], plan: ExportPlan) -> None:
        if not plan.sheet.trimmed:
            sheet_grid(plan)
        super().__init__(file, plan)
        self._data = data
        self._cells: list[_Cell] = []

    def encode(self, frame: Bytes) -> _Cell:
        """Return the visible part of the frame."""
        return _trimmed(frame) if self._plan.sheet.trimmed else _Cell(frame, 0, 0)

    def add(self, encoded: _Cell) -> None:
        self._cells.append(encoded)
        if sum(cell.pixels.size for cell in self._cells) > 4 * LARGEST**2:
            raise _too_large(self._plan)

    def finish(self) -> None:
        plan, layout, cells = self._plan, self._plan.sheet, self._cells
        if layout.trimmed:
            kept, places = _different(cells)
            sheet = _packed([cell.size for cell in kept], plan)
        else:
            kept, places = cells, list(range(len(cells)))
            columns, _ = sheet_grid(plan)
            wide = columns * (plan.view.size[0] + layout.padding) + layout.padding
            sheet = _rows([cell.size for cell in kept], wide, plan)
        width, height = sheet.size
        pixels = np.zeros((height, width, 4), dtype=np.uint8)
        for cell, (left, top) in zip(kept, sheet.corners, strict=True):
            wide, high = cell.size
            pixels[top : top + high, left : left + wide] = cell.pixels
        save_png(pixels, self._file)
        corners = [sheet.corners[place] for place in places]
        self._data.write(_data(plan, sheet.size, cells, corners))


def sheet_grid(plan: ExportPlan) -> tuple[int, int]:
    """Return the columns and rows of a nearly square sheet of equal cells.

    Raises `LissomError` if the sheet would be too large.
    """
    count, padding = len(plan.times), plan.sheet.padding
    width, height = (side + padding for side in plan.view.size)
    room = LARGEST - padding
    most = min(room // width, count)
    columns = max(1, min(most, math.ceil(math.sqrt(count * height / width))))
    rows = math.ceil(count / columns)
    if max(columns * width, rows * height) > room:
        raise _too_large(plan)
    return math.ceil(count / rows), rows  # no empty columns


def _too_large(plan: ExportPlan) -> LissomError:
    width, height = plan.view.size
    return LissomError(
        _(
            "{count} frames of {width} × {height} pixels do not fit on a sheet of {largest:,} "
            "× {largest:,}; choose fewer frames or a smaller size"
        ).format(count=len(plan.times), width=width, height=height, largest=LARGEST)
    )


def _trimmed(frame: Bytes) -> _Cell:
    """Return the visible part of a frame; one pixel if nothing is visible."""
    seen = frame[..., 3] > 0
    if not seen.any():
        return _Cell(frame[:1, :1].copy(), 0, 0)
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    top, left = int(rows[0]), int(columns[0])
    return _Cell(frame[top : rows[-1] + 1, left : columns[-1] + 1].copy(), left, top)


def _different(cells: Sequence[_Cell]) -> tuple[list[_Cell], list[int]]:
    """Return the distinct cells, and the index of each frame's cell."""
    numbers: dict[tuple[tuple[int, int], bytes], int] = {}
    kept: list[_Cell] = []
    places = []
    for cell in cells:
        number = numbers.setdefault((cell.size, cell.pixels.tobytes()), len(kept))
        if number == len(kept):
            kept.append(cell)
        places.append(number)
    return kept, places


def _packed(sizes: Sequence[tuple[int, int]], plan: ExportPlan) -> _SheetLayout:
    """Return the smallest of several layouts in rows."""
    padding = plan.sheet.padding
    widest = max(width for width, _ in sizes) + 2 * padding
    if plan.sheet.power_of_two:
        widths = [2**power for power in range((widest - 1).bit_length(), LARGEST.bit_length())]
    else:
        side = math.sqrt(sum((width + padding) * (height + padding) for width, height in sizes))
        widths = sorted({min(max(widest, round(part * side)), LARGEST) for part in _WIDTHS})
    sheets = [_rows(sizes, width, plan) for width in widths]
    fitting = [sheet for sheet in sheets if max(sheet.size) <= LARGEST]
    if not fitting:
        raise _too_large(plan)
    return min(fitting, key=lambda sheet: (math.prod(sheet.size), max(sheet.size)))


def _rows(sizes: Sequence[tuple[int, int]], most: int, plan: ExportPlan) -> _SheetLayout:
    """Place cells in order in rows of at most `most` pixels."""
    padding = plan.sheet.padding
    left = top = padding
    row_height = right = 0
    corners = []
    for width, height in sizes:
        if left > padding and left + width + padding > most:
            left, top, row_height = padding, top + row_height + padding, 0
        corners.append((left, top))
        left += width + padding
        row_height, right = max(row_height, height), max(right, left)
    size = right, top + row_height + padding
    if plan.sheet.power_of_two:
        size = 1 << (size[0] - 1).bit_length(), 1 << (size[1] - 1).bit_length()
    return _SheetLayout(size, tuple(corners))


def _data(
    plan: ExportPlan,
    size: tuple[int, int],
    cells: Sequence[_Cell],
    corners: Sequence[tuple[int, int]],
) -> bytes:
    frames = {}
    for index, (name, cell, corner) in enumerate(zip(plan.names, cells, corners, strict=True)):
        frames[name] = {
            "frame": _box(corner, cell.size),
            "rotated": False,
            "trimmed": cell.size != plan.view.size,
            "spriteSourceSize": _box((cell.left, cell.top), cell.size),
            "sourceSize": _size(plan.view.size),
            "duration": frame_duration(index, plan.fps, per_second=1000),
        }
    meta = {
        "app": "Lissom",
        "version": version("lissom"),
        "image": display_name(plan.out.name),
        "format": "RGBA8888",
        "size": _size(size),
        "scale": "1",
        "frameTags": [
            {"name": tag.name, "from": tag.first, "to": tag.last, "direction": "forward"}
            for tag in plan.tags
        ],
    }
    return strict_json({"frames": frames, "meta": meta}, indent=1).encode()


def _box(corner: tuple[int, int], size: tuple[int, int]) -> dict[str, int]:
    return {"x": corner[0], "y": corner[1], **_size(size)}


def _size(size: tuple[int, int]) -> dict[str, int]:
    return {"w": size[0], "h": size[1]}

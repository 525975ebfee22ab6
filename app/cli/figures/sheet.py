"""Sheets: rows of pictures of posed shapes with plots beside them, by matplotlib."""

import io
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from app.cli.figures.easel import Easel, alike, box_of
from app.cli.figures.track import Tracked
from app.errors import LissomError, missing
from app.motion import Box
from engine.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, GRID, LIMIT = "#3c404a", "#e0e2e8", "#cf3f3c"
DOTS = 110  # an inch
PICTURE = 520  # pixels of a drawing's longer side
SHOWN = 1.9  # of relative distortion: curves beyond are cut off


def require_matplotlib() -> None:
    """Refuse to begin without it.

    Raises
    ------
    LissomError
        If matplotlib is not installed.
    """
    if remedy := missing("figures"):
        raise LissomError(f"the figures need matplotlib, which is not installed: {remedy}")


def new_sheet(width: float, height: float) -> "Figure":
    """Return an empty sheet of so many inches."""
    from matplotlib.figure import Figure  # noqa: PLC0415 - it is an extra

    return Figure(figsize=(width, height), dpi=DOTS, layout="constrained")


def as_png(sheet: "Figure") -> bytes:
    """Return a sheet as a PNG file, the same bytes for the same sheet."""
    file = io.BytesIO()
    sheet.savefig(file, format="png", metadata={"Software": None})
    return file.getvalue()


def show(
    axes: "Axes", easel: Easel, track: Tracked, time: float, *, box: Box | None = None
) -> None:
    """Draw an in-between, by default whole."""
    positions = track.frame(time).positions
    box = box or box_of(positions)
    picture = easel.draw(track.pair.shape, positions, box, pixels=PICTURE)
    axes.imshow(picture)
    axes.set_axis_off()


def show_panels(
    easel: Easel, panels: Sequence[tuple[str, Tracked, float]], size: tuple[float, float]
) -> "Figure":
    """Return a sheet, of a size in inches, with titled in-betweens side by side at one scale."""
    sheet = new_sheet(*size)
    boxes = alike([box_of(track.frame(time).positions) for _, track, time in panels])
    columns = sheet.subplots(1, len(panels))
    for axes, (title, track, time), box in zip(columns, panels, boxes, strict=True):
        show(axes, easel, track, time, box=box)
        axes.set_title(title, color=INK, fontsize=11)
    return sheet


def show_strip(
    rows: Sequence[Sequence["Axes"]],
    easel: Easel,
    tracks: Mapping[str, Tracked],
    times: Sequence[float],
) -> None:
    """Draw in-betweens in rows with names, all at the same scale."""
    every = tracks.values()
    boxes = alike([box_of(*(track.frame(time).positions for track in every)) for time in times])
    for row, (named, track) in zip(rows, tracks.items(), strict=True):
        for axes, time, box in zip(row, times, boxes, strict=True):
            show(axes, easel, track, time, box=box)
        name(row[0], named)
    for axes, time in zip(rows[0], times, strict=True):
        axes.set_title(f"t = {time:g}", color=INK, fontsize=9)


def show_row(row: Sequence["Axes"], easel: Easel, track: Tracked, times: Sequence[float]) -> None:
    """Draw a method's in-betweens, all at the same scale."""
    boxes = alike([box_of(track.frame(time).positions) for time in times])
    for axes, time, box in zip(row, times, boxes, strict=True):
        show(axes, easel, track, time, box=box)


def name(axes: "Axes", text: str) -> None:
    """Write the name of a row to its left."""
    axes.text(
        *(-0.04, 0.5, text),
        transform=axes.transAxes,
        rotation=90,
        va="center",
        ha="right",
        color=INK,
        fontsize=11,
        fontweight="bold",
    )


def plot_shares(axes: "Axes", times: Floats, shares: Floats, title: str, colour: str) -> None:
    """Draw the relative distortion of the worst points over time, and the limit."""
    axes.plot(times, np.minimum(shares, 2 * SHOWN), color=colour, alpha=0.25, linewidth=0.8)
    axes.axhline(1.0, color=LIMIT, linewidth=1.2)
    axes.set_xlim(0, 1)
    axes.set_ylim(0, SHOWN)
    axes.set_title(f"{title}, at most {told(float(shares.max()))}", color=INK, fontsize=9)
    plain(axes)


def plain(axes: "Axes") -> None:
    """Give a plot the looks of all."""
    axes.tick_params(colors=INK, labelsize=8)
    axes.grid(color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set_color(GRID)


def told(value: float) -> str:
    """Return a number as it is printed beside a figure."""
    if not np.isfinite(value):
        return "unbounded (it folds)"
    return f"{value:.4f}" if value < 10 else f"{value:,.0f}"

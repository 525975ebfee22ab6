"""Sheets: rows of pictures of posed shapes with plots beside them, by matplotlib."""

import io
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from app.errors import LissomError, install_hint
from app.motion import BoundingBox
from app.paper_figures.measure import MeasuredMotion
from app.paper_figures.shape_renderer import ShapeRenderer, bounds_of, same_scale
from app.texts import _
from engine.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, GRID, LIMIT = "#3c404a", "#e0e2e8", "#cf3f3c"
DOTS = 110  # dots per inch
PICTURE = 520  # pixels of a drawing's longer side
SHOWN = 1.9  # relative distortion above which curves are cut off


def require_matplotlib() -> None:
    """Raise `LissomError` if matplotlib is not installed, before any computation."""
    if remedy := install_hint("figures"):
        raise LissomError(
            _("the figures need matplotlib, which is not installed: {remedy}").format(remedy=remedy)
        )


def new_sheet(width: float, height: float) -> "Figure":
    """Return an empty sheet; width and height are in inches."""
    from matplotlib.figure import Figure  # noqa: PLC0415 - it is an extra

    return Figure(figsize=(width, height), dpi=DOTS, layout="constrained")


def as_png(sheet: "Figure") -> bytes:
    """Return a sheet as a PNG file; the same sheet always gives the same bytes."""
    file = io.BytesIO()
    sheet.savefig(file, format="png", metadata={"Software": None})
    return file.getvalue()


def draw_frame(
    axes: "Axes",
    easel: ShapeRenderer,
    track: MeasuredMotion,
    time: float,
    *,
    box: BoundingBox | None = None,
) -> None:
    """Draw an in-between, uncropped by default."""
    positions = track.frame(time).positions
    box = box or bounds_of(positions)
    picture = easel.draw(track.pair.shape, positions, box, pixels=PICTURE)
    axes.imshow(picture)
    axes.set_axis_off()


def draw_panels(
    easel: ShapeRenderer,
    panels: Sequence[tuple[str, MeasuredMotion, float]],
    size: tuple[float, float],
) -> "Figure":
    """Return a sheet with titled in-betweens side by side at one scale; the size is in inches."""
    sheet = new_sheet(*size)
    boxes = same_scale([bounds_of(track.frame(time).positions) for _, track, time in panels])
    columns = sheet.subplots(1, len(panels))
    for axes, (title, track, time), box in zip(columns, panels, boxes, strict=True):
        draw_frame(axes, easel, track, time, box=box)
        axes.set_title(title, color=INK, fontsize=11)
    return sheet


def draw_strip(
    rows: Sequence[Sequence["Axes"]],
    easel: ShapeRenderer,
    tracks: Mapping[str, MeasuredMotion],
    times: Sequence[float],
) -> None:
    """Draw in-betweens in rows with names, all at the same scale."""
    every = tracks.values()
    boxes = same_scale(
        [bounds_of(*(track.frame(time).positions for track in every)) for time in times]
    )
    for row, (named, track) in zip(rows, tracks.items(), strict=True):
        for axes, time, box in zip(row, times, boxes, strict=True):
            draw_frame(axes, easel, track, time, box=box)
        label_row(row[0], named)
    for axes, time in zip(rows[0], times, strict=True):
        axes.set_title(f"t = {time:g}", color=INK, fontsize=9)


def draw_row(
    row: Sequence["Axes"], easel: ShapeRenderer, track: MeasuredMotion, times: Sequence[float]
) -> None:
    """Draw a method's in-betweens, all at the same scale."""
    boxes = same_scale([bounds_of(track.frame(time).positions) for time in times])
    for axes, time, box in zip(row, times, boxes, strict=True):
        draw_frame(axes, easel, track, time, box=box)


def label_row(axes: "Axes", text: str) -> None:
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
    """Plot the relative distortion of the worst points over time, and the limit."""
    axes.plot(times, np.minimum(shares, 2 * SHOWN), color=colour, alpha=0.25, linewidth=0.8)
    axes.axhline(1.0, color=LIMIT, linewidth=1.2)
    axes.set_xlim(0, 1)
    axes.set_ylim(0, SHOWN)
    most = format_number(float(shares.max()))
    text = _("{title}, at most {value}").format(title=title, value=most)
    axes.set_title(text, color=INK, fontsize=9)
    style_axes(axes)


def style_axes(axes: "Axes") -> None:
    """Apply the common style to a plot."""
    axes.tick_params(colors=INK, labelsize=8)
    axes.grid(color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    for spine in axes.spines.values():
        spine.set_color(GRID)


def format_number(value: float) -> str:
    """Format a number for printing beside a figure."""
    if not np.isfinite(value):
        return _("unbounded (it folds)")
    return f"{value:.4f}" if value < 10 else f"{value:,.0f}"

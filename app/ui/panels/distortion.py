"""The distortion of the drawing: on the drawing, over its area, and over time."""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2, ImVec4, icons_fontawesome_6 as icons, imgui, implot

from app.editor import Action, ComparisonRuntime, CurveKind, HeatMap, Project, Session, do
from app.editor.actions import playback, viewing
from app.editor.actions.project_files import saving_curves
from app.motion import DisplayedFrame
from app.render import heat_colormap
from app.reports import TIMES, Curves, split_at_keys
from app.ui.methods import METHODS
from app.ui.style.theme import SMALL, Look, colour_u32, with_alpha
from app.ui.style.widgets import (
    draw_tooltip,
    heading,
    option_buttons,
    small_text,
    split_line,
    text_button,
)
from app.ui.viewport.canvas import heat_limits
from app.ui.viewport.gpu_resources import measure_distortion
from engine.arrays import Floats
from engine.domain.meshing.mesh import Mesh
from engine.maps import Bounds

HEAT_MAPS = (("none", "Off"), ("k", "Shear"), ("sigma_a", "Stretch"), ("sigma_b", "Squeeze"))
NAMES = {"k": "Shear (k)", "sigma_a": "Stretch (σa)", "sigma_b": "Squeeze (σb)"}
SPLITS = (("divider", "Divider"), ("beside", "Side by side"))
KINDS = (("relative", "Relative"), ("absolute", "Absolute"))
BINS = 48
HISTOGRAM, STRIP = 4.6, 0.45  # em
PLOT, LARGEST_PLOT = 4.2, 10.0  # em: smallest and largest height of a plot
LIMIT = 0.11  # em: width of the limit's line
FRAMES = 1.35  # em: height of the frame numbers below the lower plot
SEGMENTS = 72  # pieces of one point's line at most, or a few in each segment
MOST = 2.5  # largest common range, times the own method's: another method may have no limit
HEADROOM = 1.4  # of the largest value: space for the title
QUIET = (
    implot.Flags_.no_legend
    | implot.Flags_.no_mouse_text
    | implot.Flags_.no_menus
    | implot.Flags_.no_inputs
    | implot.Flags_.no_title
)


def draw_distortion_panel(session: Session, look: Look, project: Project) -> list[Action]:
    if project.layer_runtime.shown is None:
        return []
    _style_plots(look)
    heading(look, "On the drawing")
    actions: list[Action] = []
    heat_map = session.overlays.heat_map
    match option_buttons(look, "heat map", HEAT_MAPS, heat_map):
        case "none" | "k" | "sigma_a" | "sigma_b" as chosen:
            actions.append(do(viewing.show_heat_map, chosen))
    _spread(look, project, project.layer_runtime.shown, "k" if heat_map == "none" else heat_map)
    heading(look, "Compare")
    actions += _compare(session, look)
    heading(look, "Over time")
    if len(project.layer.keys) < 2:
        small_text(look, "Make a second key to see how the in-betweens distort.")
        return actions
    return [*actions, *_over_time(session, look, project)]


def _compare(session: Session, look: Look) -> list[Action]:
    """Draw the choice of the compared method and of its layout in the viewport."""
    actions: list[Action] = []
    split = session.compare_view
    imgui.set_next_item_width(-1)
    shown = "Nothing" if split is None else METHODS[split.method].name
    if imgui.begin_combo("##compared", shown):
        if imgui.selectable("Nothing", split is None)[0]:
            actions.append(do(viewing.compare_with_method, None))
        for method, text in METHODS.items():
            is_chosen = split is not None and split.method == method
            if imgui.selectable(text.title, is_chosen)[0]:
                actions.append(do(viewing.compare_with_method, method))
            draw_tooltip(text.what)
        imgui.end_combo()
    draw_tooltip("The same keys by another method, beside this drawing's own")
    if split is not None:
        chosen = option_buttons(
            look, "split", SPLITS, "beside" if split.is_side_by_side else "divider"
        )
        if chosen is not None and (chosen == "beside") != split.is_side_by_side:
            actions.append(do(viewing.set_side_by_side, chosen == "beside"))
    return actions


def _style_plots(look: Look) -> None:
    style = implot.get_style()
    clear = ImVec4(0, 0, 0, 0)
    for slot, colour in (
        (implot.Col_.frame_bg, clear),
        (implot.Col_.plot_bg, look.palette.desk),
        (implot.Col_.plot_border, clear),
        (implot.Col_.axis_text, look.palette.dim),
        (implot.Col_.axis_grid, look.palette.line),
        (implot.Col_.axis_tick, look.palette.line),
    ):
        style.set_color_(slot, colour)
    style.plot_padding = ImVec2(0.1 * look.em, 0.4 * look.em)
    style.label_padding = ImVec2(0.35 * look.em, 0.35 * look.em)
    style.plot_border_size = 0.0


class _Histogram(NamedTuple):
    """Shares of the area between the edges (one more than shares), and the worst value."""

    shares: tuple[float, ...]
    edges: tuple[float, ...]
    worst: float


@lru_cache(maxsize=2)
def _histogram(shown: DisplayedFrame, heat_map: HeatMap, low: float, high: float) -> _Histogram:
    values = measure_distortion(shown, heat_map)
    ends = np.array([low, high, values.min(), values.max()])
    shares, edges = np.histogram(
        values,
        BINS,
        range=(float(ends.min()), float(ends.max())),
        weights=_areas(shown.mesh.domain.mesh),
    )
    worst = values.min() if heat_map == "sigma_b" else values.max()
    return _Histogram(tuple(shares.tolist()), tuple(edges.tolist()), float(worst))


@lru_cache(maxsize=2)
def _areas(mesh: Mesh) -> Floats:
    """Return the share of the area around each vertex, (v,)."""
    areas = np.bincount(mesh.triangles.ravel(), np.repeat(mesh.areas(), 3), len(mesh.vertices))
    return np.asarray(areas / areas.sum())


@lru_cache(maxsize=2)
def _colours(first: float, last: float, low: float, high: float) -> tuple[int, ...]:
    """Return the heat map's colours at the middles of the bins."""
    middles = first + (np.arange(BINS) + 0.5) / BINS * (last - first)
    places = np.clip((middles - low) / (high - low), 0.0, 1.0)
    rows = heat_colormap()[np.rint(255 * places).astype(int)]
    return tuple(imgui.IM_COL32(red, green, blue, 255) for red, green, blue in rows.tolist())


def _spread(look: Look, project: Project, shown: DisplayedFrame, heat_map: HeatMap) -> None:
    """Draw the histogram of distortion over the area, in the colours of the heat map."""
    low, high = heat_limits(project, heat_map)
    histogram = _histogram(shown, heat_map, low, high)
    edges = histogram.edges
    axis = implot.AxisFlags_.no_highlight | implot.AxisFlags_.no_grid_lines
    inverted = implot.AxisFlags_.invert if heat_map == "sigma_b" else 0
    if implot.begin_plot("##histogram", ImVec2(-1, HISTOGRAM * look.em), QUIET):
        implot.setup_axes("", "", axis | inverted, axis | implot.AxisFlags_.no_decorations)
        room = 0.02 * (edges[-1] - edges[0])
        top = max(histogram.shares) * 1.08
        implot.setup_axes_limits(edges[0] - room, edges[-1] + room, 0.0, top, implot.Cond_.always)
        _bars(look, histogram, _colours(edges[0], edges[-1], low, high))
        _rule("bound", [high], look.palette.danger, width=LIMIT * look.em)
        implot.end_plot()
    name = NAMES[heat_map]
    small_text(look, f"{name} over the area: {histogram.worst:.2f} at worst, limit {high:.2f}.")


def _bars(look: Look, histogram: _Histogram, colours: tuple[int, ...]) -> None:
    """Draw the bars, and a strip of the heat map's colours below them."""
    draw_list = implot.get_plot_draw_list()
    implot.push_plot_clip_rect()
    floor = implot.get_plot_pos().y + implot.get_plot_size().y
    strip = STRIP * look.em
    first = implot.plot_to_pixels(histogram.edges[0], 1.0)
    last = implot.plot_to_pixels(histogram.edges[-1], 0.0)
    step = (last.x - first.x) / BINS
    for number, (share, colour) in enumerate(zip(histogram.shares, colours, strict=True)):
        left, right = sorted((first.x + number * step, first.x + (number + 1) * step))
        top = last.y + share * (first.y - last.y) - strip
        draw_list.add_rect_filled(
            ImVec2(left + 0.5, top), ImVec2(right - 0.5, floor - strip - 1), colour
        )
        draw_list.add_rect_filled(ImVec2(left, floor - strip), ImVec2(right + 0.5, floor), colour)
    implot.pop_plot_clip_rect()


def _over_time(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    match option_buttons(look, "curves", KINDS, session.curves):
        case "relative" | "absolute" as kind:
            actions.append(do(viewing.show_curves, kind))
    curves = project.curves.value
    if curves is None:
        small_text(look, "Measuring…")
        return actions
    height = _plot_height(look)
    bounds = project.layer.bounds
    upper, lower = _plots(session.curves, curves, bounds)
    other_upper, other_lower = None, None
    twin, twin_curves = project.layer_runtime.comparison, project.comparison_curves
    if twin is not None and twin_curves.value is not None:
        if twin_curves.follows(twin.clip(project.document)):
            other_upper, other_lower = _plots(session.curves, twin_curves.value, bounds)
        _draw_comparison_tooltip(look, twin, curves, twin_curves.value)
    actions += _plot(session, look, curves, (upper, other_upper), height)
    actions += _plot(session, look, curves, (lower, other_lower), height + FRAMES * look.em)
    if session.curves == "relative":
        small_text(look, "Each point relative to its larger key. Red: theoretical limit.")
    else:
        small_text(look, "Red: the limits of poses.")
    halves, is_new = split_line(2), curves.clip == project.clip
    png, csv = f"{icons.ICON_FA_IMAGE}  Save as PNG…", f"{icons.ICON_FA_TABLE}  Save as CSV…"
    if text_button(f"{png}###png", next(halves), enabled=is_new):
        actions.append(do(saving_curves.ask_curves_png))
    if text_button(f"{csv}###csv", next(halves), enabled=is_new):
        actions.append(do(saving_curves.ask_curves_csv))
    return actions


def _plot_height(look: Look) -> float:
    """Return the height of the upper plot with which both plots fit the panel."""
    spacing = imgui.get_style().item_spacing.y
    below = SMALL * imgui.get_text_line_height() + imgui.get_frame_height() + 3 * spacing
    room = (imgui.get_content_region_avail().y - below - FRAMES * look.em) / 2 - spacing
    return min(max(room, PLOT * look.em), LARGEST_PLOT * look.em)


class _Plot(NamedTuple):
    """A plot over time: the line of all points, and the range and limit of its values.

    Of two plots with the same frames, only the lower one has frame numbers.
    """

    title: str
    frames: Floats
    values: Floats
    least: float
    bound: float
    has_frames: bool

    @property
    def top(self) -> float:
        largest = max(self.bound, float(np.nanmax(self.values)))
        return self.least + HEADROOM * (largest - self.least)


@lru_cache(maxsize=4)
def _plots(kind: CurveKind, curves: Curves, bounds: Bounds) -> tuple[_Plot, _Plot]:
    if kind == "relative":
        return (
            _Plot("k", *_lines(curves, curves.k_share), 0.0, 1.0, has_frames=False),
            _Plot("τ − 1", *_lines(curves, curves.tau_share), 0.0, 1.0, has_frames=True),
        )
    farthest = max(bounds.sigma_a, 1.0 / bounds.sigma_b)
    return (
        _Plot("k", *_lines(curves, curves.k), 0.0, bounds.k, has_frames=False),
        _Plot("τ = max(σa, 1/σb)", *_lines(curves, curves.tau), 1.0, farthest, has_frames=True),
    )


def _lines(curves: Curves, values: Floats) -> tuple[Floats, Floats]:
    """Return the points' lines, with fewer pieces in each of many segments."""
    wanted = max(4, SEGMENTS * TIMES // len(curves.frames))
    pieces = np.linspace(0, TIMES - 1, min(wanted, TIMES)).round().astype(int)
    kept = np.append(pieces, TIMES)  # and the break after each segment
    frames, lines = (line.reshape(-1, TIMES + 1) for line in split_at_keys(curves, values))
    return frames[:, kept].ravel(), lines[:, kept].ravel()


def _draw_comparison_tooltip(
    look: Look, twin: ComparisonRuntime, own: Curves, other: Curves
) -> None:
    """Show the name and the extremes of each method's curves."""
    if (other.clip.layer, other.clip.baseline or twin.method) != (twin.layer, twin.method):
        small_text(look, "Measuring the other method…")
        return
    palette = look.palette
    for curves, colour in ((own, palette.accent), (other, palette.warning)):
        name = METHODS[curves.clip.baseline or curves.clip.layer.variant].name
        (k, sigma_a, _), (*_, sigma_b) = curves.extremes.max(0), curves.extremes.min(0)
        limits = f"shear {k:.2f}, stretch {sigma_a:.2f}, squeeze {sigma_b:.2f}"
        imgui.text_colored(colour, f"{name}: {limits}")


def _plot(
    session: Session,
    look: Look,
    curves: Curves,
    plots: tuple[_Plot, _Plot | None],
    height: float,
) -> list[Action]:
    """Draw the curves of the worst points, also the compared method's. A click scrubs."""
    plot, other = plots
    actions: list[Action] = []
    project, palette = session.project, look.palette
    if project is None or not implot.begin_plot(
        f"##over time {plot.title}", ImVec2(-1, height), QUIET
    ):
        return actions
    quiet = implot.AxisFlags_.no_highlight
    along = quiet | implot.AxisFlags_.no_grid_lines
    if not plot.has_frames:
        along |= implot.AxisFlags_.no_tick_labels
    implot.setup_axes("", "", along, quiet)
    first, last = float(curves.frames[0]), float(curves.frames[-1])
    top = plot.top if other is None else min(max(plot.top, other.top), MOST * plot.top)
    implot.setup_axes_limits(first, last, plot.least, top, implot.Cond_.always)
    _rule("keys", [key.frame for key in project.layer.keys], palette.line)
    alpha = 0.10 if curves.clip != project.clip else 0.30
    if other is not None:
        _trace("others", other, with_alpha(palette.warning, alpha))
    _trace("points", plot, with_alpha(palette.accent, alpha))
    _rule("bound", [plot.bound], palette.danger, width=LIMIT * look.em, across=True)
    _rule("now", [playback.current_frame(session, project)], palette.text)
    corner = implot.get_plot_pos()
    place = corner + ImVec2(0.5 * look.em, 0.2 * look.em)
    implot.get_plot_draw_list().add_text(place, colour_u32(palette.text), plot.title)
    # ImPlot never reports a plot without own inputs as hovered.
    is_over = imgui.is_mouse_hovering_rect(corner, corner + implot.get_plot_size())
    if is_over and imgui.is_window_hovered() and imgui.is_mouse_clicked(imgui.MouseButton_.left):
        actions.append(do(playback.seek, round(implot.get_plot_mouse_pos().x)))
    implot.end_plot()
    draw_tooltip("Click to go to that frame")
    return actions


def _trace(name: str, plot: _Plot, colour: ImVec4) -> None:
    line = implot.Spec()
    line.line_color = colour
    implot.plot_line(f"##{name}", plot.frames, plot.values, line)


def _rule(
    name: str, values: Sequence[float], colour: ImVec4, *, width: float = 1.0, across: bool = False
) -> None:
    """Draw lines through a whole plot: vertical, or horizontal if `across`."""
    line = implot.Spec()
    line.line_color, line.line_weight = colour, width
    if across:
        line.flags = implot.InfLinesFlags_.horizontal
    implot.plot_inf_lines(f"##{name}", np.array(values, dtype=float), line)

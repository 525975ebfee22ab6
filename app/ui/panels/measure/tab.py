"""The tab of measures: distortion on the drawing, over its area, over time, and of keys."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui, implot

from app.editor import Action, HeatMap, Project, Session, do
from app.editor.actions import viewing
from app.motion import LayerFrame
from app.render import heat_colormap
from app.texts import _
from app.ui.methods import METHODS
from app.ui.panels.measure.curves import (
    LIMIT_WIDTH,
    PLOT_FLAGS,
    draw_distortion_curves,
    draw_rule,
)
from app.ui.panels.measure.keys import draw_key_table, draw_pose_state
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, heading, option_buttons, small_text
from app.ui.viewport.canvas import heat_limits
from app.ui.viewport.picture.gpu_resources import measure_distortion
from engine.arrays import Floats
from engine.domain.meshing.mesh import Mesh

HEAT_MAPS = (
    ("none", _("Off")),
    ("k", _("Shear")),
    ("sigma_a", _("Stretch")),
    ("sigma_b", _("Squeeze")),
)
NAMES = {"k": _("Shear (k)"), "sigma_a": _("Stretch (σa)"), "sigma_b": _("Squeeze (σb)")}
SPLITS = (("divider", _("Divider")), ("beside", _("Side by side")))
BINS = 48
HISTOGRAM, STRIP = 4.6, 0.45  # em


def draw_measure_panel(session: Session, look: Look, project: Project) -> list[Action]:
    if project.layer_runtime.shown is None:
        return []
    _style_plots(look)
    heading(look, _("On the drawing"))
    actions: list[Action] = []
    heat_map = session.display.overlays.heat_map
    match option_buttons(look, "heat map", HEAT_MAPS, heat_map):
        case "none" | "k" | "sigma_a" | "sigma_b" as chosen:
            actions.append(do(viewing.show_heat_map, chosen))
    _spread(look, project, project.layer_runtime.shown, "k" if heat_map == "none" else heat_map)
    heading(look, _("Compare"))
    actions += _compare(session, look)
    heading(look, _("Over time"))
    if len(project.layer.keys) < 2:
        small_text(look, _("Set a second key to see how the in-betweens distort."))
    else:
        actions += draw_distortion_curves(session, look, project)
    heading(look, _("Pose"))
    draw_pose_state(session, look, project)
    heading(look, _("Keys"))
    return actions + draw_key_table(session, look, project)


def _compare(session: Session, look: Look) -> list[Action]:
    """Draw the choice of the compared method and of its layout in the viewport."""
    actions: list[Action] = []
    split = session.display.compare_view
    imgui.set_next_item_width(-1)
    shown = _("Nothing") if split is None else METHODS[split.method].name
    if imgui.begin_combo("##compared", shown):
        if imgui.selectable(_("Nothing"), split is None)[0]:
            actions.append(do(viewing.compare_with_method, None))
        for method, text in METHODS.items():
            is_chosen = split is not None and split.method == method
            if imgui.selectable(text.title, is_chosen)[0]:
                actions.append(do(viewing.compare_with_method, method))
            draw_tooltip(text.what)
        imgui.end_combo()
    draw_tooltip(_("The same keys by another method, beside this drawing's own"))
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
def _histogram(shown: LayerFrame, heat_map: HeatMap, low: float, high: float) -> _Histogram:
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


def _spread(look: Look, project: Project, shown: LayerFrame, heat_map: HeatMap) -> None:
    """Draw the histogram of distortion over the area, in the colours of the heat map."""
    low, high = heat_limits(project, heat_map)
    histogram = _histogram(shown, heat_map, low, high)
    edges = histogram.edges
    axis = implot.AxisFlags_.no_highlight | implot.AxisFlags_.no_grid_lines
    inverted = implot.AxisFlags_.invert if heat_map == "sigma_b" else 0
    if implot.begin_plot("##histogram", ImVec2(-1, HISTOGRAM * look.em), PLOT_FLAGS):
        implot.setup_axes("", "", axis | inverted, axis | implot.AxisFlags_.no_decorations)
        room = 0.02 * (edges[-1] - edges[0])
        top = max(histogram.shares) * 1.08
        implot.setup_axes_limits(edges[0] - room, edges[-1] + room, 0.0, top, implot.Cond_.always)
        _bars(look, histogram, _colours(edges[0], edges[-1], low, high))
        draw_rule("bound", [high], look.palette.danger, width=LIMIT_WIDTH * look.em)
        implot.end_plot()
    text = _("{name} over the area: {worst:.2f} at worst, limit {limit:.2f}.")
    small_text(look, text.format(name=NAMES[heat_map], worst=histogram.worst, limit=high))


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

"""How far the drawing is distorted: on the drawing, over its points, and over time."""

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui, implot

from app.actions import measuring, viewing
from app.actions.action import Action, do
from app.measuring import TIMES, Curves
from app.session import HeatMap, Project, Session
from app.ui.canvas import heat_limits, measure
from app.ui.theme import Look
from app.ui.widgets import heading, segments, small
from engine.arrays import Floats

HEAT_MAPS = (("none", "Off"), ("k", "k"), ("sigma_a", "σa"), ("sigma_b", "σb"))
BINS = 40
PLOT = 9.0  # em


def draw(session: Session, look: Look) -> list[Action]:
    """Draw the choice of the heat map, the histogram, and the curves."""
    project = session.project
    if project is None or project.shown is None:
        return []
    actions: list[Action] = []
    heading(look, "On the drawing")
    heat_map = session.overlays.heat_map
    match segments(look, "heat map", HEAT_MAPS, heat_map):
        case "none" | "k" | "sigma_a" | "sigma_b" as chosen:
            actions.append(do(viewing.show_heat_map, chosen))
    _colour_plots(look)
    _histogram(look, project, "k" if heat_map == "none" else heat_map)
    heading(look, "Over time")
    curves = project.curves
    if len(project.document.keys) < 2:
        small(look, "There is nothing to compare yet: make a second key.")
        return actions
    actions.append(do(measuring.keep_up))
    if curves is not None:
        actions += _curves(look, curves)
    return actions


def _colour_plots(look: Look) -> None:
    style = implot.get_style()
    clear = ImVec4(0, 0, 0, 0)
    for slot, colour in (
        (implot.Col_.frame_bg, clear),
        (implot.Col_.plot_bg, look.palette.desk),
        (implot.Col_.plot_border, look.palette.line),
        (implot.Col_.axis_text, look.palette.dim),
        (implot.Col_.axis_grid, look.palette.line),
        (implot.Col_.axis_tick, look.palette.line),
    ):
        style.set_color_(slot, colour)
    style.plot_padding = ImVec2(0.2 * look.em, 0.4 * look.em)
    style.plot_border_size = 0.0


def _histogram(look: Look, project: Project, heat_map: HeatMap) -> None:
    if project.shown is None:
        return
    values = measure(project.shown, heat_map)
    bound = heat_limits(project, heat_map)[1]
    low, high = (0.0, max(bound, 0.01)) if heat_map == "k" else sorted((1.0, bound))
    counts, edges = np.histogram(values, bins=BINS, range=(low, max(high, float(values.max()))))
    share = 100.0 * counts / max(len(values), 1)
    centres = (edges[:-1] + edges[1:]) / 2
    flags = implot.Flags_.no_legend | implot.Flags_.no_mouse_text | implot.Flags_.no_inputs
    if implot.begin_plot("##histogram", ImVec2(-1, 0.75 * PLOT * look.em), flags):
        axis = implot.AxisFlags_.no_highlight
        implot.setup_axes("", "", axis, axis | implot.AxisFlags_.no_decorations)
        implot.setup_axes_limits(
            float(edges[0]),
            float(max(edges[-1], bound) * 1.02),
            0.0,
            float(share.max() * 1.1 + 1e-9),
            implot.Cond_.always,
        )
        bars = implot.Spec()
        bars.fill_color = look.palette.accent
        bars.line_color = look.palette.accent
        implot.plot_bars("points", centres, share, 0.9 * float(edges[1] - edges[0]), bars)
        _limit(look, bound, vertical=True)
        implot.end_plot()
    worst = values.min() if heat_map == "sigma_b" else values.max()
    small(look, f"Worst {worst:.3f}; the line is the bound, {bound:.2f}")


def _curves(look: Look, curves: Curves) -> list[Action]:
    actions: list[Action] = []
    for name, title, shares in (
        ("k", "k, each point's share of its keys'", curves.k_share),
        ("tau", "τ − 1, each point's share of its keys'", curves.tau_share),
    ):
        flags = implot.Flags_.no_legend | implot.Flags_.no_mouse_text | implot.Flags_.no_menus
        if implot.begin_plot(f"##{name}", ImVec2(-1, PLOT * look.em), flags):
            implot.setup_axes("", "", 0, 0)
            top = max(1.15, float(shares.max()) * 1.05)
            first, last = float(curves.frames[0]), float(curves.frames[-1])
            implot.setup_axes_limits(first, last, 0.0, top, implot.Cond_.once)
            line = implot.Spec()
            accent = look.palette.accent
            line.line_color = ImVec4(accent.x, accent.y, accent.z, 0.28)
            implot.plot_line("##points", *_joined(curves.frames, shares), line)
            _limit(look, 1.0, vertical=False)
            implot.end_plot()
        small(look, title)
    if imgui.button("Save as CSV…"):
        actions.append(do(measuring.ask_csv))
    imgui.same_line()
    if imgui.button("Save as PNG…"):
        actions.append(do(measuring.ask_png))
    return actions


def _joined(frames: Floats, shares: Floats) -> tuple[Floats, Floats]:
    """Return all curves (t, p) as one line, broken by NaN after each interval."""
    intervals = len(frames) // TIMES
    blocks = shares.T.reshape(-1, intervals, TIMES)
    broken = np.concatenate([blocks, np.full((*blocks.shape[:2], 1), np.nan)], axis=2)
    times = np.concatenate(
        [frames.reshape(intervals, TIMES), np.full((intervals, 1), np.nan)], axis=1
    )
    return np.tile(times.ravel(), len(blocks)), broken.ravel()


def _limit(look: Look, value: float, *, vertical: bool) -> None:
    limit = implot.Spec()
    limit.line_color = look.palette.danger
    limit.line_weight = 1.6
    if not vertical:
        limit.flags = implot.InfLinesFlags_.horizontal
    implot.plot_inf_lines("bound", np.array([value]), limit)

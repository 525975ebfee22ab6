"""The curves of the worst points over time, also of the compared method."""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2, ImVec4, icons_fontawesome_6 as icons, imgui, implot

from app.editor import Action, ComparisonRuntime, CurveKind, Project, Session, do
from app.editor.actions import playback, viewing
from app.editor.actions.project_files import saving_curves
from app.reports import TIMES, Curves, split_at_keys
from app.texts import _
from app.ui.methods import METHODS
from app.ui.style.theme import SMALL, Look, colour_u32, with_alpha
from app.ui.style.widgets import draw_tooltip, option_buttons, small_text, split_line, text_button
from engine.arrays import Floats
from engine.maps import Bounds

KINDS = (("relative", _("Relative")), ("absolute", _("Absolute")))
PLOT, LARGEST_PLOT = 4.2, 10.0  # em: smallest and largest height of a plot
LIMIT_WIDTH = 0.11  # em: width of the limit's line
FRAMES = 1.35  # em: height of the frame numbers below the lower plot
SEGMENTS = 72  # pieces of one point's line at most, or a few in each segment
MOST = 2.5  # largest common range, times the own method's: another method may have no limit
HEADROOM = 1.4  # of the largest value: space for the title
PLOT_FLAGS = (
    implot.Flags_.no_legend
    | implot.Flags_.no_mouse_text
    | implot.Flags_.no_menus
    | implot.Flags_.no_inputs
    | implot.Flags_.no_title
)


def draw_distortion_curves(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    match option_buttons(look, "curves", KINDS, session.display.curve_kind):
        case "relative" | "absolute" as kind:
            actions.append(do(viewing.show_curves, kind))
    curves = project.measured.curves.value
    if curves is None:
        small_text(look, _("Measuring…"))
        return actions
    height = _plot_height(look)
    bounds = project.layer.bounds
    upper, lower = _plots(session.display.curve_kind, curves, bounds)
    other_upper, other_lower = None, None
    comparison, other = project.layer_runtime.comparison, project.measured.comparison_curves
    if comparison is not None and other.value is not None:
        if other.follows(comparison.clip(project.document)):
            other_upper, other_lower = _plots(session.display.curve_kind, other.value, bounds)
        _draw_comparison(look, comparison, curves, other.value)
    actions += _plot(session, look, curves, (upper, other_upper), height)
    actions += _plot(session, look, curves, (lower, other_lower), height + FRAMES * look.em)
    if session.display.curve_kind == "relative":
        small_text(look, _("Each point relative to its larger key. Red: theoretical limit."))
    else:
        small_text(look, _("Red: the limits of poses."))
    halves, is_new = split_line(2), curves.clip == project.clip
    reason = None if is_new else _("Wait until the curves are measured again.")
    png = f"{icons.ICON_FA_IMAGE}  {_('Save as PNG…')}"
    csv = f"{icons.ICON_FA_TABLE}  {_('Save as CSV…')}"
    if text_button(f"{png}###png", next(halves), reason=reason):
        actions.append(do(saving_curves.ask_curves_png))
    if text_button(f"{csv}###csv", next(halves), reason=reason):
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


def _draw_comparison(look: Look, comparison: ComparisonRuntime, own: Curves, other: Curves) -> None:
    """Show the name and the extremes of each method's curves."""
    method = other.clip.baseline or comparison.method
    if (other.clip.layer, method) != (comparison.layer, comparison.method):
        small_text(look, _("Measuring the other method…"))
        return
    palette = look.palette
    for curves, colour in ((own, palette.accent), (other, palette.warning)):
        name = METHODS[curves.clip.baseline or curves.clip.layer.variant].name
        k, sigma_a = curves.extremes[:, :2].max(0)
        text = _("{name}: shear {k:.2f}, stretch {sigma_a:.2f}, squeeze {sigma_b:.2f}")
        sigma_b = curves.extremes[:, 2].min()
        imgui.text_colored(colour, text.format(name=name, k=k, sigma_a=sigma_a, sigma_b=sigma_b))


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
        f"##over time {plot.title}", ImVec2(-1, height), PLOT_FLAGS
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
    draw_rule("keys", [key.frame for key in project.layer.keys], palette.line)
    alpha = 0.10 if curves.clip != project.clip else 0.30
    if other is not None:
        _trace("others", other, with_alpha(palette.warning, alpha))
    _trace("points", plot, with_alpha(palette.accent, alpha))
    draw_rule("bound", [plot.bound], palette.danger, width=LIMIT_WIDTH * look.em, across=True)
    draw_rule("now", [playback.current_frame(session, project)], palette.text)
    corner = implot.get_plot_pos()
    place = corner + ImVec2(0.5 * look.em, 0.2 * look.em)
    implot.get_plot_draw_list().add_text(place, colour_u32(palette.text), plot.title)
    # ImPlot never reports a plot without own inputs as hovered.
    is_over = imgui.is_mouse_hovering_rect(corner, corner + implot.get_plot_size())
    if is_over and imgui.is_window_hovered() and imgui.is_mouse_clicked(imgui.MouseButton_.left):
        actions.append(do(playback.seek, round(implot.get_plot_mouse_pos().x)))
    implot.end_plot()
    draw_tooltip(_("Click to go to that frame"))
    return actions


def _trace(name: str, plot: _Plot, colour: ImVec4) -> None:
    line = implot.Spec()
    line.line_color = colour
    implot.plot_line(f"##{name}", plot.frames, plot.values, line)


def draw_rule(
    name: str, values: Sequence[float], colour: ImVec4, *, width: float = 1.0, across: bool = False
) -> None:
    """Draw lines through a whole plot: vertical, or horizontal if `across`."""
    line = implot.Spec()
    line.line_color, line.line_weight = colour, width
    if across:
        line.flags = implot.InfLinesFlags_.horizontal
    implot.plot_inf_lines(f"##{name}", np.array(values, dtype=float), line)

"""The graph's mapping between numbers and pixels, and the shape of its curves."""

from collections.abc import Mapping
from math import ceil, floor, log10

import numpy as np
from imgui_bundle import ImVec2, ImVec4

from app.document import ChannelCurve, curves_of, display_frame, keys_in, sample_curves, track_in
from app.editor import CurvePoint, GraphPlace, PointBox, PointDrag, PointScale, TangentDrag
from app.editor.actions.timing import graph
from app.ui.style.theme import rgb
from app.ui.timeline.layout import TimelineLayout
from app.ui.timeline.rows.lanes import find_visible_keys
from engine.arrays import Floats

STEP = 0.5  # em between two samples of a curve
BESIDE = 1 / 512  # frames before and after a key where a curve is sampled, too
WHOLE = 240  # samples of all frames, which the shown numbers fit
MOST_FITTED = 100  # keys up to which they fit exactly
MARGIN, APART = 0.12, 0.08  # of the fitted numbers, above and below; more for each further unit
LABEL_GAP = 2.3  # em: smallest distance of the axis's labels
# Smallest range of numbers that is fitted, by unit.
LEAST_RANGES = {"px": 8.0, "°": 8.0, "%": 20.0, "": 1.0}
COLOURS = {
    True: ("ff8f88", "7fd49b", "7db4ff", "f2c35a", "d69bff", "4fd0c8", "ff9ed2", "b7c36b"),
    False: ("c4302b", "1d7f45", "1f62c4", "8a5f00", "8334bd", "00757a", "b3256f", "5f6c00"),
}


class GraphView:
    """The curves that the graph shows, and the mapping between numbers and pixels."""

    def __init__(self, bands: TimelineLayout) -> None:
        self.bands = bands
        self._lines: dict[ChannelCurve, tuple[Floats, Floats]] = {}
        project, palette = bands.project, bands.look.palette
        self.state, self.document = project.graph, project.document
        self.is_speed = self.state.shows_speed
        self.curves = graph.shown_curves(project)
        self.chosen = graph.selected_points(project)
        colours = COLOURS[palette.is_dark]
        listed = [
            curve
            for channel in graph.graphed_channels(project)
            for curve in curves_of(self.document, channel)
        ]
        self.colours: Mapping[ChannelCurve, ImVec4] = {
            curve: rgb(colours[index % len(colours)]) for index, curve in enumerate(listed)
        }
        self.top = bands.track_top + 0.5 * bands.look.em
        self.bottom = bands.track_bottom - 0.5 * bands.look.em
        gesture = project.timeline.gesture
        is_held = isinstance(gesture, (PointDrag, PointScale, TangentDrag, PointBox))
        given = self.state.gesture_ranges if is_held else self.state.ranges or {}
        # The units of selected points come first: the graph has two axes.
        first = [each.unit for each in self.curves if any(each == at.curve for at in self.chosen)]
        units = dict.fromkeys([*first, *(each.unit for each in self.curves)])
        self.ranges = {
            unit: given[unit] if unit in given else self._fitting_range(unit, index)
            for index, unit in enumerate(units)
        }

    def y(self, unit: str, number: float) -> float:
        """Return the height of a number, in pixels of the window."""
        low, high = self.ranges[unit]
        return self.bottom - (number - low) / (high - low) * (self.bottom - self.top)

    def number(self, unit: str, y: float) -> float:
        """Return the number at a height of the window."""
        low, high = self.ranges[unit]
        return low + (self.bottom - y) / (self.bottom - self.top) * (high - low)

    def place(self, mouse: ImVec2) -> GraphPlace:
        """Return the frame and the numbers of all units at a place of the window."""
        numbers = {unit: self.number(unit, mouse.y) for unit in self.ranges}
        return GraphPlace(self.bands.frame(mouse.x), numbers)

    def point_place(self, point: CurvePoint, index: int) -> ImVec2:
        """Return where a point is in the window; `index` is that of its key."""
        number = graph.height_of(self.bands.project, point.curve, index)
        x = self.bands.x_of(point.curve.channel, point.frame)
        return ImVec2(x, self.y(point.curve.unit, number))

    def axis_colour(self, unit: str) -> ImVec4:
        """Return the colour of an axis: of its curve, if there is only one."""
        own = [each for each in self.curves if each.unit == unit]
        return self.colours[own[0]] if len(own) == 1 else self.bands.look.palette.dim

    def points(self) -> list[tuple[CurvePoint, int]]:
        """Return the visible points of all curves, with the indices of their keys."""
        found = []
        for curve in self.curves:
            keys = keys_in(self.document, curve.channel)
            seen = find_visible_keys(self.bands, track_in(self.document, curve.channel), keys)
            found += [(CurvePoint(curve, keys[index].frame), index) for index in seen]
        return found

    def line(self, curve: ChannelCurve) -> tuple[Floats, Floats]:
        """Return the places of a curve in the window; the heights are NaN where it has none."""
        if curve not in self._lines:
            self._lines[curve] = self._line(curve)
        return self._lines[curve]

    def _line(self, curve: ChannelCurve) -> tuple[Floats, Floats]:
        times = self._times(curve)
        numbers = self._numbers(curve, times)
        low, high = self.ranges[curve.unit]
        heights = self.bottom - (numbers - low) / (high - low) * (self.bottom - self.top)
        scale = self.bands.time_view.scale * self.bands.look.em
        return self.bands.x(0) + times * scale, heights

    def zoomed(self, factor: float, y: float) -> dict[str, tuple[float, float]]:
        """Return the ranges of numbers scaled by a factor, fixed at a height."""
        fixed = {unit: self.number(unit, y) for unit in self.ranges}
        return {
            unit: (
                fixed[unit] + factor * (low - fixed[unit]),
                fixed[unit] + factor * (high - fixed[unit]),
            )
            for unit, (low, high) in self.ranges.items()
        }

    def panned(self, by: float) -> dict[str, tuple[float, float]]:
        """Return the ranges of numbers after a move of the curves by pixels downwards."""
        share = by / (self.bottom - self.top)
        return {
            unit: (low + share * (high - low), high + share * (high - low))
            for unit, (low, high) in self.ranges.items()
        }

    def fitted_to_points(self) -> dict[str, tuple[float, float]]:
        """Return the ranges that show the selected points, and of other units the present ones."""
        numbers: dict[str, list[float]] = {}
        for curve in self.curves:
            for index, key in enumerate(keys_in(self.document, curve.channel)):
                if CurvePoint(curve, key.frame) in self.chosen:
                    height = graph.height_of(self.bands.project, curve, index)
                    numbers.setdefault(curve.unit, []).append(height)
        return self.ranges | {
            unit: _widened(min(own), max(own), unit) for unit, own in numbers.items()
        }

    def ticks(self, unit: str) -> list[float]:
        """Return round numbers of a unit, in even distances, that lie in the visible range."""
        low, high = self.ranges[unit]
        per_label = (high - low) * LABEL_GAP * self.bands.look.em / max(self.bottom - self.top, 1.0)
        power = 10.0 ** floor(log10(per_label))
        step = next(each * power for each in (1, 2, 5, 10) if each * power >= per_label)
        return [step * count for count in range(ceil(low / step), floor(high / step) + 1)]

    def label(self, curve_or_unit: ChannelCurve | str, number: float) -> str:
        """Return a number with its unit, as a person reads it."""
        unit = curve_or_unit if isinstance(curve_or_unit, str) else curve_or_unit.unit
        return format_number(number, unit, is_speed=self.is_speed)

    def _times(self, curve: ChannelCurve) -> Floats:
        """Return the visible frames at which a curve is sampled: evenly, and around its keys."""
        bands = self.bands
        step = max(STEP / bands.time_view.scale, BESIDE)
        first = floor(bands.frame(bands.left) / step)
        last = ceil(bands.frame(bands.right) / step)
        even = step * np.arange(first, last + 1)
        keys = keys_in(self.document, curve.channel)
        indices = find_visible_keys(bands, track_in(self.document, curve.channel), keys)
        frames = (keys[index].frame for index in indices)
        seen = np.array(
            [float(display_frame(self.document, curve.channel, frame)) for frame in frames]
        )
        times = np.union1d(even, seen)
        if self.is_speed or curve.channel.kind.is_held:
            # The curve jumps at keys.
            times = np.setdiff1d(times, seen) if self.is_speed else times
            times = np.union1d(times, np.concatenate([seen - 2 * BESIDE, seen + 2 * BESIDE]))
        return times[times >= 0.0]

    def _numbers(self, curve: ChannelCurve, times: Floats) -> Floats:
        channel = curve.channel
        if not self.is_speed:
            return sample_curves(self.document, channel, tuple(times.tolist()))[curve]
        around = np.concatenate([times - BESIDE, times + BESIDE])
        found = sample_curves(self.document, channel, tuple(around.tolist()))[curve]
        before, after = np.split(found, 2)
        return (after - before) / (2 * BESIDE)

    def _fitting_range(self, unit: str, index: int) -> tuple[float, float]:
        """Return the range in which all curves of a unit lie, in all frames.

        Each further unit has a larger margin, so that extreme points lie apart.
        """
        frames = self.document.frames
        times = np.linspace(frames.first, frames.last, WHOLE)
        numbers: list[float] = []
        for curve in self.curves:
            if curve.unit == unit:
                found = self._numbers(curve, times)
                numbers += found[np.isfinite(found)].tolist()
                count = min(len(keys_in(self.document, curve.channel)), MOST_FITTED)
                numbers += [
                    graph.height_of(self.bands.project, curve, index) for index in range(count)
                ]
        ends = min(numbers, default=0.0), max(numbers, default=1.0)
        return _widened(*ends, unit, MARGIN + index * APART)


def _widened(low: float, high: float, unit: str, margin: float = MARGIN) -> tuple[float, float]:
    """Return a range with a margin; it is not too small for its unit."""
    room = max(high - low, LEAST_RANGES.get(unit, 1.0))
    middle, half = (low + high) / 2, (0.5 + margin) * room
    return middle - half, middle + half


def format_number(number: float, unit: str, *, is_speed: bool = False) -> str:
    """Return a number with its unit; speeds are per frame."""
    text = f"{round(number, 3) + 0.0:.5g}".replace("-", "−")
    whole = f"{text}{unit}" if unit in ("°", "%") else f"{text} {unit}".rstrip()
    return f"{whole} / f" if is_speed else whole

"""The person's view of the graph of channels over time."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from app.document import POSE, Channel, ChannelCurve, Document, curves_of, keys_in
from app.editor.parts.timeline.gestures import CurvePoint
from app.editor.work.revised import Revised

# Lowest and highest visible number, by unit.
NumberRanges = Mapping[str, tuple[float, float]]


@dataclass(slots=True, kw_only=True, eq=False)
class GraphState(Revised):
    """Which curves the graph shows, and the selected points of curves."""

    is_open: bool = False  # in place of the lanes
    shows_speed: bool = False  # velocities in place of values
    # The selected channel is shown alone unless it is one of these.
    graphed: tuple[Channel[Any], ...] = ()
    hidden: frozenset[ChannelCurve] = frozenset()
    # Selected points. A selected key without a point here is selected in all its curves.
    chosen_points: frozenset[CurvePoint] = frozenset()
    ranges: NumberRanges | None = None  # None fits the curves
    # Visible range during a gesture, so that nothing moves under the pointer.
    gesture_ranges: NumberRanges = field(default_factory=lambda: MappingProxyType({}))
    is_fitting: bool = False  # whether the next frame fits the selected points

    def shown_channels(self, document: Document, selected: Channel[Any]) -> list[Channel[Any]]:
        """Return the channels whose curves are shown; their keys are numbers."""
        shown = self.graphed if selected in self.graphed else (selected,)
        return [each for each in shown if keys_in(document, each) and curves_of(document, each)]

    def has_lane(self, channel: Channel[Any]) -> bool:
        """Return whether a channel has a lane of its own, with which it can be deleted."""
        return channel.kind is not POSE and not self.is_open

    def open(self, channels: tuple[Channel[Any], ...]) -> None:
        """Show the graph of some channels in place of the lanes."""
        self.is_open, self.ranges = True, None
        self.show_channels(channels)

    def close(self) -> None:
        self.is_open = False

    def show_channels(self, channels: tuple[Channel[Any], ...]) -> None:
        self.graphed, self.chosen_points = channels, frozenset()

    def toggle_speed(self) -> None:
        """Show velocities in place of values, or values again."""
        self.shows_speed, self.ranges = not self.shows_speed, None

    def hide_curves(self, curves: frozenset[ChannelCurve]) -> None:
        self.hidden = curves

    def select_points(self, points: frozenset[CurvePoint]) -> None:
        self.chosen_points = points

    def show_ranges(self, ranges: NumberRanges | None) -> None:
        self.ranges, self.is_fitting = ranges, False

    def fix_ranges(self, ranges: NumberRanges) -> None:
        """Keep the visible numbers until a gesture ends."""
        self.gesture_ranges = ranges

    def ask_fit(self) -> None:
        """Let the next frame show the selected points, or all if none is selected."""
        self.is_fitting = True

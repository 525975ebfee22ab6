"""The graph of channels over time: open it, and choose what it shows."""

from collections.abc import Iterable
from typing import Any

from app.document import (
    Channel,
    ChannelCurve,
    KeysByChannel,
    channels_in,
    curves_of,
    find_velocity,
    keys_in,
)
from app.editor.actions import editing
from app.editor.actions.action_spec import named_action, unless
from app.editor.parts.timeline.gestures import CurvePoint
from app.editor.parts.timeline.graph import NumberRanges
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.texts import _


@named_action(
    _("Graph view"),
    "E",
    icon="CHART_LINE",
    hint=_("Show the selected channels as curves, or their lanes again"),
    active=lambda session: session.project and session.project.graph.is_open,
)
@with_project
def toggle_graph(_: Session, project: Project) -> None:
    """Show the curves of the selected channels in place of the lanes, or the lanes again."""
    if project.graph.is_open:
        project.graph.close()
        return
    chosen = {project.channel, *project.selection.keys}
    channels = [each for each in listed_channels(project, chosen) if each in chosen]
    project.graph.open(tuple(channels))


@named_action(
    _("Speed graph"),
    "Shift+E",
    icon="GAUGE_HIGH",
    hint=_("Show speeds in the graph, or values again"),
    why_disabled=unless(lambda _, project: project.graph.is_open, _("Open the graph view first.")),
    active=lambda session: session.project and session.project.graph.shows_speed,
)
@with_project
def toggle_speed(_: Session, project: Project) -> None:
    project.graph.toggle_speed()


def listed_channels(
    project: Project, others: set[Channel[Any]] | None = None
) -> list[Channel[Any]]:
    """Return the channels that the graph lists: of the scene, of the active layer, and others.

    Only channels with keys that are numbers are listed, in the order of the lanes.
    """
    document, active = project.document, project.selection.active
    own = (others or set()) | {*project.graph.graphed}
    return [
        channel
        for channel in channels_in(document)
        if (channel in own or channel.layer in (None, active)) and curves_of(document, channel)
    ]


def graphed_channels(project: Project) -> list[Channel[Any]]:
    """Return the channels whose curves the graph shows."""
    return project.graph.shown_channels(project.document, project.channel)


def shown_curves(project: Project) -> list[ChannelCurve]:
    """Return the curves that the graph shows."""
    return [
        curve
        for channel in graphed_channels(project)
        for curve in curves_of(project.document, channel)
        if curve not in project.graph.hidden
    ]


def height_of(project: Project, curve: ChannelCurve, index: int) -> float:
    """Return the number at which the graph shows a key: its value, or its speed."""
    if project.graph.shows_speed:
        return find_velocity(project.document, curve, index)
    if curve.is_timing:
        return 1.0 + index
    return curve.number_at_key(project.document, keys_in(project.document, curve.channel)[index])


@with_project
def show_channel(session: Session, project: Project, channel: Channel[Any], *, adds: bool) -> None:
    """Show a channel alone, or show or hide it beside the others."""
    shown = graphed_channels(project)
    if not adds:
        shown = [channel]
    elif channel not in shown:
        shown.append(channel)
    elif len(shown) > 1:
        shown.remove(channel)
    project.graph.show_channels(tuple(shown))
    editing.deselect_keys(session)
    if project.channel not in shown:
        project.selection.select_channel(shown[-1])


@with_project
def toggle_curve(_: Session, project: Project, curve: ChannelCurve) -> None:
    """Show or hide a curve of a channel."""
    project.graph.hide_curves(project.graph.hidden ^ {curve})


@with_project
def show_ranges(_: Session, project: Project, ranges: NumberRanges | None) -> None:
    """Show ranges of numbers, by unit; None fits the curves."""
    project.graph.show_ranges(ranges)


@with_project
def select_points(session: Session, project: Project, points: frozenset[CurvePoint]) -> None:
    """Select points of curves, and with them the keys that they belong to."""
    editing.select_channel_keys(session, group_by_channel(points))
    project.graph.select_points(points)


def group_by_channel(points: Iterable[CurvePoint]) -> KeysByChannel:
    """Return the keys of points."""
    keys: dict[Channel[Any], frozenset[int]] = {}
    for point in points:
        channel = point.curve.channel
        keys[channel] = keys.get(channel, frozenset()) | {point.frame}
    return keys


def selected_points(project: Project) -> frozenset[CurvePoint]:
    """Return the selected points of the curves that the graph shows."""
    own: dict[tuple[Channel[Any], int], set[ChannelCurve]] = {}
    for point in project.graph.chosen_points:
        own.setdefault((point.curve.channel, point.frame), set()).add(point.curve)
    keys, every = project.selection.keys, frozenset(shown_curves(project))
    return frozenset(
        CurvePoint(curve, frame)
        for channel, frames in keys.items()
        for frame in frames
        for curve in own.get((channel, frame), every) & every
        if curve.channel == channel
    )

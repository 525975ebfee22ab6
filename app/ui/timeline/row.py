"""Rows of the timeline: of layers, groups, and channels."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Protocol

from app.document import (
    LAST_FRAME,
    Channel,
    Document,
    Layer,
    Track,
    TreeRow,
    channels_of,
    keys_in,
    layer_keys,
    memoized_on,
)


class HasFrame(Protocol):
    """A key, a marker or any other item at a frame."""

    @property
    def frame(self) -> int:
        pass


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LayerRow:
    """A layer's row of keys: between two heights, in pixels of the window."""

    layer: Layer
    top: float
    bottom: float
    is_active: bool
    row: TreeRow

    @property
    def middle(self) -> float:
        return (self.top + self.bottom) / 2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ChannelLane:
    """The lane of a channel's keys: between two heights, in pixels of the window."""

    channel: Channel[Any]
    layer: Layer | None  # None for a channel of the scene
    top: float
    bottom: float
    is_chosen: bool
    track: Track | None = None

    @property
    def middle(self) -> float:
        return (self.top + self.bottom) / 2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GroupRow:
    """The row of a group or a switch: between two heights, in pixels of the window."""

    row: TreeRow
    top: float
    bottom: float

    @property
    def middle(self) -> float:
        return (self.top + self.bottom) / 2


def has_lanes(layer: Layer) -> bool:
    """Return whether a layer has channels with keys besides its poses."""
    return len([*channels_of(layer)]) > 1


def find_least_gap(document: Document, channel: Channel[Any]) -> int:
    """Return the smallest distance of a channel's neighbouring keys, in frames."""
    layer = None if channel.layer is None else document.layer(channel.layer)
    if layer is None:
        return _least_gap(keys_in(document, channel))
    return _least_gap_in_layer(layer, channel)


@memoized_on
def _least_gap_in_layer(layer: Layer, channel: Channel[Any]) -> int:
    return _least_gap(layer_keys(layer, channel))


def _least_gap(keys: Sequence[HasFrame]) -> int:
    return min((later.frame - key.frame for key, later in pairwise(keys)), default=LAST_FRAME)

"""Tracks: keys of single handles."""

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Self

from app.document.channels.key import BaseKey
from app.document.checks import (
    LAST_FRAME,
    MAX_COORDINATE,
    NOTHING,
    Unknown,
    require,
    require_distinct,
    require_point,
)
from app.texts import N_, _

MAX_TRACK_ROTATION = 20 * math.tau  # radians, either direction


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackKey(BaseKey):
    """Position of a track's handles at a frame, and the segment to the next key."""

    # For a pose-space track, the displacement of the handle from the base motion, in a frame that
    # rotates with the shape. For a scene-space track, the position in the picture. Pixels.
    place: complex
    # Rotation of the shape at the handle relative to the base motion, in radians, if the track keys
    # rotation.
    turn: float = 0.0
    # Velocity through the key in pixels per frame, in the space of `place`. None derives it from
    # the neighbouring keys and the easings.
    velocity: complex | None = None

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require_point(self.place, _("A key of a track"))
        require(
            abs(self.turn) <= MAX_TRACK_ROTATION,
            N_("A track can rotate by at most {largest:g} whole turns, not {turn:g}."),
            largest=MAX_TRACK_ROTATION / math.tau,
            turn=self.turn / math.tau,
        )
        require(
            self.velocity is None or abs(self.velocity) <= MAX_COORDINATE,
            N_(
                "The velocity of a track's key can be at most {largest:,.0f} pixels a frame, "
                "not {velocity}."
            ),
            largest=MAX_COORDINATE,
            velocity=self.velocity,
        )

    def retimed(self, frame: int, pace: float) -> Self:
        """Return the key at another frame, with its velocity multiplied by `pace`."""
        velocity = None if self.velocity is None else pace * self.velocity
        return replace(self, frame=frame, velocity=velocity)

    def without_velocity(self) -> Self:
        """Return the key without a velocity of its own."""
        return self if self.velocity is None else replace(self, velocity=None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Track:
    """Keys of one handle, or of several that move together, on top of the layer's motion.

    A track acts from its first to its last key, both included.
    """

    # Handle ids. The keys belong to the first; the other handles get the same displacement.
    handles: tuple[int, ...]
    is_scene_space: bool = False  # whether keys are positions in the picture
    keys: tuple[TrackKey, ...]  # in the order of their frames, at least one
    delay: int = 0  # in frames; wraps around in a loop
    # How far the displacement spreads around the handles, from 0 (hardly) to 1 (freely).
    reach: float = 1.0
    keys_rotation: bool = False  # whether keys also rotate the shape at the handles
    enabled: bool = True
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(len(self.handles) > 0, N_("A track needs at least one handle."))
        require_distinct(
            self.handles, N_("A track lists the handle {value!r} twice; list it once.")
        )
        require(len(self.keys) > 0, N_("A track needs at least one key. Delete the track instead."))
        for before, after in pairwise(key.frame for key in self.keys):
            require(
                after != before,
                N_("A track has two keys at frame {before}; keep one of them."),
                before=before,
            )
            require(
                after > before,
                N_("The track's keys at frames {before} and {after} are out of order."),
                before=before,
                after=after,
            )
        require(
            0 <= self.delay <= LAST_FRAME,
            N_("The delay of a track must be from 0 to {largest:,} frames, not {delay:,}."),
            largest=LAST_FRAME,
            delay=self.delay,
        )
        require(
            0 <= self.reach <= 1,
            N_("The reach of a track must be from 0 to 1, not {reach:g}."),
            reach=self.reach,
        )

    @property
    def key_frames(self) -> frozenset[int]:
        """The frames of the keys, without the delay."""
        return frozenset(key.frame for key in self.keys)

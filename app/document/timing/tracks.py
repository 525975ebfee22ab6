"""Tracks: keys of single handles, beside those of whole poses."""

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Self

from app.document.checks import (
    LAST_FRAME,
    MAX_COORDINATE,
    NOTHING,
    Unknown,
    require,
    require_distinct,
    require_point,
)
from app.document.timing.base_key import BaseKey

MAX_TRACK_ROTATION = 20 * math.tau  # either way


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackKey(BaseKey):
    """Where a track wants its handles at a frame, and the way from there to its next key."""

    # Of a track with the pose, by how much the handle is beside its place in the base motion, in
    # the frame that turns with the shape there; of a planted one, its place in the picture. Pixels.
    place: complex
    # By how much the shape turns there beyond the base motion, in radians; where the track turns.
    turn: float = 0.0
    # With which the motion passes it where it goes through, in pixels a frame, as the place is
    # told; None for what its neighbours and the easings make of it.
    velocity: complex | None = None

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require_point(self.place, "A track's key")
        require(
            abs(self.turn) <= MAX_TRACK_ROTATION,
            f"A track turns by at most {MAX_TRACK_ROTATION / math.tau:g} whole turns, not by "
            f"{self.turn / math.tau:g}.",
        )
        require(
            self.velocity is None or abs(self.velocity) <= MAX_COORDINATE,
            f"A track passes a key at no more than {MAX_COORDINATE:,.0f} pixels a frame, not at "
            f"{self.velocity}.",
        )

    def retimed(self, frame: int, pace: float) -> Self:
        """Return the key at another frame of a motion that runs so many times as fast."""
        velocity = None if self.velocity is None else pace * self.velocity
        return replace(self, frame=frame, velocity=velocity)

    def without_velocity(self) -> Self:
        """Return the key passed as its neighbours and the easings have it."""
        return self if self.velocity is None else replace(self, velocity=None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Track:
    """A clock of one handle's own, or of some that move together, over the layer's motion.

    It acts from its first key to its last one, both included, and nowhere else.
    """

    # The ids of its handles. Its keys are of the first one; the others are moved by as much.
    handles: tuple[int, ...]
    is_scene_space: bool = (
        False  # whether its keys are places in the picture, and not beside the pose
    )
    keys: tuple[TrackKey, ...]  # in the order of their frames; there is always one
    delay: int = 0  # frames by which it is late; in a loop it comes round
    # How far around its handles the body gives, from 0, hardly, to 1, as it likes.
    reach: float = 1.0
    keys_rotation: bool = False  # whether its keys turn the shape at the handles, too
    enabled: bool = True
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(len(self.handles) > 0, "A track is of at least one handle.")
        require_distinct(self.handles, "A track has the handle {!r} twice.")
        require(len(self.keys) > 0, "A track has at least one key; remove the track instead.")
        for before, after in pairwise(key.frame for key in self.keys):
            require(after != before, f"A track has two keys at frame {before}.")
            require(after > before, f"A track's keys at frames {before} and {after} are mixed up.")
        require(
            0 <= self.delay <= LAST_FRAME,
            f"The delay of a track is from 0 to {LAST_FRAME:,} frames, not {self.delay:,}.",
        )
        require(
            0 <= self.reach <= 1, f"The reach of a track is between 0 and 1, not {self.reach:g}."
        )

    @property
    def key_frames(self) -> frozenset[int]:
        """The frames that have a key, without the delay."""
        return frozenset(key.frame for key in self.keys)

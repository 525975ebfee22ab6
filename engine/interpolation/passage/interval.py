"""All that the in-betweens of two neighbouring keyframes are made of, but for their variant."""

from typing import NamedTuple

from engine.dirichlet import Extension
from engine.interpolation.passage.derivatives import Passage
from engine.interpolation.sites import Sites
from engine.maps import Bounds


class Interval(NamedTuple):
    """Two keyframes at the sites, and how the motion leads from one to the other.

    What it has is shared, not copied: sites by all keyframes, keyframes by the intervals on both
    sides.

    Parameters
    ----------
    sites : Sites
    passage : Passage
        The keyframes, with those around them that the course weighs.
    bounds : Bounds
        That metric and a scaled variant obey along courses that are not straight; else they obey
        their keyframes' own.
    transform : Extension or None
        Of the sites' outline, at the nodes of their paths; variants that `needs_transform` says so
        of need it.
    """

    sites: Sites
    passage: Passage
    bounds: Bounds
    transform: Extension | None = None

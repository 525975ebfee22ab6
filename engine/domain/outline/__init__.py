"""From a mask to its outline, a polygon of few edges, and the cage around it.

In: the mask of a subject in its picture.
Out: an `Enclosure`: an outline and a cage of as many vertices, strictly apart.
Imports: `engine.domain.picture`, `engine.geometry`.
"""

from engine.domain.outline.enclosure import LARGEST_OUTLINE, Detail, Enclosure, enclose
from engine.domain.outline.holes import HoleMap, find_holes

__all__ = ["LARGEST_OUTLINE", "Detail", "Enclosure", "HoleMap", "enclose", "find_holes"]

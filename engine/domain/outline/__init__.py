"""From a mask to its outline, a polygon of few edges, and the cage around it.

In: the mask of a subject in its working grid.
Out: an outline and a cage of as many vertices, strictly apart.
Imports: `engine.domain.picture`, `engine.geometry`.
"""

from engine.domain.outline.tracing import Detail, trace_outline

__all__ = ["Detail", "trace_outline"]

"""From a mask to its outline, a polygon of few edges, and the cage around it.

In: the mask of a subject in its picture.
Out: an `Enclosure`: an outline and a cage of as many vertices, strictly apart.
Imports: `engine.domain.mask`, `engine.geometry`.
"""

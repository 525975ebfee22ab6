"""The search for the minimum: from certified map to certified map.

In: an objective, a certified map, and a starting point.
Out: a search that is advanced step by step, its optimality measure, and the active bounds.
Imports: `engine.maps`, and the energy, barrier, handles and Newton models of `engine.deform`.
"""

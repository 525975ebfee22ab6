"""The objective of a step: energy, barrier and handles, and its Newton models.

In: a boundary, handles, targets, barrier bounds, and the evaluation of a map.
Out: values, gradients, Hessians, directions, and where the barrier stands; inner distortion bounds
from boundary limits.
Imports: `engine.dirichlet`, `engine.maps`, and the handles of `engine.deform`.
"""

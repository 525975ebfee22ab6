"""Poses of sliders, added to in-betweens by weights of any sign within the limits of distortion.

In: poses of a domain, the Hilbert transform of its outline, limits; an in-between, and weights.
Out: frames within the limits.
Imports: `engine.interpolation`, `engine.deform.correction`, `engine.dirichlet`, `engine.maps`.
"""

from engine.sliders.frame_solver import (
    FrameSolution as FrameSolution,
    FrameSolver as FrameSolver,
)
from engine.sliders.slider_poses import SliderFrame as SliderFrame, SliderPoses as SliderPoses

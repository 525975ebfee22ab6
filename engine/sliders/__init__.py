"""Poses of a slider, blended by weights of any sign within the limits of the distortion.

In: poses of a sampled domain, the Hilbert transform of its outline, limits; weights that sum to 1.
Out: frames within the limits; motions whose weights depend on time, for series.
Imports: `engine.interpolation`, `engine.deform.correction`, `engine.dirichlet`, `engine.maps`.
"""

from engine.sliders.motion import SliderMotion as SliderMotion
from engine.sliders.pose_blend import PoseBlend as PoseBlend, PoseFrame as PoseFrame

"""The Dirichlet problem on a polygon and its harmonic conjugate (Section 7.4).

In: an outline, and real functions on it.
Out: holomorphic functions with these real parts, at any points inside.
Imports: `engine.maps`, `engine.geometry`.
"""

from engine.dirichlet.hilbert import Extension as Extension, HilbertTransform as HilbertTransform
from engine.dirichlet.refinement import Densities as Densities, Refinement as Refinement

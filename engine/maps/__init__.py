"""Harmonic maps over a cage, their distortion, and its proof.

In: a cage, holes, coefficients of Φ and Ψ, points, bounds.
Out: values and derivatives, k, σ_a, σ_b, τ, and certificates.
Imports: `engine.geometry`.
"""

from engine.maps import distortion as distortion
from engine.maps.boundary import Boundary as Boundary
from engine.maps.bounds import Bounds as Bounds, LocalBounds as LocalBounds
from engine.maps.cauchy import (
    cauchy_coordinates as cauchy_coordinates,
    cauchy_derivatives as cauchy_derivatives,
    evaluate as evaluate,
)
from engine.maps.certificate import (
    ROUNDING as ROUNDING,
    Certificate as Certificate,
    Enclosures as Enclosures,
    certify as certify,
    certify_segments as certify_segments,
    segment_enclosures as segment_enclosures,
)
from engine.maps.harmonic_map import HarmonicMap as HarmonicMap, derivatives_of as derivatives_of
from engine.maps.span import Span as Span
from engine.maps.stiffness import (
    SOFTEST as SOFTEST,
    STIFFEST as STIFFEST,
    require_stiffness as require_stiffness,
    stiffness_along_loops as stiffness_along_loops,
)

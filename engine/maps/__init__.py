"""Harmonic maps over a cage, how far they distort, and the proof of it.

In: a cage, holes, coefficients of Φ and Ψ, points, bounds.
Out: values and derivatives, k, σ_a, σ_b, τ, and certificates.
Imports: `engine.geometry`.
"""

from engine.maps import distortion
from engine.maps.boundary import Boundary
from engine.maps.bounds import Bounds, Limits
from engine.maps.cauchy import cauchy_coordinates, cauchy_derivatives, evaluate
from engine.maps.certificate import (
    Certificate,
    Enclosures,
    certify,
    certify_segments,
    segment_enclosures,
)
from engine.maps.harmonic_map import HarmonicMap, derivatives_of
from engine.maps.span import Span

__all__ = [
    "Boundary",
    "Bounds",
    "Certificate",
    "Enclosures",
    "HarmonicMap",
    "Limits",
    "Span",
    "cauchy_coordinates",
    "cauchy_derivatives",
    "certify",
    "certify_segments",
    "derivatives_of",
    "distortion",
    "evaluate",
    "segment_enclosures",
]

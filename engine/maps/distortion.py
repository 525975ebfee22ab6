"""Local distortion of a map, from its Wirtinger derivatives f_z and f_z̄ (Section 3.4).

All functions take complex128 arrays of one shape and work entry by entry. The map is locally
injective and keeps the orientation where |f_z| > |f_z̄|; there k < 1 and sigma_b > 0. With F = f_z
and G = conj(f_z̄), both holomorphic, ν = G / F is holomorphic and η is the conjugate of F·G.
"""

import numpy as np

from engine.arrays import Complexes, Floats


def mu(fz: Complexes, fzbar: Complexes) -> Complexes:
    """First complex dilatation μ = f_z̄ / f_z; half its argument is the stretch direction.

    Departs from the paper: Section 4 prints the denominator with a superscript 0 instead of t.
    """
    return fzbar / fz


def nu(fz: Complexes, fzbar: Complexes) -> Complexes:
    """Second complex dilatation ν = conj(f_z̄) / f_z, holomorphic for a harmonic map.

    Departs from the paper: Section 5.2 lost the bar over the numerator.
    """
    return fzbar.conj() / fz


def eta(fz: Complexes, fzbar: Complexes) -> Complexes:
    """η = f_z̄ conj(f_z) = μ |f_z|², anti-holomorphic for a harmonic map (Section 5.4).

    Departs from the paper: Section 5.4 lost the bar over the second factor.
    """
    return fzbar * fz.conj()


def k(fz: Complexes, fzbar: Complexes) -> Floats:
    """Little dilatation k = |f_z̄| / |f_z| = |μ| = |ν|, the conformal distortion."""
    return np.abs(fzbar) / np.abs(fz)


def K(fz: Complexes, fzbar: Complexes) -> Floats:  # noqa: N802 - the field writes it so
    """Large dilatation K = sigma_a / sigma_b = (1 + k) / (1 − k)."""
    return sigma_a(fz, fzbar) / sigma_b(fz, fzbar)


def sigma_a(fz: Complexes, fzbar: Complexes) -> Floats:
    """Larger singular value of the Jacobian, |f_z| + |f_z̄|."""
    return np.abs(fz) + np.abs(fzbar)


def sigma_b(fz: Complexes, fzbar: Complexes) -> Floats:
    """Smaller singular value |f_z| − |f_z̄|, signed: negative where the orientation is reversed."""
    return np.abs(fz) - np.abs(fzbar)


def tau(fz: Complexes, fzbar: Complexes) -> Floats:
    """Isometric distortion τ = max(sigma_a, 1 / sigma_b) of Section 8, for sigma_b > 0."""
    return np.maximum(sigma_a(fz, fzbar), 1.0 / sigma_b(fz, fzbar))

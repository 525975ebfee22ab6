"""Exact integrals of polynomials against the Cauchy kernel on one panel.

On a panel ζ(τ) = o + e τ^q the kernel dζ/(ζ − z) is q τ^(q−1) dτ / (τ^q − w) with w = (z − o)/e,
which is Σ dτ/(τ − r) over the q roots r of w. Each panel therefore costs q integrals over [0, 1],
for z far from the panel, near it or on it (Helsing and Ojala 2008, here for graded panels). With
Legendre polynomials P_k and x = 2τ − 1 they are q_k(x) = ∫ P_k(s) / (s − x) ds, which obey the
three-term recurrence of the Legendre functions.
"""

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.dirichlet.panels import NODES, gauss_legendre, legendre_matrices

# Bernstein ellipse beyond which Gauss-Legendre quadrature is exact to 1e-12: its error falls like
# SEPARATION^(-2 NODES). Within it the recurrence is used; its rounding grows like SEPARATION^NODES.
SEPARATION = 3.0


def is_near(w: Complexes, power: int) -> Booleans:
    """Return where plain quadrature on a panel of this power is not accurate enough."""
    return _ellipse(w if power == 1 else w ** (1.0 / power)) < SEPARATION


def panel_weights(w: Complexes, power: int) -> tuple[Complexes, Complexes]:
    """Return the weights of the Cauchy integrals of a density and of its derivative.

    Parameters
    ----------
    w : complex128, shape (t,)
        (z − origin) / span, not 0. On the panel itself, the sign of the imaginary part gives the
        side.

    Returns
    -------
    weights, derivative_weights : complex128, shape (t, NODES)
        For values of μ at the panel's nodes: of ∫ μ dζ / (ζ − z), and of ∫ (dμ/dζ) dζ / (ζ − z)
        times the span.
    """
    weights = np.zeros((len(w), NODES), dtype=np.complex128)
    derivative_weights = np.zeros_like(weights)
    for root in _roots(w, power):
        each = _root_weights(root)
        weights += each
        # dτ / (τ^q − w) is Σ dτ / (q r^(q−1) (τ − r)).
        derivative_weights += each / (power * root ** (power - 1))[:, None]
    _, differentiation = legendre_matrices()
    return weights, derivative_weights @ differentiation


def _roots(w: Complexes, power: int) -> list[Complexes]:
    if power == 1:
        return [w]
    principal = w ** (1.0 / power)
    return [principal * np.exp(2j * np.pi * k / power) for k in range(power)]


def _ellipse(root: Complexes) -> Floats:
    """Return the parameter of the Bernstein ellipse of [0, 1] through each point."""
    x = 2 * root - 1
    # The sum of the distances from the foci is 2 × the larger half axis (ρ + 1/ρ) / 2.
    axis = (np.abs(x - 1) + np.abs(x + 1)) / 2
    result: Floats = axis + np.sqrt(np.maximum(axis * axis - 1, 0.0))
    return result


def _root_weights(root: Complexes) -> Complexes:
    """Return the weights of ∫ μ dτ / (τ − r) over [0, 1]."""
    tau, own = gauss_legendre()
    to_legendre, _ = legendre_matrices()
    weights = own / (tau - root[:, None])
    near = np.flatnonzero(_ellipse(root) < SEPARATION)
    weights[near] = _legendre_integrals(2 * root[near] - 1) @ to_legendre
    return weights


def _legendre_integrals(x: Complexes) -> Complexes:
    """Return q_k(x) for k < NODES, (t, NODES)."""
    q = np.empty((len(x), NODES), dtype=np.complex128)
    q[:, 0] = np.log((x - 1) / (x + 1))
    q[:, 1] = x * q[:, 0] + 2
    for k in range(1, NODES - 1):
        q[:, k + 1] = ((2 * k + 1) * x * q[:, k] - k * q[:, k - 1]) / (k + 1)
    return q


def near_distance(power: Indices) -> Floats:
    """Return from which distance, over a panel's length, plain quadrature is accurate."""
    angle = np.linspace(0.0, np.pi, 200)
    x = (SEPARATION * np.exp(1j * angle) + np.exp(-1j * angle) / SEPARATION) / 2
    root = (1 + x) / 2
    farthest = {}
    for q in np.unique(power):
        w = root[np.angle(root) <= np.pi / q] ** q
        farthest[q] = np.abs(w - np.clip(w.real, 0.0, 1.0)).max()
    return np.array([farthest[q] for q in power])

"""The paper's four variants as printed, slow and in its order: read this file first.

Two keyframes over one cage, a domain without holes, straight paths from the anchor, sums instead of
integrals. `engine.interpolation` computes the same much faster, around holes, through many
keyframes and with proofs. Tests compare it with this.

Departs from the paper: its text lost bars in Equations (5), (7), (8), (13) and (16) to (18), which
are put back, and Section 7.4 solves the Dirichlet problem in the span of the cage's coordinates.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.errors import EngineError
from engine.maps import HarmonicMap, distortion
from engine.variant import Variant

STEPS = 400  # of a path
NODES, GRADING = 48, 4  # on an edge of the outline, and how strongly they crowd at its ends


class ReferenceFrame(NamedTuple):
    """An in-between at points (n,): f, f_z and f_z̄, complex128."""

    positions: Complexes
    fz: Complexes
    fzbar: Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reference:
    """In-betweens f^t of two keyframes.

    Parameters
    ----------
    first, second : HarmonicMap
        f⁰ and f¹.
    outline : complex128, shape (p,)
        The domain's boundary: simple, counter-clockwise.
    anchor : complex
        v_0, from which every point must be seen.
    """

    first: HarmonicMap
    second: HarmonicMap
    outline: Complexes
    anchor: complex

    def frame(self, variant: Variant, points: Complexes, t: float) -> ReferenceFrame:
        """Return the in-between at points (n,) inside the outline, not near it, at t in [0, 1]."""
        z = self.anchor + (points[:, None] - self.anchor) * np.linspace(0.0, 1.0, STEPS + 1)
        fz, fzbar = self.derivatives(variant, z, t)
        v0 = z[:1, 0]
        start = (1 - t) * self.first(v0) + t * self.second(v0)  # Section 7: Φ(v_0), Ψ(v_0) = 0
        phi, psi = start + integral(fz, z), integral(fzbar.conj(), z)
        return ReferenceFrame(phi + psi.conj(), fz[:, -1], fzbar[:, -1])  # Equation (1)

    def derivatives(self, variant: Variant, z: Complexes, t: float) -> tuple[Complexes, Complexes]:
        """Return f_z^t and f_z̄^t on paths (n, s) from the anchor."""
        fz0, fzbar0, fz1, fzbar1 = self._keyframes(z)
        if variant == Variant.METRIC:
            fz = self._metric_fz(fz0, fz1, z, t)
        else:
            log_fz0, log_fz1 = logarithms(fz0, fz1)
            fz = np.exp((1 - t) * log_fz0 + t * log_fz1)  # Equation (3)
        if variant == Variant.NU:
            nu0, nu1 = distortion.nu(fz0, fzbar0), distortion.nu(fz1, fzbar1)
            nu = (1 - t) * nu0 + t * nu1  # Equation (4)
            return fz, nu.conj() * fz.conj()  # Equation (5)
        eta0, eta1 = distortion.eta(fz0, fzbar0), distortion.eta(fz1, fzbar1)
        eta = (1 - t) * eta0 + t * eta1  # Equation (6)
        if variant == Variant.SCALED_ETA:
            return fz, self.rho(t) * eta / fz.conj()  # Equation (8)
        if variant in (Variant.ETA, Variant.METRIC):
            return fz, eta / fz.conj()  # Equation (7)
        raise EngineError(
            "The paper has no variant {variant!r}; choose one of the paper's variants.",
            variant=variant,
        )

    def rho(self, t: float) -> float:
        """Return ρ(t), the largest that all nodes of the outline allow (Section 7.3)."""
        return float(self.allowed(nodes(self.outline)[0], t).min(initial=1.0))

    def allowed(self, w: Complexes, t: float) -> Floats:
        """Return the largest ρ within the bounds of each point (p,), infinite where f_z̄^t is 0."""
        fz0, fzbar0, fz1, fzbar1 = self._keyframes(w)
        ends = (fz0, fzbar0), (fz1, fzbar1)
        fz = np.abs(fz0) ** (1 - t) * np.abs(fz1) ** t
        eta0, eta1 = (distortion.eta(*each) for each in ends)
        fzbar = np.abs((1 - t) * eta0 + t * eta1) / fz
        most_k = np.maximum(*(distortion.k(*each) for each in ends))
        most_a = np.maximum(*(distortion.sigma_a(*each) for each in ends))
        least_b = np.minimum(*(distortion.sigma_b(*each) for each in ends))
        with np.errstate(divide="ignore", invalid="ignore"):
            rho_k = most_k / (fzbar / fz)  # Equation (16)
            rho_a = (most_a - fz) / fzbar  # Equation (17)
            rho_b = (fz - least_b) / fzbar  # Equation (18)
        rho = np.minimum(rho_k, np.minimum(rho_a, rho_b))
        return np.where(fzbar > 0, rho, np.inf)

    def _metric_fz(self, fz0: Complexes, fz1: Complexes, z: Complexes, t: float) -> Complexes:
        """Return f_z^t of the metric variant on paths from the anchor (Section 6.2)."""
        w, dw = nodes(self.outline)
        log_fz = extension(w, dw, np.log(self.metric_modulus(w, t)), z)
        log_fz0, log_fz1 = logarithms(fz0[:, :1], fz1[:, :1])
        angle = (1 - t) * log_fz0.imag + t * log_fz1.imag
        return np.asarray(np.exp(log_fz + 1j * (angle - log_fz[:, :1].imag)))  # constant C

    def metric_modulus(self, w: Complexes, t: float) -> Floats:
        """Return |f_z^t| on the outline, where the metric tensor is blended linearly."""
        fz0, fzbar0, fz1, fzbar1 = self._keyframes(w)
        # Equation (9): the metric tensor is 𝒜 I + 2 [[Re η, Im η], [Im η, −Re η]].
        a0, a1 = np.abs(fz0) ** 2 + np.abs(fzbar0) ** 2, np.abs(fz1) ** 2 + np.abs(fzbar1) ** 2
        eta0, eta1 = distortion.eta(fz0, fzbar0), distortion.eta(fz1, fzbar1)
        a, eta = (1 - t) * a0 + t * a1, (1 - t) * eta0 + t * eta1
        # Equation (10): σ_a² = 𝒜 + 2 |η|. Equation (11): σ_b² = 𝒜 − 2 |η|.
        # Equation (12): K² = σ_a² / σ_b².
        squared = (a + np.sqrt(a**2 - 4 * np.abs(eta) ** 2)) / 2  # Equation (13)
        return np.asarray(np.sqrt(squared))

    def _keyframes(self, z: Complexes) -> tuple[Complexes, ...]:
        """Return f_z⁰, f_z̄⁰, f_z¹ and f_z̄¹: the C_j' of Equation (14) times φ and ψ."""
        both = (*self.first.derivatives(z.ravel()), *self.second.derivatives(z.ravel()))
        return tuple(each.reshape(z.shape) for each in both)


def logarithms(fz0: Complexes, fz1: Complexes) -> tuple[Complexes, Complexes]:
    """Return continuous log f_z⁰ and log f_z¹ on paths (n, s), with the roots of Section 7.2."""
    root0 = np.log(fz0[:, :1])
    root1 = np.log(fz1[:, :1] / fz0[:, :1]) + root0
    steps0, steps1 = (np.log(fz[:, 1:] / fz[:, :-1]) for fz in (fz0, fz1))  # Equation (15)
    first, second = np.hstack([root0, steps0]), np.hstack([root1, steps1])
    return np.cumsum(first, axis=1), np.cumsum(second, axis=1)  # Equation (2)


def integral(values: Complexes, z: Complexes) -> Complexes:
    """Return the integrals (n,) along paths (n, s) by the trapezoidal rule of Section 7."""
    return np.asarray(((values[:, 1:] + values[:, :-1]) / 2 * np.diff(z)).sum(axis=1))


def nodes(outline: Complexes) -> tuple[Complexes, Complexes]:
    """Return points on an outline and dw of each, crowded at its vertices."""
    x = (np.arange(NODES) + 0.5) / NODES
    rise, fall = x**GRADING, (1 - x) ** GRADING
    slope = GRADING * (x * (1 - x)) ** (GRADING - 1) / (rise + fall) ** 2
    sides = (np.roll(outline, -1) - outline)[:, None]
    w = outline[:, None] + sides * rise / (rise + fall)
    return w.ravel(), (sides * slope / NODES).ravel()


def extension(w: Complexes, dw: Complexes, real_part: Floats, z: Complexes) -> Complexes:
    """Return at points inside the holomorphic function with this real part on the outline.

    Its Cauchy integral has a real density μ, with μ/2 + 1/(2π) ∮ μ Im(dw / (w − z)) = Re there.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        kernel = (dw / (w - w[:, None])).imag / (2 * np.pi)
    np.fill_diagonal(kernel, 0.0)
    np.fill_diagonal(kernel, 1.0 - kernel.sum(axis=1))  # of μ = 1 the integral is exact
    mu = np.linalg.solve(kernel, real_part)
    cauchy = (dw / (w - row[:, None]) for row in z)
    return np.array([each @ mu / each.sum(axis=1) for each in cauchy])

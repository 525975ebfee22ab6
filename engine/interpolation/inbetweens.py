"""In-betweens of some keyframes by one variant, as functions of the weights."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np

from engine.arrays import Complexes, Floats, readonly
from engine.interpolation.derivatives import Derivatives, weighted
from engine.interpolation.keyframe_samples import KeyframeSamples
from engine.interpolation.sites import Sites


class Blend(Protocol):
    """A variant: how the derivatives of an in-between follow from the weights."""

    @property
    def nbytes(self) -> int:
        """Memory beyond the keyframes' own, in bytes."""

    def derivatives(self, weights: Floats) -> Derivatives:
        """Return the in-between's derivatives at the nodes of the paths."""


class Scale(Protocol):
    """A scaling ρ of Ψ."""

    @property
    def nbytes(self) -> int:
        """Memory beyond the keyframes' own, in bytes."""

    def __call__(self, weights: Floats) -> float:
        """Return ρ, between 0 and 1."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frame:
    """An in-between at the points.

    Parameters
    ----------
    positions, fz, fzbar : complex128, shape (m,)
        f, f_z and the true derivative f_z̄ = ∂f/∂z̄.
    rho : float or None
        The scaling of η where the variant has one.
    """

    positions: Complexes
    fz: Complexes
    fzbar: Complexes
    rho: float | None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class IntegratedInbetweens:
    """In-betweens by blended derivatives, integrated along the paths (Sections 4.1 and 7).

    All of it is frozen: calls are pure, and may run on several threads at once.

    Parameters
    ----------
    sites : Sites
    keyframes : tuple of KeyframeSamples, length q
    blend : Blend
    scale : Scale or None
        None where Ψ is not scaled.
    """

    sites: Sites
    keyframes: tuple[KeyframeSamples, ...]
    blend: Blend
    scale: Scale | None

    @property
    def nbytes(self) -> int:
        """Memory beyond the sites' and the keyframes' own, in bytes."""
        return self.blend.nbytes + (0 if self.scale is None else self.scale.nbytes)

    def rho(self, weights: Floats) -> float:
        """Return ρ for the weights (q,); 1 where Ψ is not scaled."""
        return 1.0 if self.scale is None else self.scale(weights)

    def parts(self, weights: Floats) -> tuple[Complexes, Complexes]:
        """Return Φ and conj(Ψ), each (m,), both 0 at the anchor and Ψ before its scaling.

        f is the anchor's position + Φ + ρ conj(Ψ). Without ρ both parts are analytic in the
        weights, which f is not where ρ has a kink.
        """
        # What the quadrature lacks of the keyframes is known, and blended like them: the keyframes
        # come out exactly, without a jump in time.
        blended = self.blend.derivatives(weights)
        paths = self.sites.paths
        phi = paths.integrals(paths.step_integrals(blended.fz, blended.fz_slope))
        phi += weighted([key.phi_error for key in self.keyframes], weights)
        psi = paths.integrals(paths.step_integrals(blended.g, blended.g_slope))
        psi += weighted([key.psi_error for key in self.keyframes], weights)
        return phi, psi.conj()

    def offsets(self, weights: Floats) -> Complexes:
        """Return f − f(anchor) at the points, (m,)."""
        return self._offsets(self.blend.derivatives(weights), weights, self.rho(weights))

    def anchor_position(self, weights: Floats) -> complex:
        """Return the blended position of the anchor."""
        return complex(weights @ [key.anchor_position for key in self.keyframes])

    def frame(self, weights: Floats, *, anchor_position: complex | None = None) -> Frame:
        """Return the in-between for the weights (q,), by default with the anchor's own blended."""
        blended = self.blend.derivatives(weights)
        rho = self.rho(weights)
        if anchor_position is None:
            anchor_position = self.anchor_position(weights)
        places = self.sites.paths.places
        return Frame(
            positions=anchor_position + self._offsets(blended, weights, rho),
            fz=blended.fz[places],
            fzbar=rho * blended.g[places].conj(),
            rho=None if self.scale is None else rho,
        )

    def _offsets(self, blended: Derivatives, weights: Floats, rho: float) -> Complexes:
        """Return what `parts` gives, added up; one sum along the paths serves both."""
        paths = self.sites.paths
        steps = paths.step_integrals(blended.fz, blended.fz_slope)
        conj_psi = paths.step_integrals(blended.g, blended.g_slope)
        np.conj(conj_psi, out=conj_psi)
        conj_psi *= rho
        steps += conj_psi
        errors = weighted([key.psi_error for key in self.keyframes], weights)
        np.conj(errors, out=errors)
        errors *= rho
        errors += weighted([key.phi_error for key in self.keyframes], weights)
        errors += paths.integrals(steps)
        return errors


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearInbetweens:
    """The maps themselves, blended linearly: for comparison, without any guarantee.

    Parameters
    ----------
    keyframes : tuple of KeyframeSamples, length q
    fz, fzbar : tuple of complex128, shape (m,)
        Derivatives of each keyframe at the points.
    """

    keyframes: tuple[KeyframeSamples, ...]
    fz: tuple[Complexes, ...]
    fzbar: tuple[Complexes, ...]

    @classmethod
    def of(cls, keyframes: Sequence[KeyframeSamples], sites: Sites) -> Self:
        """Work out the derivatives of the keyframes at the points."""
        places = sites.paths.places
        fz = [np.exp(key.log_fz[places]) for key in keyframes]
        g = [key.nu[places] * a for key, a in zip(keyframes, fz, strict=True)]
        return cls(
            keyframes=tuple(keyframes),
            fz=tuple(map(readonly, fz)),
            fzbar=tuple(readonly(b.conj()) for b in g),
        )

    @property
    def nbytes(self) -> int:
        """Memory beyond the sites' and the keyframes' own, in bytes."""
        return sum(array.nbytes for array in (*self.fz, *self.fzbar))

    def offsets(self, weights: Floats) -> Complexes:
        """Return f − f(anchor) at the points, (m,)."""
        positions = weighted([key.positions for key in self.keyframes], weights)
        return positions - self.anchor_position(weights)

    def anchor_position(self, weights: Floats) -> complex:
        """Return the blended position of the anchor."""
        return complex(weights @ [key.anchor_position for key in self.keyframes])

    def frame(self, weights: Floats, *, anchor_position: complex | None = None) -> Frame:
        """Return the in-between for the weights (q,), by default with the anchor's own blended."""
        positions = weighted([key.positions for key in self.keyframes], weights)
        if anchor_position is not None:
            positions += anchor_position - self.anchor_position(weights)
        return Frame(
            positions=positions,
            fz=weighted(self.fz, weights),
            fzbar=weighted(self.fzbar, weights),
            rho=None,
        )


Inbetweens = IntegratedInbetweens | LinearInbetweens

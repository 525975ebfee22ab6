"""In-betweens of two keyframes by one variant, as functions of time from one to the other."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.interpolation.blends import MetricResidual
from engine.interpolation.derivatives import Derivatives, Passage, weighted
from engine.interpolation.periods import Closing, Residual, combined
from engine.interpolation.scaling import Scaling
from engine.interpolation.sites import Sites


class Blend(Protocol):
    """A variant: how the derivatives of an in-between follow from the keyframes and the time."""

    @property
    def nbytes(self) -> int:
        """Memory beyond the keyframes' own, in bytes."""

    def values(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return f_z and conj(f_z̄) at times (t,) and the nodes of the paths, each (t, s)."""

    def derivatives(self, time: float) -> Derivatives:
        """Return the in-between's derivatives at the nodes of the paths."""

    def at(self, which: Indices) -> Self:
        """Return the same at some of the nodes only."""


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
    """In-betweens by blended derivatives, integrated along the paths.

    Section 4.1: f^t = Φ^t + conj(Ψ^t) is harmonic, whatever holomorphic Φ'^t = f_z^t and
    Ψ'^t = conj(f_z̄^t) are blended; Section 7 integrates both from the anchor.

    All of it is frozen: calls are pure, and may run on several threads at once.

    Parameters
    ----------
    sites : Sites
    passage : Passage
    blend : Blend
    scale : Scaling or None
        None where Ψ is not scaled.
    metric : MetricResidual or None
        Of the metric variant.
    closings : tuple of Closing
        Of h, which closes the periods around holes, and where Ψ is scaled of d
        (`engine.interpolation.scaling`); none without holes.
    """

    sites: Sites
    passage: Passage
    blend: Blend
    scale: Scaling | None
    metric: MetricResidual | None = None
    closings: tuple[Closing, ...] = ()

    @property
    def correction(self) -> float:
        """The largest |h| that closes the periods around holes; 0 where there are none."""
        return self.closings[0].largest if self.closings else 0.0

    @property
    def opening(self) -> Residual | None:
        """What d is at the nodes, around holes where Ψ is scaled."""
        return self.closings[1].residual if len(self.closings) > 1 else None

    @property
    def nbytes(self) -> int:
        """Memory beyond the sites' and the keyframes' own, in bytes."""
        return (
            self.passage.nbytes
            + self.blend.nbytes
            + (0 if self.scale is None else self.scale.nbytes)
        )

    def rho(self, time: float) -> float:
        """Return ρ; 1 where Ψ is not scaled."""
        return 1.0 if self.scale is None else self.scale(time)

    def derivatives_at(self, which: Indices) -> "PointDerivatives":
        """Return f_z and f_z̄ of some of the points as functions of times."""
        nodes = self.sites.paths.places[which]
        return PointDerivatives(
            blend=self.blend.at(nodes),
            scale=self.scale,
            opening=None if self.opening is None else self.opening.at(nodes),
        )

    def offsets(self, time: float) -> Complexes:
        """Return f − f(anchor) at the points, (m,)."""
        rho = self.rho(time)
        return self._offsets(_blended(self.blend, self.opening, time, rho), time, rho)

    def frame(self, time: float) -> Frame:
        """Return the in-between at a time in [0, 1]."""
        rho = self.rho(time)
        blended = _blended(self.blend, self.opening, time, rho)
        places = self.sites.paths.places
        return Frame(
            positions=self.passage.anchor_position(time) + self._offsets(blended, time, rho),
            fz=blended.fz[places],
            fzbar=rho * blended.g[places].conj(),
            rho=None if self.scale is None else rho,
        )

    def _offsets(self, blended: Derivatives, time: float, rho: float) -> Complexes:
        """Return Φ + ρ conj(Ψ), both 0 at the anchor; one sum along the paths serves both."""
        keyframes, weights = self.passage.keyframes, self.passage.course(time)
        paths = self.sites.paths
        steps = paths.step_integrals(blended.fz, blended.fzz)
        conj_psi = paths.step_integrals(blended.g, blended.gz)
        np.conj(conj_psi, out=conj_psi)
        conj_psi *= rho
        steps += conj_psi
        # What the quadrature lacks of the keyframes is known, and blended like them: the keyframes
        # come out exactly, without a jump in time.
        errors = weighted([key.psi_error for key in keyframes], weights)
        np.conj(errors, out=errors)
        errors *= rho
        errors += weighted([key.phi_error for key in keyframes], weights)
        errors += paths.integrals(steps)
        return errors


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointDerivatives:
    """f_z and f_z̄ of in-betweens at some points (p,), without their paths.

    Parameters
    ----------
    blend : Blend
        At the points.
    scale : Scaling or None
    opening : Residual or None
        At the points.
    """

    blend: Blend
    scale: Scaling | None
    opening: Residual | None

    def __call__(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return both, each (t, p), at times (t,) in [0, 1]."""
        fz, g = self.blend.values(times)
        fzbar = np.conj(g, out=g)
        if self.scale is not None:
            rho = self.scale.at(times)[:, None]
            fzbar *= rho
            if self.opening is not None:
                fz *= rho + (1.0 - rho) * np.exp(self.opening.at_times(times))
        return fz, fzbar


def _blended(blend: Blend, opening: Residual | None, time: float, rho: float) -> Derivatives:
    """Return the derivatives of a blend, Ψ' and Ψ'' before their scaling by ρ.

    Around holes ρ scales Φ a little, too: Φ' is the mean of that for ρ = 0, F e^d, and that for
    ρ = 1, F (`engine.interpolation.scaling`).
    """
    blended = blend.derivatives(time)
    if opening is None:
        return blended
    d, d_z = np.zeros_like(blended.fz), np.zeros_like(blended.fz)
    opening.add_to(d, d_z, time)
    alone = (1.0 - rho) * np.exp(d)
    share = rho + alone
    return replace(
        blended, fz=blended.fz * share, fzz=blended.fzz * share + blended.fz * alone * d_z
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearInbetweens:
    """The maps themselves, blended linearly: for comparison, without any guarantee.

    Parameters
    ----------
    passage : Passage
    fz, fzbar : tuple of complex128, shape (m,)
        Derivatives of each keyframe at the points.
    """

    passage: Passage
    fz: tuple[Complexes, ...]
    fzbar: tuple[Complexes, ...]

    @property
    def correction(self) -> float:
        """0: linear blends are closed."""
        return 0.0

    @classmethod
    def of(cls, passage: Passage, sites: Sites) -> Self:
        """Work out the derivatives of the keyframes at the points."""
        places = sites.paths.places
        fz = [np.exp(key.log_fz[places]) for key in passage.keyframes]
        g = [key.nu[places] * a for key, a in zip(passage.keyframes, fz, strict=True)]
        return cls(
            passage=passage,
            fz=tuple(map(freeze, fz)),
            fzbar=tuple(freeze(b.conj()) for b in g),
        )

    @property
    def nbytes(self) -> int:
        """Memory beyond the sites' and the keyframes' own, in bytes."""
        return sum(array.nbytes for array in (*self.fz, *self.fzbar))

    def offsets(self, time: float) -> Complexes:
        """Return f − f(anchor) at the points, (m,)."""
        return self._positions(time) - self.passage.anchor_position(time)

    def frame(self, time: float) -> Frame:
        """Return the in-between at a time in [0, 1]."""
        weights = self.passage.course(time)
        return Frame(
            positions=self._positions(time),
            fz=weighted(self.fz, weights),
            fzbar=weighted(self.fzbar, weights),
            rho=None,
        )

    def derivatives_at(self, which: Indices) -> Callable[[Floats], tuple[Complexes, Complexes]]:
        """Return f_z and f_z̄ of some of the points as functions of times (t,), (t, p) each."""
        fz, fzbar = (np.array([each[which] for each in known]) for known in (self.fz, self.fzbar))

        def blended(times: Floats) -> tuple[Complexes, Complexes]:
            weights = self.passage.course.at(times).T
            return combined(weights, fz), combined(weights, fzbar)

        return blended

    def _positions(self, time: float) -> Complexes:
        keyframes = self.passage.keyframes
        return weighted([key.positions for key in keyframes], self.passage.course(time))


Inbetweens = IntegratedInbetweens | LinearInbetweens

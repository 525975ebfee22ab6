"""In-betweens of two keyframes by one variant, as functions of time from one to the other."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, nbytes_of
from engine.interpolation.added.closing import Closing
from engine.interpolation.added.pins.evaluated import EvaluatedCorrection, Mixing, SpanBasis
from engine.interpolation.added.pins.pinning import CorrectionSeries
from engine.interpolation.blends.blend import Blend
from engine.interpolation.keyframe_blend.derivatives import Derivatives, KeyframeBlend, weighted_sum
from engine.interpolation.sampled_domain import SampledDomain
from engine.interpolation.scaling.smoothed_rho import SmoothedRho
from engine.interpolation.series.residual import Residual
from engine.maps import Boundary, Bounds, distortion


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frame:
    """An in-between at the points.

    `positions`, `fz` and `fzbar` are f, f_z and the true derivative f_z̄ = ∂f/∂z̄, complex128 (m,).
    `rho` scales η; None for variants without scaling.
    """

    positions: Complexes
    fz: Complexes
    fzbar: Complexes
    rho: float | None

    @property
    def k(self) -> Floats:
        """Conformal distortion at the points, float64 (m,)."""
        return distortion.k(self.fz, self.fzbar)

    @property
    def tau(self) -> Floats:
        """Isometric distortion."""
        return distortion.tau(self.fz, self.fzbar)

    @property
    def sigma_a(self) -> Floats:
        """Larger singular value."""
        return distortion.sigma_a(self.fz, self.fzbar)

    @property
    def sigma_b(self) -> Floats:
        """Smaller singular value."""
        return distortion.sigma_b(self.fz, self.fzbar)


class PointValues(NamedTuple):
    """An in-between at the value points (v,), or at times (t,) there, (t, v).

    `fz` and `g` are f_z and conj(f_z̄). `k` is K, which multiplies the q of a further correction
    (`engine.deform.correction.frame.BaseFrame`).
    """

    fz: Complexes
    g: Complexes
    k: Complexes


class Correctable(Protocol):
    """In-betweens, or a single frame, that corrections of handles change."""

    @property
    def sign(self) -> int: ...

    def anchor_position(self, time: float, /) -> complex: ...

    def frame_with_values(self, time: float, /) -> tuple[Frame, PointValues]: ...


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Inbetweens:
    """In-betweens by blended derivatives, integrated along the paths.

    Section 4.1: f^t = Φ^t + conj(Ψ^t) is harmonic for any holomorphic Φ'^t = f_z^t and
    Ψ'^t = conj(f_z̄^t). Section 7 integrates both from the anchor.

    The value is frozen: calls are pure and may run on several threads at once.

    Attributes
    ----------
    scale : SmoothedRho or None
        ρ; None if Ψ is not scaled.
    closing : Closing or None
        Series of h, which closes the periods around holes.
    conformal_closing : Closing or None
        Series of d, around holes with a scaled Ψ. It closes the periods without any Ψ
        (`engine.interpolation.scaling.pointwise`).
    corrections : tuple of EvaluatedCorrection
        Of pinned handles, then of tracks. Each corrects the result of the previous one.
    """

    sampled_domain: SampledDomain
    blend: Blend
    scale: SmoothedRho | None = None
    closing: Closing | None = None
    conformal_closing: Closing | None = None
    corrections: tuple[EvaluatedCorrection, ...] = ()

    @property
    def keyframe_blend(self) -> KeyframeBlend:
        """The keyframes of the blend and their time weights."""
        return self.blend.keyframe_blend

    @property
    def boundary(self) -> Boundary:
        return self.sampled_domain.boundary

    @property
    def bounds(self) -> Bounds:
        """Bounds of motion through keyframes."""
        return self.blend.bounds

    @property
    def correction(self) -> float:
        """The largest |h| that closes the periods around holes; 0 without holes."""
        return 0.0 if self.closing is None else self.closing.largest

    @property
    def _conformal(self) -> Residual | None:
        """Series of d at the nodes."""
        return None if self.conformal_closing is None else self.conformal_closing.residual

    @property
    def nbytes(self) -> int:
        """Memory in bytes, without the sampled domain and the keyframes."""
        return nbytes_of(self, but=(self.sampled_domain, self.keyframe_blend.keyframes))

    def rho(self, time: float) -> float:
        """Return ρ; 1 if Ψ is not scaled."""
        return 1.0 if self.scale is None else self.scale(time)

    def with_correction(self, known: CorrectionSeries, basis: SpanBasis | None = None) -> Self:
        """Return a copy with one more correction; a basis at the nodes saves time."""
        sites = self.sampled_domain
        more = EvaluatedCorrection.of(known, sites.boundary.span, sites.paths.nodes, basis)
        return replace(self, corrections=(*self.corrections, more))

    @property
    def sign(self) -> int:
        """σ of the corrections: −1 if a correction without q keeps η, 1 if it keeps ν."""
        return self.blend.sign or -1

    def anchor_position(self, time: float) -> complex:
        return complex(self.anchor_positions(np.array([time]))[0])

    def anchor_positions(self, times: Floats) -> Complexes:
        """Return the positions of the anchor at times (t,)."""
        positions = self.keyframe_blend.anchor_positions(times)
        return sum((each.known.shift(times) for each in self.corrections), positions)

    def derivatives_at(self, which: Indices) -> Callable[[Floats], tuple[Complexes, Complexes]]:
        """Return f_z and f_z̄ of some of the points (p,) as functions of times (t,), (t, p) each."""
        values = self._values_at(self.sampled_domain.paths.places[which])

        def derivatives(times: Floats) -> tuple[Complexes, Complexes]:
            fz, g, _ = values(times)
            return fz, np.conj(g, out=g)

        return derivatives

    def values_at(self, times: Floats) -> PointValues:
        """Return the values at the value points and times (t,), (t, v) each."""
        return self._values_at(self.sampled_domain.paths.beside)(times)

    def frame_with_values(self, time: float) -> tuple[Frame, PointValues]:
        """Return a frame and the values at the value points, for little more than the frame."""
        (blended, mixing), beside = self._mixed(time), self.sampled_domain.paths.beside
        values = PointValues(blended.fz[beside], blended.g[beside], mixing.k[beside])
        return self._frame(blended, time), values

    def _values_at(self, nodes: Indices) -> Callable[[Floats], PointValues]:
        """Return values at nodes (p,) as functions of times (t,), (t, p) each."""
        blend, conformal = self.blend.at(nodes), self._conformal and self._conformal.at(nodes)
        corrections = [each.at(nodes) for each in self.corrections]

        def values(times: Floats) -> PointValues:
            fz, g = blend.values(times)
            if self.scale is not None:
                rho = self.scale.at(times)[:, None]
                g *= rho
                if conformal is not None:
                    fz *= rho + (1.0 - rho) * np.exp(conformal.at_times(times))
            k = self._factor(blend.keyframe_blend.log_fz_without_residuals_at(times), fz)
            for each in corrections:
                fz, g, k = each.changed_values(fz, g, k, self.sign, times)
            return PointValues(fz, g, k)

        return values

    def offsets(self, time: float) -> Complexes:
        """Return f − f(anchor) at the points, (m,)."""
        return self._offsets(self.derivatives(time), time)

    def frame(self, time: float) -> Frame:
        """Return the in-between at a time in [0, 1]."""
        return self._frame(self.derivatives(time), time)

    def _frame(self, blended: Derivatives, time: float) -> Frame:
        places = self.sampled_domain.paths.places
        return Frame(
            positions=self.anchor_position(time) + self._offsets(blended, time),
            fz=blended.fz[places],
            fzbar=blended.g[places].conj(),
            rho=None if self.scale is None else self.rho(time),
        )

    def _factor(self, plain_log_fz: Complexes, fz: Complexes) -> Complexes:
        """Return K = L² / F before corrections; L is the exponential of the blended logarithms.

        The linear blend has zeros of f_z, where K would be infinite; there K = L.
        """
        if not self.blend.sign:
            return np.exp(plain_log_fz)
        squared = 2.0 * plain_log_fz
        return np.divide(np.exp(squared, out=squared), fz, out=squared)

    def _mixed(self, time: float) -> tuple[Derivatives, Mixing]:
        """Return the derivatives of a frame after all corrections, and K."""
        blended = self._uncorrected(time)
        log_l, log_k_z = self.keyframe_blend.log_fz_without_residuals(time)
        if self.blend.sign:
            log_k_z *= 2.0
            log_k_z -= blended.fzz / blended.fz
        mixing = Mixing(self._factor(log_l, blended.fz), log_k_z)
        for each in self.corrections:
            blended, mixing = each.changed(blended, mixing, self.sign, time)
        return blended, mixing

    def derivatives(self, time: float) -> Derivatives:
        """Return the derivatives at the nodes."""
        return self._mixed(time)[0] if self.corrections else self._uncorrected(time)

    def _uncorrected(self, time: float) -> Derivatives:
        """Return the derivatives of a frame before corrections.

        Around holes ρ scales Φ a little, too. Φ' is the mean, weighted by ρ, of F e^d (ρ = 0) and F
        (ρ = 1) (`engine.interpolation.scaling.pointwise`).
        """
        blended = self.blend.derivatives(time)
        if self.scale is not None:
            rho = self.rho(time)
            # Equation (8): η̃ = ρ η.
            blended = blended._replace(g=rho * blended.g, gz=rho * blended.gz)
            if self._conformal is not None:
                d, d_z = np.zeros_like(blended.fz), np.zeros_like(blended.fz)
                self._conformal.add_to(d, d_z, time)
                alone = (1.0 - rho) * np.exp(d)
                share = rho + alone
                blended = blended._replace(
                    fz=blended.fz * share, fzz=blended.fzz * share + blended.fz * alone * d_z
                )
        return blended

    def _offsets(self, blended: Derivatives, time: float) -> Complexes:
        """Return Φ + conj(Ψ), both 0 at the anchor; one sum along the paths gives both."""
        paths = self.sampled_domain.paths
        steps = paths.step_integrals(blended.fz, blended.fzz)
        conj_psi = paths.step_integrals(blended.g, blended.gz)
        steps += np.conj(conj_psi, out=conj_psi)
        offsets = self.quadrature_errors(time)
        offsets += paths.integrals(steps)
        return offsets

    def quadrature_errors(self, time: float) -> Complexes:
        """Return the known errors of the quadrature at the keyframes, blended, (m,).

        They have the weights of the keyframes. The in-between therefore equals the keyframes at
        both ends, without a jump in time.
        """
        keyframes, weights = self.keyframe_blend.keyframes, self.keyframe_blend.time_weights(time)
        errors = weighted_sum([key.psi_error for key in keyframes], weights)
        np.conj(errors, out=errors)
        errors *= self.rho(time)
        errors += weighted_sum([key.phi_error for key in keyframes], weights)
        return errors

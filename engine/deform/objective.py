"""What a step of a drag minimises: energy, barrier and handles, with gradient and Hessian.

The unknowns are φ and ψ in the boundary's basis, whose derivatives are orthonormal: the Hessian is
then well conditioned but for handles and walls, and half the digits do for its sketches. Without
ψ_0, a constant (the gauge: (φ + c, ψ − conj(c)) is the same map). As a real vector they are the
real and imaginary parts, alternating, of the conjugates of φ and ψ_1, ψ_2, …; with that order
Re Σ P_j φ_j is the plain product with the parts of a complex row P, and matrices need no
rearrangement.

Around q holes the last q entries of φ are the logarithms' a_j, scaled, and those of ψ their
conjugates: ψ's are no unknowns, and what they contribute is folded onto φ's. Constants on the cage
of a hole, which change no map, have a stiffness of their own (`Handles`), and steps never change
them. In all there are u = 4 n − 2 − 2 q real unknowns for the n functions of the span.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.deform.barrier import Barrier
from engine.deform.energy import Radial, symmetric_dirichlet, symmetric_dirichlet_derivatives
from engine.deform.handles import Handles, Wish
from engine.maps import Boundary

# In single or double precision.
Reals = npt.NDArray[np.float32] | npt.NDArray[np.float64]

# A sketched Hessian takes one sample in so many, with the coefficients of its neighbours summed, as
# long as that leaves this many for each cage vertex. Samples with coefficients this far above the
# median (near a bound) enter one by one; of many the stiffest, this part of the number of the calm.
SAMPLES_PER_VERTEX = 2
STIFF = 3.0
STIFF_PER_CALM = 0.75
# Samples this far above the median keep all their digits in a sketch, too.
HARD = 1e3
# Stiffness of a step against turning the whole shape by an angle, over that against stretching it.
DAMPING = 1e-4


class Jet(NamedTuple):
    """Everything the objective knows of a map; real-linear in its coefficients.

    Parameters
    ----------
    f, g : complex128, shape (m,)
        f_z and conj(f_z̄) at the samples.
    positions, fz : complex128, shape (h,)
        The map and f_z at the handles.
    """

    f: Complexes
    g: Complexes
    positions: Complexes
    fz: Complexes

    def advanced(self, length: float, direction: "Jet") -> "Jet":
        """Return the jet of the map that lies `length` steps along a direction."""
        return Jet(*(here + length * there for here, there in zip(self, direction, strict=True)))


class _Quadrature(NamedTuple):
    """Samples (s,), and what they contribute to the Hessian (6, s).

    The entries are, in the frames of f and g, radial and tangential of f, the same of g, between
    both radials, and what the projection removes from the tangential of f. The last `hard` samples
    are so stiff that single precision would lose the others beside them.
    """

    samples: Indices
    entries: Floats
    hard: int = 0

    def split(self) -> tuple["_Quadrature", "_Quadrature"]:
        """Return those that are not hard, and those that are."""
        calm = len(self.samples) - self.hard
        return (
            _Quadrature(self.samples[:calm], self.entries[:, :calm]),
            _Quadrature(self.samples[calm:], self.entries[:, calm:]),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Objective:
    """Energy + barrier + handle terms.

    Parameters
    ----------
    boundary : Boundary
    handles : Handles
    wish : Wish
    barrier : Barrier or None
    stride : int
        One sample in so many enters the Hessian; more than one make a sketch of it. Good enough,
        and two to three times faster, on the way; near a minimum its steps overshoot in directions
        that show between the samples only, and the shape would never come to rest.
    """

    boundary: Boundary
    handles: Handles
    wish: Wish
    barrier: Barrier | None = None
    stride: int = 1

    @cached_property
    def _turning(self) -> Booleans:
        return np.isfinite(self.wish.rotations)

    def coefficients(self, unknowns: Floats) -> tuple[Complexes, Complexes]:
        """Return the columns (n,) of coefficients of φ and ψ that unknowns (u,) stand for."""
        n, count = len(self.boundary.span), len(self.boundary.holes)
        conjugates = np.ascontiguousarray(unknowns).view(np.complex128).conj()
        of_phi = conjugates[:n]
        of_psi = np.concatenate([[0.0], conjugates[n:], of_phi[n - count :].conj()])
        return self.boundary.basis @ of_phi, self.boundary.basis @ of_psi

    def jet(self, phi: Complexes, psi: Complexes) -> Jet:
        """Measure a map, or a change of a map, by the columns (n,) of its coefficients."""
        span, coordinates = self.boundary.span, self.handles.coordinates
        rows, phi_alone = self.boundary.derivatives, span.without_constant(phi)
        return Jet(
            f=rows @ phi_alone,
            g=rows @ span.without_constant(psi),
            positions=coordinates @ phi + (coordinates @ psi).conj(),
            fz=self.handles.derivatives @ phi_alone,
        )

    def value(self, jet: Jet) -> float:
        """Return the objective, ∞ where the map folds or leaves the walls."""
        value = self.energy(jet)
        if self.barrier is not None and np.isfinite(value):
            density = self.barrier.value(np.abs(jet.f), np.abs(jet.g))
            value += float(self.boundary.shares @ density)
        return value

    def energy(self, jet: Jet) -> float:
        """Return the objective without its barrier."""
        # A trial step may lead farther than numbers reach; there the energy is ∞.
        with np.errstate(over="ignore", invalid="ignore"):
            density = symmetric_dirichlet(np.abs(jet.f), np.abs(jet.g))
            pull = np.abs(jet.positions - self.wish.positions) ** 2
            value = self.boundary.weights @ density + self.handles.stiffness @ pull
            if self._turning.any():
                value += self._turning_stiffness @ self._turning_angles(jet) ** 2
        return np.inf if np.isnan(value) else float(value)

    def within(self, jet: Jet) -> bool:
        """Tell whether the samples are strictly within the walls."""
        a, b = np.abs(jet.f), np.abs(jet.g)
        if self.barrier is None:
            return bool(np.all(a > b))
        return bool(np.all(self.barrier.slacks(a, b) > 0))

    def radial(self, jet: Jet) -> Radial:
        """Return what each sample contributes to the derivatives of energy and barrier."""
        a, b = np.abs(jet.f), np.abs(jet.g)
        energy = symmetric_dirichlet_derivatives(a, b).weighted(self.boundary.weights)
        if self.barrier is None:
            return energy
        return energy.plus(self.barrier.derivatives(a, b).weighted(self.boundary.shares))

    def gradient(self, jet: Jet, radial: Radial) -> Floats:
        """Return the gradient (u,)."""
        pull = 2.0 * self.handles.stiffness * (jet.positions - self.wish.positions)
        by_phi = pull.conj() @ self.handles.basis_coordinates
        by_psi = pull @ self.handles.basis_coordinates
        if self._turning.any():
            # d arg F = Im(dF / F) = Re(−i dF / F).
            angle = 2.0 * self._turning_stiffness * self._turning_angles(jet)
            by_phi += (-1j * angle / jet.fz[self._turning]) @ self._turning_rows
        by_handles = self._by_unknowns(by_phi, by_psi)
        gradient: Floats = by_handles + self.sampled_gradient(jet, radial.a, radial.b_per_b)
        return gradient

    def sampled_gradient(
        self, jet: Jet, by_a: Floats, b_per_b: Floats, samples: Indices | slice = slice(None)
    ) -> Floats:
        """Return the gradient (u,) of a sum over samples of functions of a and b.

        Parameters
        ----------
        jet : Jet
        by_a, b_per_b : float64, shape (m,)
            What each sample contributes to the derivative by a, and to that by b over b.
        samples : Indices or slice
            Which samples contribute, by default all.
        """
        rows, f, g = self.boundary.basis_derivatives[samples], jet.f[samples], jet.g[samples]
        by_phi = (by_a[samples] * f.conj() / np.abs(f)) @ rows
        by_psi = (b_per_b[samples] * g.conj()) @ rows
        return self._by_unknowns(by_phi, by_psi)

    def _by_unknowns(self, by_phi: Complexes, by_psi: Complexes) -> Floats:
        """Return a gradient (u,) from what multiplies φ and ψ (n,), logarithms included."""
        count = len(self.boundary.holes)
        if count:
            by_phi[-count:] += by_psi[-count:].conj()
        return np.concatenate([by_phi, by_psi[1 : len(by_psi) - count]]).view(np.float64)

    def hessian(self, jet: Jet, radial: Radial) -> Floats:
        """Return the positive semidefinite part of the Hessian (u, u), upper triangle.

        Notes
        -----
        In the frames F / |F|, G / |G| of each sample the exact Hessian has the radial block
        [[h_aa, h_ab], [h_ab, h_bb]] and the tangential entries h_a / a, h_b / b, of which only
        h_a / a can be negative: max(h_a / a, 0) is the exact projection. The sum over the samples
        is a quadrature, coarser than that of energy and gradient. Cost: 24 s n² for s samples; in
        a sketch in single precision but for the hard ones.
        """
        hessian = self.handles.hessian.copy()
        calm, hard = self._quadrature(radial).split()
        rows = [*self._turning_roots(jet), self._damping_root(jet, calm)]
        self._add(hessian, jet, calm, rows, single=self.stride > 1)
        if len(hard.samples):
            self._add(hessian, jet, hard)
        return hessian

    def stiffening(self, jet: Jet, radial: Radial, samples: Indices) -> Floats:
        """Return the positive part of the Hessian (u, u) of a few samples, upper triangle."""
        hessian = np.zeros_like(self.handles.hessian)
        entries = _entries(radial)[:, samples]
        self._add(hessian, jet, _Quadrature(samples, entries))
        return hessian

    def _add(
        self,
        hessian: Floats,
        jet: Jet,
        quadrature: "_Quadrature",
        more: Sequence[Complexes] = (),
        *,
        single: bool = False,
    ) -> None:
        """Add samples, and further rows of φ, to a Hessian; on request in single precision."""
        n, u = len(self.boundary.span), len(hessian)
        by_phi, by_psi, cross = self._roots(jet, quadrature, more, single=single)
        of_phi, of_psi = by_phi.T @ by_phi, by_psi.T @ by_psi
        across = by_psi[: len(cross)]
        across *= cross[:, None]
        mixed = by_phi[: len(cross)].T @ across
        hessian[: 2 * n, : 2 * n] += of_phi
        hessian[2 * n :, 2 * n :] += of_psi[: u - 2 * n, : u - 2 * n]
        hessian[: 2 * n, 2 * n :] += mixed[:, : u - 2 * n]
        if self.boundary.holes:
            self._fold_logarithms(hessian, mixed, of_psi)

    def _fold_logarithms(self, hessian: Floats, mixed: Reals, of_psi: Reals) -> None:
        """Add what ψ's logarithms, the conjugates of φ's, contribute to a Hessian (u, u).

        Parameters
        ----------
        hessian : float64, shape (u, u)
            Its upper triangle is changed.
        mixed : float32 or float64, shape (2n, 2n − 2)
            Between the parts of φ and those of ψ_1, ψ_2, …
        of_psi : float32 or float64, shape (2n − 2, 2n − 2)
        """
        count = 2 * len(self.boundary.holes)
        sign = np.tile([1.0, -1.0], count // 2)  # a conjugate has the other imaginary part
        logs = slice(len(mixed) - count, len(mixed))
        across, own = mixed[:, -count:] * sign, of_psi[:, -count:] * sign
        hessian[: len(mixed), logs] += across
        hessian[logs, logs] += across[logs].T + sign[:, None] * own[-count:]
        hessian[logs, len(mixed) :] += own[:-count].T

    def negative_part(self, jet: Jet, radial: Radial) -> Floats:
        """Return what the projection removed from the Hessian of φ, (2n, 2n).

        `hessian` minus this is the exact Hessian; it need not be positive.
        """
        samples, entries, _ = self._quadrature(radial)
        bent = entries[-1] > 0
        f = jet.f[samples[bent]]
        roots = -1j * np.sqrt(entries[-1][bent]) * f.conj() / np.abs(f)
        rows = self.boundary.basis_derivatives[samples[bent]] * roots[:, None]
        turning = self._turning_roots(jet, removed=True)
        by_phi = np.concatenate([rows, *turning]).view(np.float64)
        removed: Floats = by_phi.T @ by_phi
        return removed

    def _roots(
        self, jet: Jet, quadrature: "_Quadrature", more: Sequence[Complexes], *, single: bool
    ) -> tuple[Reals, Reals, Reals]:
        """Return rows of φ and of ψ whose Gram matrices are their blocks of the Hessian.

        Further rows of φ come last. The first s rows of each are the radial ones, of the s samples:
        the third array (s,) weighs their products between φ and ψ.
        """
        samples, entries, _ = quadrature
        kind = np.complex64 if single else np.complex128
        rows = self.boundary.basis_derivatives[samples].astype(kind, copy=False)
        f, g = jet.f[samples], jet.g[samples]
        b = np.abs(g)
        frame_f = f.conj() / np.abs(f)
        frame_g = np.where(b > 0, g.conj(), 1.0) / np.where(b > 0, b, 1.0)
        root_f, around_f, root_g, around_g = np.sqrt(entries[:4])
        count, n = rows.shape
        by_phi = np.empty((2 * count + sum(map(len, more)), n), kind)
        by_psi = np.empty((2 * count, n - 1), kind)
        for place, part in enumerate((root_f * frame_f, -1j * around_f * frame_f)):
            own = by_phi[place * count : (place + 1) * count]
            np.multiply(rows, part.astype(kind)[:, None], out=own)
        for place, part in enumerate((root_g * frame_g, -1j * around_g * frame_g)):
            own = by_psi[place * count : (place + 1) * count]
            np.multiply(rows[:, 1:], part.astype(kind)[:, None], out=own)
        if more:
            np.concatenate(more, out=by_phi[2 * count :], casting="same_kind")
        both = root_f * root_g
        cross = entries[4] / np.where(both > 0, both, 1.0)
        real: np.dtype[Any] = np.dtype(np.float32 if single else np.float64)
        return by_phi.view(real), by_psi.view(real), cross.astype(real, copy=False)

    def _quadrature(self, radial: Radial) -> "_Quadrature":
        """Return the samples that enter the Hessian.

        Calm ones stand for their neighbours that were added, and in a sketch for more.
        """
        entries = _entries(radial)
        m, n = len(self.boundary.points), len(self.boundary.span)
        own, loops = self.boundary.own_samples
        first, middles, sketched = [], [], False
        for (start, end), cage in zip(pairwise(loops), self.boundary.span.cages, strict=True):
            # A small hole may have no more samples than its cage needs.
            enough = (end - start) // (SAMPLES_PER_VERTEX * len(cage))
            stride = max(min(self.stride, enough), 1)
            places = np.arange(start, end, stride)
            first.append(places)
            middles.append(np.minimum(places + stride // 2, end - 1))
            sketched |= stride > 1
        density = (radial.aa + radial.bb) / self.boundary.shares
        stiffest = max(n, int(STIFF_PER_CALM * m / self.stride)) if sketched else 1
        ordered = np.partition(density, sorted({m // 2, m - stiffest}))
        median = float(ordered[m // 2])
        least = max(STIFF * median, float(ordered[m - stiffest])) if sketched else STIFF * median
        stiff = np.flatnonzero(density > least)
        hard = density[stiff] > HARD * median
        stiff = np.concatenate([stiff[~hard], stiff[hard]])
        alone = entries[:, stiff]
        entries[:, stiff] = 0.0
        summed = np.add.reduceat(entries, own[np.concatenate(first)], axis=1)
        some = summed[0] > 0
        return _Quadrature(
            np.concatenate([own[np.concatenate(middles)[some]], stiff]),
            np.hstack([summed[:, some], alone]),
            int(np.count_nonzero(hard)),
        )

    def _damping_root(self, jet: Jet, calm: "_Quadrature") -> Complexes:
        """Return the row of a tiny stiffness against turning as a whole.

        One handle leaves the rotation of the shape free; rounding alone would then turn it.
        """
        stiffness = DAMPING * calm.entries[0].sum()
        per_sample = -1j * np.sqrt(stiffness) * self.boundary.weights / jet.f
        row: Complexes = per_sample[None, :] @ self.boundary.basis_derivatives
        return row

    @cached_property
    def _turning_stiffness(self) -> Floats:
        return 2.0 * self.handles.arm**2 * self.handles.stiffness[self._turning]

    @cached_property
    def _turning_rows(self) -> Complexes:
        return self.handles.basis_derivatives[self._turning]

    def _turning_angles(self, jet: Jet) -> Floats:
        wished = np.exp(-1j * self.wish.rotations[self._turning])
        angles: Floats = np.angle(jet.fz[self._turning] * wished)
        return angles

    def _turning_roots(self, jet: Jet, *, removed: bool = False) -> list[Complexes]:
        """Return the rows whose Gram matrix is the projected Hessian of the rotation terms.

        With dF / F = x + iy the term c δ² has the Hessian 2c [[0, −δ], [−δ, 1]]; its eigenvalues
        are c (1 ± root) with root² = 1 + 4 δ², for the vectors (−2δ, 1 ± root). The negative one is
        what the projection removed.
        """
        if not self._turning.any():
            return []
        delta = self._turning_angles(jet)
        root = np.sqrt(1.0 + 4.0 * delta**2)
        eigenvalue = 1.0 - root if removed else 1.0 + root
        # x vx + y vy = Re((vx − i vy) dF / F).
        length = np.maximum(np.hypot(2.0 * delta, eigenvalue), np.finfo(np.float64).tiny)
        scale = np.sqrt(self._turning_stiffness * np.abs(eigenvalue)) / length
        frame = scale * (-2.0 * delta - 1j * eigenvalue) / jet.fz[self._turning]
        return [frame[:, None] * self._turning_rows]


def _entries(radial: Radial) -> Floats:
    """Return what samples contribute to the Hessian, as a `_Quadrature` has it."""
    return np.array(
        [
            radial.aa,
            np.maximum(radial.around_a, 0.0),
            radial.bb,
            radial.around_b,
            radial.ab,
            np.maximum(-radial.around_a, 0.0),
        ]
    )

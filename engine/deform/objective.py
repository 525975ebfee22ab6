"""What a step of a drag minimises: energy, barrier and handles, with gradient and Hessian.

The unknowns are φ and ψ in the boundary's basis, whose derivatives are orthonormal and whose means
are 0: the Hessian is then well conditioned but for walls, and half the digits do for all samples
but those next to walls. Without ψ_0, a constant (the gauge: (φ + c, ψ − conj(c)) is the same map).
As a real vector they are the real and imaginary parts, alternating, of the conjugates of φ and ψ_1,
ψ_2, …; with that order Re Σ P_j φ_j is the plain product with the parts of a complex row P, and
matrices need no rearrangement.

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

from engine.arrays import Booleans, Complexes, Floats, Indices, Singles
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
# Samples this far above the median keep all their digits.
HARD = 1e5
# Stiffness of a step against turning the whole shape by an angle, over that against stretching it.
DAMPING = 1e-4


@dataclass(frozen=True, kw_only=True, eq=False)
class Jet:
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

    @cached_property
    def a(self) -> Floats:
        """|f_z| at the samples, float64 (m,)."""
        moduli: Floats = np.abs(self.f)
        return moduli

    @cached_property
    def b(self) -> Floats:
        """|f_z̄| at the samples, float64 (m,)."""
        moduli: Floats = np.abs(self.g)
        return moduli

    @cached_property
    def density(self) -> Floats:
        """The symmetric Dirichlet density at the samples, float64 (m,)."""
        # A trial step may lead farther than numbers reach; there the energy is ∞.
        with np.errstate(over="ignore", invalid="ignore"):
            return symmetric_dirichlet(self.a, self.b)

    def scaled(self, factor: float) -> "Jet":
        """Return the jet of a change that is so many times as large."""
        return Jet(
            f=factor * self.f,
            g=factor * self.g,
            positions=factor * self.positions,
            fz=factor * self.fz,
        )

    def advanced(self, length: float, direction: "Jet") -> "Jet":
        """Return the jet of the map that lies `length` steps along a direction."""
        return Jet(
            f=self.f + length * direction.f,
            g=self.g + length * direction.g,
            positions=self.positions + length * direction.positions,
            fz=self.fz + length * direction.fz,
        )


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
        One sample in so many enters the Hessian; more than one make a sketch of it, two to three
        times faster. Its steps overshoot in directions that show between the samples only, unless
        products with the Hessian over all samples mend them.
    """

    boundary: Boundary
    handles: Handles
    wish: Wish
    barrier: Barrier | None = None
    stride: int = 1

    @cached_property
    def turning(self) -> Booleans:
        """Which handles have a prescribed rotation, bool (h,)."""
        return np.isfinite(self.wish.rotations)

    def coefficients(self, unknowns: Floats) -> tuple[Complexes, Complexes]:
        """Return the columns (n,) of coefficients of φ and ψ that unknowns (u,) stand for."""
        of_phi, of_psi = self._in_basis(unknowns)
        return self.boundary.basis @ of_phi, self.boundary.basis @ of_psi

    def change(self, unknowns: Floats) -> Jet:
        """Measure a change of a map by its unknowns (u,)."""
        of_phi, of_psi = self._in_basis(unknowns)
        rows, coordinates = self.boundary.basis_derivatives, self.handles.basis_coordinates
        return Jet(
            f=rows @ of_phi,
            g=rows @ of_psi,
            positions=coordinates @ of_phi + (coordinates @ of_psi).conj(),
            fz=self.handles.basis_derivatives @ of_phi,
        )

    def _in_basis(self, unknowns: Floats) -> tuple[Complexes, Complexes]:
        """Return φ and ψ (n,) in the basis."""
        n, count = len(self.boundary.span), len(self.boundary.holes)
        conjugates = np.ascontiguousarray(unknowns).view(np.complex128).conj()
        of_phi = conjugates[:n]
        of_psi = np.concatenate([[0.0], conjugates[n:], of_phi[n - count :].conj()])
        return of_phi, of_psi

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
            density = self.barrier.value(jet.a, jet.b)
            value += float(self.boundary.shares @ density)
        return value

    def energy(self, jet: Jet) -> float:
        """Return the objective without its barrier."""
        with np.errstate(over="ignore", invalid="ignore"):
            pull = np.abs(jet.positions - self.wish.positions) ** 2
            value = self.boundary.weights @ jet.density + self.handles.stiffness @ pull
            if self.turning.any():
                value += self._turning_stiffness @ self._turning_angles(jet) ** 2
        return np.inf if np.isnan(value) else float(value)

    def within(self, jet: Jet) -> bool:
        """Tell whether the samples are strictly within the walls."""
        if self.barrier is None:
            return bool(np.all(jet.a > jet.b))
        return bool(np.all(self.barrier.slacks(jet.a, jet.b) > 0))

    def radial(self, jet: Jet) -> Radial:
        """Return what each sample contributes to the derivatives of energy and barrier."""
        a, b = jet.a, jet.b
        energy = symmetric_dirichlet_derivatives(a, b).weighted(self.boundary.weights)
        if self.barrier is None:
            return energy
        return energy.plus(self.barrier.derivatives(a, b).weighted(self.boundary.shares))

    def gradient(self, jet: Jet, radial: Radial) -> Floats:
        """Return the gradient (u,)."""
        pull = 2.0 * self.handles.stiffness * (jet.positions - self.wish.positions)
        by_phi = pull.conj() @ self.handles.basis_coordinates
        by_psi = pull @ self.handles.basis_coordinates
        if self.turning.any():
            # d arg F = Im(dF / F) = Re(−i dF / F).
            angle = 2.0 * self._turning_stiffness * self._turning_angles(jet)
            by_phi += (-1j * angle / jet.fz[self.turning]) @ self._turning_rows
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
        by_phi = (by_a[samples] / jet.a[samples] * f.conj()) @ rows
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
        is a quadrature, coarser than that of energy and gradient, and in single precision but for
        the hard ones. Cost: 24 s n² for s samples.
        """
        calm, hard = self._quadrature(radial).split()
        hessian = self.handles.hessian.copy()
        self._add(hessian, jet, calm, self._further_rows(jet, calm), single=True)
        if len(hard.samples):
            self._add(hessian, jet, hard)
        return hessian

    def single_hessian(self, jet: Jet, radial: Radial) -> Singles | None:
        """Return the same in single precision throughout, or None where that will not do.

        That is where samples are hard, around holes, where functions may nearly be the same, and
        where fewer than two handles leave the shape free to turn or to go anywhere.
        """
        quadrature = self._quadrature(radial)
        if quadrature.hard or self.boundary.holes or len(self.wish.positions) < 2:
            return None
        hessian = self.handles.hessian.astype(np.float32)
        further = self._further_rows(jet, quadrature)
        self._add(hessian, jet, quadrature, further, single=True)
        return hessian

    def product(self, jet: Jet, radial: Radial, change: Jet) -> Floats:
        """Return the product (u,) of the Hessian over all samples with a change.

        In double precision, and without the tiny stiffness against turning as a whole; the matrix
        is not formed. Cost: 16 m n for m samples.
        """
        frame_f, frame_g = _frames(jet.f, jet.g)
        f, g = frame_f * change.f, frame_g * change.g
        around_a = np.maximum(radial.around_a, 0.0)
        by_f = radial.aa * f.real + radial.ab * g.real - 1j * around_a * f.imag
        by_g = radial.ab * f.real + radial.bb * g.real - 1j * radial.around_b * g.imag
        pull = 2.0 * self.handles.stiffness * change.positions
        rows, coordinates = self.boundary.basis_derivatives, self.handles.basis_coordinates
        by_phi = (by_f * frame_f) @ rows + pull.conj() @ coordinates
        by_psi = (by_g * frame_g) @ rows + pull @ coordinates
        for frame in self._turning_frames(jet):
            along = (frame * change.fz[self.turning]).real
            by_phi += (along * frame) @ self._turning_rows
        return self._by_unknowns(by_phi, by_psi)

    def stiffening(self, jet: Jet, radial: Radial, samples: Indices) -> Floats:
        """Return the positive part of the Hessian (u, u) of a few samples, upper triangle."""
        hessian = np.zeros_like(self.handles.hessian)
        entries = _entries(radial)[:, samples]
        self._add(hessian, jet, _Quadrature(samples, entries))
        return hessian

    def _add(
        self,
        hessian: Reals,
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

    def _fold_logarithms(self, hessian: Reals, mixed: Reals, of_psi: Reals) -> None:
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
        frame_f, frame_g = _frames(jet.f[samples], jet.g[samples])
        root_f, around_f, root_g, around_g = np.sqrt(entries[:4])
        count, n = rows.shape
        # Where the projection removed the tangential one there is none.
        held = np.flatnonzero(around_f)
        last = count + len(held)
        by_phi = np.empty((last + sum(map(len, more)), n), kind)
        by_psi = np.empty((2 * count, n - 1), kind)
        along_f, along_g = (root_f * frame_f).astype(kind), (root_g * frame_g).astype(kind)
        across_f = (-1j * (around_f * frame_f)[held]).astype(kind)
        across_g = (-1j * around_g * frame_g).astype(kind)
        np.multiply(rows, along_f[:, None], out=by_phi[:count])
        np.multiply(rows[held], across_f[:, None], out=by_phi[count:last])
        np.multiply(rows[:, 1:], along_g[:, None], out=by_psi[:count])
        np.multiply(rows[:, 1:], across_g[:, None], out=by_psi[count:])
        if more:
            np.concatenate(more, out=by_phi[last:], casting="same_kind")
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

    def _further_rows(self, jet: Jet, calm: "_Quadrature") -> list[Complexes]:
        """Return rows of φ that are no samples', and enter the Hessian with the calm ones."""
        return [*self._turning_roots(jet), self._damping_root(jet, calm)]

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
        return 2.0 * self.handles.arm**2 * self.handles.stiffness[self.turning]

    @cached_property
    def _turning_rows(self) -> Complexes:
        return self.handles.basis_derivatives[self.turning]

    def _turning_angles(self, jet: Jet) -> Floats:
        wished = np.exp(-1j * self.wish.rotations[self.turning])
        angles: Floats = np.angle(jet.fz[self.turning] * wished)
        return angles

    def _turning_roots(self, jet: Jet, *, removed: bool = False) -> list[Complexes]:
        """Return the rows of φ of `_turning_frames`."""
        frames = self._turning_frames(jet, removed=removed)
        return [frame[:, None] * self._turning_rows for frame in frames]

    def _turning_frames(self, jet: Jet, *, removed: bool = False) -> list[Complexes]:
        """Return what multiplies dF of handles in rows: the projected Hessian of their rotations.

        With dF / F = x + iy the term c δ² has the Hessian 2c [[0, −δ], [−δ, 1]]; its eigenvalues
        are c (1 ± root) with root² = 1 + 4 δ², for the vectors (−2δ, 1 ± root). The negative one is
        what the projection removed.
        """
        if not self.turning.any():
            return []
        delta = self._turning_angles(jet)
        root = np.sqrt(1.0 + 4.0 * delta**2)
        eigenvalue = 1.0 - root if removed else 1.0 + root
        # x vx + y vy = Re((vx − i vy) dF / F).
        length = np.maximum(np.hypot(2.0 * delta, eigenvalue), np.finfo(np.float64).tiny)
        scale = np.sqrt(self._turning_stiffness * np.abs(eigenvalue)) / length
        return [scale * (-2.0 * delta - 1j * eigenvalue) / jet.fz[self.turning]]


def _frames(f: Complexes, g: Complexes) -> tuple[Complexes, Complexes]:
    """Return conj(F) / |F| and conj(G) / |G| (s,), 1 where G is 0."""
    b = np.abs(g)
    frame_g = np.ones_like(g)
    np.divide(g.conj(), b, out=frame_g, where=b > 0)
    return f.conj() / np.abs(f), frame_g


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

"""The energy of a map relative to another one, with the barrier of its bounds and its pins.

With B = f_z and C = conj(f_z̄) of the base, J = |B|² − |C|², α = conj(B) / J and β = −C / J, the map
g = f ∘ base⁻¹ has

    P = ∂_w g = α F + β conj(G),    Q = conj(∂_w̄ g) = α G + β conj(F),

and Re(p dP + q dQ) = Re((p α + conj(q β)) dF + (conj(p β) + q α) dG): rows of the derivatives by P
and Q become rows by φ and ψ, and the projection of the Hessian is that of the energy in P and Q.
The identity is the minimum of the energy; so that it is that of all together, the slope of the
barrier at the base is taken off, as a function of |F| and |G| that turns with the map. The barrier
is convex in these two, so that what is left of it is nowhere negative, however near a wall is.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from engine.arrays import Complexes, Floats, Indices, Singles
from engine.deform.handles import hold_constants
from engine.deform.model import (
    Barrier,
    Jet,
    Radial,
    by_unknowns,
    symmetric_dirichlet,
    symmetric_dirichlet_derivatives,
)
from engine.deform.relative.pins import Pins
from engine.deform.relative.pulls import TINY, Pulls
from engine.deform.relative.rows import Rows

# A prescribed turn is as stiff as two points this far (of L) on either side.
ARM = 0.02
# κ: how strongly the outline is held where the base has it, times (1 − reach)², over L².
HELD = 300.0
# How much stiffer by the barrier than by the energy a sample is whose barrier enters the Hessian,
# that does so by itself, and with all its digits.
FELT, ALONE, HARD = 0.3, 1.0, 1e5

# By |F| and by |G|, each (m,).
Load = tuple[Floats, Floats]
# Rows by φ and ψ (k,), and of which of some samples.
Block = tuple[Complexes, Complexes, Indices]


@dataclass(frozen=True, kw_only=True, eq=False)
class RelativeEnergy:
    """What a correction of a base minimises.

    Parameters
    ----------
    rows : Rows
    base : Jet
    pins : Pins
    fixed : float64, shape (u, u)
        The Hessian of what holds the outline, which does not change in a solve.
    pulls : Pulls
    """

    rows: Rows
    base: Jet
    pins: Pins
    alpha: Complexes = field(init=False)
    beta: Complexes = field(init=False)
    fixed: Floats = field(init=False)
    pulls: Pulls = field(init=False)

    def __post_init__(self) -> None:
        f, g, boundary = self.base.f, self.base.g, self.rows.boundary
        area = np.abs(f) ** 2 - np.abs(g) ** 2
        object.__setattr__(self, "alpha", f.conj() / area)
        object.__setattr__(self, "beta", -g / area)
        pulls = Pulls(
            boundary=boundary,
            coordinates=self.rows.coordinates,
            stiffness=self.stiffness,
            firmer=self.rows.firmer,
            offsets=np.abs(self.base.positions - self.pins.places),
        )
        fixed = 2.0 * self.held * self.rows.held
        hold_constants(boundary, fixed)
        object.__setattr__(self, "fixed", fixed)
        object.__setattr__(self, "pulls", pulls)

    @cached_property
    def stiffness(self) -> Floats:
        """λ of the points (h,)."""
        return self.pins.stiffness * self.rows.firmer / self.rows.boundary.size**2

    @cached_property
    def held(self) -> float:
        """κ, for the mean over the outline of |δ|² / L²."""
        return HELD * (1.0 - self.pins.reach) ** 2

    @cached_property
    def turning(self) -> Indices:
        """The points that are to be turned, (t,)."""
        return np.flatnonzero(~np.isnan(self.pins.turns))

    def relative(self, at: Jet) -> tuple[Complexes, Complexes]:
        """Return P and Q (m,)."""
        return (
            self.alpha * at.f + self.beta * at.g.conj(),
            self.alpha * at.g + self.beta * at.f.conj(),
        )

    def load(self, barrier: Barrier) -> Load:
        """Return the slope of the barrier at the base, by |F| and by |G|."""
        b = self.base.b
        radial = barrier.derivatives(self.base.a, b)
        return radial.a, radial.b_per_b * b

    def value(self, at: Jet, unknowns: Floats, barrier: Barrier, load: Load) -> float:
        """Return what is minimised; ∞ beyond the walls."""
        a, b = at.a, at.b
        if not np.all(barrier.slacks(a, b) > 0):
            return np.inf
        p, q = self.relative(at)
        density = symmetric_dirichlet(np.abs(p), np.abs(q)) + barrier.value(a, b)
        density -= load[0] * (a - self.base.a)
        density -= load[1] * (b - self.base.b)
        value = self.rows.boundary.weights @ density
        value += self.pulls.value(at.positions - self.pins.places)
        if self.held:
            value += self.held * (unknowns @ (self.rows.held @ unknowns))
        if len(self.turning):
            value += self._turning_stiffness @ self._turned(at) ** 2
        return float(value)

    def model(
        self, at: Jet, unknowns: Floats, barrier: Barrier, load: Load
    ) -> tuple[Floats, Floats, Floats]:
        """Return the gradient (u,), the projected Hessian (u, u), and what the projection removed.

        With that taken off again the Hessian is the exact one, which need not be positive, but for
        pulls that give in: along them it has nothing (`Pulls.step`).
        """
        boundary, weights = self.rows.boundary, self.rows.boundary.weights
        a, b = at.a, at.b
        p, q = self.relative(at)
        energy = symmetric_dirichlet_derivatives(np.abs(p), np.abs(q))
        bar = _unloaded(barrier.derivatives(a, b), a, b, load)
        by_p = weights * energy.a * p.conj() / np.abs(p)
        by_q = weights * energy.b_per_b * q.conj()
        by_f = by_p * self.alpha + (by_q * self.beta).conj()
        by_g = (by_p * self.beta).conj() + by_q * self.alpha
        by_f += weights * bar.a * at.f.conj() / a
        by_g += weights * bar.b_per_b * at.g.conj()
        lacking = at.positions - self.pins.places
        pull = self.pulls.firmness(lacking) * lacking
        by_phi = by_f @ boundary.basis_derivatives + pull.conj() @ self.rows.coordinates
        by_psi = by_g @ boundary.basis_derivatives + pull @ self.rows.coordinates
        hessian = self.fixed + self.pulls.hessian(lacking)
        if len(self.turning):
            slope = 2.0 * self._turning_stiffness * self._turned(at)
            frames = -1j / at.fz[self.turning]
            by_phi += (slope * frames) @ self.rows.derivatives[self.turning]
            roots = np.sqrt(2.0 * self._turning_stiffness)[:, None] * frames[:, None]
            rows = roots * self.rows.derivatives[self.turning]
            _add_squared(hessian, by_unknowns(boundary, rows, np.zeros_like(rows)))
        gradient = by_unknowns(boundary, by_phi, by_psi)
        if self.held:
            gradient = gradient + 2.0 * self.held * (self.rows.held @ unknowns)
        removed = np.zeros_like(hessian)
        self._add_energy(hessian, removed, (p, q), energy)
        self._add_barrier(hessian, removed, at, bar, energy)
        return gradient, hessian, removed

    @cached_property
    def _turning_stiffness(self) -> Floats:
        arm = ARM * self.rows.boundary.size
        stiffness: Floats = 2.0 * arm**2 * self.stiffness[self.turning]
        return stiffness

    def _turned(self, at: Jet) -> Floats:
        """Return by how much the points are turned too far, (t,)."""
        wanted = np.exp(-1j * self.pins.turns[self.turning])
        angles: Floats = np.angle(at.fz[self.turning] * wanted)
        return angles

    def _add_energy(
        self, hessian: Floats, removed: Floats, pair: tuple[Complexes, Complexes], energy: Radial
    ) -> None:
        some = self.rows.some
        alpha, beta = self.alpha[some].astype(np.complex64), self.beta[some].astype(np.complex64)
        for into, roots in zip(
            (hessian, removed), _roots(pair, energy, some, self.rows.some_weights), strict=True
        ):
            blocks = []
            for by_p, by_q, which in roots:
                x, y = by_p.astype(np.complex64), by_q.astype(np.complex64)
                a, b = alpha[which], beta[which]
                blocks.append((x * a + (y * b).conj(), (x * b).conj() + y * a, which))
            self._add(into, blocks, self.rows.single[some])

    def _add_barrier(
        self, hessian: Floats, removed: Floats, at: Jet, barrier: Radial, energy: Radial
    ) -> None:
        stiffer = (barrier.aa + barrier.bb) / (energy.aa + energy.bb)
        boundary, some = self.rows.boundary, self.rows.some
        calm = (stiffer[some] > FELT) & (stiffer[some] <= ALONE)
        alone = np.flatnonzero((stiffer > ALONE) & (stiffer <= HARD))
        hard = np.flatnonzero(stiffer > HARD)
        for which, weights, rows in (
            (some[calm], self.rows.some_weights[calm], self.rows.single[some[calm]]),
            (alone, boundary.weights[alone], self.rows.single[alone]),
            (hard, boundary.weights[hard], boundary.basis_derivatives[hard]),
        ):
            if len(which):
                both = _roots((at.f, at.g), barrier, which, weights)
                for into, roots in zip((hessian, removed), both, strict=True):
                    self._add(into, roots, rows)

    def _add(self, hessian: Floats, blocks: list[Block], rows: Complexes) -> None:
        """Add the squares of rows by φ and ψ to a Hessian, in the rows' own precision."""
        if not blocks:
            return
        count, r = len(self.rows.boundary.holes), rows.shape[1]
        # At once where they belong: as many copies would take as long as their product.
        every = np.empty((sum(len(block[2]) for block in blocks), 2 * r - 1 - count), rows.dtype)
        at = 0
        for x, y, which in blocks:
            into, own = every[at : at + len(which)], rows[which]
            np.multiply(x[:, None], own, out=into[:, :r])
            np.multiply(y[:, None], own[:, 1 : r - count], out=into[:, r:])
            if count:
                into[:, r - count : r] += (y[:, None] * own[:, r - count :]).conj()
            at += len(which)
        _add_squared(hessian, every.view(every.real.dtype))


def _unloaded(radial: Radial, a: Floats, b: Floats, load: Load) -> Radial:
    """Return the derivatives of a barrier less a load, for a = |F| and b = |G|."""
    by_a, by_b = load
    per_b = by_b / np.maximum(b, TINY)
    return radial._replace(
        a=radial.a - by_a,
        b_per_b=radial.b_per_b - per_b,
        around_a=radial.around_a - by_a / a,
        around_b=np.maximum(radial.around_b - per_b, 0.0),
    )


def _roots(
    pair: tuple[Complexes, Complexes], radial: Radial, which: Indices, weights: Floats
) -> tuple[list[Block], list[Block]]:
    """Return rows by both of a pair whose squares are the projected Hessian of samples (s,).

    Then those whose squares the projection removed.
    """
    x, y = pair[0][which], pair[1][which]
    aa, ab, bb = radial.aa[which], radial.ab[which], radial.bb[which]
    root = np.sqrt(weights)
    first = np.sqrt(aa)
    mixed = ab / first
    second = np.sqrt(np.maximum(bb - mixed**2, 0.0))
    size = np.abs(y)
    frame_x = root * x.conj() / np.abs(x)
    frame_y = root * np.where(size > 0, y.conj() / np.maximum(size, TINY), 1.0)
    nothing, every = np.zeros_like(frame_x), np.arange(len(which))
    around = radial.around_a[which]
    tangential = -1j * np.sqrt(np.abs(around)) * frame_x
    up, down = np.flatnonzero(around > 0), np.flatnonzero(around < 0)
    kept = [
        (first * frame_x, mixed * frame_y, every),
        (nothing, second * frame_y, every),
        (nothing, -1j * np.sqrt(radial.around_b[which]) * frame_y, every),
        (tangential[up], nothing[up], up),
    ]
    return kept, [(tangential[down], nothing[down], down)] if len(down) else []


def _add_squared(hessian: Floats, rows: Floats | Singles) -> None:
    """Add the product of real rows (k, u) with themselves, in their own precision."""
    hessian += rows.T @ rows

"""Newton's method for the correction of one frame, from nothing, within the bounds.

Each frame is solved by itself, never from a neighbour, so that frames are the same in whichever
order they are asked for. Where nothing is asked, the correction is nothing.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from engine.arrays import Complexes, Floats, ratio
from engine.deform.model import (
    SHIFT,
    Barrier,
    Jet,
    Walls,
    factor_of,
    factor_shifted,
    in_basis,
)
from engine.deform.relative.between import Middles
from engine.deform.relative.energy import RelativeEnergy
from engine.deform.relative.pins import Pins
from engine.deform.relative.pulls import TINY
from engine.deform.relative.rows import Rows
from engine.maps import Boundary, Limits

MOST_STEPS = 60
# Weight of the barrier at rest. After a short step it grows, to a part of what the step was to gain
# at least, and after a long one it falls: pins that are wanted far beyond a wall pull at it with a
# force that the least weight stands against only next to it.
LEAST_WEIGHT = 2e-2
SHORT, LONG = 0.2, 0.5
GROWTH, OF_GAIN, FALL = 2.0, 0.05, 0.5
# Parts of what the projection removes from the Hessian that are tried to be left out of it, and the
# size of steps beyond which that is of no use.
REMOVED = (1.0, 0.3)
FARTHEST = 1.0
# Walls are inside the bounds by this part of the way to the identity: between two samples a map is
# beyond what it is at them by less. A base near that keeps half of what it has left.
MARGIN = 1e-2
LEFT = 1e-4
# What is left to go (of L, and of the derivatives in the mean) where a correction is at rest: steps
# shrink by a factor that itself shrinks off the bounds, and hardly does while a map creeps along.
ENOUGH = 1e-5
SHORTEST = 1e-7
SUFFICIENT = 1e-4
TO_THE_WALL = 0.9
HALVINGS = 10


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Corrected:
    """A correction: what is added to a base.

    Parameters
    ----------
    phi, psi : complex128, shape (n,)
        Coefficients over the functions of the span.
    change : Jet
        The same at the samples and the points.
    misses : float64, shape (h,)
        How far the points are from where they are wanted.
    steps : int
    is_held_back : bool
        Whether a bound is reached.
    """

    phi: Complexes
    psi: Complexes
    change: Jet
    misses: Floats
    steps: int
    is_held_back: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class Corrector:
    """Corrections of maps of one domain, with pins at some points of it.

    Parameters
    ----------
    boundary : Boundary
        As `Boundary.sample` gives it.
    points : complex128, shape (h,)
        In the closed domain.
    """

    boundary: Boundary
    points: Complexes

    @cached_property
    def rows(self) -> Rows:
        """What does not depend on the base."""
        return Rows.of(self.boundary, self.points)

    @cached_property
    def _middles(self) -> Middles:
        return Middles.of(self.boundary)

    def measured(self, phi: Complexes, psi: Complexes) -> Jet:
        """Return a map of the span, by its coefficients (n,), at the samples and the points."""
        boundary, points = self.boundary, self._of_points
        span = boundary.span
        alone = span.without_constant(phi)
        return Jet(
            f=boundary.derivatives @ alone,
            g=boundary.derivatives @ span.without_constant(psi),
            positions=points[0] @ phi + (points[0] @ psi).conj(),
            fz=points[1] @ alone,
        )

    @cached_property
    def _of_points(self) -> tuple[Complexes, Complexes]:
        """The functions of the span and their derivatives at the points, (h, n) each."""
        span = self.boundary.span
        return span.coordinates(self.points), span.derivatives(self.points)

    def correct(self, base: Jet, pins: Pins, limits: Limits) -> Corrected:
        """Return the map of the span that brings the points of a base where they are wanted.

        It minimises the symmetric Dirichlet energy relative to the base, with the points held as
        firmly as the pins say, within the limits, or where the base exceeds them within what it
        has itself.

        Notes
        -----
        Cost: about 70 s n² a step for s samples and n functions; 2 to 6 steps where no bound is
        near, 10 to 40 at bounds. A base that folds stays as it is.
        """
        if not np.all(np.abs(base.f) > np.abs(base.g)):
            return self._nothing(base, pins)
        walls = _walls(base, limits)
        energy = RelativeEnergy(rows=self.rows, base=base, pins=pins)
        unknowns = np.zeros(len(energy.fixed))
        weight, at, steps, duals = LEAST_WEIGHT, base, 0, None
        last = TINY
        while steps < MOST_STEPS:
            barrier = Barrier(walls=walls, weight=weight, duals=duals)
            load = energy.load(barrier)
            value = energy.value(at, unknowns, barrier, load)
            gradient, hessian, removed = energy.model(at, unknowns, barrier, load)
            step, change = self._step(energy, at, gradient, hessian, removed)
            length, slope = _longest(barrier, at, change), float(gradient @ step)
            while length > SHORTEST:
                tried = at.advanced(length, change)
                there = energy.value(tried, unknowns + length * step, barrier, load)
                if there <= value + SUFFICIENT * length * slope + 1e-13 * abs(value):
                    break
                length *= 0.5
            else:
                break
            duals = _next_duals(barrier, at, change)
            at, unknowns, steps = tried, unknowns + length * step, steps + 1
            size = self._size(change)
            if size * min(size / last, 1.0) < ENOUGH and weight == LEAST_WEIGHT:
                break
            last = size
            if length < SHORT:
                weight = max(GROWTH * weight, -OF_GAIN * slope)
            elif length > LONG:
                weight = max(FALL * weight, LEAST_WEIGHT)
        change = self.rows.change(unknowns)
        share = self._middles.share_within(base, change, limits, self.boundary)
        if share < 1.0:
            unknowns, change = share * unknowns, change.scaled(share)
            at = base.advanced(1.0, change)
        return self._corrected(unknowns, pins, at, walls, steps)

    def _step(
        self, energy: RelativeEnergy, at: Jet, gradient: Floats, hessian: Floats, removed: Floats
    ) -> tuple[Floats, Jet]:
        """Return Newton's step (u,), and what it changes.

        That of a Hessian with less of what bends down, where one with more leads anywhere.
        """
        lacking = at.positions - energy.pins.places
        for part in REMOVED:
            factor = factor_of(hessian - part * removed, SHIFT)
            if factor is not None:
                step = energy.pulls.step(factor, gradient, lacking)
                change = self.rows.change(step)
                if self._size(change) < FARTHEST:
                    return step, change
        step = energy.pulls.step(factor_shifted(hessian), gradient, lacking)
        return step, self.rows.change(step)

    def _nothing(self, base: Jet, pins: Pins) -> Corrected:
        """Return the correction of a base that none can be added to."""
        nothing = np.zeros(len(self.boundary.span), dtype=np.complex128)
        return Corrected(
            phi=nothing,
            psi=nothing,
            change=self.measured(nothing, nothing),
            misses=np.abs(base.positions - pins.places),
            steps=0,
            is_held_back=True,
        )

    def _size(self, change: Jet) -> float:
        """Return how large a change is."""
        weights = self.boundary.lengths
        moved = np.abs(change.positions).max(initial=0.0) / self.boundary.size
        return float(max(moved, np.abs(change.f) @ weights, np.abs(change.g) @ weights))

    def _corrected(
        self, unknowns: Floats, pins: Pins, at: Jet, walls: Walls, steps: int
    ) -> Corrected:
        phi, psi = in_basis(self.boundary, unknowns)
        slacks = Barrier(walls=walls, weight=LEAST_WEIGHT).slacks(at.a, at.b)
        return Corrected(
            phi=self.boundary.basis @ phi,
            psi=self.boundary.basis @ psi,
            change=self.rows.change(unknowns),
            misses=np.abs(at.positions - pins.places),
            steps=steps,
            is_held_back=bool(slacks.min() < MARGIN),
        )


def _next_duals(barrier: Barrier, at: Jet, change: Jet) -> Floats:
    """Return the dual variables (3, m) of the barrier after a whole step.

    To first order: where a map goes along a curved wall they would keep it there.
    """
    a, b = at.a, at.b
    da = (at.f.conj() * change.f).real / a
    db = (at.g.conj() * change.g).real / np.maximum(b, TINY)
    return barrier.next_duals(a, b, da, db)


def _longest(barrier: Barrier, at: Jet, change: Jet) -> float:
    """Return how much of a step leads at most so far towards the walls as is allowed."""

    def stays(length: float) -> bool:
        a, b = np.abs(at.f + length * change.f), np.abs(at.g + length * change.g)
        return bool(np.all(barrier.slacks(a, b) > 0))

    if stays(1.0 / TO_THE_WALL):
        return 1.0
    inside, outside = 0.0, 1.0 / TO_THE_WALL
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if stays(middle) else (inside, middle)
    return TO_THE_WALL * inside


def _walls(base: Jet, limits: Limits) -> Walls:
    """Return where the barrier of each sample becomes infinite."""
    a, b = base.a, base.b
    inner = Walls.around(limits.towards_identity(MARGIN), len(a))
    outer = Walls.around(limits, len(a))
    k, sigma_a, sigma_b = ratio(b, a), a + b, a - b
    # As smooth in time as the base: no sample's wall leaps as it comes near.
    return Walls(
        k=np.maximum(inner.k, (k + np.maximum(outer.k, k + LEFT)) / 2),
        sigma_a=np.maximum(
            inner.sigma_a, (sigma_a + np.maximum(outer.sigma_a, sigma_a * (1 + LEFT))) / 2
        ),
        sigma_b=np.minimum(
            inner.sigma_b, (sigma_b + np.minimum(outer.sigma_b, sigma_b * (1 - LEFT))) / 2
        ),
    )

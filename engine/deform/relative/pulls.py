"""Pins that pull with bounded force at the points of a map.

A pin holds its point by λ |e|², e what the point lacks, as long as that pulls with less than a
force F; beyond e₀ = F / (2 λ) by 2 λ e₀ |e| − λ e₀² (Huber 1964). One that is wanted far out of
reach then stretches the shape to its bounds, and neither tears at what is held elsewhere nor
presses a map against its walls ever harder: no wish is worse conditioned than those at the end of
the reach.

The Hessian has 2 λ e₀ / |e| for 2 λ across a pull, and nothing along it; by itself that would lead
far past the target. A step is instead to the minimum of Newton's model of all else and of the pulls
as they are: e is linear in the unknowns. It is found by weights that follow the pulls (Holland and
Welsch 1977), in the few dimensions of the pins, from the step whose Hessian has
2 λ e₀ / |e| along them too.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.deform.model import by_unknowns, solved
from engine.maps import Boundary

# The force of a pin that is wanted elsewhere, per L: what is within reach needs some 10, of a body
# that hardly gives some 200. One that is wanted nearer than this part of L to where the base has
# its point pulls the more strongly the nearer it is, and so much more strongly if it only holds.
PULL = 200.0
NEAR = 0.02
HOLDING = 100.0
# Rounds of the weights, and what part of the way is left after them.
ROUNDS = 50
LEFT_TO_GO = 1e-3
TINY = 1e-300


@dataclass(frozen=True, kw_only=True, eq=False)
class Pulls:
    """The pulls of pins.

    Parameters
    ----------
    boundary : Boundary
    coordinates : complex128, shape (h, r)
        Of the functions of the boundary's basis, at the points.
    stiffness : float64, shape (h,)
        λ of each.
    firmer : float64, shape (h,)
        By which factor they are held, and pull, more firmly where it is stiff.
    offsets : float64, shape (h,)
        How far from where the base has them the points are wanted.
    """

    boundary: Boundary
    coordinates: Complexes
    stiffness: Floats
    firmer: Floats
    offsets: Floats

    @cached_property
    def gives(self) -> Floats:
        """e₀ of each (h,)."""
        size = self.boundary.size
        nearness = NEAR * size / np.maximum(self.offsets, TINY)
        forces = PULL / size * self.firmer * np.clip(nearness, 1.0, HOLDING)
        gives: Floats = forces / (2.0 * self.stiffness)
        return gives

    def value(self, lacking: Complexes) -> float:
        """Return the energy where the points lack so much (h,)."""
        far = np.abs(lacking)
        near = np.minimum(far, self.gives)
        return float(self.stiffness @ (near * (2.0 * far - near)))

    def firmness(self, lacking: Complexes) -> Floats:
        """Return the force of each over what it lacks (h,): 2 λ, or 2 λ e₀ / |e| beyond e₀."""
        part = np.minimum(1.0, self.gives / np.maximum(np.abs(lacking), TINY))
        firmness: Floats = 2.0 * self.stiffness * part
        return firmness

    def hessian(self, lacking: Complexes) -> Floats:
        """Return that (u, u), as firm along pulls as across."""
        root = np.sqrt(np.tile(self.firmness(lacking), 2))
        rows = root[:, None] * self._rows
        squared: Floats = rows.T @ rows
        return squared

    def step(self, factor: Floats, gradient: Floats, lacking: Complexes) -> Floats:
        """Return the step (u,) to the minimum of the model with the pulls as they are.

        Parameters
        ----------
        factor : float64, shape (u, u)
            Of the model's Hessian, with `hessian` in it.
        gradient : float64, shape (u,)
        lacking : complex128, shape (h,)
            Before the step.
        """
        step = -solved(factor, gradient)
        # What only holds is left as firm as it is.
        some = np.flatnonzero(self.offsets > NEAR / HOLDING * self.boundary.size)
        rows = self._rows[np.concatenate([some, some + len(lacking)])]
        errors, first = _parts(lacking[some]), rows @ step
        before = self._firmness_of(errors, some)
        if np.array_equal(before, self._firmness_of(errors + first, some)):
            return step
        responses = np.column_stack([solved(factor, row) for row in rows])
        yielding = rows @ responses
        stiffness = np.linalg.inv(yielding)
        alone, pushed = stiffness - np.diag(before), stiffness @ first + before * errors
        held = 2.0 * np.tile(self.stiffness[some], 2)
        moved: Floats = np.linalg.solve(alone + np.diag(held), pushed - held * errors)
        if not np.array_equal(held, self._firmness_of(errors + moved, some)):
            moved = self._followed(alone, pushed, errors, first, some)
        better: Floats = step + responses @ np.linalg.solve(yielding, moved - first)
        return better if gradient @ better < 0 else step

    def _followed(
        self, alone: Floats, pushed: Floats, errors: Floats, moved: Floats, some: Indices
    ) -> Floats:
        """Return how points move (2 q,) to the minimum, by weights that follow their pulls."""
        for _ in range(ROUNDS):
            firm = self._firmness_of(errors + moved, some)
            model = alone + np.diag(firm)
            # The model bends down where only a pull that has given in held it.
            if np.linalg.eigvalsh(model + model.T)[0] <= 0:
                break
            before = moved
            moved = np.asarray(np.linalg.solve(model, pushed - firm * errors), dtype=np.float64)
            change = np.abs(moved - before).max()
            if change <= LEFT_TO_GO * np.abs(errors + moved).max():
                break
        return moved

    def _firmness_of(self, errors: Floats, some: Indices) -> Floats:
        """Return the firmness for what x and y of some points lack (2 q,)."""
        far = np.hypot(*errors.reshape(2, -1))
        part = np.minimum(1.0, self.gives[some] / np.maximum(far, TINY))
        return np.tile(2.0 * self.stiffness[some] * part, 2)

    @cached_property
    def _rows(self) -> Floats:
        """What moves the points: x, then y, by the unknowns (2 h, u)."""
        some, boundary = self.coordinates, self.boundary
        along = [by_unknowns(boundary, row.copy(), row) for row in some]
        up = [by_unknowns(boundary, -1j * row, 1j * row) for row in some]
        return np.array(along + up)


def _parts(places: Complexes) -> Floats:
    """Return x and then y of places (h,), float64 (2 h,)."""
    return np.concatenate([places.real, places.imag])

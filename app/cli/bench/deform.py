"""The deformer: one certified step, its parts, and Newton's method from the identity."""

from collections.abc import Iterator

import numpy as np

from app.cli.bench.table import Row, Table, measure
from engine.arrays import Complexes
from engine.deform import (
    Deformer,
    Handles,
    Objective,
    State,
    Wish,
    line_search,
    newton_direction,
)
from engine.maps import Boundary, Bounds, certify

CAGE_VERTICES = (25, 50, 53, 100, 200)
DRAG_STEPS = 20
MOST_STEPS = 100


def tables() -> Iterator[Table]:
    """Measure drags of a star over cages of more and more vertices."""
    for count in CAGE_VERTICES:
        yield _drag(star(count))


def star(count: int) -> Boundary:
    """Return a rounded star: outline and cage of as many vertices."""
    angle = 2 * np.pi * np.arange(count) / count
    return Boundary.sample(_rounded(angle, 0.0), _rounded(angle, 0.04))


def _rounded(angle: np.ndarray[tuple[int], np.dtype[np.float64]], offset: float) -> Complexes:
    radius = 1 + offset + 0.35 * np.cos(5 * angle)
    points: Complexes = radius * np.exp(1j * angle)
    return points


def _drag(boundary: Boundary) -> Table:
    tips = 1.1 * np.exp(2j * np.pi * np.arange(5) / 5)
    points = np.append(tips, 0.0)
    handles = Handles.place(boundary, points)
    deformer = Deformer(boundary=boundary, handles=handles, bounds=Bounds())
    targets = points + 0.4 * np.exp(2j * np.arange(6))
    wish = handles.wish(targets)
    states = [deformer.start()]
    for _ in range(DRAG_STEPS):
        states.append(deformer.step(states[-1], wish))
    state = states[DRAG_STEPS // 2]
    objective = Objective(boundary=boundary, handles=handles, wish=wish, stride=4)
    jet = objective.jet(*state.map.columns)
    radial = objective.radial(jet)
    rows = (
        Row(
            name="certified step of a drag",
            seconds=_mean_step(deformer, states, wish),
            note=f"{len(boundary.points)} samples",
        ),
        Row(name="Hessian", seconds=measure(lambda: objective.hessian(jet, radial))),
        Row(
            name="Hessian and its factors, direction",
            seconds=measure(lambda: newton_direction(objective, jet)),
        ),
        Row(
            name="certificate",
            seconds=measure(lambda: certify(state.map, boundary, deformer.bounds)),
        ),
        Row(
            name="minimum without bounds",
            seconds=None,
            note=f"{_newton_steps(boundary, handles, wish)} Newton steps from the identity",
        ),
    )
    return Table(title=f"Deformer, {len(boundary.cage)} cage vertices, 6 handles", rows=rows)


def _mean_step(deformer: Deformer, states: list[State], wish: Wish) -> float:
    def all_steps() -> None:
        for state in states[:-1]:
            deformer.step(state, wish)

    return measure(all_steps) / (len(states) - 1)


def _newton_steps(boundary: Boundary, handles: Handles, wish: Wish) -> int:
    objective = Objective(boundary=boundary, handles=handles, wish=wish)
    phi, psi = boundary.cage, np.zeros_like(boundary.cage)
    for steps in range(MOST_STEPS):
        jet = objective.jet(phi, psi)
        value = objective.value(jet)
        direction = newton_direction(objective, jet)
        if -direction.derivative < 1e-8 * value:
            return steps
        length = line_search(objective, jet, direction, value)
        phi, psi = phi + length * direction.phi, psi + length * direction.psi
    return MOST_STEPS

"""The deformer: one certified step, its parts, and Newton's method from the identity."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import NamedTuple
from unittest import mock

import numpy as np

from engine.arrays import Complexes
from engine.deform import (
    Deformer,
    Handles,
    HandleTargets,
    Objective,
    State,
    certified_step,
    line_search,
    newton_direction,
    projected_hessian,
)
from engine.geometry import Domain
from engine.maps import Boundary, Bounds, certify
from tests.bench.table import Row, Table, measure

MOVING_STEPS = 40
DRAG_STEPS = 20
MOST_STEPS = 100
REPEATS = 5
# What a certified step consists of, and the functions that do it.
PARTS = {
    "  its Hessian, factors and direction": "preconditioned_direction",
    "  its certificate": "certify_segments",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    cages: tuple[int, ...] = (25, 50, 53, 100, 200)  # vertices


BRIEF = Extent(cages=(25,))


def tables(extent: Extent) -> Iterator[Table]:
    """Measure drags of a star over cages of more and more vertices."""
    for count in extent.cages:
        yield _drag(star(count))


def star(count: int) -> Boundary:
    """Return a rounded star: outline and cage of as many vertices."""
    angle = 2 * np.pi * np.arange(count) / count
    return Boundary.sample(Domain(_rounded(angle, 0.0), _rounded(angle, 0.04)))


def _rounded(angle: np.ndarray[tuple[int], np.dtype[np.float64]], offset: float) -> Complexes:
    radius = 1 + offset + 0.35 * np.cos(5 * angle)
    points: Complexes = radius * np.exp(1j * angle)
    return points


def _drag(boundary: Boundary) -> Table:
    tips = 1.1 * np.exp(2j * np.pi * np.arange(5) / 5)
    points = np.append(tips, 0.0)
    handles = Handles.place(boundary, points)
    deformer = Deformer(boundary=boundary, handles=handles, bounds=Bounds())
    handle_targets = handles.targets(points + 0.4 * np.exp(2j * np.arange(6)))
    # The same distance, while the hand draws an arc.
    share = np.arange(1, MOVING_STEPS + 1)[:, None] / MOVING_STEPS
    arc = points + 0.4 * share * np.exp(2j * np.arange(6) + 1j * share)
    moving = _steps(deformer, [handles.targets(targets) for targets in arc])
    resting = _steps(deformer, [handle_targets] * DRAG_STEPS)
    state = resting[DRAG_STEPS // 2].start
    objective = Objective(boundary=boundary, handles=handles, targets=handle_targets)
    jet = objective.evaluate(*state.map.columns)
    radial = objective.radial_derivatives(jet)
    steps = _newton_steps(boundary, handles, handle_targets)
    rows = (
        *_split(deformer, moving),
        Row(
            name="certified step, the hand rests",
            seconds=_mean_step(deformer, resting),
            note=f"mean of the first {DRAG_STEPS} towards the same targets, "
            f"{sum(step.end.search is not None for step in resting)} in search of rest",
        ),
        Row(name="Hessian", seconds=measure(lambda: projected_hessian(objective, jet, radial))),
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
            note=f"{steps} Newton steps from the identity",
        ),
    )
    return Table(title=f"Deformer, {len(boundary.cage)} cage vertices, 6 handles", rows=rows)


class _Step(NamedTuple):
    """A step of a drag, towards targets."""

    start: State
    handle_targets: HandleTargets
    end: State


def _steps(deformer: Deformer, requests: Sequence[HandleTargets]) -> list[_Step]:
    """Follow targets with a step each."""
    steps, state = [], deformer.start()
    for handle_targets in requests:
        steps.append(_Step(state, handle_targets, deformer.step(state, handle_targets)))
        state = steps[-1].end
    return steps


def _mean_step(deformer: Deformer, steps: list[_Step]) -> float:
    def all_steps() -> None:
        for step in steps:
            deformer.step(step.start, step.handle_targets)

    return measure(all_steps) / len(steps)


def _split(deformer: Deformer, steps: list[_Step]) -> Iterator[Row]:
    """Measure steps, and of them Newton's direction, the certificate, and the rest."""
    spent = dict.fromkeys(PARTS, 0.0)

    def clocked(part: str, function: Callable[..., object]) -> Callable[..., object]:
        def timed(*arguments: object, **named: object) -> object:
            start = time.process_time()
            result = function(*arguments, **named)
            spent[part] += time.process_time() - start
            return result

        return timed

    with ExitStack() as stack:
        for part, name in PARTS.items():
            function = clocked(part, getattr(certified_step, name))
            stack.enter_context(mock.patch.object(certified_step, name, function))
        start = time.process_time()
        for step in REPEATS * steps:
            deformer.step(step.start, step.handle_targets)
        whole, count = time.process_time() - start, REPEATS * len(steps)
    samples = len(deformer.boundary.points)
    note = f"mean of {len(steps)} requests; {samples} samples"
    yield Row(name="certified step, the hand moves", seconds=whole / count, note=note)
    for part, seconds in spent.items():
        yield Row(name=part, seconds=seconds / count)
    yield Row(name="  the rest of it", seconds=(whole - sum(spent.values())) / count)


def _newton_steps(boundary: Boundary, handles: Handles, handle_targets: HandleTargets) -> int:
    objective = Objective(boundary=boundary, handles=handles, targets=handle_targets)
    phi, psi = boundary.cage, np.zeros_like(boundary.cage)
    for steps in range(MOST_STEPS):
        jet = objective.evaluate(phi, psi)
        value = objective.value(jet)
        direction = newton_direction(objective, jet)
        if -direction.derivative < 1e-8 * value:
            return steps
        length, _ = line_search(objective, jet, direction, value)
        phi, psi = phi + length * direction.phi, psi + length * direction.psi
    return MOST_STEPS

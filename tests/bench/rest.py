"""Pulls of sample drawings: ten moves of the pointer, and how soon the pose rests after them."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from statistics import mean

import numpy as np

from app.document import Layer, Target
from app.editor.work.drag_session import DragStart
from app.solving import DragSolver, Rig
from app.storage import load_project, sample_images
from engine.deform import BoundedPull
from tests.bench.table import Row, Table, measure

PER_MOVE = 2  # steps


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    samples: tuple[str, ...] = ("dragon", "giraffe", "character")
    reaches: tuple[float, ...] = (40.0, 240.0)  # pixels, of an easy and of a hard pull
    handles: int = 3  # that are pulled, one after the other
    moves: int = 10


BRIEF = Extent(samples=("character",), reaches=(40.0,), handles=1, moves=2)


def tables(extent: Extent) -> Iterator[Table]:
    """Measure pulls of the first handles of samples, from the first key of each."""
    for name in extent.samples:
        layer = load_project(sample_images() / f"{name}.lissom").layers[0]
        rig = Rig.of(layer)
        rows = [row for reach in extent.reaches for row in _rows(layer, rig, reach, extent)]
        title = f"A pull of {name}, {len(layer.domain.cage)} cage vertices"
        yield Table(title=f"{title}, mean of {extent.handles} handles", rows=tuple(rows))


def _rows(layer: Layer, rig: Rig, reach: float, extent: Extent) -> Iterator[Row]:
    pulls = [_Pull.of(layer, rig, handle.id) for handle in layer.handles[: extent.handles]]
    moving, resting, steps = [], [], []
    for pull in pulls:
        move = partial(pull.moved, reach, extent.moves)
        moving.append(measure(move, repeats=1))
        rest = partial(pull.rested, *move())
        resting.append(measure(rest, repeats=1))
        steps.append(rest())
    yield Row(name=f"{extent.moves} moves, {reach:.0f} px", seconds=mean(moving))
    note = f"{mean(steps):.1f} steps, at most {max(steps)}"
    yield Row(name=f"until it rests, {reach:.0f} px", seconds=mean(resting), note=note)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Pull:
    """A hand at a handle, and the drag that begins with the layer's first pose."""

    begun: DragSolver
    start: DragStart
    hands: tuple[BoundedPull, ...]

    @classmethod
    def of(cls, layer: Layer, rig: Rig, handle: int) -> "_Pull":
        pose = layer.keys[0].pose
        hands = (BoundedPull(frozenset([handle])),)
        return cls(begun=DragSolver.begin(rig, pose), start=DragStart.of(layer, pose), hands=hands)

    def moved(self, reach: float, moves: int) -> tuple[DragSolver, Mapping[int, Target]]:
        """Return the drag after moves of the pointer on an arc, and the last targets."""
        drag, targets = self.begun, dict(self.start.targets)
        (handle,) = self.hands[0].handles
        for move in range(moves):
            place = self.start.places[handle] + reach * complex(np.exp(0.1j * move))
            targets[handle] = Target(position=place)
            drag = drag.step_towards(targets, PER_MOVE, self.hands)
        return drag, targets

    def rested(self, drag: DragSolver, targets: Mapping[int, Target]) -> int:
        """Return the steps until a drag rests."""
        steps = 0
        while not drag.is_over:
            drag, steps = drag.step_towards(targets, 1, self.hands), steps + 1
        return steps

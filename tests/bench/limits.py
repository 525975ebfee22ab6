"""The deformer at its limits: hard requests, and how they come to rest; it takes some minutes."""

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain, cycle, islice, pairwise

import numpy as np

from app.cut_out import build_picture_domain
from app.storage import decode_picture, sample_images
from engine.arrays import Complexes
from engine.deform import Deformer, Handles, State, Status
from engine.geometry import contains
from engine.maps import Boundary, Bounds, certify
from tests.bench.deform import DRAG_STEPS, star
from tests.bench.table import Row, Table

# Hard requests: bounds from the tightest to the widest, and drawings to try them on.
ROW_OF_BOUNDS = (
    Bounds(k=0.13, sigma_a=1.3, sigma_b=0.77),
    Bounds(k=0.35, sigma_a=1.6, sigma_b=0.6),
    Bounds(k=0.6, sigma_a=2.0, sigma_b=0.5),
    Bounds(k=0.6, sigma_a=2.5, sigma_b=0.4),
    Bounds(k=0.7, sigma_a=3.0, sigma_b=0.33),
    Bounds(k=0.8, sigma_a=5.0, sigma_b=0.2),
    Bounds(k=0.9, sigma_a=10.0, sigma_b=0.1),
    Bounds(k=0.95, sigma_a=20.0, sigma_b=0.05),
)
DRAWINGS = ("bar", "s", "character", "giraffe")
# One request in so many, of all kinds, is also followed along a path, and let go of after a drag.
COMPARED = 5
# Under which a drag is let go.
RELEASED_BOUNDS = (ROW_OF_BOUNDS[1], ROW_OF_BOUNDS[2], Bounds())
PATH_ROWS = 20
# What is left of a motion that can be seen, of the diagonal.
SEEN = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    shapes: int = 6  # with twelve requests each
    # Requests that are followed through all bounds: swapped, collapsed, pulled far.
    through_bounds: tuple[int, ...] = (0, 9, 12, 27, 33, 39, 44)
    cages: tuple[int, ...] = (50, 100)  # vertices, of stars that are let go
    # In different ways: where a drag ends, the search for rest takes more or fewer steps by chance.
    releases: int = 5


BRIEF = Extent(shapes=1, through_bounds=(), cages=(25,), releases=1)


def tables(extent: Extent) -> Iterator[Table]:
    """Measure hard requests, rows of bounds under them, and releases."""
    requests = list(_requests(extent.shapes))
    yield _hard_requests(requests)
    yield _rows_of_bounds({f"request {place}": requests[place] for place in extent.through_bounds})
    yield _releases(extent)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Request:
    """Handles that are asked for something that the bounds may not allow."""

    boundary: Boundary
    bounds: Bounds
    points: Complexes
    targets: Complexes

    def deformer(self) -> Deformer:
        return Deformer(
            boundary=self.boundary,
            handles=Handles.place(self.boundary, self.points),
            bounds=self.bounds,
        )


def _hard_requests(requests: list[_Request]) -> Table:
    """Bring requests to rest from the shape at rest, and compare with other ways there."""
    steps, totals, seconds, resumed, paths, rest = [], [], [], [], [], []
    optimal = certified = 0
    for number, request in enumerate(requests):
        deformer = request.deformer()
        handle_targets = deformer.handles.targets(request.targets)
        begun = time.process_time()
        state, total = deformer.settle(deformer.start(), handle_targets, throw=False)
        seconds.append(time.process_time() - begun)
        totals.append(total)
        last, found = state.statistics, state.outcome
        if last is None or found is None:
            continue
        steps.append(found.steps)
        optimal += state.status in (Status.CONVERGED, Status.AT_LIMITS)
        certified += certify(state.map, request.boundary, request.bounds).is_certified
        again, _ = deformer.settle(deformer.start(state.map), handle_targets, throw=False)
        resumed.append(1.0 - _energy(again) / last.objective)
        if number % COMPARED == 0:
            paths.append(last.objective / _energy(_along_path(request)))
            rest.append(_rest_after_release(request))
    resumed_most, path_ratio = max(resumed), np.quantile(paths, 0.95)
    return Table(
        title=f"{len(requests)} hard requests, from the shape at rest",
        rows=(
            _fact("certified", f"{certified} of {len(requests)}"),
            _fact("proven minima, optimality measure at most 1e-6", f"{optimal}"),
            _fact("Newton steps of the way that is kept", _median_and_most(steps)),
            _fact("Newton steps of all ways", _median_and_most(totals)),
            _fact("seconds for all ways", _median_and_most(seconds)),
            _fact("gain by resuming, of the energy", f"at most {resumed_most:.1e}"),
            _fact(
                f"energy over that of a path in {PATH_ROWS} rows, {len(paths)} requests",
                f"95 % at most {path_ratio:.4f}",
            ),
            _fact("processor's seconds to rest after their release", _median_and_most(rest)),
        ),
    )


def _rows_of_bounds(requests: dict[str, _Request]) -> Table:
    """Widen the bounds under the same requests: the energy must not rise."""
    rows = []
    for name, request in {"the giraffe's bow": _bow(), **requests}.items():
        energies = []
        for bounds in ROW_OF_BOUNDS:
            deformer = replace(request, bounds=bounds).deformer()
            handle_targets = deformer.handles.targets(request.targets)
            energies.append(
                _energy(deformer.settle(deformer.start(), handle_targets, throw=False)[0])
            )
        rise = max(after / before - 1.0 for before, after in pairwise(energies))
        rows.append(_fact(f"largest rise of the energy, {name}", f"{max(rise, 0.0):.1e}"))
    return Table(
        title=f"{len(rows)} requests under {len(ROW_OF_BOUNDS)} bounds, from tight to wide",
        rows=tuple(rows),
    )


def _releases(extent: Extent) -> Table:
    """Let go of a star that was pulled far, and wait until its outline is at rest."""
    rows = []
    for count in extent.cages:
        boundary = star(count)
        tips = 1.1 * np.exp(2j * np.pi * np.arange(5) / 5)
        points = np.append(tips, 0.0)
        pulls = 0.4 * np.exp(2j * np.arange(6)) * np.exp(1j * np.arange(extent.releases))[:, None]
        for bounds in RELEASED_BOUNDS:
            seconds = [
                _rest_after_release(
                    _Request(boundary=boundary, bounds=bounds, points=points, targets=points + pull)
                )
                for pull in pulls
            ]
            rows.append(
                _fact(f"{count} cage vertices, k ≤ {bounds.k:g}", _median_and_most(seconds))
            )
    return Table(title="Processor's seconds to rest after release", rows=tuple(rows))


def _bow() -> _Request:
    """Return the bow of the sample giraffe, its key of frame 30."""
    script = json.loads((sample_images() / "giraffe.json").read_text(encoding="utf-8"))
    bent = script["keys"][1]["targets"]
    places = script["handles"]
    return _Request(
        boundary=_drawn("giraffe"),
        bounds=Bounds(),
        points=np.array([complex(*place) for place in places.values()]),
        targets=np.array([complex(*bent.get(name, place)) for name, place in places.items()]),
    )


def _requests(count: int) -> Iterator[_Request]:
    """Yield six kinds of requests on each shape, under bounds that follow each other."""
    bounds = cycle(ROW_OF_BOUNDS[(5 * place) % 8] for place in range(8))
    shapes = chain(map(star, (25, 50)), map(_drawn, DRAWINGS))
    for number, boundary in enumerate(islice(shapes, count)):
        rng = np.random.default_rng(number)
        size = boundary.size
        for _ in range(2):
            points = _inside(boundary, rng)
            far = rng.normal(size=6) + 1j * rng.normal(size=6)
            middle = points.mean()
            grid = _grid(boundary)
            pulled = np.zeros(len(grid))
            pulled[rng.integers(len(grid))] = 0.12 * size
            asked = (
                (points, points + 0.15 * size * far),
                (points, points + 0.05 * size * far),
                (points, middle + 0.02 * size * np.exp(1j * np.arange(6))),
                (points, points[rng.permutation(6)]),
                (points, middle + 3 * np.exp(1j * rng.normal()) * (points - middle)),
                (grid, grid + pulled * np.exp(2j * np.pi * rng.random())),
            )
            for places, targets in asked:
                yield _Request(
                    boundary=boundary, bounds=next(bounds), points=places, targets=targets
                )


def _drawn(name: str) -> Boundary:
    picture = decode_picture((sample_images() / f"{name}.png").read_bytes(), "")
    domain, _ = build_picture_domain(picture.rgba, triangles=1000, detail="coarse")
    return Boundary.sample(domain)


def _inside(boundary: Boundary, rng: np.random.Generator) -> Complexes:
    """Return six random points of a shape."""
    low, spread = _box(boundary)
    points = low + spread.real * rng.random(2000) + 1j * spread.imag * rng.random(2000)
    return points[contains(boundary.outline, points)][:6]


def _grid(boundary: Boundary) -> Complexes:
    """Return the points of a grid of 5 × 5 that are in a shape."""
    low, spread = _box(boundary)
    share = np.arange(1, 6) / 6
    grid = (low + spread.real * share[:, None] + 1j * spread.imag * share).ravel()
    return grid[contains(boundary.outline, grid)]


def _box(boundary: Boundary) -> tuple[complex, complex]:
    x, y = boundary.outline.real, boundary.outline.imag
    return complex(x.min(), y.min()), complex(np.ptp(x), np.ptp(y))


def _along_path(request: _Request) -> State:
    """Follow the straight way in rows as a recorded drag does, and come to rest."""
    deformer = request.deformer()
    state = deformer.start()
    for share in np.arange(1, PATH_ROWS + 1) / PATH_ROWS:
        row = request.points + share * (request.targets - request.points)
        state, _ = deformer.track_path_row(state, deformer.handles.targets(row))
    return deformer.settle(state, deformer.handles.targets(request.targets), throw=False)[0]


def _rest_after_release(request: _Request) -> float:
    """Return the seconds from the end of a drag until the outline hardly moves any more."""
    deformer = request.deformer()
    state = deformer.start()
    for share in np.arange(1, DRAG_STEPS + 1) / DRAG_STEPS:
        row = request.points + share * (request.targets - request.points)
        state = deformer.step(state, deformer.handles.targets(row))
    handle_targets = deformer.handles.targets(request.targets)
    begun = time.process_time()
    seen = [(0.0, state)]
    while not state.status.is_final:
        state = deformer.step(state, handle_targets)
        seen.append((time.process_time() - begun, state))
    outline = request.boundary.outline
    end = state.map(outline)
    moving = [
        second
        for second, earlier in seen
        if np.abs(earlier.map(outline) - end).max() > SEEN * request.boundary.size
    ]
    return max(moving, default=0.0)


def _energy(state: State) -> float:
    return np.inf if state.statistics is None else state.statistics.objective


def _median_and_most(values: list[float] | list[int]) -> str:
    return f"median {np.median(values):.3g}, at most {max(values):.3g}"


def _fact(name: str, note: str) -> Row:
    return Row(name=name, seconds=None, note=note)

"""Hard and easy requests: what the deformer finds, against searches from every side.

Drawings are bent, curled, twisted, mirrored, and their limbs are crossed. The best known energy is
the least that any search finds from the shape at rest, turned by every quarter against the rotation
that aligns it, within its bounds and within bounds that widen on the way.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from app.cut_out import build_picture_domain
from app.storage import decode_picture, sample_images
from engine.arrays import Complexes
from engine.deform import Deformer, Handles, Objective, Status
from engine.deform.interior_point.continuation import advance_search, begin_search
from engine.deform.interior_point.search import StartingPoint
from engine.deform.model.barrier import MARGIN
from engine.deform.trust_region import align_rigidly
from engine.geometry import contains
from engine.maps import Boundary, Bounds, certify
from tests.campaigns.slowest import timed

DRAWINGS = ("character", "giraffe", "dragon", "s", "bar", "ring")
BOUNDS = (
    Bounds(),
    Bounds(k=0.3, sigma_a=2.0, sigma_b=0.5),
    Bounds(k=0.6, sigma_a=3.0, sigma_b=0.33),
    Bounds(k=0.9, sigma_a=10.0, sigma_b=0.1),
)
HANDLES = 7
ANGLES = np.arange(4) * np.pi / 2
MOST_STEPS = 200  # of one search
MOST_IN_ALL = 250
NEAR = 1.01  # times the best known energy
TOLD_EVERY = 10  # requests


class Request(NamedTuple):
    """Handles of a shape, and where they are wanted."""

    name: str
    deformer: Deformer
    targets: Complexes


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Solve so many requests, hard and easy in turns, and yield what was found of each sort."""
    found: dict[str, list[tuple[float, int, int]]] = {}
    for number, request in enumerate(timed(requests(seed, amount))):
        deformer, handle_targets = (
            request.deformer,
            request.deformer.handles.targets(request.targets),
        )
        state, tried = deformer.settle(deformer.start(), handle_targets, throw=False)
        assert state.status in (Status.CONVERGED, Status.AT_LIMITS, Status.UNFINISHED)
        assert certify(state.map, deformer.boundary, deformer.bounds).is_certified
        assert state.steps <= MOST_STEPS
        assert tried <= MOST_IN_ALL
        energy = state.statistics.objective
        over = energy / min(energy, best_known(request))
        sort = "easy" if request.name.startswith("nudged") else "hard"
        found.setdefault(sort, []).append((over, state.steps, tried))
        if (number + 1) % TOLD_EVERY == 0 or number + 1 == amount:
            for sort, results in found.items():
                yield f"{sort} requests", layers(results)


def layers(results: list[tuple[float, int, int]]) -> dict[str, float]:
    """Return how good what was found is, and what it cost."""
    over, steps, tried = np.array(results).T
    return {
        "solved": len(over),
        f"within {NEAR:g} of the best known": np.count_nonzero(over <= NEAR),
        "most over it": over.max(),
        "median steps": np.median(steps),
        "most steps": steps.max(),
        "median steps tried": np.median(tried),
        "most steps tried": tried.max(),
    }


def best_known(request: Request) -> float:
    """Return the least energy that searches from every side find."""
    deformer = request.deformer
    handle_targets = deformer.handles.targets(request.targets)
    objective = Objective(
        boundary=deformer.boundary, handles=deformer.handles, targets=handle_targets
    )
    rest = deformer.start().map
    least = np.inf
    for angle in ANGLES:
        first = align_rigidly(deformer.handles, handle_targets, rest, angle)
        proven = certify(first, deformer.boundary, deformer.bounds)
        for way in (StartingPoint.REST, StartingPoint.WIDENING):
            search = begin_search(
                objective,
                first,
                proven,
                inside=deformer.bounds.towards_identity(MARGIN),
                limits=deformer.bounds,
                way=way,
            )
            for _ in range(MOST_STEPS):
                search = advance_search(search)
                if search.is_over:
                    break
            least = min(least, search.energy)
    return least


def requests(seed: int, amount: int) -> Iterator[Request]:
    """Yield requests, each kind on each shape under bounds that follow each other."""
    rng = np.random.default_rng(seed)
    shapes = [*map(drawn, DRAWINGS), pictured(comb()), pictured(hook())]
    kinds = [nudged, *KINDS]
    for number in range(amount):
        kind, shape = kinds[number % len(kinds)], number // len(kinds) + number
        boundary = shapes[shape % len(shapes)]
        points = spread_points(boundary, rng)
        bounds = BOUNDS[int(rng.integers(len(BOUNDS)))]
        handles = Handles.place(boundary, points)
        yield Request(
            f"{kind.__name__} {shape % len(shapes)}",
            Deformer(boundary=boundary, handles=handles, bounds=bounds),
            kind(points, boundary.size, rng),
        )


def nudged(points: Complexes, size: float, rng: np.random.Generator) -> Complexes:
    """Wish two handles a little way off, as most requests do."""
    moved = np.zeros(len(points), dtype=complex)
    moved[rng.choice(len(points), 2)] = rng.uniform(0.03, 0.12) * size
    return points + moved * np.exp(2j * np.pi * rng.random(len(points)))


def curled(points: Complexes, size: float, rng: np.random.Generator) -> Complexes:
    """Bend the plane around a circle, along a random direction."""
    along = np.exp(2j * np.pi * rng.random())
    centre, bend = points.mean(), rng.uniform(2.5, 6.0) / size
    w = (points - centre) / along
    return centre + along * (np.exp(1j * bend * w) - 1) / (1j * bend)


def twisted(points: Complexes, _size: float, rng: np.random.Generator) -> Complexes:
    """Turn the handles around one of them, the more the farther away they are."""
    centre = rng.choice(points)
    away = np.abs(points - centre) / np.abs(points - centre).max()
    return centre + np.exp(1j * rng.choice([-1, 1]) * rng.uniform(1.5, 4.0) * away) * (
        points - centre
    )


def hinged(points: Complexes, _size: float, rng: np.random.Generator) -> Complexes:
    """Turn what is on one side of a line rigidly, as limbs are."""
    side, centre = np.exp(2j * np.pi * rng.random()), rng.choice(points)
    beyond = ((points - centre) / side).real > 0
    turn = np.exp(1j * rng.choice([-1, 1]) * rng.uniform(1.2, 3.0))
    return np.where(beyond, centre + turn * (points - centre), points)


def crossed(points: Complexes, size: float, rng: np.random.Generator) -> Complexes:
    """Wish one handle, the farthest or another, beyond those opposite of it."""
    i = int(rng.choice([np.abs(points - points.mean()).argmax(), rng.integers(len(points))]))
    targets = points.copy()
    targets[i] = 2 * points.mean() - points[i] + 0.1 * size * np.exp(2j * np.pi * rng.random())
    return targets


def mirrored(points: Complexes, _size: float, rng: np.random.Generator) -> Complexes:
    """Wish all handles on the other side of a line, nearly."""
    side = np.exp(2j * np.pi * rng.random())
    return points.mean() + side * (((points - points.mean()) / side).conj()) * rng.uniform(0.6, 1)


def swapped(points: Complexes, _size: float, rng: np.random.Generator) -> Complexes:
    """Let some handles change places."""
    some = rng.choice(len(points), int(rng.integers(2, 5)), replace=False)
    targets = points.copy()
    targets[some] = points[np.roll(some, 1)]
    return targets


def strewn(points: Complexes, size: float, rng: np.random.Generator) -> Complexes:
    """Wish each handle somewhere else."""
    return points + 0.15 * size * (rng.normal(size=len(points)) + 1j * rng.normal(size=len(points)))


KINDS = (curled, hinged, crossed, twisted, strewn, swapped, mirrored)


def spread_points(boundary: Boundary, rng: np.random.Generator) -> Complexes:
    """Return points of a shape that are far from each other."""
    outline = boundary.outline
    low, spread = outline.real.min() + 1j * outline.imag.min(), np.ptp(outline.real)
    box = low + spread * rng.random(4000) + 1j * np.ptp(outline.imag) * rng.random(4000)
    inside = box[contains(outline, box, holes=boundary.loops[1:])]
    chosen = [inside[0]]
    while len(chosen) < HANDLES:
        away = np.abs(inside[:, None] - np.array(chosen)).min(axis=1)
        chosen.append(inside[away.argmax()])
    return np.array(chosen)


def drawn(name: str) -> Boundary:
    """Return the boundary of a sample drawing."""
    picture = decode_picture((sample_images() / f"{name}.png").read_bytes(), "")
    return _boundary(picture.rgba)


def pictured(image: Image.Image) -> Boundary:
    """Return the boundary of what is white in an image."""
    rgba = np.zeros((*np.shape(image), 4), dtype=np.uint8)
    rgba[..., 3] = image
    return _boundary(rgba)


def comb() -> Image.Image:
    """Draw a back with five teeth."""
    image = Image.new("L", (300, 200))
    draw = ImageDraw.Draw(image)
    draw.rectangle((20, 20, 280, 60), fill=255)
    for tooth in range(5):
        draw.rectangle((20 + 58 * tooth, 20, 48 + 58 * tooth, 180), fill=255)
    return image


def hook() -> Image.Image:
    """Draw a long arm that bends twice."""
    image = Image.new("L", (240, 240))
    draw = ImageDraw.Draw(image)
    draw.line([(30, 210), (30, 40), (200, 40), (200, 130), (110, 150)], fill=255, width=28)
    return image


def _boundary(rgba: np.ndarray) -> Boundary:
    domain, _ = build_picture_domain(rgba, triangles=1000, detail="coarse")
    return Boundary.sample(domain)

"""Picture → domain, stage by stage, and the Cauchy coordinates."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from app.cut_out import build_picture_domain, subject_mask
from app.cut_out.matte import matte_picture
from app.storage import decode_picture, sample_images
from engine.domain.meshing.triangulation import triangulate
from engine.domain.outline.enclosure import enclose_subject
from engine.maps import cauchy_coordinates, cauchy_derivatives, evaluate
from tests.bench.memory import most_held
from tests.bench.table import Row, Table, measure


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    triangles: int = 100_000
    stages: tuple[int, ...] = (10_000, 100_000, 1_000_000)  # triangles
    points: int = 50_000


BRIEF = Extent(triangles=1_000, stages=(1_000,), points=500)


def tables(extent: Extent) -> Iterator[Table]:
    """Measure the way from a picture's bytes to its domain."""
    pictures = {path.stem: path.read_bytes() for path in sorted(sample_images().glob("*.png"))}
    yield _samples(pictures, extent.triangles)
    yield _stages(pictures["giraffe"], extent.stages)
    yield _coordinates(extent.points)


def _samples(pictures: dict[str, bytes], triangles: int) -> Table:
    rows = []
    for name, data in pictures.items():

        def build(data: bytes = data) -> None:
            build_picture_domain(
                decode_picture(data, "").rgba, triangles=triangles, detail="normal"
            )

        domain, _ = build_picture_domain(
            decode_picture(data, "").rgba, triangles=1000, detail="normal"
        )
        rows.append(
            Row(
                name=name,
                seconds=measure(build, repeats=3),
                note=f"{len(domain.cage)} cage vertices",
            )
        )
    return Table(title=f"Picture → domain, {triangles:,} triangles", rows=tuple(rows))


def _stages(data: bytes, sizes: tuple[int, ...]) -> Table:
    rgba = decode_picture(data, "").rgba
    subject = subject_mask(rgba)
    outline = enclose_subject(subject.mask, detail="normal").outline
    rows = [
        Row(name="decode", seconds=measure(lambda: decode_picture(data, ""))),
        Row(name="mask", seconds=measure(lambda: subject_mask(rgba))),
        Row(name="matte", seconds=measure(lambda: matte_picture(rgba, subject.mask))),
        Row(
            name="outline and cage",
            seconds=measure(lambda: enclose_subject(subject.mask, detail="normal")),
        ),
    ]
    for count in sizes:
        seconds = measure(partial(triangulate, outline, count), repeats=3)
        rows.append(
            Row(
                name=f"triangulation, {count:,}",
                seconds=seconds,
                note=f"{1e9 * seconds / count:.0f} ns a triangle",
            )
        )
    rows.append(Row(name="until here", seconds=None, note=most_held()))
    return Table(title="Stages for the giraffe", rows=tuple(rows))


def _coordinates(count: int) -> Table:
    cage = 1.2 * np.exp(2j * np.pi * np.arange(100) / 100)
    rng = np.random.default_rng(0)
    points = np.sqrt(rng.random(count)) * np.exp(2j * np.pi * rng.random(count))
    both = np.column_stack([cage**2, cage**3])
    return Table(
        title=f"{count:,} points × 100 cage vertices",
        rows=(
            Row(name="coordinates C", seconds=measure(lambda: cauchy_coordinates(cage, points))),
            Row(name="derivatives D", seconds=measure(lambda: cauchy_derivatives(cage, points))),
            Row(
                name="a map and its derivatives, without C and D",
                seconds=measure(lambda: evaluate(cage, both, points, orders=(0, 1))),
            ),
        ),
    )

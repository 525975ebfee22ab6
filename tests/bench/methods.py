"""Every method of the paper's Figure 9 side by side: a frame against the number of vertices."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from app.document import Baseline, Layer, Variant
from app.motion import (
    MeshFrame,
    PreparedBaseline,
    TriangulatedDomain,
    discrete_harmonic,
    prepare_baseline,
)
from engine.maps import HarmonicMap
from tests.bench.interpolate import bent
from tests.bench.streaming import Interval, posed_giraffe, seconds_played
from tests.bench.table import Row, Table, measure

MIDDLE = 0.5  # of the interval
OURS = (Variant.NU, Variant.SCALED_ETA, Variant.METRIC)
REPEATS = {
    Baseline.SIG13: 1,
    Baseline.FFMP: 1,
    Baseline.HANDLES: 1,
    Baseline.ARAP: 5,
    Baseline.MESH_ETA: 5,
    Baseline.CONFORMAL: 5,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    vertices: tuple[int, ...] = (1_000, 10_000, 50_000, 100_000)
    refined: tuple[int, ...] = (1_000, 4_000, 16_000, 64_000)  # triangles


BRIEF = Extent(vertices=(500,), refined=(1_000, 2_000))


class Cost(NamedTuple):
    """The seconds of a frame, and a remark."""

    seconds: float
    note: str = ""


def tables(extent: Extent) -> Iterator[Table]:
    """Measure a frame by every method at each size, and how scaled η becomes integrable."""
    layer = posed_giraffe().layers[0]
    measured = []
    for vertices in extent.vertices:
        interval = Interval.of(layer, 2 * vertices)
        costs = frame_costs(layer, interval)
        measured.append((len(interval.mesh.vertices), costs))
        rows = [
            Row(name=name, seconds=cost.seconds, note=cost.note) for name, cost in costs.items()
        ]
        title = f"A frame by every method, {len(interval.mesh.vertices):,} vertices"
        yield Table(title=title, rows=tuple(rows))
    yield _ratios(measured)
    yield _refinement(layer, extent.refined)


def frame_costs(layer: Layer, interval: Interval) -> dict[str, Cost]:
    """Return what a frame between the first two keys costs, by the name of the method.

    Parameters
    ----------
    layer : Layer
        With two keys and the handles that made them.
    interval : Interval
        Of these keys, at the vertices of a mesh.
    """
    first, second = (interval.sampler.samples(pose) for pose in (interval.first, interval.second))
    ends = first.positions, second.positions
    costs = {
        "linear": Cost(
            seconds_played(lambda t: (1.0 - t) * ends[0] + t * ends[1]), "in double precision"
        )
    }
    for variant in OURS:
        series = interval.build(variant)
        out = np.empty(series.size, dtype=np.float32)
        costs[f"{variant}, series"] = Cost(
            seconds_played(partial(series.values, out=out)), "positions, as it is played"
        )
        inbetweens = interval.inbetweens(variant)
        costs[f"{variant}, directly"] = Cost(measure(partial(inbetweens.offsets, MIDDLE)))
    for baseline in Baseline:
        prepared = prepared_for(baseline, layer, interval, (first.map, second.map))
        found: list[MeshFrame] = []

        def frame(prepared: PreparedBaseline = prepared, found: list[MeshFrame] = found) -> None:
            found[:] = [prepared.frame(MIDDLE)]

        seconds = measure(frame, repeats=REPEATS[baseline])
        costs[baseline.value] = Cost(seconds, _told(found[0]))
    return costs


def prepared_for(
    baseline: Baseline, layer: Layer, interval: Interval, maps: Sequence[HarmonicMap]
) -> PreparedBaseline:
    """Prepare a method; conformal interpolation gets the giraffe bent, its keys not being so."""
    if baseline is Baseline.CONFORMAL:
        bend = bent(layer.domain.cage)
        still = np.zeros_like(bend.psi)
        maps = (
            HarmonicMap.identity(layer.domain.cage),
            HarmonicMap(cage=bend.cage, phi=bend.phi, psi=still),
        )
    return prepare_baseline(
        baseline,
        maps,
        interval.mesh.vertices,
        interval.mesh.triangles,
        outline=layer.domain.outline,
        handles=[handle.position for handle in layer.handles],
        bounds=layer.bounds,
    )


def _told(frame: MeshFrame) -> str:
    if frame.angle_defect is not None:
        return f"angle defect {frame.angle_defect:.0e}"
    if frame.poisson_error is not None:
        return f"Poisson error {frame.poisson_error:.4f}"
    return ""


def _ratios(measured: Sequence[tuple[int, dict[str, Cost]]]) -> Table:
    """Tell how many frames of the metric variant one of Chen et al. (2013) takes."""
    rows = []
    for vertices, costs in measured:
        chen = costs[Baseline.SIG13.value].seconds
        streamed, directly = (costs[f"metric, {how}"].seconds for how in ("series", "directly"))
        note = f"{chen / streamed:,.0f} times the series, {chen / directly:,.0f} the direct path"
        rows.append(Row(name=f"{vertices:,} vertices", seconds=chen, note=note))
    return Table(title="A frame of Chen et al. (2013), over one of metric", rows=tuple(rows))


def _refinement(layer: Layer, sizes: Sequence[int]) -> Table:
    """Measure the Poisson error with discrete harmonic keyframes on finer and finer meshes."""
    errors: dict[Baseline, list[float]] = {Baseline.MESH_ETA: [], Baseline.ARAP: []}
    counts, rows = [], []
    for triangles in sizes:
        interval = Interval.of(layer, triangles)
        mesh = interval.mesh
        domain = TriangulatedDomain.of(mesh.vertices, mesh.triangles)
        keys = [
            discrete_harmonic(domain, interval.sampler.samples(pose).positions)
            for pose in (interval.first, interval.second)
        ]
        counts.append(len(mesh.triangles))
        for baseline, found in errors.items():
            prepared = prepare_baseline(baseline, keys, mesh.vertices, mesh.triangles)
            found.append(prepared.frame(MIDDLE).poisson_error or 0.0)
        note = ", ".join(f"{name} {found[-1]:.5f}" for name, found in errors.items())
        rows.append(Row(name=f"{counts[-1]:,} triangles", seconds=None, note=note))
    # The size of a triangle is as the root of their number.
    orders = {
        name: -2 * np.polyfit(np.log(counts), np.log(found), 1)[0] for name, found in errors.items()
    }
    note = ", ".join(f"{name} {order:.2f}" for name, order in orders.items())
    rows.append(Row(name="order in the size of a triangle", seconds=None, note=note))
    return Table(title="Poisson error of discrete harmonic keyframes (9.1)", rows=tuple(rows))

"""In-betweens on the direct path: what they cost to prepare and to evaluate, and their memory."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, Self

import numpy as np

from app.cut_out import CutOut, build_picture_domain
from app.storage import decode_picture, sample_images
from engine.arrays import Complexes, Integers
from engine.dirichlet import Extension, HilbertTransform
from engine.domain import MeshedDomain
from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.triangulation import triangulate
from engine.interpolation import (
    Frame,
    Inbetweens,
    KeyframeBlend,
    KeyframeSamples,
    KeyframeSegment,
    SampledDomain,
    Variant,
    prepare_inbetweens,
    sample_domain,
    sample_keyframes,
)
from engine.interpolation.inbetweens import PointValues
from engine.maps import Boundary, Bounds, HarmonicMap, Span
from engine.paths import root_sheets
from engine.sliders import FrameSolver, SliderPoses
from engine.streaming import Positions, Series, build_series, finish
from tests.bench.table import Row, Table, measure

MIDDLE = 0.4  # of the interval
SLIDER_BOUNDS = Bounds(k=0.21, sigma_a=1.75, sigma_b=0.55)  # hardly wider than the bent giraffe
INTEGRATED = (Variant.NU, Variant.ETA, Variant.SCALED_ETA, Variant.METRIC)


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    vertices: int = 50_000
    growth: tuple[int, ...] = (10_000, 50_000, 500_000)  # vertices
    triangles: int = 100_000  # of the ring


BRIEF = Extent(vertices=500, growth=(500,), triangles=1_000)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyframePair:
    """Two keyframes of the giraffe, sampled at the vertices of a mesh."""

    maps: tuple[HarmonicMap, HarmonicMap]
    mesh: Mesh
    sites: SampledDomain
    keyframes: tuple[KeyframeSamples, ...]
    sheets: Integers
    transform: HilbertTransform
    extension: Extension

    @classmethod
    def of(cls, domain: MeshedDomain, vertices: int, transform: HilbertTransform) -> Self:
        """Sample the giraffe and the giraffe bent by a radian and stretched along itself."""
        maps = (HarmonicMap.identity(domain.cage), bent(domain.cage))
        mesh = triangulate(domain.outline, 2 * vertices)
        sites = sites_of(domain, mesh)
        keyframes = sample_keyframes(maps, sites)
        sheets = root_sheets(np.array([key.anchor_fz for key in keyframes]))
        return cls(
            maps=maps,
            mesh=mesh,
            sites=sites,
            keyframes=keyframes,
            sheets=sheets,
            transform=transform,
            extension=transform.at(sites.paths.nodes, single=True),
        )

    def first_keyframe(self) -> tuple[KeyframeSamples, ...]:
        """Sample the first keyframe."""
        return sample_keyframes(self.maps[:1], self.sites)

    def inbetweens(self, variant: Variant) -> Inbetweens:
        """Prepare the interval."""
        keyframe_blend = KeyframeBlend.of(self.keyframes, self.sheets)
        interval = KeyframeSegment(self.sites, keyframe_blend, Bounds(), transform=self.extension)
        return prepare_inbetweens(variant, interval)


def bent(cage: Complexes) -> HarmonicMap:
    """Return a map that bends a shape by a radian over its height, with k = 0.2 everywhere."""
    place = (cage - cage.mean()) / np.ptp(cage.imag)
    phi = np.ptp(cage.imag) * (np.exp(place) - 1)
    return HarmonicMap(cage=cage, phi=phi, psi=0.2 * phi)


def sites_of(domain: MeshedDomain, mesh: Mesh) -> SampledDomain:
    """Lay the paths along the edges of a mesh."""
    return sample_domain(Boundary.sample(domain), mesh.vertices, triangles=mesh.triangles)


def tables(extent: Extent) -> Iterator[Table]:
    """Measure frames and preparation, and how both grow with the number of vertices."""
    picture = decode_picture((sample_images() / "giraffe.png").read_bytes(), "")
    domain, _ = build_picture_domain(picture.rgba, triangles=1000, detail="normal")
    transform = HilbertTransform.on(domain)
    pair = KeyframePair.of(domain, extent.vertices, transform)
    yield _frames(pair)
    yield _preparation(domain, pair)
    yield _growth(domain, [KeyframePair.of(domain, count, transform) for count in extent.growth])
    yield _around_a_hole(extent.triangles)


def _frames(pair: KeyframePair) -> Table:
    first, second = (key.positions for key in pair.keyframes)
    rows = [
        Row(name="linear blend", seconds=measure(lambda: 0.6 * first + 0.4 * second, repeats=50))
    ]
    for variant in INTEGRATED:
        inbetweens = pair.inbetweens(variant)
        seconds = measure(partial(inbetweens.offsets, MIDDLE), repeats=20)
        rows.append(Row(name=f"{variant}, positions", seconds=seconds))
        seconds = measure(partial(inbetweens.frame, MIDDLE), repeats=20)
        rows.append(Row(name=f"{variant}, with f_z and f_z̄", seconds=seconds))
    rows += _slider_frames(pair)
    return Table(title=f"A frame at {len(first):,} vertices, directly", rows=tuple(rows))


def _slider_frames(pair: KeyframePair) -> Iterator[Row]:
    """Measure the second keyframe as the pose of a slider on the first."""
    turns, transform = np.zeros(1, dtype=np.intp), pair.transform
    given = (pair.maps[1:], turns, pair.sites, transform, SLIDER_BOUNDS)
    solver = FrameSolver.of(*given, np.empty(0, dtype=np.complex128))
    poses = SliderPoses.of(pair.keyframes[1:], turns, pair.sites)
    base, ones = pair.inbetweens(Variant.ETA), np.ones(len(solver.nodes), dtype=np.complex128)

    def frame(weight: float) -> Frame:
        solution = solver.solve(np.array([weight]), PointValues(ones, 0 * ones, ones))
        return poses.add_to(base, 0.0, solution, pair.extension).frame()

    for name, weight in (("within the limits", 0.4), ("curbed", 1.3)):
        curbed = solver.solve(np.array([weight]), PointValues(ones, 0 * ones, ones)).curbed
        yield Row(
            name=f"slider, {name}",
            seconds=measure(partial(frame, weight), repeats=20),
            note=f"ln |f_z| curbed by {curbed:.2f}",
        )


def _preparation(domain: MeshedDomain, pair: KeyframePair) -> Table:
    sites, transform = pair.sites, pair.transform
    first, second = (key.positions for key in pair.keyframes)
    nodes = len(transform.nodes)
    rows = [
        Row(name="linear blend of a frame", seconds=measure(lambda: 0.6 * first + 0.4 * second)),
        Row(
            name="paths, once for each mesh",
            seconds=measure(partial(sites_of, domain, pair.mesh), repeats=3),
            note=_megabytes(sites.nbytes),
        ),
        Row(
            name="integral equation, once for each outline",
            seconds=measure(lambda: HilbertTransform.on(domain), repeats=1),
            note=f"{_megabytes(transform.nbytes)}, {nodes:,} nodes, {len(domain.outline)} corners",
        ),
        Row(
            name="Cauchy integrals, once for each mesh",
            seconds=measure(partial(transform.at, sites.paths.nodes, single=True), repeats=3),
            note=f"{_megabytes(pair.extension.nbytes)}, {len(sites.paths.nodes):,} points",
        ),
        Row(
            name="a keyframe",
            seconds=measure(pair.first_keyframe, repeats=3),
            note=_megabytes(pair.keyframes[0].nbytes),
        ),
    ]
    for variant in INTEGRATED:
        seconds = measure(partial(pair.inbetweens, variant), repeats=3)
        note = _megabytes(pair.inbetweens(variant).nbytes)
        rows.append(Row(name=f"an interval, {variant}", seconds=seconds, note=note))
    return Table(title=f"Preparation at {len(first):,} vertices", rows=tuple(rows))


def _growth(domain: MeshedDomain, pairs: Sequence[KeyframePair]) -> Table:
    rows = []
    for pair in pairs:
        count = len(pair.mesh.vertices)
        inbetweens = pair.inbetweens(Variant.METRIC)
        steps = {
            "frame": measure(partial(inbetweens.offsets, MIDDLE)),
            "keyframe": measure(pair.first_keyframe, repeats=1),
            "interval": measure(partial(pair.inbetweens, Variant.METRIC), repeats=1),
            "paths": measure(partial(sites_of, domain, pair.mesh), repeats=1),
        }
        rows += [
            Row(
                name=f"{name}, {count:,} vertices",
                seconds=seconds,
                note=f"{1e9 * seconds / count:.0f} ns a vertex",
            )
            for name, seconds in steps.items()
        ]
    return Table(title="Against the number of vertices, metric", rows=tuple(rows))


def _around_a_hole(triangles: int) -> Table:
    """Measure one motion of the sample's ring, with its hole filled and with its hole kept."""
    picture = decode_picture((sample_images() / "ring.png").read_bytes(), "")
    rings = [
        build_picture_domain(
            picture.rgba, triangles=triangles, detail="normal", cut_out=CutOut(holes=way)
        )[0]
        for way in ("fill", "keep")
    ]
    rows = []
    for variant in INTEGRATED:
        filled, kept = (_HoledPair.of(domain).cost(variant) for domain in rings)
        for name, own in (("filled", filled), ("kept", kept)):
            note = (
                f"{own.interval / filled.interval:.2f} times; "
                f"a keyframe {own.keyframe / filled.keyframe:.2f}, "
                f"a streamed frame {own.frame / filled.frame:.2f} times"
            )
            rows.append(Row(name=f"{variant}, hole {name}", seconds=own.interval, note=note))
    counts = " and ".join(str(len(Span(cage=d.cage, holes=d.holes))) for d in rings)
    title = f"An interval and its series around a hole ({counts} functions of the maps)"
    return Table(title=title, rows=tuple(rows))


class _Cost(NamedTuple):
    """Seconds of a keyframe, of an interval with its series, and of a streamed frame."""

    keyframe: float
    interval: float
    frame: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _HoledPair:
    """The ring at rest and bent, as if it had no hole."""

    maps: tuple[HarmonicMap, HarmonicMap]
    sites: SampledDomain
    extension: Extension

    @classmethod
    def of(cls, domain: MeshedDomain) -> Self:
        """Prepare what the intervals of a ring share."""
        sites = sites_of(domain, domain.mesh)
        transform = HilbertTransform.on(domain)
        whole = bent(domain.cage)
        inside = np.zeros(sum(len(hole.cage) for hole in domain.holes))
        second = HarmonicMap(
            cage=domain.cage,
            phi=np.append(whole.phi, inside),
            psi=np.append(whole.psi, inside),
            holes=domain.holes,
            logs=np.zeros(len(domain.holes), dtype=np.complex128),
        )
        maps = (HarmonicMap.identity(domain.cage, domain.holes), second)
        return cls(maps=maps, sites=sites, extension=transform.at(sites.paths.nodes, single=True))

    def cost(self, variant: Variant) -> _Cost:
        """Measure."""
        keyframes = sample_keyframes(self.maps, self.sites)

        def prepared() -> Series:
            sheets = root_sheets(np.array([key.anchor_fz for key in keyframes]))
            keyframe_blend = KeyframeBlend.of(keyframes, sheets)
            interval = KeyframeSegment(self.sites, keyframe_blend, Bounds(), self.extension)
            inbetweens = prepare_inbetweens(variant, interval)
            return finish(build_series(Positions.of(inbetweens, self.sites)))

        series = prepared()
        out = np.empty(series.size, dtype=np.float32)
        frame = measure(partial(series.values, MIDDLE, out=out), repeats=50)
        keyframe = measure(partial(sample_keyframes, self.maps[1:], self.sites), repeats=5)
        return _Cost(keyframe, measure(prepared, repeats=5), frame)


def _megabytes(count: int) -> str:
    return f"{count / 1e6:.0f} MB"

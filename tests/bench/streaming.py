"""In-betweens as series in time: a frame against a linear blend, and what a series costs."""

import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from app.document import Document, Layer, Meshing, Pose, Variant
from app.motion import PoseSampler
from app.render import Renderer, Scene, fit_view
from app.render.gpu.context import create_context
from app.render.gpu.mesh import GpuMesh, PosedMesh, PositionBuffer
from app.render.gpu.picture import GpuPicture
from app.render.gpu.series_buffer import SeriesBuffer
from app.render.gpu.target import RenderTarget
from app.solving import load_pose_script, pose_document
from app.storage import open_picture, sample_images
from engine.arrays import Singles
from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.triangulation import triangulate
from engine.interpolation import Inbetweens
from engine.maps import distortion
from engine.streaming import Distortions, Positions, Series, build_series, finish
from tests.bench.table import Row, Table, measure

VARIANTS = (Variant.LINEAR, Variant.NU, Variant.ETA, Variant.SCALED_ETA, Variant.METRIC)
# A second of playing: what a frame costs on the way, through all the pieces of a series.
TIMES = tuple((i + 0.5) / 24 for i in range(24))
REPEATS = 9


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    triangles: tuple[int, ...] = (100_000, 1_000_000)
    growth: tuple[int, ...] = (10_000, 100_000, 1_000_000)  # triangles


BRIEF = Extent(triangles=(1_000,), growth=(1_000,))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Interval:
    """The giraffe's first two keys at the vertices of a mesh."""

    sampler: PoseSampler
    first: Pose
    second: Pose
    prepared: dict[Variant, Inbetweens] = field(default_factory=dict)

    @classmethod
    def of(cls, layer: Layer, triangles: int) -> "Interval":
        """Lay the paths of a mesh of so many triangles."""
        mesh = triangulate(layer.domain.outline, triangles)
        sampler = PoseSampler(layer, domain=replace(layer.domain, mesh=mesh))
        return cls(sampler=sampler, first=layer.keys[0].pose, second=layer.keys[1].pose)

    @property
    def mesh(self) -> Mesh:
        """The mesh."""
        return self.sampler.domain.mesh

    def inbetweens(self, variant: Variant) -> Inbetweens:
        """Prepare the direct path, once."""
        if variant not in self.prepared:
            self.prepared[variant] = self.sampler.inbetweens(self.first, self.second, variant)
        return self.prepared[variant]

    def build(self, variant: Variant) -> Series:
        """Build the series of the positions."""
        return finish(build_series(Positions.of(self.inbetweens(variant), self.sampler.sites)))


def tables(extent: Extent) -> Iterator[Table]:
    """Measure frames, building, growth and drawing."""
    layer = posed_giraffe().layers[0]
    for triangles in extent.triangles:
        interval = Interval.of(layer, triangles)
        series = {variant: interval.build(variant) for variant in VARIANTS}
        yield _frames(interval, series)
        if triangles == extent.triangles[0]:
            yield _heat(interval)
            yield _building(interval, series)
            yield _drawing(interval, series)
    yield from _growth([Interval.of(layer, triangles) for triangles in extent.growth])


def posed_giraffe() -> Document:
    """Return the giraffe with its first two keys."""
    folder = sample_images()
    document = open_picture(folder / "giraffe.png", Meshing(triangles=1000)).document
    script = load_pose_script(folder / "giraffe.json")
    (layer,) = script.layers
    short = replace(script, layers=(replace(layer, keys=layer.keys[:2]),))
    posed, _ = pose_document(document, short, lambda _: None)
    return posed


def _frames(interval: Interval, series: dict[Variant, Series]) -> Table:
    count = len(interval.mesh.vertices)
    ends, out = series[Variant.LINEAR].pieces[0].rows, np.empty(2 * count, dtype=np.float32)

    def blend(time: float) -> None:
        np.dot(np.array([1.0 - time, time], dtype=np.float32), ends, out=out)

    variants = VARIANTS[1:]
    linear, by_terms, *played = seconds_side_by_side(
        [
            blend,
            lambda t: np.float32(1 - t) * ends[0] + np.float32(t) * ends[1],
            *(partial(_write, series[variant], out) for variant in variants),
        ]
    )
    rows = [
        Row(name="linear blend, float32", seconds=linear, note="both keyframes in one product"),
        Row(name="linear blend, float32, as a·(1 − t) + b·t", seconds=by_terms),
    ]
    for variant, seconds in zip(variants, played, strict=True):
        direct = measure(partial(interval.inbetweens(variant).offsets, 0.6))
        note = f"the direct path takes {direct / seconds:.0f} times as long"
        rows.append(Row(name=f"series, {variant}", seconds=seconds, note=note))
    triangles = len(interval.mesh.triangles)
    return Table(title=f"A frame of {triangles:,} triangles ({count:,} vertices)", rows=tuple(rows))


def _write(series: Series, out: Singles, time: float) -> None:
    series.values(time, out=out)


def _heat(interval: Interval) -> Table:
    rows = []
    for variant in VARIANTS[1:]:
        inbetweens = interval.inbetweens(variant)
        series = finish(build_series(Distortions.of(inbetweens, interval.sampler.sites)))
        rows += [
            Row(
                name=f"{variant}, series",
                seconds=seconds_played(partial(_streamed_k, series)),
                note=_extent(series, len(interval.mesh.vertices)),
            ),
            Row(
                name=f"{variant}, direct path",
                seconds=measure(partial(_direct_k, inbetweens, 0.6)),
            ),
        ]
    return Table(title="k of a frame, for the heat map", rows=tuple(rows))


def _streamed_k(series: Series, time: float) -> None:
    fz, fzbar = series.values(time).view(np.complex64).reshape(2, -1)
    np.abs(fzbar) / np.abs(fz)


def _direct_k(inbetweens: Inbetweens, time: float) -> None:
    frame = inbetweens.frame(time)
    distortion.k(frame.fz, frame.fzbar)


def _building(interval: Interval, series: dict[Variant, Series]) -> Table:
    diameter, count = interval.sampler.sites.diameter, len(interval.mesh.vertices)
    rows = [
        Row(
            name=variant,
            seconds=measure(partial(interval.build, variant), repeats=3),
            note=f"{_extent(found, count)}, error {found.error / diameter:.1e} of the diameter",
        )
        for variant, found in series.items()
    ]
    return Table(title="Building the series of an interval", rows=tuple(rows))


def _extent(series: Series, count: int) -> str:
    rows = "+".join(str(len(piece.rows)) for piece in series.pieces)
    return f"{series.nbytes / count:.0f} bytes a vertex, rows {rows}"


def _growth(intervals: list[Interval]) -> Iterator[Table]:
    frames, builds = [], []
    for interval in intervals:
        series = interval.build(Variant.METRIC)
        out = np.empty(series.size, dtype=np.float32)
        frames.append(seconds_played(partial(_write, series, out)))
        builds.append(measure(partial(interval.build, Variant.METRIC), repeats=1))
    for title, times in (("A frame", frames), ("Building the series", builds)):
        rows = [
            Row(
                name=f"{len(interval.mesh.triangles):,} triangles",
                seconds=seconds,
                note=f"{1e9 * seconds / len(interval.mesh.vertices):.3g} ns a vertex",
            )
            for interval, seconds in zip(intervals, times, strict=True)
        ]
        yield Table(title=f"{title} against the number of vertices, metric", rows=tuple(rows))


def _drawing(interval: Interval, series: dict[Variant, Series]) -> Table:
    """Measure the vertex sampler: frames so small that hardly a pixel is painted."""
    mesh = interval.mesh
    context = create_context()
    renderer = Renderer(context)
    picture = GpuPicture(context, np.full((1000, 1000, 4), 255, dtype=np.uint8))
    gpu = GpuMesh(renderer.programs, picture, rest=mesh.vertices, triangles=mesh.triangles)
    target = RenderTarget(renderer.programs, (8, 8))
    view = fit_view(0j, 1000 + 1000j, target.size)
    rows = []
    for variant, found in series.items():
        by_shader = SeriesBuffer(
            context, len(mesh.vertices), max(len(piece.rows) for piece in found.pieces)
        )
        streamed = PositionBuffer(context, len(mesh.vertices))
        poses = PosedMesh(gpu, by_shader), PosedMesh(gpu, streamed)
        scenes = [Scene(meshes=(pose,)) for pose in poses]

        def shade(time: float, source: SeriesBuffer = by_shader, series: Series = found) -> None:
            source.place(series, time)

        def write(time: float, source: PositionBuffer = streamed, series: Series = found) -> None:
            source.write(series.values(time).reshape(-1, 2))

        for name, place, scene in (
            ("by the shader", shade, scenes[0]),
            ("by the processor", write, scenes[1]),
        ):

            def draw(
                time: float, place: Callable[[float], None] = place, scene: Scene = scene
            ) -> None:
                place(time)
                renderer.draw(target, view, scene)
                context.finish()

            rows.append(Row(name=f"{variant}, {name}", seconds=seconds_played(draw)))
        for pose in poses:
            pose.release()
    title = f"Vertices of {len(mesh.triangles):,} triangles placed, {context.info['GL_RENDERER']}"
    for owner in (target, gpu, picture, renderer, context):
        owner.release()
    return Table(title=title, rows=tuple(rows))


def seconds_played(frame: Callable[[float], object]) -> float:
    """Return the seconds of a frame while an interval plays."""

    def play() -> None:
        for time in TIMES:
            frame(time)

    return measure(play, repeats=REPEATS) / len(TIMES)


def seconds_side_by_side(frames: Sequence[Callable[[float], object]]) -> list[float]:
    """Return the same of several, by turns: what slows a machine for a while slows them all."""
    rounds = [[seconds_played(frame) for frame in frames] for _ in range(REPEATS)]
    return [statistics.median(each) for each in zip(*rounds, strict=True)]

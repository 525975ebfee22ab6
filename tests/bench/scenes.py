"""Scenes: opening a drawing on many layers, and many layers beside one of as many triangles."""

import io
import math
import tempfile
import time
import tracemalloc
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from app.document import Document, Layer, Meshing, PictureFile, Pose, Variant, clip_of
from app.editor import LayerRuntime
from app.editor.actions.project_files import files
from app.storage import Picture, decode_picture, load_project, open_layered, sample_images
from engine.arrays import Complexes
from engine.domain import Domain, MeshedDomain
from tests.bench.memory import most_held
from tests.bench.stage.driver import REACH, Driver, dragging, playing
from tests.bench.table import Row, Table, row_of

SAMPLE = "giraffe.lissom"
ARMS = 5
GRAIN = 6  # levels: flat colours would be read too fast


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    layers: int = 20
    side: int = 2_000  # pixels, of a layer
    posed: int = 10
    triangles: int = 20_000  # of each
    frames: int = 40
    reach: float = REACH  # pixels around it in which a handle is dragged


BRIEF = Extent(layers=2, side=160, posed=1, triangles=1_000, frames=2, reach=4.0)


def tables(extent: Extent) -> Iterator[Table]:
    """Measure scenes as a window has them, without a display."""
    with tempfile.TemporaryDirectory() as folder:
        yield _opening(Path(folder), extent)
        yield _beside_one(Path(folder), extent)
    yield _memory(extent)


def _opening(folder: Path, extent: Extent) -> Table:
    """Measure from a file on the disk to layers that can be drawn."""
    path = folder / "scene.ora"
    _write_drawing(path, extent)
    begun = time.perf_counter()
    opened = open_layered(path, Meshing())
    read = time.perf_counter() - begun
    files.with_layer_runtimes(opened)
    shown = time.perf_counter() - begun
    return Table(
        title=f"Opening an .ora of {extent.layers} layers of {extent.side:,} pixels, on all cores",
        rows=(
            Row(name="read, outlined and triangulated", seconds=read),
            Row(name="and ready to be drawn", seconds=shown),
            Row(name="until here", seconds=None, note=most_held()),
        ),
    )


def _write_drawing(path: Path, extent: Extent) -> None:
    """Write a drawing of bodies with arms, each on a layer of the size of the canvas."""
    rng = np.random.default_rng(0)
    side = extent.side
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", "image/openraster")
        names = [f"data/{number}.png" for number in range(extent.layers)]
        stack = "".join(f'<layer name="{name}" src="{name}"/>' for name in names)
        archive.writestr(
            "stack.xml", f'<image w="{side}" h="{side}"><stack>{stack}</stack></image>'
        )
        for name in names:
            image = Image.new("L", (side, side))
            draw = ImageDraw.Draw(image)
            middle = side * (0.5 + 0.1 * rng.normal()) * (1 + 1j)
            for turn in 2 * np.pi * (rng.random() + np.arange(ARMS)) / ARMS:
                end = middle + 0.3 * side * np.exp(1j * turn)
                ends = (middle.real, middle.imag, end.real, end.imag)
                draw.line(ends, fill=255, width=round(0.07 * side))
            radius = 0.12 * side * (1 + 1j)
            low, high = middle - radius, middle + radius
            draw.ellipse((low.real, low.imag, high.real, high.imag), fill=255)
            alpha = np.asarray(image)[..., None]
            grain = rng.integers(0, GRAIN, (side, side, 3), dtype=np.uint8)
            colours = (rng.integers(40, 200, 3, dtype=np.uint8) + grain) * (alpha > 0)
            file = io.BytesIO()
            Image.fromarray(np.dstack([colours, alpha])).save(file, "PNG")
            archive.writestr(name, file.getvalue())


def _beside_one(folder: Path, extent: Extent) -> Table:
    """Play and drag one layer, and then several of as many triangles together."""
    stage = Driver(folder)
    rows = []
    for count, triangles in (
        (1, extent.posed * extent.triangles),
        (extent.posed, extent.triangles),
    ):
        document, picture = _giraffes(count, triangles)
        puppets = {
            each.id: LayerRuntime.of(clip_of(document, each.id), picture, among=count)
            for each in document.layers
        }
        files.install_opened_file(
            stage.session, folder / SAMPLE, files.OpenedFile(document, puppets, ())
        )
        stage.settle()
        what = f"{count} of {triangles:,} triangles"
        runs = {
            "playing": playing(stage, extent.frames),
            "dragging": dragging(stage, extent.frames, extent.reach),
        }
        rows += [
            (f"{way}, {what}", [frame.whole for frame in frames]) for way, frames in runs.items()
        ]
    return Table(
        title=f"A frame by the clock until all of it is drawn, {stage.device}",
        rows=tuple(row_of(*rows[place]) for place in (0, 2, 1, 3)),
    )


def _giraffes(count: int, triangles: int) -> tuple[Document, Picture]:
    """Return so many animated giraffes side by side, which together are as large as one."""
    document = load_project(sample_images() / SAMPLE)
    first = document.layers[0]
    scale = 1 / math.ceil(math.sqrt(count))
    small = Image.fromarray(decode_picture(first.picture.data, SAMPLE).rgba)
    small = small.resize([round(scale * side) for side in small.size])
    data = io.BytesIO()
    small.save(data, "PNG")
    file = PictureFile(data=data.getvalue(), suffix=".png", size=small.size)
    layers = tuple(
        _smaller(first, file, scale, number, triangles=triangles) for number in range(count)
    )
    changed = replace(document, layers=layers, size=document.canvas)
    return changed, decode_picture(file.data, SAMPLE)


def _smaller(
    layer: Layer, file: PictureFile, scale: float, number: int, *, triangles: int
) -> Layer:
    """Return a layer of this number, with a mesh of its own, in its place among others."""
    row, column = divmod(number, round(1 / scale))
    corner = complex(column * file.size[0], row * file.size[1])

    def place(points: Complexes) -> Complexes:
        return scale * points + corner

    def pose(full: Pose) -> Pose:
        targets = {
            identity: replace(target, position=scale * target.position + corner)
            for identity, target in full.targets.items()
        }
        return replace(full, phi=place(full.phi), psi=scale * full.psi, targets=targets)

    outline = place(layer.domain.outline)
    domain = MeshedDomain.of(Domain(outline, place(layer.domain.cage)), triangles)
    return replace(
        layer,
        id=number,
        name=f"giraffe {number}",
        picture=file,
        corner=corner,
        domain=domain,
        anchor=None if layer.anchor is None else scale * layer.anchor + corner,
        handles=tuple(
            replace(handle, position=scale * handle.position + corner) for handle in layer.handles
        ),
        keys=tuple(replace(key, pose=pose(key.pose)) for key in layer.keys),
        library=(),
        # Whose in-betweens are soon prepared; frames take no longer with others.
        variant=Variant.NU,
    )


def _memory(extent: Extent) -> Table:
    """Tell what layers take with their in-betweens, beside the picture that they share."""
    rows = []
    for count in sorted({1, max(1, extent.posed // 2), extent.posed}):
        document, picture = _giraffes(count, extent.triangles)
        tracemalloc.start()
        kept = []
        for layer in document.layers:
            clip = clip_of(document, layer.id)
            puppet = LayerRuntime.of(clip, picture)
            store = puppet.store
            store.set_needed_clips([clip], [], 0)
            store.add(store.segments_job(clip, store.missing_segments(clip, 0))())
            kept.append(store)
        used = tracemalloc.get_traced_memory()[0] / 2**20
        tracemalloc.stop()
        note = f"{used:.1f} MiB, {used / count:.1f} each"
        rows.append(Row(name=f"{count} of {extent.triangles:,} triangles", seconds=None, note=note))
    return Table(title="Memory of layers with their in-betweens", rows=tuple(rows))

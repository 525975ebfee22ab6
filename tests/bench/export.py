"""Exports: frames per second and where their time goes, start-up, and memory."""

import io
import json
import struct
import sys
import tempfile
import time
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image

from app.cut_out import build_picture_domain
from app.document import (
    Document,
    ExportSettings,
    FrameRange,
    Keyframe,
    Meshing,
    PictureFile,
    new_layer,
)
from app.errors import install_hint
from app.export import ExportRequest, FrameRenderer, plan_export
from app.export.writers.png import encode_png
from app.export_formats import EXPORT_FORMATS
from app.motion import Evaluator, bounding_box
from app.render import Renderer
from app.render.gpu.context import create_context
from app.render.gpu.target import RenderTarget
from app.storage import decode_picture, load_project, sample_images, save_project
from engine.arrays import Complexes
from tests.bench.memory import Run, run_measured
from tests.bench.table import Row, Table, measure

FULL_HD, FOUR_K = (1920, 1080), (3840, 2160)


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    triangles: int = 100_000
    frames: int = 24
    large_frames: int = 300
    formats: tuple[str, ...] = tuple(EXPORT_FORMATS)
    pinned: tuple[str, str] = ("giraffe", "0:71")
    repeats: int = 3


BRIEF = Extent(
    triangles=1_000, frames=2, large_frames=2, formats=("glb",), pinned=("ring", "1:2"), repeats=1
)


def tables(extent: Extent) -> Iterator[Table]:
    """Measure exports of the giraffe as it turns and bends."""
    yield _speed(extent)
    with tempfile.TemporaryDirectory() as folder:
        yield _processes(Path(folder), extent)
        yield _formats(Path(folder), extent.formats)
        yield _pinned(Path(folder), *extent.pinned, extent.repeats)


def _speed(extent: Extent) -> Table:
    document = _bending_giraffe(FULL_HD, extent.triangles, frames=extent.frames)
    layer = document.layers[0]
    pictures = {layer.id: decode_picture(layer.picture.data, "").rgba}
    context = create_context()
    evaluator = Evaluator.exact(document)
    middle = float((extent.frames - 1) // 2)
    places = evaluator.evaluate(document, middle).layers[layer.id].scene_positions
    with tempfile.TemporaryDirectory() as folder:
        request = ExportRequest(out=Path(folder), settings=document.export, project="giraffe")
        plan = plan_export(document, request, evaluator)
        start = time.process_time()
        painter = FrameRenderer(context, document, pictures, evaluator, plan)
        posed = painter.pose(middle)
        frame = painter.draw(posed)
        begun = time.process_time() - start

        def make_all() -> None:
            deque(painter.run(), maxlen=0)

        each = measure(make_all, repeats=3, clock=time.perf_counter) / len(plan.times)
        worked = measure(make_all, repeats=3) / len(plan.times)
        interpolated = measure(lambda: painter.pose(middle))
        drawn = measure(lambda: painter.draw(posed))
        encoded = measure(lambda: encode_png(frame))
    target = RenderTarget(Renderer(context).programs, FULL_HD)
    seen = _part_around(plan.view.to_pixels(places))
    read = measure(lambda: target.read_straight_rgba(seen))
    context.release()
    fewer = len(posed.vertices[0].triangles)
    return Table(
        title="PNG frames of 1920 × 1080 pixels, the processor's time, "
        f"{extent.triangles:,} triangles",
        rows=(
            Row(name="a frame, by the clock", seconds=each, note=f"{1 / each:.1f} a second"),
            Row(name="a frame", seconds=worked, note="on all cores"),
            Row(name="interpolate", seconds=interpolated, note="on a thread beside"),
            Row(name="draw", seconds=drawn - read, note=f"{fewer:,} triangles that show the same"),
            Row(name="read", seconds=read),
            Row(name="encode", seconds=encoded, note="on two threads beside"),
            Row(name="begin", seconds=begun, note="once an export, with its first frame"),
        ),
    )


def _part_around(points: Complexes) -> tuple[int, int, int, int]:
    """Return left, top, width and height of the pixels that points (n,) of a frame span."""
    box = bounding_box(points)
    size = box.upper - box.lower
    return int(box.lower.real), int(box.lower.imag), int(size.real), int(size.imag)


def _processes(folder: Path, extent: Extent) -> Table:
    small, large = folder / "small.lissom", folder / "large.lissom"
    save_project(small, _bending_giraffe((480, 270), extent.triangles))
    save_project(large, _bending_giraffe(FOUR_K, extent.triangles, frames=extent.large_frames))
    helped = _export("--help")
    started = _export(str(small), "--out", str(folder / "one"))
    exported = _export(str(large), "--out", str(folder / "many"))
    return Table(
        title="lissom export as a process, by the clock",
        rows=(
            Row(name="--help", seconds=helped.seconds),
            Row(name="one frame of 480 × 270 pixels", seconds=started.seconds),
            Row(
                name=f"{extent.large_frames} frames of 3840 × 2160 pixels",
                seconds=exported.seconds,
                note=exported.memory,
            ),
        ),
    )


def _formats(folder: Path, names: tuple[str, ...]) -> Table:
    """Measure every format of one file on the animated giraffe, in frames that suit a web page."""
    project = sample_images() / "giraffe.lissom"
    rows = []
    for name in names:
        format_ = EXPORT_FORMATS[name]
        if not format_.suffixes or (format_.extra and install_hint(format_.extra)):
            continue
        out = folder / f"{name}{format_.suffixes[0]}"
        words = ["--format", name] if name == "glb" else ["--format", name, "--size", "480x464"]
        words += [] if format_.is_transparent else ["--background", "#ffffff"]
        seconds = _export(str(project), "--out", str(out), *words).seconds
        note = f"{out.stat().st_size / 1000:,.0f} KB"
        if name == "glb":
            note += f", {_without_texture(out.read_bytes()) / 1000:,.0f} KB without the texture"
        rows.append(Row(name=name, seconds=seconds, note=note))
    return Table(title="the giraffe's 3 s in every format, by the clock", rows=tuple(rows))


def _pinned(folder: Path, name: str, frames: str, repeats: int) -> Table:
    """Measure an export of a sample without auto-pins and with them, by turns."""
    document = load_project(sample_images() / f"{name}.lissom")
    words = {False: "without auto-pins", True: "with auto-pins"}
    for pinned in words:
        layers = tuple(replace(each, has_auto_pins=pinned) for each in document.layers)
        save_project(folder / f"{pinned}.lissom", replace(document, layers=layers))
    runs = [
        (pinned, _export(str(folder / f"{pinned}.lissom"), "--frames", frames, "--out", str(out)))
        for number in range(repeats)
        for pinned, out in ((each, folder / f"{each} {number}") for each in words)
    ]
    rows = []
    for pinned, row in words.items():
        best = min((run for own, run in runs if own is pinned), key=lambda run: run.seconds)
        rows.append(Row(name=row, seconds=best.seconds, note=best.memory))
    return Table(title=f"PNG frames {frames} of the sample {name}, by the clock", rows=tuple(rows))


def _without_texture(glb: bytes) -> int:
    """Return the bytes of a glTF file but for its pictures."""
    (length,) = struct.unpack_from("<I", glb, 12)
    content = json.loads(glb[20 : 20 + length])
    views = [content["bufferViews"][image["bufferView"]] for image in content["images"]]
    return len(glb) - sum(int(view["byteLength"]) for view in views)


def _bending_giraffe(size: tuple[int, int], triangles: int, *, frames: int = 1) -> Document:
    """Return the giraffe on a canvas, as it was drawn in frame 0, turned and bent in the last."""
    with Image.open(sample_images() / "giraffe.png") as drawing:
        giraffe = drawing.convert("RGBA")
    scale = 0.95 * size[1] / giraffe.height
    giraffe = giraffe.resize((round(scale * giraffe.width), round(scale * giraffe.height)))
    canvas = Image.new("RGBA", size)
    canvas.paste(giraffe, ((size[0] - giraffe.width) // 2, (size[1] - giraffe.height) // 2))
    stream = io.BytesIO()
    canvas.save(stream, "PNG", compress_level=1)
    file = PictureFile(data=stream.getvalue(), suffix=".png", size=size)
    domain, _ = build_picture_domain(np.asarray(canvas), triangles=triangles, detail="normal")
    layer = new_layer(file, domain, Meshing())
    first = layer.keys[0]
    z = domain.cage - complex(*size) / 2
    # |f_z| stays within half of 1 around it.
    bent = replace(
        first.pose, phi=first.pose.phi + z * (np.exp(0.3j) - 1) + z**2 / np.abs(z).max() / 8
    )
    last = frames - 1
    keys = (first, Keyframe(frame=last, pose=bent)) if last else (first,)
    return Document(
        layers=(replace(layer, keys=keys),),
        frames=FrameRange(0, last),
        export=ExportSettings(framing="canvas"),
    )


def _export(*words: str) -> Run:
    return run_measured(sys.executable, "-m", "app", "export", *words)

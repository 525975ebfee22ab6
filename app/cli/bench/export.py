"""Exports: frames per second and where their time goes, start-up, and memory."""

import io
import json
import struct
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from app.cli.bench.table import Row, Table, measure
from app.document import (
    Document,
    ExportSettings,
    FrameRange,
    Keyframe,
    Meshing,
    PictureFile,
    clip_of,
    new_figure,
)
from app.export import (
    ExportRequest,
    KeptPoses,
    Painter,
    encode_png,
    export,
    missing,
    plan_export,
)
from app.export_formats import EXPORT_FORMATS
from app.motion import Animation, box_around
from app.render import Renderer
from app.render.gpu import RenderTarget, create_context
from app.storage import decode_picture, sample_images, save_project
from engine.arrays import Complexes
from engine.domain import build_domain

FULL_HD, FOUR_K = (1920, 1080), (3840, 2160)
TRIANGLES = 100_000


def tables() -> Iterator[Table]:
    """Measure exports of the giraffe as it turns and bends."""
    yield _speed()
    with tempfile.TemporaryDirectory() as folder:
        yield _processes(Path(folder))
        yield _formats(Path(folder))


def _speed() -> Table:
    document = _bending_giraffe(FULL_HD, last=23)
    figure = document.figures[0]
    pictures = {figure.id: decode_picture(figure.picture.data, "").rgba}
    context = create_context()
    poses = {figure.id: KeptPoses(Animation(clip_of(document, figure.id)))}
    places = poses[figure.id].positions(11.0)
    with tempfile.TemporaryDirectory() as folder:
        request = ExportRequest(out=Path(folder), settings=document.export, project="giraffe")
        plan = plan_export(document, request, poses)
        start = time.process_time()
        painter = Painter(context, document, pictures, poses, plan)
        posed = painter.pose(11.0)
        frame = painter.draw(posed)
        begun = time.process_time() - start

        def make_all() -> None:
            deque(export(plan, painter.pose, painter.draw), maxlen=0)

        each = _by_the_clock(make_all) / len(plan.times)
        worked = measure(make_all, repeats=3) / len(plan.times)
        interpolated = measure(lambda: painter.pose(11.0))
        drawn = measure(lambda: painter.draw(posed))
        encoded = measure(lambda: encode_png(frame))
    target = RenderTarget(Renderer(context).programs, FULL_HD)
    seen = _part_around(plan.view.to_pixels(places))
    read = measure(lambda: target.read_straight_rgba(seen))
    context.release()
    fewer = len(posed.vertices[0].triangles)
    return Table(
        title=f"PNG frames of 1920 × 1080 pixels, {TRIANGLES:,} triangles, the processor's time",
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
    box = box_around(points)
    size = box.upper - box.lower
    return int(box.lower.real), int(box.lower.imag), int(size.real), int(size.imag)


def _processes(folder: Path) -> Table:
    small, large = folder / "small.lissom", folder / "large.lissom"
    save_project(small, _bending_giraffe((480, 270), last=0))
    save_project(large, _bending_giraffe(FOUR_K, last=299))
    helped, _ = _run("export", "--help")
    started, _ = _run("export", str(small), "--out", str(folder / "one"))
    exported, peak = _run("export", str(large), "--out", str(folder / "many"))
    return Table(
        title="lissom export as a process, by the clock",
        rows=(
            Row(name="--help", seconds=helped),
            Row(name="one frame of 480 × 270 pixels", seconds=started),
            Row(
                name="300 frames of 3840 × 2160 pixels",
                seconds=exported,
                note=f"{peak / 2**30:.2f} GiB of memory at most",
            ),
        ),
    )


def _formats(folder: Path) -> Table:
    """Measure every format of one file on the animated giraffe, in frames that suit a web page."""
    project = sample_images() / "giraffe.lissom"
    rows = []
    for name, format_ in EXPORT_FORMATS.items():
        if not format_.suffixes or missing(name):
            continue
        out = folder / f"{name}{format_.suffixes[0]}"
        words = ["--format", name] if name == "glb" else ["--format", name, "--size", "480x464"]
        words += [] if format_.is_transparent else ["--background", "#ffffff"]
        seconds, _ = _run("export", str(project), "--out", str(out), *words)
        note = f"{out.stat().st_size / 1000:,.0f} KB"
        if name == "glb":
            note += f", {_without_texture(out.read_bytes()) / 1000:,.0f} KB without the texture"
        rows.append(Row(name=name, seconds=seconds, note=note))
    return Table(title="the giraffe's 3 s in every format, by the clock", rows=tuple(rows))


def _without_texture(glb: bytes) -> int:
    """Return the bytes of a glTF file but for its pictures."""
    (length,) = struct.unpack_from("<I", glb, 12)
    content = json.loads(glb[20 : 20 + length])
    views = [content["bufferViews"][image["bufferView"]] for image in content["images"]]
    return len(glb) - sum(int(view["byteLength"]) for view in views)


def _bending_giraffe(size: tuple[int, int], *, last: int) -> Document:
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
    domain, _ = build_domain(np.asarray(canvas), triangles=TRIANGLES, detail="normal")
    figure = new_figure(file, domain, Meshing())
    first = figure.keys[0]
    z = domain.cage - complex(*size) / 2
    # |f_z| stays within half of 1 around it.
    bent = replace(
        first.pose, phi=first.pose.phi + z * (np.exp(0.3j) - 1) + z**2 / np.abs(z).max() / 8
    )
    keys = (first, Keyframe(frame=last, pose=bent)) if last else (first,)
    return Document(
        figures=(replace(figure, keys=keys),),
        frames=FrameRange(0, last),
        export=ExportSettings(framing="canvas"),
    )


def _by_the_clock(function: Callable[[], object]) -> float:
    return measure(function, repeats=3, clock=time.perf_counter)


# A process that is started takes over the largest memory of the one that starts it, and this one
# may have held more than what it measures.
MEASURED = """
import resource, subprocess, sys, time
begun = time.perf_counter()
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
print(time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def _run(*words: str) -> tuple[float, int]:
    """Run the program; return its seconds and the largest memory that it held, in bytes."""
    told = subprocess.run(  # noqa: S603 - this program itself
        [sys.executable, "-c", MEASURED, sys.executable, "-m", "app", *words],
        stdout=subprocess.PIPE,
        check=True,
    )
    seconds, kilobytes = told.stdout.split()
    return float(seconds), 1024 * int(kilobytes)

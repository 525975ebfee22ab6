"""The window: its start, the way from a picture to a drag, its frames, and its latency."""

import statistics
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from app.cli.process import set_switch_interval
from app.document import Meshing, Target, Variant, clip_of
from app.editor import LayerRuntime, Project
from app.editor.actions import playback
from app.editor.actions.project_files import files
from app.storage import decode_picture, load_project, sample_images
from app.ui.window.memory import limit_arenas
from app.ui.window.window import SIZE
from engine.domain import mesh_inside
from tests.bench.stage import crowded, idle, start
from tests.bench.stage.driver import (
    REACH,
    Driver,
    HandleDrag,
    dragging,
    handle_place,
    playing,
    scrubbing,
    still,
)
from tests.bench.table import Row, Table, row_at_most, row_of

TABS = ("Handle", "Layers", "Animate", "Shape", "Export", "Measure")
HARD = 6.0  # how much farther a hard pull goes
LATER = 20  # pictures that are shown while a hand goes from a handle to the timeline


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    sample: str = "giraffe.lissom"
    picture: str = "dragon.png"  # that is opened
    triangles: int = 100_000
    repeats: int = 3  # of the start, of opening, and of releases
    frames: int = 60
    moves: int = 100  # of the pointer
    reach: float = REACH  # pixels around it in which a handle is dragged
    idle: float = 10.0  # seconds in which nobody touches the window
    size: tuple[int, int] = SIZE
    variant: Variant = Variant.METRIC
    crowd: int = 10_000  # keys, or markers, of a drawing


BRIEF = Extent(
    sample="ring.lissom",
    picture="bar.png",
    triangles=1_000,
    repeats=1,
    frames=2,
    moves=2,
    reach=4.0,
    idle=0.1,
    size=(640, 440),
    variant=Variant.NU,
    crowd=50,
)


def tables(extent: Extent) -> Iterator[Table]:
    """Measure the window without a display, on whatever draws here; its start also on one."""
    set_switch_interval()
    limit_arenas()
    yield start.table(extent.repeats)
    with tempfile.TemporaryDirectory() as folder:
        stage = Driver(Path(folder), extent.size)
        yield _opening(stage, extent)
        stage.settle()
        files.install_opened_file(stage.session, Path(folder) / extent.sample, _sample(extent))
        stage.settle()
        yield from _frames(stage, extent)
        yield _latency(stage, extent)
        yield _release(stage, extent)
        yield _playhead(stage, extent)
        yield crowded.table(stage, Path(folder), extent.crowd, extent.frames)
    yield idle.table(extent.idle)


def _opening(stage: Driver, extent: Extent) -> Table:
    """Measure from a dropped picture to a drag."""
    stage.session.settings.default_meshing = Meshing(triangles=extent.triangles)
    path = sample_images() / extent.picture
    times = [_open_and_drag(stage, path, extent.reach) for _ in range(extent.repeats)]
    names = ("until a click adds a handle", "until that handle has followed the pointer")
    triangles = len(stage.project.layer.domain.mesh.triangles)
    return Table(
        title=f"From a dropped picture ({extent.picture}, {triangles:,} triangles) to a drag",
        rows=tuple(map(row_at_most, names, zip(*times, strict=True))),
    )


def _open_and_drag(stage: Driver, path: Path, reach: float) -> tuple[float, float]:
    session = stage.session
    stage.mouse(0j)
    session.project = None
    stage.settle()
    begun = time.perf_counter()
    stage.ask(files.open_file, path)
    stage.until(
        lambda: session.project is not None and session.project.layer_runtime.shown is not None
    )
    # What is drawn from now on takes the pointer.
    stage.refresh()
    shown = time.perf_counter() - begun
    project = stage.project
    vertices = project.layer.domain.mesh.vertices
    inside = complex(vertices[np.argmin(abs(vertices - vertices.mean()))])
    point = stage.point(inside)
    stage.mouse(point)
    stage.refresh()
    stage.mouse(point, down=True)
    stage.until(lambda: bool(project.layer.handles))
    stage.mouse(point + reach)
    stage.until(lambda: abs(handle_place(project) - inside) > 1.0)
    followed = time.perf_counter() - begun
    stage.mouse(point + reach, down=False)
    stage.settle()
    return shown, followed


def _sample(extent: Extent) -> files.OpenedFile:
    """Return the animated sample on a finer mesh."""
    document = load_project(sample_images() / extent.sample)
    layer = document.layers[0]
    mesh = mesh_inside(layer.domain, triangles=extent.triangles)
    domain = replace(layer.domain, mesh=mesh)
    layer = replace(layer, domain=domain, variant=extent.variant)
    document = document.with_layer(layer)
    picture = decode_picture(layer.picture.data, extent.sample)
    puppet = LayerRuntime.of(clip_of(document, layer.id), picture)
    return files.OpenedFile(document, {layer.id: puppet}, ())


def _frames(stage: Driver, extent: Extent) -> Iterator[Table]:
    """Measure frames of everything that a person does."""
    count = extent.frames
    runs = {
        "nothing moves": still(stage, count),
        f"playing, {extent.variant}": playing(stage, count),
        "scrubbing": scrubbing(stage, count),
        "dragging a handle": dragging(stage, count, extent.reach),
    }
    triangles = len(stage.project.layer.domain.mesh.triangles)
    what = "{:,} triangles, {} × {} pixels".format(triangles, *extent.size)
    yield Table(
        title=f"A frame by the clock until all of it is drawn: {what}, {stage.device}",
        rows=tuple(row_of(name, [frame.whole for frame in run]) for name, run in runs.items()),
    )
    for title in TABS:
        stage.show_tab(title)
        runs |= {
            f"{title} in front, nothing moves": still(stage, count // 2),
            f"{title} in front, playing": playing(stage, count // 2),
        }
    yield Table(
        title=f"The interface's own part of a frame, processor time of its thread: {what}",
        rows=tuple(row_of(name, [frame.own for frame in run]) for name, run in runs.items()),
    )


def _release(stage: Driver, extent: Extent) -> Table:
    """Measure from letting a handle go to a pose that rests, and to the in-betweens around it."""
    times: list[list[float]] = []
    for number in range(extent.repeats):
        drag = HandleDrag(stage, extent.reach)
        for move in range(10):
            drag.move(20 * number + move)
            stage.refresh()
        let_go = time.perf_counter()
        drag.let_go()
        stage.refresh()
        marks = []
        for is_done in (_rests, _is_exact, _is_fine):
            stage.until(partial(is_done, stage.project))
            marks.append(time.perf_counter() - let_go)
        times.append(marks)
        stage.settle()
    names = (
        "until the pose rests",
        "until its in-betweens are exact, as they are drawn while it moves",
        "until they are exact in full detail",
    )
    rows = tuple(map(row_of, names, zip(*times, strict=True)))
    return Table(title="From the release of a handle", rows=rows)


def _playhead(stage: Driver, extent: Extent) -> Table:
    """Measure from moving the playhead, once a handle is let go, to the exact in-between."""
    rows = []
    for name, reach, wait in (
        ("the playhead is moved at once", extent.reach, 1),
        (f"{LATER} pictures later, after a hard pull", HARD * extent.reach, LATER),
    ):
        runs = [_leave(stage, reach, number, wait) for number in range(extent.repeats)]
        times, keys = zip(*runs, strict=True)
        note = (
            f"pictures of a key before it: median {statistics.median(keys):.0f}, most {max(keys)}"
        )
        rows.append(replace(row_of(name, times), note=note))
    return Table(
        title="From moving the playhead between keys, once a handle is let go, to the in-between",
        rows=tuple(rows),
    )


def _leave(stage: Driver, reach: float, number: int, wait: int) -> tuple[float, int]:
    """Pull, let go, and leave the pose: the seconds to the in-between, the pictures before it."""
    project = stage.project
    drag = HandleDrag(stage, reach)
    for move in range(10):
        drag.move(20 * number + move)
        stage.refresh()
    drag.let_go()
    for _ in range(wait):
        stage.refresh()
    first, second, *_ = project.layer.keys
    between = (first.frame + second.frame) // 2 + number
    moved = time.perf_counter()
    stage.ask(playback.scrub, between)
    stage.refresh()
    keys = 0
    while not _shows(project, between, exactly=True):
        keys += _shows(project, between)
        stage.refresh()
    seconds = time.perf_counter() - moved
    stage.settle()
    return seconds, keys


def _shows(project: Project, frame: int, *, exactly: bool = False) -> bool:
    """Tell whether a frame of the document as it is now is shown."""
    shown = project.layer_runtime.shown
    if shown is None or shown.frame != frame or shown.clip != project.clip:
        return False
    return shown.is_current or not exactly


def _rests(project: Project) -> bool:
    return project.drag is None


def _is_exact(project: Project) -> bool:
    return project.layer_runtime.store.has(project.clip)


def _is_fine(project: Project) -> bool:
    store, fine = project.layer_runtime.store, project.layer_runtime.fine
    if store.mesh.domain is project.layer.domain:
        return _is_exact(project)
    return fine is not None and fine.has(project.clip)


def _latency(stage: Driver, extent: Extent) -> Table:
    """Measure from a move of the pointer to the first picture of a pose that was solved for it."""
    drag = HandleDrag(stage, extent.reach)
    sent: list[tuple[Target | None, float]] = []
    frames: list[int] = []
    seconds: list[float] = []
    while len(frames) < extent.moves:
        moved = time.perf_counter()
        drag.move(1 + len(sent))
        frame = stage.refresh()
        sent.append((drag.wish, moved))
        drawn = moved + frame.whole
        wishes = [wish for wish, _ in sent]
        if drag.followed in wishes:
            for number in range(len(frames), wishes.index(drag.followed) + 1):
                frames.append(len(sent) - number)
                seconds.append(drawn - sent[number][1])
    drag.end()
    return Table(
        title="From a move of the pointer to a picture that follows it, at 60 frames a second",
        rows=(
            row_of("time until that picture is drawn", seconds),
            Row(
                name="frames, the one that takes the move included",
                seconds=None,
                note=f"median {statistics.median(frames):.0f}, worst {max(frames)}, "
                f"of {len(frames)} moves",
            ),
        ),
    )

"""The whole window, used for minutes on end: memory, handles and OpenGL objects do not grow.

Somebody drags, plays, undoes, saves and exports a project with layers, by the window's own clock,
which a slow machine's frames move on.
"""

import gc
import os
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import harness
import moderngl
import numpy as np
from harness import Harness

from app.document.keyframe import Target
from app.editor.actions import editing, exporting, playback, posing, saving
from app.storage.assets import sample_images

ROUND = 20.0  # seconds by the window's clock
RATE = 15  # frames a second by it
PAGE = os.sysconf("SC_PAGE_SIZE")
GL = (moderngl.Buffer, moderngl.Texture, moderngl.Framebuffer, moderngl.VertexArray)
MOST_SLOPE = 1.0  # MB a minute, once all is warm


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Use a window for so many minutes by its clock, and yield what was measured."""
    harness.FRAME = 1 / RATE
    window, rng = Harness(), np.random.default_rng(seed)
    window.reset()
    window.open(sample_images() / "friend.lissom")
    rounds = max(4, round(amount * 60 / ROUND))
    measured = []
    with tempfile.TemporaryDirectory() as name:
        for number in range(rounds):
            seconds = use(window, rng, Path(name), number)
            gc.collect()
            handles = len(os.listdir("/proc/self/fd"))  # noqa: PTH208 - their number alone
            alive = sum(isinstance(each, GL) for each in gc.get_objects())
            measured.append((resident(), handles, alive, seconds))
            (Path(name) / "a.gif").unlink(missing_ok=True)
    megabytes, handles, alive, seconds = np.array(measured).T
    minutes = ROUND / 60 * np.arange(rounds)
    warm = rounds // 3
    slope = float(np.polyfit(minutes[warm:], megabytes[warm:], 1)[0])
    third = rounds // 3
    yield (
        "window",
        {
            "minutes": rounds * ROUND / 60,
            "memory, MB": float(megabytes[-1]),
            "slope, MB a minute": slope,
            "file handles, first": float(handles[warm]),
            "last": float(handles[-1]),
            "OpenGL objects, first": float(alive[warm]),
            "last of them": float(alive[-1]),
            "ms a frame that plays, first third": 1e3 * float(seconds[:third].mean()),
            "last third": 1e3 * float(seconds[-third:].mean()),
        },
    )
    assert slope < MOST_SLOPE
    assert handles[-1] <= handles[warm] + 2
    assert alive[-1] <= alive[warm] + 8


def use(window: Harness, rng: np.random.Generator, folder: Path, number: int) -> float:
    """Do what a person does in a round; return the processor's seconds for a frame that plays."""
    session, project = window.session, window.session.project
    frames = round(ROUND * RATE)
    playback.seek(session, int(rng.integers(0, project.document.frames.last)))
    window.frames()
    handles = project.figure.handles
    for _ in range(4):
        if handles:
            handle = handles[rng.integers(len(handles))]
            gesture = object()
            way = 8 * rng.normal(size=2)
            for step in range(frames // 16):
                place = handle.position + complex(*way) * np.sin(step / 9)
                posing.pull(session, {handle.id: Target(position=place)}, gesture=gesture)
                window.frames()
            posing.let_go(session)
        window.settle()
    playback.toggle_play(session)
    begun = time.process_time()
    window.frames(frames // 2)
    seconds = (time.process_time() - begun) / (frames // 2)
    playback.halt(session)
    for _ in range(4):
        editing.undo(session)
        window.frames(frames // 32)
    saving.write(session, folder / "a.lissom", None)
    window.settle()
    if number % 3 == 0:
        exporting.start(session, folder / "frames")
        while session.export is not None or session.jobs.kinds:
            window.frames()
        for path in (folder / "frames").glob("*.png"):
            path.unlink()
    return seconds


def resident() -> float:
    """Return the memory of this process, in MB."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE / 1e6

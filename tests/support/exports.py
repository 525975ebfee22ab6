"""Plans of small exports, and frames for them without a renderer, for the tests of formats."""

from pathlib import Path

import numpy as np

from app.document import FRAME_NAMES
from app.export.destination import FrameNames
from app.export.plan import ExportPlan, FrameTag
from app.export.run import export_frames
from app.export_formats import MeshOptions, SpriteSheetOptions
from app.render.view import canvas_view
from engine.arrays import Bytes

SIZE = (37, 22)
FRAMES = 7


def plan_for(out: Path, format_: str, **changes: object) -> ExportPlan:
    values: dict[str, object] = {
        "out": out,
        "format": format_,
        "view": canvas_view(SIZE),
        "background": None,
        "times": tuple(float(number) for number in range(FRAMES)),
        "first": 0,
        "span": (0.0, FRAMES - 1.0),
        "fps": 24.0,
        "timeline_fps": 24.0,
        "passes": 1,
        "canvas": SIZE,
        "loop": True,
        "frame_names": FrameNames(pattern=FRAME_NAMES, project="walk"),
        "tags": (FrameTag("walk", 0, FRAMES - 1),),
        "sheet": SpriteSheetOptions(trimmed=False, padding=0),
        "shapes": MeshOptions(),
    }
    return ExportPlan(**(values | changes))  # type: ignore[arg-type]


def draw(time: float, size: tuple[int, int] = SIZE) -> Bytes:
    """A disc with a soft edge and a gradient that moves to the right."""
    y, x = np.mgrid[: size[1], : size[0]]
    edge = 8.5 - np.hypot(x - 8 - 2 * time, y - 10)
    frame = np.zeros((size[1], size[0], 4), dtype=np.uint8)
    frame[..., 3] = np.clip(128 + 60 * edge, 0, 255)
    frame[..., 0], frame[..., 1], frame[..., 2] = 40 + 5 * x, 200 - 6 * y, 90
    frame[frame[..., 3] == 0] = 0
    return frame


def at_once(time: float) -> float:
    """Poses that take no time: the time itself."""
    return time


def run(plan: ExportPlan, drawing=draw) -> None:
    assert list(export_frames(plan, at_once, drawing)) == list(range(1, len(plan.times) + 1))

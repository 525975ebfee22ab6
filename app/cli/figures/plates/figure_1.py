"""Figure 1: the giraffe halfway to the ground, by each method."""

from app.cli.figures.easel import alike, box_of
from app.cli.figures.methods import ARAP, HANDLES, LINEAR, METRIC, NU
from app.cli.figures.plates.plate import BOUNDED, Plate, Studio, bounded_rows
from app.cli.figures.shapes import ShapePair, sample
from app.cli.figures.sheet import INK, as_png, new_sheet, show
from app.cli.figures.track import Measured, Tracked

TIME = 0.5
MEASURED = 3  # times: the middle, and both keyframes
METHODS = (LINEAR, HANDLES, ARAP, NU, METRIC)
CAPTION = (
    "Interpolation of the giraffe, from the source (left) to the target (right), at t = 0.5. "
    "Linear interpolation of positions shrinks the neck. Handles that go straight lead the "
    "deformer where nobody would pull it. Metric keeps the direction of its stretch, ARAP and ν do "
    "not."
)


def pair(triangles: int) -> ShapePair:
    """Return the giraffe upright and with its head at the ground."""
    return sample("giraffe", 0, 1, triangles)


def measure(triangles: int) -> tuple[Measured, ...]:
    """Measure all methods."""
    both = pair(triangles)
    return tuple(Tracked(both, method, MEASURED).measured() for method in METHODS)


def make(studio: Studio) -> Plate:
    """Draw the figure."""
    both = pair(studio.triangles)
    tracks = [Tracked(both, method, MEASURED) for method in METHODS]
    panels = [
        ("source", tracks[-1], 0.0),
        *((track.method.name, track, TIME) for track in tracks),
        ("target", tracks[-1], 1.0),
    ]
    sheet = new_sheet(14, 3.4)
    boxes = alike([box_of(track.frame(time).positions) for _, track, time in panels])
    columns = sheet.subplots(1, len(panels))
    for axes, (title, track, time), box in zip(columns, panels, boxes, strict=True):
        show(axes, studio.easel, track, time, box=box)
        axes.set_title(title, color=INK, fontsize=11)
    return Plate(
        title="The giraffe",
        caption=CAPTION,
        picture=as_png(sheet),
        heads=BOUNDED,
        rows=bounded_rows(tuple(track.measured() for track in tracks)),
    )

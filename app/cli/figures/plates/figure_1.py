"""Figure 1: the giraffe halfway to the ground, by each method."""

from app.cli.figures.methods import ARAP, HANDLES, LINEAR, METRIC, NU
from app.cli.figures.plates.plate import Plate, Studio, bounded_plate
from app.cli.figures.shapes import sample
from app.cli.figures.sheet import show_panels
from app.cli.figures.track import tracked

TIME = 0.5
MEASURED = 3  # times: the middle, and both keyframes
METHODS = (LINEAR, HANDLES, ARAP, NU, METRIC)
CAPTION = (
    "Interpolation of the giraffe, from the source (left) to the target (right), at t = 0.5. "
    "Linear interpolation of positions shrinks the neck. Handles that go straight lead the "
    "deformer where nobody would pull it. Metric keeps the direction of its stretch, ARAP and ν do "
    "not."
)


def make(studio: Studio) -> Plate:
    """Draw the figure."""
    tracks = tracked(sample("giraffe", 0, 1, studio.triangles), METHODS, MEASURED)
    metric = tracks[METRIC.name]
    between = ((name, track, TIME) for name, track in tracks.items())
    panels = [("source", metric, 0.0), *between, ("target", metric, 1.0)]
    sheet = show_panels(studio.easel, panels, (14, 3.4))
    return bounded_plate("The giraffe", CAPTION, sheet, tracks)

"""Figure 1: the giraffe halfway to the ground, by each method."""

from app.paper_figures.measure import measure_motions
from app.paper_figures.methods import ARAP, HANDLES, LINEAR, METRIC, NU
from app.paper_figures.plots.paper_figure import FigureContext, PaperFigure, make_distortion_figure
from app.paper_figures.shapes import make_sample_pair
from app.paper_figures.sheet import draw_panels
from app.texts import _

TIME = 0.5
MEASURED = 3  # times: the middle, and both keyframes
METHODS = (LINEAR, HANDLES, ARAP, NU, METRIC)
CAPTION = _(
    "Interpolation of the giraffe, from the source (left) to the target (right), at t = 0.5. "
    "Linear interpolation of positions shrinks the neck. Handles on straight paths lead the "
    "deformer to poses that nobody would choose. Metric keeps the direction of the neck's "
    "stretch; ARAP and ν do not."
)


def make_figure_1(studio: FigureContext) -> PaperFigure:
    tracks = measure_motions(make_sample_pair("giraffe", 0, 1, studio.triangles), METHODS, MEASURED)
    metric = tracks[METRIC.name]
    between = ((name, track, TIME) for name, track in tracks.items())
    panels = [("source", metric, 0.0), *between, ("target", metric, 1.0)]
    sheet = draw_panels(studio.renderer, panels, (14, 3.4))
    return make_distortion_figure(_("The giraffe"), CAPTION, sheet, tracks)

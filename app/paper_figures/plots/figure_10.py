"""Figure 10: the metric variant on this project's own drawings."""

from app.paper_figures.measure import MeasuredMotion
from app.paper_figures.methods import METRIC
from app.paper_figures.plots.paper_figure import FigureContext, PaperFigure, make_distortion_figure
from app.paper_figures.shapes import bar_to_ring, letter_s, make_sample_pair
from app.paper_figures.sheet import draw_row, label_row, new_sheet
from app.texts import _

TIMES = (0.0, 0.25, 0.5, 0.75, 1.0)
TIMES_MEASURED = 21
CAPTION = _(
    "A collection of in-betweens by the metric variant. Between the keyframes at the left and "
    "the right, nothing is distorted more than in the keyframes. The ring has a hole, a case "
    "that the paper does not treat."
)


def make_figure_10(studio: FigureContext) -> PaperFigure:
    triangles = studio.triangles
    pairs = {
        "giraffe": make_sample_pair("giraffe", 0, 1, triangles),
        "dragon": make_sample_pair("dragon", 1, 2, triangles),
        "octopus": make_sample_pair("octopus", 1, 2, triangles),
        "character": make_sample_pair("character", 0, 1, triangles),
        "S to U": letter_s(triangles),
        "bar to ring": bar_to_ring(triangles),
        "ring": make_sample_pair("ring", 0, 3, triangles),
    }
    tracks = {named: MeasuredMotion(pair, METRIC, TIMES_MEASURED) for named, pair in pairs.items()}
    sheet = new_sheet(12, 1.9 * len(tracks))
    rows = sheet.subplots(len(tracks), len(TIMES))
    for row, (named, track) in zip(rows, tracks.items(), strict=True):
        draw_row(row, studio.renderer, track, TIMES)
        label_row(row[0], named)
    return make_distortion_figure(_("A collection"), CAPTION, sheet, tracks)

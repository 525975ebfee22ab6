"""Figure 10: what the metric variant makes of this project's own drawings."""

from app.cli.figures.methods import METRIC
from app.cli.figures.plates.plate import Plate, Studio, bounded_plate
from app.cli.figures.shapes import bar_to_ring, letter_s, sample
from app.cli.figures.sheet import name, new_sheet, show_row
from app.cli.figures.track import Tracked

TIMES = (0.0, 0.25, 0.5, 0.75, 1.0)
TIMES_MEASURED = 21
CAPTION = (
    "A collection of in-betweens by the metric variant: between the keyframes at the left and at "
    "the right nothing is distorted further than in them. The ring has a hole, which the paper "
    "does not treat."
)


def make(studio: Studio) -> Plate:
    """Draw the figure."""
    triangles = studio.triangles
    pairs = {
        "giraffe": sample("giraffe", 0, 1, triangles),
        "dragon": sample("dragon", 1, 2, triangles),
        "octopus": sample("octopus", 1, 2, triangles),
        "character": sample("character", 0, 1, triangles),
        "S to U": letter_s(triangles),
        "bar to ring": bar_to_ring(triangles),
        "ring": sample("ring", 0, 3, triangles),
    }
    tracks = {named: Tracked(pair, METRIC, TIMES_MEASURED) for named, pair in pairs.items()}
    sheet = new_sheet(12, 1.9 * len(tracks))
    rows = sheet.subplots(len(tracks), len(TIMES))
    for row, (named, track) in zip(rows, tracks.items(), strict=True):
        show_row(row, studio.easel, track, TIMES)
        name(row[0], named)
    return bounded_plate("A collection", CAPTION, sheet, tracks)

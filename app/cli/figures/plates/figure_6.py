"""Figure 6: a bar becomes a ring."""

from app.cli.figures.methods import ARAP, FFMP, METRIC, SCALED_ETA
from app.cli.figures.plates.comparison import compare
from app.cli.figures.plates.plate import Plate, Studio
from app.cli.figures.shapes import bar_to_ring

METHODS = (ARAP, FFMP, SCALED_ETA, METRIC)
CAPTION = (
    "Bar to ring. Pictures and geometric distortion, as in Figure 5, of ARAP, FFMP and our "
    "variants that interpolate the direction of the stretch, which turns by a right angle here."
)


def make(studio: Studio) -> Plate:
    """Draw the figure."""
    pair = bar_to_ring(studio.triangles)
    return compare(studio, pair, METHODS, title="Bar to ring", caption=CAPTION)

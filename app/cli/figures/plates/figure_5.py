"""Figure 5: a letter S becomes a U."""

from app.cli.figures.methods import ARAP, FFMP, METRIC, NU, SCALED_ETA
from app.cli.figures.plates.comparison import compare
from app.cli.figures.plates.plate import Plate, Studio
from app.cli.figures.shapes import letter_s

METHODS = (ARAP, FFMP, NU, SCALED_ETA, METRIC)
CAPTION = (
    "S to U. Pictures and geometric distortion of our variants, ARAP and FFMP: k and τ of the 100 "
    "points of highest distortion, each relative to its keyframe. Ours stay below the red line; "
    "the others' in-betweens exceed it."
)


def make(studio: Studio) -> Plate:
    """Draw the figure."""
    pair = letter_s(studio.triangles)
    return compare(studio, pair, METHODS, title="S to U", caption=CAPTION)

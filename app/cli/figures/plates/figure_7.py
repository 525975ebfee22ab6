"""Figure 7: a bar whose keyframe is told by its boundary alone, by harmonic coordinates."""

from dataclasses import replace

import numpy as np

from app.cli.figures.methods import ARAP, FFMP, METRIC
from app.cli.figures.plates.comparison import compare
from app.cli.figures.plates.plate import Plate, Studio
from app.cli.figures.shapes import ShapePair, beam
from engine.baselines import harmonic_coordinate_maps

METHODS = (ARAP, FFMP, METRIC)
TURN, GROWTH = 2.4, 0.7  # of the bar, over its length
CAPTION = (
    "Square bar. Only the places of the outline's vertices are given in both keyframes; harmonic "
    "coordinates make maps of them (Weber and Gotsman 2010, Section 10). Pictures and geometric "
    "distortion as in Figure 5."
)


def pair(triangles: int) -> ShapePair:
    """Return the bar and the bar bent to a horn."""
    shape = beam(triangles)
    outline, cage = shape.domain.outline, shape.domain.cage
    middle = outline.mean()
    rate = complex(GROWTH, TURN) / float(np.ptp(outline.real))
    along, across = (outline - middle).real, (outline - middle).imag
    horn = (np.exp(rate * along) - 1) / rate + 1j * across * np.exp(rate * along)
    (first, second), _ = harmonic_coordinate_maps(outline, cage, [outline, horn])
    domain = replace(shape.domain, cage=first.cage)
    return ShapePair(
        shape=replace(shape, domain=domain), first=first, second=second, anchor=complex(middle)
    )


def make(studio: Studio) -> Plate:
    """Draw the figure."""
    return compare(
        studio, pair(studio.triangles), METHODS, title="Harmonic coordinates", caption=CAPTION
    )

"""The figures, a module each, but for those that compare alike.

In: a studio.
Out: plates: a picture, a caption, and the numbers beside them.
Imports: `app.cli.figures` without its page.
"""

from app.cli.figures.plates import (
    comparison,
    figure_1,
    figure_3,
    figure_4,
    figure_8,
    figure_9,
    figure_10,
    figure_11,
)
from app.cli.figures.plates.plate import Plate as Plate, Studio as Studio

MAKERS = {
    1: figure_1.make,
    3: figure_3.make,
    4: figure_4.make,
    5: comparison.s_to_u,
    6: comparison.bar_becomes_ring,
    7: comparison.harmonic_coordinates,
    8: figure_8.make,
    9: figure_9.make,
    10: figure_10.make,
    11: figure_11.make,
}

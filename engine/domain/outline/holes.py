"""The holes of a subject that stay holes: an outline around each, and a cage inside it.

A hole is outlined by the rules of the subject itself, seen from the subject: its loop runs
clockwise, so that the subject lies on the left, and margin and offset lead into the hole. They
shrink with the hole, so that outline and cage leave its middle free.
"""

import numpy as np
from scipy import ndimage

from engine.arrays import Booleans, Integers
from engine.domain.outline.cage import offset_cage
from engine.domain.outline.fitting import Candidates, fit_polygon
from engine.domain.outline.margin import curve_at_margin, distance_field
from engine.errors import EngineError
from engine.geometry import Hole, deepest_point

SMALLEST_HOLE = 0.012  # radius of the largest disc in a hole that is kept, of the diagonal
SHARE = 0.25  # of that radius: the margin at most, and the offset from outline to cage
FEWEST_EDGES = 16
FRAME = 2  # cells of the subject around a hole that is cut out


def trace_hole(
    labels: Integers, number: int, *, margin: float, offset: float, closing: float, diagonal: float
) -> Hole | None:
    """Find the outline of a hole, and the cage inside it, in cells.

    Parameters
    ----------
    labels : int32, shape (h, w)
        The number of the hole that each cell belongs to, 0 where to none.
    number : int
        Of the hole.
    margin, offset : float
        Wanted distances from the subject to the outline and from there to the cage, in cells.
    closing : float
        Width, in cells, below which a gap within the hole is closed.
    diagonal : float
        Of the subject's box, in cells.

    Returns
    -------
    Hole or None
        None where the hole is too small, or too intricate.
    """
    rows, columns = ndimage.find_objects(labels, max_label=number)[number - 1]
    window: Booleans = np.pad(labels[rows, columns] == number, FRAME)
    corner = complex(columns.start - FRAME, rows.start - FRAME)
    field = distance_field(~window)
    radius = float(field.distance.max())
    if radius < SMALLEST_HOLE * diagonal:
        return None
    offset = min(offset, SHARE * radius)
    curve = curve_at_margin(
        field,
        margin=min(margin, SHARE * radius),
        offset=offset,
        closing=closing,
        diagonal=float(np.hypot(*window.shape)),
        hole=True,
    )
    candidates = Candidates.on(curve, diagonal, fewest_edges=FEWEST_EDGES)
    outline = fit_polygon(candidates, field.boundary())
    if outline is None:
        return None
    try:
        cage = offset_cage(outline, offset, hole=True)
    except EngineError:
        return None
    return Hole(outline=outline + corner, cage=cage + corner, centre=deepest_point(cage) + corner)

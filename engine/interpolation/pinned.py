"""Handles that stay during a segment: from in-betweens to their corrections."""

import numpy as np

from engine.arrays import Complexes
from engine.correction import BaseFrame, Corrector
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.pins import BaseAt, Pins, PinSeries, pin
from engine.maps import Bounds


def points_for_pins(corrector: Corrector) -> Complexes:
    """Return at which points in-betweens tell what pins need: handles, nodes and samples."""
    return np.concatenate([corrector.points, corrector.paths.nodes, corrector.boundary.points])


def solve_pins(base: Inbetweens, corrector: Corrector, pins: Pins, bounds: Bounds) -> PinSeries:
    """Find the corrections of a segment.

    Parameters
    ----------
    base : Inbetweens
        Without pins, at `points_for_pins`.
    corrector : Corrector
        For the handles.
    pins : Pins
    bounds : Bounds
        Limits that are kept at the samples, as far as the base keeps them.
    """
    count, nodes = len(corrector.points), len(corrector.paths.nodes)
    parts = slice(count, count + nodes), slice(count + nodes, None)
    places, blend = base.sites.paths.places, base.blend
    # The linear blend has zeros of f_z, where L² / F would be infinite.
    sign, is_squared = blend.sign or -1, blend.sign != 0

    def base_at(time: float) -> BaseAt:
        frame = base.frame(time)
        by = np.exp(base.passage.plain_log_fz(time)[0][places])
        if is_squared:
            by = by * by / frame.fz
        of_nodes, of_samples = (
            BaseFrame(frame.fz[part], frame.fzbar[part].conj(), by[part], sign) for part in parts
        )
        return BaseAt(frame.positions[:count], base.anchor_position(time), of_nodes, of_samples)

    return pin(corrector, base_at, pins, bounds, sign=sign, is_squared=is_squared)

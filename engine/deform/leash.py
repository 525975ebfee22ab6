"""The leash: how far ahead of the handles a step may look."""

import numpy as np

from engine.arrays import Complexes
from engine.deform.handles import Handles, Wish
from engine.deform.objective import Jet

# A handle is pulled towards a point at most this far (of L) ahead of it, and turned by at most this
# angle: farther away the quadratic model says nothing. Both times the reach, at most 1.
LEASH, TURN_LEASH = 0.02, 0.2
# Handles whose correlation with their targets is weaker have no common rotation.
CORRELATED = 0.5


def cut_to_leash(
    handles: Handles, size: float, reach: float, jet: Jet, wish: Wish
) -> tuple[Wish, bool]:
    """Return the wish cut to the leash, and whether that cut anything.

    What all handles want to turn together, they turn: straight ways to a wish that is mainly a
    rotation would squeeze the shape.
    """
    distance, most = LEASH * size * reach, TURN_LEASH * reach
    positions = _turned(handles, jet.positions, wish.positions, most)
    pull = wish.positions - positions
    cut = distance / np.maximum(np.abs(pull), distance)
    # Free handles have NaN, which passes through.
    turn = np.angle(np.exp(1j * wish.rotations) * jet.fz.conj())
    near = np.angle(jet.fz) + np.clip(turn, -most, most)
    leashed = bool(np.any(cut < 1.0) or np.any(np.abs(turn) > most))
    return Wish(positions + cut * pull, near), leashed


def _turned(handles: Handles, positions: Complexes, targets: Complexes, most: float) -> Complexes:
    """Return the positions turned as a whole towards the targets (Procrustes), up to an angle."""
    weights = handles.stiffness / handles.stiffness.sum()
    centre = weights @ positions
    from_centre, wanted = positions - centre, targets - weights @ targets
    correlation = weights @ (from_centre.conj() * wanted)
    scale = weights @ (np.abs(from_centre) * np.abs(wanted))
    if abs(correlation) <= CORRELATED * scale:
        return positions
    angle = np.clip(np.angle(correlation), -most, most)
    turned: Complexes = centre + np.exp(1j * angle) * from_centre
    return turned

"""The free motion of a damped oscillator."""

import numpy as np

from engine.arrays import Floats


def oscillator_flow(angles: Floats, damping: float) -> Floats:
    """Return exp(A h) of the free oscillator, ö + 2ζωȯ + ω²o = 0, for the state (o, ȯ/ω).

    Parameters
    ----------
    angles : float64, shape (...)
        ωh, 0 or more.
    damping : float
        ζ, 0 or more.

    Returns
    -------
    float64, shape (..., 2, 2)
        Of norm at most 1.

    Notes
    -----
    With c = e^(−ζωh) cos θ and s = e^(−ζωh) ωh sin θ/θ, θ = ωh √(1 − ζ²), it is
    ((c + ζs, s), (−s, c − ζs)). Above ζ = 1 the exponentials of cosh and sinh are joined with the
    first one, since √(ζ² − 1) − ζ = −1/(ζ + √(ζ² − 1)): no exponent is positive, nothing overflows.
    """
    root = np.sqrt(abs((1 - damping) * (1 + damping)))
    turns = angles * root
    if damping < 1:
        decay = np.exp(-damping * angles)
        c, s = decay * np.cos(turns), decay * angles * np.sinc(turns / np.pi)
    else:
        decay, less = np.exp(-angles / (damping + root)), -np.expm1(-2 * turns)
        share = np.divide(less, 2 * turns, out=np.ones_like(turns), where=turns > 0)
        c, s = decay * (1 - less / 2), decay * angles * share
    rows = np.stack([c + damping * s, s, -s, c - damping * s], axis=-1)
    matrices: Floats = rows.reshape(*angles.shape, 2, 2)
    return matrices

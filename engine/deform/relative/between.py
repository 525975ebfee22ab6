"""How much of a correction keeps the limits between the samples of the boundary, too.

f_z and conj(f_z̄) are holomorphic on the boundary and around it, so that four samples give them in
the middle of a segment by interpolation in z, also around a corner; what that lacks falls with the
fourth power of the spacing. Far out of reach a map runs along its walls: these are inside the
limits at the samples, and between two of them a map may be beyond both.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, freeze, ratio
from engine.deform.model import Jet, Walls
from engine.maps import Boundary, Limits

ROUNDS = 24  # of bisection


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Middles:
    """The middles of a boundary's m segments.

    Parameters
    ----------
    stencil : intp, shape (4, m)
        The samples from which values there follow.
    weights : complex128, shape (4, m)
    following : intp, shape (m,)
        The samples at which the segments end.
    """

    stencil: Indices
    weights: Complexes
    following: Indices

    @classmethod
    def of(cls, boundary: Boundary) -> Self:
        """Work the weights of interpolation out."""
        after = boundary.following
        stencil = np.stack([np.argsort(after), np.arange(len(after)), after, after[after]])
        nodes = boundary.points[stencil]
        middles = (nodes[1] + nodes[2]) / 2
        weights = np.ones_like(nodes)
        for i in range(len(nodes)):
            for j in range(len(nodes)):
                if i != j:
                    weights[i] *= (middles - nodes[j]) / (nodes[i] - nodes[j])
        return cls(stencil=stencil, weights=freeze(weights), following=after)

    def along(self, values: Complexes) -> Complexes:
        """Return the values at the samples, and those in the middles, (2m,)."""
        return np.concatenate([values, (self.weights * values[self.stencil]).sum(axis=0)])

    def share_within(self, base: Jet, change: Jet, limits: Limits, boundary: Boundary) -> float:
        """Return how much of a change of a base keeps the limits, or what the base has beyond them.

        It is 1 unless a limit is broken; else the largest part up to which none is.
        """
        walls = [
            np.concatenate([wall, np.maximum(sign * wall, sign * wall[self.following]) * sign])
            for wall, sign in zip(Walls.at(limits, boundary), (1, 1, -1), strict=True)
        ]
        f, g, df, dg = map(self.along, (base.f, base.g, change.f, change.g))
        own = _distortions(f, g)
        allowed = np.maximum(own, [walls[0], walls[1], -walls[2]])

        def keeps(share: float) -> bool:
            return bool(np.all(_distortions(f + share * df, g + share * dg) <= allowed))

        if keeps(1.0):
            return 1.0
        inside, outside = 0.0, 1.0
        for _ in range(ROUNDS):
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if keeps(middle) else (inside, middle)
        return inside


def _distortions(f: Complexes, g: Complexes) -> Floats:
    """Return k, σ_a and −σ_b, (3, p): what limits are upper bounds of."""
    a, b = np.abs(f), np.abs(g)
    return np.array([ratio(b, a), a + b, b - a])

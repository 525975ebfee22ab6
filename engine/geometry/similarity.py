"""Similarities of the plane."""

from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes


class Similarity(NamedTuple):
    """z ↦ factor · z + shift, the factor not 0. A rigid motion has a factor of modulus 1."""

    factor: complex = 1.0 + 0j
    shift: complex = 0j

    @classmethod
    def fit_rigid_motion(cls, places: Complexes, wanted: Complexes) -> "Similarity":
        """Return the rigid motion that brings places (n,) nearest to others, in least squares."""
        centre, to = complex(places.mean()), complex(wanted.mean())
        product = complex(np.vdot(places - centre, wanted - to))
        factor = product / abs(product) if product else 1.0 + 0j
        return cls(factor, to - factor * centre)

    def apply(self, places: Complexes) -> Complexes:
        if self == IDENTITY_MOTION:
            return places
        return self.factor * places + self.shift

    def apply_inverse(self, place: complex) -> complex:
        """Return the preimage of a place."""
        return (place - self.shift) / self.factor

    def compose(self, other: "Similarity") -> "Similarity":
        """Return the similarity that applies `other` first."""
        return Similarity(self.factor * other.factor, self.factor * other.shift + self.shift)

    @property
    def inverse(self) -> "Similarity":
        return Similarity(1 / self.factor, -self.shift / self.factor)


IDENTITY_MOTION = Similarity()

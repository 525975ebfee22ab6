"""Rigid motions of the plane, and similarities."""

from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes


class RigidMotion(NamedTuple):
    """z ↦ factor · z + shift, the factor of modulus 1."""

    factor: complex = 1.0 + 0j
    shift: complex = 0j

    @classmethod
    def fit(cls, places: Complexes, wanted: Complexes) -> "RigidMotion":
        """Return the motion that brings places (n,) nearest to others, in least squares."""
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
        return (place - self.shift) * self.factor.conjugate()

    def compose(self, other: "RigidMotion") -> "RigidMotion":
        """Return the motion that applies `other` first."""
        return RigidMotion(self.factor * other.factor, self.factor * other.shift + self.shift)

    @property
    def inverse(self) -> "RigidMotion":
        return RigidMotion(self.factor.conjugate(), -self.factor.conjugate() * self.shift)


class Similarity(NamedTuple):
    """z ↦ factor · z + shift, the factor not 0."""

    factor: complex = 1.0 + 0j
    shift: complex = 0j

    def apply(self, places: Complexes) -> Complexes:
        return self.factor * places + self.shift

    def apply_inverse(self, place: complex) -> complex:
        """Return the preimage of a place."""
        return (place - self.shift) / self.factor


IDENTITY_MOTION = RigidMotion()

"""Rigid motions of the plane."""

from typing import NamedTuple

from engine.arrays import Complexes


class RigidMotion(NamedTuple):
    """z ↦ factor · z + shift, the factor of modulus 1."""

    factor: complex = 1.0 + 0j
    shift: complex = 0j

    def on(self, places: Complexes) -> Complexes:
        """Return where places come to."""
        if self == HERE:
            return places
        return self.factor * places + self.shift

    def back(self, place: complex) -> complex:
        """Return which place comes to a place."""
        return (place - self.shift) * self.factor.conjugate()


HERE = RigidMotion()

"""Interpolation of harmonic keyframes: every variant of the paper behind `prepare`."""

from engine.interpolation.inbetweens import Frame, Inbetweens
from engine.interpolation.prepare import Prepared, Variant, prepare, prepare_inbetweens
from engine.interpolation.sites import Sites, prepare_sites

__all__ = [
    "Frame",
    "Inbetweens",
    "Prepared",
    "Sites",
    "Variant",
    "prepare",
    "prepare_inbetweens",
    "prepare_sites",
]

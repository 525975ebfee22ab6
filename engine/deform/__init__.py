"""The deformer: handles, energy, barrier and certificate (Chen and Weber 2015, 2017)."""

from engine.deform.boundary import Boundary
from engine.deform.bounds import Bounds
from engine.deform.certificate import Certificate, certify
from engine.deform.deformer import Deformer, State, Statistics, Status
from engine.deform.handles import Handles, Wish

__all__ = [
    "Boundary",
    "Bounds",
    "Certificate",
    "Deformer",
    "Handles",
    "State",
    "Statistics",
    "Status",
    "Wish",
    "certify",
]

"""Measurements of a method on a pair of keyframes: frames and distortion (Section 8)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.paper_figures.methods import ComparedMethod, Inbetween
from app.paper_figures.shapes import ShapePair
from app.reports import divide_by_keys, worst_points
from engine.arrays import Complexes, Floats
from engine.domain.meshing.mesh import Mesh
from engine.maps import distortion

TIMES = 41  # of the curves
FOLDED = np.inf  # τ of a map that is not injective


class MeasuredMotion:
    """The in-betweens of a pair by one method, at `times` even times from 0 to 1.

    `frame` returns the in-between at a time in [0, 1].
    """

    def __init__(self, pair: ShapePair, method: ComparedMethod, times: int = TIMES) -> None:
        self.pair = pair
        self.method = method
        self.times: Floats = np.linspace(0.0, 1.0, times)
        self.frame = method.prepare(pair)

    @cached_property
    def frames(self) -> tuple[Inbetween, ...]:
        return tuple(self.frame(float(time)) for time in self.times)

    @cached_property
    def k(self) -> Floats:
        """Conformal distortion (t, p)."""
        return np.array([distortion.k(frame.fz, frame.fzbar) for frame in self.frames])

    @cached_property
    def tau(self) -> Floats:
        """Isometric distortion (t, p), infinite if a map folds."""
        values = []
        for frame in self.frames:
            least = distortion.sigma_b(frame.fz, frame.fzbar)
            with np.errstate(divide="ignore"):
                tau = distortion.tau(frame.fz, frame.fzbar)
            values.append(np.where(least > 0, tau, FOLDED))
        return np.array(values)

    @cached_property
    def k_shares(self) -> Floats:
        """Conformal distortion of the 100 worst points, relative to their larger keys, (t, 100)."""
        return divide_by_keys(worst_points(self.k))

    @cached_property
    def tau_shares(self) -> Floats:
        """τ − 1 of the 100 worst points, relative to their larger keys, (t, 100)."""
        return divide_by_keys(worst_points(self.tau - 1.0))

    def summarize(self) -> "DistortionSummary":
        """Return the numbers printed beside the pictures."""
        mesh = self.pair.shape.domain.mesh
        areas = np.array([area_of(mesh, frame.positions) for frame in self.frames])
        ends = np.minimum(areas[0], areas[-1])
        return DistortionSummary(
            k=float(self.k_shares.max()),
            tau=float(self.tau_shares.max()),
            k_of_all=float(self.k.max() / max(self.k[0].max(), self.k[-1].max())),
            tau_of_all=float(
                (self.tau.max() - 1) / (max(self.tau[0].max(), self.tau[-1].max()) - 1)
            ),
            area=float(areas.min() / ends),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class DistortionSummary:
    """Distortion of a method's in-betweens relative to the keyframes.

    `k` and `tau` are the largest k and τ − 1 of the 100 worst points, each relative to the larger
    key of its point. They are at most 1 if distortion is bounded point by point. `k_of_all` and
    `tau_of_all` are the largest values of all points relative to the largest values of both keys.
    They are at most 1 if distortion is bounded as a whole. `area` is the smallest area over time,
    relative to the smaller key.
    """

    k: float
    tau: float
    k_of_all: float
    tau_of_all: float
    area: float


def measure_motions(
    pair: ShapePair, methods: Sequence[ComparedMethod], times: int = TIMES
) -> dict[str, MeasuredMotion]:
    """Return the measured in-betweens of a pair by method name."""
    return {method.name: MeasuredMotion(pair, method, times) for method in methods}


def area_of(mesh: Mesh, positions: Complexes) -> float:
    """Return the signed area of a posed mesh."""
    corners = positions[mesh.triangles]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return float((first.conj() * second).imag.sum() / 2)

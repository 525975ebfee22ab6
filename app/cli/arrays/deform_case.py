"""Handles of a shape dragged to their targets, from a file to arrays."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from app.cli.arrays.hole_arrays import HOLE_ARRAYS, hole_arrays, read_holes
from app.errors import LissomError
from app.storage import read_arrays
from app.texts import _
from engine.arrays import Complexes
from engine.deform import BoundedPull, Deformer, Handles, require_held
from engine.geometry import Domain
from engine.maps import Boundary, Bounds, HarmonicMap, LocalBounds

LIMITS = ("k_max", "sigma_a_max", "sigma_b_min")
MATERIAL = ("stiffness", "local_limits")


def solve_case(path: Path) -> dict[str, Any]:
    """Deform the shape of a case; return the map and its proven distortion by name."""
    case = read_arrays(
        path,
        required=("outline", "cage", "handles", "targets", *LIMITS),
        optional=("phi", "psi", "logs", "path", "pull", *MATERIAL, *HOLE_ARRAYS),
    )
    k, sigma_a, sigma_b = (_scalar(case, name) for name in LIMITS)
    bounds: LocalBounds = Bounds(k=k, sigma_a=sigma_a, sigma_b=sigma_b)
    domain = Domain(case["outline"], case["cage"], read_holes(case))
    points = require_held(case["handles"], domain)
    boundary = Boundary.sample(domain)
    if "stiffness" in case:
        boundary = boundary.stiffened(case["stiffness"])
    if _is_local(case):
        bounds = bounds.scaled_by_stiffness(boundary)
    handles = Handles.place(boundary, points)
    rows = _rows(case, len(handles.points))
    pulls = _pulls(case, handles.points)
    targets = [handles.targets(row, None, pulls) for row in rows]
    deformer = Deformer(boundary=boundary, handles=handles, bounds=bounds)
    state, tried = deformer.start(_start(case, boundary)), 0
    for target in targets[:-1]:
        state, count = deformer.track_path_row(state, target)
        tried += count
    state, count = deformer.settle(state, targets[-1], throw=False)
    certificate = state.certificate
    return {
        "outline": boundary.outline,
        "cage": boundary.cage,
        "phi": state.map.phi,
        "psi": state.map.psi,
        "logs": state.map.logs,
        **hole_arrays(boundary.holes),
        "handles_mapped": deformer.positions(state),
        "k": certificate.k,
        "sigma_a": certificate.sigma_a,
        "sigma_b": certificate.sigma_b,
        "certified": certificate.is_certified,
        "status": state.status.value,
        "steps": state.steps,
        "steps_tried": tried + count,
    }


def _scalar(case: Mapping[str, npt.NDArray[Any]], name: str) -> float:
    value = case[name]
    if value.size != 1 or value.dtype.kind not in "biuf":
        raise LissomError(
            _("{name} must be one number, not an array of shape {shape} and type {type}").format(
                name=name, shape=value.shape, type=value.dtype
            )
        )
    return float(value.reshape(()))


def _is_local(case: Mapping[str, npt.NDArray[Any]]) -> bool:
    """Return whether limits are tighter in stiff parts of the shape."""
    value = _scalar(case, "local_limits") if "local_limits" in case else 0.0
    if value not in (0.0, 1.0):
        raise LissomError(_("local_limits must be 0 or 1, not {value:g}").format(value=value))
    return value == 1.0


def _rows(case: Mapping[str, npt.NDArray[Any]], count: int) -> list[npt.NDArray[Any]]:
    """Return the rows of the path, then the targets."""
    path = case.get("path", np.empty((0, count)))
    if path.ndim != 2 or path.shape[1] != count:
        raise LissomError(
            _(
                "path must have one column for each of {count} handles, not the shape {shape}"
            ).format(count=count, shape=path.shape)
        )
    return [*path, case["targets"]]


def _pulls(case: Mapping[str, npt.NDArray[Any]], points: Complexes) -> list[BoundedPull]:
    """Return bounded drag forces, each at one handle, if the case asks for them.

    A single given force is used for all handles whose target differs from their rest position.
    """
    if "pull" not in case:
        return []
    pull, count = case["pull"], len(points)
    if pull.dtype.kind not in "biuf" or pull.shape not in ((), (1,), (count,)):
        raise LissomError(
            _(
                "pull must be one number, or one for each of {count} handles, not an array of "
                "shape {shape} and type {type}"
            ).format(count=count, shape=pull.shape, type=pull.dtype)
        )
    forces = np.broadcast_to(pull.astype(np.float64), count)
    if pull.shape != (count,) and case["targets"].shape == points.shape:
        forces = np.where(case["targets"] == points, np.inf, forces)
    return [BoundedPull([handle], force) for handle, force in enumerate(forces.tolist())]


def _start(case: Mapping[str, npt.NDArray[Any]], boundary: Boundary) -> HarmonicMap | None:
    """Return the map to start from, or None for the identity."""
    if ("phi" in case) != ("psi" in case):
        raise LissomError(_("the start map needs both phi and psi"))
    if "phi" not in case:
        return None
    return HarmonicMap(
        cage=boundary.cage,
        phi=case["phi"],
        psi=case["psi"],
        holes=boundary.holes,
        logs=case.get("logs", np.zeros(len(boundary.holes))),
    )

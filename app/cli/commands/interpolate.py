"""`lissom interpolate`: in-betweens of harmonic maps at points, from file to file."""

import argparse

import numpy as np

from app.cli.hole_arrays import HOLE_ARRAYS, read_holes
from app.document import NATURAL
from app.errors import LissomError
from app.storage import check_writable, read_arrays, write_arrays
from engine.interpolation import prepare
from engine.maps import Bounds, HarmonicMap


def run(arguments: argparse.Namespace) -> int:
    """Read maps, interpolate them and write the in-betweens."""
    check_writable(arguments.out)
    data = read_arrays(
        arguments.maps,
        required=("outline", "cage", "phi", "psi", "points"),
        optional=("anchor", "triangles", "turns", "logs", *HOLE_ARRAYS),
    )
    phi, psi, holes = data["phi"], data["psi"], read_holes(data)
    count = data["cage"].size + sum(len(hole.cage) for hole in holes)
    if phi.ndim != 2 or phi.shape != psi.shape or phi.shape[1] != count:
        raise LissomError(
            "phi and psi must both be of shape (keyframes, cage vertices); they are of shape "
            f"{phi.shape} and {psi.shape}, with {count} vertices of the cage and those in holes"
        )
    logs = data.get("logs", np.zeros((len(phi), len(holes))))
    if logs.shape != (len(phi), len(holes)):
        raise LissomError(
            f"logs must be of shape (keyframes, holes), ({len(phi)}, {len(holes)}), not "
            f"{logs.shape}"
        )
    if arguments.bounds and not arguments.through:
        raise LissomError("--bounds is what --through keeps; say --through as well")
    _require_in_range(arguments.times, len(phi), loop=arguments.loop)
    bounds = NATURAL.bounds
    if arguments.bounds:
        k, sigma_a, sigma_b = arguments.bounds
        bounds = Bounds(k=k, sigma_a=sigma_a, sigma_b=sigma_b)
    prepared = prepare(
        [
            HarmonicMap(cage=data["cage"], phi=a, psi=b, holes=holes, logs=c)
            for a, b, c in zip(phi, psi, logs, strict=True)
        ],
        data["points"],
        outline=data["outline"],
        variant=arguments.variant,
        triangles=data.get("triangles"),
        anchor=data.get("anchor"),
        turns=data.get("turns"),
        through=arguments.through,
        loop=arguments.loop,
        bounds=bounds,
    )
    frames = [prepared.frame(time) for time in arguments.times]
    results = {
        "times": np.array(arguments.times),
        "anchor": np.array(prepared.sites.anchor),
        "positions": np.array([frame.positions for frame in frames]),
        "fz": np.array([frame.fz for frame in frames]),
        "fzbar": np.array([frame.fzbar for frame in frames]),
    }
    if prepared.variant.is_scaled:
        results["rho"] = np.array([frame.rho for frame in frames])
    if arguments.through:
        results["tangents"] = np.array(prepared.tangents)
    write_arrays(arguments.out, results)
    return 0


def _require_in_range(times: tuple[float, ...], keyframes: int, *, loop: bool) -> None:
    """Refuse times before any long computation."""
    last = keyframes if loop else keyframes - 1
    for time in times:
        if keyframes >= 2 and not 0 <= time <= last:
            raise LissomError(
                f"time {time:g} is out of range: {keyframes} keyframes span the times from 0 to "
                f"{last}"
            )

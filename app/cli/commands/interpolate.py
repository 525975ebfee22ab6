"""`lissom interpolate`: in-betweens of keyframes at points, from file to file."""

import argparse
from typing import Any

import numpy as np
import numpy.typing as npt

from app.cli.console import print_notice
from app.cli.keyframes import Keyframes, read_keyframes
from app.document import NATURAL, Baseline
from app.errors import LissomError, report_progress
from app.motion import prepare_baseline
from app.storage import check_writable, write_arrays
from engine.geometry import Domain
from engine.interpolation import Variant, prepare
from engine.maps import Boundary, Bounds

UNFINISHED = 1e-8  # angle defect, in radians, from which on a notice is printed
NO_PRINCIPAL = "--principal is for arap and mesh-eta; leave it out"


def run(arguments: argparse.Namespace) -> int:
    """Read keyframes, interpolate them and write the in-betweens."""
    check_writable(arguments.out, sources=arguments.keyframes)
    given = read_keyframes(arguments.keyframes)
    _require_in_range(arguments.times, given.count, loop=arguments.loop)
    if arguments.variant in tuple(Baseline):
        results = _compared(arguments, given)
    else:
        results = _harmonic(arguments, given)
    write_arrays(arguments.out, {"times": np.array(arguments.times), **results})
    return 0


def _harmonic(arguments: argparse.Namespace, given: Keyframes) -> dict[str, npt.NDArray[Any]]:
    """Interpolate by one of the paper's variants."""
    if arguments.bounds and not arguments.through:
        raise LissomError("--bounds is what --through keeps; say --through as well")
    if arguments.principal:
        raise LissomError(NO_PRINCIPAL)
    outline = given.outline
    if outline is None:
        meshes = ", ".join(each for each in Baseline if not each.needs_maps)
        raise LissomError(
            f"{arguments.variant} is for keyframes that are harmonic maps, and these are poses of "
            f"a mesh; choose one of {meshes}"
        )
    prepared = prepare(
        given.maps,
        Boundary.sample(Domain(outline, given.maps[0].cage, given.maps[0].holes)),
        given.points,
        variant=Variant(arguments.variant),
        triangles=given.triangles,
        anchor=given.anchor,
        turns=given.turns,
        through=arguments.through,
        loop=arguments.loop,
        bounds=_bounds(arguments),
        progress=report_progress,
    )
    frames = [prepared.frame(time) for time in arguments.times]
    results = {
        "anchor": np.array(prepared.sampled_domain.anchor),
        "positions": np.array([frame.positions for frame in frames]),
        "fz": np.array([frame.fz for frame in frames]),
        "fzbar": np.array([frame.fzbar for frame in frames]),
    }
    if prepared.variant.is_scaled:
        results["rho"] = np.array([frame.rho for frame in frames])
    if arguments.through:
        results["tangents"] = np.array(prepared.tangents)
    return results


def _compared(arguments: argparse.Namespace, given: Keyframes) -> dict[str, npt.NDArray[Any]]:
    """Interpolate by one of the paper's compared methods."""
    baseline = Baseline(arguments.variant)
    if given.triangles is None:
        raise LissomError(f"{baseline} needs the array 'triangles', of the points")
    if arguments.through:
        raise LissomError(f"{baseline} cannot pass through keyframes; leave --through out")
    if arguments.bounds and baseline is not Baseline.HANDLES:
        raise LissomError(f"{baseline} keeps no bounds; leave --bounds out")
    if arguments.principal and not baseline.unwraps:
        raise LissomError(NO_PRINCIPAL)
    if baseline is Baseline.HANDLES and given.handles is None:
        raise LissomError(
            "handles needs the array 'handles', the points that are led straight from key to key"
        )
    prepared = prepare_baseline(
        baseline,
        given.maps or given.poses,
        given.points,
        given.triangles,
        outline=given.outline,
        anchor=given.anchor,
        turns=given.turns,
        principal=arguments.principal,
        handles=given.handles,
        bounds=_bounds(arguments),
        loop=arguments.loop,
    )
    frames = [prepared.frame(time) for time in arguments.times]
    domain = prepared.domain
    results: dict[str, npt.NDArray[Any]] = {
        "anchor": np.array(domain.points[domain.anchor]),
        "triangles": domain.mesh.triangles,
    }
    for name in ("positions", "fz", "fzbar", "rho", "poisson_error", "angle_defect"):
        values = [getattr(frame, name) for frame in frames]
        if values[0] is not None:
            results[name] = np.array(values)
    defect = max(results.get("angle_defect", np.zeros(1)))
    if defect > UNFINISHED:
        print_notice(f"a mesh could not be flattened: angles of {defect:.2g} radians are left over")
    return results


def _bounds(arguments: argparse.Namespace) -> Bounds:
    if not arguments.bounds:
        return NATURAL.bounds
    k, sigma_a, sigma_b = arguments.bounds
    return Bounds(k=k, sigma_a=sigma_a, sigma_b=sigma_b)


def _require_in_range(times: tuple[float, ...], keyframes: int, *, loop: bool) -> None:
    """Refuse times before any long computation."""
    last = keyframes if loop else keyframes - 1
    for time in times:
        if keyframes >= 2 and not 0 <= time <= last:
            raise LissomError(
                f"time {time:g} is out of range: {keyframes} keyframes span the times from 0 to "
                f"{last}"
            )

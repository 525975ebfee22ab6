"""In-betweens of keyframes as arrays."""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from app.cli.arrays.keyframes import Keyframes
from app.cli.console import print_notice
from app.document import NATURAL, Baseline
from app.errors import LissomError, report_progress
from app.motion import prepare_baseline
from app.texts import N_, _
from engine.geometry import Domain
from engine.interpolation import Variant, prepare
from engine.maps import Boundary, Bounds

UNFINISHED = 1e-8  # angle defect, in radians, from which on a notice is printed
NO_PRINCIPAL = N_("--principal applies only to arap and mesh-eta; leave it out")


class BlendOptions(NamedTuple):
    """How keyframes are blended, and at which times."""

    variant: str  # of the paper, or a compared method
    times: tuple[float, ...]  # keyframe i is at time i
    through: bool
    loop: bool
    bounds: tuple[float, float, float] | None  # k, sigma_a, sigma_b; None are a new project's
    principal: bool

    @property
    def kept_bounds(self) -> Bounds:
        if self.bounds is None:
            return NATURAL.bounds
        k, sigma_a, sigma_b = self.bounds
        return Bounds(k=k, sigma_a=sigma_a, sigma_b=sigma_b)


def blend_keyframes(given: Keyframes, options: BlendOptions) -> dict[str, npt.NDArray[Any]]:
    """Return the in-betweens by name; a `LissomError` names options that do not fit."""
    # Before any long computation.
    last = given.count if options.loop else given.count - 1
    for time in options.times:
        if given.count >= 2 and not 0 <= time <= last:
            raise LissomError(
                _(
                    "time {time:g} is out of range: {count} keyframes span the times from 0 to "
                    "{last}"
                ).format(time=time, count=given.count, last=last)
            )
    is_compared = options.variant in tuple(Baseline)
    results = _compared(given, options) if is_compared else _harmonic(given, options)
    return {"times": np.array(options.times), **results}


def _harmonic(given: Keyframes, options: BlendOptions) -> dict[str, npt.NDArray[Any]]:
    """Interpolate by one of the paper's variants."""
    if options.bounds and not options.through:
        raise LissomError(_("--bounds applies only with --through; add --through as well"))
    if options.principal:
        raise LissomError(_(NO_PRINCIPAL))
    outline = given.outline
    if outline is None:
        meshes = ", ".join(each for each in Baseline if not each.needs_maps)
        raise LissomError(
            _(
                "{variant} needs keyframes that are harmonic maps, not poses of a mesh; choose "
                "one of {methods}"
            ).format(variant=options.variant, methods=meshes)
        )
    prepared = prepare(
        given.maps,
        Boundary.sample(Domain(outline, given.maps[0].cage, given.maps[0].holes)),
        given.points,
        variant=Variant(options.variant),
        triangles=given.triangles,
        anchor=given.anchor,
        turns=given.turns,
        through=options.through,
        loop=options.loop,
        bounds=options.kept_bounds,
        progress=report_progress,
    )
    frames = [prepared.frame(time) for time in options.times]
    results = {
        "anchor": np.array(prepared.sampled_domain.anchor),
        "positions": np.array([frame.positions for frame in frames]),
        "fz": np.array([frame.fz for frame in frames]),
        "fzbar": np.array([frame.fzbar for frame in frames]),
    }
    if prepared.variant.is_scaled:
        results["rho"] = np.array([frame.rho for frame in frames])
    if options.through:
        results["tangents"] = np.array(prepared.tangents)
    return results


def _compared(given: Keyframes, options: BlendOptions) -> dict[str, npt.NDArray[Any]]:
    """Interpolate by one of the paper's compared methods."""
    baseline = Baseline(options.variant)
    if given.triangles is None:
        raise LissomError(
            _("{method} needs the array 'triangles': the triangles of the points").format(
                method=baseline
            )
        )
    if options.through:
        raise LissomError(
            _("{method} cannot pass through keyframes; leave out --through").format(method=baseline)
        )
    if options.bounds and baseline is not Baseline.HANDLES:
        raise LissomError(_("{method} keeps no limits; leave out --bounds").format(method=baseline))
    if options.principal and not baseline.unwraps:
        raise LissomError(_(NO_PRINCIPAL))
    if baseline is Baseline.HANDLES and given.handles is None:
        raise LissomError(
            _(
                "the method handles needs the array 'handles': the points that go straight from "
                "key to key"
            )
        )
    prepared = prepare_baseline(
        baseline,
        given.maps or given.poses,
        given.points,
        given.triangles,
        outline=given.outline,
        anchor=given.anchor,
        turns=given.turns,
        principal=options.principal,
        handles=given.handles,
        bounds=options.kept_bounds,
        loop=options.loop,
    )
    frames = [prepared.frame(time) for time in options.times]
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
        print_notice(
            _(
                "the mesh could not be flattened; angle errors of up to {defect:.2g} radians remain"
            ).format(defect=defect)
        )
    return results

"""Limits at all times of a segment: the least change of corrections that keeps them.

Corrections are solved at few times, and a series goes through them. Between these times, or where
they were solved without limits, the series may break limits at some samples and times v. With a_v
the derivative of a distortion there by the unknowns, e_v its excess, and ℓ_j(t) the share of the
correction at node j in the series, the changes δ_j

    minimise Σ_j ½ δ_jᵀ H_j δ_j   where   Σ_j ℓ_j(t_v) a_v · δ_j ≤ −e_v,

H_j the metric of the correction with the rows of its points: what is pinned stays. The dual has
one unknown λ_v ≥ 0 for each v, and δ_j = −Σ_v ℓ_j(t_v) λ_v H_j⁻¹ a_v. A few rounds of it suffice.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import scipy.optimize

from engine.arrays import Floats
from engine.deform.correction.barrier import distortion_slopes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame
from engine.deform.correction.point_targets import PointTargets
from engine.deform.correction.solver import PointProblem, PointSolution
from engine.deform.correction.step_model import StepModel

ROUNDS = 10
NEAR = 0.02  # distance from a limit from which on a sample takes part
MARGIN = 0.0005  # slack that is left
MOST_HOT = 6  # samples that take part at one time
LONGEST = 1.0  # longest change of h in a round
RIDGE = 1e-9  # of the mean diagonal of the dual's form


class SolvedNode(NamedTuple):
    """A time of the series: the base at the nodes of paths, targets, and their correction."""

    base: BaseFrame
    targets: PointTargets
    solution: PointSolution


class CheckedTime(NamedTuple):
    """A time at which limits of ln σ_a, −ln σ_b and k, (3,), are kept at the samples."""

    time: float
    samples: BaseFrame
    limits: Floats


class _NearLimits(NamedTuple):
    """Samples near limits: excess (v,), slopes (v, 2N), and the shares of the nodes (v, n)."""

    excess: Floats
    slopes: Floats
    shares: Floats


def keep_limits(
    corrector: PointCorrector,
    nodes: Sequence[SolvedNode],
    checked: Sequence[CheckedTime],
    shares: Floats,
) -> tuple[list[PointSolution], bool]:
    """Return corrections whose series keeps the limits at the checked times, and whether it does.

    `shares` (c, n) are those of the nodes at the checked times.
    """
    problems = [PointProblem(corrector, n.base, n.targets, None) for n in nodes]
    states = [
        problem.state(n.solution.x, n.solution.shift)
        for problem, n in zip(problems, nodes, strict=True)
    ]
    models = [problem.step_model(at) for problem, at in zip(problems, states, strict=True)]
    aims, h_of = [at.residual for at in states], corrector.variables.at_nodes.h_of
    is_kept = False
    # Where targets are far out of reach, corrections may grow beyond all numbers.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        for _ in range(ROUNDS):
            x = np.array([at.frame.x for at in states])
            near = _near_limits(corrector, checked, shares, x)
            is_kept = bool(near.excess.max(initial=-1.0) <= 0.0)
            if is_kept or not np.isfinite(near.excess).all():
                break
            changes = _least_changes(models, near)
            if changes is None:
                break
            longest = max(np.abs(h_of(change)).max() for change, _ in changes)
            part = min(1.0, LONGEST / longest)
            for j, (change, shift) in enumerate(changes):
                at = states[j]
                moved = problems[j].state(at.frame.x + part * change, at.shift + part * shift)
                states[j] = problems[j].restored(moved, models[j], aims[j])
    found = [problem.solution(at, 0) for problem, at in zip(problems, states, strict=True)]
    return [replace(each, is_limited=True) for each in found], is_kept


def _least_changes(
    models: Sequence[StepModel], near: _NearLimits
) -> list[tuple[Floats, complex]] | None:
    """Return the changes of the unknowns and translations; None if there are none."""
    along = [model.solve_along(near.slopes.T) for model in models]
    form = sum(
        np.outer(share, share) * (near.slopes @ change)
        for share, (change, _) in zip(near.shares.T, along, strict=True)
    )
    pushes = _least_pushes(np.asarray(form), near.excess + MARGIN)
    if pushes is None:
        return None
    parts = near.shares.T * pushes
    return [
        (-change @ part, -complex(shift @ part))
        for part, (change, shift) in zip(parts, along, strict=True)
    ]


def _near_limits(
    corrector: PointCorrector, checked: Sequence[CheckedTime], shares: Floats, x: Floats
) -> _NearLimits:
    """Return the samples near limits for corrections x (n, 2N)."""
    values, following = corrector.variables.at_samples, corrector.boundary.next_samples
    excess, slopes, owners = [], [], []
    for number, (each, own) in enumerate(zip(checked, shares @ x, strict=True)):
        conformal, kept, mixed, factor = each.samples.apply_correction(values, own)
        a, g = np.abs(conformal), kept + mixed
        b, least = np.abs(g), np.exp(-each.limits[1])
        # σ_b itself and not its logarithm, so that folds open again.
        reached = np.array([np.log(a + b), -(a - b) / least, b / a])
        over = reached - np.array([each.limits[0], -1.0, each.limits[2]])[:, None]
        grows = over[:, following] > over
        is_peak = ~grows
        is_peak[:, following] &= grows
        # Not a number counts as an excess.
        kinds, samples = np.nonzero((is_peak & (over > -NEAR)) | ~np.isfinite(over))
        hottest = np.argsort(over[kinds, samples])[::-1][:MOST_HOT]
        kinds, samples = kinds[hottest], samples[hottest]
        by_h = each.samples.sign * kept + mixed
        of_all = distortion_slopes(a[samples], g[samples], by_h[samples], factor[samples])
        of_each = of_all[kinds, np.arange(len(samples))]
        of_each[kinds == 1] *= ((a - b)[samples[kinds == 1]] / least)[:, None]
        of_h, of_q = (of_each[:, k] - 1j * of_each[:, k + 1] for k in (0, 2))
        slopes.append(values.rows_at(samples, of_h, of_q))
        excess.append(over[kinds, samples])
        owners.append(np.full(len(samples), number))
    return _NearLimits(np.concatenate(excess), np.vstack(slopes), shares[np.concatenate(owners)])


def _least_pushes(form: Floats, excess: Floats) -> Floats | None:
    """Return the λ ≥ 0 that minimises ½ λᵀ form λ − excess · λ; None if it is not found."""
    form = form + RIDGE * np.trace(form) / len(form) * np.eye(len(form))
    try:
        root = np.linalg.cholesky(form)
        # ½ |Lᵀ λ − L⁻¹ excess|² is the same but for a constant.
        return np.asarray(scipy.optimize.nnls(root.T, np.linalg.solve(root, excess))[0])
    except (np.linalg.LinAlgError, RuntimeError):  # of many nearly equal samples
        return None

"""Hessians of the objective, projected, as sums over samples of the boundary.

The blocks of the Hessian are Gram matrices of rows of φ and ψ: the samples' rows times the roots of
each sample's contribution.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, Singles
from engine.deform.model.energy import RadialDerivatives
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.objective import Objective

# In single or double precision.
Reals = npt.NDArray[np.float32] | npt.NDArray[np.float64]

# Added samples are summed with their neighbours, unless their coefficients are this far above the
# median (near a bound).
STIFF = 3.0
# Samples this far above the median keep double precision.
HARD = 1e5
# Stiffness of a step against a rotation of the whole shape, over that against stretching it.
DAMPING = 1e-4


class _Quadrature(NamedTuple):
    """Samples (s,), and their contributions to the Hessian (6, s).

    The entries are, in the frames of f and g: radial and tangential of f, the same of g, between
    both radials, and the part that the projection removes from the tangential of f. The last `hard`
    samples are so stiff that single precision would lose the others beside them.
    """

    samples: Indices
    entries: Floats
    hard: int = 0


def projected_hessian(objective: Objective, jet: Evaluation, radial: RadialDerivatives) -> Floats:
    """Return the positive semidefinite part of the Hessian (u, u), upper triangle.

    Notes
    -----
    In the frames F / |F|, G / |G| of each sample the exact Hessian has the radial block
    [[h_aa, h_ab], [h_ab, h_bb]] and the tangential entries h_a / a, h_b / b, of which only
    h_a / a can be negative: max(h_a / a, 0) is the exact projection. The sum over the samples
    is in single precision but for the hard ones. Cost: 24 m n² for m samples.
    """
    samples, entries, hard = _quadrature(objective, radial)
    last = len(samples) - hard
    calm = _Quadrature(samples[:last], entries[:, :last])
    hessian = _held_hessian(objective, jet).copy()
    _add(
        objective,
        hessian,
        jet,
        calm,
        [*_rotation_roots(objective, jet), _damping_root(objective, jet, calm)],
        single=True,
    )
    if hard:
        _add(objective, hessian, jet, _Quadrature(samples[last:], entries[:, last:]))
    return hessian


def single_hessian(
    objective: Objective, jet: Evaluation, radial: RadialDerivatives
) -> Singles | None:
    """Return the projected Hessian in single precision throughout, or None.

    None where samples are hard, around holes, where functions may nearly coincide, and where fewer
    than two handles leave the shape free to rotate or move.
    """
    quadrature = _quadrature(objective, radial)
    is_held = len(objective.targets.positions) > 1 or objective.handles.armature is not None
    if quadrature.hard or objective.boundary.holes or not is_held:
        return None
    hessian = _held_hessian(objective, jet).astype(np.float32)
    further = [*_rotation_roots(objective, jet), _damping_root(objective, jet, quadrature)]
    _add(objective, hessian, jet, quadrature, further, single=True)
    return hessian


def hessian_product(
    objective: Objective, jet: Evaluation, radial: RadialDerivatives, change: Evaluation
) -> Floats:
    """Return the product (u,) of the Hessian over all samples with a change.

    In double precision, and without the tiny stiffness against rotation; the matrix is not formed.
    Cost: 16 m n for m samples.
    """
    frame_f, frame_g = _frames(jet.f, jet.g)
    f, g = frame_f * change.f, frame_g * change.g
    around_a = np.maximum(radial.around_a, 0.0)
    by_f = radial.aa * f.real + radial.ab * g.real - 1j * around_a * f.imag
    by_g = radial.ab * f.real + radial.bb * g.real - 1j * radial.around_b * g.imag
    pull = 2.0 * objective.handles.stiffness * objective.target_error_change(jet, change.positions)
    rows, coordinates = objective.boundary.basis_derivatives, objective.handles.basis_coordinates
    by_phi = (by_f * frame_f) @ rows + pull.conj() @ coordinates
    by_psi = (by_g * frame_g) @ rows + pull @ coordinates
    if (armature := objective.armature_at(jet)) is not None:
        pull = armature.hessian_product(change.shaft_positions)
        coordinates = armature.armature.basis_coordinates
        by_phi += pull.conj() @ coordinates
        by_psi += pull @ coordinates
    for frame in objective.rotation_frames(jet):
        along = (frame * change.fz[objective.rotation_constraints]).real
        by_phi += (along * frame) @ objective.rotation_rows
    return objective.by_unknowns(by_phi, by_psi)


def stiffening_hessian(
    objective: Objective, jet: Evaluation, radial: RadialDerivatives, samples: Indices
) -> Floats:
    """Return the positive part of the Hessian (u, u) of these samples, upper triangle."""
    hessian = np.zeros_like(objective.handles.hessian)
    entries = _entries(radial)[:, samples]
    _add(objective, hessian, jet, _Quadrature(samples, entries))
    return hessian


def _add(
    objective: Objective,
    hessian: Reals,
    jet: Evaluation,
    quadrature: "_Quadrature",
    more: Sequence[Complexes] = (),
    *,
    single: bool = False,
) -> None:
    """Add samples, and further rows of φ, to a Hessian; optionally in single precision."""
    r, u = objective.boundary.basis.shape[1], len(hessian)
    by_phi, by_psi, cross = _roots(objective, jet, quadrature, more, single=single)
    of_phi, of_psi = by_phi.T @ by_phi, by_psi.T @ by_psi
    across = by_psi[: len(cross)]
    across *= cross[:, None]
    mixed = by_phi[: len(cross)].T @ across
    hessian[: 2 * r, : 2 * r] += of_phi
    hessian[2 * r :, 2 * r :] += of_psi[: u - 2 * r, : u - 2 * r]
    hessian[: 2 * r, 2 * r :] += mixed[:, : u - 2 * r]
    if objective.boundary.holes:
        _fold_logarithms(objective, hessian, mixed, of_psi)


def _fold_logarithms(objective: Objective, hessian: Reals, mixed: Reals, of_psi: Reals) -> None:
    """Add the contributions of ψ's logarithms, the conjugates of φ's, to a Hessian (u, u).

    Parameters
    ----------
    hessian : float64, shape (u, u)
        Its upper triangle is changed.
    mixed : float32 or float64, shape (2r, 2r − 2)
        Between the parts of φ and those of ψ_1, ψ_2, …
    of_psi : float32 or float64, shape (2r − 2, 2r − 2)
    """
    count = 2 * len(objective.boundary.holes)
    sign = np.tile([1.0, -1.0], count // 2)  # a conjugate has the other imaginary part
    logs = slice(len(mixed) - count, len(mixed))
    across, own = mixed[:, -count:] * sign, of_psi[:, -count:] * sign
    hessian[: len(mixed), logs] += across
    hessian[logs, logs] += across[logs].T + sign[:, None] * own[-count:]
    hessian[logs, len(mixed) :] += own[:-count].T


def negative_part(objective: Objective, jet: Evaluation, radial: RadialDerivatives) -> Floats:
    """Return the part that the projection removed from the Hessian of φ, (2r, 2r).

    `projected_hessian` minus this is the exact Hessian; it need not be positive.
    """
    samples, entries, _ = _quadrature(objective, radial)
    bent = entries[-1] > 0
    f = jet.f[samples[bent]]
    roots = -1j * np.sqrt(entries[-1][bent]) * f.conj() / np.abs(f)
    rows = objective.boundary.basis_derivatives[samples[bent]] * roots[:, None]
    turning = _rotation_roots(objective, jet, removed=True)
    by_phi = np.concatenate([rows, *turning]).view(np.float64)
    removed: Floats = by_phi.T @ by_phi
    return removed


def _roots(
    objective: Objective,
    jet: Evaluation,
    quadrature: "_Quadrature",
    more: Sequence[Complexes],
    *,
    single: bool,
) -> tuple[Reals, Reals, Reals]:
    """Return rows of φ and of ψ whose Gram matrices are their blocks of the Hessian.

    Further rows of φ come last. The first s rows of each are the radial rows of the s samples: the
    third array (s,) weighs their products between φ and ψ.
    """
    samples, entries, _ = quadrature
    kind = np.complex64 if single else np.complex128
    rows = objective.boundary.basis_derivatives[samples].astype(kind, copy=False)
    frame_f, frame_g = _frames(jet.f[samples], jet.g[samples])
    root_f, around_f, root_g, around_g = np.sqrt(entries[:4])
    count, n = rows.shape
    # Where the projection removed the tangential entry there is no row.
    held = np.flatnonzero(around_f)
    last = count + len(held)
    by_phi = np.empty((last + sum(map(len, more)), n), kind)
    by_psi = np.empty((2 * count, n - 1), kind)
    along_f, along_g = (root_f * frame_f).astype(kind), (root_g * frame_g).astype(kind)
    across_f = (-1j * (around_f * frame_f)[held]).astype(kind)
    across_g = (-1j * around_g * frame_g).astype(kind)
    np.multiply(rows, along_f[:, None], out=by_phi[:count])
    np.multiply(rows[held], across_f[:, None], out=by_phi[count:last])
    np.multiply(rows[:, 1:], along_g[:, None], out=by_psi[:count])
    np.multiply(rows[:, 1:], across_g[:, None], out=by_psi[count:])
    if more:
        np.concatenate(more, out=by_phi[last:], casting="same_kind")
    both = root_f * root_g
    cross = entries[4] / np.where(both > 0, both, 1.0)
    real: np.dtype[Any] = np.dtype(np.float32 if single else np.float64)
    return by_phi.view(real), by_psi.view(real), cross.astype(real, copy=False)


def _quadrature(objective: Objective, radial: RadialDerivatives) -> "_Quadrature":
    """Return the samples that enter the Hessian; calm ones stand for added neighbours, too."""
    boundary, entries = objective.boundary, _entries(radial)
    own, _ = boundary.original_samples
    density = (radial.aa + radial.bb) / (boundary.barrier_weights * boundary.stiffness)
    median = float(np.partition(density, len(density) // 2)[len(density) // 2])
    stiff = np.flatnonzero(density > STIFF * median)
    hard = density[stiff] > HARD * median
    stiff = np.concatenate([stiff[~hard], stiff[hard]])
    alone = entries[:, stiff]
    entries[:, stiff] = 0.0
    summed = np.add.reduceat(entries, own, axis=1)
    some = summed[0] > 0
    return _Quadrature(
        np.concatenate([own[some], stiff]),
        np.hstack([summed[:, some], alone]),
        int(np.count_nonzero(hard)),
    )


def _held_hessian(objective: Objective, jet: Evaluation) -> Floats:
    """Return the Hessian of the energy of the handles' positions and the armature, (u, u)."""
    held = objective.handles.hessian
    added, removed = objective.armature_rows(jet)
    removed = np.concatenate([objective.pull_rows(jet), removed])
    if len(removed):
        held = held - removed.T @ removed
    return held + added.T @ added if len(added) else held


def _damping_root(objective: Objective, jet: Evaluation, calm: "_Quadrature") -> Complexes:
    """Return the row of a tiny stiffness against rotation of the whole shape.

    One handle leaves the rotation of the shape free; rounding alone would then rotate it.
    """
    stiffness = DAMPING * calm.entries[0].sum()
    per_sample = -1j * np.sqrt(stiffness) * objective.boundary.weights / jet.f
    row: Complexes = per_sample[None, :] @ objective.boundary.basis_derivatives
    return row


def _rotation_roots(
    objective: Objective, jet: Evaluation, *, removed: bool = False
) -> list[Complexes]:
    """Return the rows of φ of `Objective.rotation_frames`."""
    frames = objective.rotation_frames(jet, removed=removed)
    return [frame[:, None] * objective.rotation_rows for frame in frames]


def _frames(f: Complexes, g: Complexes) -> tuple[Complexes, Complexes]:
    """Return conj(F) / |F| and conj(G) / |G| (s,), 1 where G is 0."""
    b = np.abs(g)
    frame_g = np.ones_like(g)
    np.divide(g.conj(), b, out=frame_g, where=b > 0)
    return f.conj() / np.abs(f), frame_g


def _entries(radial: RadialDerivatives) -> Floats:
    """Return the samples' contributions to the Hessian, as the entries of a `_Quadrature`."""
    return np.array(
        [
            radial.aa,
            np.maximum(radial.around_a, 0.0),
            radial.bb,
            radial.around_b,
            radial.ab,
            np.maximum(-radial.around_a, 0.0),
        ]
    )

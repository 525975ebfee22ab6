"""Continuous branches of log f_z (Sections 3.5 and 7.2)."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, Integers, freeze
from engine.errors import EngineError
from engine.paths.integration_paths import IntegrationPaths

MOST_TURNS = 1_000_000  # in all at the anchor; with more an angle has less than nine digits
LARGEST_TURN = 1.0  # radians that f_z may turn along a step without a subdivision
MOST_BISECTIONS = 12
TURN_COUNT = (
    "The turns between {keyframes} keyframes must be {count} integers, not {dtype} of shape "
    "{shape}."
)


def continue_logarithm(
    fz: Complexes,
    log_fz_z: Complexes,
    paths: IntegrationPaths,
    evaluate: Callable[[Complexes], Complexes],
) -> Complexes:
    """Return log f_z at the nodes (s,), continuous along the paths, principal at the anchor.

    Its exponential equals `fz` to rounding.

    Parameters
    ----------
    fz : complex128, shape (s,)
        A holomorphic function without zeros, at the nodes.
    log_fz_z : complex128, shape (s,)
        Its logarithmic derivative there, Φ'' / Φ'.
    evaluate : callable
        Returns the function at points (p,); called only where a step turns the function far.
    """
    parent = paths.tree.parent
    turns = np.angle(fz / fz[parent])  # Equation (15), imaginary part
    # The rate of the turn at both ends: the ratio of f_z does not show whole turns within a step.
    pace = np.abs((log_fz_z * paths.steps).imag)
    pace = np.maximum(pace, np.abs((log_fz_z[parent] * paths.steps).imag))
    far = np.flatnonzero(np.maximum(np.abs(turns), pace) > LARGEST_TURN)
    if len(far):
        starts = paths.nodes[parent[far]]
        turns[far] = _turns_along(starts, paths.nodes[far], float(pace[far].max()), evaluate)
    principal = np.angle(fz)
    turns[0] = principal[0]
    arguments = paths.tree.sums(turns)  # Equation (2), imaginary part
    # Only the integer is taken from the sum, so rounding does not accumulate along the path.
    sheets = np.round((arguments - principal) / (2 * np.pi))
    logarithm: Complexes = np.log(np.abs(fz)) + 1j * (principal + 2 * np.pi * sheets)
    return logarithm


def root_sheets(anchor_fz: Complexes, turns: npt.ArrayLike | None = None) -> Integers:
    """Choose the branch of each keyframe's logarithm at the anchor (Section 7.2).

    Parameters
    ----------
    anchor_fz : complex128, shape (q,)
        f_z of the keyframes at the anchor.
    turns : int, shape (q − 1,), optional
        Full turns of the shape between neighbouring keyframes beyond the shorter way; default 0.
        The number is relative, so it stays valid while the poses are edited.

    Returns
    -------
    int32, shape (q,)
        n such that the logarithm at the anchor is Log f_z + 2πi n. Without turns the arguments of
        neighbouring keyframes differ by at most π. The first n is 0.

    Raises
    ------
    EngineError
        If `turns` is too long or short, not of integers, or too large.
    """
    extra = np.zeros(len(anchor_fz) - 1, np.int32) if turns is None else np.asarray(turns)
    if extra.shape != (len(anchor_fz) - 1,) or extra.dtype.kind not in "iu":
        raise EngineError(
            TURN_COUNT,
            keyframes=len(anchor_fz),
            count=len(anchor_fz) - 1,
            dtype=extra.dtype,
            shape=extra.shape,
        )
    principal = np.angle(anchor_fz)
    shorter = np.angle(anchor_fz[1:] / anchor_fz[:-1])
    sheets = np.cumsum(np.round((shorter - np.diff(principal)) / (2 * np.pi)) + extra)
    if np.abs(sheets).max(initial=0.0) > MOST_TURNS:
        raise EngineError(
            "The keyframes make more than {most:,} whole turns; give fewer turns.", most=MOST_TURNS
        )
    return freeze(np.concatenate([[0], sheets]).astype(np.int32))


def shorter_turns(anchor_fz: Complexes, leads: Floats) -> Integers:
    """Return full turns for `root_sheets` that turn the whole shape the shorter way.

    Where a part of the shape curls by more than half a turn, the shorter way of the anchor may be
    the longer one of the rest.

    Parameters
    ----------
    anchor_fz : complex128, shape (q,)
        f_z of the keyframes at the anchor.
    leads : float64, shape (q,)
        By how much each keyframe turns the shape further than the anchor, in the mean.

    Returns
    -------
    int32, shape (q − 1,)
        With them the mean turn between neighbouring keyframes is at most π.
    """
    change = np.angle(anchor_fz[1:] / anchor_fz[:-1]) + np.diff(leads)
    return freeze(-np.round(change / (2 * np.pi)).astype(np.int32))


def _turns_along(
    starts: Complexes, ends: Complexes, pace: float, evaluate: Callable[[Complexes], Complexes]
) -> Floats:
    """Follow the argument along segments (p,), subdivided until each part turns little.

    `pace` is the largest expected turn along a segment.
    """
    todo: Indices = np.arange(len(starts))
    turns = np.zeros(len(starts))
    pieces = max(8, int(np.ceil(2 * pace)))
    for _ in range(MOST_BISECTIONS):
        along = np.linspace(0.0, 1.0, pieces + 1)
        samples = starts[todo, None] + (ends - starts)[todo, None] * along
        values = evaluate(samples.ravel()).reshape(samples.shape)
        ratios = values[:, 1:] * values[:, :-1].conj()
        each = np.where(ratios == 0, np.pi, np.angle(ratios))
        turns[todo] = each.sum(axis=1)
        todo = todo[np.abs(each).max(axis=1) > LARGEST_TURN]
        if not len(todo):
            return turns
        pieces *= 2
    raise EngineError(
        "f_z vanishes, or nearly vanishes, close to ({x:.6g}, {y:.6g}); the keyframe folds there. "
        "Pose it again without folds.",
        x=starts[todo[0]].real,
        y=starts[todo[0]].imag,
    )

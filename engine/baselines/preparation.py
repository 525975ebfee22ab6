"""From keyframes and a mesh to in-betweens by any of the methods."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy.typing as npt

from engine.arrays import Complexes
from engine.baselines.arap import ArapInbetweens
from engine.baselines.frames import MeshFrame, MeshInbetweens
from engine.baselines.mesh_keyframes import MeshKeyframe, mesh_keyframes
from engine.baselines.poisson import PoissonStep
from engine.baselines.triangulated_domain import TriangulatedDomain
from engine.errors import EngineError
from engine.maps import HarmonicMap
from engine.variant import Baseline


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PreparedBaseline:
    """In-betweens of all keyframes at any time; keyframe i is at time i.

    Frames are pure functions of frozen arrays, like those of `engine.interpolation.Prepared`.

    Parameters
    ----------
    baseline : Baseline
    domain : TriangulatedDomain
        Its anchor is the vertex whose position and rotation are linear in time.
    intervals : tuple of MeshInbetweens, length q − 1 or q
        One for each pair of neighbouring keyframes; in a loop one more, from the last to the first.
    """

    baseline: Baseline
    domain: TriangulatedDomain
    intervals: tuple[MeshInbetweens, ...]

    def at(self, time: float) -> Complexes:
        """Return the positions (n,) of the vertices at a time, as `frame` does."""
        return self.frame(time).positions

    def frame(self, time: float) -> MeshFrame:
        """Return the in-between at a time from 0 to the number of intervals.

        Raises
        ------
        EngineError
            If the time is out of range.
        """
        last = len(self.intervals)
        if not 0.0 <= time <= last:
            raise EngineError(
                f"Time {time:g} is out of range: the keyframes span the times from 0 to {last}."
            )
        interval = min(int(time), last - 1)
        return self.intervals[interval].frame(float(time) - interval)


def prepare_baseline(
    baseline: Baseline | str,
    keyframes: Sequence[HarmonicMap | Complexes],
    points: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    anchor: complex | None = None,
    turns: npt.ArrayLike | None = None,
    principal: bool = False,
    loop: bool = False,
) -> PreparedBaseline:
    """Prepare the in-betweens of keyframes by a method that the paper compares its own with.

    Parameters
    ----------
    baseline : Baseline or str
    keyframes : sequence of HarmonicMap, or of complex of shape (n,); length q ≥ 2
        Maps of the domain, or where the vertices are in each keyframe.
    points : complex, shape (n,)
        The vertices of the domain.
    triangles : int, shape (m, 3)
    anchor : complex, optional
        The vertex next to it becomes the anchor; by default the one farthest from the border.
    turns : int, shape (q − 1,), or (q,) in a loop, optional
        Whole turns between neighbouring keyframes beyond the shorter way.
    principal : bool
        With ARAP and mesh η: whether the angles are those between −π and π of each triangle by
        itself, without regard to its neighbours: the version that fails.
    loop : bool
        Whether the last keyframe leads on to the first one, which is at time q again.

    Raises
    ------
    EngineError
        If anything of that does not hold, or a keyframe folds.
    """
    baseline = _known_baseline(baseline)
    domain = TriangulatedDomain.of(points, triangles, anchor)
    positions = [each(domain.points) if callable(each) else each for each in keyframes]
    around = mesh_keyframes(
        domain,
        [*positions, *positions[:1]] if loop else positions,
        turns=turns,
        principal=principal,
    )
    return PreparedBaseline(
        baseline=baseline,
        domain=domain,
        intervals=_mesh_intervals(domain, around),
    )


def _mesh_intervals(
    domain: TriangulatedDomain, keyframes: Sequence[MeshKeyframe]
) -> tuple[MeshInbetweens, ...]:
    step = PoissonStep.on(domain)
    return tuple(
        ArapInbetweens(first=first, second=second, step=step)
        for first, second in pairwise(keyframes)
    )


def _known_baseline(baseline: Baseline | str) -> Baseline:
    try:
        return Baseline(baseline)
    except ValueError:
        names = ", ".join(Baseline)
        raise EngineError(f"There is no method {baseline!r}; there are {names}.") from None

"""From keyframes and a mesh to in-betweens by any of the methods."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy.typing as npt

from app.baseline import Baseline
from app.motion.rival_methods.arap import ArapInbetweens
from app.motion.rival_methods.blended_metric import FlatInbetweens
from app.motion.rival_methods.ffmp import FfmpInbetweens
from app.motion.rival_methods.flattening import Flattening
from app.motion.rival_methods.harmonic import (
    ConformalInbetweens,
    HandleInbetweens,
    require_holomorphic,
)
from app.motion.rival_methods.mesh_eta import MeshEtaInbetweens
from app.motion.rival_methods.mesh_keyframes import (
    MeshFrame,
    MeshInbetweens,
    MeshKeyframe,
    mesh_keyframes,
)
from app.motion.rival_methods.poisson import PoissonStep
from app.motion.rival_methods.triangulated_domain import TriangulatedDomain
from engine.arrays import Complexes, as_points
from engine.deform import Deformer, Handles
from engine.errors import EngineError
from engine.geometry import ON_OUTLINE, Domain, diameter, require_inside
from engine.interpolation import Variant, prepare, require_keyframes, segment_at
from engine.maps import Boundary, Bounds, HarmonicMap


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PreparedBaseline:
    """In-betweens of all keyframes at any time; keyframe i is at time i.

    Frames are pure functions of frozen arrays, like those of `engine.interpolation.Prepared`.

    Parameters
    ----------
    domain : TriangulatedDomain
        Its anchor is the vertex whose position and rotation are linear in time.
    segments : tuple of MeshInbetweens, length q − 1 or q
        One for each pair of neighbouring keyframes; in a loop one more, from the last to the first.
    """

    baseline: Baseline
    domain: TriangulatedDomain
    segments: tuple[MeshInbetweens, ...]

    def frame(self, time: float) -> MeshFrame:
        """Return the in-between at a time from 0 to the number of segments.

        Raises
        ------
        EngineError
            If the time is out of range.
        """
        interval, moment = segment_at(time, len(self.segments))
        return self.segments[interval].frame(moment)


def prepare_baseline(
    baseline: Baseline | str,
    keyframes: Sequence[HarmonicMap | Complexes],
    points: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    outline: npt.ArrayLike | None = None,
    anchor: npt.ArrayLike | None = None,
    turns: npt.ArrayLike | None = None,
    principal: bool = False,
    handles: npt.ArrayLike | None = None,
    bounds: Bounds = Bounds(),
    loop: bool = False,
) -> PreparedBaseline:
    """Prepare the in-betweens of keyframes by a rival method.

    Parameters
    ----------
    keyframes : sequence of HarmonicMap, or of complex of shape (n,); length q ≥ 2
        Maps of the domain, or positions of the vertices in each keyframe; a baseline that
        `needs_maps` must be given maps.
    points : complex, shape (n,)
        The vertices of the domain.
    outline : complex, shape (p,), optional
        The domain's boundary, inside the cage of the maps, around the vertices: for baselines that
        `needs_maps`.
    anchor : complex, optional
        The vertex next to it becomes the anchor; by default the one farthest from the border.
    turns : int, shape (q − 1,), or (q,) in a loop, optional
        Whole turns between neighbouring keyframes beyond the shorter way.
    principal : bool
        Whether the angles of ARAP and mesh η are those between −π and π of each triangle,
        regardless of its neighbours: the version that fails.
    handles : complex, shape (h,), optional
        Points of the domain that move straight, for the baseline of that name.
    bounds : Bounds
        For the same baseline.
    loop : bool
        Whether the last keyframe leads on to the first one, which is at time q again.

    Raises
    ------
    EngineError
        If an argument is invalid, or a keyframe folds.
    """
    baseline = _known_baseline(baseline)
    domain = TriangulatedDomain.of(points, triangles, anchor)
    around = [*keyframes, *keyframes[:1]] if loop else list(keyframes)
    border = None if outline is None else as_points(outline, "outline", at_least=3)
    if border is not None:
        holes = around[0].holes if around and isinstance(around[0], HarmonicMap) else ()
        loops, near = [hole.outline for hole in holes], ON_OUTLINE * diameter(border)
        require_inside(border, domain.points, "point", holes=loops, tolerance=near)
    intervals: Sequence[MeshInbetweens]
    if baseline.needs_maps:
        maps = _maps_over_one_cage(baseline, around)
        if border is None:
            raise EngineError(
                "The method {baseline} needs the outline of the domain; give the outline.",
                baseline=baseline,
            )
        boundary = Boundary.sample(Domain(border, maps[0].cage, maps[0].holes))
        if baseline is Baseline.HANDLES:
            intervals = _by_handles(domain, boundary, maps, handles, bounds)
        else:
            intervals = _conformal(domain, boundary, maps, turns)
    else:
        positions = [each(domain.points) if callable(each) else each for each in around]
        keys = mesh_keyframes(domain, positions, turns=turns, principal=principal)
        intervals = _on_mesh(baseline, domain, keys)
    return PreparedBaseline(baseline=baseline, domain=domain, segments=tuple(intervals))


def _on_mesh(
    baseline: Baseline, domain: TriangulatedDomain, keyframes: Sequence[MeshKeyframe]
) -> list[MeshInbetweens]:
    """Prepare a method that uses only the keyframes' triangles."""
    pairs = list(pairwise(keyframes))
    if baseline is Baseline.SIG13:
        flattening = Flattening.on(domain)
        return [FlatInbetweens.of(*pair, flattening) for pair in pairs]
    step = PoissonStep.on(domain)
    if baseline is Baseline.ARAP:
        return [ArapInbetweens(first=first, second=second, step=step) for first, second in pairs]
    if baseline is Baseline.FFMP:
        return [FfmpInbetweens.of(*pair, step) for pair in pairs]
    return [MeshEtaInbetweens.of(*pair, step) for pair in pairs]


def _by_handles(
    domain: TriangulatedDomain,
    boundary: Boundary,
    maps: Sequence[HarmonicMap],
    points: npt.ArrayLike | None,
    bounds: Bounds,
) -> list[MeshInbetweens]:
    places = as_points(() if points is None else points, "handles")
    if not len(places):
        raise EngineError(
            "The method 'handles' needs handles that lead from key to key. Name points of the "
            "domain as handles."
        )
    deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, places), bounds=bounds)
    return [
        HandleInbetweens(domain=domain, deformer=deformer, first=first, second=second)
        for first, second in pairwise(maps)
    ]


def _conformal(
    domain: TriangulatedDomain,
    boundary: Boundary,
    maps: Sequence[HarmonicMap],
    turns: npt.ArrayLike | None,
) -> list[MeshInbetweens]:
    require_holomorphic(maps, boundary)
    prepared = prepare(
        maps,
        boundary,
        domain.points,
        variant=Variant.NU,
        triangles=domain.mesh.triangles,
        anchor=domain.points[domain.anchor],
        turns=turns,
    )
    return [
        ConformalInbetweens(domain=domain, prepared=prepared, start=start)
        for start in range(len(maps) - 1)
    ]


def _maps_over_one_cage(
    baseline: Baseline, keyframes: Sequence[HarmonicMap | Complexes]
) -> list[HarmonicMap]:
    """Raise an `EngineError` for keyframes that are no maps, or have different cages."""
    maps = [each for each in keyframes if isinstance(each, HarmonicMap)]
    if len(maps) < len(keyframes):
        raise EngineError(
            "The method {baseline} needs keyframes that are harmonic maps, not positions of a "
            "mesh; choose another method.",
            baseline=baseline,
        )
    require_keyframes(maps)
    return maps


def _known_baseline(baseline: Baseline | str) -> Baseline:
    try:
        return Baseline(baseline)
    except ValueError:
        names = ", ".join(Baseline)
        raise EngineError(
            "There is no method {baseline!r}; choose one of {names}.",
            baseline=baseline,
            names=names,
        ) from None

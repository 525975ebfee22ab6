"""The sliders of a clip, on top of its motion from key to key."""

from collections.abc import Callable, Sequence
from copy import copy
from functools import partial

import numpy as np

from app.document import (
    Clip,
    Layer,
    Pose,
    Variant,
    limits_along,
    slider_poses,
    slider_weights_at,
    with_stiffness,
)
from app.motion.inbetweens.content_cache import digest
from app.motion.inbetweens.outline_cache import SAMPLED, nbytes_or_0
from app.motion.inbetweens.pins.auto_pins import BESIDE
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.secondary_correction import SecondaryCorrection, SolvedSliders
from app.motion.inbetweens.segment_keys import frame_content
from engine.arrays import Complexes, Indices
from engine.geometry import diameter
from engine.interpolation import Inbetweens
from engine.sliders import FrameSolution, FrameSolver, SliderFrame, SliderPoses

UNMOVED = 0.5  # pixels between a target in a pose and the handle at rest

# In-betweens of keys around a frame at a sampler's points, and the time among them.
BaseAt = Callable[[float], tuple[Inbetweens, float]]


class SliderStage:
    """Adds the poses of a clip's sliders to its in-betweens, at the points of a sampler.

    Handles that no pose of a slider moves stay where the in-betweens have them. The layer's limits
    hold for any values. `base_of` returns the motion of the keys at the points of any sampler.
    Solutions are cached by content in the sampler's outline.
    """

    def __init__(
        self,
        clip: Clip,
        variant: Variant,
        sampler: PoseSampler,
        base_of: Callable[[PoseSampler], BaseAt],
    ) -> None:
        self.clip, self._variant, self._sampler, self._base_of = clip, variant, sampler, base_of
        self._prepared: tuple[FrameSolver, BaseAt] | None = None

    def with_values(self, clip: Clip) -> "SliderStage":
        """Return the stage of a clip that differs only in values of sliders."""
        changed = copy(self)
        changed.clip = clip
        return changed

    @property
    def poses(self) -> tuple[Pose, ...]:
        return _apart(slider_poses(self.clip))[0]

    def frame(self, base: Inbetweens, time: float, frame: float) -> SliderFrame:
        """Add the sliders at a frame to an in-between of the sampler at a time."""
        return add_sliders(self._sampler, base, time, self.solved_at(frame))

    def solved_at(self, frame: float) -> SolvedSliders:
        """Return the curbed weights of a frame, and how strongly they are curbed."""
        solver, base_at = self._prepare()

        def solve() -> FrameSolution:
            inbetweens, time = base_at(frame)
            weights = np.array(slider_weights_at(self.clip, frame))
            return solver.solve(weights, inbetweens.frame_with_values(time)[1])

        key = solver, frame_content(self.clip, frame, self._variant)
        solution = self._sampler.known.slider_solution(key, solve)
        return SolvedSliders(solution, slider_poses(self.clip))

    def _prepare(self) -> tuple[FrameSolver, BaseAt]:
        """Prepare the solver, and the in-betweens where it needs them."""
        if self._prepared is None:
            poses, turns = _apart(slider_poses(self.clip))
            layer, sampler = self.clip.layer, self._sampler
            solver = _solver(layer, sampler, poses, turns)
            beside = PoseSampler(
                layer,
                points=np.array([sampler.sites.anchor]),
                values_at=solver.nodes,
                sibling=sampler,
            )
            self._prepared = solver, self._base_of(beside)
        return self._prepared


def apply_correction(
    sampler: PoseSampler,
    inbetweens: Inbetweens,
    time: float,
    correction: SecondaryCorrection,
) -> Inbetweens | SliderFrame:
    """Return the in-betweens of a sampler, changed by a correction at a time."""
    found: Inbetweens | SliderFrame = inbetweens
    if correction.sliders is not None:
        found = add_sliders(sampler, inbetweens, time, correction.sliders)
    if correction.series is not None:
        found = found.with_correction(correction.series, sampler.basis)
    return found


def add_sliders(
    sampler: PoseSampler, base: Inbetweens, time: float, sliders: SolvedSliders
) -> SliderFrame:
    """Return an in-between of a sampler at a time with sliders."""
    solution, poses = sliders
    extension = None if solution.densities is None else sampler.extension
    forms = solution.forms
    basis = None
    if forms is not None:
        basis = sampler.find("forms", digest(forms), partial(sampler.basis.combined, forms))
    found = _sampled_poses(sampler, *_apart(poses))
    return found.add_to(base, time, solution, extension, basis)


def _sampled_poses(sampler: PoseSampler, poses: Sequence[Pose], turns: Indices) -> SliderPoses:
    """Return poses of sliders with their full turns at a sampler's points, cached by content."""
    content = digest(turns, *(each for p in poses for each in (p.phi, p.psi, p.logs)))

    def make() -> SliderPoses:
        return SliderPoses.of([sampler.samples(pose) for pose in poses], turns, sampler.sites)

    return sampler.find("slider poses", content, make)


def _solver(
    layer: Layer, sampler: PoseSampler, poses: tuple[Pose, ...], turns: Indices
) -> FrameSolver:
    """Return the solver of frames with these poses of sliders.

    It is cached by content for all samplers of the outline and the anchor.
    """
    domain, sites = layer.domain, sampler.sites
    bounds = limits_along(layer, with_stiffness(layer, sites.boundary))
    pins, is_anchored = _pins(layer, poses, sites.anchor), layer.has_parent
    maps = [sampler.samples(pose).map for pose in poses]
    content = digest(
        *(*domain.loops, *domain.cages, turns, pins),
        *map(np.atleast_1d, (bounds.k, bounds.sigma_a, bounds.sigma_b)),
        *(each for f in maps for each in (f.phi, f.psi, f.logs)),
    )
    given = (maps, turns, sites, sampler.known.transform, bounds, pins)
    make = partial(FrameSolver.of, *given, is_anchored=is_anchored)
    return SAMPLED.find(("slider", content, sites.anchor, is_anchored), make, nbytes_or_0)


def _apart(poses: Sequence[tuple[Pose, int]]) -> tuple[tuple[Pose, ...], Indices]:
    """Return the poses of sliders, and their full turns."""
    turns = np.array([turns for _, turns in poses], dtype=np.intp)
    return tuple(pose for pose, _ in poses), turns


def _pins(layer: Layer, poses: tuple[Pose, ...], anchor: complex) -> Complexes:
    """Return the handles at rest that no pose moves, (m,).

    A handle on the anchor of an attached layer moves with the anchor.
    """
    near = BESIDE * diameter(layer.domain.outline) if layer.has_parent else 0.0
    sprung = layer.sprung_handles
    return np.array(
        [
            each.position
            for each in layer.handles
            if not (each.is_unpinned or each.id in sprung or not layer.has_auto_pins)
            and abs(each.position - anchor) >= near
            and all(abs(p.targets[each.id].position - each.position) < UNMOVED for p in poses)
        ],
        dtype=np.complex128,
    )

"""The sliders of a clip, on top of its motion from key to key."""

from collections.abc import Callable

import numpy as np

from app.document import Clip, Layer, Pose, Variant, slider_poses, slider_weights_at
from app.motion.inbetweens.auto_pins import BESIDE
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.segment_keys import frame_content
from engine.arrays import Complexes
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
        named = slider_poses(clip)
        self.poses = tuple(pose for pose, _ in named)
        self._turns = np.array([turns for _, turns in named], dtype=np.intp)
        self._prepared: tuple[SliderPoses, FrameSolver, BaseAt] | None = None

    def frame(self, base: Inbetweens, time: float, frame: float) -> SliderFrame:
        """Add the sliders at a frame to an in-between of the sampler at a time."""
        sampler, solution = self._sampler, self.solution_at(frame)
        poses, _, _ = self._prepare()
        extension = None if solution.densities is None else sampler.extension
        basis = None if solution.h is None else sampler.basis
        return poses.add_to(base, time, solution, extension, basis)

    def solution_at(self, frame: float) -> FrameSolution:
        """Return the curbed weights of a frame, and how strongly they are curbed."""
        _, solver, base_at = self._prepare()

        def solve() -> FrameSolution:
            inbetweens, time = base_at(frame)
            weights = np.array(slider_weights_at(self.clip, frame))
            return solver.solve(weights, inbetweens.frame_with_values(time)[1])

        key = solver, frame_content(self.clip, frame, self._variant)
        return self._sampler.known.slider_solution(key, solve)

    def _prepare(self) -> tuple[SliderPoses, FrameSolver, BaseAt]:
        """Prepare the poses at the points, the solver, and the in-betweens where it needs them."""
        if self._prepared is None:
            layer, sampler = self.clip.layer, self._sampler
            samples = [sampler.samples(pose) for pose in self.poses]
            poses = SliderPoses.of(samples, self._turns, sampler.sites)
            solver = sampler.slider_solver(
                self.poses,
                self._turns,
                layer.bounds,
                _pins(layer, self.poses, sampler.sites.anchor),
                is_anchored=layer.has_parent,
            )
            beside = PoseSampler(
                layer.domain,
                anchor=layer.anchor,
                points=np.array([sampler.sites.anchor]),
                values_at=solver.nodes,
                sibling=sampler,
            )
            self._prepared = poses, solver, self._base_of(beside)
        return self._prepared


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

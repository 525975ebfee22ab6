"""Transfer of poses by a similarity, to another layer or to the mirrored side."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from app.document import Layer, Pose, Target, find_chains
from app.rigging import bend_side
from app.solving.drag.rig import Rig, pins_of
from app.solving.drag.shown_pose import fit_map
from engine.arrays import Complexes
from engine.deform import StartingPoint
from engine.geometry import contains, diameter
from engine.maps import HarmonicMap, certify

MOST_STEPS = 600  # per pose
# Share of a shape that must lie on the image of another shape to count as similar.
SIMILAR_SHARE = 0.9
BESIDE = 0.005  # fraction of the shape's diameter: points this close are on the shape
ENOUGH = 2_000  # vertices sampled for that test
# A part is mirrored if the best similarity without mirroring has two large errors at the handles.
# They exceed this fraction of the handles' spread, and this multiple of the mirrored error.
ODD, CLEARER = 0.1, 4.0


@dataclass(frozen=True, slots=True)
class SimilarityTransform:
    """A similarity S of the plane: z ↦ factor · z + shift, or of conj(z) if it mirrors."""

    factor: complex = 1.0 + 0j
    shift: complex = 0j
    mirrors: bool = False

    @classmethod
    def reflection(cls, axis: float) -> Self:
        """Return the reflection at a vertical axis, R(z) = 2a − conj(z)."""
        return cls(-1.0 + 0j, complex(2 * axis), mirrors=True)

    @classmethod
    def fit(cls, places: Complexes, images: Complexes, *, mirrors: bool | None = None) -> Self:
        """Return the similarity that best maps places to images, each complex128 (n,), n ≥ 1.

        Its scale is the ratio of their spreads, so that the fit of images to places is its inverse.
        A single place is only translated, or mirrored at a vertical axis. By default S mirrors only
        if the images clearly are mirrored.
        """
        if mirrors is not None:
            return cls._fit_nearest(places, images, mirrors=mirrors)
        plain = cls._fit_nearest(places, images, mirrors=False)
        mirrored = cls._fit_nearest(places, images, mirrors=True)
        off, off_mirrored = (
            np.abs(each.apply(places) - images).max() for each in (plain, mirrored)
        )
        spread = np.abs(images - images.mean()).max()
        return mirrored if off > max(ODD * spread, CLEARER * off_mirrored) else plain

    @classmethod
    def _fit_nearest(cls, places: Complexes, images: Complexes, *, mirrors: bool) -> Self:
        points = places.conj() if mirrors else places
        spread, other = points - points.mean(), images - images.mean()
        turn, size = np.vdot(spread, other), np.linalg.norm(spread)
        factor = -1.0 + 0j if mirrors else 1.0 + 0j
        if size > 0 and abs(turn) > 0:
            factor = complex(np.linalg.norm(other) / size * turn / abs(turn))
        return cls(factor, complex(images.mean() - factor * points.mean()), mirrors)

    def apply(self, places: Complexes) -> Complexes:
        """Return the images of places (n,)."""
        return self.factor * (places.conj() if self.mirrors else places) + self.shift

    def apply_to_point(self, place: complex) -> complex:
        return complex(self.apply(np.array([place]))[0])

    def apply_inverse(self, places: Complexes) -> Complexes:
        """Return the preimages of places (n,)."""
        points: Complexes = (places - self.shift) / self.factor
        return points.conj() if self.mirrors else points

    def transform_rotation(self, turn: complex) -> complex:
        """Return the rotation of the image of a shape with this rotation."""
        return turn.conjugate() if self.mirrors else turn

    def transform_target(
        self,
        shape: HarmonicMap,
        place: complex,
        target: complex,
        point: complex,
        turn: complex | None = None,
    ) -> complex:
        """Return the target of a point that moves like the image of a place with a target.

        The image of the motion f is S ∘ f ∘ S⁻¹. S maps the place p near to the point. The motion
        of f at p is applied to S(p), and the point moves with it rigidly:

            S(f(p)) + u (point − S(p)),  u the rotation of the image at p

        or with another rotation of f, `turn`. An undeformed drawing stays undeformed for all
        places. A rotation of the whole shape is kept. The transfer back is the inverse.
        """
        if turn is None:
            (fz,), _ = shape.derivatives(np.array([place]))
            turn = complex(fz / abs(fz))
        return self.apply_to_point(target) + self.transform_rotation(turn) * (
            point - self.apply_to_point(place)
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PoseTransfer:
    """A transfer of poses from one layer, as it was at the time of the poses, to another.

    `pairs` maps handle ids of the target layer to handle ids of the source.
    """

    source: Layer
    pairs: Mapping[int, int]
    similarity: SimilarityTransform
    # Whether sides are exchanged within a layer. Distant parts then rotate only with the whole
    # layer.
    is_within_layer: bool = False

    def transfer_targets(self, layer: Layer, pose: Pose) -> dict[int, Target]:
        """Return the targets of a layer's handles for a pose of the source, by handle id."""
        shape, carried = self.source.map_of(pose), {}
        sides = joint_sides(self.source, pose)
        whole = mean_rotation(self.source, shape) if self.is_within_layer else None
        for identity, other in self.pairs.items():
            target, place = pose.targets[other], self.source.handle(other).position
            point = layer.handle(identity).position
            turn = target.rotation
            carried[identity] = Target(
                position=self.similarity.transform_target(
                    shape, place, target.position, point, whole
                ),
                rotation=-turn if turn is not None and self.similarity.mirrors else turn,
                side=transferred_side(sides.get(other), mirrors=self.similarity.mirrors),
            )
        return carried

    def transfer_pose(self, rig: Rig, pose: Pose, present: Pose | None = None) -> Pose:
        """Return a pose of the source for the rig's layer, solved within its limits.

        Handles without a partner keep their targets in `present`, which is not needed if all have
        one.
        """
        layer, targets = rig.layer, self.transfer_targets(rig.layer, pose)
        if present is not None:
            targets, pins = {**present.targets, **targets}, pins_of(layer, present)
            return solve_from_map(rig, layer.map_of(present), targets, pins)
        begin, ways = find_initial_map(rig, self.source, pose, self.similarity, targets)
        # Sprung handles need a target too; the solver ignores it.
        rest = {handle.id: Target(position=handle.position) for handle in layer.handles}
        return solve_from_map(rig, begin, {**rest, **targets}, self._transfer_pins(rig, pose), ways)

    def _transfer_pins(self, rig: Rig, pose: Pose) -> list[Target]:
        """Return the targets of the rig's fixed points, from the motion of the nearest handles."""
        shape = self.source.map_of(pose)
        held = [self.source.handle(other).position for other in self.pairs.values()]
        if self.source.attachments and self.source.anchor is not None:
            held.append(self.source.anchor)
        pins = []
        for joint in rig.pins:
            beside = min(held, key=lambda place: abs(self.similarity.apply_to_point(place) - joint))
            target = complex(shape(np.array([beside]))[0])
            pins.append(
                Target(position=self.similarity.transform_target(shape, beside, target, joint))
            )
        return pins


def joint_sides(layer: Layer, pose: Pose) -> dict[int, int | None]:
    """Return the sides to which the joints of bones bend in a pose, by handle id."""
    sides: dict[int, int | None] = {}
    for chain in find_chains(layer.bones):
        for triple in zip(chain.handles, chain.handles[1:], chain.handles[2:], strict=False):
            places = [pose.targets[identity].position for identity in triple]
            sides[triple[1]] = bend_side(*places) or pose.targets[triple[1]].side
    return sides


def transferred_side(side: int | None, *, mirrors: bool) -> int | None:
    """Return the side of a joint in the image of a pose."""
    return -side if mirrors and side is not None else side


def solve_from_map(
    rig: Rig,
    begin: HarmonicMap,
    targets: Mapping[int, Target],
    pins: Sequence[Target],
    ways: tuple[StartingPoint, ...] = tuple(StartingPoint),
) -> Pose:
    """Return the pose for these targets, solved from a map with some starting points."""
    posed, followed = rig.posed_at(begin, {}).follow(targets)
    deformer, wanted = posed.deformer, posed.build_targets(followed, tuple(pins))
    state, _ = deformer.settle(
        rig.start_at(begin), wanted, ways=ways, at_most=MOST_STEPS, throw=False
    )
    # Steps that lead into the limits are proven for wider ones.
    proven = certify(state.map, deformer.boundary, deformer.bounds)
    return posed.make_pose(state.map, followed.targets, proven)


def find_initial_map(
    rig: Rig,
    source: Layer,
    pose: Pose,
    similarity: SimilarityTransform,
    targets: Mapping[int, Target],
) -> tuple[HarmonicMap, tuple[StartingPoint, ...]]:
    """Return the solver's first map for the image of a pose, and its starting points.

    For similar drawings it is the map nearest to S ∘ f ∘ S⁻¹, and the pose is the nearest minimum.
    Otherwise it is the undeformed map with the mean rotation of that image.
    """
    shape = source.map_of(pose)
    if is_similar(rig.layer, source, similarity):
        return _image(rig, source, shape, similarity), (StartingPoint.HERE,)
    turn = similarity.transform_rotation(mean_rotation(source, shape))
    apart = [
        target.position - turn * rig.layer.handle(identity).position
        for identity, target in targets.items()
    ]
    begin = rig.deformer.rest_map.moved(turn, complex(np.mean(apart)) if apart else 0j)
    return begin, tuple(StartingPoint)


def mean_rotation(layer: Layer, shape: HarmonicMap) -> complex:
    """Return the mean rotation of a layer, of modulus 1."""
    fz, _ = shape.derivatives(_some(layer.domain.mesh.vertices))
    turn = complex(fz.sum())
    return turn / abs(turn) if turn else 1.0 + 0j


def is_similar(layer: Layer, source: Layer, similarity: SimilarityTransform) -> bool:
    """Return whether nearly all of a layer lies on the image of another layer."""
    places = similarity.apply_inverse(_some(layer.domain.mesh.vertices))
    # Many vertices of a coarse mesh are on its outline, and thus slightly off the other's image.
    found = source.covers(places, tolerance=BESIDE * diameter(source.domain.outline))
    return bool(found.mean() >= SIMILAR_SHARE)


def _some(vertices: Complexes) -> Complexes:
    return vertices[:: max(1, len(vertices) // ENOUGH)]


def _image(
    rig: Rig, source: Layer, shape: HarmonicMap, similarity: SimilarityTransform
) -> HarmonicMap:
    """Return the map nearest to S ∘ f ∘ S⁻¹."""
    boundary = rig.deformer.boundary
    places = similarity.apply_inverse(boundary.points)
    cage, *inner = source.domain.cages
    inside = contains(cage, places, holes=inner)
    points = places[inside]
    fz, fzbar = shape.derivatives(points)
    # With d S⁻¹ = dw/a or its conjugate: (S ∘ f ∘ S⁻¹)_w = f_z, and the other derivative is f_z̄
    # a/conj(a). If S mirrors, both are conjugated before this rotation.
    if similarity.mirrors:
        fz, fzbar = fz.conj(), fzbar.conj()
    turned = similarity.factor / similarity.factor.conjugate()
    return fit_map(boundary, fz, turned * fzbar, similarity.apply(shape(points)), inside=inside)

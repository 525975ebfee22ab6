"""Poses that are carried from one layer to another, or to its own other side, by a similarity."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from app.document import Layer, Pose, Target
from app.solving.drag_solver import Rig, fit_map, pins_of
from engine.arrays import Complexes
from engine.deform import StartingPoint
from engine.geometry import contains, diameter
from engine.maps import HarmonicMap, certify

MOST_STEPS = 600  # for one pose
# Of a shape that counts as like another one, the part at least that lies on that one's image.
SIMILAR_SHARE = 0.9
BESIDE = 0.005  # of the shape's diameter: so near to it is on it
ENOUGH = 2_000  # vertices by which that is told
# A part is drawn mirrored where its handles are this far from the likeness that mirrors nothing,
# over their spread, and this many times nearer to the one that does.
ODD, CLEARER = 0.1, 4.0


@dataclass(frozen=True, slots=True)
class SimilarityTransform:
    """A similarity S of the plane: z ↦ factor · z + shift, of conj(z) where it mirrors."""

    factor: complex = 1.0 + 0j
    shift: complex = 0j
    mirrors: bool = False

    @classmethod
    def reflection(cls, axis: float) -> Self:
        """Return the reflection at an upright axis, R(z) = 2a − conj(z)."""
        return cls(-1.0 + 0j, complex(2 * axis), mirrors=True)

    @classmethod
    def fit(cls, places: Complexes, images: Complexes, *, mirrors: bool | None = None) -> Self:
        """Return the likeness by which some places come next to others.

        Its scale is that of their spreads, so that the way back is its inverse. One place alone is
        moved, and mirrored at an upright axis.

        Parameters
        ----------
        places, images : complex128, shape (n,)
            At least one.
        mirrors : bool, optional
            Whether it mirrors; by default only where the images clearly are mirrored.
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
        """Return where places (n,) come to."""
        return self.factor * (places.conj() if self.mirrors else places) + self.shift

    def apply_to_point(self, place: complex) -> complex:
        """Return where one place comes to."""
        return complex(self.apply(np.array([place]))[0])

    def apply_inverse(self, places: Complexes) -> Complexes:
        """Return which places (n,) come to some."""
        points: Complexes = (places - self.shift) / self.factor
        return points.conj() if self.mirrors else points

    def transform_rotation(self, turn: complex) -> complex:
        """Return by what the image of a shape turns that turns by this."""
        return turn.conjugate() if self.mirrors else turn

    def transform_target(
        self,
        shape: HarmonicMap,
        place: complex,
        wished: complex,
        point: complex,
        turn: complex | None = None,
    ) -> complex:
        """Return where a point goes if it moves as the image of a place with a target.

        The image of the motion f is S ∘ f ∘ S⁻¹. A place p comes to one beside the point; what f
        does at p is done to S(p), and the point is taken along as a rigid body would be:

            S(f(p)) + u (point − S(p)),  u the turn of the image at p

        or by another `turn` of f than that at the place. So the drawing at rest stays at rest
        whatever the places are, a shape that is turned as a whole is turned alike, and the way back
        changes nothing.
        """
        if turn is None:
            (fz,), _ = shape.derivatives(np.array([place]))
            turn = complex(fz / abs(fz))
        return self.apply_to_point(wished) + self.transform_rotation(turn) * (
            point - self.apply_to_point(place)
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PoseTransfer:
    """The way from one layer's poses to another's.

    Parameters
    ----------
    source : Layer
        As it was when its poses were.
    pairs : mapping of int to int
        Of the other layer's handles, those that take over, and from which of the source's.
    likeness : SimilarityTransform
    """

    source: Layer
    pairs: Mapping[int, int]
    similarity: SimilarityTransform
    # Whether sides exchange within one layer: what is far apart turns only as the whole does.
    is_within_layer: bool = False

    def transfer_targets(self, layer: Layer, pose: Pose) -> dict[int, Target]:
        """Return where a layer's handles are wanted by a pose of the source, by their ids."""
        shape, carried = self.source.map_of(pose), {}
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
            )
        return carried

    def transfer_pose(self, rig: Rig, pose: Pose, present: Pose | None = None) -> Pose:
        """Return a pose of the source as one of a rig's layer, solved within its bounds.

        Parameters
        ----------
        rig : Rig
        pose : Pose
            Of the source.
        present : Pose, optional
            Where the handles stay that take nothing over; none is needed where all do.
        """
        layer, targets = rig.layer, self.transfer_targets(rig.layer, pose)
        if present is not None:
            targets, pins = {**present.targets, **targets}, pins_of(layer, present)
            return solve_from_map(rig, layer.map_of(present), targets, pins)
        begin, ways = find_initial_map(rig, self.source, pose, self.similarity, targets)
        # What follows by a spring needs a target, too, which is not heeded.
        rest = {handle.id: Target(position=handle.position) for handle in layer.handles}
        return solve_from_map(rig, begin, {**rest, **targets}, self._transfer_pins(rig, pose), ways)

    def _transfer_pins(self, rig: Rig, pose: Pose) -> list[Target]:
        """Return where the joints of a rig's layer are held, as is done next to them."""
        shape = self.source.map_of(pose)
        held = [self.source.handle(other).position for other in self.pairs.values()]
        if self.source.attachments and self.source.anchor is not None:
            held.append(self.source.anchor)
        pins = []
        for joint in rig.pins:
            beside = min(held, key=lambda place: abs(self.similarity.apply_to_point(place) - joint))
            wished = complex(shape(np.array([beside]))[0])
            pins.append(
                Target(position=self.similarity.transform_target(shape, beside, wished, joint))
            )
        return pins


def solve_from_map(
    rig: Rig,
    begin: HarmonicMap,
    targets: Mapping[int, Target],
    pins: Sequence[Target],
    ways: tuple[StartingPoint, ...] = tuple(StartingPoint),
) -> Pose:
    """Return the pose with these wishes that is found from a map, along some ways."""
    deformer, wish = rig.deformer, rig.build_targets(targets, tuple(pins))
    state, _ = deformer.settle(
        rig.start_at(begin), wish, ways=ways, at_most=MOST_STEPS, throw=False
    )
    # Steps that walk into the bounds are proven for wider ones.
    proven = certify(state.map, deformer.boundary, deformer.bounds)
    return rig.make_pose(state.map, targets, proven)


def find_initial_map(
    rig: Rig,
    source: Layer,
    pose: Pose,
    likeness: SimilarityTransform,
    targets: Mapping[int, Target],
) -> tuple[HarmonicMap, tuple[StartingPoint, ...]]:
    """Return the map with which the solver begins to look for the image of a pose, and its ways.

    It is the map nearest to S ∘ f ∘ S⁻¹ where the two drawings are alike, and the pose the minimum
    next to that; else the rest, turned as a whole as that is.
    """
    shape = source.map_of(pose)
    if is_similar(rig.layer, source, likeness):
        return _image(rig, source, shape, likeness), (StartingPoint.HERE,)
    turn = likeness.transform_rotation(mean_rotation(source, shape))
    apart = [
        target.position - turn * rig.layer.handle(identity).position
        for identity, target in targets.items()
    ]
    begin = rig.deformer.rest_map.moved(turn, complex(np.mean(apart)) if apart else 0j)
    return begin, tuple(StartingPoint)


def mean_rotation(layer: Layer, shape: HarmonicMap) -> complex:
    """Return by what a layer is turned as a whole, of modulus 1."""
    fz, _ = shape.derivatives(_some(layer.domain.mesh.vertices))
    turn = complex(fz.sum())
    return turn / abs(turn) if turn else 1.0 + 0j


def is_similar(layer: Layer, source: Layer, likeness: SimilarityTransform) -> bool:
    """Tell whether nearly all of a layer lies on another one's image."""
    places = likeness.apply_inverse(_some(layer.domain.mesh.vertices))
    # Many vertices of a coarse mesh are on its outline, and so beside the image of another one.
    found = source.covers(places, tolerance=BESIDE * diameter(source.domain.outline))
    return bool(found.mean() >= SIMILAR_SHARE)


def _some(vertices: Complexes) -> Complexes:
    return vertices[:: max(1, len(vertices) // ENOUGH)]


def _image(
    rig: Rig, source: Layer, shape: HarmonicMap, likeness: SimilarityTransform
) -> HarmonicMap:
    """Return the map that is nearest to S ∘ f ∘ S⁻¹."""
    boundary = rig.deformer.boundary
    places = likeness.apply_inverse(boundary.points)
    cage, *inner = source.domain.cages
    inside = contains(cage, places, holes=inner)
    points = places[inside]
    fz, fzbar = shape.derivatives(points)
    # With d S⁻¹ = dw/a, or its conjugate: (S ∘ f ∘ S⁻¹)_w = f_z, and its other derivative is
    # f_z̄ a/conj(a), both conjugated before they are turned where S mirrors.
    if likeness.mirrors:
        fz, fzbar = fz.conj(), fzbar.conj()
    turned = likeness.factor / likeness.factor.conjugate()
    return fit_map(boundary, fz, turned * fzbar, likeness.apply(shape(points)), inside=inside)

"""Limbs of a layer: its chains of bones, with their rigid points, and the points of the body."""

from dataclasses import dataclass
from functools import cached_property

from app.document.layer import Layer
from app.document.queries.material.boundary_stiffness import stiff_outline
from app.document.queries.material.local_limits import limb_shapes
from app.document.queries.memo import memoized_on
from app.document.rig.chains import Chain, find_chains
from engine.arrays import Complexes
from engine.deform import Armature, Hinge, Shaft
from engine.domain.material.shafts import LimbCut, LimbShape, body_points, shaft_points
from engine.maps import Boundary


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbChain:
    """A chain of bones, with the places of its handles in the drawing."""

    chain: Chain
    places: tuple[complex, ...]
    shapes: tuple[LimbShape, ...]  # around each bone
    first_shaft: int  # number of its first bone's shaft
    parent: int | None  # number of the shaft at whose end it starts; None for the body

    @property
    def bones(self) -> list[tuple[complex, complex]]:
        return list(zip(self.places, self.places[1:], strict=False))

    @property
    def lengths(self) -> list[float]:
        return [abs(end - start) for start, end in self.bones]


@dataclass(frozen=True, kw_only=True, eq=False)
class Limbs:
    """All limbs of a layer; parents come first."""

    limbs: tuple[LimbChain, ...]
    body: Complexes  # points of the outline that belong to no limb

    @cached_property
    def bone_shafts(self) -> list[Shaft]:
        """The shafts of all bones."""
        shafts = []
        for limb in self.limbs:
            for number, ((start, end), shape) in enumerate(
                zip(limb.bones, limb.shapes, strict=True)
            ):
                is_last = number == len(limb.shapes) - 1
                points = shaft_points(shape, start, end, is_last=is_last)
                shafts.append(Shaft(points, points))
        return shafts

    @cached_property
    def bone_hinges(self) -> list[Hinge]:
        """The hinges between bones."""
        hinges = []
        for limb in self.limbs:
            for number, joint in enumerate(limb.places[1:-1], limb.first_shaft):
                hinges.append(Hinge(number, number + 1, joint, joint))
            if limb.parent is not None:
                hinges.append(Hinge(limb.parent, limb.first_shaft, limb.places[0], limb.places[0]))
        return hinges

    def bones_in(self, boundary: Boundary) -> Armature:
        """Return the bones alone, on a boundary."""
        return Armature.place(boundary, self.bone_shafts, self.bone_hinges)


@memoized_on
def find_limbs(layer: Layer) -> Limbs | None:
    """Return the limbs of a layer; None without bones."""
    shapes = limb_shapes(layer)
    by_ends = {bone.ends: shape for bone, shape in shapes.items()}
    limbs, count, last = list[LimbChain](), 0, dict[int, int]()
    for chain in find_chains(shapes):
        places = [layer.handle(identity).position for identity in chain.handles]
        links = zip(chain.handles, chain.handles[1:], strict=False)
        limbs.append(
            LimbChain(
                chain=chain,
                places=tuple(places),
                shapes=tuple(by_ends[ends] for ends in links),
                first_shaft=count,
                parent=last.get(chain.root),
            )
        )
        count += len(places) - 1
        last[chain.end] = count - 1
    if not limbs:
        return None
    cuts = [
        LimbCut(limb.places[0], limb.places[1], limb.places[-1], limb.shapes[0])
        for limb in limbs
        if limb.parent is None
    ]
    body = body_points(layer.domain.loops, stiff_outline(layer).points, cuts)
    return Limbs(limbs=tuple(limbs), body=body)

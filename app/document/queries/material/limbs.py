"""Limbs of a layer: its chains of bones, with their rigid points, and the points of the body."""

from cmath import phase
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from app.document.layer import Layer
from app.document.queries.material.boundary_stiffness import outline_points
from app.document.queries.material.local_limits import bones_and_handles, limb_shapes_in
from app.document.queries.memo import memoized_on
from app.document.rig.chains import Bone, Chain, find_chains
from engine.arrays import Complexes, Floats
from engine.deform import Armature, Hinge, Shaft, Ties
from engine.domain import MeshedDomain
from engine.domain.material.line_ties import BendingPlace, tie_lines
from engine.domain.material.shafts import (
    LimbCut,
    LimbShape,
    body_anchor,
    body_points,
    shaft_points,
    width_points,
)
from engine.geometry import Similarity
from engine.maps import Boundary

# κ L² of each point of the rigid part at an end.
END_STIFFNESS = 3e4
# κ L² of the two points that hold a limb's width. Without them, legs that walk lose up to 14 % of
# their area. As firm as the shaft they would thicken the line at elbows by half.
WIDTH_STIFFNESS = 1e4
# κ of ties across the line, for all outlines. With less, elbows are pointed and their line thick;
# with more, the limb becomes thin there.
LINE_STIFFNESS = 150.0


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbChain:
    """A chain of bones, with the places of its handles in the drawing."""

    chain: Chain
    places: tuple[complex, ...]
    shapes: tuple[LimbShape, ...]  # around each bone
    first_shaft: int  # number of its first bone's shaft
    end_shaft: int | None  # number of the rigid part at its end
    parent: int | None  # number of the shaft at whose end it starts; None for the body

    @property
    def bones(self) -> list[tuple[complex, complex]]:
        return list(zip(self.places, self.places[1:], strict=False))

    @property
    def lengths(self) -> list[float]:
        return [abs(end - start) for start, end in self.bones]

    @property
    def bone_shafts(self) -> list[Shaft]:
        """The shaft of each bone."""
        shafts = []
        for number, ((start, end), shape) in enumerate(zip(self.bones, self.shapes, strict=True)):
            is_last = number == len(self.shapes) - 1
            points = shaft_points(shape, start, end, is_last=is_last)
            shafts.append(Shaft(points, points))
        return shafts


class PlacedLimbs(NamedTuple):
    """Where bones carry the handles of their chains, by id.

    A joint lies in the middle between the places to which its bones carry it. `angles` are those of
    the rigid parts at ends.
    """

    places: Mapping[int, complex]
    angles: Mapping[int, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class Limbs:
    """All limbs of a layer; parents come first."""

    limbs: tuple[LimbChain, ...]
    body: Complexes  # points of the outline that belong to no limb, away from roots
    beside_roots: Complexes  # other points of the body
    shares_beside: Floats  # of the body's firmness, of these points
    anchor: complex | None  # in the body, for in-betweens; None lets the engine choose
    ties: Ties  # across the drawn line at joints
    widths: tuple[Shaft, ...]  # two points across each bone

    @cached_property
    def shafts(self) -> list[Shaft]:
        """The shafts of all bones, then those of the rigid parts at ends."""
        shafts, ends = [], []
        for limb in self.limbs:
            shafts += limb.bone_shafts
            part = limb.shapes[-1].end_part
            if limb.end_shaft is not None and part is not None:
                ends.append(Shaft(part.points, part.points, END_STIFFNESS))
        return shafts + ends

    @cached_property
    def hinges(self) -> list[Hinge]:
        """The hinges between shafts."""
        hinges = []
        for limb in self.limbs:
            for number, joint in enumerate(limb.places[1:-1], limb.first_shaft):
                hinges.append(Hinge(number, number + 1, joint, joint))
            if limb.parent is not None:
                hinges.append(Hinge(limb.parent, limb.first_shaft, limb.places[0], limb.places[0]))
            if limb.end_shaft is not None:
                last, end = limb.first_shaft + len(limb.shapes) - 1, limb.places[-1]
                hinges.append(Hinge(last, limb.end_shaft, end, end))
        return hinges

    @cached_property
    def ends(self) -> frozenset[int]:
        """The ids of the ends of all chains."""
        return frozenset(limb.chain.end for limb in self.limbs)

    @cached_property
    def rigid_ends(self) -> frozenset[int]:
        """The ids of the ends with a rigid part, which a pose holds in place of the drawing."""
        return frozenset(limb.chain.end for limb in self.limbs if limb.end_shaft is not None)

    @cached_property
    def points(self) -> Complexes:
        """The points of all shafts, (t,)."""
        return np.concatenate([shaft.points for shaft in self.shafts])

    def locate(self, positions: Complexes) -> PlacedLimbs:
        """Return where the bones carry the handles, with the points (t,) at these positions."""
        starts = np.cumsum([0, *(len(shaft.points) for shaft in self.shafts)])
        motions = [
            Similarity.fit_rigid_motion(shaft.points, positions[start : start + len(shaft.points)])
            for shaft, start in zip(self.shafts, starts[:-1], strict=True)
        ]
        found, angles = dict[int, list[complex]](), dict[int, float]()
        for limb in self.limbs:
            pairs = zip(limb.bones, pairwise(limb.chain.handles), strict=True)
            for number, (bone, ids) in enumerate(pairs):
                for identity, place in zip(ids, bone, strict=True):
                    motion = motions[limb.first_shaft + number]
                    found.setdefault(identity, []).append(_carry(motion, place))
            if limb.end_shaft is not None:
                motion = motions[limb.end_shaft]
                found[limb.chain.end] = [_carry(motion, limb.places[-1])]
                angles[limb.chain.end] = phase(motion.factor)
        places = {identity: sum(carried) / len(carried) for identity, carried in found.items()}
        return PlacedLimbs(places, angles)

    def armature_in(self, boundary: Boundary) -> Armature:
        """Return the bones and the ends of limbs, without the body, on a boundary."""
        return Armature.place(boundary, [*self.shafts, *self.widths], self.hinges, self.ties)


def _carry(motion: Similarity, place: complex) -> complex:
    return motion.factor * place + motion.shift


def find_limbs(layer: Layer) -> Limbs | None:
    """Return the limbs of a layer; None without bones."""
    return _limbs_in(layer.domain, *bones_and_handles(layer)) if layer.bones else None


@memoized_on
def _limbs_in(
    domain: MeshedDomain, bones: tuple[Bone, ...], handles: tuple[tuple[int, complex], ...]
) -> Limbs | None:
    shapes, at = limb_shapes_in(domain, bones, handles), dict(handles)
    by_ends = {bone.ends: shape for bone, shape in shapes.items()}
    limbs, count, last = list[LimbChain](), 0, dict[int, int]()
    for chain in find_chains(shapes):
        limbs.append(
            LimbChain(
                chain=chain,
                places=tuple(at[identity] for identity in chain.handles),
                shapes=tuple(by_ends[ends] for ends in pairwise(chain.handles)),
                first_shaft=count,
                end_shaft=None,
                parent=last.get(chain.root),
            )
        )
        count += len(chain.handles) - 1
        last[chain.end] = count - 1
    if not limbs:
        return None
    for number, limb in enumerate(limbs):
        if limb.shapes[-1].end_part is not None:
            limbs[number] = replace(limb, end_shaft=count)
            count += 1
    cuts = [
        LimbCut(limb.places[0], limb.places[1], limb.places[-1], limb.shapes[0])
        for limb in limbs
        if limb.parent is None
    ]
    body = body_points(domain.loops, np.concatenate(outline_points(domain)), cuts)
    starts = {bone.ends[0] for bone in shapes}
    bending = [
        BendingPlace(at[bone.ends[1]], shape.joint_width)
        for bone, shape in shapes.items()
        if bone.ends[1] in starts
    ]
    lines = tie_lines(domain.loops, bending)
    ties = Ties(lines.starts, lines.ends, LINE_STIFFNESS * lines.shares)
    anchor = body_anchor(domain.loops, cuts)
    return Limbs(
        limbs=tuple(limbs),
        body=body.firm,
        beside_roots=body.beside,
        shares_beside=body.shares,
        anchor=anchor,
        ties=ties,
        widths=_find_widths(domain, limbs),
    )


def _find_widths(domain: MeshedDomain, limbs: Sequence[LimbChain]) -> tuple[Shaft, ...]:
    """Return the shafts that hold the width of each bone's limb."""
    widths = []
    for limb in limbs:
        for (start, end), shaft in zip(limb.bones, limb.bone_shafts, strict=True):
            middle = complex(shaft.points[len(shaft.points) // 2])
            points = width_points(domain.loops, start, end, middle)
            if np.ptp(points) != 0:
                widths.append(Shaft(points, points, WIDTH_STIFFNESS))
    return tuple(widths)


def motion_anchor(layer: Layer) -> complex | None:
    """Return the anchor of a layer's in-betweens; None lets the engine choose.

    It is the layer's own, or lies in the body of a layer with bones: where the body stays, nothing
    turns it or moves it away.
    """
    limbs = find_limbs(layer) if layer.anchor is None else None
    return layer.anchor if limbs is None else limbs.anchor

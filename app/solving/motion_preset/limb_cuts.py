"""Limbs that touch each other or the trunk in the drawing, parted by knife lines."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from app.cut_out import CutLine, CutOut, build_picture_domain, subject_mask, texture
from app.document import Document, Layer
from app.rigging import (
    Body,
    LimbLine,
    NearArm,
    find_arm_line,
    find_limb_line,
    move_off_arm,
    near_side,
    other_side,
    trace_near_arm,
)
from app.solving.resolve_keys import KeyResolver, step_resolver
from app.texts import N_
from engine.arrays import Bytes, Complexes, Floats
from engine.domain import CUT_WIDTH
from engine.errors import EngineError
from engine.geometry import Domain, box_diagonal, distance_to_boundary, distance_to_segments

PARTED = N_("Limbs touch in the drawing. They were parted along their drawn lines.")
# Lines that leave no domain are tried shorter: shares of them above the crotch.
SHARES = (1.0, 0.9, 0.75, 0.6)
# Of the diagonal: the knife extends lines that end this near to the outline.
MOUTH = 0.012
FEWEST = 8  # points of a line
LEAST = 8.0  # widths of a slit: length of a line above the crotch that covers a limb
ABOVE = 0.2  # of an arm's length: its contour is looked for this far above its shoulder
PARTED_ALREADY = 0.5  # share of a contour inside the domain: with less, a slit is there already
BESIDE = 2.0  # widths of a slit: a handle nearer to a knife line may be inside the slit


class LimbCuts(NamedTuple):
    """The cut-out of a layer with knife lines between limbs, and the joints beside the lines."""

    cut_out: CutOut
    joints: Mapping[str, complex]


def find_limb_cuts(
    layer: Layer, body: Body, rgba: Bytes, *, arms: Iterable[str] = "LR"
) -> LimbCuts | None:
    """Return how the limbs of an undeformed body are parted; None if no line between them is found.

    `arms` are the sides of the arms that are parted from the trunk, if seen from the front.
    No line passes through a handle, and each line leaves a domain.
    """
    loops, corner = layer.domain.loops, layer.corner
    shown = texture(rgba, subject_mask(rgba, layer.cut_out))
    found = [find_limb_line(loops, near, far, shown, corner) for near, far in _pairs(body)]
    if body.kind.name == "biped-front":
        found += [find_arm_line(loops, body.joints, side, shown, corner) for side in arms]
    lines = [line for line in found if line is not None]
    width = CUT_WIDTH * box_diagonal(layer.domain.outline)
    handles = np.array([handle.position for handle in layer.handles], dtype=np.complex128)
    lines = [_with_straight_mouth(line, layer.domain) for line in lines]
    arm = _find_near_arm(layer, body, shown)
    around = [] if arm is None else [CutLine(points=arm.contour - corner, covered="left")]
    free = [line for line in lines if (_distances(handles, line.points) > BESIDE * width).all()]
    choices = [
        (some, count, share)
        for some in ([around, []] if around else [[]])
        for count in range(len(free), -1, -1)
        for share in (SHARES if count else (1.0,))
        if some or count
    ]
    for some, count, share in choices:
        for chosen in combinations(free, count):
            parts = tuple(line.shortened(share) for line in chosen)
            drawn = *some, *(_cut_line(line, corner, LEAST * width) for line in parts)
            cut_out = replace(layer.cut_out, cut_lines=(*layer.cut_out.cut_lines, *drawn))
            if _is_possible(layer, cut_out, rgba):
                joints = dict(body.joints)
                if some and arm is not None:
                    joints = move_off_arm(joints, arm, loops, near_side(body.facing))
                return LimbCuts(cut_out, _beside(joints, parts, BESIDE * width))
    return None


def _find_near_arm(layer: Layer, body: Body, shown: Bytes) -> NearArm | None:
    """Return the near arm over the trunk that no slit parts yet."""
    end = f"hand.{near_side(body.facing)}"
    if body.kind.name != "biped-side" or end not in body.joints:
        return None
    limb = np.array([body.joints[name] for name in body.limb_joints(end)])
    if len(limb) < 3:
        return None
    above = limb[0] + ABOVE * np.abs(np.diff(limb)).sum() * np.exp(1j * np.angle(limb[0] - limb[1]))
    arm = trace_near_arm(layer.domain.loops, np.append(above, limb), shown, layer.corner)
    if arm is None or layer.domain.contains(arm.contour).mean() < PARTED_ALREADY:
        return None
    return arm


def part_limbs(document: Document, identity: int, cuts: LimbCuts, rgba: Bytes) -> Document:
    """Return a document with a layer's limbs parted: its domain built, and its poses solved again.

    Raises an `EngineError` if the domain does not contain a handle.
    """
    layer = replace(document.layer(identity), cut_out=cuts.cut_out, is_stale=True)
    resolver = KeyResolver(before=layer, bounds=layer.bounds, meshing=layer.meshing)
    while not resolver.is_over or resolver.new_layer is None:
        resolver = step_resolver(resolver, rgba)
    return resolver.command(document.with_layer(layer))


def _pairs(body: Body) -> list[tuple[list[complex], list[complex]]]:
    """Return the near and the far limb of each pair, by their joints from root to end."""
    ends = ("foot", "hand") if body.kind.name == "four-legs" else ("foot",)
    pairs = []
    for end in ends:
        near = f"{end}.{near_side(body.facing)}"
        if near not in body.joints or other_side(near) not in body.joints:
            continue
        limbs = [body.limb_joints(tip) for tip in (near, other_side(near))]
        if min(map(len, limbs)) > 1:
            one, other = ([body.joints[name] for name in limb] for limb in limbs)
            pairs.append((one, other))
    return pairs


def _with_straight_mouth(line: LimbLine, domain: Domain) -> LimbLine:
    """Return a line without its points near the outline, from where the knife extends it."""
    loops = domain.loops
    away = distance_to_boundary(loops[0], line.points, holes=loops[1:])
    deep = domain.contains(line.points) & (away >= MOUTH * box_diagonal(loops[0]))
    first = int(deep.argmax())
    if len(line.points) - first < FEWEST:
        return line
    return line._replace(points=line.points[first:], crotch=max(line.crotch - first, 0))


def _cut_line(line: LimbLine, corner: complex, least: float) -> CutLine:
    """Return the knife line; the far limb is covered above the crotch."""
    points = line.points - corner
    if np.abs(np.diff(points[line.crotch :])).sum() < least:
        return CutLine(points=points)
    return CutLine(points=points, covered=line.far_side, covered_from=line.crotch)


def _is_possible(layer: Layer, cut_out: CutOut, rgba: Bytes) -> bool:
    """Return whether the cut-out leaves a domain that contains the handles and the anchor."""
    try:
        domain, _ = build_picture_domain(
            rgba,
            triangles=layer.meshing.triangles,
            detail=layer.meshing.detail,
            cut_out=cut_out,
        )
    except EngineError:
        return False
    places = [handle.position for handle in layer.handles]
    if layer.anchor is not None:
        places.append(layer.anchor)
    return bool(domain.moved(layer.corner).contains(np.array(places, np.complex128)).all())


def _distances(points: Complexes, line: Complexes) -> Floats:
    return np.asarray(distance_to_segments(points, line[:-1], line[1:]))


def _beside(
    joints: Mapping[str, complex], lines: tuple[LimbLine, ...], least: float
) -> dict[str, complex]:
    """Return the joints, those closer to a line than a distance moved away from it."""
    moved = dict(joints)
    for name, place in joints.items():
        for line in lines:
            nearest = line.points[np.abs(line.points - place).argmin()]
            away = place - nearest
            if 0 < abs(away) < least:
                moved[name] = complex(nearest + least * away / abs(away))
    return moved

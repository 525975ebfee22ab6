"""Solving keys again after a change of limits, domain or picture."""

from dataclasses import dataclass, replace
from functools import reduce

import numpy as np

from app.cut_out import build_picture_domain
from app.document import (
    Command,
    Document,
    Layer,
    Meshing,
    Pose,
    Target,
    layer_commands,
    shape_commands,
    transfer_painted_stiffness,
)
from app.solving.drag.rig import Rig, pins_of
from app.solving.drag.shown_pose import fit_map
from app.texts import _, message_of
from engine.arrays import Bytes
from engine.deform import StartingPoint
from engine.geometry import contains
from engine.maps import Bounds, HarmonicMap, certify

MOST_STEPS = 600  # per key
AT_REST = 1e-3  # pixels: tolerance of coefficients of an undeformed drawing
NO_PICTURE = np.zeros((0, 0, 4), dtype=np.uint8)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyResolver:
    """The state of solving a layer's poses again for other limits, domain or picture."""

    before: Layer
    bounds: Bounds  # limits of the new poses
    meshing: Meshing | None = None  # of a new domain; None keeps the domain
    solves_all: bool = True  # also poses that already satisfy the limits
    new_layer: Layer | None = None  # with the new domain and undeformed poses, once built
    replaces_picture: bool = False  # whether `new_layer` has another picture
    label: str = _("Replace picture")  # of that command
    rig: Rig | None = None  # None before the first key
    poses: tuple[Pose, ...] = ()  # solved, in the order of `Layer.poses`
    unsolved: tuple[str, ...] = ()  # names of poses that could not satisfy the limits and stay
    notices: tuple[str, ...] = ()  # of the domain builder

    @property
    def is_over(self) -> bool:
        """Whether every pose is solved."""
        return len(self.poses) == len(self.before.poses)

    @property
    def progress(self) -> float:
        """The finished share of the steps, 0 to 1."""
        builds = self.meshing is not None
        done = len(self.poses) + (builds and self.new_layer is not None)
        return done / (len(self.before.poses) + builds)

    @property
    def status_text(self) -> str:
        """Description of the next step."""
        if self.meshing is not None and self.new_layer is None:
            return _("Building the domain")
        return _("Solving pose {number} of {count}").format(
            number=len(self.poses) + 1, count=len(self.before.poses)
        )

    @property
    def command(self) -> Command:
        """The command that applies everything as one undo step."""
        identity, into = self.before.id, self.new_layer
        if into is None:
            return shape_commands.set_limits(identity, self.bounds, self.poses)
        if self.replaces_picture:
            posed = shape_commands.set_limits(identity, self.bounds, self.poses)
            return _joined(self.label, layer_commands.replace_layer(identity, into), posed)
        domain = shape_commands.replace_domain(identity, into.domain, into.meshing, self.poses)
        return _joined(domain.label, domain, layer_commands.keep_attachments(identity))


def _joined(label: str, *commands: Command) -> Command:
    """Return a command that runs the others in order."""

    def change(document: Document) -> Document:
        return reduce(lambda before, command: command(before), commands, document)

    return Command(label, change)


def step_resolver(resolver: KeyResolver, picture: Bytes = NO_PICTURE) -> KeyResolver:
    """Build the domain of the picture, or solve the next key; on the worker thread.

    Only a resolver that builds a domain needs the picture.
    """
    if resolver.meshing is not None and resolver.new_layer is None:
        return _with_domain(resolver, picture, resolver.meshing)
    rig = resolver.rig or Rig.of(
        replace(resolver.new_layer or resolver.before, bounds=resolver.bounds)
    )
    index = len(resolver.poses)
    pose = _solved(resolver, rig, index)
    outside = resolver.unsolved
    if not pose.certificate.is_certified:
        outside = (*outside, _in_words(resolver.before, index))
    return replace(resolver, rig=rig, poses=(*resolver.poses, pose), unsolved=outside)


def solve_all(resolver: KeyResolver) -> KeyResolver:
    """Solve all keys of a resolver that builds no domain."""
    while not resolver.is_over:
        resolver = step_resolver(resolver)
    return resolver


def _in_words(layer: Layer, index: int) -> str:
    """Return the place of a pose: the frame of its key, or its name in the library."""
    count = len(layer.keys)
    if index < count:
        return _("at frame {frame}").format(frame=layer.keys[index].frame)
    return _("“{name}”").format(name=layer.library[index - count].name)


def _with_domain(resolver: KeyResolver, picture: Bytes, meshing: Meshing) -> KeyResolver:
    domain, found = build_picture_domain(
        picture,
        triangles=meshing.triangles,
        detail=meshing.detail,
        cut_out=resolver.before.cut_out,
    )
    before = resolver.before
    domain = domain.moved(before.corner)
    rest = HarmonicMap.identity(domain.cage, domain.holes)
    poses = (pose.with_map(rest) for pose in before.poses)
    stiffness = transfer_painted_stiffness(before.stiffness, before.domain, domain)
    into = before.with_poses(poses, domain=domain, meshing=meshing, stiffness=stiffness)
    return replace(resolver, new_layer=into, notices=tuple(map(message_of, found)))


def _solved(resolver: KeyResolver, rig: Rig, index: int) -> Pose:
    """Return a pose over the rig's cage, within its limits, solved for its targets."""
    boundary, bounds = rig.deformer.boundary, rig.deformer.bounds
    before, into = resolver.before, resolver.new_layer
    old = before.poses[index]
    pose, pins, shape = old, pins_of(before, old), before.map_of(old)
    first = shape
    if into is not None:
        pose, first = into.poses[index], _carried_over(before, old, rig)
        if before.anchor is not None and into.anchor is not None:
            pins = tuple(transfer_target(pin, shape, before.anchor, into.anchor) for pin in pins)
    if not resolver.solves_all and certify(first, boundary, bounds).is_certified:
        return pose
    posed, followed = rig.posed_at(first, pose.targets).follow(pose.targets)
    wanted, deformer = posed.build_targets(followed, pins), posed.deformer
    # A pose that is carried over to a new shape stays in its valley, which is faster, too.
    ways = tuple(StartingPoint) if into is None else (StartingPoint.HERE,)
    begun = rig.start_at(first)
    state, _ = deformer.settle(begun, wanted, ways=ways, at_most=MOST_STEPS, throw=False)
    certificate = certify(state.map, boundary, bounds)
    if into is not None and not certificate.is_certified:
        # If the new shape is larger, the transferred map may not lead back into the limits.
        state, _ = deformer.settle(deformer.start(), wanted, at_most=MOST_STEPS, throw=False)
        certificate = certify(state.map, boundary, bounds)
    if into is None and not certificate.is_certified:
        return replace(pose, certificate=certify(first, boundary, bounds))
    return posed.make_pose(state.map, followed.targets, certificate)


def transfer_target(target: Target, shape: HarmonicMap, place: complex, to: complex) -> Target:
    """Return the target of a point that moves on the undeformed layer, with the pose's rotation."""
    if to == place:
        return target
    fz = complex(shape.derivatives(np.array([place]))[0][0])
    return replace(target, position=target.position + fz / abs(fz) * (to - place))


def _carried_over(layer: Layer, pose: Pose, rig: Rig) -> HarmonicMap:
    """Return the map over the rig's cage that is nearest to a pose of the layer.

    The pose's map is defined from the old outline to the old cage, where the new outline may lie.
    """
    boundary, domain = rig.deformer.boundary, layer.domain
    shape, rest = layer.map_of(pose), HarmonicMap.identity(domain.cage, domain.holes)
    is_at_rest = all(
        np.allclose(one, two, rtol=0.0, atol=AT_REST)
        for one, two in zip(shape.columns, rest.columns, strict=True)
    )
    inside = contains(domain.cage, boundary.points, holes=domain.cages[1:])
    if is_at_rest or not inside.any():
        return HarmonicMap.identity(boundary.cage, boundary.holes)
    points = boundary.points[inside]
    fz, fzbar = shape.derivatives(points)
    return fit_map(boundary, fz, fzbar, shape(points), inside=inside)

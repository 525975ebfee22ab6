"""Solving the poses of a script: of keys, and of sliders."""

from collections.abc import Callable, Iterable
from dataclasses import replace

from app.document import (
    SLIDER,
    Document,
    Layer,
    LibraryPose,
    Pose,
    Slider,
    Target,
    format_slider_value,
    measure_target_errors,
    rest_pose,
)
from app.solving.drag.drag_solver import DragSolver
from app.solving.drag.rig import Rig
from app.solving.script.keys import PoseKey
from app.solving.script.sliders import ScriptSlider
from app.solving.script_scene import find_layer
from app.texts import _
from engine.deform import BoundedPull

# Largest number of steps; a drag that needs more moves slowly along a limit.
MOST_STEPS = 1500


def solve_pose(rig: Rig, start: Pose, key: PoseKey, where: str) -> tuple[Pose, list[str]]:
    """Drag the handles from a pose to the targets of a key; `where` begins the notices."""
    layer = rig.layer
    identities = {handle.name: handle.id for handle in layer.handles}
    named = {identities[name]: place for name, place in key.targets.items()}
    turned = {identities[name]: turn for name, turn in {**key.turns, **key.angles}.items()}
    sides = {identities[name]: side for name, side in key.sides.items()}
    carried = layer.sprung_handles & named.keys()
    notices = [
        _(
            "{where}: {handle!r} has a spring, which ignores targets of keys; leave its target out"
        ).format(where=where, handle=layer.handle(identity).name)
        for identity in sorted(carried)
    ]
    for identity in carried:
        del named[identity]
    targets = dict(start.targets)
    for identity in named.keys() | sides.keys() | (turned.keys() - layer.sprung_handles):
        before = targets[identity]
        targets[identity] = Target(
            position=named.get(identity, before.position),
            rotation=turned.get(identity, before.rotation),
            side=sides.get(identity, before.side),
        )
    if all(start.targets[i] == target for i, target in targets.items()):
        return start, notices
    hands = tuple(BoundedPull((identity,), key.pull) for identity in named)
    drag = DragSolver.begin(rig, start).step_towards(targets, MOST_STEPS, hands)
    target_errors = measure_target_errors(layer, drag.make_pose(targets))
    notices += [
        _(
            "{where}: {handle!r} is {error:.1f} px from its target, beyond the reach of its bones"
        ).format(where=where, handle=layer.handle(identity).name, error=error)
        for identity, error in drag.out_of_reach(targets).items()
        if identity in named
    ]
    drag, released = drag.release(targets, hands)
    left = {**targets, **released}
    pose = drag.step_towards(left, MOST_STEPS).make_pose(left)
    notices += [
        _("{where}: {handle!r} is {error:.1f} px from its target, {reason}").format(
            where=where,
            handle=layer.handle(identity).name,
            error=error,
            reason=target_errors.reason,
        )
        for identity, error in target_errors.errors.items()
    ]
    return pose, notices


def with_sliders(
    document: Document,
    layer: Layer,
    sliders: Iterable[ScriptSlider],
    progress: Callable[[str], None],
) -> tuple[Layer, list[str]]:
    """Return a layer of the document with sliders, and notices.

    Poses are dragged from the undeformed drawing, and are kept in the library.
    """
    rig, rest, notices = Rig.of(layer), rest_pose(layer.domain, layer.handles), list[str]()
    library, made, channels = list(layer.library), list[Slider](), dict(layer.channels)
    for given in sliders:
        slider, poses = given.slider, []
        for each, key in zip(slider.poses, given.poses, strict=True):
            named = f"{slider.name} {format_slider_value(each.at)}"
            where = _("slider pose {name!r}").format(name=named)
            progress(_("solving the {where}").format(where=where))
            pose, found = solve_pose(rig, rest, key, where)
            notices += found
            poses.append(replace(each, pose=None if pose is rest else named))
            if pose is not rest:
                library.append(LibraryPose(name=named, pose=pose))
        driver = None if given.driver is None else find_layer(document, given.driver).id
        made.append(replace(slider, poses=tuple(poses), driver=driver))
        channels[SLIDER.name, slider.name] = given.keys
    changed = replace(layer, library=tuple(library), sliders=tuple(made), channels=channels)
    return changed, notices

"""From a new document and a pose script to an animation, solved as the window would solve it."""

from collections.abc import Callable
from dataclasses import replace

from app.document import (
    Document,
    FrameRange,
    Keyframe,
    Pose,
    Target,
    find_shortfall,
    handle_commands,
)
from app.solving.drag import Drag, Rig
from app.solving.script import PoseKey, PoseScript

# A drag that is not at rest by then creeps along a bound.
MOST_STEPS = 1500
STEPS_AT_ONCE = 25


def pose_document(
    document: Document, script: PoseScript, progress: Callable[[str], None]
) -> tuple[Document, tuple[str, ...]]:
    """Give the figure in front of a new document the handles and keys of a script.

    Each key is solved by a drag from the key before, the first one from the drawing as it is. A
    handle that a key does not name keeps its target of the key before.

    Parameters
    ----------
    document : Document
        With a picture in front as it was drawn, as `open_picture` gives it.
    script : PoseScript
    progress : callable
        Told in words what is being solved.

    Returns
    -------
    document : Document
    notices : tuple of str
        By how much handles fall short of their targets.

    Raises
    ------
    LissomError, EngineError
        If a handle or the anchor lies outside the shape.
    """
    identity = document.figures[-1].id
    for name, place in script.handles.items():
        document = handle_commands.add_handle(identity, place, name=name)(document)
    figure = replace(
        document.figure(identity),
        variant=script.variant,
        bounds=script.bounds,
        anchor=script.anchor,
    )
    rig = Rig.of(figure)
    pose = figure.keys[0].pose
    keys, notices = [], []
    for key in script.keys:
        progress(f"solving the key at frame {key.frame}")
        pose, notice = _solve(rig, pose, key)
        notices += notice
        keys.append(Keyframe(frame=key.frame, pose=pose, easing=key.ease, passing=key.passing))
    posed = replace(
        document,
        figures=(*document.figures[:-1], replace(figure, keys=tuple(keys))),
        frames=FrameRange(0, keys[-1].frame),
        fps=script.fps,
        loop=script.loop,
    )
    return posed, tuple(notices)


def _solve(rig: Rig, start: Pose, key: PoseKey) -> tuple[Pose, list[str]]:
    """Drag the handles from a pose to the targets of a key."""
    figure = rig.figure
    identities = {handle.name: handle.id for handle in figure.handles}
    named = {identities[name]: Target(position=place) for name, place in key.targets.items()}
    targets = {**start.targets, **named}
    if all(start.targets[i].position == target.position for i, target in targets.items()):
        return start, []
    drag = Drag.begin(rig, start)
    for _ in range(MOST_STEPS // STEPS_AT_ONCE):
        drag = drag.towards(targets, STEPS_AT_ONCE)
        if drag.is_over:
            break
    pose = drag.pose(targets)
    shortfall = find_shortfall(figure, pose)
    notices = [
        f"frame {key.frame}: {figure.handle(identity).name!r} is {lag:.1f} px short of "
        f"its target, {shortfall.reason}"
        for identity, lag in shortfall.lags.items()
    ]
    return pose, notices

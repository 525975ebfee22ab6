"""From a new document and a pose script to an animation, solved as the window would solve it."""

from collections.abc import Callable
from dataclasses import replace

from app.document import Document, FrameRange, Keyframe, Pose, Target, add_handle
from app.solving.drag import Drag, Rig
from app.solving.script import PoseKey, PoseScript
from engine.geometry import box_diagonal

# A drag that is not at rest by then creeps along a bound.
MOST_STEPS = 1500
STEPS_AT_ONCE = 25
# Of the diagonal of the outline's box: a handle this far from its target lags. A free handle always
# gives in a little, since it pulls against the stiffness of the shape.
LAG = 0.005


def pose_document(
    document: Document, script: PoseScript, progress: Callable[[str], None]
) -> tuple[Document, tuple[str, ...]]:
    """Give a new document the handles and keys of a script.

    Each key is solved by a drag from the key before, the first one from the drawing as it is. A
    handle that a key does not name keeps its target of the key before.

    Parameters
    ----------
    document : Document
        With the picture as it was drawn, as `open_picture` gives it.
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
    for name, place in script.handles.items():
        document = add_handle(place, name=name)(document)
    document = replace(
        document,
        fps=script.fps,
        loop=script.loop,
        variant=script.variant,
        bounds=script.bounds,
        anchor=script.anchor,
    )
    rig = Rig.of(document)
    pose = document.keys[0].pose
    keys, notices = [], []
    for key in script.keys:
        progress(f"solving the key at frame {key.frame}")
        pose, notice = _solve(rig, pose, key)
        notices += notice
        keys.append(Keyframe(frame=key.frame, pose=pose, easing=key.ease))
    frames = FrameRange(0, keys[-1].frame)
    return replace(document, keys=tuple(keys), frames=frames), tuple(notices)


def _solve(rig: Rig, start: Pose, key: PoseKey) -> tuple[Pose, list[str]]:
    """Drag the handles from a pose to the targets of a key."""
    document = rig.document
    identities = {handle.name: handle.id for handle in document.handles}
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
    size = box_diagonal(document.domain.outline)
    reason = "held back by the bounds" if drag.at_bounds else "held back by the others"
    notices = [
        f"frame {key.frame}: {document.handle(identity).name!r} stays {lag:.1f} pixels short of "
        f"its target, {reason}"
        for identity, lag in document.lags(pose).items()
        if lag > LAG * size
    ]
    return pose, notices

"""A blob with four handles, dragged to some poses: what stays, what moves, and what is hung."""

from dataclasses import replace
from functools import cache

import numpy as np
from animations import still_document, within
from documents import altered
from shapes import regular_polygon

from app.document import FrameRange, Keyframe, Target, clip_of, handle_commands
from app.motion import Animation
from app.solving import DragSolver, Rig

PLACES = {"left": 25 + 45j, "middle": 60 + 48j, "right": 95 + 45j, "top": 60 + 70j}
# Of each key: where the handles go; what is not named stays where it was drawn.
MOVES = ({}, {"top": 12 + 6j}, {"top": -12 + 6j}, {"top": -4 - 6j, "right": 5 + 8j})
DRAWN = 10  # frames between two keys
CORNERS = 16  # of its outline


@cache
def drawing():
    """A document of the blob within a polygon, with a handle at each of its places."""
    circle = regular_polygon(CORNERS)
    corners = 60 + 47j + 54 * circle.real + 40j * circle.imag
    document = within(still_document(), corners)
    for name, place in PLACES.items():
        document = handle_commands.add_handle(0, place, name=name)(document)
    return document


@cache
def dragged(number):
    """The pose to which the handles of that drawing are dragged by one of the moves."""
    layer, move = drawing().layers[0], MOVES[number]
    targets = {
        handle.id: Target(position=handle.position + move.get(handle.name, 0))
        for handle in layer.handles
    }
    drag = DragSolver.begin(Rig.of(layer), layer.keys[0].pose)
    while not drag.is_over:
        drag = drag.step_towards(targets, 50)
    return drag.make_pose(targets)


@cache
def posed(count=4, *, loop=False, drawn=DRAWN, variant="nu"):
    """A document whose handles are dragged to so many of those places, with a key for each."""
    keys = tuple(Keyframe(frame=drawn * number, pose=dragged(number)) for number in range(count))
    last = drawn * (count if loop else count - 1)
    frames = FrameRange(0, last)
    return altered(drawing(), keys=keys, frames=frames, loop=loop, variant=variant)


def with_layer(document, **changes):
    return document.with_layer(replace(document.layers[0], **changes))


def animate(document, points=None):
    layer = document.layers[0]
    handles = np.array([handle.position for handle in layer.handles])
    points = np.concatenate([handles, layer.domain.outline]) if points is None else points
    return Animation(clip_of(document, 0), points=points)


@cache
def animated(document):
    """The motion of its handles and its outline, with all frames that were asked for."""
    return animate(document)

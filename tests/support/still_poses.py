"""A blob with four handles, dragged to some poses: what stays, what moves, and what is hung."""

from dataclasses import replace
from functools import cache

import numpy as np
from animations import still_document, within
from documents import altered
from shapes import regular_polygon

from app.document import FrameRange, Keyframe, Target, clip_of, handle_commands
from app.motion import Animation
from app.solving import Drag, Rig

PLACES = {"left": 25 + 45j, "middle": 60 + 48j, "right": 95 + 45j, "top": 60 + 70j}
# Of each key: where the handles go; what is not named stays where it was drawn.
MOVES = ({}, {"top": 12 + 6j}, {"top": -12 + 6j}, {"top": -4 - 6j, "right": 5 + 8j})
DRAWN = 10  # frames between two keys
CORNERS = 16  # of its outline


@cache
def posed(count=4, *, loop=False):
    """A document whose handles are dragged to so many of those places, with a key for each."""
    circle = regular_polygon(CORNERS)
    corners = 60 + 47j + 54 * circle.real + 40j * circle.imag
    document = within(still_document(), corners)
    for name, place in PLACES.items():
        document = handle_commands.add_handle(0, place, name=name)(document)
    figure = document.figures[0]
    rig, names = Rig.of(figure), {handle.name: handle.id for handle in figure.handles}
    keys = []
    for number, move in enumerate(MOVES[:count]):
        targets = {
            identity: Target(position=PLACES[name] + move.get(name, 0))
            for name, identity in names.items()
        }
        drag = Drag.begin(rig, figure.keys[0].pose)
        while not drag.is_over:
            drag = drag.towards(targets, 50)
        keys.append(Keyframe(frame=DRAWN * number, pose=drag.pose(targets)))
    last = DRAWN * (len(keys) if loop else len(keys) - 1)
    return altered(document, keys=tuple(keys), frames=FrameRange(0, last), loop=loop)


def with_figure(document, **changes):
    return document.with_figure(replace(document.figures[0], **changes))


def animate(document, points=None):
    figure = document.figures[0]
    handles = np.array([handle.position for handle in figure.handles])
    points = np.concatenate([handles, figure.domain.outline]) if points is None else points
    return Animation(clip_of(document, 0), points=points)

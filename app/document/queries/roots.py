"""About which handle a spring swings: where a limb hangs on the rest of the drawing."""

import numpy as np

from app.document.figure import Figure
from app.document.queries.remembered import remembered
from app.document.timing import Spring
from engine.domain import Domain
from engine.domain.meshing import find_distances


def root_of(figure: Figure, spring: Spring) -> int | None:
    """Return the id of the handle about which a spring swings; None where there is none.

    It is the spring's own. If that follows by a spring, it is the root of that one, and so on.
    Without one of its own it is the nearest handle that follows by none, first along bones, and
    then along the drawing, never across a gap. What follows is told without tracks, so that these
    change no root.
    """
    seen = {spring.handle}
    while spring.root is not None:
        following = figure.spring_of(spring.root)
        if following is None or not following.enabled:
            return spring.root
        if spring.root in seen:
            break
        seen.add(spring.root)
        spring = following
    following_ids = {each.handle for each in figure.springs if each.enabled} | seen
    held = [each for each in figure.handles if each.id not in following_ids]
    bones = [bone.ends for bone in figure.bones if spring.handle in bone.ends]
    on_bones = [each for each in held if any(each.id in ends for ends in bones)]
    nearest = on_bones or held
    if not nearest:
        return None
    places = (figure.handle(spring.handle).position, *(each.position for each in nearest))
    return nearest[int(np.argmin(_distances(figure.domain, places)))].id


@remembered
def _distances(domain: Domain, places: tuple[complex, ...]) -> tuple[float, ...]:
    """Return how far it is along the drawing from the first of some places to the others."""
    return tuple(find_distances(domain.mesh, places[0], np.array(places[1:])).tolist())

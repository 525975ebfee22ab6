"""Drags of poses: what holds where a wish says nothing."""

from still_poses import PLACES, posed

from app.document import Target
from app.solving import Drag, Rig


def test_a_handle_that_is_newer_than_its_targets_holds_where_the_drag_has_it():
    figure = posed().figures[0]
    rig, pose = Rig.of(figure), figure.keys[0].pose
    *older, newest = figure.handles
    targets = {handle.id: Target(position=handle.position) for handle in older}
    targets[older[0].id] = Target(position=older[0].position + 4j)
    drag = Drag.begin(rig, pose)
    while not drag.is_over:
        drag = drag.towards(targets, 20)
    wished = {**targets, newest.id: Target(position=PLACES["top"])}
    whole = Drag.begin(rig, pose)
    while not whole.is_over:
        whole = whole.towards(wished, 20)
    places = (each.pose(wished).phi for each in (drag, whole))
    one, other = places
    assert abs(one - other).max() < 1.0
    assert abs(figure.map_of(drag.pose(wished))(figure.domain.outline)).max() < 1e3

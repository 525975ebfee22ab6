"""What a domain tells of points."""

import numpy as np
from pictures import ring, seen

from engine.domain import build_domain


def test_points_outside_come_to_middles_of_triangles_and_no_two_to_one():
    domain, _ = build_domain(seen(ring(120)), triangles=1_000, detail="normal")
    (hole,) = domain.holes
    middle = hole.centre
    inside = complex(domain.mesh.vertices[domain.mesh.triangles[5]].mean())
    points = np.array([inside, middle, middle, -40 - 30j, inside])
    places = domain.nearest(points)
    assert domain.contains(points).tolist() == [True, False, False, False, True]
    assert domain.contains(places).all()
    assert places[0] == places[4] == inside
    assert places[1] != places[2]
    # No other place of the domain is nearer by more than a triangle's size.
    size = np.sqrt(120**2 / 500)
    for point, place in zip(points[1:4], places[1:4], strict=True):
        nearest = np.abs(domain.mesh.vertices - point).min()
        assert abs(place - point) < nearest + 2 * size

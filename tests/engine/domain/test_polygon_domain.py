"""Domains from polygons, and what the ways to a domain refuse."""

import numpy as np
import pytest
from messages import says
from numpy.testing import assert_allclose

from engine.arrays import FEW_ENTRIES, NOT_FINITE, NOT_WHOLE, OTHER_KIND
from engine.domain import Domain, build_domain, domain_of_polygon, require_domain
from engine.domain.build import LONGEST_EDGE, NO_DETAIL, NO_MASK
from engine.domain.mask.grid import EMPTY_MASK
from engine.errors import EngineError
from engine.geometry import diameter, edge_vectors, signed_area
from engine.geometry.polygon import HOLE_LEAVES
from engine.maps import Boundary, Bounds, HarmonicMap, certify

SQUARE = [0, 4, 4 + 3j, 3j]
HOLE = [1 + 1j, 2 + 1j, 2 + 2j, 1 + 2j]
MASK = np.ones((40, 40), dtype=np.bool_)


@pytest.mark.parametrize("step", [1, -1])
def test_domain_of_polygon_is_valid_in_either_direction(step):
    domain = domain_of_polygon(SQUARE[::step], [HOLE[::step]], triangles=1_000)
    require_domain(domain)
    assert [signed_area(loop) > 0 for loop in domain.loops] == [True, False]
    assert_allclose(sum(map(signed_area, domain.loops)), 11, rtol=1e-12, atol=0)
    longest = max(np.abs(edge_vectors(loop)).max() for loop in domain.loops)
    assert longest <= LONGEST_EDGE * diameter(domain.outline)
    identity = HarmonicMap.identity(domain.cage, domain.holes)
    assert certify(identity, Boundary.sample(domain), Bounds()).is_certified


@pytest.mark.parametrize(
    ("outline", "holes", "triangles", "message"),
    [
        (SQUARE, (), 999, "between 1,000"),
        (SQUARE, (), 2000.5, says(NOT_WHOLE, name="triangles", value=2000.5)),
        (SQUARE, (), "2000", says(NOT_WHOLE, name="triangles", value="2000")),
        (SQUARE[:2], (), 1_000, says(FEW_ENTRIES, name="outline", at_least=3, count=2)),
        ([0, 4, np.nan], (), 1_000, says(NOT_FINITE, name="outline", index=2)),
        ([0, 4, 3j, 4 + 3j], (), 1_000, "outline crosses"),
        (SQUARE, [np.array(HOLE) + 3], 1_000, says(HOLE_LEAVES, number=0)),
    ],
)
def test_domain_of_polygon_refuses_in_words(outline, holes, triangles, message):
    with pytest.raises(EngineError, match=message):
        domain_of_polygon(outline, holes, triangles=triangles)


@pytest.mark.parametrize(
    ("mask", "given", "message"),
    [
        (MASK, {"detail": "fineish"}, says(NO_DETAIL, detail="fineish")),
        (MASK.astype(np.uint8), {}, says(NO_MASK, dtype="uint8", shape=(40, 40))),
        (MASK[..., None], {}, says(NO_MASK, shape=(40, 40, 1))),
        (MASK[:0], {}, says(EMPTY_MASK)),
        (MASK, {"holes": "open"}, "holes"),
        (MASK, {"toggled_holes": [np.nan]}, says(NOT_FINITE, name="toggled holes", index=0)),
        (MASK, {"cut_lines": [[1j]]}, says(FEW_ENTRIES, name="cut line", at_least=2, count=1)),
    ],
)
def test_build_domain_refuses_in_words(mask, given, message):
    with pytest.raises(EngineError, match=message):
        build_domain(mask, **{"triangles": 1_000, "detail": "normal"} | given)


def test_domain_refuses_holes_that_are_polygons():
    with pytest.raises(EngineError, match=says(OTHER_KIND, name="hole 0", given="list")):
        Domain(SQUARE, SQUARE, [HOLE])

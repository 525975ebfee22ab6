"""A domain from a file is asked for all that building one gives."""

from dataclasses import replace

import numpy as np
import pytest
from messages import says
from pictures import blob, limbs, ring, seen, star
from shapes import regular_polygon

from engine.domain import MeshedDomain, build_domain, require_domain
from engine.domain.meshing.mesh import Mesh
from engine.domain.validity import (
    MESH_CORNERS,
    MESH_FLAT,
    MESH_OVERLAPS,
    MESH_SIZE,
    MESH_UNFILLED,
    MESH_UNUSED,
    TOO_FAR,
    VERTEX_COUNT,
)
from engine.errors import EngineError
from engine.geometry.polygon import CAGE_ORDER, CAGE_TOUCHES

# A pentagon with a hole in its fan: the L-shaped outline 0, 2, 2+i, 1+i, 1+2i, 2i.
OUTLINE = np.array([0, 2, 2 + 1j, 1 + 1j, 1 + 2j, 2j]) * 50 + 20 + 30j
CAGE = np.array([-0.2 - 0.2j, 2.2 - 0.2j, 2.2 + 1.2j, 1.2 + 1.2j, 1.2 + 2.2j, -0.2 + 2.2j])
TRIANGLES = np.array([[0, 1, 3], [1, 2, 3], [0, 3, 5], [3, 4, 5]], np.int32)


def domain(outline=OUTLINE, cage=CAGE * 50 + 20 + 30j, vertices=OUTLINE, triangles=TRIANGLES):
    mesh = Mesh(vertices=vertices, triangles=np.array(triangles, np.int32).reshape(-1, 3))
    return MeshedDomain(outline=outline, cage=cage, mesh=mesh)


def test_a_domain_made_by_hand_is_one():
    require_domain(domain())
    # Vertices on the outline's edges and inside are welcome.
    middle = (OUTLINE[0] + OUTLINE[1]) / 2
    split = [[0, 6, 3], [6, 1, 3], [1, 2, 3], [0, 3, 5], [3, 4, 5]]
    require_domain(domain(vertices=np.append(OUTLINE, middle), triangles=split))


@pytest.mark.parametrize("picture", [blob(), star(7), limbs(6)])
def test_every_domain_that_is_built_is_one(picture):
    built, _ = build_domain(seen(picture), triangles=3_000, detail="normal")
    require_domain(built)


@pytest.mark.parametrize(
    ("broken", "message"),
    [
        (domain(outline=OUTLINE[::-1]), "outline runs clockwise"),
        (domain(outline=OUTLINE[[0, 2, 1, 3, 4, 5]]), "outline crosses"),
        (domain(cage=(CAGE * 50 + 20 + 30j)[::-1]), says(CAGE_ORDER)),
        (domain(cage=0.5 * (OUTLINE - OUTLINE[3]) + OUTLINE[3]), says(CAGE_TOUCHES)),
        (domain(cage=CAGE * 50 + 500), says(CAGE_ORDER)),
        (domain(cage=200 * regular_polygon(501)), says(VERTEX_COUNT, name="cage", most=500)),
        (domain(cage=OUTLINE + 1e-6 * (CAGE * 50 + 20 + 30j - OUTLINE)), "cage comes too close"),
        (domain(cage=1e200 * CAGE), says(TOO_FAR, name="cage")),
        (domain(vertices=OUTLINE * 1e150), says(TOO_FAR, name="mesh")),
        (domain(triangles=[]), says(MESH_SIZE)),
        (domain(triangles=[*TRIANGLES[:3], [3, 4, 6]]), says(MESH_CORNERS)),
        (domain(triangles=[*TRIANGLES[:3], [3, 4, -1]]), says(MESH_CORNERS)),
        (domain(vertices=np.append(OUTLINE, 45 + 45j)), says(MESH_UNUSED)),
        (domain(triangles=TRIANGLES[:, ::-1]), says(MESH_FLAT)),
        (domain(triangles=[*TRIANGLES[:3], [3, 5, 4]]), says(MESH_FLAT)),
        (domain(triangles=[*TRIANGLES, [3, 4, 5]]), says(MESH_OVERLAPS)),
        (domain(triangles=[*TRIANGLES, [1, 2, 3]]), says(MESH_OVERLAPS)),
        (domain(triangles=TRIANGLES[[1, 2, 3]]), says(MESH_UNFILLED)),
        # Across the notch: each corner lies on the outline, but not the edge between them.
        (domain(triangles=[*TRIANGLES, [2, 4, 3]]), says(MESH_UNFILLED)),
        (domain(vertices=OUTLINE + 5), says(MESH_UNFILLED)),
        (domain(vertices=0.9 * OUTLINE), says(MESH_UNFILLED)),
    ],
)
def test_fault_of_a_domain_is_named(broken, message):
    with pytest.raises(EngineError, match=message):
        require_domain(broken)


def test_a_mesh_that_goes_twice_around_fills_nothing():
    """Each of its triangles is fine, no edge is shared by three, and its border is the outline."""
    turned = replace(
        domain().mesh,
        vertices=np.concatenate([OUTLINE, OUTLINE]),
        triangles=np.concatenate([TRIANGLES, TRIANGLES + 6]),
    )
    with pytest.raises(EngineError, match=says(MESH_UNFILLED)):
        require_domain(replace(domain(), mesh=turned))


@pytest.fixture(scope="module")
def holed() -> MeshedDomain:
    built, _ = build_domain(seen(ring()), triangles=1_000, detail="coarse", holes="keep")
    assert len(built.holes) == 1
    return built


def test_a_domain_with_a_hole_is_one(holed):
    require_domain(holed)


def altered(domain: MeshedDomain, **changes) -> MeshedDomain:
    return replace(domain, holes=(replace(domain.holes[0], **changes),))


def test_fault_of_a_hole_is_named(holed):
    (hole,) = holed.holes
    middle = hole.centre
    filled = build_domain(seen(ring()), triangles=1_000, detail="coarse", holes="fill")[0].mesh
    for broken, message in (
        (altered(holed, outline=hole.outline[::-1]), "outline of hole 0 runs counter-clockwise"),
        (altered(holed, outline=hole.outline + 100), "Hole 0 leaves the outline"),
        (replace(holed, holes=(hole, hole)), "Hole 1 leaves the outline, or meets another hole"),
        (altered(holed, cage=hole.cage[::-1]), "cage of hole 0 runs counter-clockwise"),
        (altered(holed, cage=middle + 1.2 * (hole.cage - middle)), "cage of hole 0 is not inside"),
        (altered(holed, cage=hole.cage[:2]), "cage of hole 0 needs at least 3"),
        (altered(holed, centre=middle + 100), "centre of hole 0 is not inside"),
        (altered(holed, outline=middle + 1.05 * (hole.outline - middle)), "does not fill"),
        (replace(holed, holes=()), "does not fill"),
        (replace(holed, mesh=filled), "does not fill"),
    ):
        with pytest.raises(EngineError, match=message):
            require_domain(broken)

"""What the engine cannot use is refused by an error of its own, which names it."""

from functools import cache

import numpy as np
import pytest
from shapes import regular_polygon

from engine.deform import Aim, BoundedPull, Deformer, Handles
from engine.dirichlet import HilbertTransform
from engine.domain import build_domain, find_holes, mesh_inside, rectangle_domain
from engine.domain.material.brush import brush_weights
from engine.domain.material.limb import limb_weights
from engine.domain.material.transfer import copy_nearest_stiffness
from engine.domain.meshing.triangulation import triangulate
from engine.domain.outline.enclosure import enclose_subject
from engine.errors import EngineError
from engine.geometry import Domain, constrained_delaunay, fit_rigid
from engine.interpolation import InteriorKnot, TimeWeights, prepare, sample_domain, sample_keyframes
from engine.maps import Boundary, Bounds, HarmonicMap, derivatives_of
from engine.streaming import build_morph_targets

NAN = float("nan")
OUTLINE, CAGE = regular_polygon(8), regular_polygon(8, 1.2)
DOMAIN = Domain(OUTLINE, CAGE)
MAP = HarmonicMap.identity(CAGE)
MASK = np.zeros((60, 60), np.bool_)
MASK[10:50, 10:50] = True


@cache
def boundary():
    return Boundary.sample(DOMAIN)


@cache
def handles():
    return Handles.place(boundary(), np.array([-0.5, 0.5 + 0j]))


@cache
def transform():
    return HilbertTransform.on(DOMAIN)


def built(**changes):
    return build_domain(**{"mask": MASK, "triangles": 2000, "detail": "fine"} | changes)


def in_between(time):
    return prepare([MAP, MAP], boundary(), [0j], variant="nu").frame(time)


def targets(times, tolerance=0.1):
    return next(build_morph_targets(lambda _: OUTLINE, OUTLINE, times, tolerance=tolerance))


REFUSED = {
    "detail": lambda: built(detail="fineish"),
    "triangles as text": lambda: built(triangles="2000"),
    "half a triangle": lambda: built(triangles=2000.5),
    "mask of numbers": lambda: built(mask=MASK.astype(int)),
    "toggled holes nowhere": lambda: built(toggled_holes=[complex(NAN, NAN)]),
    "holes maybe": lambda: enclose_subject(MASK, detail="fine", holes="maybe"),
    "an empty mask": lambda: enclose_subject(~MASK & MASK, detail="fine"),
    "holes of an empty mask": lambda: find_holes(~MASK & MASK),
    "no triangles": lambda: triangulate(OUTLINE, 0),
    "fewer than no triangles": lambda: mesh_inside(DOMAIN, triangles=-5),
    "a rectangle without area": lambda: rectangle_domain(0, 0),
    "a bound as text": lambda: Bounds(k="x"),
    "weights as text": lambda: Handles.place(boundary(), np.array([0j]), ["x"]),
    "rotations as text": lambda: handles().targets([0j, 1], ["a", "b"]),
    "half a handle in a hand": lambda: handles().targets([0j, 1], None, [BoundedPull([0.5])]),
    "half a handle in a link": lambda: handles().targets([0j, 1], None, (), [Aim(0, 1, 0)]),
    "keyframes as arrays": lambda: prepare([CAGE, CAGE], boundary(), [0j]),
    "a time as text": lambda: in_between("0.5"),
    "a time that is no number": lambda: in_between(NAN),
    "an endless time": lambda: in_between(np.inf),
    "several times": lambda: in_between(np.array([0.2, 0.3])),
    "no keyframes": lambda: sample_keyframes([], sample_domain(boundary(), [0j])),
    "no maps": lambda: derivatives_of([], np.array([0j])),
    "an interval of no length": lambda: InteriorKnot(0.0, 1.0),
    "a pace of none": lambda: InteriorKnot(1.0, 1.0, 0.0, 1.0),
    "an end that is no number": lambda: TimeWeights.between(NAN, 1.0),
    "an outline that runs clockwise": lambda: HilbertTransform.on(Domain(OUTLINE[::-1], CAGE)),
    "a cage inside": lambda: HilbertTransform.on(Domain(OUTLINE, 0.5 * CAGE)),
    "an extension outside": lambda: transform().at(np.array([0j, 30 + 30j])),
    "an extension nowhere": lambda: transform().at(np.empty(0, complex)),
    "parts of other nodes": lambda: transform().at(np.array([0j])).extend(np.zeros((3, 1))),
    "targets at no time": lambda: targets([]),
    "targets back in time": lambda: targets([1, 0]),
    "a tolerance below 0": lambda: targets([0, 1], tolerance=-1),
    "a brush without radius": lambda: brush_weights([OUTLINE], np.array([0j]), 0.0, 0.5),
    "a brush nowhere": lambda: brush_weights([OUTLINE], np.array([complex(NAN, 0)]), 1.0, 0.5),
    "no stiffness": lambda: copy_nearest_stiffness([OUTLINE], np.zeros(len(OUTLINE)), OUTLINE),
    "a rigid motion to nowhere": lambda: fit_rigid(
        np.array([0j, 1]), np.array([NAN, 0j]), np.ones(2)
    ),
    "a rigid motion of no weight": lambda: fit_rigid(
        np.array([0j, 1]), np.array([1, 0j]), np.array([1.0, -1.0])
    ),
    "a polygon that crosses itself": lambda: constrained_delaunay(np.array([0, 1 + 1j, 1, 1j])),
}


@pytest.mark.parametrize("case", REFUSED)
def test_input_is_refused_by_the_engine_when_it_is_no_input(case):
    with pytest.raises(EngineError):
        REFUSED[case]()


def test_bone_from_nowhere_is_refused_as_such():
    with pytest.raises(EngineError, match="ends of a bone"):
        limb_weights([OUTLINE], complex(NAN, 0), 1 + 0j, OUTLINE)


def test_extension_takes_points_of_the_boundary():
    on = np.concatenate([OUTLINE, (OUTLINE + np.roll(OUTLINE, -1)) / 2])
    assert np.isfinite(transform().at(on).extend(np.ones((len(transform().nodes), 1))).values).all()


def test_handles_are_held_by_whole_numbers_of_any_type():
    handle_targets = handles().targets([0j, 1], None, [BoundedPull(np.array([0]))])
    assert handle_targets.pulls is not None
    assert Deformer(boundary=boundary(), handles=handles(), bounds=Bounds()).start() is not None

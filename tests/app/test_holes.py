"""A layer with a hole, through document, files, motion, solving and the command line."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from documents import PICTURE
from holed_shapes import Holed, boundary_of, random_map, ring
from numpy.testing import assert_allclose, assert_array_equal

from app.cli.arrays.hole_arrays import HOLES_LACK
from app.cli.main import main
from app.cut_out import CutOut, build_picture_domain
from app.document import Document, Handle, Keyframe, Meshing, Pose, Target, clip_of, new_layer
from app.errors import LissomError
from app.motion import Animation
from app.motion.meshes.deform_mesh import DeformMesh
from app.reports import certify_clip
from app.solving.drag.shown_pose import fit_map
from app.storage import load_project, save_project
from engine.domain import MeshedDomain, require_domain
from engine.domain.meshing.triangulation import triangulate
from engine.geometry import contains
from engine.maps import Boundary, Bounds, HarmonicMap, certify

MIDDLE, RADIUS = 100 + 100j, 80.0


@cache
def coarse() -> Holed:
    return ring(sides=24)


@cache
def shape() -> Holed:
    return coarse().moved(RADIUS, MIDDLE)


@cache
def document() -> Document:
    """A ring in a picture, with three poses of which none is at rest."""
    outline = shape().outline
    mesh = triangulate(outline, 1500, holes=shape().loops[1:])
    domain = MeshedDomain(outline=outline, cage=shape().cage, mesh=mesh, holes=shape().holes)
    require_domain(domain)
    layer = new_layer(PICTURE, domain, Meshing())
    handle = Handle(id=0, name="rim", position=MIDDLE + 0.75 * RADIUS)
    boundary = Boundary.sample(domain)
    keys = []
    for number in range(3):
        f = random_map(coarse(), number, 0.08)
        f = HarmonicMap(
            cage=domain.cage,
            phi=RADIUS * f.phi + MIDDLE * (np.arange(len(f.phi)) < len(domain.cage)),
            psi=RADIUS * f.psi,
            holes=domain.holes,
            logs=RADIUS * f.logs,
        )
        pose = Pose(
            targets={0: Target(position=complex(f(np.array([handle.position]))[0]))},
            phi=f.phi,
            psi=f.psi,
            logs=f.logs,
            certificate=certify(f, boundary, Bounds()),
        )
        keys.append(Keyframe(frame=12 * number, pose=pose))
    layer = replace(layer, handles=(handle,), next_handle=1, keys=tuple(keys))
    return Document(layers=(layer,))


def test_a_project_keeps_holes_and_maps_bit_for_bit(tmp_path):
    path = tmp_path / "ring.lissom"
    save_project(path, document())
    (before,), (after,) = document().layers, load_project(path).layers
    for one, two in zip(before.domain.holes, after.domain.holes, strict=True):
        assert_array_equal(one.outline, two.outline)
        assert_array_equal(one.cage, two.cage)
        assert one.centre == two.centre
    for one, two in zip(before.poses, after.poses, strict=True):
        for name in ("phi", "psi", "logs"):
            assert_array_equal(getattr(one, name), getattr(two, name))
        assert two.certificate.is_certified


def test_a_handle_or_anchor_in_a_hole_is_refused():
    (layer,) = document().layers
    with pytest.raises(LissomError, match="lies outside the shape"):
        replace(layer, anchor=MIDDLE)
    with pytest.raises(LissomError, match="lies outside the shape"):
        replace(layer, handles=(replace(layer.handles[0], position=MIDDLE + 3),))
    pose = replace(layer.keys[0].pose, logs=np.empty(0))
    with pytest.raises(LissomError, match="has 0 holes, but the layer has 1"):
        replace(layer, keys=(Keyframe(frame=0, pose=pose),))


def test_the_screen_shows_the_map_around_a_hole():
    (layer,) = document().layers
    pose = layer.keys[1].pose
    mesh = DeformMesh.fine(layer.domain)
    expected = layer.map_of(pose)(layer.domain.mesh.vertices)
    assert_allclose(mesh.pose_vertices(pose), expected, rtol=0, atol=1e-3)


def test_a_motion_around_a_hole_is_certified_and_its_correction_reported(tmp_path, capsys):
    path = tmp_path / "ring.lissom"
    (layer,) = document().layers
    from_key_to_key = Document(layers=(replace(layer, keys=layer.keys[:2]),))
    save_project(path, from_key_to_key)
    clip = clip_of(from_key_to_key, layer.id)
    report = certify_clip(clip)
    assert all(own.is_certified for _, own in report.keys)
    for interval in report.segments:
        assert interval.correction > 1e-4
        assert interval.reached.k <= 1.05 * interval.keys.k
    main(["certify", str(path)])
    assert "To close around holes, the in-betweens" in capsys.readouterr().out


def test_frames_keep_the_hole_open():
    clip = clip_of(document(), document().layers[0].id)
    animation = Animation(clip)
    domain = document().layers[0].domain
    for frame in (0.0, 5.0, 12.0, 20.0):
        places = animation.positions(frame)
        moved = np.split(places[: sum(map(len, domain.loops))], [len(domain.outline)])
        assert not contains(moved[0], np.array([moved[1].mean()]), holes=[moved[1]]).any()
        corners = places[domain.mesh.triangles]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        assert ((a.conj() * b).imag > 0).all()


def test_a_frame_between_keys_is_fitted_by_a_map_around_the_hole():
    boundary, f = boundary_of("ring"), random_map(ring(), 5, 0.1)
    found = fit_map(boundary, *f.derivatives(boundary.points), f(boundary.points))
    assert_allclose(found(boundary.points), f(boundary.points), rtol=0, atol=1e-8)
    assert_allclose(found.logs, f.logs, rtol=0, atol=1e-9)


def ring_picture() -> np.ndarray:
    y, x = np.mgrid[:160, :160]
    away = np.hypot(x - 79.5, y - 79.5)
    rgba = np.zeros((160, 160, 4), dtype=np.uint8)
    rgba[(away < 70) & (away > 35)] = (200, 60, 60, 255)
    return rgba


def test_arrays_of_holes_are_handed_from_command_to_command(tmp_path):
    domain, _ = build_picture_domain(
        ring_picture(), triangles=1000, detail="coarse", cut_out=CutOut(holes="keep")
    )
    (hole,) = domain.holes
    held = 80 + 80j + 52 * np.exp(1j * np.pi * np.array([0.0, 0.5, 1.0, 1.5]))
    case = {
        "outline": domain.outline,
        "cage": domain.cage,
        "hole_outlines": hole.outline,
        "hole_outline_sizes": np.array([len(hole.outline)]),
        "hole_cages": hole.cage,
        "hole_cage_sizes": np.array([len(hole.cage)]),
        "hole_centres": np.array([hole.centre]),
        "handles": held,
        "targets": held + np.array([10, -4j, -10, 4j]),
        "k_max": 0.8,
        "sigma_a_max": 5.0,
        "sigma_b_min": 0.2,
    }
    np.savez(tmp_path / "case.npz", **case)
    assert main(["deform", str(tmp_path / "case.npz"), "--out", str(tmp_path / "map.npz")]) == 0
    with np.load(tmp_path / "map.npz") as written:
        got = dict(written)
    assert bool(got["certified"])
    assert got["logs"].shape == (1,)
    assert_array_equal(got["hole_cages"], hole.cage)
    f = HarmonicMap(
        cage=got["cage"], phi=got["phi"], psi=got["psi"], holes=domain.holes, logs=got["logs"]
    )
    assert_allclose(f(held), got["handles_mapped"], rtol=0, atol=1e-9)
    rest = HarmonicMap.identity(domain.cage, domain.holes)
    maps = {name: got[name] for name in got if name.startswith("hole_")}
    maps |= {"outline": got["outline"], "cage": got["cage"], "points": domain.mesh.vertices}
    for name in ("phi", "psi", "logs"):
        maps[name] = np.array([getattr(rest, name), got[name]])
    np.savez(tmp_path / "maps.npz", **maps)
    arguments = ["--variant", "nu", "--times=0,0.5,1", "--out", str(tmp_path / "out.npz")]
    assert main(["interpolate", str(tmp_path / "maps.npz"), *arguments]) == 0
    with np.load(tmp_path / "out.npz") as written:
        frames = dict(written)
    assert_allclose(frames["positions"][0], domain.mesh.vertices, rtol=0, atol=1e-9)
    assert_allclose(frames["positions"][2], f(domain.mesh.vertices), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"hole_cage_sizes": np.array([3])}, "add up to"),
        ({"hole_centres": None}, HOLES_LACK.format(name="hole_centres")),
        ({"hole_outline_sizes": np.array([1.5])}, "whole numbers"),
    ],
)
def test_arrays_that_are_no_holes_are_refused(tmp_path, capsys, change, message):
    hole = ring().holes[0]
    case = {
        "outline": ring().outline,
        "cage": ring().cage,
        "hole_outlines": hole.outline,
        "hole_outline_sizes": np.array([len(hole.outline)]),
        "hole_cages": hole.cage,
        "hole_cage_sizes": np.array([len(hole.cage)]),
        "hole_centres": np.array([hole.centre]),
        "handles": np.array([0.75]),
        "targets": np.array([0.75]),
        "k_max": 0.8,
        "sigma_a_max": 5.0,
        "sigma_b_min": 0.2,
    } | change
    np.savez(tmp_path / "case.npz", **{k: v for k, v in case.items() if v is not None})
    with pytest.raises(SystemExit):
        main(["deform", str(tmp_path / "case.npz"), "--out", str(tmp_path / "map.npz")])
    assert message in capsys.readouterr().err

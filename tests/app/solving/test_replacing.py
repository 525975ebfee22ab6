"""Another picture under the handles and keys of a layer."""

from dataclasses import replace

import numpy as np
import pytest
from layered import blob, png
from PIL import Image, ImageDraw

from app.document import handle_commands, key_commands
from app.document.channels.springs import Spring
from app.document.channels.tracks import Track, TrackKey
from app.document.keyframe import Target
from app.document.model import Document
from app.document.settings import Meshing
from app.solving.drag.drag_solver import DragSolver
from app.solving.drag.rig import Rig
from app.solving.reload.replace_picture import find_new_corner, start_picture_replacement
from app.solving.resolve_keys import step_resolver
from app.storage.assets import sample_images
from app.storage.pictures.layered import ImportedLayer
from app.storage.pictures.picture import decode_picture
from app.storage.project_file import load_project
from app.storage.scenes.layers import make_posable_layer, make_still_picture

MESHING = Meshing(triangles=1_000, detail="coarse")


def layer_of(image, corner=0j):
    data = png(image)
    imported = ImportedLayer(
        name="arm", data=data, picture=decode_picture(data, "arm.png"), corner=corner
    )
    layer, _ = make_posable_layer(imported, 0, MESHING, is_cut_out=True)
    return layer


@pytest.fixture(scope="module")
def raised():
    """An ellipse around 90 + 50i with an anchor and two handles, one of them raised at frame 10."""
    document = Document(layers=(layer_of(blob(120, 40), 30 + 30j),), size=(300, 200))
    layer = replace(document.layers[0], anchor=50 + 50j)
    document = document.with_layer(layer)
    for place in (50 + 50j, 140 + 50j):
        document = handle_commands.add_handle(0, place)(document)
    (layer,) = document.layers
    targets = {0: Target(position=50 + 50j), 1: Target(position=130 + 75j)}
    drag = DragSolver.begin(Rig.of(layer), layer.keys[0].pose).step_towards(targets, 300)
    return key_commands.insert_key(0, 10, drag.make_pose(targets))(document)


def replaced(document, made):
    (before,) = document.layers
    old = decode_picture(before.picture.data, "old")
    new = decode_picture(made.picture.data, "new")
    corner = find_new_corner(before, new, document.canvas, old.rgba)
    resolver = start_picture_replacement(before, made, corner)
    while not resolver.is_over:
        resolver = step_resolver(resolver, np.zeros((1, 1, 4), np.uint8))
    assert resolver.progress == 1
    after = resolver.command(document)
    assert after.canvas == document.canvas
    return after.layers[0]


def test_tracks_and_springs_stay_and_planted_places_go_with_their_handles(raised):
    at = (TrackKey(frame=1, place=52 + 49j), TrackKey(frame=9, place=140 + 70j, turn=0.5))
    planted = Track(handles=(1,), is_scene_space=True, keys=at, delay=2)
    beside = Track(handles=(0,), keys=at)
    springs = (Spring(handle=1, frequency=3.0, damping=0.2),)
    before = replace(raised.layers[0], tracks=(planted, beside), springs=springs)
    document = raised.with_layer(before)
    layer = replaced(document, layer_of(blob(120, 40, (10, 20, 30))))
    assert (layer.tracks, layer.springs) == (before.tracks, springs)
    # On a smaller shape the handle comes nearer to the middle, and is wanted as far from there.
    layer = replaced(document, layer_of(blob(62, 20)))
    by = layer.handle(1).position - before.handle(1).position
    assert abs(by) > 10
    one, other = (
        new.place - old.place for new, old in zip(layer.track_of(1).keys, at, strict=True)
    )
    (fz,), _ = before.map_of(before.key(10).pose).derivatives(np.array([before.handle(1).position]))
    assert abs(one - by) < 1e-9
    assert abs(other - by * fz / abs(fz)) < 1e-9
    assert replace(layer.track_of(1), keys=at) == planted
    assert layer.track_of(0) == beside


@pytest.mark.parametrize(
    ("size", "corner"),
    [((120, 40), 30 + 30j), ((300, 200), 0j), ((60, 80), 60 + 10j), ((62, 20), 59 + 40j)],
)
def test_where_another_picture_comes(raised, size, corner):
    layer = replaced(raised, layer_of(blob(*size)))
    assert layer.corner == corner
    assert layer.picture.size == size
    assert layer.domain.contains(np.array([layer.anchor])).all()


def test_the_same_shape_is_posed_as_before(raised):
    (before,) = raised.layers
    layer = replaced(raised, layer_of(blob(120, 40, (10, 20, 30))))
    assert layer.handles == before.handles
    assert layer.anchor == before.anchor
    points = np.array([60 + 50j, 90 + 50j, 120 + 52j])
    for key, old in zip(layer.keys, before.keys, strict=True):
        assert key.frame == old.frame
        assert key.pose.certificate.is_certified
        moved = layer.map_of(key.pose)(points) - before.map_of(old.pose)(points)
        assert np.abs(moved).max() < 1


def test_what_is_not_on_the_new_shape_comes_onto_it_and_its_targets_follow(raised):
    (before,) = raised.layers
    layer = replaced(raised, layer_of(blob(50, 30)))
    places = np.array([handle.position for handle in layer.handles])
    assert layer.domain.contains(places).all()
    # The anchor is at the first handle still.
    assert layer.anchor == layer.handles[0].position
    rest, up = layer.keys
    for handle, old in zip(layer.handles, before.handles, strict=True):
        by = handle.position - old.position
        assert abs(by) > 5
        assert abs(rest.pose.targets[handle.id].position - handle.position) < 1e-9
        before_up = before.keys[1].pose.targets[handle.id].position
        moved = up.pose.targets[handle.id].position - before_up
        assert abs(abs(moved) - abs(by)) < 1e-9
    # At the raised end the shape is turned, and so is the way that its target goes.
    turned = up.pose.targets[1].position - before.keys[1].pose.targets[1].position
    assert abs(np.angle(turned / (layer.handles[1].position - before.handles[1].position))) > 0.1


def test_a_still_picture_stays_where_it_was_put():
    still = replace(
        make_still_picture(png(blob(40, 20)), decode_picture(png(blob(40, 20)), "a")), id=0
    )
    document = Document(layers=(still,))
    pose = still.keys[0].pose
    turned = pose.with_map(still.map_of(pose).moved(1j, 50 + 5j))
    document = key_commands.replace_key_pose(0, 0, turned)(document)
    data = png(blob(40, 20, (0, 0, 250)))
    layer = replaced(document, make_still_picture(data, decode_picture(data, "b")))
    assert layer.still
    assert layer.picture.data == data
    points = np.array([5 + 5j, 30 + 12j])
    moved = layer.map_of(layer.keys[0].pose)(points)
    assert np.abs(moved - (1j * points + 50 + 5j)).max() < 1e-6


def test_a_pose_that_cannot_be_carried_over_is_reached_from_rest():
    """The head of the sample as an ellipse: carried over, one pose is squeezed below."""
    document = load_project(sample_images() / "friend.lissom")
    head = next(layer for layer in document.layers if layer.name == "head")
    image = Image.new("RGBA", (460, 460))
    ImageDraw.Draw(image).ellipse((10, 10, 450, 450), fill=(250, 210, 170, 255))
    corner = 1060 + 1100j - 230 * (1 + 1j)
    resolver = start_picture_replacement(head, layer_of(image), corner)
    while not resolver.is_over:
        resolver = step_resolver(resolver, np.zeros((1, 1, 4), np.uint8))
    assert not resolver.unsolved
    assert all(pose.certificate.is_certified for pose in resolver.poses)

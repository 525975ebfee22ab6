import weakref
from dataclasses import replace

import numpy as np
from documents import CENTRE, disc_document
from shapes import regular_polygon

from app.document import Track, TrackKey, clip_of, track_commands
from app.document.channels.easing import LINEAR
from app.document.commands import (
    handle_commands,
)
from app.document.commands.keys import (
    key_commands,
)
from app.document.commands.layers import layer_commands
from app.motion import CorrectedFrames, DeformMesh, InbetweenCache, evaluate_layer
from engine.domain import MeshedDomain
from engine.domain.meshing.triangulation import triangulate


def test_the_nearer_key_stands_in_until_the_in_between_is_prepared():
    """As for a layer that is duplicated there, which was never shown before."""
    document = disc_document()
    layer = document.layers[0]
    first = layer.keys[0].pose
    turned = replace(first, phi=CENTRE + (first.phi - CENTRE) * np.exp(0.8j))
    clip = clip_of(key_commands.insert_key(layer.id, 24, turned)(document), layer.id)
    store = InbetweenCache(mesh=DeformMesh.coarse(layer.domain))
    for frame, pose in ((6, first), (18, turned)):
        shown = evaluate_layer(clip, frame, None, [store], None)
        assert shown.placeholder is pose
        assert not shown.is_current
        assert shown.pose is None
        np.testing.assert_array_equal(shown.positions, store.mesh.pose_vertices(pose))
        assert evaluate_layer(clip, frame, None, [store], shown) is shown


def test_the_frame_before_a_change_stays_until_the_new_one_is_known():
    document = disc_document()
    layer = document.layers[0]
    first = layer.keys[0].pose
    turned, bent = (
        replace(first, phi=CENTRE + (first.phi - CENTRE) * np.exp(angle)) for angle in (0.8j, 0.9j)
    )
    was, clip = (
        clip_of(key_commands.insert_key(layer.id, 24, pose)(document), layer.id)
        for pose in (turned, bent)
    )
    store = InbetweenCache(mesh=DeformMesh.coarse(layer.domain))
    store.add(store.segments_job(was, [0])())
    earlier = evaluate_layer(was, 12, None, [store], None)
    kept = evaluate_layer(clip, 12, None, [store], earlier)
    assert kept.vertices is earlier.vertices
    assert kept.clip is clip
    assert not kept.is_current
    assert evaluate_layer(clip, 12, None, [store], kept) is kept
    # At another frame it would be wrong, and so it is where the new one cannot be made.
    assert evaluate_layer(clip, 13, None, [store], kept).placeholder is bent
    store.set_needed_clips([clip], [], 12)
    store.mark_failed("in-betweens", clip)
    assert evaluate_layer(clip, 12, None, [store], kept).placeholder in (first, bent)


def test_key_with_a_track_waits_for_what_its_correction_needs():
    document = handle_commands.add_handle(0, CENTRE)(disc_document())
    layer = document.layers[0]
    key = TrackKey(frame=0, place=5 + 0j, easing=LINEAR)
    track = Track(handles=(layer.handles[0].id,), keys=(key,))
    document = track_commands.put_track(0, track)(document)
    clip = clip_of(document, 0)
    store, corrected = InbetweenCache(mesh=DeformMesh.coarse(layer.domain)), CorrectedFrames(clip)
    corrected.take(corrected.missing_here(document, 0, {})())
    shown = evaluate_layer(clip, 0, None, [store], None, corrected)
    pose = layer.keys[0].pose
    assert shown.placeholder is pose
    assert not shown.is_current
    store.add(store.segments_job(clip, [])())
    shown = evaluate_layer(clip, 0, None, [store], shown, corrected)
    assert shown.is_current
    (moved,) = shown.handle_positions - layer.handles[0].position
    np.testing.assert_allclose(moved, 5, atol=0.05)


def test_one_exact_in_between_stands_in_for_others_nearby():
    document = disc_document()
    layer = document.layers[0]
    first = layer.keys[0].pose
    pair = clip_of(key_commands.insert_key(layer.id, 24, first)(document), layer.id)
    store = InbetweenCache(mesh=DeformMesh.coarse(layer.domain))
    store.add(store.segments_job(pair, [0])())
    bent = replace(first, phi=CENTRE + (first.phi - CENTRE) * np.exp(0.8j))
    clip = clip_of(key_commands.insert_key(layer.id, 24, bent)(document), layer.id)
    assert store.frame_job(pair, 12) is None
    assert store.frame_job(clip, 24) is None
    store.add(store.frame_job(clip, 12)())
    seen = store.segment(clip, 0).single_frame
    exact = InbetweenCache(mesh=store.mesh)
    exact.add(exact.segments_job(clip, [0])())
    for frame, stand_in in ((12, None), (13, seen), (8, seen), (4, first), (22, bent)):
        shown = evaluate_layer(clip, frame, None, [store], None)
        assert shown.placeholder is stand_in
        if shown.is_current:
            expected = exact.positions(clip, frame)
            np.testing.assert_allclose(shown.positions, expected, atol=1e-5)
    # Of other keys it shows nothing.
    other = clip_of(key_commands.insert_key(layer.id, 24, turned_back(bent))(document), layer.id)
    assert evaluate_layer(other, 12, None, [store], None).placeholder is first


def turned_back(pose):
    return replace(pose, phi=CENTRE + (pose.phi - CENTRE) * np.exp(-0.4j))


def test_twenty_layers_with_something_in_front_are_drawn_again_as_they_are():
    """Each in the order that it was painted in before, without finding or uploading it anew."""
    document = handle_commands.add_handle(0, CENTRE)(disc_document())
    document = layer_commands.set_depth(0, 0, 1.0, None)(document)
    clip = clip_of(document, 0)
    layer = clip.layer
    stores = []
    for triangles in range(300, 500, 10):
        mesh = triangulate(layer.domain.outline, triangles)
        own = replace(layer, domain=replace(layer.domain, mesh=mesh))
        clip = replace(clip, layer=own)
        stores.append((clip, InbetweenCache(mesh=DeformMesh.fine(own.domain))))
    shows = [evaluate_layer(clip, 0, None, [store], None) for clip, store in stores]
    for (clip, store), shown in zip(stores, shows, strict=True):
        order = shown.vertices.triangles
        assert not np.array_equal(order, store.mesh.domain.mesh.triangles)
        assert evaluate_layer(clip, 0, None, [store], shown) is shown
        assert evaluate_layer(clip, 5, None, [store], shown).vertices is shown.vertices


def test_a_mesh_with_something_in_front_goes_with_what_showed_it():
    document = handle_commands.add_handle(0, CENTRE)(disc_document())
    clip = clip_of(layer_commands.set_depth(0, 0, 1.0, None)(document), 0)
    mesh = triangulate(clip.layer.domain.outline, 300)
    posable = DeformMesh.fine(replace(clip.layer.domain, mesh=mesh))
    order, depths = posable.order.triangles(clip, 0), posable.order.depths(clip, 0)
    assert not np.array_equal(order, mesh.triangles)
    np.testing.assert_allclose(depths.max(), 1, rtol=0, atol=1e-6)
    vertices = weakref.ref(mesh.vertices)
    del mesh, posable
    assert vertices() is None


def test_layers_that_are_drawn_together_share_the_coarse_triangles():
    outline = 100 * regular_polygon(30)
    mesh = triangulate(outline, 30_000)
    domain = MeshedDomain(outline=outline, cage=1.2 * outline, mesh=mesh)
    alone, one_of_two, one_of_ten = (
        len(DeformMesh.coarse(domain, among=among).domain.mesh.triangles) for among in (1, 2, 10)
    )
    assert abs(alone - 12_000) < 600
    assert abs(one_of_two - 6_000) < 300
    assert abs(one_of_ten - 4_000) < 200
